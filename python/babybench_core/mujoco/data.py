"""The state: :class:`MjData`."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .. import _native
from ..contacts import ContactList
from ..named import KINDS, PREFIX, Named, accessor, span
from .model import MjModel, is_compiled, matrix_places, views
from .options import MISSING

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
_COUNTED = {"ne": (0,), "nf": (1, 2), "nl": (3, 4)}
"""Counts that MuJoCo keeps of the rows of constraints, by their types."""


class MjData(Named):
    """A state of a model, under the names and in the shapes of MuJoCo's ``MjData``.

    The arrays are the same memory for as long as the state lives: what is written into ``qpos``, ``qvel``, ``act``,
    ``ctrl``, ``qfrc_applied``, ``xfrc_applied``, ``mocap_pos``, ``mocap_quat``, ``qacc_warmstart``, ``eq_active`` and
    ``time`` counts from the next computation on, and the others show what the last one found. Contacts, rows of
    constraints and ``qM`` are fresh copies each time.
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
        arrays.update(userdata=np.zeros(model.nuserdata))
        own = self.__dict__
        own.update(arrays)
        own.update(
            _own=native, _arrays={**arrays, "eq_active": native.eq_active}, _clock=clock, eq_active=native.eq_active
        )
        own.update(model=model, _names=model._names, _numbers=model._numbers, _start=None)

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
        # only what is a constraint with friction has one, and what is none lies in the gap
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
        """Number of rows of constraints."""
        return int(self._own.counts[1])

    @property
    def qM(self) -> NDArray[np.float64]:
        """Inertia in joint space, in MuJoCo's sparse order (nM); :func:`mj_fullM` makes a matrix of it."""
        matrix: NDArray[np.float64] = self._own.inertia()[matrix_places(self.model)]
        return matrix

    @property
    def ten_J(self) -> NDArray[np.float64]:
        """Rates of the lengths of tendons by velocities, (ntendon, nv)."""
        m = self.model
        rates = np.zeros((m.ntendon, m.nv))
        tendons = np.repeat(np.arange(m.ntendon), m.tendon_num)
        np.add.at(rates, (tendons, m.jnt_dofadr[m.wrap_objid]), m.wrap_prm)
        return rates

    def __getattr__(self, name: str) -> Any:
        """Returns rows of constraints, ``efc_force`` and the like, and numbers of them."""
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

    def __copy__(self) -> MjData:
        return MjData(self.model)._take(self)

    def _take(self, other: MjData) -> MjData:
        """Becomes a copy of another state of the model."""
        self._own.copy_from(other._own)
        self.userdata[:] = other.userdata
        self.__dict__["_start"] = other._start
        return self

    def __deepcopy__(self, memo: Any) -> MjData:
        return self.__copy__()

    def __reduce__(self) -> NoReturn:
        raise TypeError("cannot pickle a state: pickle what mj_getState writes, and put it back with mj_setState")

    def __dir__(self) -> list[str]:
        names = [*self._arrays, *(f"efc_{name}" for name in (*_ROWS, "J")), *_COUNTED, *super().__dir__()]
        return sorted({name for name in names if not name.startswith("_")})

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


for _name, _kind in {**KINDS, "ten": "tendon"}.items():
    if _kind not in ("texture", "material", "equality"):
        setattr(MjData, _name, accessor(_kind))
