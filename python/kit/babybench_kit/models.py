"""The model that scripts see, ``env.model``: MuJoCo's own, or its stand-in."""

from __future__ import annotations

import os
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native
from babybench_core.looks import LOOKS, is_look
from babybench_core.mujoco.model import _fixed

from .beneath import Beneath
from .flat import flat
from .looks import VISUAL, visual_arrays, visual_numbers
from .standin import MUJOCO
from .utils import JOINT_EQUALITY
from .views import ModelView

_CHECKED = (
    *("body", "jnt", "dof", "geom", "site", "cam", "light", "tendon", "actuator", "pair", "eq", "qpos0", "qpos"),
    *("mat", "tex", "mesh", "skin", "hfield"),
)
_ALLOWED = frozenset({"eq_active0", "eq_data", "tex_data"})
"""Arrays that scripts may write to, too: those of locks, which are read back; and pixels, too many to compare."""


def mujoco_module() -> ModuleType | None:
    """Returns MuJoCo's bindings if they are installed, unless ``BABYBENCH_MUJOCO=off``."""
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


def _grow(model: Any, core: Beneath) -> None:
    """Copies the engine's numbers for MIMo at another age to MuJoCo's model of a document."""
    for name in core.blueprint.MODEL_ARRAYS:
        own, array = getattr(model, name, None), np.asarray(core.blueprint.model_array(name))
        if name == "actuator_gear":
            model.actuator_gear[:, 0] = array
        elif isinstance(own, np.ndarray) and own.shape == array.shape and own.dtype.kind == "f":
            own[...] = array


def compiled(mujoco: ModuleType, core: Beneath) -> Any:
    """Compiles the scene of an environment with MuJoCo; pictures on surfaces are the library's small ones."""
    if core.document is not None and core.document.path is not None:
        root = flat(core.document.path)
        xml, images = _with_small_textures({}, ElementTree.tostring(root, encoding="unicode"), {})
    else:
        xml, images = _native.scene_file(core.config, core.assets)
        if core.assets is not None:
            xml, images = _with_small_textures(core.config, xml, images)
    model = mujoco.MjModel.from_xml_string(xml, images)
    if core.document is not None and core.config["age"] is not None:
        _grow(model, core)
    return model


def mujoco_model(mujoco: ModuleType, core: Beneath, model: Any) -> Any:
    """Applies an environment's changes to a compiled model of MuJoCo."""
    # the defaults of MuJoCo 3.3.0, whose contacts the engine has
    for name in ("mjDSBL_MULTICCD", "mjDSBL_ISLAND"):
        model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, name, 0))
    model.opt.ccd_iterations = 50
    model.vis.global_.offwidth, model.vis.global_.offheight = core.width, core.height
    if core.place is not None:
        model.body_pos[1] = core.place
        model.qpos0[:3] = model.qpos_spring[:3] = core.place
    if core.config["actuation_model"] == "muscle":
        # muscles replace the springs in the joints
        joints = core.mimo_joints
        model.jnt_stiffness[joints] = 0
        model.dof_damping[model.jnt_dofadr[joints]] /= 20
        model.actuator_forcelimited[:] = 0
    return model


def view_model(core: Beneath) -> ModelView:
    """Returns the stand-in for MuJoCo's model."""
    model = ModelView(core.blueprint, core.engine, core.width, core.height)
    if core.place is not None:
        model.body_pos[1] = core.place
        for name in ("qpos0", "qpos_spring"):
            array = np.array(getattr(model, name))
            array[:3] = core.place
            model.__dict__[name] = _fixed(array, name)
    return model


