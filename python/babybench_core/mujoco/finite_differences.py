"""Derivatives by finite differences: ``mjd_transitionFD`` and ``mjd_inverseFD``."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Optional

import numpy as np
from numpy.typing import NDArray

from .data import MjData
from .enums import mjtDisableBit, mjtState
from .functions import mj_differentiatePos, mj_getState, mj_integratePos, mj_setState, mj_stateSize, mj_step
from .inverse import mj_inverse
from .jacobians import check
from .model import MjModel

__all__ = ["mjd_inverseFD", "mjd_transitionFD"]

_Floats = NDArray[np.float64]
_Out = Optional[NDArray[np.float64]]


class _Stepper:
    """Repeated steps from one state."""

    def __init__(self, m: MjModel, d: MjData) -> None:
        self.m, self.d = m, d
        spec = mjtState.mjSTATE_FULLPHYSICS | mjtState.mjSTATE_CTRL
        if not m.opt.disableflags & mjtDisableBit.mjDSBL_WARMSTART:
            spec |= mjtState.mjSTATE_WARMSTART
        self.spec = int(spec)
        self.start = np.zeros(mj_stateSize(m, self.spec))
        mj_getState(m, d, self.start, self.spec)

    def after(self, nudge: Callable[[], None]) -> tuple[_Floats, _Floats, _Floats]:
        """Returns positions, other parts of the state and sensors one step after a nudge, and restores the state."""
        nudge()
        mj_step(self.m, self.d)
        found = self.d.qpos.copy(), np.concatenate([self.d.qvel, self.d.act]), self.d.sensordata.copy()
        mj_setState(self.m, self.d, self.start, self.spec)
        return found

    def between(self, first: tuple[_Floats, ...], second: tuple[_Floats, ...], by: float) -> tuple[_Floats, _Floats]:
        """Returns the differences of states and of sensors from the first to the second, per unit."""
        turned = np.zeros(self.m.nv)
        mj_differentiatePos(self.m, turned, by, first[0], second[0])
        return np.concatenate([turned, (second[1] - first[1]) / by]), (second[2] - first[2]) / by


def mjd_transitionFD(m: MjModel, d: MjData, eps: float, flg_centered: int, A: _Out, B: _Out, C: _Out, D: _Out) -> None:
    """Computes how a step changes with the state and the controls, by finite differences.

    Args:
        m: Model.
        d: State; restored afterwards, except for derived quantities.
        eps: Size of the differences.
        flg_centered: Whether the differences are centered.
        A: The next state by the state, (2 nv + na, 2 nv + na), with positions in tangent space.
        B: The next state by the controls, (2 nv + na, nu).
        C: Sensors by the state, (nsensordata, 2 nv + na).
        D: Sensors by the controls, (nsensordata, nu); with the wrong sign for centered differences, as in MuJoCo 3.3.0.

    Raises:
        TypeError: A matrix has another shape.
    """
    check(m, d)
    states = 2 * m.nv + m.na
    shapes = {
        "A": (A, states, states),
        "B": (B, states, m.nu),
        "C": (C, m.nsensordata, states),
        "D": (D, m.nsensordata, m.nu),
    }
    for name, (matrix, rows, columns) in shapes.items():
        if matrix is not None and np.shape(matrix) != (rows, columns):
            raise TypeError(f"{name} should be of shape ({rows}, {columns})")
    work = _Stepper(m, d)
    middle = work.after(lambda: None)
    if B is not None or D is not None:
        _by_controls(work, middle, eps, bool(flg_centered), B, D)
    if A is None and C is None:
        return

    def move(index: int, by: float) -> None:
        if index < m.nv:
            velocity = np.zeros(m.nv)
            velocity[index] = 1
            mj_integratePos(m, d.qpos, velocity, by)
        elif index < 2 * m.nv:
            d.qvel[index - m.nv] += by
        else:
            d.act[index - 2 * m.nv] += by

    for index in range(states):
        plus = work.after(partial(move, index, eps))
        minus = work.after(partial(move, index, -eps)) if flg_centered else middle
        state, sensors = work.between(minus, plus, 2 * eps if flg_centered else eps)
        if A is not None:
            A[:, index] = state
        if C is not None:
            C[:, index] = sensors


def _by_controls(
    work: _Stepper, middle: tuple[_Floats, _Floats, _Floats], eps: float, centered: bool, B: _Out, D: _Out
) -> None:
    """Differentiates by controls, to the side on which they are within their ranges."""
    m, d = work.m, work.d

    def move(index: int, by: float) -> None:
        d.ctrl[index] += by

    for index in range(m.nu):
        low, high = m.actuator_ctrlrange[index] if m.actuator_ctrllimited[index] else (-np.inf, np.inf)
        at = d.ctrl[index]
        up = low <= at <= high and low <= at + eps <= high
        down = (centered or not up) and low <= at - eps <= high and low <= at <= high

        plus = work.after(partial(move, index, eps)) if up else middle
        minus = work.after(partial(move, index, -eps)) if down else middle
        state, sensors = work.between(minus, plus, eps * max(1, int(up) + int(down)))
        if B is not None:
            B[:, index] = state
        if D is not None:
            # MuJoCo 3.3.0 inverts the sign of centered differences
            D[:, index] = -sensors if up and down else sensors


def mjd_inverseFD(
    m: MjModel,
    d: MjData,
    eps: float,
    flg_actuation: int,
    DfDq: _Out,
    DfDv: _Out,
    DfDa: _Out,
    DsDq: _Out,
    DsDv: _Out,
    DsDa: _Out,
    DmDq: _Out,
) -> None:
    """Computes how inverse dynamics change with positions, velocities and accelerations, by forward differences.

    Row i of a matrix (nv, nv) is the change of ``qfrc_inverse`` by the i-th number.

    Raises:
        NotImplementedError: Derivatives of sensors or of the inertia are requested.
    """
    check(m, d)
    if any(matrix is not None for matrix in (DsDq, DsDv, DsDa, DmDq)):
        raise NotImplementedError("mjd_inverseFD: only DfDq, DfDv and DfDa are computed here; leave the others None")
    start = d.qpos.copy(), d.qvel.copy(), d.qacc.copy()

    def forces() -> _Floats:
        mj_inverse(m, d)
        return np.asarray(d.qfrc_inverse - (d.qfrc_actuator if flg_actuation else 0.0))

    def back() -> None:
        d.qpos[:], d.qvel[:], d.qacc[:] = start

    middle = forces()
    for kind, matrix in enumerate((DfDq, DfDv, DfDa)):
        for index in range(m.nv if matrix is not None else 0):
            velocity = np.zeros(m.nv)
            velocity[index] = 1
            if kind == 0:
                mj_integratePos(m, d.qpos, velocity, eps)
            else:
                (d.qvel if kind == 1 else d.qacc)[index] += eps
            matrix[index] = (forces() - middle) / eps  # type: ignore[index]
            back()
    forces()
