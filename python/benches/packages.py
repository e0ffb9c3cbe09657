"""Runs the environments of five packages on ``babybench.mujoco`` beside MuJoCo 3.3.0, and writes ``docs/packages.md``.

Each package has a virtual environment of its own, in which ``packages.txt`` says what is installed::

    python benches/packages.py run VENVS RESULTS        # VENVS/NAME/bin/python for each package; a file in RESULTS for each
    python benches/packages.py table RESULTS docs/packages.md

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
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

STEPS, SEED, SECONDS = 200, 0, 90
PACKAGES = ("gymnasium-robotics", "metaworld", "dm_control", "myosuite", "robosuite")
FULL = 8191
"""All parts of MuJoCo's state (``mjtState``)."""
SAME = 1e-9


class Env:
    """The interface that this script gives to the environments of all packages."""

    def __init__(self, reset: Callable[[], Any], step: Callable[[Any], Any], owner: Any, low: Any, high: Any) -> None:
        """Takes what resets and steps it; ``owner`` is looked through for its model and state."""
        self.reset, self.step, self.owner = reset, step, owner
        self.low, self.high = (np.clip(np.asarray(bound, np.float64), -1, 1) for bound in (low, high))
        self.halves = False
        """Whether a step begins with its second half, so that the first has to be done again from another state."""

    @property
    def model(self) -> Any:
        """The model of MuJoCo."""
        return _found(self.owner(), "model")

    @property
    def data(self) -> Any:
        """The state of MuJoCo."""
        return _found(self.owner(), "data")


def _found(owner: Any, name: str) -> Any:
    """Returns the model or the state that an environment holds, without the classes that packages wrap around it."""
    value = getattr(owner, name)
    for inner in ("ptr", f"_{name}"):
        value = (
            getattr(value, inner) if hasattr(type(value), inner) or inner in getattr(value, "__dict__", {}) else value
        )
    return value


def flat(value: Any) -> list[float]:
    """Returns the numbers of an observation."""
    if isinstance(value, dict):
        return [number for key in sorted(value) for number in flat(value[key])]
    if isinstance(value, (tuple, list)):
        return [number for part in value for number in flat(part)]
    array = np.asarray(value)
    return [] if array.dtype.kind not in "bifu" else [float(number) for number in array.reshape(-1)]


def _of_gymnasium(make: Callable[[], Any], inner: tuple[str, ...] = ()) -> Env:
    env = make()

    def owner() -> Any:
        found = env.unwrapped
        for name in inner:
            found = getattr(found, name, found)
        return found

    def step(action: Any) -> tuple[Any, float, bool]:
        observation, reward, terminated, truncated, _ = env.step(action.astype(env.action_space.dtype))
        return observation, float(reward), bool(terminated or truncated)

    return Env(lambda: env.reset(seed=SEED)[0], step, owner, env.action_space.low, env.action_space.high)


def _of_dm_control(make: Callable[[], Any]) -> Env:
    env = make()
    spec = env.action_spec()

    def step(action: Any) -> tuple[Any, float, bool]:
        now = env.step(action)
        return now.observation, float(now.reward or 0), now.last()

    made = Env(lambda: env.reset().observation, step, lambda: env.physics, spec.minimum, spec.maximum)
    made.halves = True
    return made


def gymnasium_robotics() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers."""
    import gymnasium
    import gymnasium_robotics

    gymnasium.register_envs(gymnasium_robotics)
    names = [name for name, spec in gymnasium.registry.items() if "gymnasium_robotics" in str(spec.entry_point)]
    inner = ("ant_env", "point_env", "robot_env", "unwrapped")
    return {name: (lambda name=name: _of_gymnasium(lambda: gymnasium.make(name), inner)) for name in names}


def metaworld() -> dict[str, Callable[[], Env]]:
    """The tasks of the package."""
    import gymnasium
    import metaworld  # noqa: F401
    from metaworld.env_dict import ALL_V3_ENVIRONMENTS

    def make(name: str) -> Env:
        return _of_gymnasium(lambda: gymnasium.make("Meta-World/MT1", env_name=name, seed=SEED))

    return {name: (lambda name=name: make(name)) for name in ALL_V3_ENVIRONMENTS}


def dm_control() -> dict[str, Callable[[], Env]]:
    """The tasks of the suite and of ``manipulation``."""
    from dm_control import manipulation, suite

    def of_suite(domain: str, task: str) -> Env:
        return _of_dm_control(lambda: suite.load(domain, task, task_kwargs={"random": SEED}))

    tasks = {f"{domain}/{task}": (lambda d=domain, t=task: of_suite(d, t)) for domain, task in suite.ALL_TASKS}
    for name in manipulation.ALL:
        tasks[f"manipulation/{name}"] = lambda name=name: _of_dm_control(lambda: manipulation.load(name, seed=SEED))
    return tasks


def myosuite() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers."""
    import myosuite
    from myosuite.utils import gym

    def make(name: str) -> Env:
        made = _of_gymnasium(lambda: gym.make(name), ("sim",))
        made.halves = True
        return made

    return {name: (lambda name=name: make(name)) for name in sorted(myosuite.myosuite_env_suite)}


