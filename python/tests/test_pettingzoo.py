"""Two infants behind PettingZoo's parallel interface."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import babybench

pytest.importorskip("pettingzoo", reason="PettingZoo is not installed")

TWO = """<mujoco>
  <include file="mimo_settings.xml"/>
  <include file="mimo_actuators.xml"/>
  <include file="other_mimo_settings.xml"/>
  <include file="other_mimo_actuators.xml"/>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="mimo_location" pos="0 0 0.1" euler="0 -90 0">
      <freejoint name="mimo_location"/>
      <include file="mimo.xml"/>
    </body>
    <body name="other_location" pos="0 0.8 0.1" euler="0 -90 0">
      <freejoint name="other_location"/>
      <include file="other_mimo.xml"/>
    </body>
  </worldbody>
</mujoco>"""


@pytest.fixture
def two(tmp_path: Path):
    (tmp_path / "two.xml").write_text(TWO)
    config = {
        "scene": str(tmp_path / "two.xml"),
        "behavior": "self_touch",
        "vision_active": False,
        "max_episode_steps": 5,
    }
    env = babybench.pettingzoo.ParallelEnv(config)
    yield env
    env.close()


def test_pettingzoo_finds_nothing_wrong(two):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what it says of its own environments
        from pettingzoo.test import parallel_api_test

        with pytest.warns(UserWarning, match="options of a reset without effect: 'options'"):
            parallel_api_test(two, num_cycles=12)


def test_the_other_moves_by_his_own_actions(two):
    def run(level: float):
        two.reset(seed=3)
        ends = []
        while two.agents:
            actions = {agent: np.zeros(two.action_space(agent).shape, np.float32) for agent in two.agents}
            actions["other"][:] = level
            ends.append(two.step(actions))
        return ends

    rest, moved, again = run(0.0), run(0.6), run(0.6)
    assert len(rest) == 5
    assert all(rest[-1][3].values())
    assert not np.array_equal(rest[0][0]["other"], moved[0][0]["other"])
    for a, b in zip(moved, again):
        np.testing.assert_array_equal(a[0]["other"], b[0]["other"])
        np.testing.assert_array_equal(a[0]["learner"]["touch"], b[0]["learner"]["touch"])
    two.reset(seed=3)
    with pytest.raises(ValueError, match="action"):
        two.step({"learner": np.zeros(two.action_space("learner").shape), "other": np.zeros(3)})
    with pytest.raises(KeyError):
        two.step({})


def test_a_room_with_one_infant_is_refused():
    with pytest.raises(ValueError, match="no second infant"):
        babybench.pettingzoo.ParallelEnv("self_touch", vision_active=False)


def test_the_end_is_the_end(two):
    env = two
    env.reset(seed=0)
    actions = {agent: env.action_space(agent).sample() for agent in env.agents}
    with pytest.raises(KeyError, match="no agent 'third'; agents are learner, other"):
        env.step({**actions, "third": actions["other"]})
    with pytest.raises(KeyError, match="no action of the agent 'learner'"):
        env.step({"other": actions["other"]})
    while env.agents:
        env.step(actions)
    for late in (actions, {}):
        with pytest.raises(RuntimeError, match="the episode is over"):
            env.step(late)
    env.reset(seed=0)
    assert env.step(actions)[0].keys() == {"learner", "other"}
