"""A camera that users move around a scene, and its projection."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

FOVY = 45.0
"""The vertical field of view of free cameras, degrees: that of MuJoCo's."""


@dataclass
class Orbit:
    """A camera that looks at a point from a distance (m), azimuth and elevation (degrees)."""

    lookat: Floats = field(default_factory=lambda: np.array([0.0, 0.0, 0.25]))
    distance: float = 1.8
    azimuth: float = 135.0
    elevation: float = -25.0
    fovy: float = FOVY

    @property
    def camera(self) -> tuple[list[float], float, float, float]:
        """The camera in the form that pictures take."""
        return self.lookat.tolist(), self.distance, self.azimuth, self.elevation

    def turn(self, across: float, down: float) -> None:
        """Turns around the point by degrees; the camera stays between straight down and just below the horizon."""
        self.azimuth -= across
        self.elevation = min(max(self.elevation - down, -89.9), 10.0)

    def shift(self, across: float, down: float) -> None:
        """Moves the point in the plane of the picture, by fractions of its height."""
        _, right, up = self.axes()
        self.lookat += (up * down - right * across) * self._height(self.distance)

    def zoom(self, factor: float) -> None:
        """Moves nearer or farther."""
        self.distance = min(max(self.distance * factor, 0.1), 30.0)

    def axes(self) -> tuple[Floats, Floats, Floats]:
        """Returns the directions forward, right and up."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
        forward, up = np.array([ce * ca, ce * sa, se]), np.array([-se * ca, -se * sa, ce])
        return forward, np.cross(forward, up), up

    def _height(self, depth: float) -> float:
        """Returns the height of the part of the world that the picture shows at a distance from its plane."""
        return 2 * depth * math.tan(math.radians(self.fovy) / 2)

    def place(self, x: float, y: float, depth: float, size: tuple[int, int]) -> Floats:
        """Returns the point of the world at a pixel of a picture and a distance from its plane."""
        forward, right, up = self.axes()
        scale = self._height(depth) / size[1]
        eye = self.lookat - forward * self.distance
        place: Floats = eye + forward * depth + right * (x - size[0] / 2) * scale - up * (y - size[1] / 2) * scale
        return place

    def pixels(self, points: Floats, size: tuple[int, int]) -> npt.NDArray[np.intp]:
        """Returns the pixels that show points of the world, (K, 2); those behind the camera are left out."""
        forward, right, up = self.axes()
        arms = points - (self.lookat - forward * self.distance)
        depth = arms @ forward
        arms, depth = arms[depth > 0.01], depth[depth > 0.01]
        scale = size[1] / (2 * depth * math.tan(math.radians(self.fovy) / 2))
        return np.stack([size[0] / 2 + arms @ right * scale, size[1] / 2 - arms @ up * scale], axis=1).astype(np.intp)
