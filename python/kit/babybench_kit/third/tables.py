"""MIMo 3's default parameters of the senses."""

from __future__ import annotations

from typing import Any

from ..tables import SPACING_V1, SPACING_V2, touch_params

_CHEST = {"chest": 0.030}
SPACINGS_V1 = {**SPACING_V1, **_CHEST}
"""Distance between touch sensors on each body of MIMo v1, m."""
SPACINGS_V2 = {**SPACING_V2, **_CHEST}
"""The same for MIMo v2."""


def vision_params(size: int) -> dict[str, dict[str, Any]]:
    """Returns parameters of two eyes of ``size`` by ``size`` pixels, sharp and without a fovea."""
    eye = {"width": size, "height": size, "fovy": 60, "acuity": False, "foveation": False}
    return {name: dict(eye) for name in ("eye_left", "eye_right")}


TOUCH_DEFAULTS = touch_params(SPACINGS_V1)
TOUCH_DEFAULTS_V2 = touch_params(SPACINGS_V2)
VISION_DEFAULTS = vision_params(256)
