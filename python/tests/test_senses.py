"""Ages, delays and what else lies between a sense and the observation: keywords from the table of keys."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core import _native


def test_every_key_of_growth_and_of_senses_is_a_keyword():
    keys = _native.config_keys()
    sections = {"Growth", "Delays", "Noise", "Vision", "Pain"}
    names = [name for name, key in keys.items() if key["section"] in sections]
    assert {"age", "strength_age", "delay_sensory", "delay_motor", "noise_touch", "vision_acuity", "pain_active"} <= {
        *names
    }
    for name in names:
        with pytest.raises(ValueError, match=f"`{name}`"):
            babybench.make(SMALL, **{name: "nonsense"})


def test_an_infant_is_made_by_keywords():
    env = babybench.make(SMALL, age=3, touch_pooled=True, pain_active=True, pain_threshold=0.1)
    observation, _ = env.reset(seed=0)
    assert set(observation) == set(env.observation_space)
    for key, space in env.observation_space.items():
        assert space.contains(observation[key]), key
    assert observation["touch_pooled"].shape[1] == 5
    assert observation["pain"].dtype == np.float32
    assert observation["pain"].any()


@pytest.mark.parametrize("views", [False, True])
def test_a_delayed_sense_shows_what_was_before(views):
    now, later = babybench.Env(SMALL), babybench.Env({**SMALL, "delay_sensory": 2, "delay_vestibular": 0}, views=views)
    history = [now.reset(seed=0)[0]]
    later.reset(seed=0)
    for step in range(1, 6):
        action = np.full(now.action_space.shape, 0.2, np.float32)
        history.append(now.step(action)[0])
        seen = later.step(action)[0]
        for key, delay in [("observation", 2), ("touch", 2), ("vestibular", 0)]:
            np.testing.assert_array_equal(seen[key], history[max(0, step - delay)][key], err_msg=f"{key}, step {step}")


def test_a_vector_has_the_senses_of_its_environments():
    config = {**SMALL, "noise_touch": 0.1, "touch_pooled": True, "pain_active": True, "delay_touch": 1}
    envs, env = babybench.VectorEnv(config, num_envs=2), babybench.Env(config)
    together, alone = envs.reset(seed=4)[0], env.reset(seed=4)[0]
    for key, values in alone.items():
        np.testing.assert_array_equal(together[key][0], values, err_msg=key)


def test_what_shapes_a_sense_that_is_off_is_refused():
    with pytest.raises(ValueError, match=r"`vision_acuity`.*vision_active"):
        babybench.make(SMALL, vision_acuity=True)
    with pytest.raises(ValueError, match=r"`delay_motor` is 1\.5"):
        babybench.make(SMALL, delay_motor=1.5)
    with pytest.raises(ValueError, match=r"`head_circumference` is 0\.1"):
        babybench.make(SMALL, age=6, head_circumference=0.1)
