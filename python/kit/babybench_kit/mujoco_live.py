"""MuJoCo's own state, ``env.data`` where MuJoCo is installed: the engine's numbers in MuJoCo's arrays.

MuJoCo computes what the engine does not have under MuJoCo's names, above all contacts and constraints: when a script first
requests it, and from then on with every step.
"""

from __future__ import annotations

import copy
import sys
import weakref
from collections.abc import Callable
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np

from .beneath import Beneath
from .course import Copy
from .live import STATE, Live

_POSITION = ("mj_comPos", "mj_camlight", "mj_tendon", "mj_crb", "mj_factorM", "mj_transmission", "mj_comVel")
"""Stages that follow from poses and are cheap."""

_CONSTRAINT = ("mj_collision", "mj_makeConstraint", "mj_island", "mj_projectConstraint", "mj_fwdVelocity")
"""Stages that are expensive: contacts, constraints, and what follows from them."""

_CONSTRAINED = ("ncon", "contact", "ne", "nf", "nl", "nJ", "nA", "nefc", "nisland", "actuator_velocity", "ten_velocity")
_PREFIXES = ("efc_", "iefc_", "island_", "map_", "dof_island", "tree_island")


@lru_cache(maxsize=1)
def data_class(mujoco: ModuleType) -> Any:
    """Returns MuJoCo's class of states, with contacts and constraints that are computed when they are first read."""
    base = mujoco.MjData

    def completed(method: Callable[..., Any]) -> Callable[..., Any]:
        def call(self: Any, *args: Any) -> Any:
            live = self._live()
            if live is not None:
                live.complete()
            return method(self, *args)

        call.__doc__ = method.__doc__
        return call

    contact = completed(base.contact.fget)

    def shown(self: Any) -> Any:
        found, live = contact(self), self._live()
        if live is not None:
            live.show_normals(found)
        return found

    names = [
        name
        for name, member in vars(base).items()
        if isinstance(member, property) and (name in _CONSTRAINED or name.startswith(_PREFIXES))
    ]
    own: dict[str, Any] = {}
    for name in names:
        member = getattr(base, name)
        own[name] = property(completed(member.fget), member.fset, doc=member.__doc__)
    own["contact"] = property(shown, base.contact.fset, doc=base.contact.__doc__)
    for name in ("actuator", "tendon", "ten", "__copy__", "__deepcopy__"):
        if hasattr(base, name):
            own[name] = completed(getattr(base, name))
    # a copy, and so a pickle, is a plain state of MuJoCo's
    own["__reduce_ex__"] = lambda self, protocol: (copy.copy, (self.__copy__(),))
    return type(base.__name__, (base,), {**own, "__module__": base.__module__, "__doc__": base.__doc__})


class MujocoLive(Live):
    """MuJoCo's own state."""

    def __init__(self, core: Beneath, mujoco: ModuleType) -> None:
        """Makes a state of the environment's model."""
        super().__init__(core)
        self.model = core.model
        self.data = data_class(mujoco)(core.model)
        self.data._live = weakref.ref(self)
        self.position = [getattr(mujoco, name) for name in _POSITION]
        self.constraint = [getattr(mujoco, name) for name in _CONSTRAINT]
        self._solve = mujoco.mj_fwdConstraint
        self.arrays = [self._array(name) for name in core.parts.FILLED]
        self._state = [getattr(self.data, name) for name in STATE]
        self._eq_active = self.data.eq_active.view(np.uint8)  # MuJoCo 3.9 and later have booleans
        self.muscle = core.config["actuation_model"] == "muscle"
        self.refresh()
        self.idle = self._references()

    def _array(self, name: str) -> Any:
        """Returns an array of MuJoCo's. Its empty arrays share an address, so they could not be written to together."""
        array = getattr(self.data, name)
        return array if array.size else np.zeros(array.shape)

    def _references(self) -> int:
        # MuJoCo's arrays are the same objects each time, and do not hold the state
        return sys.getrefcount(self.data) + sum(map(sys.getrefcount, self.arrays))

    @property
    def state(self) -> list[Any]:
        """Returns the arrays that can be written to."""
        return self._state

    def held(self) -> bool:
        """Returns whether the state or one of its arrays is referenced outside the environment."""
        return self._references() > self.idle

    def refresh(self) -> None:
        """Updates the state."""
        data, model, parts = self.data, self.model, self.core.parts
        parts.fill(self.arrays)
        if self.muscle:
            model.actuator_gear[:, 0] = parts.gear
        data.time = self.core.engine.time
        self._compute(self.position)
        if self.course.copy.contacts:
            self._compute(self.constraint)
            self._fill_forces()
        parts.fill_position(self._state[:2])
        self.course.change("show")

    def _compute(self, functions: list[Any]) -> None:
        """Calls functions of MuJoCo with the positions and velocities from which everything was computed; keeps these."""
        model, data = self.model, self.data
        self.core.parts.fill_start(self._eq_active, self._state[:2])
        for function in functions:
            function(model, data)

    def complete(self) -> None:
        """Computes contacts and constraints, now and from now on with every step."""
        if self.course.copy is not Copy.POSES:
            return
        self.course.change("complete")
        data, core = self.data, self.core
        if not np.array_equal(data.xpos, core.engine.state_array("xpos")):
            return  # a script has computed another state
        qpos, qvel = self._state[:2]
        present = qpos.copy(), qvel.copy()  # a script may have written them
        self._compute(self.constraint)
        qpos[:], qvel[:] = present
        self._fill_forces()

    def show_normals(self, contacts: Any) -> None:
        """Inverts normals as MIMo's own touch does, in contacts of the engine's state."""
        if not (self.course.moment.felt and self.course.copy.present):
            return
        if np.array_equal(self.data.xpos, self.core.engine.state_array("xpos")):
            self.core.show_normals(contacts.frame)

    def _fill_forces(self) -> None:
        forces = self.core.parts.efc_force
        if len(forces) == self.data.nefc:
            self.data.efc_force[:] = forces
        elif self.data.nefc:
            # another release of MuJoCo finds other contacts: their forces are its own
            self.core.parts.fill_start(self._eq_active, self._state[:2])
            self._solve(self.model, self.data)
            self.core.parts.fill(self.arrays)
