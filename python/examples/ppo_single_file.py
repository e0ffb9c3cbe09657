"""PPO in one file, after CleanRL: nothing is hidden, and everything can be changed.

The intrinsic reward is novelty of touch: the less often a sensor has been touched in this run, the more it counts.
Needs ``pip install torch``; run it with ``python ppo_single_file.py --total-steps 200000``.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import torch
from torch import nn
from torch.distributions import Normal

import babybench


class Agent(nn.Module):
    """A policy and a value function of proprioception and touch."""

    def __init__(self, inputs: int, outputs: int) -> None:
        """Builds both networks."""
        super().__init__()
        self.critic = nn.Sequential(
            nn.Linear(inputs, 128), nn.Tanh(), nn.Linear(128, 128), nn.Tanh(), nn.Linear(128, 1)
        )
        self.actor = nn.Sequential(
            nn.Linear(inputs, 128), nn.Tanh(), nn.Linear(128, 128), nn.Tanh(), nn.Linear(128, outputs)
        )
        self.log_std = nn.Parameter(torch.zeros(outputs))

    def policy(self, x: torch.Tensor) -> Normal:
        """Returns the distribution of actions."""
        return Normal(self.actor(x), self.log_std.exp())


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--envs", type=int, default=16)
    parser.add_argument("--rollout", type=int, default=128)
    parser.add_argument("--total-steps", type=int, default=200_000)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    torch.manual_seed(args.seed)

    envs = babybench.VectorEnv("self_touch", args.envs, autoreset_mode="SameStep", copy=False, touch_scale=2.0)
    n, shapes = args.envs, {key: values.shape[1:] for key, values in envs.reset()[0].items()}
    proprioception, sensors = shapes["observation"][0], shapes["touch"][0] // 3
    low, high = envs.single_action_space.low, envs.single_action_space.high
    counts = np.ones(sensors)

    def inputs(observations: dict[str, np.ndarray]) -> tuple[torch.Tensor, np.ndarray]:
        touched = np.abs(observations["touch"].reshape(n, sensors, 3)).max(-1) > 1e-6
        vector = np.concatenate([np.clip(observations["observation"], -5, 5), touched], axis=1, dtype=np.float32)
        return torch.from_numpy(vector), touched

    agent = Agent(proprioception + sensors, len(low))
    optimizer = torch.optim.Adam(agent.parameters(), lr=3e-4, eps=1e-5)
    states = torch.zeros(args.rollout, n, proprioception + sensors)
    actions = torch.zeros(args.rollout, n, len(low))
    logprobs, rewards, dones, values = (torch.zeros(args.rollout, n) for _ in range(4))
    x, _ = inputs(envs.reset(seed=args.seed)[0])
    done, started = torch.zeros(n), time.perf_counter()

    for update in range(1, max(1, args.total_steps // (args.rollout * n)) + 1):
        for t in range(args.rollout):
            with torch.no_grad():
                policy = agent.policy(x)
                action = policy.sample()
                values[t] = agent.critic(x).flatten()
            states[t], actions[t], dones[t] = x, action, done
            logprobs[t] = policy.log_prob(action).sum(1)
            observations, _, terminated, truncated, _ = envs.step(np.clip(action.numpy(), low, high))
            x, touched = inputs(observations)
            rewards[t] = torch.from_numpy((touched / np.sqrt(counts)).sum(1, dtype=np.float32))
            counts += touched.sum(0)
            done = torch.from_numpy((terminated | truncated).astype(np.float32))

        with torch.no_grad():
            advantages, last, value = torch.zeros_like(rewards), torch.zeros(n), agent.critic(x).flatten()
            for t in reversed(range(args.rollout)):
                going = 1 - (done if t == args.rollout - 1 else dones[t + 1])
                following = value if t == args.rollout - 1 else values[t + 1]
                last = rewards[t] + 0.99 * following * going - values[t] + 0.99 * 0.95 * going * last
                advantages[t] = last
        returns = advantages + values

        flat = [a.reshape(-1, *a.shape[2:]) for a in (states, actions, logprobs, advantages, returns)]
        for _ in range(4):
            for rows in torch.randperm(args.rollout * n).split(512):
                state, action, old, advantage, target = (a[rows] for a in flat)
                policy = agent.policy(state)
                ratio = (policy.log_prob(action).sum(1) - old).exp()
                advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
                gain = torch.min(advantage * ratio, advantage * ratio.clamp(0.8, 1.2)).mean()
                error = (agent.critic(state).flatten() - target).square().mean()
                loss = 0.5 * error - gain - 0.001 * policy.entropy().sum(1).mean()
                optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
                optimizer.step()

        steps = update * args.rollout * n
        speed = steps / (time.perf_counter() - started)
        print(f"{steps:8} steps, {speed:6.0f}/s, reward {rewards.mean():.3f}, sensors felt {np.mean(counts > 1):.1%}")
    envs.close()


if __name__ == "__main__":
    main()
