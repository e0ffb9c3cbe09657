"""Runs the recipes for learners for a few steps and prints the table of docs/learners.md.

Usage: ``python benches/recipes.py [CLEANRL_SCRIPT]``.

Needs ``ray[rllib]`` and PyTorch; what is not installed is named in its row. CLEANRL_SCRIPT is a ``ppo_continuous_action.py``.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time
from pathlib import Path

EXAMPLES = Path(__file__).parent.parent / "examples"
RECIPES = {
    "RLlib, PPO, single environments": ["rllib_selftouch.py", "--iterations", "4"],
    "RLlib, PPO, the library's vector": ["rllib_selftouch.py", "--iterations", "4", "--vector"],
}
CLEANRL = ["--total-timesteps", "8192", "--num-envs", "4", "--num-steps", "256", "--cuda", "False"]
RETURN = re.compile(r"return[ =]\[?([0-9.]+)")
STEPS = re.compile(r"(?:global_step=| )([0-9]+)(?: steps|,)")


def row(name: str, arguments: list[str]) -> str:
    """Runs a recipe; returns its row."""
    started = time.perf_counter()
    command = [sys.executable, str(EXAMPLES / arguments[0]), *arguments[1:]]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - started
    returns, steps = RETURN.findall(done.stdout), STEPS.findall(done.stdout)
    if done.returncode or not returns or not steps:
        last = (done.stderr.strip().splitlines() or ["it printed nothing"])[-1]
        return f"| {name} | not run: {last[:80]} | | |"
    return f"| {name} | {int(steps[-1]):,} | {seconds:.0f} s | {float(returns[0]):.1f}, {float(returns[-1]):.1f} |"


def main() -> None:
    """Prints the table."""
    recipes = dict(RECIPES)
    if len(sys.argv) > 1:
        recipes["CleanRL, `ppo_continuous_action.py`"] = ["cleanrl_selftouch.py", sys.argv[1], *CLEANRL]
    print("| recipe | steps | whole process | return, first and last |\n|---|--:|--:|--:|")
    for name, arguments in recipes.items():
        print(row(name, arguments), flush=True)


if __name__ == "__main__":
    main()
