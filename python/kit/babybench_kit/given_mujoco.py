"""MuJoCo's own models as ``env.model``, which a program has compiled from the environment's document.

MuJoCo does not keep the document of a model, so models of other documents are refused. What a program has written into the
model since it was compiled goes to the engine, or is refused by name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from babybench_core import _native
from babybench_core.looks import LOOKS

from .models import Watched, compiled, mujoco_model, mujoco_module
from .views import OPTIONS

if TYPE_CHECKING:
    from .core import Core

_SIZES = (
    "nq",
    "nv",
    "nu",
    "na",
    "nbody",
    "njnt",
    "ngeom",
    "nsite",
    "ncam",
    "nlight",
    "nmat",
    "neq",
    "ntendon",
    "nmocap",
)
_KINDS = ("body", "joint", "geom", "site", "camera", "light", "actuator", "sensor", "tendon", "equality", "material")
_PARTS = (
    "body",
    "jnt",
    "dof",
    "geom",
    "site",
    "cam",
    "light",
    "actuator",
    "sensor",
    "tendon",
    "wrap",
    "eq",
    "pair",
    "mat",
    "qpos",
)
_DRAWN = frozenset({"offwidth", "offheight"})
"""The size of MuJoCo's own pictures, which programs set; the environment takes it from ``width`` and ``height``."""
_FOLLOWED = frozenset(
    {
        *(("global_", "fovy"), ("map", "znear"), ("map", "zfar"), ("headlight", "active")),
        *(("headlight", name) for name in ("ambient", "diffuse", "specular")),
    }
)
_ALIKE = 1e-9
"""Numbers that differ by at most this, relative to their size or to 1, are those of the document."""

OTHER = (
    "env.model is a model of MuJoCo that was not compiled from {path}: it has {what}. MuJoCo does not keep the document of a "
    "model: compile env.fullpath, or edit it with babybench.mujoco.MjSpec.from_file(env.fullpath), whose models keep it"
)
FIXED = (
    "env.model: {names} differ from {path}, and a running environment cannot take them over; write them into the document. What "
    "can be written are {known}"
)


def is_model(model: Any) -> bool:
    """Returns whether this is one of MuJoCo's own models."""
    mujoco = mujoco_module()
    return mujoco is not None and isinstance(model, mujoco.MjModel)


def is_state(data: Any) -> bool:
    """Returns whether this is one of MuJoCo's own states."""
    mujoco = mujoco_module()
    return mujoco is not None and isinstance(data, mujoco.MjData)


def state(model: Any) -> Any:
    """Makes a state at ``qpos0``."""
    mujoco = mujoco_module()
    assert mujoco is not None
    return mujoco.MjData(model)


def adopt(core: Core, model: Any, path: str) -> None:
    """Uses a model as that of an environment, and passes to the engine what a program has written into it.

    Raises:
        ValueError: Its elements differ from the document's, or it has numbers that a running environment cannot use.
    """
    mujoco = mujoco_module()
    assert mujoco is not None
    fresh = compiled(mujoco, core)
    _compare_names(model, fresh, path)
    free = {*_native.CHANGEABLE, *LOOKS, "eq_active0", "eq_data"}
    written = {name: np.array(getattr(model, name)) for name in dir(model) if _differs(model, fresh, name)}
    options = {name: value for name, value in _settings(model.opt) if not _same(value, getattr(fresh.opt, name))}
    fixed = sorted(written.keys() - free) + [f"opt.{name}" for name in options if name not in OPTIONS]
    visual, others = _visual(model, fresh)
    fixed += others
    if fixed:
        known = ", ".join([*sorted(free), *sorted(f"vis.{part}.{name}" for part, name in _FOLLOWED)])
        raise ValueError(FIXED.format(names=", ".join(fixed), path=path, known=known))
    # compared with the document's numbers, so that earlier writes count as changes
    for name in written:
        getattr(model, name)[...] = getattr(fresh, name)
    for name in options:
        _set(model.opt, name, getattr(fresh.opt, name))
    for part, name, _ in visual:
        _set(getattr(model.vis, part), name, getattr(getattr(fresh.vis, part), name))
    core.show_model(Watched(core, mujoco_model(mujoco, core, model)))
    for name, values in written.items():
        getattr(model, name)[...] = values
    for name, value in options.items():
        _set(model.opt, name, value)
    for part, name, value in visual:
        _set(getattr(model.vis, part), name, value)
    core.check_model()


def _compare_names(model: Any, fresh: Any, path: str) -> None:
    """Raises an error if the elements of a model differ from those of the document's model."""
    for size in _SIZES:
        now, first = int(getattr(model, size)), int(getattr(fresh, size))
        if now != first:
            raise ValueError(OTHER.format(path=path, what=f"{size} {now}, where the document gives {first}"))
    for kind in _KINDS:
        one, other = ([getattr(each, kind)(i).name for i in range(_count(each, kind))] for each in (model, fresh))
        for now, first in zip(one, other):
            if now != first:
                raise ValueError(OTHER.format(path=path, what=f"a {kind} {now!r}, where the document gives {first!r}"))


def _count(model: Any, kind: str) -> int:
    sizes = {"joint": "njnt", "camera": "ncam", "actuator": "nu", "equality": "neq", "material": "nmat"}
    return int(getattr(model, sizes.get(kind, f"n{kind}")))


def _same(now: Any, first: Any) -> bool:
    """Returns whether numbers are the same except for the last bits."""
    one, other = np.asarray(now), np.asarray(first)
    if one.shape != other.shape:
        return False
    if one.dtype.kind != "f":
        return bool(np.array_equal(one, other))
    return bool(np.allclose(one, other, rtol=_ALIKE, atol=_ALIKE, equal_nan=True))


def _differs(model: Any, fresh: Any, name: str) -> bool:
    """Returns whether an array of the model differs from the document's."""
    if name.split("_")[0] not in _PARTS and name != "qpos0":
        return False
    now = getattr(model, name)
    return isinstance(now, np.ndarray) and not _same(now, getattr(fresh, name))


def _settings(of: Any) -> list[tuple[str, Any]]:
    """Returns the numbers of options or of a part of ``vis``."""
    found = [(name, getattr(of, name)) for name in dir(of) if not name.startswith("_")]
    return [(name, np.array(value)) for name, value in found if isinstance(value, (int, float, np.ndarray))]


def _visual(model: Any, fresh: Any) -> tuple[list[tuple[str, str, Any]], list[str]]:
    """Returns what a program has written into ``vis``: the values that affect pictures, and the names of the rest."""
    follows, rest = [], []
    for part in ("global_", "map", "headlight", "quality", "rgba", "scale"):
        for name, value in _settings(getattr(model.vis, part)):
            if name in _DRAWN or _same(value, getattr(getattr(fresh.vis, part), name)):
                continue
            if _followed(part, name):
                follows.append((part, name, value))
            else:
                rest.append(f"vis.{part}.{name}")
    return follows, rest


def _followed(part: str, name: str) -> bool:
    """Returns whether a setting affects pictures: numbers, and the colours of the headlight."""
    return (part, name) in _FOLLOWED


def _set(of: Any, name: str, value: Any) -> None:
    """Writes a number or an array of options."""
    present = getattr(of, name)
    if isinstance(present, np.ndarray):
        present[...] = value
    else:
        setattr(of, name, type(present)(value))
