"""An infant who learns to look at his hands, as an algorithm of Stable-Baselines3, without a reward.

It is the policy ``watching`` of the command line (the guide says more: records, measures, benchmarks) with one archive of
postures for all infants of a vector. In a trial of a second an infant takes a posture, moves the right wrist, then the left one;
a hand is what moves in its pictures with one wrist and not with the other. Postures that bring such places to the middle of both
eyes are varied. ``learn``, ``predict``, ``save``, ``load``, callbacks and ``evaluate_policy`` are those of every algorithm.

    pip install stable-baselines3
    python watching_sb3.py                              # five seeds of 100,000 steps, then ten episodes of each
    python watching_sb3.py --seeds 1 --steps 20000
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.policies import BasePolicy

import babybench

REGARD = {
    "behavior": "hand_regard",
    "scene": "cubes",
    "vision_rate": 30,
    "touch_active": False,
    "vestibular_active": False,
    **{f"act_{part}": False for part in ("fingers", "feet", "legs", "body", "eyes")},
    **{f"lock_{part}": True for part in ("feet", "legs", "body", "eyes")},
}
EPISODE = 1000  # steps
SETTLING, MOVING, APART = 100, 50, 6  # steps: to take a posture, to move a wrist, between pictures that are compared
TRIAL = SETTLING + 2 * MOVING + 1
STIFFNESS, DAMPING = 2.0, 0.15  # effort for each rad that a joint is off, and for each rad/s
SWING, RATE = 0.5, 4.0  # of a wrist: rad, Hz
LEAST, CLEAR, AREA = 8.0, 2.0, 0.01  # change that counts, of 255; times that of the other hand; share of the picture
TURN = 0.01  # rad by which the eyes may turn until a trial is worth half
KEPT, SEEN = 8, 0.01  # postures for each hand and for both; how well a hand is seen at least
AGAIN, TOGETHER, RANDOM = 0.15, 0.6, 0.1  # shares of trials
VARIATIONS = (0.03, 0.07, 0.15, 0.3)  # standard deviations, in half ranges of a joint


class Body:
    """The joints that an action moves: their places in proprioception, their ranges, and the limb of each."""

    def __init__(self, env: babybench.Env) -> None:
        """Reads the joints of an environment."""
        slices, names = env.proprioception.slices, env.actuator_names
        joints = env.array("actuator_trnid") - 1  # the first joint places MIMo, and has no angle
        self.angles, self.velocities = joints + slices["angles"].start, joints + slices["velocities"].start
        ranges: np.ndarray = env.array("jnt_range")[joints + 1]
        self.low, self.high = ranges[:, 0], ranges[:, 1]
        self.dt = env.dt

        def of(*words: str) -> np.ndarray:
            return np.array([any(word in name for word in words) for name in names])

        self.head, self.wrists = of("head", "eye"), [of(f"{side}_wrist") for side in ("right", "left")]
        self.arms = [of(f"{side}_shoulder", f"{side}_elbow") | w for side, w in zip(("right", "left"), self.wrists)]


class Posture(BasePolicy):
    """Takes the best posture, holds it, and moves the wrists in turn; its state is the number of steps so far."""

    def __init__(self, observation_space: Any, action_space: Any, lr_schedule: Any, body: Body) -> None:
        """Rests in the middle of all ranges."""
        super().__init__(observation_space, action_space)
        self.body = body
        self.register_buffer("posture", torch.from_numpy((body.low + body.high) / 2))

    def drive(self, felt: np.ndarray, postures: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Returns the actions that take postures, and move a wrist when it is time for a trial."""
        body, goals = self.body, np.array(np.broadcast_to(postures, (len(felt), len(self.body.low))))
        swing = SWING * np.sin(2 * np.pi * RATE * body.dt * (step % MOVING))
        for hand, wrist in enumerate(body.wrists):
            moves = (step >= SETTLING) & ((step - SETTLING) // MOVING == hand)
            goals += np.where(moves, swing, 0.0)[:, None] * wrist
        effort = STIFFNESS * (goals - felt[:, body.angles]) - DAMPING * felt[:, body.velocities]
        return np.asarray(np.clip(effort, self.action_space.low, self.action_space.high), np.float32)

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = False
    ) -> tuple[np.ndarray, Any]:
        """Returns actions for many environments, or for one."""
        felt = observation["observation"]
        many = np.atleast_2d(felt)
        step = np.zeros(len(many), int) if state is None else state[0]
        if episode_start is not None:
            step = np.where(episode_start, 0, step)
        actions = self.drive(many, self.posture.numpy(), step)
        step = np.where(step + 1 >= TRIAL, SETTLING, step + 1)
        return (actions if felt.ndim > 1 else actions[0]), (step,)

    def _predict(self, observation: Any, deterministic: bool = False) -> torch.Tensor:
        return torch.from_numpy(self.predict({key: value.numpy() for key, value in observation.items()})[0])


