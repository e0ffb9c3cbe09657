"""The look of a model: what pictures follow, and no step reads."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native

from .beneath import Beneath
from .views import LOOKS, ModelView

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


def is_look(name: str) -> bool:
    """Tells whether pictures follow an array."""
    return name in LOOKS or name.startswith("vis_")


def looks(engine: _native.Env) -> dict[str, NDArray[Any]]:
    """Returns the look of an environment's model."""
    return {name: array for name, array in _native.model_columns(engine).items() if is_look(name)}


def take_looks(core: Beneath, given: dict[str, NDArray[Any]]) -> None:
    """Gives an environment the look of another one, of which it is a copy."""
    own = looks(core.engine)
    others = {name: array for name, array in given.items() if not np.array_equal(array, own[name])}
    if not others:
        return
    _native.paint(core.engine, others)
    for name in LOOKS.intersection(others):
        getattr(core.model, name)[...] = others[name]
