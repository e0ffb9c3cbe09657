"""The curves and the parts of MIMo's muscles, as MIMo's own class shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from .core import Core

Array = NDArray[np.float64]


def bump(length: ArrayLike, a: float, mid: float, b: float) -> Array:
    """Returns a bump of height 1 at ``mid``, which falls to 0 at ``a`` and ``b``, in four pieces of parabolas."""
    x = np.asarray(length, dtype=np.float64)
    left, right = 0.5 * (a + mid), 0.5 * (mid + b)
    pieces = [
        0.5 * np.square((x - a) / (left - a)),
        1 - 0.5 * np.square((mid - x) / (mid - left)),
        1 - 0.5 * np.square((x - mid) / (right - mid)),
        0.5 * np.square((b - x) / (b - right)),
    ]
    inside = [(x >= a) & (x < left), (x >= left) & (x < mid), (x >= mid) & (x < right), (x >= right) & (x <= b)]
    return np.select(inside, pieces, 0.0)


class MuscleParts:
    """The state of an actuator's two muscles: ``..._1`` pulls to the negative side, ``..._2`` to the positive one."""

    lmin: float
    lmax: float
    fvmax: float
    fpmax: float
    vmax: Array
    n_actuators: int
    mimo_actuated_qpos: NDArray[np.int_]
    mimo_actuated_qvel: NDArray[np.int_]
    actuators: NDArray[np.int_]
    _core: Core
    _moments: Array
    _offsets: Array
    _spring: Array

    @property
    def activity(self) -> Array:
        """Returns the activations of the muscles, (2 n,), 0 to 1."""
        return np.asarray(self._core.engine.state_array("act"))

    @property
    def target_activity(self) -> Array:
        """Returns the excitations that the activations follow, (2 n,)."""
        return np.asarray(self._core.engine.state_array("actuator_target"))

    @property
    def maximum_isometric_forces(self) -> Array:
        """Returns the largest forces of the two muscles of each actuator as the scene has them, (n, 2)."""
        return np.asarray(self._core.blueprint.model_array("actuator_user"))[self.actuators, 1:3]

    @property
    def muscle_lengths(self) -> Array:
        """Returns the lengths of the muscles, (2 n,), relative to their optimum."""
        angles = self._core.engine.state_array("qpos")[self.mimo_actuated_qpos] - self._spring
        return np.asarray(np.tile(angles, 2) * self._moments + self._offsets)

    @property
    def muscle_velocities(self) -> Array:
        """Returns the velocities of the muscles, (2 n,), optimal lengths per s."""
        return np.asarray(np.tile(self._core.engine.state_array("qvel")[self.mimo_actuated_qvel], 2) * self._moments)

    @property
    def muscle_forces(self) -> NDArray[np.float32]:
        """Returns the forces of the muscles, (2 n,), relative to ``fmax``."""
        return np.asarray(self._core.engine.state_array("muscle_force").astype(np.float32))

    def fl(self, lce: ArrayLike) -> Array:
        """Returns the factor of active force at lengths, relative to the optimum."""
        main = bump(lce, self.lmin, 1, self.lmax)
        return np.asarray(main + 0.15 * bump(lce, self.lmin, 0.5 * (self.lmin + 0.95), 0.95))

    def fv(self, lce_dot: ArrayLike) -> Array:
        """Returns the factor of active force at velocities, (n,), optimal lengths per s."""
        speed, most = np.asarray(lce_dot) / self.vmax, self.fvmax - 1
        shortening, lengthening = np.square(speed + 1), self.fvmax - np.square(most - speed) / most
        return np.select(
            [speed < -1, speed <= 0, speed <= most], [np.zeros_like(speed), shortening, lengthening], self.fvmax
        )

    def fp(self, lce: ArrayLike) -> Array:
        """Returns the passive force at lengths, relative to the optimum."""
        length, bend = np.asarray(lce), 0.5 * (self.lmax + 1)
        quarter = 0.25 * self.fpmax
        steep = quarter * ((length - 1) / (bend - 1)) ** 3
        straight = quarter * (1 + 3 * (length - bend) / (bend - 1))
        return np.select([length <= 1, length <= bend], [np.zeros_like(length), steep], straight)

    def collect_data_for_actuators(self) -> list[Array]:
        """Returns 20 arrays, (n,), for the negative and the positive muscle of each actuator, unless stated otherwise.

        Angle and velocity of the joint, angle from that of its spring, gear (one array each); excitation, activation, length,
        velocity, force, and the factors of :meth:`fl`, :meth:`fv` and :meth:`fp` (two arrays each).
        """
        engine = self._core.engine
        angles = engine.state_array("qpos")[self.mimo_actuated_qpos]
        velocities = engine.state_array("qvel")[self.mimo_actuated_qvel]
        pairs = (
            *(self.target_activity, self.activity, self.muscle_lengths, self.muscle_velocities, self.muscle_forces),
            self.fl(self.muscle_lengths),
            np.concatenate([self.fv(velocity) for velocity in np.split(self.muscle_velocities, 2)]),
            self.fp(self.muscle_lengths),
        )
        halves = [np.asarray(half) for pair in pairs for half in np.split(np.asarray(pair), 2)]
        return [angles, velocities, angles - self._spring, np.asarray(self._core.parts.gear)[self.actuators], *halves]


_HALVES = {
    "lce": "muscle_lengths",
    "lce_dot": "muscle_velocities",
    "force_muscles": "muscle_forces",
    "moment": "_moments",
}


def _half(name: str, number: int) -> property:
    def get(self: MuscleParts) -> Array:
        return np.asarray(np.split(np.asarray(getattr(self, name)), 2)[number])

    get.__doc__ = f"Returns the {('first', 'second')[number]} half of ``{name.lstrip('_')}``, (n,)."
    return property(get)


for _stem, _whole in _HALVES.items():
    for _number in (0, 1):
        setattr(MuscleParts, f"{_stem}_{_number + 1}", _half(_whole, _number))
for _number in (0, 1):
    setattr(MuscleParts, f"lce_{_number + 1}_ref", _half("_offsets", _number))
