"""Programs on MIMo 3, ``mimo_infant``: names, ids, delays, acuity, growth and tasks, without MIMo 3."""

from __future__ import annotations

import importlib
import inspect
import json
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from mimo_infant.growth.growth import get_growth_params, get_version
from mimo_infant.growth.utils import calc_volume, growth_function, mj_unit
from mimo_infant.simulation.envs import roll_over
from mimo_infant.simulation.envs.mimo_env import SCENE_DIRECTORY
from mimo_infant.simulation.envs.reach import MIMoReachEnv
from mimo_infant.vision.vision import SimpleVision

import mimo_infant

NAMES: dict[str, Any] = json.loads((Path(__file__).parent / "kit" / "mimo3_names.json").read_text(encoding="utf-8"))
REFUSED = ("muscle_testing", "cache", "sensormeshes", "sensorpoints", "viewer", "physics", "benchmark", "illustrations")
REFUSED_MODULES = {
    name
    for name in NAMES
    if name.endswith(REFUSED) or name.endswith("showroom") or ".schema." in name or ".data." in name
}
SERVED = sorted(set(NAMES) - REFUSED_MODULES)
UNSERVED = {"log", "DIRNAME"}
"""Names of files that are not written here."""


@pytest.mark.parametrize("module", sorted(REFUSED_MODULES))
def test_a_module_that_is_not_served_says_what_to_use(module: str) -> None:
    with pytest.raises(ImportError, match=r"is not served by babybench-kit"):
        importlib.import_module(module)


@pytest.mark.parametrize("module", SERVED)
def test_public_names_are_there_with_their_parameters(module: str) -> None:
    found, names = importlib.import_module(module), NAMES[module]
    public = [name for name in [*names["constants"], *names["functions"], *names["classes"]] if name[0] != "_"]
    assert [name for name in public if name not in UNSERVED and not hasattr(found, name)] == []
    for name, wanted in names["functions"].items():
        if name[0] != "_" and name not in UNSERVED:
            assert parameters(getattr(found, name))[: wanted.count(",") + 1] == listed(wanted), name


@pytest.mark.parametrize(("module", "name"), [(m, n) for m in SERVED for n in NAMES[m]["classes"]])
def test_methods_are_there_or_refused(module: str, name: str) -> None:
    cls = getattr(importlib.import_module(module), name)
    uncalled = getattr(cls, "_uncalled", frozenset())
    if name == "DiscreteTouch":
        with pytest.raises(NotImplementedError, match="TrimeshTouch"):
            cls(None, {})
        return
    for method, wanted in NAMES[module]["classes"][name].items():
        if method in uncalled:
            with pytest.raises(TypeError, match=method):
                type("Own", (cls,), {method: lambda self: None})
        elif not wanted.startswith("property"):
            assert hasattr(cls, method), (
                f"{name}.{method} does not exist, and subclasses that replace it are not refused"
            )
            function, expected = getattr(cls, method), listed(wanted)
            others = any(p.kind is p.VAR_KEYWORD for p in inspect.signature(function).parameters.values())
            found = parameters(function)
            assert found[: len(expected)] == expected or (others and expected[: len(found)] == found), method


def parameters(function: Any) -> list[str]:
    """Returns the names of the parameters of a function."""
    return [p.name for p in inspect.signature(function).parameters.values() if p.kind is not p.VAR_KEYWORD]


def listed(text: str) -> list[str]:
    """Returns the names of the parameters in a text."""
    inner = text[text.index("(") + 1 : -1]
    depth, names = 0, [""]
    for letter in inner:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and not depth:
            names.append("")
        else:
            names[-1] += letter
    return [name.split("=")[0].strip() for name in names if name.strip() and not name.strip().startswith("*")]


@pytest.mark.parametrize(
    ("name", "actions", "numbers", "touch"),
    [
        ("MIMoBench-v0", 46, 305, 17274),
        ("MIMoReach-v0", 8, 226, None),
        ("MIMoStandup-v0", 27, 264, None),
        ("MIMoSelfBody-v0", 8, 226, 1818),
        ("MIMoCatch-v0", 48, 433, 5928),
        ("MIMoMuscleStaticTest-v0", 88, 49, None),
        ("MIMoVelocityMuscleTest-v0", 92, 49, None),
        ("MIMoRollOver-v0", 46, 305, None),
    ],
)
def test_ids_have_the_spaces_of_mimo_3(name: str, actions: int, numbers: int, touch: int | None) -> None:
    # an id that is registered is left alone, and the tests of MIMo 2 register theirs
    _, cls = gym.spec(name).entry_point.split(":") if name in gym.registry else ("", "")
    made = getattr(importlib.import_module("mimo_infant.simulation.envs"), cls)
    env = made(vision_params=None) if name == "MIMoBench-v0" else made()
    assert env.action_space.shape == (actions,)
    assert env.observation_space["observation"].shape == (numbers,)
    assert touch is None or env.observation_space["touch"].shape == (touch,)
    env.reset(seed=0)
    observation, reward, *_ = env.step(np.zeros(actions))
    assert np.isfinite(observation["observation"]).all()
    assert np.isfinite(reward)


