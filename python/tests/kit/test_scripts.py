"""The kit's own scripts, unmodified, on what stands in for MIMo."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import pickle
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from .conftest import run

Interpreter = tuple[str, tuple[object, ...]]
HERE = Path(__file__).parent
EXAMPLES = {
    "random_selftouch": "self_touch",
    "random_handregard": "hand_regard",
    "intrinsic_selftouch_count": "self_touch",
    "intrinsic_motivation_wrapper": "self_touch",
    "intrinsic_handregard_saliency": "hand_regard",
}
NEEDED = {"intrinsic_handregard_saliency": "scipy"}
KITS_OWN = ("cv2", "skimage", "trimesh", "matplotlib")
"""Packages that the kit's `babybench/utils.py` imports."""

EPISODE = 6


def shorten(checkout: Path) -> None:
    """Makes episodes short, by configuration: logs are written at the end of each."""
    for file in (checkout / "examples").glob("*.yml"):
        text = re.sub(r"max_episode_steps *:.*", f"max_episode_steps : {EPISODE}", file.read_text())
        file.write_text(re.sub(r"save_logs_every *:.*", f"save_logs_every: {EPISODE}", text))


def learner(python: str) -> tuple[object, ...]:
    """Returns a folder with a learner, where none is installed."""
    if python == sys.executable and importlib.util.find_spec("stable_baselines3"):
        return ()
    return (HERE / "learner",)


def has(python: str, modules: tuple[str, ...]) -> bool:
    """Returns whether this Python has modules; the kit's has."""
    return python != sys.executable or all(importlib.util.find_spec(module) for module in modules)


def newer_matplotlib() -> bool:
    """Returns whether matplotlib has lost what the kit's plot of touch calls: since 3.10."""
    major, minor = importlib.metadata.version("matplotlib").split(".")[:2]
    return (int(major), int(minor)) >= (3, 10)


def log(folder: Path) -> list[dict[str, Any]]:
    """Reads a training log."""
    with (folder / "logs" / "training.pkl").open("rb") as f:
        return pickle.load(f)  # type: ignore[no-any-return]


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_run_where_the_package_is_installed(interpreter: Interpreter, checkout: Path, example: str) -> None:
    python, path = interpreter
    if not has(python, (NEEDED.get(example, "numpy"),)):
        pytest.skip(f"{NEEDED[example]} is not installed")
    shorten(checkout)
    steps = 2 * EPISODE + 1
    run(python, f"examples/{example}.py", "--train_for", steps, cwd=checkout, path=(*path, *learner(python)))
    folder = checkout / "results" / EXAMPLES[example]
    records = log(folder)
    assert [record["steps"] for record in records][-2:] == [EPISODE, EPISODE]
    assert 'file="' in (folder / "scene.xml").read_text()


@pytest.mark.parametrize("behavior", ["selftouch", "handregard", "test_installation"])
def test_the_checkouts_own_scripts_run(interpreter: Interpreter, checkout: Path, behavior: str) -> None:
    # in the root, the checkout's own babybench is imported
    python, path = interpreter
    if not has(python, KITS_OWN):
        pytest.skip(f"the kit's own scripts need {', '.join(KITS_OWN)}")
    if python == sys.executable and behavior == "selftouch" and newer_matplotlib():
        pytest.skip("the kit's own plot of touch needs matplotlib below 3.10")
    shorten(checkout)
    config = f"examples/config_{behavior}.yml"
    train = (
        "import yaml, babybench.utils as u\n"
        f"c = yaml.safe_load(open({config!r}))\n"
        "e = u.make_env(c)\n"
        f"for _ in range(3):\n    e.reset()\n    [e.step(e.action_space.sample()) for _ in range({EPISODE})]\n"
        "e.reset()\n"
        "import os; assert os.path.dirname(u.__file__) == os.path.abspath('babybench'), u.__file__\n"
    )
    run(python, "-c", train, cwd=checkout, path=path)
    done = run(python, "evaluation.py", "--config", config, "--duration", 2, "--episodes", 1, cwd=checkout, path=path)
    assert "Preliminary training score: " in done.stdout
    folder = next((checkout / "results").iterdir())
    assert (folder / "videos" / "evaluation_0.avi").stat().st_size > 10_000
    with (folder / "logs" / "evaluation_0.pkl").open("rb") as f:
        trajectory = pickle.load(f)
    assert len(trajectory["qpos"]) == len(trajectory["info"]) == 2


