"""``mujoco.rollout``, copies of states and keyframes from states, on ``babybench.mujoco``."""

from __future__ import annotations

import numpy as np
import pytest
from mujoco_documents import ARM

from babybench import mujoco
from babybench.mujoco import rollout

FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS


def arm() -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(ARM)
    return model, mujoco.MjData(model)


def starts(model: mujoco.MjModel, count: int) -> np.ndarray:
    data = mujoco.MjData(model)
    found = np.zeros((count, mujoco.mj_stateSize(model, FULL)))
    for k, row in enumerate(found):
        data.qpos[0] = 0.1 * k
        mujoco.mj_getState(model, data, row, FULL)
    return found


def test_a_rollout_is_what_single_steps_give() -> None:
    model, data = arm()
    control = np.random.default_rng(1).uniform(-1, 1, (3, 25, model.nu))
    states, sensors = rollout.rollout(model, data, starts(model, 3), control)
    assert states.shape == (3, 25, mujoco.mj_stateSize(model, FULL))
    assert sensors.shape == (3, 25, model.nsensordata)
    for run in range(3):
        mujoco.mj_resetData(model, data)
        data.qpos[0] = 0.1 * run
        for step in range(25):
            data.ctrl[:] = control[run, step]
            mujoco.mj_step(model, data)
        assert states[run, -1, 1] == data.qpos[0]
        assert states[run, -1, 0] == pytest.approx(25 * model.opt.timestep)


def test_what_is_given_once_counts_for_all_runs() -> None:
    model, data = arm()
    room = np.empty((2, 10, mujoco.mj_stateSize(model, FULL)))
    with rollout.Rollout(nthread=2) as runs:
        states, _ = runs.rollout(model, [data], starts(model, 2), [[0.5]], nstep=10, state=room)
    assert states is room
    alone, _ = rollout.rollout([model], data, starts(model, 2)[1], np.full((10, 1), 0.5))
    np.testing.assert_array_equal(alone[0], states[1])


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"control": np.zeros((2, 5, 3))}, "trailing dimension of control must be 1, got 3"),
        ({"control": np.zeros((2, 5, 1)), "nstep": 7}, "several numbers of steps: 5, 7"),
        ({"control": np.zeros((4, 5, 1))}, "several numbers of runs: 2, 4"),
        ({"control": np.zeros((1, 2, 5, 1))}, "at most 3 dimensions"),
        ({"control_spec": int(FULL)}, "must be a sum of inputs"),
        ({"nstep": 4, "sensordata": np.zeros((2, 3, 0))}, "several numbers of steps"),
        ({"nstep": 4, "state": np.zeros((2, 4, 3), np.float32)}, "must be an array of doubles of shape"),
    ],
)
def test_shapes_that_do_not_agree_are_refused(options: dict[str, object], text: str) -> None:
    model, data = arm()
    with pytest.raises(ValueError, match=text):
        rollout.rollout(model, data, starts(model, 2), **options)  # type: ignore[arg-type]


def test_a_rollout_needs_a_model_and_a_state() -> None:
    model, data = arm()
    for models, states in (([], data), (model, [])):
        with pytest.raises(ValueError, match="at least one model and one state"):
            rollout.rollout(models, states, starts(model, 2))


def test_a_copy_goes_on_with_the_same_bits() -> None:
    model, data = arm()
    data.ctrl[0] = 1.0
    mujoco.mj_step(model, data, 20)
    other = mujoco.MjData(model)
    assert mujoco.mj_copyData(other, model, data) is other
    np.testing.assert_array_equal(other.xpos, data.xpos)
    mujoco.mj_step(model, data, 20)
    mujoco.mj_step(model, other, 20)
    assert other.qpos[0] == data.qpos[0]
    with pytest.raises(ValueError, match="another model"):
        mujoco.mj_copyData(other, model, arm()[1])


def test_a_state_becomes_a_keyframe() -> None:
    model, data = arm()
    data.qpos[0], data.time = 0.7, 3.0
    mujoco.mj_setKeyframe(model, data, 0)
    mujoco.mj_resetData(model, data)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert (data.qpos[0], data.time) == (0.7, 3.0)
    with pytest.raises(IndexError, match="keyframe 1 does not exist"):
        mujoco.mj_setKeyframe(model, data, 1)
