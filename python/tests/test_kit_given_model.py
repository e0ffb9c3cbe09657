"""Models that programs compile themselves, and put in the place of ``env.model``."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from babybench import mujoco
from babybench_kit.tasks.dummy import MIMoDummyEnv, MIMoV2DummyEnv

POST = {"name": "post", "type": mujoco.mjtGeom.mjGEOM_BOX, "size": [0.01, 0.1, 0.2], "pos": [0.8, 0, 0.2]}


class Playpen(MIMoDummyEnv):
    """Compiles its own model, as MIMo's method does."""

    def _initialize_simulation(self) -> Any:
        spec = mujoco.MjSpec.from_file(self.fullpath)
        spec.worldbody.add_geom(**POST)
        self.model = spec.compile()
        self.model.vis.global_.offwidth, self.model.vis.global_.offheight = self.width, self.height
        self.model.opt.gravity[2] = -1.5
        self.model.geom_friction[self.model.geom("post").id, 0] = 0.25
        self.data = mujoco.MjData(self.model)
        assert self.dt == 2 * self.model.opt.timestep
        self._get_joints()
        self._get_actuators()
        self._get_facial_expressions({"default": "tex_head_default"})
        self._set_initial_position({"robot:left_elbow": -0.7})
        self.data.qvel[0] = 0.125
        self.actuation_model = self.actuation_model(self, self.mimo_actuators)
        return self.model, self.data


class Returned(MIMoDummyEnv):
    """Returns what it has made, and leaves the rest to the base."""

    def _initialize_simulation(self) -> Any:
        model = mujoco.MjModel.from_xml_path(self.fullpath)
        return model, mujoco.MjData(model)


class Unpacked(MIMoDummyEnv):
    """Unpacks what the base returns."""

    def _initialize_simulation(self) -> Any:
        model, data = super()._initialize_simulation()
        data.qpos[0] += 0.5
        self.seen = (model, data)
        return model, data


PLAIN = {"touch_params": None, "vision_params": None}


def run(env: Any, steps: int = 3) -> list[np.ndarray]:
    env.reset(seed=0)
    return [env.step(np.full(env.action_space.shape, 0.1, np.float32))[0]["observation"] for _ in range(steps)]


def test_a_program_compiles_its_own_model() -> None:
    env, plain = Playpen(**PLAIN), MIMoDummyEnv(**PLAIN)
    assert env.model.ngeom == plain.model.ngeom + 1
    assert env.model.opt.gravity[2] == -1.5
    assert env.model.geom("post").friction[0] == 0.25
    assert env._core.engine.model_array("geom_friction")[env.model.geom("post").id, 0] == 0.25
    address = int(env.model.joint("robot:left_elbow").qposadr[0])
    assert env.init_qpos[address] == -0.7
    assert env.init_qvel[0] == 0.125
    env.reset(seed=0)
    env.step(np.zeros(env.action_space.shape, np.float32))
    assert env.data.qvel[2] > -0.1  # it falls slowly


def test_models_that_are_returned_move_as_the_scene_does() -> None:
    for one, other in zip(run(Returned(**PLAIN)), run(MIMoDummyEnv(**PLAIN))):
        np.testing.assert_array_equal(one, other)
    assert Returned(**PLAIN).mimo_actuators.size


def test_the_base_returns_model_and_data() -> None:
    env = Unpacked(**PLAIN)
    assert env.seen[0] is env.model
    assert env.seen[1].model is env.model


def test_model_and_data_are_replaced_later() -> None:
    env = MIMoV2DummyEnv(**PLAIN)
    env.reset(seed=0)
    spec = mujoco.MjSpec.from_file(env.fullpath)
    spec.worldbody.add_geom(**POST)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] += 0.1
    env.model = model
    env.data = data
    np.testing.assert_array_equal(env.data.qpos, data.qpos)
    assert env.model.ngeom == model.ngeom
    env.step(np.zeros(env.action_space.shape, np.float32))
    for again in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        assert again.model.ngeom == model.ngeom
        np.testing.assert_array_equal(again.data.qpos, env.data.qpos)


def test_what_cannot_be_taken_over_is_refused() -> None:
    env = MIMoDummyEnv(**PLAIN)
    with pytest.raises(TypeError, match=r"must be a model of MuJoCo or of babybench\.mujoco"):
        env.model = object()
    with pytest.raises(TypeError, match=r"must be a state of babybench\.mujoco"):
        env.data = object()
    other = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    with pytest.raises(ValueError, match="the state has nq 7"):
        env.data = mujoco.MjData(other)
    fixed = mujoco.MjModel.from_xml_path(env.fullpath)
    fixed.site_size[0] = 7
    with pytest.raises((AttributeError, ValueError), match="site_size"):
        env.model = fixed
    assert env.model.ngeom == fixed.ngeom
    run(env)

    class Nothing(MIMoDummyEnv):
        def _initialize_simulation(self) -> Any:
            return None

    with pytest.raises(TypeError, match=r"Nothing\._initialize_simulation neither calls"):
        Nothing(**PLAIN)

    class Mixed(MIMoDummyEnv):
        def _initialize_simulation(self) -> Any:
            model = mujoco.MjModel.from_xml_path(self.fullpath)
            return model, mujoco.MjData(mujoco.MjModel.from_xml_path(self.fullpath))

    with pytest.raises(ValueError, match="the state of another model"):
        Mixed(**PLAIN)

    class Fixed(MIMoDummyEnv):
        def _initialize_simulation(self) -> Any:
            model = mujoco.MjModel.from_xml_path(self.fullpath)
            model.site_size[0] = 7
            return model, mujoco.MjData(model)

    with pytest.raises((AttributeError, ValueError), match="site_size"):
        Fixed(**PLAIN)
