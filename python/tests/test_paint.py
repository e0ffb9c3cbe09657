"""What pictures follow can be changed in environments of ``babybench.make``; steps stay as they are."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core import looks


@pytest.fixture
def env() -> Any:
    env = babybench.Env({**SMALL, "behavior": "self_touch"})
    env.reset(seed=0)
    return env


def test_pictures_follow_and_steps_do_not(env: Any) -> None:
    plain = copy.deepcopy(env)
    first = env.picture("closeup", 60, 60).astype(float)
    env.paint({"geom_rgba": np.tile([1, 0, 0, 1], (len(env.geom_names), 1)), "cam_fovy": {"closeup": 20}})
    painted = env.picture("closeup", 60, 60).astype(float)
    assert np.abs(painted - first).mean() > 5
    other = copy.deepcopy(env)
    action = env.action_space.sample()
    seen = [each.step(action)[0] for each in (env, plain, other)]
    for key in seen[0]:
        assert np.array_equal(seen[0][key], seen[1][key]), key
    assert np.array_equal(env.picture("closeup", 60, 60), other.picture("closeup", 60, 60))
    env.reset()
    assert np.abs(env.picture("closeup", 60, 60) - first).mean() > 5


@pytest.mark.parametrize(
    ("change", "error", "text"),
    [
        ({"geom_rgb": 1}, KeyError, "'geom_rgb' does not affect pictures; did you mean `geom_rgba`"),
        ({"body_mass": 1}, KeyError, "'body_mass' does not affect pictures"),
        ({"geom_rgba": [1, 0, 0, 1]}, ValueError, r"geom_rgba has the shape \(4,\)"),
        ({"geom_rgba": {"head": [1, 0]}}, ValueError, r"'head' has numbers of the shape \(4,\)"),
        ({"geom_matid": {"head": 999}}, ValueError, "model.geom_matid, element"),
    ],
)
def test_what_no_picture_follows_is_refused(env: Any, change: Any, error: type[Exception], text: str) -> None:
    before = looks.of(env._core)
    with pytest.raises(error, match=text):
        env.paint(change)
    for name, array in looks.of(env._core).items():
        assert np.array_equal(array, before[name]), name
