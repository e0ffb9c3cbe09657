"""MuJoCo's own models in the place of ``env.model``. Runs where MuJoCo is installed."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from babybench_kit.models import mujoco_module
from babybench_kit.tasks.dummy import MIMoDummyEnv

mujoco = mujoco_module()
pytestmark = pytest.mark.skipif(mujoco is None, reason="there are no models of MuJoCo's own without MuJoCo")
PLAIN = {"touch_params": None, "vision_params": None}


class Moon(MIMoDummyEnv):
    """Compiles its own model with MuJoCo, as MIMo's method does, and writes into it."""

    def _initialize_simulation(self) -> Any:
        self.own = mujoco.MjModel.from_xml_path(self.fullpath)
        self.own.vis.global_.offwidth = 480
        self.own.opt.gravity[2] = -1.5
        self.own.geom_friction[3, 0] = 0.25
        self.own.geom_rgba[3] = 1, 0, 0, 1
        data = mujoco.MjData(self.own)
        data.qvel[0] = 0.125
        return self.own, data


def fall(env: Any) -> float:
    env.reset(seed=0)
    env.step(np.zeros(env.action_space.shape, np.float32))
    return float(env.data.qvel[2])


def test_what_a_program_writes_into_a_model_of_mujoco_acts() -> None:
    env = Moon(**PLAIN)
    assert env.model is env.own
    assert env.init_qvel[0] == 0.125
    read = env._core.engine.model_array
    assert read("geom_friction")[3, 0] == env.model.geom_friction[3, 0] == 0.25
    assert fall(env) == pytest.approx(fall(MIMoDummyEnv(**PLAIN)) * 1.5 / 9.81, rel=1e-3)
    env.own.opt.gravity[2] = -5
    env.step(np.zeros(env.action_space.shape, np.float32))
    assert read("opt.gravity").tolist() == [0, 0, -5]
    for again in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        assert again.model.opt.gravity[2] == -5
        assert again.model.geom_friction[3, 0] == 0.25


def test_a_model_of_mujoco_is_given_later() -> None:
    env = MIMoDummyEnv(**PLAIN)
    env.reset(seed=0)
    model = mujoco.MjModel.from_xml_path(env.fullpath)
    data = mujoco.MjData(model)
    data.qpos[2] += 0.1
    env.model = model
    env.data = data
    assert env.model is model
    np.testing.assert_array_equal(env.data.qpos, data.qpos)
    assert fall(env) == fall(MIMoDummyEnv(**PLAIN))


def test_what_cannot_be_taken_over_is_refused_by_name() -> None:
    env = MIMoDummyEnv(**PLAIN)
    first, before = env.model, fall(env)
    model = mujoco.MjModel.from_xml_path(env.fullpath)
    model.body_ipos[3, 0] += 0.5
    model.opt.integrator = 1
    model.vis.rgba.fog[0] = 0.25
    with pytest.raises(
        ValueError, match=r"body_ipos, opt\.integrator, vis\.rgba\.fog differ from .*xml, and a running environment"
    ):
        env.model = model
    with pytest.raises(ValueError, match="it has nq 0, where the document gives"):
        env.model = mujoco.MjModel.from_xml_string("<mujoco/>")
    spec = mujoco.MjSpec.from_file(env.fullpath)
    spec.worldbody.first_geom().name = "another"
    with pytest.raises(ValueError, match="it has a geom 'another', where the document gives"):
        env.model = spec.compile()
    model = mujoco.MjModel.from_xml_path(env.fullpath)
    model.geom_friction[3, 0] = -1
    with pytest.raises(ValueError, match="geom_friction"):
        env.model = model
    assert env.model is first
    assert fall(env) == before


@pytest.mark.parametrize("name", ["integrator", "iterations", "disableflags", "magnetic"])
def test_options_that_the_engine_does_not_take_over_are_refused(name: str) -> None:
    env = MIMoDummyEnv(**PLAIN)
    env.reset(seed=0)
    if name == "magnetic":
        env.model.opt.magnetic[0] = 1
    else:
        setattr(env.model.opt, name, getattr(env.model.opt, name) + 1)
    with pytest.raises(ValueError, match=rf"env\.model was changed \(opt\.{name}\)"):
        env.reset(seed=0)
