"""The few of MuJoCo's functions that scripts for BabyBench call, on what stands for its model and its state.

Everything else is MuJoCo's own business: ``pip install mujoco``.
"""

from __future__ import annotations

import enum
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from babybench_core.mimo.views import DataView as MjData
from babybench_core.mimo.views import ModelView as MjModel

stands_in = True
"""Tells these bindings from MuJoCo's own."""

__version__ = "0.0.0+babybench"

__all__ = [
    "MjData",
    "MjModel",
    "Renderer",
    "mj_contactForce",
    "mj_forward",
    "mj_id2name",
    "mj_name2id",
    "mjtGeom",
    "mjtJoint",
    "mjtObj",
]


class mjtObj(enum.IntEnum):
    """Kinds of elements."""

    mjOBJ_BODY = 1
    mjOBJ_JOINT = 3
    mjOBJ_GEOM = 5
    mjOBJ_SITE = 6
    mjOBJ_CAMERA = 7
    mjOBJ_TEXTURE = 13
    mjOBJ_MATERIAL = 15
    mjOBJ_EQUALITY = 17
    mjOBJ_TENDON = 18
    mjOBJ_ACTUATOR = 19
    mjOBJ_SENSOR = 20


class mjtGeom(enum.IntEnum):
    """Shapes of geoms."""

    mjGEOM_PLANE = 0
    mjGEOM_HFIELD = 1
    mjGEOM_SPHERE = 2
    mjGEOM_CAPSULE = 3
    mjGEOM_ELLIPSOID = 4
    mjGEOM_CYLINDER = 5
    mjGEOM_BOX = 6
    mjGEOM_MESH = 7


class mjtJoint(enum.IntEnum):
    """Types of joints."""

    mjJNT_FREE = 0
    mjJNT_BALL = 1
    mjJNT_SLIDE = 2
    mjJNT_HINGE = 3


def _names(model: MjModel, kind: int) -> list[str]:
    name = mjtObj(int(kind)).name.removeprefix("mjOBJ_").lower()
    return model._names[name]


def mj_id2name(m: MjModel, type: int, id: int) -> str | None:
    """Returns the name of an element; nothing if it has none or does not exist."""
    names = _names(m, type)
    return (names[id] or None) if 0 <= id < len(names) else None


def mj_name2id(m: MjModel, type: int, name: str) -> int:
    """Returns the id of an element; -1 if it does not exist."""
    names = _names(m, type)
    return names.index(name) if name in names else -1


def mj_forward(m: MjModel, d: MjData) -> None:
    """Computes everything at the positions and velocities of a state."""
    d._sync.forward()


def mj_contactForce(m: MjModel, d: MjData, id: int, result: NDArray[np.float64]) -> None:
    """Writes the force of a contact in its frame, (6,), N and N m."""
    np.reshape(result, -1)[:] = d.contact._forces[id]


class Renderer:
    """Draws the scene of a state, as MuJoCo's renderer does."""

    def __init__(self, model: MjModel, height: int = 240, width: int = 320, max_geom: int = 10000) -> None:
        """Takes the size of pictures, pixels."""
        self.height, self.width = height, width
        self._model = model
        self._data: MjData | None = None
        self._camera = "corner"

    def update_scene(self, data: MjData, camera: int | str = -1, scene_option: Any = None) -> None:
        """Takes the state and the camera of the next picture; without a camera, the one in the corner of the room."""
        cameras = self._model._names["camera"]
        self._camera = camera if isinstance(camera, str) else (cameras[camera] if camera >= 0 else "corner")
        self._data = data

    def render(self, *, out: NDArray[np.uint8] | None = None) -> NDArray[np.uint8]:
        """Draws the picture, (height, width, 3), red, green and blue."""
        if self._data is None:
            raise RuntimeError("call update_scene(env.data) before render()")
        picture: NDArray[np.uint8] = self._data._env.render(self._camera, self.width, self.height)
        if out is None:
            return picture
        out[...] = picture
        return out

    def close(self) -> None:
        """Does nothing."""

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def __getattr__(name: str) -> NoReturn:
    raise AttributeError(
        f"mujoco.{name}: MuJoCo is not installed, and what stands in for it here does not have that; pip install mujoco"
    )
