"""Every method of MIMo's environments that a subclass replaces is called, or the class is refused: tasks too, MIMo 2 and 3."""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

FOLDER = Path(__file__).parent / "kit"
SECOND = json.loads((FOLDER / "mimo_names.json").read_text(encoding="utf-8"))["modules"]
THIRD = json.loads((FOLDER / "mimo3_names.json").read_text(encoding="utf-8"))
BASES = {
    "mimoEnv.envs": set(SECOND["mimoEnv.envs.mimo_env"]["classes"]["MIMoEnv"]["methods"]),
    "mimo_infant.simulation.envs": set(THIRD["mimo_infant.simulation.envs.mimo_env"]["classes"]["MIMoEnv"]),
}
FOR_PROGRAMS = {"swap_facial_expression", "n_actuators", "body_contact_reward"}
"""What programs alone call."""
TASKS = ("dummy.MIMoDummyEnv", "reach.MIMoReachEnv", "standup.MIMoStandupEnv", "selfbody.MIMoSelfBodyEnv")
CLASSES = [
    (package, task)
    for package in BASES
    for task in (*TASKS, "catch.MIMoCatchEnv", "roll_over.MIMoRollOverEnv")
    if package != "mimoEnv.envs" or not task.startswith("roll_over")
]
SENSES = {"get_touch_obs", "touch_setup", "get_vision_obs", "vision_setup", "get_vestibular_obs", "vestibular_setup"}
EYES = {name: {"width": 8, "height": 8} for name in ("eye_left", "eye_right")}


def methods_of(package: str, task: str) -> set[str]:
    """Returns the names of MIMo's own methods."""
    module, name = task.split(".")
    known = SECOND if package == "mimoEnv.envs" else THIRD
    own = known[f"{package}.{module}"]["classes"][name]
    return (BASES[package] | set(own.get("methods", own))) - {"__init__"} - FOR_PROGRAMS


def recording(cls: Any, names: set[str]) -> tuple[Any, set[str]]:
    """Returns a subclass that replaces methods, and the names of those that were called."""
    called: set[str] = set()

    def wrapped(name: str) -> Any:
        def method(self: Any, *args: Any, **kwargs: Any) -> Any:
            called.add(name)
            return getattr(super(own, self), name)(*args, **kwargs)

        return method

    own = type("Own", (cls,), {name: wrapped(name) for name in names})
    return own, called


def arguments(task: str) -> dict[str, Any]:
    """Returns arguments that turn all senses on, few sensors among them."""
    touch = {"scales": {"head": 0.1}, "touch_function": "force_vector", "response_function": "spread_linear"}
    senses: dict[str, Any] = {
        "vision_params": EYES,
        "vestibular_params": {"sensors": ["vestibular_acc", "vestibular_gyro"]},
    }
    if task.startswith(("dummy", "reach", "standup", "roll_over")):
        senses["touch_params"] = touch
    return senses


def used(env: Any) -> None:
    """Resets and steps an environment."""
    env.reset(seed=0)
    env.step(np.zeros(env.action_space.shape, np.float32))


@pytest.mark.parametrize(("package", "task"), CLASSES)
def test_all_methods_that_are_replaced_together_are_called(package: str, task: str) -> None:
    module, name = task.split(".")
    cls = getattr(importlib.import_module(f"{package}.{module}"), name)
    names = methods_of(package, task)
    own, called = recording(cls, names)
    delays = {"motor_delay": 2, "sensory_delay": 2} if package != "mimoEnv.envs" else {}
    used(own(**arguments(task), **delays))
    assert names - called == set()


@pytest.mark.parametrize("package", BASES)
def test_a_method_that_is_replaced_alone_is_called(package: str) -> None:
    cls = importlib.import_module(f"{package}.reach").MIMoReachEnv
    for name in sorted(methods_of(package, "reach.MIMoReachEnv") - {"_delayed_action", "_delayed_observation"}):
        own, called = recording(cls, {name})
        senses = arguments("reach") if name in SENSES else {}
        used(own(**senses))
        assert called == {name}
