"""Runs the environments of five packages on ``babybench.mujoco`` beside MuJoCo 3.3.0, and writes docs/packages.md.

Each package has a virtual environment of its own, in which ``packages.txt`` says what is installed::

    python benches/packages.py run VENVS RESULTS        # VENVS/NAME/bin/python for each package; a file in RESULTS for each
    python benches/packages.py table RESULTS ../docs/packages.md --speed

A run that was interrupted goes on where it ended; ``--again`` repeats what this package did, as after a change of it.
Both runs have the same seeds and actions. That on this package starts each step from the state that MuJoCo had.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import signal
import subprocess
import sys
import textwrap
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from package_envs import SEED, SOURCES, Env, flat

STEPS, SECONDS = 200, 90
PACKAGES = ("gymnasium-robotics", "metaworld", "dm_control", "myosuite", "robosuite")
FULL = 8191
"""All parts of MuJoCo's state (``mjtState``)."""
SAME = 1e-9
NUDGE = 1e-15
"""How far a start is moved to see what MuJoCo makes of it, relative to each position and velocity."""
COMMIT = "BABYBENCH_COMMIT"
"""The variable that hands the commit of this package on."""
SIDES = ("theirs", "ours", "nudged")


@contextlib.contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Ends a run that takes too long."""

    def late(*_: Any) -> None:
        raise TimeoutError(f"more than {seconds} s of CPU time")

    signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _seeded(make: Callable[[], Env]) -> tuple[Env, np.random.Generator]:
    random.seed(SEED)
    np.random.seed(SEED)
    env = make()
    env.reset()
    return env, np.random.default_rng(SEED)


def record(make: Callable[[], Env], mujoco: Any, path: Path) -> dict[str, Any]:
    """Runs an environment on MuJoCo, and writes the results."""
    env, rng = _seeded(make)
    states, actions, seen, ends, spent = [], [], [], [], 0.0
    for _ in range(STEPS):
        state = np.zeros(mujoco.mj_stateSize(env.model, FULL))
        mujoco.mj_getState(env.model, env.data, state, FULL)
        action = rng.uniform(env.low, env.high)
        before = time.process_time()
        observation, reward, end = env.step(action)
        spent += time.process_time() - before
        states.append(state)
        actions.append(action)
        seen.append([*flat(observation), reward])
        ends.append(end)
        if end:
            env.reset()
    np.savez(path, states=states, actions=actions, seen=seen, ends=ends)
    return {"seconds": spent}


def repeat(make: Callable[[], Env], mujoco: Any, path: Path, nudge: float = 0.0, seed: int = 0) -> dict[str, Any]:
    """Repeats a run, each step from MuJoCo's state or one that is ``nudge`` away, and measures how far they are apart."""
    random_numbers = np.random.default_rng(seed)
    with np.load(path) as run:
        states, actions, seen, ends = (run[name] for name in ("states", "actions", "seen", "ends"))
    env, _ = _seeded(make)
    far, spent = np.zeros(len(seen)), 0.0
    for number, (state, action, before_it, end) in enumerate(zip(states, actions, seen, ends)):
        mujoco.mj_setState(env.model, env.data, state, FULL)
        for array in (env.data.qpos, env.data.qvel) if nudge else ():
            array[:] *= 1 + nudge * random_numbers.uniform(-1, 1, array.size)
        if env.halves:
            mujoco.mj_step1(env.model, env.data)
        before = time.process_time()
        observation, reward, _ = env.step(action)
        spent += time.process_time() - before
        now = np.array([*flat(observation), reward])
        if now.shape != before_it.shape:
            raise ValueError(f"{now.size} numbers, where MuJoCo has {before_it.size}")
        scale = max(1.0, float(np.abs(before_it).max()))
        far[number] = np.abs(now - before_it).max() / scale
        if end:
            env.reset()
    # the first observation after a reset may remember where the steps of the reset have led
    later = ~np.concatenate([[True], ends[:-1]])
    measured = np.where(later if later.any() else True, far, 0.0)
    worst = int(np.argmax(np.where(np.isfinite(measured), measured, np.inf)))
    return {"seconds": spent, "apart": float(measured[worst]), "worst": worst}


def sensitivity(make: Callable[[], Env], mujoco: Any, path: Path) -> dict[str, Any]:
    """Measures how far MuJoCo is from itself after steps that start ``NUDGE`` away, in the worst of three runs."""
    return {"apart": max(repeat(make, mujoco, path, NUDGE, seed)["apart"] for seed in range(3))}


