"""A spring between a point of a body and a place in the world, as stiff as the body is heavy."""

from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from babybench_core import _native

Floats = npt.NDArray[np.float64]

STRENGTH = 12.0
"""Angular frequency of the pulled body, rad/s: the stiffness is its square times the effective mass at the point."""

MOST = 40.0
"""The greatest force, in weights of the mass at the point, so that a distant pointer cannot throw the infant out of the room."""


class Spring:
    """Pulls at a body of an environment."""

    def __init__(self, core: _native.Env) -> None:
        """Creates a spring that holds no body."""
        self._core = core
        self._body: Optional[int] = None
        self._point: Floats = np.zeros(3)
        self._before: Optional[Floats] = None
        self.target: Floats = np.zeros(3)
        """The target of the pull, m, in the world."""

    @property
    def holds(self) -> bool:
        """Whether it holds a body."""
        return self._body is not None

    def hold(self, body: int, place: Floats) -> None:
        """Grabs a body at a place of the world, m."""
        self._body, self._before = body, None
        self._point = self._frame(body).T @ (place - self._core.state_array("xpos")[body])
        self.target = place

    def let_go(self) -> None:
        """Releases the body and removes the force."""
        if self.holds:
            self._core.release_forces()
        self._body = None

    @property
    def at(self) -> Floats:
        """Current position of the point, m, in the world."""
        body = self._body or 0
        at: Floats = self._core.state_array("xpos")[body] + self._frame(body) @ self._point
        return at

    def pull(self, seconds: float) -> None:
        """Sets the force of the next step, given its duration."""
        if self._body is None:
            return
        at = self.at
        mass = 1 / max(float(self._core.model_array("body_invweight0")[self._body, 0]), 1e-9)
        velocity = np.zeros(3) if self._before is None else (at - self._before) / seconds
        force = mass * (STRENGTH**2 * (self.target - at) - 1.4 * STRENGTH * velocity)
        size, most = float(np.linalg.norm(force)), MOST * mass * 9.81
        if size > most:
            force *= most / size
        self._before = at
        self._core.release_forces()
        self._core.apply_force(self._body, force.tolist(), at.tolist())

    def _frame(self, body: int) -> Floats:
        frame: Floats = self._core.state_array("xmat")[body].reshape(3, 3)
        return frame
