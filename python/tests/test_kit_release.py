"""Environments of the starter kit beside the MuJoCo that is installed, of whatever release: ``scripts/mujoco_matrix.sh``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kit_scripts import Make, maker, steps

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
if getattr(mujoco, "stands_in", False):
    pytest.skip("MuJoCo is not installed", allow_module_level=True)


@pytest.fixture(params=["spring_damper", "positional", "muscle"])
def env(make: Make, request: pytest.FixtureRequest) -> Any:
    """An environment of each actuation model, after a few steps."""
    env = make(actuation_model=request.param)
    env.reset()
    steps(env, 5)
    return env.unwrapped


def test_the_model_and_the_state_are_mujoco_s_and_of_the_present(env: Any) -> None:
    assert isinstance(env.model, mujoco.MjModel)
    assert isinstance(env.data, mujoco.MjData)
    held = env.data
    for _ in range(3):
        steps(env, 1)
        engine = env._core.engine
        assert np.array_equal(held.qpos, engine.state_array("qpos"))
        np.testing.assert_allclose(held.xpos, engine.state_array("xpos"), rtol=0, atol=1e-12)
        contacts = engine.contacts()
        assert held.ncon == len(contacts["geom1"]) > 0
        assert np.array_equal(held.contact.geom1, contacts["geom1"])
        # MuJoCo 4 finds the points of boxes in another way
        away = 1e-12 if mujoco.__version__.startswith("3.3") else 2e-3
        np.testing.assert_allclose(held.contact.pos, contacts["pos"], rtol=0, atol=away)
        force = np.zeros(6)
        for number, normal in enumerate(contacts["force"][:, 0]):
            mujoco.mj_contactForce(env.model, held, number, force)
            assert force[0] == pytest.approx(normal, rel=1e-6, abs=1e-9)
    assert np.array_equal(np.asarray(held.eq_active, bool), np.asarray(env._core.parts.eq_active0, bool))


def test_what_a_script_writes_reaches_the_engine(env: Any) -> None:
    elbow = int(np.ravel(env.model.joint("robot:right_elbow").qposadr)[0])
    env.data.qpos[elbow] = -1.25
    mujoco.mj_forward(env.model, env.data)
    env._get_obs()
    assert env._core.engine.state_array("qpos")[elbow] == -1.25
    env.model.opt.gravity[2] = -1.62
    env.model.body_mass[env.model.body("head").id] *= 2
    steps(env, 1)
    assert env._core.engine.model_array("opt.gravity")[2] == -1.62
    env.reset()
    steps(env, 1)


def test_a_force_of_mj_apply_ft_acts(env: Any) -> None:
    model, data = env.model, env.data
    head = model.body("head").id
    mujoco.mj_applyFT(model, data, np.array([0, 0, 50.0]), np.zeros(3), data.xipos[head], head, data.qfrc_applied)
    steps(env, 1)
    assert np.array_equal(env._core.engine.state_array("qfrc_applied"), data.qfrc_applied)
    assert np.any(data.qfrc_applied)


def test_locks_are_taken_over(make: Make) -> None:
    import mimoEnv.utils as mimo_utils

    env = make().unwrapped
    env.reset()
    mimo_utils.lock_joint(env.model, "robot:right_elbow", -0.5)
    env.reset()
    for _ in range(60):
        env.step(np.zeros(env.action_space.shape, np.float32))
    elbow = int(np.ravel(env.model.joint("robot:right_elbow").qposadr)[0])
    assert env.data.qpos[elbow] == pytest.approx(-0.5, abs=0.05)


@pytest.mark.parametrize("scene", ["base", "crib", "cubes"])
def test_scenes_compile(tmp_path: Path, scene: str) -> None:
    env = maker(tmp_path / scene)(scene=scene).unwrapped
    env.reset()
    assert env.model.nv == env._core.blueprint.model_options["nv"]
    assert len(env.data.qvel) == env.model.nv
