"""Examples run, documentation tells the truth, types are those of the code."""

from __future__ import annotations

import doctest
import importlib
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import gymnasium
import pytest

HERE = Path(__file__).parent.parent
EXAMPLES = HERE / "examples"


# Ray gives up on its own processes sooner than a busy machine starts them.
PATIENT_RAY = {
    "RAY_raylet_start_wait_time_s": "600",
    "RAY_worker_register_timeout_seconds": "600",
    "RAY_gcs_server_request_timeout_seconds": "600",
    "RAY_health_check_initial_delay_ms": "600000",
}


def run(example, *arguments, cwd, **variables):
    """Runs an example; returns what it prints."""
    command = [sys.executable, str(EXAMPLES / example), *map(str, arguments)]
    env = {**os.environ, **variables}
    done = subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_quick_start(tmp_path):
    pytest.importorskip("matplotlib", reason="the picture needs matplotlib")
    said = run("quick_start.py", "--steps", 50, cwd=tmp_path)
    assert "after 50 random steps" in said
    assert "touch         17169 numbers (float32)" in said
    assert (tmp_path / "mimo.png").stat().st_size > 10_000


def test_plot_touch(tmp_path):
    pytest.importorskip("matplotlib", reason="the picture needs matplotlib")
    said = run("plot_touch.py", "--steps", 30, cwd=tmp_path)
    assert re.search(r"shows \d+ sensors that feel something", said)
    assert (tmp_path / "touch.png").stat().st_size > 30_000


def test_growing(tmp_path):
    pytest.importorskip("matplotlib", reason="the curves need matplotlib")
    said = run("growing.py", "--generations", 3, "--population", 5, "--seeds", 1, cwd=tmp_path)
    for learner, age in (("grows", 9), ("shrinks", 1), ("9 months", 9)):
        assert re.search(rf"^{learner} +rolled 0\.\d\d of the way .* at {age} months$", said, re.MULTILINE), said
    assert (tmp_path / "growing.png").stat().st_size > 10_000