def robosuite() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers, with one Panda, or two where there are two arms."""
    import robosuite
    from robosuite.environments.base import REGISTERED_ENVS

    def make(name: str) -> Env:
        robots = ["Panda", "Panda"] if name.startswith("TwoArm") else "Panda"
        settings = {"has_renderer": False, "has_offscreen_renderer": False, "use_camera_obs": False, "seed": SEED}
        env = robosuite.make(name, robots=robots, **settings)
        low, high = env.action_spec

        def step(action: Any) -> tuple[Any, float, bool]:
            observation, reward, done, _ = env.step(action)
            return observation, float(reward), bool(done)

        return Env(env.reset, step, lambda: env.sim, low, high)

    return {name: (lambda name=name: make(name)) for name in REGISTERED_ENVS}


SOURCES = {"gymnasium-robotics": gymnasium_robotics, "metaworld": metaworld, "dm_control": dm_control} | {
    "myosuite": myosuite,
    "robosuite": robosuite,
}


@contextlib.contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Ends what takes too long."""

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
    """Runs an environment on MuJoCo, and writes what it saw."""
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


def repeat(make: Callable[[], Env], mujoco: Any, path: Path) -> dict[str, Any]:
    """Repeats a run on this package, each step from MuJoCo's state, and measures how far they are apart."""
    with np.load(path) as run:
        states, actions, seen, ends = (run[name] for name in ("states", "actions", "seen", "ends"))
    env, _ = _seeded(make)
    apart, spent, worst, fresh = 0.0, 0.0, 0, True
    for number, (state, action, before_it, end) in enumerate(zip(states, actions, seen, ends)):
        mujoco.mj_setState(env.model, env.data, state, FULL)
        if env.halves:
            mujoco.mj_step1(env.model, env.data)
        before = time.process_time()
        observation, reward, _ = env.step(action)
        spent += time.process_time() - before
        now = np.array([*flat(observation), reward])
        if now.shape != before_it.shape:
            raise ValueError(f"{now.size} numbers, where MuJoCo has {before_it.size}")
        scale = max(1.0, float(np.abs(before_it).max()))
        far = float(np.abs(now - before_it).max()) / scale
        # the first observation after a reset may remember where the steps of the reset have led
        if not fresh and not far <= apart:
            apart, worst = far, number
        fresh = bool(end)
        if end:
            env.reset()
    return {"seconds": spent, "apart": apart, "worst": worst}


def one_package(package: str, side: str, folder: Path, part: str) -> None:
    """Runs the environments of a package on one side, and writes a line about each."""
    warnings.simplefilter("ignore")
    mujoco: Any
    if side == "ours":
        from babybench import mujoco

        mujoco.install()
    else:
        import mujoco
    work = record if side == "theirs" else repeat
    first, step = (int(number) for number in part.split("/"))
    environments = list(SOURCES[package]().items())
    (folder / f"{package}.count").write_text(json.dumps(len(environments)))
    for name, make in environments[first::step]:
        told: dict[str, Any] = {"name": name, "side": side}
        path = folder / package / (name.replace("/", "_") + ".npz")
        path.parent.mkdir(parents=True, exist_ok=True)
        if side == "theirs" or path.exists():
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


