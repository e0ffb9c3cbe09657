"""The model that scripts see, ``env.model``: MuJoCo's own, or what stands for it; only its locks may be changed."""

from __future__ import annotations

import os
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np

from .. import _native
from ..standin import MUJOCO
from .beneath import Beneath
from .utils import JOINT_EQUALITY
from .views import ModelView

_CHECKED = ("body", "jnt", "dof", "geom", "site", "cam", "tendon", "actuator", "pair", "eq", "qpos")
_ALLOWED = frozenset({"eq_active0", "eq_data", "geom_rgba", "site_rgba"})
"""Arrays of the model that scripts may write to: those of locks are read back, colours are MuJoCo's own pictures' business."""


def mujoco_module() -> ModuleType | None:
    """Returns MuJoCo's bindings if they are installed; ``BABYBENCH_MUJOCO=off`` does without."""
    if os.environ.get(MUJOCO) == "off":
        return None
    try:
        import mujoco
    except ImportError:
        return None
    return None if getattr(mujoco, "stands_in", False) else mujoco


def _textures(xml: str) -> dict[str, ElementTree.Element]:
    found = ElementTree.fromstring(xml).iter("texture")
    return {texture.get("name", ""): texture for texture in found}


def _with_small_textures(config: dict[str, Any], xml: str, images: dict[str, bytes]) -> tuple[str, dict[str, bytes]]:
    """Replaces textures by the library's own of the same names: MIMo's take gigabytes of memory once they are decoded."""
    own_xml, own_images = _native.scene_file(config, None)
    own = _textures(own_xml)
    root = ElementTree.fromstring(xml)
    for parent in list(root.iter()):
        for index, texture in enumerate(list(parent)):
            replacement = own.get(texture.get("name", "")) if texture.tag == "texture" else None
            if replacement is not None and texture.get("name"):
                parent[index] = replacement
    named = {value for texture in root.iter("texture") for value in texture.attrib.values()}
    kept = {name: image for name, image in images.items() if name in named}
    return ElementTree.tostring(root, encoding="unicode"), {**kept, **own_images}


def mujoco_model(mujoco: ModuleType, core: Beneath) -> Any:
    """Compiles the scene of an environment with MuJoCo; pictures on surfaces are the library's small ones."""
    xml, images = _native.scene_file(core.config, core.assets)
    if core.assets is not None:
        xml, images = _with_small_textures(core.config, xml, images)
    model = mujoco.MjModel.from_xml_string(xml, images)
    model.vis.global_.offwidth, model.vis.global_.offheight = core.width, core.height
    if core.place is not None:
        model.body_pos[1] = core.place
        model.qpos0[:3] = model.qpos_spring[:3] = core.place
    if core.config["actuation_model"] == "muscle":
        # muscles take the place of the springs in the joints
        joints = core.mimo_joints
        model.jnt_stiffness[joints] = 0
        model.dof_damping[model.jnt_dofadr[joints]] /= 20
        model.actuator_forcelimited[:] = 0
    return model


def view_model(core: Beneath) -> ModelView:
    """Returns what stands for MuJoCo's model."""
    model = ModelView(core.blueprint)
    if core.place is not None:
        for name in ("body_pos", "qpos0", "qpos_spring"):
            array = np.array(getattr(model, name))
            (array[1] if array.ndim > 1 else array)[:3] = core.place
            array.flags.writeable = False
            model.__dict__[name] = array
    return model


class Watched:
    """A model that a script has, of which only locks may be changed."""

    def __init__(self, core: Beneath, model: Any) -> None:
        """Remembers what the model is."""
        self.core = core
        self.model = model
        self.locks = self._locks()
        names = (
            []
            if isinstance(model, ModelView)
            else [n for n in dir(model) if n.split("_")[0] in _CHECKED and n not in _ALLOWED]
        )
        if core.config["actuation_model"] == "muscle":
            names = [name for name in names if name != "actuator_gear"]
        self.arrays = {name: array.copy() for name in names if isinstance(array := getattr(model, name), np.ndarray)}
        self.gravity = np.array(model.opt.gravity)
        self.timestep = float(model.opt.timestep)

    def _locks(self) -> list[tuple[int, float]]:
        active = np.asarray(self.model.eq_active0).tolist()
        return list(zip(active, np.asarray(self.model.eq_data)[:, 0].tolist()))

    def check(self) -> None:
        """Applies changed locks to the engine.

        Raises:
            ValueError: Something else was changed.
        """
        changed = [name for name, array in self.arrays.items() if not np.array_equal(getattr(self.model, name), array)]
        if not np.array_equal(self.model.opt.gravity, self.gravity) or self.model.opt.timestep != self.timestep:
            changed.append("opt")
        if changed:
            raise ValueError(
                f"env.model was changed ({', '.join(changed)}), but the engine's model cannot be: change the configuration or "
                "the MJCF files that the scene includes, or run this with MuJoCo and the original kit"
            )
        now = self._locks()
        for number, (before, after) in enumerate(zip(self.locks, now)):
            if before != after:
                self._lock(number, *after)
        self.locks = now

    def _lock(self, number: int, active: int, angle: float) -> None:
        joint = self.model.equality(number).name
        if int(np.ravel(self.model.eq_type)[number]) != JOINT_EQUALITY or not joint:
            raise ValueError(
                f"equality {number} of env.model was changed; only joints that have a name can be locked and unlocked"
            )
        if active:
            self.core.engine.lock(joint, angle)
        else:
            self.core.engine.unlock(joint)


def make_model(core: Beneath) -> Any:
    """Makes the model that scripts see: MuJoCo's own where it is installed."""
    mujoco = mujoco_module()
    model = mujoco_model(mujoco, core) if mujoco is not None else view_model(core)
    active = np.asarray(core.parts.eq_active0)
    model.eq_active0[:] = active
    return model
