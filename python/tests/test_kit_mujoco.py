"""MuJoCo's functions on the model and the state of environments, without MuJoCo and in the place of it."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import numpy as np
import pytest
from kit_scripts import Make, steps

import mujoco

without = pytest.mark.skipif(not getattr(mujoco, "stands_in", False), reason="MuJoCo is installed")


@without
def test_mj_step_is_a_physics_step(make: Make) -> None:
    env, other = make().unwrapped, make().unwrapped
    for one in (env, other):
        one.reset()
    model, data = env.model, env.data
    for _ in range(4):
        action = np.full(env.action_space.shape, 0.3, np.float32)
        data.ctrl[:] = 0.2
        mujoco.mj_step(model, data, nstep=2)
        mujoco.mj_rnePostConstraint(model, data)
        for _ in range(2):
            other.data.ctrl[:] = 0.2
            other._single_mujoco_step()
        assert np.array_equal(data.qpos, other.data.qpos)
        assert np.array_equal(data.xpos, other.data.xpos)
        a, b = env.step(action)[0], other.step(action)[0]
        assert all(np.array_equal(a[key], b[key]) for key in a)


@without
def test_positions_that_are_written_are_where_functions_compute(make: Make) -> None:
    env = make().unwrapped
    env.reset()
    model, data = env.model, env.data
    elbow = int(model.joint("robot:right_elbow").qposadr[0])
    before = np.array(data.body("right_hand").xpos)
    data.qpos[elbow] = -1.5
    mujoco.mj_kinematics(model, data)
    assert not np.allclose(data.body("right_hand").xpos, before)
    mujoco.mj_resetData(model, data)
    assert np.array_equal(data.qpos, model.qpos0)
    hand = model.body("right_hand").id
    mujoco.mj_forward(model, data)
    jacp = np.zeros((3, model.nv))
    mujoco.mj_jacBodyCom(model, data, jacp, None, hand)
    mujoco.mj_applyFT(model, data, [0, 0, 2.0], [0, 0, 0], data.xipos[hand], hand, data.qfrc_applied)
    np.testing.assert_allclose(data.qfrc_applied, 2 * jacp[2], rtol=0, atol=1e-12)
    steps(env, 1)
    assert np.array_equal(env._core.engine.state_array("qfrc_applied"), data.qfrc_applied)


@pytest.mark.parametrize("held", [True, False])
def test_forces_on_bodies_act(make: Make, held: bool) -> None:
    env, other = make().unwrapped, make().unwrapped
    for one in (env, other):
        one.reset()
    hand = env.model.body("right_hand").id
    data = env.data if held else None
    env.data.xfrc_applied[hand, :3] = [0, 0, 30.0]
    action = np.zeros(env.action_space.shape, np.float32)
    for _ in range(5):
        env.step(action), other.step(action)
    assert env._core.engine.state_array("xfrc_applied")[hand, 2] == 30.0
    assert env.data.xpos[hand, 2] > other.data.xpos[hand, 2] + 1e-4
    env.data.xfrc_applied[hand] = 0
    env.step(action)
    assert not env._core.engine.state_array("xfrc_applied").any()
    env.data.xfrc_applied[hand, 2] = 1
    env.reset()
    assert not env.data.xfrc_applied.any()
    del data


def test_colours_of_the_model_reach_the_pictures(make: Make) -> None:
    env = make().unwrapped
    env.reset()
    before = env.mujoco_renderer.render("rgb_array")
    env.model.geom_rgba[:, :3] = 0, 0, 1
    env.model.mat_rgba[:, :3] = 0, 0, 1
    after = env.mujoco_renderer.render("rgb_array")
    assert not np.array_equal(before, after)
    assert after[..., 2].mean() > 2 * after[..., 0].mean()
    with pytest.raises((ValueError, AttributeError)):
        env.model.geom_type[:] = 0


@without
def test_the_stand_in_is_all_of_babybench_mujoco(make: Make) -> None:
    import mujoco.rollout
    import mujoco.viewer

    assert mujoco.__name__ == "babybench.mujoco"
    env = make().unwrapped
    assert isinstance(env.model, mujoco.MjModel)
    assert isinstance(env.data, mujoco.MjData)
    assert mujoco.MjSpec().compile().nbody == 1
    with pytest.raises(TypeError, match=r"the state of an environment is env\.data"):
        mujoco.MjData(env.model)
    with pytest.raises(AttributeError, match="pip install mujoco"):
        mujoco.mjr_render  # noqa: B018


@without
@pytest.mark.filterwarnings("ignore:make_env")
def test_renderers_draw_environments(make: Make) -> None:
    env = make().unwrapped
    env.reset()
    with mujoco.Renderer(env.model, 24, 32) as renderer:
        renderer.update_scene(env.data, "corner")
        np.testing.assert_array_equal(renderer.render(), env._core.engine.render("corner", 32, 24))
        assert renderer.render(out=np.zeros((24, 32, 3), np.uint8)).any()
        free = mujoco.MjvCamera()
        mujoco.mjv_defaultFreeCamera(env.model, free)
        renderer.update_scene(env.data)
        alone = renderer.render()
        renderer.update_scene(env.data, free)
        np.testing.assert_array_equal(renderer.render(), alone)
        renderer.enable_depth_rendering()
        assert renderer.render().shape == (24, 32)
        renderer.enable_segmentation_rendering()
        assert renderer.render().shape == (24, 32, 2)
        with pytest.raises(ValueError, match='"moon" does not exist'):
            renderer.update_scene(env.data, "moon")
        with pytest.raises(ValueError, match=r"env\.data of the environment"):
            renderer.update_scene(make().unwrapped.data)


@without
def test_steps_after_install(tmp_path) -> None:
    program = f"""
    import numpy as np
    import babybench, babybench.mujoco, babybench.utils
    babybench.mujoco.install()
    import mujoco
    env = babybench.utils.make_env({{**babybench.read_config("self_touch"), "save_dir": {str(tmp_path)!r}}}).unwrapped
    env.reset(seed=0)
    before = env.data.time
    mujoco.mj_step(env.model, env.data)
    assert env.data.time == before + env.model.opt.timestep
    mujoco.mj_forward(env.model, env.data)
    env.step(env.action_space.sample())
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
