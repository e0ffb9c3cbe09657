"""MIMo learns to roll over while he grows, and at one age, and both curves are plotted.

Every joint follows a few targets in turn (a curve for each actuator), and the cross-entropy method keeps those that roll MIMo
farthest. One learner is 1 month old at first and 9 months at the end, one shrinks from 9 months to 1, and one is 9 months old
throughout. ``age: {0: 1, ...}`` is all that differs; spaces, names and the learner are the same.

    pip install matplotlib
    python growing.py                                     # a minute on two cores
    python growing.py --seeds 5 --generations 100         # with bands over seeds
"""

from __future__ import annotations

import argparse
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import babybench

YOUNG, OLD = 1.0, 9.0  # months
STEPS = 150  # of an episode: 1.5 s
POINTS = 5  # of each actuator's curve
ELITE = 4  # curves that a generation learns from
SETTINGS = {
    "behavior": "roll_over",
    "strength": "infant",
    "springs": "weight",
    "touch_active": False,
    "vestibular_active": False,
}


def ages_of(steps: int) -> dict[str, Any]:
    """Returns the ages of each learner over a training of some steps: the last fifth, at least an episode, is at the last age."""
    until = min(steps * 4 // 5, steps - STEPS)
    return {
        "grows": {0: YOUNG, until: OLD},
        "shrinks": {0: OLD, until: YOUNG},
        f"{OLD:g} months": OLD,
    }


def learn(age: Any, generations: int, population: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Learns, and returns how far the elite of each generation rolled, 0 to 1, and its age."""
    envs = babybench.VectorEnv({**SETTINGS, "age": age}, population)
    rng = np.random.default_rng(seed)
    mean = np.zeros((POINTS, *envs.single_action_space.shape))
    deviation = np.full_like(mean, 0.6)
    low, high = envs.single_action_space.low, envs.single_action_space.high
    moments = np.linspace(0, POINTS - 1, STEPS)
    rolled, ages = np.zeros(generations), np.zeros(generations)
    for generation in range(generations):
        curves = mean + deviation * rng.standard_normal((population, *mean.shape))
        observations, infos = envs.reset(seed=seed * 1000 + generation)
        farthest = np.zeros(population)
        for moment in moments:
            at = min(int(moment), POINTS - 2)
            action = curves[:, at] + (moment - at) * (curves[:, at + 1] - curves[:, at])
            observations, _, _, _, infos = envs.step(np.clip(action, low, high).astype(np.float32))
            farthest = np.maximum(farthest, observations["achieved_goal"][:, 0])
        elite = np.argsort(farthest)[-ELITE:]
        mean += 0.7 * (curves[elite].mean(axis=0) - mean)
        deviation += 0.7 * (np.maximum(curves[elite].std(axis=0), 0.1) - deviation)
        rolled[generation] = farthest[elite].mean()
        ages[generation] = infos["age"][0] if "age" in infos else age
    envs.close()
    return rolled, ages


def main() -> None:
    """Trains all learners and plots their curves."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--generations", type=int, default=24)
    parser.add_argument("--population", type=int, default=12)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--out", default="growing.png")
    options = parser.parse_args()
    figure, (learning, growth) = plt.subplots(2, sharex=True, height_ratios=(3, 1), figsize=(6, 5))
    steps = np.arange(1, options.generations + 1) * STEPS
    for name, ages in ages_of(options.generations * STEPS).items():
        runs = [learn(ages, options.generations, options.population, seed) for seed in range(options.seeds)]
        rolled = np.array([rolled for rolled, _ in runs])
        share, age = rolled[:, -5:].mean(), runs[0][1][-1]
        print(f"{name:10} rolled {share:.2f} of the way in the last five generations, at {age:g} months")
        (line,) = learning.plot(steps, rolled.mean(axis=0), label=name)
        learning.fill_between(steps, rolled.min(axis=0), rolled.max(axis=0), alpha=0.2, color=line.get_color())
        growth.plot(steps, runs[0][1], color=line.get_color())
    learning.axhline(0.8, color="grey", linestyle=":", label="counts as rolled over")
    learning.set_ylabel("way rolled by the best, share")
    learning.legend()
    growth.set_ylabel("age, months")
    growth.set_xlabel("steps of each environment")
    figure.tight_layout()
    figure.savefig(options.out, dpi=150)
    print(f"wrote {options.out}")


if __name__ == "__main__":
    main()
