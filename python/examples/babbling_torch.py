"""Goal babbling in PyTorch: a vector of infants learn to touch themselves, without a reward and without a network.

It is the policy ``babbling`` of the command line (the guide says more: records, measures, benchmarks) with one memory
for all infants of a vector. An action is held for 0.05 to 1 s, a *movement*. The memory keeps the posture in which it began, the
touches that it added to those of its episode, and those that it could have added. In a posture, a movement promises the touches
that it led to from similar postures, above all rare ones; it is repeated, varied, or combined with one of the other arm.

    pip install torch
    python babbling_torch.py                                  # five seeds of a million steps, a minute or two each on two cores
    python babbling_torch.py --seeds 1 --steps 100000
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
import torch

import babybench

INFANTS = 16
EVERY = 10  # steps between decisions, 0.05 s
EPISODE = 1000  # steps
DURATIONS = (2, 4, 8)  # of new movements, in decisions
VARIATIONS = (0.05, 0.1, 0.2, 0.4)  # standard deviations, in half ranges of an action
AGAIN, VARIED, COMBINED = 0.4, 0.2, 0.2  # shares of the decisions; the rest is random
WIDTH, DOUBT, ANYWHERE = 0.2, 0.1, 1e-5  # of the kernel over postures: rad; weight of a failure imagined; least weight
FORGETTING = 0.05  # weight of an episode in what is known about how often each touch happens
ROOM, OUTCOMES = 12_000, 5  # movements that are remembered, and outcomes of each
PARTS = 34  # parts that count for each hand in the score


class Memory:
    """Movements that led to a touch, with their last outcomes."""

    def __init__(self, actions: int, angles: int, pairs: int) -> None:
        """Allocates the memory."""
        self.action = torch.zeros(ROOM, actions)
        self.duration = torch.ones(ROOM, dtype=torch.long)
        self.times = torch.zeros(ROOM, dtype=torch.long)
        self.posture = torch.zeros(ROOM, OUTCOMES, angles)
        self.gained = torch.zeros(ROOM, OUTCOMES, pairs)  # pairs of a palm and a part that it added
        self.open = torch.zeros(ROOM, OUTCOMES, pairs)  # pairs that it could have added
        self.used = 0

    def add(self, action: torch.Tensor, duration: int) -> int:
        """Adds a movement. If the memory is full, it replaces a random one that was not repeated."""
        if self.used < ROOM:
            at, self.used = self.used, self.used + 1
        else:
            places = torch.randint(ROOM, (8,))
            once = places[self.times[places] == 1]
            at = int(once[0] if len(once) else places[0])
            self.gained[at], self.open[at] = 0, 0
        self.action[at], self.duration[at], self.times[at] = action, duration, 0
        return at

    def learn(self, at: int, posture: torch.Tensor, gained: torch.Tensor, was_open: torch.Tensor) -> None:
        """Stores the outcome of a movement."""
        slot = int(self.times[at]) % OUTCOMES
        self.posture[at, slot], self.gained[at, slot], self.open[at, slot] = posture, gained, was_open
        self.times[at] += 1

    def promises(self, posture: torch.Tensor, worth: torch.Tensor) -> torch.Tensor:
        """Returns the expected value of each movement for each palm in each posture: (movements, postures, palms)."""
        known = self.posture[: self.used]
        distance = torch.cdist(posture, known.flatten(0, 1)).square() / posture.shape[1]
        near = (
            (torch.exp(distance / (-2 * WIDTH**2)) + ANYWHERE).view(len(posture), self.used, OUTCOMES).transpose(0, 1)
        )
        gained = torch.bmm(near, self.gained[: self.used])
        tried = torch.bmm(near, self.open[: self.used])
        share = gained / (DOUBT + tried) * worth
        # long movements touch more, but not in proportion
        return share.unflatten(2, (2, -1)).sum(3) / self.duration[: self.used, None, None].sqrt()


class Babbling:
    """The infants' movements, and their memory."""

    def __init__(self, names: list[str], low: np.ndarray, high: np.ndarray, angles: int, pairs: int) -> None:
        """Starts untrained."""
        self.low, self.high = torch.from_numpy(low), torch.from_numpy(high)
        arms = ("shoulder", "elbow", "wrist", "finger")
        of = [[side in name and any(part in name for part in arms) for name in names] for side in ("right", "left")]
        self.arms = torch.tensor(of)
        self.memory = Memory(len(low), angles, pairs)
        self.shares = torch.zeros(pairs)  # of the episodes lately, in which a pair touched

    def random(self) -> tuple[torch.Tensor, int]:
        """Draws a movement."""
        action = self.low + (self.high - self.low) * torch.rand(len(self.low))
        return action, DURATIONS[int(torch.randint(len(DURATIONS), ()))]

    def decide(
        self, posture: torch.Tensor, touched: torch.Tensor, settled: bool = False
    ) -> list[tuple[torch.Tensor, int, int]]:
        """Chooses movements: an action, its duration, and its place in memory or -1."""
        if self.memory.used == 0:
            return [(*self.random(), -1) for _ in posture]
        rarity = torch.ones_like(self.shares) if settled else (self.shares + 0.01) ** -0.7
        promises = self.memory.promises(posture, rarity * ~touched)
        best, both = promises.sum(2).max(0)
        hand_best, hand = promises.max(0)
        movements = []
        for k in range(len(posture)):
            at, chance = int(both[k]), 0.0 if settled else float(torch.rand(()))
            if not best[k] > 0 or chance >= AGAIN + VARIED + COMBINED:
                # settled, it rests where it knows nothing more
                movements.append((0 * self.low, DURATIONS[0], -1) if settled else (*self.random(), -1))
            elif chance < AGAIN:
                movements.append((self.memory.action[at], int(self.memory.duration[at]), at))
            elif chance < AGAIN + VARIED:
                movements.append((*self.varied(at), -1))
            else:
                lead = int(hand[k, int(hand_best[k].argmax())])
                action = self.memory.action[lead].clone()
                for palm in range(2):
                    if hand_best[k, palm] > 0:
                        action[self.arms[palm]] = self.memory.action[int(hand[k, palm]), self.arms[palm]]
                movements.append((action, int(self.memory.duration[lead]), -1))
        return movements

    def varied(self, at: int) -> tuple[torch.Tensor, int]:
        """Changes a movement a little."""
        deviation = VARIATIONS[int(torch.randint(len(VARIATIONS), ()))]
        noise = deviation * 0.5 * (self.high - self.low) * torch.randn(len(self.low))
        action = torch.clamp(self.memory.action[at] + noise, self.low, self.high)
        duration = float(self.memory.duration[at])
        if torch.rand(()) < 0.3:
            duration *= float(torch.exp(0.3 * torch.randn(())))
        return action, max(1, min(20, round(duration)))