def run(venvs: Path, folder: Path, packages: list[str]) -> None:
    """Runs the packages, each in its own virtual environment."""
    own = Path(__file__).resolve()
    paths = os.pathsep.join(str(own.parents[1] / part) for part in (".", "kit"))
    environment = {**os.environ, "PYTHONPATH": paths, "MUJOCO_GL": "disabled"}
    for package in packages:
        (folder / f"{package}.jsonl").unlink(missing_ok=True)
        for side in ("theirs", "ours"):
            python = venvs / package / "bin" / "python"
            command = [str(python), str(own), "one", package, side, str(folder), "0/1"]
            subprocess.run(command, env=environment, check=True)


def read(folder: Path, package: str) -> dict[str, dict[str, dict[str, Any]]]:
    """Returns what is known of each environment, by name and side."""
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for line in (folder / f"{package}.jsonl").read_text().splitlines():
        told = json.loads(line)
        found.setdefault(told["name"], {})[told["side"]] = told
    return found


def _reason(error: str) -> str:
    """Returns an error without what differs between environments."""
    text = error.split("\n")[0].split(" (HINT")[0].split("', '")[0].replace("|", "/").strip("(\"' ")
    return text[:110]


def table(folder: Path, out: Path, speed: bool) -> None:
    """Writes the tables, with a column of speed if asked."""
    head = ["package", "registered", "tried", "run on MuJoCo", "run here", "agree to 1e-9", "to 1e-6"]
    rows, reasons, sums = [], Counter[tuple[str, str]](), []
    for package in PACKAGES:
        found = read(folder, package)
        registered = json.loads((folder / f"{package}.count").read_text())
        counts, ratios = [registered, len(found), 0, 0, 0, 0], []
        for name, sides in sorted(found.items()):
            theirs, ours = sides.get("theirs", {}), sides.get("ours", {})
            runs, here, apart = "seconds" in theirs, "seconds" in ours, ours.get("apart", 1.0)
            flags = (False, False, runs, here, here and apart <= SAME, here and apart <= 1e-6)
            counts = [count + flag for count, flag in zip(counts, flags)]
            if here:
                ratios.append(ours["seconds"] / max(1e-9, theirs["seconds"]))
                rows.append([package, name, f"{apart:.0e}", f"{ratios[-1]:.2f}"])
            else:
                error = ours.get("error") or theirs.get("error") or "not run"
                reasons[f"{package}, {'here alone' if runs else 'MuJoCo too'}", _reason(error)] += 1
        sums.append([package, *map(str, counts), f"{np.median(ratios):.2f}" if ratios else ""])
    sums.append(["all", *(str(sum(int(row[k]) for row in sums)) for k in range(1, len(head))), ""])
    why = [[where, reason, str(count)] for (where, reason), count in reasons.most_common()]
    last = ["step over theirs"] if speed else []
    text = [
        INTRODUCTION + (SPEED if speed else ""),
        _markdown(head + last, sums),
        "## What keeps the others from running",
        _markdown(["where", "why", "environments"], why),
        "## Environments",
        _markdown(["package", "environment", "apart", *last], rows),
    ]
    out.write_text("\n\n".join(text) + "\n")


def _markdown(head: list[str], rows: list[list[str]]) -> str:
    """Returns a table, of the columns that have a heading."""
    lines = [head, ["---"] * len(head), *(row[: len(head)] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


INTRODUCTION = """# Packages of environments on babybench.mujoco

Five packages run on [`babybench.mujoco`](mujoco.md) as PyPI ships them, after `babybench.mujoco.install()`.
`benches/packages.txt` has their versions, and `benches/packages.py` writes this page. An environment runs if it is made,
reset and stepped 200 times with random actions without an error.

Both runs have the same seeds and actions, and each step here starts from the state that MuJoCo 3.3.0 had. *Apart* is the
largest difference of an observation or a reward, relative to the largest number beside it, or to 1. The first step after
a reset is left out: some observations remember where the steps of the reset have led."""

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
    single = commands.add_parser("one")
    for name in ("package", "side", "results", "part"):
        single.add_argument(name)
    last = commands.add_parser("table")
    last.add_argument("results", type=Path)
    last.add_argument("out", type=Path)
    last.add_argument("--speed", action="store_true", help="with a column of the CPU time of steps")
    given = parser.parse_args()
    if given.command == "run":
        run(given.venvs, given.results, given.packages)
    elif given.command == "one":
        one_package(given.package, given.side, Path(given.results), given.part)
    else:
        table(given.results, given.out, given.speed)


if __name__ == "__main__":
    sys.exit(main())
