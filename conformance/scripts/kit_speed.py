"""Steps an environment of BabyBench's Python kit and prints the CPU time of the steps.

    python kit_speed.py KIT

Reads lines of JSON and answers each with a line. The first says which environment; its seed is that of the action space:
    {"config": "YAML", "seed": 0}                 one of BabyBench, as its make_env builds it from a configuration
    {"id": "NAME", "kwargs": {...}, "seed": 0}    any that the kit registers, under its name in Gymnasium
The others ask for random steps, of which the first few are not timed: {"warm_up": 5, "steps": 40}. The answer is the CPU
time of the process, s. The checkout is only read: logs and scenes go to the current folder.
"""

import json
import os
import sys
import time
from pathlib import Path


def make(kit, task):
    """Builds the environment and resets it."""
    sys.path[:0] = [str(kit), str(kit / "MIMo")]
    import gymnasium
    import mimoEnv  # noqa: F401 (registers the environments)

    if "config" in task:
        import yaml
        from babybench.utils import make_env

        env = make_env({**yaml.safe_load(task["config"]), "save_dir": "results"})
    else:
        env = gymnasium.make(task["id"], **task.get("kwargs", {}))
    env.action_space.seed(task["seed"])
    env.reset()
    return env


def spent(env, steps):
    """Returns the CPU time of random steps without resets, s."""
    actions = [env.action_space.sample() for _ in range(steps)]
    total = 0.0
    for action in actions:
        start = time.process_time()
        _, _, terminated, truncated, _ = env.step(action)
        total += time.process_time() - start
        if terminated or truncated:
            env.reset()
    return total


def main():
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever libraries print is no answer

    def answer(value):
        print(json.dumps(value), file=answers, flush=True)

    env = make(Path(sys.argv[1]).resolve(), json.loads(sys.stdin.readline()))
    answer("ready")
    for line in sys.stdin:
        request = json.loads(line)
        spent(env, request["warm_up"])
        answer(spent(env, request["steps"]))


if __name__ == "__main__":
    main()