class Trial:
    """A posture, and the mean visibility of each hand over its trials."""

    def __init__(self, posture: np.ndarray, seen: np.ndarray) -> None:
        """Starts with one trial."""
        self.posture, self.seen, self.times = posture, seen, 1

    def worth(self, hand: int | None) -> float:
        """Returns how well one hand or both were seen."""
        return float(self.seen.sum() if hand is None else self.seen[hand])


class Archive:
    """The best trials of each hand and of both, the best ones first, and what is tried next."""

    def __init__(self, body: Body, rng: np.random.Generator) -> None:
        """Starts empty."""
        self.body, self.rng = body, rng
        self.lists: dict[int | None, list[Trial]] = {0: [], 1: [], None: []}

    def add(self, trial: Trial) -> None:
        """Adds a trial to earlier trials of the same posture."""
        for other in [t for trials in self.lists.values() for t in trials if np.array_equal(t.posture, trial.posture)][
            :1
        ]:
            all_times = trial.times + other.times
            trial.seen = (trial.times * trial.seen + other.times * other.seen) / all_times
            trial.times = all_times
        for hand, trials in self.lists.items():
            kept = [t for t in trials if not np.array_equal(t.posture, trial.posture)]
            kept += [trial] if trial.worth(hand) > SEEN else []
            self.lists[hand] = sorted(kept, key=lambda t: -t.worth(hand))[:KEPT]

    def some(self, hand: int | None) -> Trial | None:
        """Returns one of the best trials, better ones more often."""
        trials = self.lists[hand]
        return trials[int(self.rng.uniform() * self.rng.uniform() * len(trials))] if trials else None

    def propose(self) -> np.ndarray:
        """Returns the posture of the next trial."""
        body, rng = self.body, self.rng
        if self.lists[None] and rng.uniform() < AGAIN:
            return self.lists[None][0].posture
        posture: np.ndarray = rng.uniform(body.low, body.high)
        parents = [self.some(None)] * 2 if rng.uniform() < TOGETHER else [self.some(0), self.some(1)]
        if rng.uniform() < RANDOM:
            return posture
        lead = int(rng.integers(2))
        head = parents[lead] or parents[1 - lead]
        limbs = [(body.head, head), *((body.arms[hand], parents[hand]) for hand in range(2))]
        deviation = rng.choice(VARIATIONS) * 0.5 * (body.high - body.low)
        for hand, (limb, parent) in enumerate(limbs, -1):
            # an arm whose hand was not seen is drawn again
            if parent and (hand < 0 or parent.seen[hand] > SEEN):
                varied = np.clip(parent.posture + deviation * rng.normal(size=len(posture)), body.low, body.high)
                posture[limb] = varied[limb]
        return posture


class Sight:
    """Changes in the pictures of many infants while each of their wrists moved."""

    def __init__(self, body: Body, infants: int, size: int) -> None:
        """Allocates the pictures."""
        self.body, self.changes = body, np.zeros((2, infants, 2, size, size), np.float32)
        square = ((np.arange(size) - (size - 1) / 2) / (size / 2)) ** 2
        r2 = square[:, None] + square
        self.weights = 0.9 * np.exp(-r2 / (2 * 0.25**2)) + 0.1 * np.exp(-r2 / (2 * 0.7**2))
        self.gaze = np.zeros((2, 2, infants, body.head.sum()))  # for each hand the least and the greatest angles
        self.counts = np.zeros(2)

    def notice(self, observation: dict[str, np.ndarray], step: int) -> None:
        """Looks at the pictures before a step of a trial."""
        hand = (step - SETTLING - 1) // MOVING
        if step == SETTLING:
            self.changes[:], self.counts[:] = 0, 0
            self.gaze[:, 0], self.gaze[:, 1] = np.inf, -np.inf
            self.last = self.shades(observation)
        elif hand in (0, 1):
            angles = observation["observation"][:, self.body.angles[self.body.head]]
            self.gaze[hand, 0] = np.minimum(self.gaze[hand, 0], angles)
            self.gaze[hand, 1] = np.maximum(self.gaze[hand, 1], angles)
            if (step - SETTLING) % APART == 0:
                now = self.shades(observation)
                self.changes[hand] += np.abs(now - self.last)
                self.counts[hand] += 1
                self.last = now

    @staticmethod
    def shades(observation: dict[str, np.ndarray]) -> np.ndarray:
        """Returns the pictures of both eyes in shades of grey: (infants, eyes, height, width)."""
        # Stable-Baselines3 puts colours first
        eyes = [observation[f"eye_{side}"].mean(1, dtype=np.float32) for side in ("left", "right")]
        return np.stack(eyes, 1)

    def found(self) -> np.ndarray:
        """Returns how well each infant has seen each hand, 0 to 1: (infants, hands)."""
        mean = self.changes / np.maximum(self.counts, 1)[:, None, None, None, None]
        moved = mean > LEAST + CLEAR * mean[::-1]
        area = np.maximum(moved.sum((3, 4)), AREA * self.weights.size)
        eyes = (moved * self.weights).sum((3, 4)) / area
        turned = (self.gaze[:, 1] - self.gaze[:, 0]).max(2, initial=0.0)
        seen: np.ndarray = 0.5 * (eyes.mean(2) + eyes.min(2)) / (1 + (turned / TURN) ** 2)
        return np.asarray(seen.T)


