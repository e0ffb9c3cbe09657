"""The state that scripts hold, ``env.data``: updated while a script holds it, and read back where it was written to."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from .beneath import Beneath
from .views import DataView

STATE = ("qpos", "qvel", "ctrl", "act", "qfrc_applied", "xfrc_applied", "mocap_pos", "mocap_quat")
"""Arrays that can be written to: the bits of ``Parts.differences``."""


class Live:
    """A state that a script may hold."""

    data: Any

    def __init__(self, core: Beneath) -> None:
        """Takes the environment."""
        self.core, self.course = core, core.course
        self.idle = 0

    def held(self) -> bool:
        """Returns whether the state or one of its arrays is referenced outside the environment."""
        raise NotImplementedError

    def refresh(self) -> None:
        """Updates the state."""
        raise NotImplementedError

    def advance(self) -> None:
        """Records that the engine's state has been replaced."""
        self.course.change("advance")
        if self.held():
            self.refresh()

    def pull(self) -> None:
        """Reads back what a script has written."""
        if not self.course.copy.present:
            return
        data, parts, engine = self.data, self.core.parts, self.core.engine
        bits = parts.differences(self.state)
        if not bits:
            return
        if bits & 0b11:
            forwarded = not np.array_equal(data.xpos, engine.state_array("xpos"))
            (parts.forward if forwarded else parts.set_position)(data.qpos, data.qvel)
        for number, name in enumerate(STATE[2:], 2):
            if bits >> number & 1:
                engine.write_state(name, getattr(data, name))
        self.core.written()

    @property
    def state(self) -> list[Any]:
        """Returns the arrays that can be written to."""
        return [getattr(self.data, name) for name in STATE]


class ViewLive(Live):
    """The stand-in for MuJoCo's state."""

    def __init__(self, core: Beneath) -> None:
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
        return [arrays[name] if name != "act" else self._act for name in STATE]

    def held(self) -> bool:
        """Returns whether the state or one of its arrays is referenced outside the environment."""
        return sys.getrefcount(self.data) > self.idle_data or sys.getrefcount(self.data._memory) > self.idle

    def refresh(self) -> None:
        """Updates the state."""
        own = self.data.__dict__
        self.core.parts.fill(self.arrays)
        own["time"] = self.core.engine.time
        own["_contacts"] = None
        self.course.change("show")

    def forward(self) -> None:
        """Computes everything at the positions and velocities that a script has written: ``mujoco.mj_forward``."""
        self.core.pull()
        self.core.parts.forward(self.data.qpos, self.data.qvel)
        self.core.written()
        self.refresh()

    def step(self, count: int) -> None:
        """Advances by physics steps: ``mujoco.mj_step``."""
        for _ in range(count):
            self.core.physics_step()
        if not self.course.copy.present:
            self.refresh()

    def reset(self) -> None:
        """Resets the simulation: ``mujoco.mj_resetData``."""
        self.core.reset_data()
        self.refresh()

    def rne_post_constraint(self) -> None:
        """Does nothing: a physics step computes forces between bodies."""