def run(policy: Babbling, envs: babybench.VectorEnv, settled: bool = False, seed: int | None = None) -> np.ndarray:
    """Runs an episode in all environments; returns which pairs touched: (environments, 2 * geoms)."""
    observation, info = envs.reset(seed=seed)
    angles = envs.proprioception.slices["angles"]
    n = envs.num_envs

    def pairs() -> torch.Tensor:
        return torch.from_numpy(info["touches"].reshape(n, -1) > 0)

    actions, left = np.zeros((n, len(policy.low)), np.float32), np.zeros(n, int)
    running: list[tuple[torch.Tensor, int, int, torch.Tensor, torch.Tensor]] = []
    for _ in range(EPISODE // EVERY):
        touched, posture = pairs(), torch.from_numpy(observation["observation"][:, angles].astype(np.float32))
        due = np.flatnonzero(left == 0)
        for k in due if running and not settled else []:
            action, duration, at, began, before = running[k]
            gained = touched[k] & ~before
            # movements without an effect are not worth a place
            if at >= 0 or gained.any():
                at = at if at >= 0 else policy.memory.add(action, duration)
                policy.memory.learn(at, began, gained, ~before)
        if len(due):
            running = running or [(torch.empty(0), 0, -1, torch.empty(0), torch.empty(0))] * n
            for k, movement in zip(due, policy.decide(posture[due], touched[due], settled)):
                running[k] = (*movement, posture[k], touched[k])
                actions[k], left[k] = movement[0].numpy(), movement[1]
        left -= 1
        for _ in range(EVERY):
            observation, _, _, _, info = envs.step(actions)
    touched = pairs()
    for row in touched if not settled else []:
        policy.shares += FORGETTING * (row.float() - policy.shares)
    return np.asarray(touched)


def train(config: str, seed: int, steps: int) -> dict[str, float]:
    """Trains one policy; returns its measures."""
    torch.manual_seed(seed)
    options: dict[str, Any] = {
        "autoreset_mode": "Disabled",
        "copy": False,
        "vision_active": False,
        "max_episode_steps": EPISODE,
    }
    envs = babybench.VectorEnv(config, INFANTS, **options)
    geoms = envs.reset()[1]["touches"].shape[2]
    names = babybench.make(config).actuator_names
    space, angles = envs.single_action_space, envs.proprioception.slices["angles"]
    policy = Babbling(names, space.low, space.high, angles.stop - angles.start, 2 * geoms)
    union, parts, started = np.zeros(2 * geoms, bool), [], time.perf_counter()

    def score(touched: np.ndarray) -> float:
        return float(np.minimum(touched.reshape(2, -1).sum(1), PARTS).sum() / (2 * PARTS))

    for episode in range(max(1, steps // (EPISODE * INFANTS))):
        touched = run(policy, envs, seed=seed if episode == 0 else None)
        union |= touched.any(0)
        parts.extend(touched.sum(1))
    seconds = time.perf_counter() - started
    test = babybench.VectorEnv(config, 10, **options)
    touched = run(policy, test, settled=True, seed=10_000 + seed)
    return {
        "score": score(union),
        "parts per episode": float(np.mean(parts)),
        "score, evaluated": score(np.asarray(touched.any(0))),
        "parts per episode, evaluated": float(touched.sum(1).mean()),
        "minutes": seconds / 60,
    }


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--config", default="self_touch")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=1_000_000)
    args = parser.parse_args()
    rows = []
    for seed in range(args.seeds):
        rows.append(train(args.config, seed, args.steps))
        print(f"seed {seed}: " + ", ".join(f"{name} {value:.3f}" for name, value in rows[-1].items()), flush=True)
    resample = np.random.default_rng(0).integers(len(rows), size=(10_000, len(rows)))
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        low, high = np.quantile(values[resample].mean(1), [0.025, 0.975])
        print(f"{name}: {values.mean():.3f} ({low:.3f} to {high:.3f})")


if __name__ == "__main__":
    main()