def test_modules_of_a_checkout_are_found_beside_the_package(checkout: Path) -> None:
    (checkout / "babybench" / "my_rewards.py").write_text("BONUS = 3\n")
    script = checkout / "examples" / "mine.py"
    script.write_text(
        "import sys\nsys.path.append('.')\nimport babybench.utils as u\nfrom babybench.my_rewards import BONUS\n"
        "print(u.make_env.__module__, BONUS)\n"
    )
    done = run(sys.executable, script, cwd=checkout)
    assert done.stdout.split() == ["babybench_kit.runs", "3"]


def test_what_is_trained_here_is_evaluated_by_the_kit(
    kit_python: str, whole: Path, checkout: Path, tmp_path: Path
) -> None:
    shorten(checkout)
    run(sys.executable, "examples/random_selftouch.py", "--train_for", 2 * EPISODE + 1, cwd=checkout)
    room = tmp_path / "room"
    room.mkdir()
    for name in ("babybench", "examples", "evaluation.py"):
        (room / name).symlink_to(whole / name)
    shutil.copytree(checkout / "results", room / "results")
    config = checkout / "examples" / "config_selftouch.yml"
    done = run(
        kit_python,
        "evaluation.py",
        "--config",
        config,
        "--duration",
        2,
        "--episodes",
        1,
        cwd=room,
        path=(whole / "MIMo",),
    )
    own = run(sys.executable, "-c", SCORE, cwd=checkout)
    score = next(line for line in done.stdout.splitlines() if line.startswith("Preliminary"))
    assert score in own.stdout


SCORE = (
    "import babybench.eval as e\n"
    "e.EVALS['self_touch'](env=None, duration=1, render=False, save_dir='results/self_touch').eval_logs()\n"
)


def test_what_the_kit_has_trained_is_evaluated_here(kit_python: str, whole: Path, checkout: Path) -> None:
    shorten(checkout)
    train = (
        "import yaml, mimoEnv, babybench.utils as u\n"
        "c = yaml.safe_load(open('examples/config_handregard.yml'))\n"
        "c['vision_active'] = False\n"
        "e = u.make_env(c)\n"
        f"for _ in range(2):\n    e.reset()\n    [e.step(e.action_space.sample()) for _ in range({EPISODE})]\n"
        "e.reset()\n"
    )
    run(kit_python, "-c", train, cwd=checkout, path=(whole / "MIMo",))
    assert [record["steps"] for record in log(checkout / "results" / "hand_regard")] == [0, EPISODE, EPISODE]
    evaluate = (
        "import sys; sys.path.remove('')\n"
        "import yaml, babybench.utils as u, babybench.eval as v\n"
        "c = yaml.safe_load(open('examples/config_handregard.yml'))\n"
        "e = u.make_env(c, training=False); e.reset()\n"
        "v = v.EVALS['hand_regard'](env=e, duration=2, render=True, save_dir=c['save_dir'])\n"
        "v.eval_logs(); v.reset()\n"
        "for _ in range(2): v.eval_step(e.step(e.action_space.sample())[4])\n"
        "v.end(4)\n"
    )
    done = run(sys.executable, "-c", evaluate, cwd=checkout)
    assert "Preliminary training score: " in done.stdout
    assert (checkout / "results" / "hand_regard" / "videos" / "evaluation_4.avi").exists()
