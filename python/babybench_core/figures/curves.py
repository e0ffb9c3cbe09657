"""Learning curves, and the results of benchmarks."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from babybench_core.figures import logs
from babybench_core.figures.statistics import interval
from babybench_core.figures.style import COLOURS, COLUMN, figure, library, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Runs = Mapping[str, Sequence[Union[str, Path]]]
_POINTS = 200
"""Points of a curve."""
_HEADINGS = {
    "score": "score",
    "parts_per_episode": "parts touched, per episode",
    "mean_return": "return",
    "successes": "share of successes",
    "touches_per_minute": "touches per minute",
    "touch_duration": "duration of a touch, s",
    "touch_share": "touching, share of time",
    "hand_to_hand": "hand to hand, share of time",
    "double_touch": "double touch, share of time",
    "handedness": "handedness",
    "smoothness": "smoothness",
    "symmetry": "symmetry",
    "hands_seen": "hand seen, share of images",
}


def learning_curves(runs: Runs, metric: Optional[str] = None, *, every_seed: bool = True) -> Figure:
    """Draws the mean over seeds with its interval of 95 %, against the number of steps, for each of several learners.

    Args:
        runs: Runs of each learner by its name, one for each seed: folders of runs, or files ``training.jsonl``.
        metric: ``score`` (of all episodes so far), ``parts``, ``in view``, ``return`` or ``success`` (means over the last
            tenth of the episodes); by default the score, of tasks the return.
        every_seed: Whether each seed has a thin line of its own.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
        FileNotFoundError: There is no log.
        ValueError: No runs, a damaged log, or one without the metric.
    """
    library()
    if not runs or not all(runs.values()):
        raise ValueError("there are no runs to draw: give at least one for each name")
    read = {label: [logs.read(path) for path in paths] for label, paths in runs.items()}
    metric = metric or logs.default_metric(next(iter(read.values()))[0][0])
    with library().rc_context(look()):
        made = figure(COLUMN, 2.4)
        axes = made.add_subplot()
        for k, (label, seeds) in enumerate(read.items()):
            _curve(axes, label, [logs.curve(seed, metric) for seed in seeds], COLOURS[k % len(COLOURS)], every_seed)
        axes.set_xlabel("environment steps")
        axes.set_ylabel(logs.METRICS[metric])
        _steps_axis(axes)
        if metric != "return":
            axes.set_ylim(bottom=0)
        axes.margins(x=0.01)
        made.legend(loc="outside upper center", ncols=min(3, len(read)), handlelength=1.2, columnspacing=1.2)
        return made


def _curve(axes: Any, label: str, seeds: list[tuple[Any, Any]], colour: str, every_seed: bool) -> None:
    # a curve ends with the shortest of its seeds
    first, last = max(x[0] for x, _ in seeds), min(x[-1] for x, _ in seeds)
    grid = np.linspace(min(first, last), last, _POINTS)
    values = np.stack([np.interp(grid, x, y) for x, y in seeds])
    mean, low, high = interval(values)
    if len(seeds) > 1:
        axes.fill_between(grid, low, high, color=colour, alpha=0.2, linewidth=0)
        if every_seed:
            axes.plot(grid, values.T, color=colour, alpha=0.35, linewidth=0.5)
    count = f" (n = {len(seeds)})" if len(seeds) > 1 else ""
    axes.plot(grid, mean, color=colour, label=f"{label}{count}")


def _steps_axis(axes: Any) -> None:
    """Labels thousands as k and millions as M."""
    from matplotlib.ticker import EngFormatter, MaxNLocator

    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.xaxis.set_major_formatter(EngFormatter(sep=""))


def benchmark_bars(path: Union[str, Path], metrics: Optional[Sequence[str]] = None) -> Figure:
    """Draws the means of a benchmark with their intervals of 95 %: a panel for each metric, a line for each policy and age.

    Args:
        path: ``benchmark.json``, or the folder that has it.
        metrics: Names of metrics, as in the file; by default score, parts, return, touches and double touch, if present.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
        FileNotFoundError: There is no benchmark.
        ValueError: The file is damaged, or has no such metric.
    """
    library()
    rows = read_benchmark(path)["rows"]
    there = [name for row in rows for name in row["metrics"]]
    usual = (
        "score",
        "parts_per_episode",
        "mean_return",
        "successes",
        "touches_per_minute",
        "double_touch",
        "hands_seen",
    )
    chosen = list(metrics) if metrics is not None else [name for name in usual if name in there]
    for name in chosen:
        if name not in there:
            raise ValueError(f"{path}: no metric {name!r}; there are {', '.join(dict.fromkeys(there))}")
    if not chosen:
        raise ValueError(f"{path}: the benchmark has no metric to draw")
    several = len({row["config"] for row in rows}) > 1
    labels = [_label(row, several) for row in rows]
    shades = {policy: COLOURS[k % len(COLOURS)] for k, policy in enumerate(dict.fromkeys(r["policy"] for r in rows))}
    with library().rc_context(look()):
        made = figure(1.4 + 1.75 * len(chosen), 0.7 + 0.2 * len(rows))
        panels = made.subplots(1, len(chosen), sharey=True, squeeze=False)[0]
        for axes, name in zip(panels, chosen):
            for k, row in enumerate(rows):
                found = row["metrics"].get(name)
                if found is None:
                    continue
                axes.plot([found["low"], found["high"]], [k, k], color=shades[row["policy"]], solid_capstyle="butt")
                axes.plot(found["mean"], k, "o", color=shades[row["policy"]], markersize=3.5)
            axes.set_xlabel(_HEADINGS.get(name, name.replace("_", " ")))
            axes.set_xlim(left=min(0.0, axes.get_xlim()[0]))
            axes.grid(axis="x", linewidth=0.3, color="#d0d0d0")
            axes.set_axisbelow(True)
            axes.tick_params(left=False)
        panels[0].set_yticks(range(len(rows)), labels)
        panels[0].set_ylim(len(rows) - 0.5, -0.5)
        return made


def months(age: float) -> str:
    """Returns an age in words: 1 month, 6 months."""
    return f"{age:g} {'month' if age == 1 else 'months'}"


def _label(row: Mapping[str, Any], several: bool) -> str:
    age = "" if row["age"] is None else f", {months(row['age'])}"
    config = f"{row['config']}, " if several else ""
    return f"{config}{row['policy']}{age}"


def read_benchmark(path: Union[str, Path]) -> dict[str, Any]:
    """Reads the results of a benchmark.

    Raises:
        FileNotFoundError: The file does not exist.
        ValueError: The file is damaged.
    """
    file = Path(path)
    file = file / "benchmark.json" if file.is_dir() else file
    try:
        found = json.loads(file.read_text("utf-8"))
        if found["rows"] and all("metrics" in row for row in found["rows"]):
            return dict(found)
    except (ValueError, TypeError, KeyError):
        pass
    raise ValueError(f"{file}: no results of a benchmark")
