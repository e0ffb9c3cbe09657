"""The state that scripts hold, ``env.data``: kept up to date while somebody holds it, and read back where it was written to."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from .. import _native
from ..standin import MUJOCO
from .utils import JOINT_EQUALITY
from .views import DataView, ModelView

if TYPE_CHECKING:
    from .core import Core

_STATE = ("qpos", "qvel", "ctrl", "act", "qfrc_applied")
"""What can be written to: the bits of ``Parts.differences``."""

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


# --- models ---


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


def mujoco_model(mujoco: ModuleType, core: Core) -> Any:
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


def view_model(core: Core) -> ModelView:
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

    def __init__(self, core: Core, model: Any) -> None:
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


# --- states ---


class Live:
    """A state that a script may hold."""

    data: Any
    stale = True

    def __init__(self, core: Core) -> None:
        """Belongs to an environment."""
        self.core = core
        self.idle = 0

    def held(self) -> bool:
        """Tells whether anybody but the environment holds the state or one of its arrays."""
        raise NotImplementedError

    def refresh(self) -> None:
        """Brings the state up to date."""
        raise NotImplementedError

    def changed(self) -> None:
        """Takes note that the engine's state is another one."""
        self.stale = True
        if self.held():
            self.refresh()

    def pull(self) -> None:
        """Reads back what a script has written."""
        if self.stale:
            return
        data, parts, engine = self.data, self.core.parts, self.core.engine
        bits = parts.differences(self.state)
        if not bits:
            return
        if bits & 0b11:
            forwarded = not np.array_equal(data.xpos, engine.state_array("xpos"))
            (parts.forward if forwarded else parts.set_position)(data.qpos, data.qvel)
        for bit, name in ((4, "ctrl"), (8, "act"), (16, "qfrc_applied")):
            if bits & bit:
                engine.write_state(name, getattr(data, name))
        self.core.forget()

    @property
    def state(self) -> list[Any]:
        """Returns the arrays that can be written to."""
        return [getattr(self.data, name) for name in _STATE]


class MujocoLive(Live):
    """MuJoCo's own state, with positions and contacts computed by MuJoCo and forces by the engine."""

    def __init__(self, core: Core, mujoco: ModuleType) -> None:
        """Makes a state of the environment's model."""
        super().__init__(core)
        self.mujoco = mujoco
        self.data = mujoco.MjData(core.model)
        self.model = core.model
        self.arrays = [getattr(self.data, name) for name in core.parts.FILLED]
        self._state = [getattr(self.data, name) for name in _STATE]
        self.muscle = core.config["actuation_model"] == "muscle"
        self.refresh()
        self.idle = self._references()

    def _references(self) -> int:
        # MuJoCo's arrays are the same objects each time, and do not hold the state
        return sys.getrefcount(self.data) + sum(map(sys.getrefcount, self.arrays))

    @property
    def state(self) -> list[Any]:
        """Returns the arrays that can be written to."""
        return self._state

    def held(self) -> bool:
        """Tells whether anybody but the environment holds the state or one of its arrays."""
        return self._references() > self.idle

    def refresh(self) -> None:
        """Brings the state up to date."""
        data, model, parts, mujoco = self.data, self.model, self.core.parts, self.mujoco
        data.qpos[:], data.qvel[:] = parts.start
        data.eq_active[:] = parts.eq_active
        if self.muscle:
            model.actuator_gear[:, 0] = parts.gear
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        parts.fill(self.arrays)
        data.time = self.core.engine.time
        forces = parts.efc_force
        if len(forces) == data.nefc:
            data.efc_force[:] = forces
        self.stale = False

    def pull(self) -> None:
        """Reads back what a script has written."""
        if not self.stale and self.data.xfrc_applied.any():
            raise ValueError(
                "data.xfrc_applied is not served: turn the force into a generalised one with "
                "mujoco.mj_applyFT(model, data, force, torque, point, body, data.qfrc_applied)"
            )
        super().pull()


class ViewLive(Live):
    """What stands for MuJoCo's state."""

    def __init__(self, core: Core) -> None:
        """Makes a state of the environment's model."""
        super().__init__(core)
        engine, parts = core.engine, core.parts
        shapes = {name: np.shape(engine.state_array(name)) for name in parts.FILLED}
        self.data = DataView(engine, core.model, shapes)
        self.data.__dict__["_sync"] = self
        self.arrays = list(self.data._arrays.values())
        self._act = np.zeros(0)
        self.refresh()
        self.idle_data = sys.getrefcount(self.data)
        self.idle = sys.getrefcount(self.data._memory)

    @property
    def state(self) -> list[Any]:
        """Returns the arrays that can be written to."""
        arrays = self.data._arrays
        return [arrays[name] if name != "act" else self._act for name in _STATE]

    def held(self) -> bool:
        """Tells whether anybody but the environment holds the state or one of its arrays."""
        return sys.getrefcount(self.data) > self.idle_data or sys.getrefcount(self.data._memory) > self.idle

    def refresh(self) -> None:
        """Brings the state up to date."""
        own = self.data.__dict__
        self.core.parts.fill(self.arrays)
        own["time"] = self.core.engine.time
        own["_contacts"] = None
        self.stale = False

    def forward(self) -> None:
        """Computes everything at the positions and velocities that a script has written: ``mujoco.mj_forward``."""
        self.core.parts.forward(self.data.qpos, self.data.qvel)
        self.core.forget()
        self.refresh()


def make_live(core: Core) -> Live:
    """Makes the state that scripts hold: MuJoCo's own where it is installed."""
    mujoco = mujoco_module()
    return MujocoLive(core, mujoco) if mujoco is not None and not isinstance(core.model, ModelView) else ViewLive(core)


def make_model(core: Core) -> Any:
    """Makes the model that scripts see: MuJoCo's own where it is installed."""
    mujoco = mujoco_module()
    model = mujoco_model(mujoco, core) if mujoco is not None else view_model(core)
    active = np.asarray(core.parts.eq_active0)
    model.eq_active0[:] = active
    return model


def assets_folder() -> Path:
    """Returns a folder with the library's assets, which is written on first use: ``babybench/*.xml`` and ``tex/*.png``."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    folder = Path(base) / "babybench" / _native.__version__ / "assets"
    try:
        _write_assets(folder)
    except OSError:
        # no home that can be written to
        import tempfile

        user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
        folder = Path(tempfile.gettempdir()) / f"babybench-{user}-{_native.__version__}" / "assets"
        _write_assets(folder)
    return folder


def _write_assets(folder: Path) -> None:
    for name, content in _native.embedded_files().items():
        path = folder / name
        if path.is_file() and path.stat().st_size == len(content):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        # another process may write the same
        part = path.with_name(f"{path.name}.{os.getpid()}")
        part.write_bytes(content)
        part.replace(path)
