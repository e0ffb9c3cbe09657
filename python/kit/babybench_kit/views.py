"""Stand-ins for MuJoCo's ``MjModel`` and ``MjData`` where MuJoCo is not installed.

Names, shapes, number types and units are MuJoCo's. The arrays of a state show the current instant after every step; ``qpos``,
``qvel``, ``ctrl``, ``qfrc_applied``, ``xfrc_applied`` and those of mocap bodies can be written. In a model these can be
written: ``eq_active0`` and ``eq_data``, which lock joints; values that the next step uses (gravity, timestep, mass, inertia,
size, poses, friction, damping, stiffness, armature, gears, softness); and values that the next picture shows (colours, groups,
materials, lights, fields of view).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native
from babybench_core.contacts import ContactList
from babybench_core.looks import LOOKS
from babybench_core.mujoco.data import MjData
from babybench_core.mujoco.model import MjModel, _fixed
from babybench_core.mujoco.options import Settings, visual, with_rows
from babybench_core.named import KINDS as _KINDS
from babybench_core.named import PREFIX as _PREFIX
from babybench_core.named import Named as _Named
from babybench_core.named import accessor as _accessor
from babybench_core.named import numbers as _numbers
from babybench_core.named import span as _span
from babybench_core.named import widened as _widened

from .view_renderer import ViewRenderer

_MODEL_HELP = (
    "{name}: the stand-in for MjModel does not have it; install mujoco (pip install mujoco), "
    "and env.model is MuJoCo's own"
)
_DATA_HELP = (
    "{name}: the stand-in for MjData does not have it; install mujoco (pip install mujoco) and env.data is MuJoCo's own"
)
_FIXED = "the engine's model cannot be changed: {name}; change the configuration or the MJCF files of the scene and make another"

# what MuJoCo stores differently from the engine
_BYTES = frozenset(
    {
        "jnt_limited",
        "eq_active0",
        "tendon_limited",
        "actuator_ctrllimited",
        "actuator_forcelimited",
    }
)
_SINGLES = frozenset({"geom_rgba", "site_rgba"})
_WIDTHS = {"actuator_gear": 6, "actuator_gainprm": 10, "actuator_biasprm": 10}
_SIZES = {
    "nq": "nq",
    "nv": "nv",
    "nu": "nu",
    "nbody": "nbody",
    "njnt": "njnt",
    "ngeom": "ngeom",
    "nsite": "nsite",
    "ncam": "ncam",
    "neq": "neq",
    "ntendon": "ntendon",
    "nsensor": "nsensor",
    "nsensordata": "nsensordata",
    "npair": "npair",
}
_WRITABLE = frozenset({"eq_active0", "eq_data"}).union(_native.CHANGEABLE, LOOKS)
OPTIONS = tuple(name[4:] for name in _native.CHANGEABLE if name.startswith("opt."))
"""The options that can be written."""


class Options:
    """The options of a model, ``model.opt``."""

    def __init__(self, values: dict[str, Any]) -> None:
        """Copies the values."""
        self.__dict__.update(values)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in OPTIONS:
            raise AttributeError(_FIXED.format(name=f"opt.{name}"))
        if isinstance(self.__dict__[name], np.ndarray):
            self.__dict__[name][...] = value
        else:
            self.__dict__[name] = float(value)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(_MODEL_HELP.format(name=f"opt.{name}"))


class ModelView(_Named):
    """The compiled scene under the names of ``MjModel``."""

    _renderer = ViewRenderer

    def __init__(self, blueprint: _native.Blueprint, engine: _native.Env, width: int, height: int) -> None:
        """Takes the scene of a blueprint as an environment has it, and the largest size of its pictures, pixels."""
        own = self.__dict__
        options = dict(blueprint.model_options)
        extras = _native.model_extras(blueprint)
        names = {kind: list(names) for kind, names in blueprint.model_names.items()}
        names.update(texture=extras["texture"], material=extras["material"])
        own["_names"] = names
        own["_numbers"] = _numbers(names)
        own["_blueprint"] = blueprint
        own["_chains"] = {}
        own.update({name: int(options[key]) for name, key in _SIZES.items()})
        own.update(
            na=0,
            nmocap=options["nmocap"],
            nlight=extras["nlight"],
            ntex=len(names["texture"]),
            nmat=len(names["material"]),
        )
        own.update({name: array for name, array in extras.items() if name.startswith("eq_")})
        columns = with_rows(_native.model_columns(engine), {})
        own.update({name: columns[name] for name in LOOKS})
        own["vis"] = visual(columns, width, height)
        statistics = {name: options[name] for name in ("extent", "meaninertia", "meanmass", "meansize")}
        own["stat"] = Settings("stat", {**statistics, "center": _fixed(options["center"], "stat.center")})
        keys = ("iterations", "tolerance", "ls_iterations", "ls_tolerance", "ccd_iterations", "ccd_tolerance")
        own["opt"] = Options({key: options[key] for key in (*keys, *OPTIONS)})

    def __getattr__(self, name: str) -> Any:
        """Returns an array by MuJoCo's name; it is read once."""
        if name.startswith("_"):
            raise AttributeError(name)
        array = self._derived(name)
        if array is None:
            if name not in self._blueprint.MODEL_ARRAYS:
                raise AttributeError(_MODEL_HELP.format(name=name))
            array = np.asarray(self._blueprint.model_array(name))
            if name in _BYTES:
                array = array.astype(np.uint8)
            elif name in _SINGLES:
                array = array.astype(np.float32)
            elif name in _WIDTHS:
                array = _widened(array, _WIDTHS[name])
        # writable arrays own their numbers
        array = array.copy() if name in _WRITABLE else _fixed(array, name)
        self.__dict__[name] = array
        return array

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in _WRITABLE:
            raise AttributeError(_FIXED.format(name=name))
        getattr(self, name)[...] = value

    def _derived(self, name: str) -> NDArray[Any] | None:
        """Returns arrays that MuJoCo has and the engine keeps in another form."""
        read = self._blueprint.model_array
        if name == "dof_M0":
            return np.asarray(read("dof_m0"))
        if name == "sensor_dim":
            return np.full(self.nsensor, 3, dtype=np.int32)
        if name == "actuator_trnid":
            return np.stack([np.asarray(read(name)), np.full(self.nu, -1, np.int32)], axis=1)
        if name in ("pair_geom1", "pair_geom2"):
            return np.array(read("pair_geom")[:, int(name[-1]) - 1])
        return None

    def _part(self, kind: str, number: int, name: str) -> NDArray[Any]:
        """Returns the part of an array that belongs to an element."""
        if kind == "joint" and name in ("qpos0", "qpos_spring"):
            return _span(getattr(self, name), self.jnt_qposadr, number)
        if kind == "joint" and name in ("armature", "damping", "frictionloss", "invweight0", "M0"):
            return _span(getattr(self, f"dof_{name}"), self.jnt_dofadr, number)
        array: NDArray[Any] = getattr(self, f"{_PREFIX.get(kind, kind)}_{name}")
        return array[number] if array.ndim > 1 else array[number : number + 1]


