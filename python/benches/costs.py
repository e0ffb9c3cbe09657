"""Costs of the Python side beside the core, measured in turn.

Run it with ``python benches/costs.py``; it prints a table. ``--quick`` takes a tenth of the time.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

import babybench
from babybench_core import _native, scenes

ROUNDS = 40


def alternate(
    pieces: dict[str, Callable[[], None]], steps: int, clock: Callable[[], float], rounds: int
) -> dict[str, float]:
    """Times pieces of work in turn, in seconds for each of ``steps``.

    Returns the median of CPU time; of wall time the least, as that of a busy machine is other programs' too.
    """
    typical: Callable[[list[float]], float] = min if clock is time.perf_counter else statistics.median
    times: dict[str, list[float]] = {name: [] for name in pieces}
    for _ in range(rounds):
        for name, work in pieces.items():
            started = clock()
            work()
            times[name].append((clock() - started) / steps)
    return {name: typical(values) for name, values in times.items()}


def one_environment(example: str, rounds: int) -> None:
    """Prints the cost of a step in Rust, and that of Gymnasium's step."""
    steps = 100 if example == "self_touch" else 20
    config = scenes.read_config(example, max_episode_steps=10**9)
    core = _native.Env(scenes.blueprint(config))
    env, views = babybench.Env(config), babybench.Env(config, views=True)
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1, 1, (steps, *env.action_space.low.shape)).astype(np.float32)
    for one in (core, env, views):
        one.reset(seed=0)
    start = core.snapshot()

    def bare() -> None:
        core.restore(start)
        core.run(actions)

    def stepped(env: babybench.Env) -> Callable[[], None]:
        def work() -> None:
            env.restore(start)
            for action in actions:
                env.step(action)

        return work

    pieces = {"core": bare, "env.step": stepped(env), "env.step, views": stepped(views)}
    found = alternate(pieces, steps, time.process_time, rounds)
    for name, seconds in found.items():
        more = "" if name == "core" else f"   core + {1e6 * (seconds - found['core']):.1f}"
        print(f"{example:12} {name:18} {1e6 * seconds:9.1f} us{more}")


def scripts(example: str, rounds: int) -> None:
    """Prints the costs of the attributes that scripts for the starter kit read."""
    import babybench.utils as bb_utils

    steps = 100 if example == "self_touch" else 20
    config = scenes.read_config(example, max_episode_steps=10**9, compat="reference")
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env = bb_utils.make_env({**config, "save_dir": folder})
    env.action_space.seed(0)
    env.reset()
    actions = np.random.default_rng(0).uniform(-1, 1, (steps, *env.action_space.shape)).astype(np.float32)
    core = env.unwrapped._core
    start = core.engine.snapshot()
    kind = type(env.unwrapped.data).__module__

    def outputs(u: Any) -> None:
        for sense in (u.touch, u.proprioception, u.vestibular, u.vision):
            if sense is not None:
                sense.sensor_outputs  # noqa: B018

    def work(look: Callable[[Any], object], holds: bool = False) -> Callable[[], None]:
        def run() -> None:
            core.engine.restore(start)
            core.changed()
            held = env.unwrapped.data if holds else None
            for action in actions:
                env.step(action)
                look(env.unwrapped)
            del held

        return run

    # the last piece makes MuJoCo compute contacts from then on, so it runs alone
    pieces = {
        "env.step": work(lambda u: None),
        "all sensor_outputs": work(outputs),
        "held data": work(lambda u: None, True),
    }
    found = alternate(pieces, steps, time.process_time, rounds)
    pieces = {"": pieces["env.step"], "held data, contacts": work(lambda u: u.data.ncon, True)}
    with_contacts = alternate(pieces, steps, time.process_time, rounds)
    found["held data, contacts"] = with_contacts["held data, contacts"] - with_contacts[""] + found["env.step"]
    for name, seconds in found.items():
        more = "" if name == "env.step" else f"   step + {1e6 * (seconds - found['env.step']):.1f}"
        print(f"{example:12} {name:20} {1e6 * seconds:9.1f} us{more}")
    print(f"{example:12} data is {kind}")


def vectors(rounds: int) -> None:
    """Prints what two threads gain, and what the Python side of a vector costs."""
    n, steps = 16, 20
    make = {
        "one thread": babybench.VectorEnv("self_touch", n, threads=1, copy=False, max_episode_steps=10**9),
        "one thread, copies": babybench.VectorEnv("self_touch", n, threads=1, max_episode_steps=10**9),
        "two threads": babybench.VectorEnv("self_touch", n, threads=2, copy=False, max_episode_steps=10**9),
    }
    shape = (steps, n, len(make["one thread"].single_action_space.low))
    actions = np.random.default_rng(0).uniform(-1, 1, shape).astype(np.float32)
    make["one thread"].reset(seed=0)
    starts = [make["one thread"].snapshot(i) for i in range(n)]

    def seconds(name: str, clock: Callable[[], float], rust: bool = False) -> float:
        envs = make[name]
        for i, start in enumerate(starts):
            envs.restore(i, start)
        started = clock()
        if rust:
            envs._core.run(actions)
        else:
            for batch in actions:
                envs.step(batch)
        return clock() - started

    for envs in make.values():
        envs.reset(seed=0)
    wall = {name: min(seconds(name, time.perf_counter) for _ in range(rounds)) for name in make}
    for name, least in wall.items():
        print(f"vector of {n}: {name:20} {1e6 * least / steps / n:7.1f} us of wall time a step")
    print(f"two threads: {wall['one thread'] / wall['two threads']:.2f} times one")
    for name in ("one thread", "one thread, copies"):
        pairs = [
            seconds(name, time.process_time) / seconds("one thread", time.process_time, rust=True)
            for _ in range(4 * rounds)
        ]
        print(f"{name}: {100 * (statistics.median(pairs) - 1):+.1f} % over the vector of Rust (CPU time)")


FIRST_STEP = """
import time; started = time.process_time()
import babybench
env = babybench.make("self_touch"); env.reset(seed=0); env.step(env.action_space.sample())
print(time.process_time() - started)
"""
MEMORY = """
import babybench
def memory(key):
    return int(next(l for l in open("/proc/self/status") if l.startswith(key)).split()[1]) / 1024
def run(env):
    env.reset(seed=0)
    for _ in range(200): env.step(env.action_space.sample())
envs = [babybench.make("self_touch")]; run(envs[0])
whole, one = memory("VmHWM"), memory("VmRSS")
for _ in range(16):
    envs.append(babybench.make("self_touch")); run(envs[-1])
print(whole, (memory("VmRSS") - one) / 16)
"""


def processes() -> None:
    """Prints what a process costs: time to the first step, memory."""

    def run(script: str) -> list[float]:
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        return [float(word) for word in done.stdout.split()]

    first = min(run(FIRST_STEP)[0] for _ in range(5))
    print(f"import and first step: {first:.2f} s of CPU time")
    if sys.platform == "linux":
        whole, more = run(MEMORY)
        print(f"whole process: {whole:.0f} MB; a further environment: {more:.1f} MB")


def main() -> None:
    """Prints all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    rounds = ROUNDS // 10 if parser.parse_args().quick else ROUNDS
    one_environment("self_touch", rounds)
    one_environment("hand_regard", max(3, rounds // 4))
    scripts("self_touch", rounds)
    scripts("hand_regard", max(3, rounds // 4))
    vectors(rounds)
    processes()


if __name__ == "__main__":
    main()
