"""The starter kit and this library, side by side: the same actions, the same observations and information."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from .conftest import CONFIGS, STEPS

Recordings = Callable[[str, str], dict[str, Any]]

# Differences grow with the steps, as any difference in the last bit does where there are contacts. Measured in 300 steps,
# relative to the largest entry or 1: self-touch 1e-8, 1e-7, 8e-9; hand regard 1.1e-5 (the kit beside itself with its solver
# started afresh in each step: 1.5e-5); installation test 5e-9, 1e-7, 4e-9.
TOLERANCE = {
    "selftouch": {"observation": 1e-6, "touch": 1e-5, "vestibular": 1e-6},
    "handregard": {"observation": 1e-4},
    "test_installation": {"observation": 1e-6, "touch": 1e-5, "vestibular": 1e-6},
}
EYES = ("eye_left", "eye_right")


def furthest(a: list[dict[str, Any]], b: list[dict[str, Any]], key: str) -> float:
    """Returns the largest difference of an entry of observations, relative to the largest number or 1."""
    worst = 0.0
    for x, y in zip(a, b):
        assert (x[key].shape, x[key].dtype) == (y[key].shape, y[key].dtype)
        scale = max(1.0, float(np.abs(x[key]).max()))
        worst = max(worst, float(np.abs(x[key].astype(float) - y[key]).max()) / scale)
    return worst


@pytest.mark.parametrize("who", ["mujoco", "alone"])
@pytest.mark.parametrize("config", CONFIGS)
def test_what_is_sensed_is_what_the_kit_senses(recordings: Recordings, config: str, who: str) -> None:
    kit, own = recordings(config, "kit"), recordings(config, who)
    assert own["order"] == kit["order"]
    assert own["reset_info"] == kit["reset_info"] == {}
    assert len(own["observations"]) == len(kit["observations"]) == STEPS
    for key, tolerance in TOLERANCE[config].items():
        assert furthest([kit["reset"]], [own["reset"]], key) < 1e-8
        difference = furthest(kit["observations"], own["observations"], key)
        print(f"{config} {who}: {key} differs by {difference:.1e}")
        assert difference < tolerance


def test_among_cubes_it_is_as_near_to_the_kit_as_the_kit_to_itself(recordings: Recordings) -> None:
    kit, again, own = (recordings("handregard", who) for who in ("kit", "kit cold", "mujoco"))
    floor = furthest(kit["observations"], again["observations"], "observation")
    difference = furthest(kit["observations"], own["observations"], "observation")
    print(f"hand regard: the kit differs from itself by {floor:.1e}, this library by {difference:.1e}")
    assert floor > 1e-6
    assert difference < 2 * floor


@pytest.mark.parametrize("config", CONFIGS)
def test_information_and_log_are_the_kits(recordings: Recordings, config: str) -> None:
    kit, own = recordings(config, "kit"), recordings(config, "mujoco")
    assert own["infos"] == kit["infos"]
    assert own["rest"] == kit["rest"]
    assert own["history"] == kit["history"]
    assert own["history"][-1]["steps"] == STEPS


@pytest.mark.parametrize("config", ["handregard", "test_installation"])
def test_the_eyes_see_what_the_kits_eyes_see(recordings: Recordings, config: str) -> None:
    kit, own = recordings(config, "kit"), recordings(config, "mujoco")
    for eye in EYES:
        near = [
            np.abs(a[eye].astype(int) - b[eye]).max() for a, b in zip(kit["observations"][:30], own["observations"])
        ]
        state = np.abs(kit["state"][eye].astype(int) - own["state"][eye])
        all_steps = [np.abs(a[eye].astype(int) - b[eye]) > 2 for a, b in zip(kit["observations"], own["observations"])]
        share = float(np.mean(all_steps))
        print(f"{config}: {eye} differs by at most {max(near)} in 30 steps, {state.max()} in the same state;")
        print(f"  {share:.1e} of all numbers of {STEPS} steps by more than 2")
        assert max(near) <= 2
        assert state.max() <= 2
        assert share < 1e-5


@pytest.mark.parametrize("who", ["mujoco", "alone"])
@pytest.mark.parametrize("config", ["selftouch", "test_installation"])
def test_what_is_felt_again_at_one_instant_has_normals_inverted(recordings: Recordings, config: str, who: str) -> None:
    kit, own = recordings(config, "kit"), recordings(config, who)
    assert np.abs(kit["again"]["touch"] - kit["observations"][-1]["touch"]).max() > 1
    assert (np.linalg.det(kit["again"]["frames"].reshape(-1, 3, 3)) < 0).any()
    for key in ("touch", "contacts", "frames"):
        assert furthest([kit["again"]], [own["again"]], key) < 1e-5


def test_a_state_that_a_script_writes_is_sensed(recordings: Recordings) -> None:
    for who in ("mujoco", "alone"):
        kit, own = recordings("selftouch", "kit"), recordings("selftouch", who)
        for key in TOLERANCE["selftouch"]:
            assert furthest([kit["written"]], [own["written"]], key) < 1e-6
        assert own["name"] == kit["name"]