def one_package(package: str, side: str, folder: Path, part: str) -> None:
    """Runs the environments of a package on one side, and writes a line about each."""
    warnings.simplefilter("ignore")
    mujoco: Any
    if side == "ours":
        from babybench import mujoco

        mujoco.install()
    else:
        import mujoco
    work = {"theirs": record, "ours": repeat, "nudged": sensitivity}[side]
    first, step = (int(number) for number in part.split("/"))
    environments = list(SOURCES[package]().items())
    (folder / f"{package}.names").write_text(json.dumps([name for name, _ in environments]))
    known = read(folder, package)
    commit = os.environ.get(COMMIT, "")
    for name, make in environments[first::step]:
        told: dict[str, Any] = {"name": name, "side": side, "commit": commit}
        path = folder / package / (name.replace("/", "_") + ".npz")
        path.parent.mkdir(parents=True, exist_ok=True)
        sides = known.get(name, {})
        wanted = side == "theirs" or path.exists()
        if side == "nudged":
            wanted = sides.get("ours", {}).get("apart", 0) > SAME
        if side not in sides and wanted:
            try:
                with limited(SECONDS):
                    told.update(work(make, mujoco, path))
            except BaseException as error:  # an environment may raise anything
                if isinstance(error, KeyboardInterrupt):
                    raise
                place = traceback.extract_tb(error.__traceback__)[-1]
                told.update(
                    error=f"{type(error).__name__}: {error}"[:400], place=f"{Path(place.filename).name}:{place.lineno}"
                )
            with (folder / f"{package}.jsonl").open("a") as file:
                file.write(json.dumps(told) + "\n")


def run(venvs: Path, folder: Path, packages: list[str], part: str, again: bool) -> None:
    """Runs the environments of packages that have not run yet, each package in its own virtual environment."""
    folder.mkdir(parents=True, exist_ok=True)
    own = Path(__file__).resolve()
    paths = os.pathsep.join(str(own.parents[1] / part) for part in (".", "kit"))
    asked = ["git", "-C", str(own.parent), "rev-parse", "--short=8", "HEAD"]
    commit = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()
    environment = {**os.environ, "PYTHONPATH": paths, "MUJOCO_GL": "disabled", COMMIT: commit}
    for package in packages:
        if again:
            keep = [sides["theirs"] for sides in read(folder, package).values() if "theirs" in sides]
            (folder / f"{package}.jsonl").write_text("".join(json.dumps(told) + "\n" for told in keep))
        for side in SIDES:
            python = venvs / package / "bin" / "python"
            command = [str(python), str(own), "one", package, side, str(folder), part]
            subprocess.run(command, env=environment, check=True)


def read(folder: Path, package: str) -> dict[str, dict[str, dict[str, Any]]]:
    """Returns what is known about each environment, by name and side."""
    found: dict[str, dict[str, dict[str, Any]]] = {}
    path = folder / f"{package}.jsonl"
    for line in path.read_text().splitlines() if path.exists() else ():
        told = json.loads(line)
        found.setdefault(told["name"], {})[told["side"]] = told
    return found


def _reason(error: str) -> str:
    """Returns an error without the parts that differ between environments."""
    text = error.split("\n")[0].split(" (HINT")[0].split("', '")[0].replace("|", "/").strip("(\"' ")
    return text[:110]


