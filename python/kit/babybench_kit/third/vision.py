"""MIMo 3's vision: pictures as sharp as an infant of an age sees them, with a fovea."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .. import senses
from ..senses import Vision

if TYPE_CHECKING:
    from ..sensing import SensingEnv

__all__ = ["SimpleVision", "Vision"]

Array = NDArray[np.float64]

_AGES = np.geomspace(1, 36, 24).round(3)
"""Ages of the table, months."""
_CUTOFFS = (
    *(0.852, 1.0005, 1.1745, 1.3795, 1.621, 1.9065, 2.2445, 2.645, 3.121, 3.6885, 4.367, 5.179),
    *(6.1425, 7.1985, 8.218, 9.008, 9.405, 9.544, 9.6775, 10.079, 11.013, 12.54, 14.6785, 17.4195),
)
"""Highest spatial frequency that is seen at each of these ages, cycles per degree."""
_GROWN = 18.0
"""The age of a MIMo without an age, months."""
_PARTS = 32
"""Number of positions between two pixels."""
_FOVEA = 10.0
"""Strength of a fovea that is requested without a number."""


class SimpleVision(senses.SimpleVision):
    """A picture of each camera, with acuity and foveation where the parameters request them.

    ``acuity`` is ``False``, ``True`` for the age of the environment (18 months without one) or an age in months; ``foveation`` is
    ``False``, ``True`` for the strength 10, or a strength. Acuity takes ``fovy``, degrees, for the field of view.

    Attributes:
        acuity_functions: The transfer function of each camera with acuity, (height, width).
        foveation: The strength of each camera with a fovea.
    """

    _state: ClassVar[frozenset[str]] = frozenset({"acuity_functions"})

    def __init__(self, env: SensingEnv, camera_parameters: dict[str, dict[str, Any]]) -> None:
        """Takes the environment."""
        self.acuity_functions: dict[str, Array] = {}
        self.foveation: dict[str, float] = {}
        age = getattr(env, "age", None)
        for camera, given in camera_parameters.items():
            acuity, fovea = given.get("acuity", False), given.get("foveation", False)
            if acuity is not False:
                months = (_GROWN if age is None else age) if acuity is True else float(acuity)
                self.acuity_functions[camera] = self._get_acuity_function(
                    given["width"], given["height"], months, given.get("fovy", 60)
                )
            if fovea:
                self.foveation[camera] = _FOVEA if fovea is True else float(fovea)
        super().__init__(env, camera_parameters)

    @property
    def _as_known(self) -> bool:
        """Returns whether pictures are the engine's."""
        return type(self) is SimpleVision and not self.acuity_functions and not self.foveation

    def _seen(self, picture: NDArray[np.uint8], camera: str) -> NDArray[np.uint8]:
        """Returns the visible part of a camera's picture."""
        if camera in self.acuity_functions:
            picture = self._apply_acuity(picture, camera)
        if camera in self.foveation:
            picture = self._apply_foveation(picture, self.foveation[camera])
        return picture

    def _apply_acuity(self, img: NDArray[np.uint8], camera: str) -> NDArray[np.uint8]:
        """Returns a picture without the details that an eye of the camera's age cannot see."""
        axes = (0, 1)
        spectrum = np.fft.fftshift(np.fft.fft2(img.astype(float), axes=axes), axes=axes)
        spectrum *= self.acuity_functions[camera][..., None]
        seen = np.abs(np.fft.ifft2(np.fft.ifftshift(spectrum, axes=axes), axes=axes))
        clipped: NDArray[np.uint8] = seen.clip(0, 255).astype(np.uint8)
        return clipped

    def _get_acuity_function(self, width: int, height: int, acuity_age: float, fovy: float) -> Array:
        """Returns the factor of each spatial frequency in the shifted spectrum of a picture, (height, width)."""
        row, column = np.mgrid[:height, :width]
        along = np.hypot((width / 2 - column) / width, (height / 2 - row) / height)
        frequency = along * max(width, height) / fovy
        return self._get_mtf(frequency, float(np.interp(acuity_age, _AGES, _CUTOFFS)))

    def _get_mtf(self, x: Array, acuity: float) -> Array:
        """Returns the contrast at frequencies, cycles per degree, for a cut-off: 1 below 0.1, and 0.01 at the cut-off."""
        exponent = -2 / (1 + np.log10(acuity))
        falling = np.clip(np.power(np.maximum(10 * np.asarray(x), 1e-9), exponent), 0.01, 0.99)
        return np.where(np.asarray(x) < 0.1, 1.0, falling)

    def _apply_foveation(self, img: NDArray[np.uint8], strength: float) -> NDArray[np.uint8]:
        """Returns a picture that is magnified in its middle."""
        height, width = img.shape[:2]
        row, column = np.mgrid[:height, :width].astype(float)
        middle = height / 2, width / 2
        up, right = row - middle[0], column - middle[1]
        distance, reach = np.hypot(up, right), np.hypot(*middle)
        there = reach * np.expm1(distance / reach * np.log1p(strength)) / strength
        scale = np.divide(there, distance, out=np.zeros_like(there), where=distance > 0)
        return _between(img, middle[0] + up * scale, middle[1] + right * scale)


def _between(img: NDArray[np.uint8], row: Array, column: Array) -> NDArray[np.uint8]:
    """Returns the colours of points between pixels, to a 32nd of a pixel, as image libraries compute them.

    Beyond its border a picture continues as its mirror image.
    """
    down, along = (np.rint(places.astype(np.float32) * _PARTS).astype(int) for places in (row, column))
    rows = [_mirrored(down // _PARTS + k, img.shape[0]) for k in (0, 1)]
    columns = [_mirrored(along // _PARTS + k, img.shape[1]) for k in (0, 1)]
    low, left = (down % _PARTS)[..., None], (along % _PARTS)[..., None]
    pixels = img.astype(int)
    upper, lower = (pixels[r, columns[0]] * (_PARTS - left) + pixels[r, columns[1]] * left for r in rows)
    mixed = upper * (_PARTS - low) + lower * low
    rounded: NDArray[np.uint8] = ((mixed + _PARTS**2 // 2) // _PARTS**2).astype(np.uint8)
    return rounded


def _mirrored(index: NDArray[np.int_], count: int) -> NDArray[np.int_]:
    """Returns indices in a row of pixels that continues as its mirror image, without repeating the last pixel."""
    period = max(2 * (count - 1), 1)
    index = np.abs(index) % period
    return np.minimum(index, period - index) if count > 1 else np.zeros_like(index)
