"""A first look: random movements, senses by name, and a picture.

Run it with ``python quick_start.py``; it writes ``mimo.png``.
"""

from __future__ import annotations

import argparse

import numpy as np

import babybench


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300, help="number of steps of 5 ms")
    parser.add_argument("--picture", default="mimo.png", help="where the picture goes")
    arguments = parser.parse_args()

    env = babybench.make("self_touch", render_mode="rgb_array")
    observation, info = env.reset(seed=0)
    env.action_space.seed(0)
    print("MIMo senses")
    for name, values in observation.items():
        print(f"  {name:12} {values.shape[0]:6} numbers ({values.dtype})")

    for _ in range(arguments.steps):
        observation, _, _, _, info = env.step(env.action_space.sample())

    elbow = env.proprioception.where("angles", "robot:right_elbow")
    sensors, forces = env.touch.sparse()
    print(f"after {info['steps']} random steps")
    print(f"  the right elbow is at {np.degrees(observation['observation'][elbow][0]):.0f} degrees")
    print(f"  {len(sensors)} of {env.touch.sensors} touch sensors feel {np.abs(forces).sum():.1f} N in all")
    print(f"  the right hand has touched: {', '.join(info['right_hand_parts']) or 'nothing'}")
    print(f"  the left hand has touched: {', '.join(info['left_hand_parts']) or 'nothing'}")

    # any moment can be restored
    before = env.snapshot()
    action = env.action_space.sample()
    once = env.step(action)[0]["observation"]
    env.restore(before)
    assert np.array_equal(once, env.step(action)[0]["observation"])

    from matplotlib import image

    image.imsave(arguments.picture, env.picture("closeup", 640, 480))
    print(f"{arguments.picture} shows it")
    env.close()


if __name__ == "__main__":
    main()