@pytest.mark.parametrize("notebook", ["quick_start", "touch_on_the_body"])
def test_notebooks(notebook, tmp_path):
    nbclient = pytest.importorskip("nbclient", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("ipykernel", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("matplotlib", reason="the pictures need matplotlib")
    import nbformat

    cells = nbformat.read(EXAMPLES / f"{notebook}.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in cells.cells), "notebooks are kept without output"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Jupyter's own
        client = nbclient.NotebookClient(
            cells, timeout=300, startup_timeout=300, resources={"metadata": {"path": str(tmp_path)}}
        )
        client.execute(env={**os.environ, "MPLBACKEND": "module://matplotlib_inline.backend_inline"})
    kinds = [kind for cell in cells.cells for out in cell.get("outputs", []) for kind in out.get("data", {})]
    assert "image/png" in kinds
    assert "text/plain" in kinds


def test_ray_on_two_workers(tmp_path):
    pytest.importorskip("ray", reason="Ray is not installed")
    arguments = ("--workers", 2, "--iterations", 2, "--directions", 2, "--steps", 20)
    try:
        said = run("ray_vectors.py", *arguments, cwd=tmp_path, **PATIENT_RAY)
    except AssertionError as error:
        # 30 seconds, which no setting changes
        if "The current node timed out during startup" not in str(error):
            raise
        pytest.skip("Ray's own processes did not start in 30 seconds")
    assert re.findall(r"^ +(\d+) steps", said, re.MULTILINE) == ["160", "320"]


@pytest.mark.parametrize("vector", [[], ["--vector"]], ids=["environments", "vector"])
def test_rllib(tmp_path, vector):
    pytest.importorskip("torch", reason="PyTorch is not installed: RLlib needs it")
    pytest.importorskip("ray.rllib", reason="RLlib is not installed", exc_type=ImportError)
    arguments = ("--iterations", 1, "--batch", 200, "--envs", 2, "--episode", 50, *vector)
    said = run("rllib_selftouch.py", *arguments, cwd=tmp_path)
    assert re.search(r"1 +200 steps, .* return [0-9]", said)


def test_cleanrl_scripts_get_an_environment(tmp_path):
    # what CleanRL's scripts for continuous actions do with a name
    script = """
import argparse, gymnasium
parser = argparse.ArgumentParser()
parser.add_argument("--env-id")
parser.add_argument("--steps", type=int)
args = parser.parse_args()
envs = gymnasium.vector.SyncVectorEnv([lambda: gymnasium.wrappers.FlattenObservation(gymnasium.make(args.env_id))] * 2)
envs.reset(seed=1)
total = sum(envs.step(envs.action_space.sample())[1].sum() for _ in range(args.steps))
print(envs.single_observation_space.shape, envs.single_action_space.shape, total > 0)
"""
    (tmp_path / "script.py").write_text(script)
    said = run("cleanrl_selftouch.py", "script.py", "--steps", 20, cwd=tmp_path)
    assert re.fullmatch(r"\(\d+,\) \(\d+,\) True\n", said)


def test_ppo_in_one_file(tmp_path):
    pytest.importorskip(
        "torch", reason="PyTorch is not installed: Linux wheels of the registry come with gigabytes of CUDA"
    )
    arguments = ("--envs", 4, "--rollout", 32, "--total-steps", 256)
    said = run("ppo_single_file.py", *arguments, cwd=tmp_path)
    assert "256 steps" in said


def test_ppo_of_stable_baselines3(tmp_path):
    pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed: it needs PyTorch")
    said = run("ppo_selftouch.py", "--envs", 4, "--rollout", 32, "--steps", 256, cwd=tmp_path)
    assert "steps a second, with learning" in said
    assert (tmp_path / "ppo_selftouch.zip").exists()


def test_goal_babbling_in_pytorch(tmp_path):
    pytest.importorskip("torch", reason="PyTorch is not installed")
    said = run("babbling_torch.py", "--seeds", 1, "--steps", 16_000, cwd=tmp_path)
    measures = dict(re.findall(r"^([a-z, ]+): ([0-9.]+) \(", said, re.MULTILINE))
    assert set(measures) == {
        "score",
        "parts per episode",
        "score, evaluated",
        "parts per episode, evaluated",
        "minutes",
    }
    assert float(measures["parts per episode"]) > 1


def test_looking_at_hands_as_an_algorithm_of_stable_baselines3(tmp_path):
    pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed: it needs PyTorch")
    script = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np
import babybench
from watching_sb3 import REGARD, Body, Watching
envs = babybench.sb3.VecEnv(REGARD, 2, max_episode_steps=500)
model = Watching(env=envs, seed=0, body=Body(babybench.make(REGARD))).learn(2_000)
model.policy.posture.copy_(model.policy.posture * 0 + 0.25)
model.save("watching")
again = Watching.load("watching", env=envs)
observation = envs.reset()
one, two = model.predict(observation), again.predict(observation)
print(np.array_equal(one[0], two[0]), again.archive.lists.keys() == {0, 1, None}, model.num_timesteps)
"""
    (tmp_path / "script.py").write_text(script)
    said = run(tmp_path / "script.py", EXAMPLES, cwd=tmp_path)
    assert said == "True True 2000\n"


def test_recordings_are_compared(tmp_path):
    pytest.importorskip("babybench_kit", reason="babybench-kit is not installed")
    config = tmp_path / "config.yml"
    config.write_text("behavior: self_touch\nscene: crib\nvision_active: False\ntouch_function: force_vector\n"
                      "touch_fingers: True\nsave_dir: results\n", "utf-8")  # fmt: skip
    import yaml

    import babybench

    whole = {**babybench.config_examples()["self_touch"], "compat": "reference", "save_dir": str(tmp_path)}
    config.write_text(yaml.safe_dump(whole), "utf-8")
    for out in ("a.npz", "b.npz"):
        run("compare_with_kit.py", "record", out, "--config", config, "--steps", 12, cwd=tmp_path)
    said = run("compare_with_kit.py", "compare", "a.npz", "b.npz", cwd=tmp_path)
    assert "information equal: True" in said
    assert set(re.findall(r"\d\.\d\de[+-]\d\d", said)) == {"0.00e+00"}


@pytest.mark.parametrize(
    "module",
    [
        "babybench",
        "babybench.mujoco",
        "babybench_core.env",
        "babybench_core.noise",
        "babybench_core.senses",
        "babybench_core.vector",
        "babybench_core.view",
    ],
)
def test_the_documentation_tells_the_truth(module):
    result = doctest.testmod(importlib.import_module(module), optionflags=doctest.ELLIPSIS)
    assert result.attempted > 0
    assert result.failed == 0


@pytest.mark.parametrize("document", ["README.md", "docs/mujoco.md"])
def test_the_programs_of_the_readme_run(tmp_path, document):
    text = (HERE / document).read_text("utf-8")
    programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert programs
    for program in programs:
        if "stable_baselines3" in program and importlib.util.find_spec("stable_baselines3") is None:
            continue
        if "-v5" in program and "Ant-v5" not in gymnasium.registry:
            continue
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, program + done.stderr


def test_the_stubs_are_those_of_the_native_part():
    pytest.importorskip("mypy", reason="mypy is not installed")
    command = [sys.executable, "-m", "mypy.stubtest", "babybench_core._native"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=HERE / "tests")
    assert done.returncode == 0, done.stdout + done.stderr
