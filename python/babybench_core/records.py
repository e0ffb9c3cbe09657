"""Types of the dictionaries that the native part returns."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
import numpy.typing as npt


class TouchBody(TypedDict):
    """The sensors of a body."""

    body: int
    """Id of the body."""
    name: str
    """Name of the body."""
    spacing: float
    """Distance between its sensors, m."""
    offset: int
    """Number of sensors on the bodies before."""
    positions: npt.NDArray[np.float64]
    """Where the sensors are, (sensors, 3), m, in the frame of the body."""
    geoms: list[tuple[int, int, int, int]]
    """For each geom: id, first sensor, last sensor plus one, number of points on its surface."""


class LockReport(TypedDict):
    """The result of a lock: names of joints."""

    changed: list[str]
    """Joints that were locked or unlocked."""
    held: list[str]
    """Joints that another constraint of the scene holds."""
    beyond_limits: list[str]
    """Locked joints whose range does not contain the angle."""
