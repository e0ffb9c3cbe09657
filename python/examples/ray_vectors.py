"""Learning on a Ray cluster: actors hold vectors of environments, the driver holds the policy.

Augmented random search (Mania, Guy, Recht, 2018): each actor tries directions in the space of linear policies, plus and
minus, on the environments of its vector; the driver follows the directions that touched the body most. Only seeds and
returns travel, because every actor makes the directions from their seeds.

Needs ``pip install ray``. On this machine: ``python ray_vectors.py``. On a cluster, start Ray on the machines
(``ray start --head``, then ``ray start --address=HEAD:6379`` on the others, with this package installed on all of them)
and run ``python ray_vectors.py --address auto --workers 32`` on one of them; or from outside
``--address ray://HEAD:10001``. Give an actor as many threads as it has CPUs (``--cpus``).
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
import numpy.typing as npt
import ray

import babybench

Floats = npt.NDArray[np.float64]


class Explorer:
    """A vector of environments that tries directions."""

    def __init__(self, envs: int, threads: int, steps: int) -> None:
        """Makes the environments: two for each direction."""
        self.envs = babybench.VectorEnv(
            "self_touch", envs, threads=threads, copy=False, touch_scale=2.0, max_episode_steps=steps
        )
        self.steps = steps
        space = self.envs.single_action_space
        inputs = self.envs.reset()[0]["observation"].shape[1]
        self.shape = (len(space.low), inputs)
        self.low, self.high = space.low, space.high

    def size(self) -> tuple[int, int]:
        """Returns the shape of a policy."""
        return self.shape

    def explore(self, policy: Floats, seeds: list[int], scale: float) -> Floats:
        """Measures the returns of each direction, plus and minus, (directions, 2)."""
        deltas = np.stack([np.random.default_rng(seed).standard_normal(self.shape) for seed in seeds])
        tried = np.concatenate([policy + scale * deltas, policy - scale * deltas])
        observations, _ = self.envs.reset(seed=seeds[0])
        returns = np.zeros(len(tried))
        for _ in range(self.steps):
            inputs = np.clip(observations["observation"], -1, 1)
            actions = np.clip(np.einsum("nij,nj->ni", tried, inputs), self.low, self.high)
            observations, *_, infos = self.envs.step(actions.astype(np.float32))
            returns += np.mean(observations["touch"] != 0, axis=1)
        returns += infos["touches"].sum((1, 2))
        brought: Floats = returns.reshape(2, -1).T
        return brought


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--address", help="address of a Ray cluster; by default Ray starts on this machine")
    parser.add_argument("--workers", type=int, default=2, help="actors")
    parser.add_argument("--cpus", type=int, default=1, help="CPUs of each actor, and threads of its vector")
    parser.add_argument("--directions", type=int, default=8, help="directions that each actor tries in an iteration")
    parser.add_argument("--iterations", type=int, default=20)
    parser.add_argument("--steps", type=int, default=200, help="steps of an episode")
    args = parser.parse_args()

    if args.address:
        ray.init(address=args.address)
    else:
        # not a cluster that happens to run on this machine
        ray.init(address="local", num_cpus=args.workers * args.cpus, include_dashboard=False)
    remote: Any = ray.remote(num_cpus=args.cpus)(Explorer)
    actors = [remote.remote(2 * args.directions, args.cpus, args.steps) for _ in range(args.workers)]
    policy = np.zeros(ray.get(actors[0].size.remote()))
    scale, rate, number = 0.05, 0.05, 0
    started = time.perf_counter()
    for iteration in range(1, args.iterations + 1):
        seeds = []
        for _ in actors:
            seeds.append(list(range(number, number + args.directions)))
            number += args.directions
        shared = ray.put(policy)
        work = [actor.explore.remote(shared, mine, scale) for actor, mine in zip(actors, seeds)]
        returns = np.concatenate(ray.get(work))
        used = [seed for mine in seeds for seed in mine]
        best = np.argsort(-returns.max(1))[: max(1, len(used) // 2)]
        spread = returns[best].std() + 1e-8
        for k in best:
            direction = np.random.default_rng(used[k]).standard_normal(policy.shape)
            policy += rate / (len(best) * spread) * (returns[k, 0] - returns[k, 1]) * direction
        steps = iteration * 2 * len(used) * args.steps
        speed = steps / (time.perf_counter() - started)
        print(
            f"{steps:8} steps, {speed:6.0f}/s: mean return {returns.mean():.2f}, best {returns.max():.2f}", flush=True
        )
    ray.shutdown()


if __name__ == "__main__":
    main()
