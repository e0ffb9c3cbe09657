"""The appearance of a model: values that affect pictures but not steps."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from babybench_core import looks

from .beneath import Beneath
from .views import ModelView

VISUAL = ("fovy", "znear", "zfar", "active")
"""The settings of pictures that are single numbers."""


def visual_numbers(model: Any) -> tuple[float, ...]:
    """Returns these settings of MuJoCo's model; in its stand-in they are arrays."""
    if isinstance(model, ModelView):
        return ()
    vis = model.vis
    return vis.global_.fovy, vis.map.znear, vis.map.zfar, vis.headlight.active


def visual_arrays(model: Any) -> dict[str, NDArray[Any]]:
    """Returns the settings of pictures that are arrays."""
    vis = model.vis
    if isinstance(model, ModelView):
        parts = (vis.global_, vis.map, vis.headlight)
        return {f"vis_{name}": array for part in parts for name, array in part._drawn.items()}
    return {f"vis_{name}": getattr(vis.headlight, name) for name in ("ambient", "diffuse", "specular")}


def take_looks(core: Beneath, given: dict[str, NDArray[Any]]) -> None:
    """Applies the look of an environment to a copy of it."""
    changed = looks.take(core.engine, given)
    for name in looks.LOOKS.intersection(changed):
        getattr(core.model, name)[...] = changed[name]