@pytest.mark.parametrize(("delay", "expected"), [(0, "1234567"), (1, "1234567"), (2, "1123456"), (3, "1112345")])
def test_actions_arrive_late(delay: int, expected: str) -> None:
    env = mimo_infant.MIMoRollOverEnv(motor_delay=delay)
    env._action_history.clear()
    seen = ""
    for command in range(1, 8):
        env._set_action(np.full(env.action_space.shape, command / 20, dtype=np.float32))
        seen += str(round(float(env.data.ctrl[env.mimo_actuators[0]]) * 20))
    assert seen == expected
    env.reset()
    assert len(env._action_history) <= max(delay - 1, 0)


def test_observations_arrive_late() -> None:
    now, late = mimo_infant.MIMoRollOverEnv(), mimo_infant.MIMoRollOverEnv(sensory_delay=3)
    seen: list[list[Any]] = [[], []]
    for env, list_of in zip((now, late), seen):
        list_of.append(env.reset(seed=1)[0]["observation"])
        for _ in range(5):
            list_of.append(env.step(np.full(46, 0.2))[0]["observation"])
    assert np.array_equal(seen[1][5], seen[0][3])
    assert np.array_equal(seen[1][0], seen[1][1])
    with pytest.raises(ValueError, match="sensory_delay is -1"):
        mimo_infant.MIMoRollOverEnv(sensory_delay=-1)


def test_eyes_of_an_age_and_a_fovea() -> None:
    vision = SimpleVision.__new__(SimpleVision)
    row, column = np.mgrid[:64, :64]
    checks = 255 * ((row // 8 + column // 8) % 2)
    picture = np.stack([(column * 4) % 256, (row * 16) % 256, checks], -1).astype(np.uint8)
    for age, expected in (
        (1.5, (71.065, 61.119, 88.873)),
        (6, (71.462, 62.925, 95.419)),
        (24, (71.658, 63.791, 97.98)),
    ):
        vision.acuity_functions = {"eye": vision._get_acuity_function(64, 64, age, 60)}
        seen = vision._apply_acuity(picture, "eye")
        assert np.allclose([seen[..., c].std() for c in range(3)], expected, atol=1e-3)
    fovea = vision._apply_foveation(picture, 10.0)
    assert np.allclose([fovea[..., c].mean() for c in range(3)], (126.576, 119.009, 127.171), atol=1e-3)
    assert (fovea[32, 32, 2], fovea[10, 50, 0]) == (0, 168)


def test_an_environment_sees_with_acuity_and_foveation() -> None:
    eye = {"width": 32, "height": 32, "fovy": 60, "acuity": False, "foveation": False}
    plain = MIMoReachEnv(vision_params={"eye_left": eye}, age=6)
    blurred = MIMoReachEnv(vision_params={"eye_left": {**eye, "acuity": True, "foveation": True}}, age=6)
    pictures = []
    for env in (plain, blurred):
        env.action_space.seed(3)
        pictures.append(env.reset(seed=3)[0]["eye_left"].astype(float))
    assert not np.array_equal(*pictures)
    expected = blurred.vision._apply_acuity(pictures[0].astype(np.uint8), "eye_left")
    assert np.array_equal(pictures[1], blurred.vision._apply_foveation(expected, 10.0))


@pytest.mark.parametrize(("start", "before", "reward"), [("supine", 0.0134, 0.0037), ("prone", 0.0217, 0.0205)])
def test_rolling_over_starts_as_in_mimo_3(start: str, before: float, reward: float, monkeypatch: Any) -> None:
    monkeypatch.setattr(roll_over, "STARTING_POSITION", start)
    env = roll_over.MIMoRollOverEnv()
    env.reset(seed=7)
    assert env.get_achieved_goal() == pytest.approx(before, abs=6e-5)
    env.data.qpos[:] = env.init_position
    found = env.step(np.full(env.action_space.shape, 0.1, dtype=np.float32))
    assert found[1] == pytest.approx(reward, abs=6e-5)
    assert env.goal == 0.8
    monkeypatch.setattr(roll_over, "STARTING_POSITION", "upright")
    with pytest.raises(ValueError, match="supine or prone"):
        roll_over.MIMoRollOverEnv()


def test_growth_has_the_sizes_of_every_age() -> None:
    sizes = get_growth_params(6, "v1")
    assert sizes["geoms"]["head"]["size"][0] == pytest.approx(0.0686018, abs=1e-7)
    assert sizes["bodies"]["chest"][2] == pytest.approx(0.082023352, abs=1e-9)
    assert sizes["gears"]["act:chest_lean"] == pytest.approx(0.545026353, abs=1e-9)
    assert get_growth_params(6, "v2")["gears"]["act:left_toes"] == pytest.approx(0.093447, abs=1e-6)
    assert get_version(Path(SCENE_DIRECTORY) / "roll_over_scene.xml") == "v1"
    path = mimo_infant.adjust_mimo_to_age(6, Path(SCENE_DIRECTORY) / "roll_over_scene.xml", create_log=False)
    mimo_infant.delete_growth_scene(path)
    assert growth_function(6, 3.42223338, 0.43146575, 37.31165274) == pytest.approx(43.681, abs=1e-3)
    assert mj_unit(17.1, "cm", "len") == pytest.approx(0.0855)
    assert calc_volume([0.1], "sphere") == pytest.approx(4 / 3 * np.pi * 1e-3)
    with pytest.raises(ValueError, match="v1 or v2"):
        get_growth_params(6, "v3")
    with pytest.raises(NotImplementedError, match="custom_measurements"):
        mimo_infant.MIMoRollOverEnv(custom_measurements={("left_larm", 1): 0.07})