def table(folder: Path, out: Path, speed: bool) -> None:
    """Writes the tables, with a column of speed if asked."""
    head = ["package", "registered", "tried here", "run on MuJoCo", "run here", "agree to 1e-9", "as near as MuJoCo"]
    rows, sums = [], []
    reasons: dict[tuple[str, str], list[str]] = {}
    for package in PACKAGES:
        found = read(folder, package)
        registered = json.loads((folder / f"{package}.names").read_text())
        counts, ratios = [len(registered), 0, 0, 0, 0, 0], []
        for name in sorted(registered):
            sides = found.get(name, {})
            theirs, ours = sides.get("theirs", {}), sides.get("ours", {})
            runs, here, apart = "seconds" in theirs, "seconds" in ours, ours.get("apart", 1.0)
            spread = sides.get("nudged", {}).get("apart", 0.0)
            near = here and apart <= max(SAME, 10 * spread)
            flags = (False, bool(ours) or "error" in theirs, runs, here, here and apart <= SAME, near)
            counts = [count + flag for count, flag in zip(counts, flags)]
            if here:
                ratios.append(ours["seconds"] / max(1e-9, theirs["seconds"]))
                note = NOTES.get(name, "" if near else "not explained" if spread else "not nudged")
                other = f"{spread:.0e}" if spread else ""
                rows.append([package, name, f"{apart:.0e}", other, note, ours.get("commit", ""), f"{ratios[-1]:.2f}"])
            else:
                where = "here alone" if runs and ours else "MuJoCo too" if "error" in theirs else "not tried"
                error = ours.get("error") or theirs.get("error") or ""
                reasons.setdefault((f"{package}, {where}", _reason(error)), []).append(name)
        sums.append([package, *map(str, counts), f"{np.median(ratios):.2f}" if ratios else ""])
    sums.append(["all", *(str(sum(int(row[k]) for row in sums)) for k in range(1, len(head))), ""])
    why = [
        f"{len(names)} of {where}{reason and ': '}{reason}\n\n{textwrap.fill(' '.join(f'`{name}`' for name in names), 140)}"
        for (where, reason), names in sorted(reasons.items(), key=lambda pair: -len(pair[1]))
    ]
    last = ["step over theirs"] if speed else []
    text = [
        INTRODUCTION + (SPEED if speed else ""),
        _markdown(head + last, sums),
        "## What has not run",
        *why,
        "## Environments",
        _markdown(["package", "environment", "apart", "MuJoCo nudged", "note", "commit", *last], rows),
    ]
    lines = "\n\n".join(text).splitlines()
    out.write_text("\n".join(line.rstrip() for line in lines) + "\n")


def _markdown(head: list[str], rows: list[list[str]]) -> str:
    """Returns a table of the columns that have a heading."""
    lines = [head, ["---"] * len(head), *(row[: len(head)] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


INTRODUCTION = """# Packages of environments on babybench.mujoco

Five packages run on [`babybench.mujoco`](../python/docs/mujoco.md) as PyPI ships them, after `babybench.mujoco.install()`.
[`packages.txt`](../python/benches/packages.txt) has their versions, and `python/benches/packages.py` writes this page; each
row says on which commit it was run, and what has not run is listed below by name. An environment runs if it is made,
reset and stepped 200 times with random actions without an error.

Both runs have the same seeds and actions, and each step here starts from the state that MuJoCo 3.3.0 had. *Apart* is the
largest difference of an observation or a reward, relative to the largest number beside it, or to 1. The first step after
a reset is left out, unless each step ends an episode: some observations remember where the steps of the reset have led.
Observations of MyoSuite are single precision, so they are equal where differences are smaller than that.

Where they are farther apart than 1e-9, *MuJoCo nudged* is as far as MuJoCo is from itself when its steps start from states
that were changed by 1e-15 of each number, in the worst of up to three runs: contacts that begin or end within a step, and solvers
that stop one iteration earlier, multiply such differences. *As near as MuJoCo* counts the environments within 1e-9 or ten
times that."""

NOTES = dict.fromkeys(("push-v3", "push-wall-v3"), "its goal lies where the steps of the reset have led")
"""Why environments are apart, where a nudge of MuJoCo does not show it."""
SPEED = """

The last column compares the CPU time of the package's whole step, which is mostly Python in some of them; 0.5 is twice as
fast."""


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("run")
    one.add_argument("venvs", type=Path)
    one.add_argument("results", type=Path)
    one.add_argument("packages", nargs="*", default=list(PACKAGES))
    one.add_argument("--part", default="0/1", help="K/N: each Nth environment, from the Kth on")
    one.add_argument("--again", action="store_true", help="repeat the runs of this package")
    single = commands.add_parser("one")
    for name in ("package", "side", "results", "part"):
        single.add_argument(name)
    last = commands.add_parser("table")
    last.add_argument("results", type=Path)
    last.add_argument("out", type=Path)
    last.add_argument("--speed", action="store_true", help="with a column of the CPU time of steps")
    given = parser.parse_args()
    if given.command == "run":
        run(given.venvs, given.results, given.packages, given.part, given.again)
    elif given.command == "one":
        one_package(given.package, given.side, Path(given.results), given.part)
    else:
        table(given.results, given.out, given.speed)


if __name__ == "__main__":
    sys.exit(main())