class Watching(BaseAlgorithm):
    """Learns to look at hands: ``Watching(env=envs, body=Body(env)).learn(100_000)``."""

    _last_obs: Any

    def __init__(
        self,
        policy: type[Posture] = Posture,
        env: Any = None,
        body: Any = None,
        seed: int | None = None,
        verbose: int = 0,
        device: str = "cpu",
        _init_setup_model: bool = True,
    ) -> None:
        """Takes a vector of environments of ``hand_regard`` with arms, wrists and neck, and the body of one of them."""
        super().__init__(policy, env, 0.0, support_multi_env=True, seed=seed, verbose=verbose, device=device)
        self.body = body
        if _init_setup_model:
            self._setup_model()

    def _setup_model(self) -> None:
        self.set_random_seed(self.seed)
        # what was loaded from a file is there already
        if not hasattr(self, "archive"):
            self.archive = Archive(self.body, np.random.default_rng(self.seed))
        self.policy = Posture(self.observation_space, self.action_space, None, self.body)

    def learn(
        self,
        total_timesteps: int,
        callback: Any = None,
        log_interval: int = 1,
        tb_log_name: str = "Watching",
        reset_num_timesteps: bool = True,
        progress_bar: bool = False,
    ) -> Watching:
        """Learns for some steps, of all environments together."""
        total_timesteps, callback = self._setup_learn(
            total_timesteps, callback, reset_num_timesteps, tb_log_name, progress_bar
        )
        infants = self.env.num_envs
        sight, step = Sight(self.body, infants, self.observation_space["eye_left"].shape[-1]), 0
        callback.on_training_start(locals(), globals())
        while self.num_timesteps < total_timesteps:
            if step == 0:
                postures = np.array([self.archive.propose() for _ in range(infants)])
            sight.notice(self._last_obs, step)
            actions = self.policy.drive(self._last_obs["observation"], postures, np.full(infants, step))
            self._last_obs, _, dones, infos = self.env.step(actions)
            self.num_timesteps += infants
            self._update_info_buffer(infos, dones)
            callback.update_locals(locals())
            if not callback.on_step():
                break
            step += 1
            if step == TRIAL:
                for posture, seen in zip(postures, sight.found()):
                    self.archive.add(Trial(posture, seen))
            if step == TRIAL or dones.any():
                step = 0
        if self.archive.lists[None]:
            self.policy.posture.copy_(torch.from_numpy(self.archive.lists[None][0].posture))
        callback.on_training_end()
        return self


class Regards:
    """Adds up how long hands were in view, by the counters that ``babybench score`` reads."""

    def __init__(self) -> None:
        """Starts at zero."""
        self.counts, self.steps = 0, 0

    def add(self, info: dict[str, Any]) -> None:
        """Adds an episode that has ended."""
        self.counts, self.steps = self.counts + int(np.sum(info["regards"])), self.steps + int(info["steps"])

    @property
    def score(self) -> float:
        """The share of the time in which a hand was in view, mean over both eyes and hands."""
        return self.counts / max(1, 4 * self.steps)


def train(seed: int, steps: int, infants: int) -> dict[str, float]:
    """Trains and evaluates one policy; returns its measures."""
    learning, settled = Regards(), Regards()
    envs = babybench.sb3.VecEnv(REGARD, infants, max_episode_steps=EPISODE)
    model = Watching(env=envs, body=Body(babybench.make(REGARD)), seed=seed)

    def each_step(local: dict[str, Any], _: Any) -> bool:
        for done, info in zip(local["dones"], local["infos"]):
            if done:
                learning.add(info)
        return True

    started = time.perf_counter()
    model.learn(steps, callback=each_step)
    seconds = time.perf_counter() - started
    test = babybench.sb3.VecEnv(REGARD, 10, max_episode_steps=EPISODE)
    test.seed(10_000 + seed)
    evaluate_policy(
        model, test, 10, callback=lambda local, _: settled.add(local["info"]) if local["done"] else None, warn=False
    )
    return {"score": learning.score, "score, evaluated": settled.score, "minutes": seconds / 60}


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("--infants", type=int, default=4)
    args = parser.parse_args()
    rows = []
    for seed in range(args.seeds):
        rows.append(train(seed, args.steps, args.infants))
        print(f"seed {seed}: " + ", ".join(f"{name} {value:.3f}" for name, value in rows[-1].items()), flush=True)
    resample = np.random.default_rng(0).integers(len(rows), size=(10_000, len(rows)))
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        low, high = np.quantile(values[resample].mean(1), [0.025, 0.975])
        print(f"{name}: {values.mean():.3f} ({low:.3f} to {high:.3f})")


if __name__ == "__main__":
    main()