_DATA_FIELDS = {
    "body": ("xpos", "xquat", "xmat", "xipos", "ximat", "subtree_com", "cvel", "cacc", "cfrc_ext", "cfrc_int"),
    "geom": ("xpos", "xmat"),
    "site": ("xpos", "xmat"),
    "camera": ("xpos", "xmat"),
}
_JOINT_ROWS = ("xanchor", "xaxis")


class DataView(_Named):
    """The current state under the names of ``MjData``."""

    def __init__(self, env: _native.Env, model: ModelView, shapes: dict[str, tuple[int, ...]]) -> None:
        """Allocates all arrays as one block, whose reference count shows whether a program holds any of them."""
        own = self.__dict__
        sizes = {name: int(np.prod(shape)) for name, shape in shapes.items()}
        memory = np.zeros(sum(sizes.values()))
        arrays, at = {}, 0
        for name, shape in shapes.items():
            # two empty arrays at one place could not be written to together
            arrays[name] = memory[at : at + sizes[name]].reshape(shape) if sizes[name] else np.zeros(shape)
            at += sizes[name]
        own.update(model=model, _names=model._names, _numbers=model._numbers, _env=env, _memory=memory, _arrays=arrays)
        own.update(time=0.0, act=np.zeros(0), _sync=None)
        own["_contacts"] = None

    def __getattr__(self, name: str) -> Any:
        """Returns a view of an array."""
        arrays = self.__dict__.get("_arrays", {})
        if name in arrays:
            return arrays[name][...]
        raise AttributeError(_DATA_HELP.format(name=name))

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "eq_active":
            raise AttributeError(
                "data.eq_active cannot be written: write model.eq_active0, which takes effect at the next reset"
            )
        if name not in self._arrays:
            raise AttributeError(f"{name} of the state cannot be replaced")
        self._arrays[name][...] = value

    def _compute(self, *_: str) -> None:
        """Computes everything at the positions and velocities that a script has written, for the functions of MuJoCo."""
        self._sync.forward()

    @property
    def _own(self) -> Any:
        """Returns the engine that the functions of MuJoCo advance."""
        return self._sync

    @property
    def eq_active(self) -> NDArray[np.uint8]:
        """Returns which equality constraints are active; ``model.eq_active0`` sets them at the next reset."""
        active, parts = np.zeros(self.model.neq, np.uint8), self._sync.core.parts
        parts.fill_start(active, [np.zeros(self.model.nq), np.zeros(self.model.nv)])
        active.flags.writeable = False
        return active

    @property
    def contact(self) -> ContactList:
        """Returns the contacts at the start of the last physics step."""
        if self._contacts is None:
            self.__dict__["_contacts"] = ContactList(self._env.contacts())
        contacts: ContactList = self._contacts
        if self._sync is not None:
            self._sync.core.show_normals(contacts.frame)
        return contacts

    @property
    def ncon(self) -> int:
        """Returns the number of contacts."""
        return len(self.contact)

    def _part(self, kind: str, number: int, name: str) -> Any:
        """Returns the part of an array that belongs to an element."""
        arrays = self._arrays
        if kind == "joint":
            if name == "qpos":
                return _span(self.qpos, self.model.jnt_qposadr, number)
            if name in _JOINT_ROWS:
                return arrays[name][number]
            return _span(getattr(self, name), self.model.jnt_dofadr, number)
        if kind == "sensor" and name == "data":
            first = self.model.sensor_adr[number]
            return self.sensordata[first : first + 3]
        if kind == "actuator":
            full = "ctrl" if name == "ctrl" else f"actuator_{name}"
            return getattr(self, full)[number : number + 1]
        if name not in _DATA_FIELDS.get(kind, ()):
            raise AttributeError(_DATA_HELP.format(name=f"{kind}(...).{name}"))
        full = name if kind == "body" else f"{_PREFIX.get(kind, kind)}_{name}"
        return arrays[full][number]


for _name, _kind in _KINDS.items():
    setattr(ModelView, _name, _accessor(_kind))
    if _kind not in ("texture", "material", "equality", "tendon"):
        setattr(DataView, _name, _accessor(_kind))

MjModel.register(ModelView)
MjData.register(DataView)
