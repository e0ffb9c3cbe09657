"""Runs of many steps from many states, as ``mujoco.rollout`` makes them: :func:`rollout`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .data import MjData
from .enums import mjtState
from .functions import advance, mj_getState, mj_setState, mj_stateSize
from .model import MjModel

__all__ = ["Rollout", "rollout"]

_Floats = NDArray[np.float64]
_FULL = int(mjtState.mjSTATE_FULLPHYSICS)
_INPUTS = {
    "ctrl": mjtState.mjSTATE_CTRL,
    "qfrc_applied": mjtState.mjSTATE_QFRC_APPLIED,
    "xfrc_applied": mjtState.mjSTATE_XFRC_APPLIED,
}
_USER = int(mjtState.mjSTATE_USER)


def rollout(
    model: Union[MjModel, Sequence[MjModel]],
    data: Union[MjData, Sequence[MjData]],
    initial_state: ArrayLike,
    control: Optional[ArrayLike] = None,
    *,
    control_spec: int = int(mjtState.mjSTATE_CTRL),
    skip_checks: bool = False,
    nstep: Optional[int] = None,
    initial_warmstart: Optional[ArrayLike] = None,
    state: Optional[_Floats] = None,
    sensordata: Optional[_Floats] = None,
    chunk_size: Optional[int] = None,
    persistent_pool: bool = False,
) -> tuple[_Floats, _Floats]:
    """Steps from each initial state, and returns the states and the sensors' readings after each step.

    Arguments without the first axis, or with one row, apply to all runs. The runs follow each other in the caller's
    thread, whatever the number of states in `data`; their numbers do not depend on threads.

    Args:
        model: The model, or one for each run; all of the same sizes.
        data: One or several scratch states.
        initial_state: Where runs begin, (runs, state) of ``mjSTATE_FULLPHYSICS``.
        control: What is applied in each step, (runs, steps, parts of `control_spec`).
        control_spec: Parts of a state that `control` has. Other inputs are zero, or as the model has them.
        skip_checks: Accepted as in MuJoCo; shapes are checked in any case.
        nstep: Number of steps, if no other argument gives it.
        initial_warmstart: Accelerations from which the solver starts, (runs, nv); zeros if they are not given.
        state: Where states are written, (runs, steps, state).
        sensordata: Where sensors' readings are written, (runs, steps, nsensordata).
        chunk_size: Accepted as in MuJoCo; it has no effect.
        persistent_pool: Accepted as in MuJoCo; it has no effect.

    Returns:
        States (runs, steps, state) and readings (runs, steps, nsensordata). A run that diverges repeats its last
        numbers, or the initial state.

    Raises:
        ValueError: Arguments whose shapes do not agree.
    """
    models = [model] if isinstance(model, MjModel) else list(model)
    states = [data] if isinstance(data, MjData) else list(data)
    if not models or not states:
        raise ValueError("a rollout needs at least one model and one state to work in")
    work = states[0]
    first = models[0]
    if int(control_spec) & ~_USER:
        raise ValueError(f"control_spec is {control_spec}: it must be a sum of inputs (mjSTATE_USER)")
    sizes = (mj_stateSize(first, _FULL), mj_stateSize(first, int(control_spec)), first.nv, first.nsensordata)
    starts = _shaped("initial_state", initial_state, 2, sizes[0])
    inputs = None if control is None else _shaped("control", control, 3, sizes[1])
    warm = None if initial_warmstart is None else _shaped("initial_warmstart", initial_warmstart, 2, sizes[2])
    given = [array for array in (starts, inputs, warm, state, sensordata) if array is not None]
    runs = _common("runs", [len(models), *(len(array) for array in given)])
    lengths = [array.shape[1] for array in (inputs, state, sensordata) if array is not None and array.ndim == 3]
    steps = _common("steps", [*lengths, *([] if nstep is None else [int(nstep)])])
    state = _room("state", state, (runs, steps, sizes[0]))
    sensordata = _room("sensordata", sensordata, (runs, steps, sizes[3]))
    for run in range(runs):
        own = models[run % len(models)]
        at = work if work.model is own else MjData(own)
        _begin(own, at, int(control_spec), starts[run % len(starts)])
        at.qacc_warmstart[:] = 0.0 if warm is None else warm[run % len(warm)]
        applied = None if inputs is None else inputs[run % len(inputs)]
        _run(own, at, int(control_spec), applied, starts[run % len(starts)], state[run], sensordata[run])
    return state, sensordata


class Rollout:
    """Makes runs as :func:`rollout` does, with the interface of MuJoCo's class.

    Args:
        nthread: Accepted as in MuJoCo; runs follow each other in the caller's thread.
    """

    def __init__(self, *, nthread: Optional[int] = None) -> None:
        """Takes MuJoCo's argument."""
        self.nthread = nthread

    def __enter__(self) -> Rollout:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Does nothing: there are no threads to end."""

    def rollout(
        self, model: Any, data: Any, initial_state: ArrayLike, control: Optional[ArrayLike] = None, **options: Any
    ) -> tuple[_Floats, _Floats]:
        """Makes runs; see :func:`rollout`."""
        return rollout(model, data, initial_state, control, **options)


def _shaped(name: str, values: ArrayLike, axes: int, last: int) -> _Floats:
    array = np.asarray(values, np.float64)
    if array.ndim > axes:
        raise ValueError(f"{name} can have at most {axes} dimensions, not {array.ndim}")
    shape: tuple[int, ...] = (1,) * (axes - array.ndim) + array.shape
    if shape[-1] != last:
        raise ValueError(f"trailing dimension of {name} must be {last}, got {shape[-1]}")
    return array.reshape(shape)


def _common(what: str, numbers: Sequence[int]) -> int:
    found = {number for number in numbers if number != 1}
    if len(found) > 1:
        raise ValueError(f"the arguments have several numbers of {what}: {', '.join(map(str, sorted(found)))}")
    return found.pop() if found else 1


def _room(name: str, array: Optional[_Floats], shape: tuple[int, int, int]) -> _Floats:
    if array is None:
        return np.zeros(shape)
    if array.shape != shape or array.dtype != np.float64:
        raise ValueError(f"{name} must be an array of doubles of shape {shape}, got {array.dtype} {array.shape}")
    return array


def _begin(model: MjModel, data: MjData, control_spec: int, start: _Floats) -> None:
    """Puts a state at the start of a run; inputs that `control_spec` does not have get the values of a new state."""
    for name, bit in _INPUTS.items():
        if not control_spec & int(bit):
            getattr(data, name)[...] = 0.0
    others = (mjtState.mjSTATE_MOCAP_POS, mjtState.mjSTATE_MOCAP_QUAT, mjtState.mjSTATE_EQ_ACTIVE)
    if missing := sum(int(bit) for bit in others if not control_spec & int(bit)):
        values = np.zeros(mj_stateSize(model, missing))
        mj_getState(model, MjData(model), values, missing)
        mj_setState(model, data, values, missing)
    mj_setState(model, data, start, _FULL)


def _run(
    model: MjModel,
    data: MjData,
    control_spec: int,
    applied: Optional[_Floats],
    start: _Floats,
    state: _Floats,
    sensors: _Floats,
) -> None:
    last, seen = start, np.zeros(sensors.shape[1])
    for step in range(len(state)):
        if applied is not None:
            mj_setState(model, data, applied[step % len(applied)], control_spec)
        try:
            advance(model, data, 1)
        except RuntimeError:  # it diverged
            state[step:], sensors[step:] = last, seen
            return
        mj_getState(model, data, state[step], _FULL)
        sensors[step] = data.sensordata
        last, seen = state[step], sensors[step]
