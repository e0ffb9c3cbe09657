"""MIMo 3, whose chest has two joints."""

from __future__ import annotations

import pytest
from conftest import SMALL

import babybench


@pytest.mark.parametrize("age", [None, 3])
@pytest.mark.parametrize(("behavior", "joints"), [("self_touch", 49), ("hand_regard", 93)])
def test_mimo_3_has_a_chest(behavior, joints, age):
    settings = {**SMALL, "behavior": behavior, "age": age}
    second, third = babybench.Env(settings), babybench.Env({**settings, "mimo_version": 3})
    assert "chest" not in second.body_names
    assert "chest" in third.body_names
    assert sum(name.startswith("robot:") for name in third.joint_names) == joints
    assert third.action_space.shape[0] == second.action_space.shape[0] + 2
    third.reset(seed=0)
    observation, *_ = third.step(third.action_space.sample())
    for key, space in third.observation_space.items():
        assert space.contains(observation[key]), key


def test_other_versions_are_refused_by_name():
    with pytest.raises(ValueError, match="`mimo_version`"):
        babybench.Env({**SMALL, "mimo_version": 4})