class Watched:
    """A model that a script holds: what it writes goes to the engine before the next step, or is refused."""

    def __init__(self, core: Beneath, model: Any) -> None:
        """Stores the model's current contents."""
        self.core = core
        self.model = model
        self.locks = self._locks()
        # muscles set the gears in each step
        muscles = core.config["actuation_model"] == "muscle"
        free = [name for name in _native.CHANGEABLE if not (muscles and name == "actuator_gear")]
        self.names = [name for name in (*free, *sorted(LOOKS)) if isinstance(_get(model, name), np.ndarray)]
        """Arrays that can change."""
        self.changeable = [_get(model, name) for name in self.names]
        for name, array in visual_arrays(model).items():
            self.names.append(name)
            self.changeable.append(array)
        self.watch = _native.Watch(self.changeable)
        self.seen = [array.copy() for array in self.changeable]
        self.option_names = [name for name in free if name not in self.names]
        self.options = self._options()
        self.visual = visual_numbers(model)
        self.fixed = {} if isinstance(model, ModelView) else self._fix()
        self.fixed_options = {} if isinstance(model, ModelView) else self._other_options()

    def _fix(self) -> dict[str, NDArray[Any]]:
        """Makes MuJoCo's other arrays read-only, and stores their contents, because there are other ways to write to them."""
        fixed = {}
        for name in dir(self.model):
            free = name in _ALLOWED or name in LOOKS or name in _native.CHANGEABLE
            known = name.split("_")[0] in _CHECKED and not free
            array = getattr(self.model, name) if known else None
            if isinstance(array, np.ndarray):
                fixed[name] = array.copy()
                array.flags.writeable = False
        return fixed

    def _options(self) -> tuple[float, ...]:
        opt = self.model.opt
        return tuple(getattr(opt, name[4:]) for name in self.option_names)

    def _other_options(self) -> dict[str, Any]:
        """Returns MuJoCo's other options, which cannot be made read-only."""
        opt, known = self.model.opt, {name[4:] for name in self.option_names + self.names}
        values = {name: getattr(opt, name) for name in dir(opt) if not name.startswith("_") and name not in known}
        return {name: np.array(value) for name, value in values.items() if isinstance(value, (int, float, np.ndarray))}

    def follow(self) -> None:
        """Passes a script's changes to the model to the engine.

        Raises:
            ValueError: Numbers that the engine does not have, that are not finite or too small.
        """
        options, changed = self._options(), self.watch.changed(self.changeable)
        visual = visual_numbers(self.model)
        if not changed and options == self.options and visual == self.visual:
            return
        engine = self.core.engine
        self._paint(changed, visual)
        changes = {
            name: np.asarray(now, np.float64)
            for name, now, before in zip(self.option_names, options, self.options)
            if now != before
        }
        for number in changed:
            name, now = self.names[number], self.changeable[number]
            if is_look(name):
                continue
            whole = engine.model_array(name)
            # unchanged numbers may differ in their last bits in MuJoCo
            written = now != self.seen[number]
            if name == "actuator_gear":
                if written[:, 1:].any():
                    raise ValueError("actuator_gear: the engine has only the first number of each row")
                now, written = now[:, 0], written[:, 0]
            whole[written] = now[written]
            changes[name] = whole
        if changes:
            engine.change_model(changes)
        self.options = options
        self.seen = [array.copy() for array in self.changeable]
        self.core.timestep = engine.dt / self.core.config["frame_skip"]

    def _paint(self, changed: list[int], visual: tuple[float, ...]) -> None:
        """Passes a script's changes to the model's appearance to the engine."""
        numbers = [number for number in changed if is_look(self.names[number])]
        looks: dict[str, Any] = {}
        if visual != self.visual:
            looks = {f"vis_{name}": np.array(value) for name, value in zip(VISUAL, visual)}
        if numbers:
            present = _native.model_columns(self.core.engine)
        for number in numbers:
            name, now = self.names[number], self.changeable[number]
            whole = present[name].reshape(now.shape)
            written = now != self.seen[number]
            whole[written] = now[written]
            looks[name] = whole
        if looks:
            _native.paint(self.core.engine, looks)
        self.visual = visual

    def show(self, changes: dict[str, NDArray[Any]]) -> None:
        """Copies to the model what the engine has changed by itself."""
        for name, array in changes.items():
            _put(self.model, name, np.asarray(array))
        self.watch.changed(self.changeable)
        self.seen = [array.copy() for array in self.changeable]
        self.options = self._options()

    def _locks(self) -> list[tuple[int, list[float]]]:
        active = np.asarray(self.model.eq_active0).tolist()
        return list(zip(active, np.asarray(self.model.eq_data).tolist()))

    def check(self) -> None:
        """Applies changes, and changed locks, to the engine.

        Raises:
            ValueError: Something else was changed.
        """
        self.follow()
        changed = [name for name, array in self.fixed.items() if not np.array_equal(getattr(self.model, name), array)]
        opt, options = self.model.opt, self.fixed_options.items()
        changed += [f"opt.{name}" for name, value in options if not np.array_equal(getattr(opt, name), value)]
        if changed:
            raise ValueError(
                f"env.model was changed ({', '.join(changed)}), but what the engine takes over are "
                f"{', '.join((*_native.CHANGEABLE, *sorted(LOOKS)))}: for the rest change the configuration or the MJCF files "
                "that the scene includes, or run this with MuJoCo and the original kit"
            )
        now = self._locks()
        for number, (before, after) in enumerate(zip(self.locks, now)):
            if before != after:
                self._lock(number, before, after)
        if now != self.locks:
            _native.set_equalities(self.core.engine, [bool(active) for active, _ in now])
        self.locks = now

    def _lock(self, number: int, before: tuple[int, list[float]], after: tuple[int, list[float]]) -> None:
        """Moves the lock of a joint; whether constraints are active is set for all of them together."""
        joint, (active, data) = self.model.equality(number).name, after
        if data == before[1] and not active:
            return
        kind, second = (int(np.ravel(array)[number]) for array in (self.model.eq_type, self.model.eq_obj2id))
        # without a second joint, MuJoCo reads the first number only
        is_lock = bool(joint) and kind == JOINT_EQUALITY and second < 0
        if data != before[1] and not is_lock:
            raise ValueError(
                f"eq_data of equality {number} of env.model was changed; what can be written are eq_active0, and the first "
                "number of eq_data of a joint with a name"
            )
        if is_lock:
            self.core.engine.lock(joint, data[0])


def make_model(core: Beneath) -> Any:
    """Makes the model that scripts see: MuJoCo's own where it is installed."""
    mujoco = mujoco_module()
    # MuJoCo has not seen a document that a program has compiled with the engine
    shown = mujoco is None or (core.document is not None and core.document.path is None)
    model = view_model(core) if mujoco is None or shown else mujoco_model(mujoco, core, compiled(mujoco, core))
    active = np.asarray(core.parts.eq_active0).astype(model.eq_active0.dtype)
    model.eq_active0[:] = active
    for name, array in core.engine.model_changes.items():
        _put(model, name, array)  # of the environment that this one is a copy of
    return model


def _get(model: Any, name: str) -> Any:
    """Returns an array of a model, or one of its options."""
    return getattr(model.opt, name[4:]) if name.startswith("opt.") else getattr(model, name)


def _put(model: Any, name: str, array: NDArray[Any]) -> None:
    """Writes an array of a model, or one of its options."""
    if name == "actuator_gear":
        model.actuator_gear[:, 0] = array
    elif name.startswith("opt.") and not array.ndim:
        setattr(model.opt, name[4:], float(array))
    else:
        _get(model, name)[:] = array
