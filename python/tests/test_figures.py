"""Figures: what they show is what the results say."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import SMALL

import babybench
import babybench.data

pytest.importorskip("matplotlib")

from babybench import figures
from babybench_core.figures import felt, logs, raster, statistics

STEPS = 60
CONFIG = """behavior: self_touch
scene: crib
touch_active: false
vision_active: false
save_dir: {name}
seed: {seed}
max_episode_steps: 50
"""


@pytest.fixture(scope="module", name="runs")
def trained(tmp_path_factory):
    """A folder with two runs of noise."""
    folder = tmp_path_factory.mktemp("runs")
    for seed in (0, 1):
        name = f"noise-{seed}"
        (folder / f"{seed}.yml").write_text(CONFIG.format(name=name, seed=seed))
        command = [
            sys.executable,
            "-m",
            "babybench",
            "train",
            "--config",
            f"{seed}.yml",
            "--train-for",
            "400",
            "--quiet",
        ]
        done = subprocess.run([*command, "--noise", "held"], cwd=folder, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module", name="record")
def recorded(tmp_path_factory):
    """A record with touch."""
    folder = tmp_path_factory.mktemp("figures") / "record"
    env = babybench.make({**SMALL, "max_episode_steps": STEPS, "age": 6})
    noise = babybench.ActionNoise("held:0.2", env, seed=7)
    with babybench.data.Recorder(env, folder, policy="held") as recorder:
        recorder.reset(seed=3)
        for _ in range(STEPS):
            recorder.step(noise())
    return babybench.data.open(folder)


def test_curves_are_the_scores_of_the_command_line(runs):
    records = logs.read(runs / "noise-0")
    steps, score = logs.curve(records, "score")
    assert steps[-1] == 400
    done = subprocess.run(
        [sys.executable, "-m", "babybench", "score", "noise-0"], cwd=runs, capture_output=True, text=True, timeout=600
    )
    assert f"score: {score[-1]}" in done.stdout
    _, parts = logs.curve(records, "parts")
    last = [len(r["right_hand_touches"]) + len(r["left_hand_touches"]) for r in records]
    assert parts[-1] == pytest.approx(np.mean(last[-5:]))


def test_learning_curves_have_a_mean_for_each_learner(runs):
    both = figures.learning_curves({"both": [runs / "noise-0", runs / "noise-1"], "one": [runs / "noise-0"]})
    axes = both.axes[0]
    labels = [line.get_label() for line in axes.lines if not line.get_label().startswith("_")]
    assert labels == ["both (n = 2)", "one"]
    means = [line for line in axes.lines if not line.get_label().startswith("_")]
    ends = [logs.curve(logs.read(runs / f"noise-{k}"), "score")[1][-1] for k in (0, 1)]
    assert means[0].get_ydata()[-1] == pytest.approx(np.mean(ends))
    assert axes.get_ylabel() == "score"


def test_intervals_hold_what_they_should():
    values = np.random.default_rng(1).normal(size=(20, 3))
    mean, low, high = statistics.interval(values)
    error = 1.96 * values.std(0, ddof=1) / np.sqrt(20)
    np.testing.assert_allclose(high - mean, error, rtol=0.2)
    np.testing.assert_allclose(mean - low, error, rtol=0.2)
    for one in statistics.interval(values[:1]):
        np.testing.assert_array_equal(one, values[0])


def test_the_body_shows_what_was_felt(record):
    everything, own = felt.shares(record, "all"), felt.shares(record, "own")
    touched = np.zeros(len(everything))
    for step in range(STEPS):
        touched += np.abs(record[0].touch(step).reshape(len(touched), -1)).max(1) > 0
    np.testing.assert_allclose(everything, touched / STEPS)
    assert np.all(own <= everything)
    assert 0 < own.sum() < everything.sum()
    made = figures.touch_on_body({"6 months": record})
    assert [axes.get_xlabel() for axes in made.axes[:2]] == ["front", "back"]
    assert "by his own body" in made.axes[-1].get_ylabel()


def test_the_raster_has_the_times_of_the_measures(record):
    measures = record.measure(0)
    for side in ("right", "left"):
        found = raster.hand_touches(record[0], side)
        share = np.any([found[row] for row in found], axis=0).mean() if found else 0.0
        assert share == pytest.approx(measures[f"{side}_hand"]["share"])
    made = figures.touch_raster(record[0])
    assert made.axes[0].get_xlabel() == "time, s"


def test_the_command_draws_all_there_is(runs, record, tmp_path):
    command = [sys.executable, "-m", "babybench", "figures", "noise-0", "noise-1", f"six={record.folder}"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "out")], cwd=runs, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    stems = ("learning-curves", "touch-on-body", "touches-six-0")
    assert names == sorted(f"{stem}.{kind}" for stem in stems for kind in ("pdf", "svg"))
    # text stays text
    assert "environment steps" in (tmp_path / "out" / "learning-curves.svg").read_text("utf-8")
    for arguments, said in (
        (["nowhere"], "no training log"),
        (["noise-0", "--metric", "return"], "the log has no return"),
        (["noise-0", "--format", "gif"], "there is no format 'gif'"),
    ):
        command = [sys.executable, "-m", "babybench", "figures", *arguments, "--out", str(tmp_path / "other")]
        done = subprocess.run(command, cwd=runs, capture_output=True, text=True, timeout=600)
        assert done.returncode == 1
        assert said in done.stderr
        assert "Traceback" not in done.stderr


def test_benchmarks_are_drawn_from_their_file(tmp_path):
    interval = {"mean": 0.3, "low": 0.2, "high": 0.4}
    row = {"config": "c", "behavior": "self_touch", "age": None, "policy": "held", "metrics": {"score": interval}}
    (tmp_path / "benchmark.json").write_text(json.dumps({"rows": [row, {**row, "age": 3.0}], "runs": []}))
    made = figures.benchmark_bars(tmp_path)
    assert [text.get_text() for text in made.axes[0].get_yticklabels()] == ["held", "held, 3 months"]
    with pytest.raises(ValueError, match="no metric 'speed'"):
        figures.benchmark_bars(tmp_path, ["speed"])
    (tmp_path / "benchmark.json").write_text("[]")
    with pytest.raises(ValueError, match="no results of a benchmark"):
        figures.benchmark_bars(tmp_path)


def test_damaged_logs_are_refused_by_their_line(tmp_path):
    (tmp_path / "training.jsonl").write_text('{"steps": 3}\n{"steps":\n')
    with pytest.raises(ValueError, match="line 2"):
        logs.read(tmp_path)
    (tmp_path / "training.jsonl").write_text("")
    with pytest.raises(ValueError, match="no episodes"):
        logs.read(tmp_path)
    with pytest.raises(ValueError, match="no runs"):
        figures.learning_curves({})


def test_without_matplotlib_the_extra_is_named(monkeypatch, record):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'babybench\[figures\]'"):
        figures.touch_raster(record[0])
