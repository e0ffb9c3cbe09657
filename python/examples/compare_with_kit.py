"""Compares this package with the starter kit, number by number.

Both record a run with the same actions, each in its own Python; then the recordings are compared:

    python compare_with_kit.py record ours.npz                            # where this package is installed
    cd BabyBench2025_Starter_Kit && python .../compare_with_kit.py record kit.npz      # where the kit is
    python compare_with_kit.py compare kit.npz ours.npz

Motion is chaotic: after some hundred steps with contacts two runs differ however close they began.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from typing import Any

import numpy as np


def record(out: str, config_file: str, steps: int) -> None:
    """Runs the environment as scripts for the kit do, and keeps the results."""
    sys.path.insert(0, os.getcwd())
    import yaml

    import babybench.utils as bb_utils

    with open(config_file) as file:
        config = yaml.safe_load(file)
    config["save_dir"] = tempfile.mkdtemp()
    env = bb_utils.make_env(config)
    env.action_space.seed(0)
    observation, _ = env.reset(seed=0)
    rows: dict[str, list[np.ndarray]] = {key: [value] for key, value in observation.items()}
    started = time.process_time()
    for _ in range(steps):
        observation, _, _, _, info = env.step(env.action_space.sample())
        for key, value in observation.items():
            rows[key].append(value)
    seconds = time.process_time() - started
    arrays: dict[str, Any] = {key: np.stack(value) for key, value in rows.items()}
    np.savez_compressed(out, info=repr(info), seconds=seconds, **arrays)
    print(f"{steps} steps in {seconds:.2f} s of CPU time, {1000 * seconds / steps:.3f} ms each; {out} has them")


def compare(one: str, other: str) -> None:
    """Prints how far apart two recordings are, after 1, 10, 100, ... steps."""
    a, b = np.load(one), np.load(other)
    senses = [key for key in a.files if key not in ("info", "seconds")]
    print(f"{'after steps':>12} " + " ".join(f"{key:>14}" for key in senses))
    last = min(len(a[senses[0]]), len(b[senses[0]])) - 1
    for step in sorted({0, 1, 10, 30, 100, 300, last}):
        if step <= last:
            apart = [np.abs(a[key][step].astype(float) - b[key][step]).max() for key in senses]
            print(f"{step:12} " + " ".join(f"{value:14.2e}" for value in apart))
    print(f"information equal: {str(a['info']) == str(b['info'])}")
    print(
        f"CPU time: {float(a['seconds']):.2f} s and {float(b['seconds']):.2f} s, {a['seconds'] / b['seconds']:.1f} times"
    )


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    recorder = commands.add_parser("record")
    recorder.add_argument("out")
    recorder.add_argument("--config", default="examples/config_selftouch.yml")
    recorder.add_argument("--steps", type=int, default=300)
    comparer = commands.add_parser("compare")
    comparer.add_argument("one")
    comparer.add_argument("other")
    args = parser.parse_args()
    if args.command == "record":
        record(args.out, args.config, args.steps)
    else:
        compare(args.one, args.other)


if __name__ == "__main__":
    main()
