"""The state: :class:`MjData`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _native
from ..contacts import ContactList
from ..named import KINDS, PREFIX, Named, accessor, span
from .derived import matrix_places
from .enums import mjtSensor
from .model import Fields, MjModel, is_compiled, views
from .model_fields import EMPTY, NOT_OF_STATES, Absent, empty
from .options import MISSING
from .structs import StatList

_BODY = (
    "xpos",
    "xquat",
    "xmat",
    "xipos",
    "ximat",
    "subtree_com",
    "cinert",
    "cvel",
    "cacc",
    "cfrc_ext",
    "cfrc_int",
    "xfrc_applied",
)
_JOINT = ("xanchor", "xaxis")
_DOF = ("qvel", "qacc", "qacc_warmstart", "qacc_smooth", "cdof", "cdof_dot")
_ROWS = ("type", "id", "pos", "margin", "R", "D", "vel", "aref", "force")
_INPUTS = (
    *("qpos", "qvel", "act", "ctrl", "qfrc_applied", "xfrc_applied", "mocap_pos", "mocap_quat", "qacc_warmstart"),
)
_FLEXES = ("flexvert_xpos", "flexedge_length", "flexedge_velocity")
"""Positions of the vertices of flexes, lengths of their edges and the rates of these, as copies."""
_COUNTED = {"ne": (0,), "nf": (1, 2), "nl": (3, 4)}
"""Numbers of constraint rows by type."""


_SIMPLEST = "<mujoco><worldbody><body><geom size='1'/></body></worldbody></mujoco>"


class MjData(Named, metaclass=Fields):
    """A state of a model, under the names and in the shapes of MuJoCo's ``MjData``.

    The arrays keep their memory for the lifetime of the state. The next computation uses what was written into ``qpos``,
    ``qvel``, ``act``, ``ctrl``, ``qfrc_applied``, ``xfrc_applied``, ``mocap_pos``, ``mocap_quat``, ``qacc_warmstart``,
    ``eq_active`` and ``time``; the other arrays hold the results of the last one. Contacts, constraint rows and ``qM`` are
    fresh copies each time.
    """

    model: MjModel

    def __init__(self, model: MjModel) -> None:
        """Creates a state at the positions ``qpos0``, at rest, without computed quantities."""
        if not is_compiled(model):
            raise TypeError(
                f"MjData needs an MjModel of babybench.mujoco, not {type(model).__module__}.{type(model).__name__}; the state of "
                "an environment is env.data"
            )
        native = _native.PhysicsData(model._own)
        arrays = views(native.memory, [(name, shape) for name, _, shape in native.layout])
        clock = arrays.pop("time")
        arrays.update(
            userdata=np.zeros(model.nuserdata),
            energy=np.zeros(2),
            qfrc_inverse=np.zeros(model.nv),
            solver_fwdinv=np.zeros(2),
        )
        own = self.__dict__
        own.update(arrays)
        own.update(
            _own=native, _arrays={**arrays, "eq_active": native.eq_active}, _clock=clock, eq_active=native.eq_active
        )
        own.update(model=model, _names=model._names, _numbers=model._numbers, _start=None)
        own.update(_subtrees=(np.zeros((model.nbody, 3)), np.zeros((model.nbody, 3))), warning=StatList(8))

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return float(self._clock[0])

    @time.setter
    def time(self, value: float) -> None:
        self._clock[0] = value

    @property
    def contact(self) -> ContactList:
        """The contacts as they were last computed."""
        contacts = ContactList(self._own.contacts())
        columns = contacts._columns
        # only constraints with friction have `mu`; contacts in the gap are not constraints
        rubs = (columns["efc_address"] >= 0) & (columns["dim"] > 1)
        columns["mu"] = np.where(rubs, columns["mu"] / np.sqrt(self.model.opt.impratio), 0.0)
        columns["exclude"] = (columns["dist"] >= columns["includemargin"]).astype(np.int32)
        return contacts

    @property
    def ncon(self) -> int:
        """Number of contacts."""
        return int(self._own.counts[0])

    @property
    def nefc(self) -> int:
        """Number of constraint rows."""
        return int(self._own.counts[1])

    @property
    def qM(self) -> NDArray[np.float64]:
        """Joint-space inertia, in MuJoCo's sparse order (nM); :func:`mj_fullM` makes a full matrix of it."""
        matrix: NDArray[np.float64] = self._own.inertia()[matrix_places(self.model)]
        return matrix

    @property
    def ten_J(self) -> NDArray[np.float64]:
        """Jacobian of the lengths of tendons, (ntendon, nv)."""
        rates: NDArray[np.float64] = self._own.tendon_jacobian()
        return rates

    def __getattr__(self, name: str) -> Any:
        """Returns arrays of constraint rows, such as ``efc_force``, and numbers of rows."""
        if name.startswith("_") or "_own" not in self.__dict__:
            raise AttributeError(name)
        if name == "efc_J":
            if self._sparse():
                raise AttributeError(
                    "data.efc_J is stored densely here, where MuJoCo stores it sparsely for this model: set "
                    '<option jacobian="dense"/> in the document, with which it is the same in both'
                )
            return self._own.jacobian().reshape(-1)
        if name.startswith("efc_") and name[4:] in _ROWS:
            return self._own.rows()[name[4:]]
        if name in _FLEXES and self.model.nflex:
            return self._own.flexes()[name]
        if name in EMPTY:
            return empty(name, self.model.nflex, "data")
        if name in NOT_OF_STATES:
            return Absent(f"data.{name}")
        if name in _COUNTED:
            return int(np.isin(self._own.rows()["type"], _COUNTED[name]).sum())
        raise AttributeError(MISSING.format(name=f"data.{name}"))

    def __setattr__(self, name: str, value: Any) -> None:
        """Writes into an array."""
        if name == "time":
            self._clock[0] = value
        elif name in self._arrays:
            self._arrays[name][...] = value
        else:
            getattr(self, name)
            raise AttributeError(f"data.{name} is computed, and cannot be set")

    @property
    def subtree_linvel(self) -> NDArray[np.float64]:
        """Velocities of the centres of mass of subtrees, (nbody, 3), m/s, where a sensor or ``mj_subtreeVel`` computes them."""
        return self._velocities_of_subtrees()[0]

    @property
    def subtree_angmom(self) -> NDArray[np.float64]:
        """Angular momenta of subtrees about their centres of mass, (nbody, 3), kg m^2/s; see :attr:`subtree_linvel`."""
        return self._velocities_of_subtrees()[1]

    def _velocities_of_subtrees(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        kinds = (mjtSensor.mjSENS_SUBTREELINVEL, mjtSensor.mjSENS_SUBTREEANGMOM)
        if np.isin(self.model.sensor_type, kinds).any():
            for own, now in zip(self._subtrees, self._subtree_velocities()):
                own[...] = now
        subtrees: tuple[NDArray[np.float64], NDArray[np.float64]] = self._subtrees
        return subtrees

    def _subtree_velocities(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns velocities and angular momenta of subtrees from the current ``cvel``."""
        m = self.model
        masses, parents = np.asarray(m.body_mass)[:, None], np.asarray(m.body_parentid)
        offsets = self.xipos - self.subtree_com[m.body_rootid]
        velocity = self.cvel[:, 3:] + np.cross(self.cvel[:, :3], offsets)
        axes = self.ximat.reshape(-1, 3, 3)
        local = np.einsum("bji,bj->bi", axes, self.cvel[:, :3]) * m.body_inertia
        momentum, spin = masses * velocity, np.einsum("bij,bj->bi", axes, local)
        total = masses.copy()
        for body in range(m.nbody - 1, 0, -1):
            momentum[parents[body]] += momentum[body]
            total[parents[body]] += total[body]
        linear = momentum / np.maximum(1e-15, total)
        for body in range(m.nbody - 1, -1, -1):
            com = self.subtree_com[body]
            # of the body itself about the centre of its subtree
            spin[body] += np.cross(self.xipos[body] - com, m.body_mass[body] * (velocity[body] - linear[body]))
            if body:
                above = parents[body]
                spin[above] += spin[body]
                apart = com - self.subtree_com[above]
                spin[above] += np.cross(apart, total[body, 0] * (linear[body] - linear[above]))
        return linear, spin

    def __copy__(self) -> MjData:
        return MjData(self.model)._take(self)

    def _take(self, other: MjData) -> MjData:
        """Becomes a copy of another state of the model."""
        self._own.copy_from(other._own)
        for name in ("userdata", "energy", "qfrc_inverse", "solver_fwdinv"):
            self._arrays[name][...] = other._arrays[name]
        for own, its in zip(self._subtrees, other._subtrees):
            own[...] = its
        self.__dict__["_start"] = other._start
        return self

    def __deepcopy__(self, memo: Any) -> MjData:
        return MjData(self.model.__copy__())._take(self)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the model with the state. Derived quantities are recomputed on unpickling."""
        inputs = {name: np.array(self._arrays[name]) for name in (*_INPUTS, "userdata", "eq_active")}
        others = {name: np.array(array) for name, array in self._arrays.items() if name not in inputs}
        return _restored, (self.model, self.time, inputs, others)

    def __dir__(self) -> list[str]:
        names = [*self._arrays, *(f"efc_{name}" for name in (*_ROWS, "J")), *_COUNTED, *super().__dir__()]
        more = [
            name
            for name in EMPTY
            if name.startswith(("flexe", "flexv", "plugin_state", "plugin_data")) or name == "plugin"
        ]
        return sorted({name for name in [*names, *more, *NOT_OF_STATES] if not name.startswith("_")})

    @staticmethod
    def _of_instances() -> list[str]:
        return dir(MjData(MjModel.from_xml_string(_SIMPLEST)))

    def _sparse(self) -> bool:
        jacobian = self.model.opt.jacobian
        return bool(jacobian == 1 or (jacobian == 2 and self.model.nv >= 60))

    def _part(self, kind: str, number: int, name: str) -> Any:
        """Returns the part of an array that belongs to an element."""
        model, arrays = self.model, self._arrays
        if kind == "joint":
            if name == "qpos":
                return span(self.qpos, model.jnt_qposadr, number)
            if name in _JOINT:
                return arrays[name][number]
            if name in _DOF or (name.startswith("qfrc_") and name in arrays):
                return span(arrays[name], model.jnt_dofadr, number)
        elif kind == "sensor" and name == "data":
            first = model.sensor_adr[number]
            return self.sensordata[first : first + model.sensor_dim[number]]
        elif kind == "actuator":
            full = "ctrl" if name == "ctrl" else f"actuator_{name}"
            if full in arrays:
                return arrays[full][number : number + 1]
        elif kind == "tendon" and name in ("length", "velocity"):
            return arrays[f"ten_{name}"][number : number + 1]
        elif kind == "body" and name in _BODY:
            return arrays[name][number]
        elif name in ("xpos", "xmat") and kind in ("geom", "site", "camera"):
            return arrays[f"{PREFIX.get(kind, kind)}_{name}"][number]
        raise AttributeError(MISSING.format(name=f"data.{kind}(...).{name}"))

    def _compute(self, *groups: str) -> None:
        self._own.forward(sum(_native.PhysicsData.GROUPS[group] for group in groups))


def _restored(model: MjModel, time: float, inputs: dict[str, NDArray[Any]], others: dict[str, NDArray[Any]]) -> MjData:
    """Restores a pickled state."""
    data = MjData(model)
    for name, values in inputs.items():
        data._arrays[name][...] = values
    data.time = time
    if others["xquat"].any():
        # contacts and constraint rows are not arrays
        data._compute("input", "constraints")
    for name, values in {**others, **inputs}.items():
        data._arrays[name][...] = values
    data.time = time
    return data


for _name, _kind in {**KINDS, "ten": "tendon"}.items():
    if _kind not in ("texture", "material", "equality"):
        setattr(MjData, _name, accessor(_kind))
