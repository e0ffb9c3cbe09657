"""Draws MIMo's skin: the position of every touch sensor, and its force.

Run it with ``python plot_touch.py``; it writes ``touch.png``.
"""

from __future__ import annotations

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import babybench


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=200, help="random steps before the picture")
    parser.add_argument("--out", default="touch.png", help="where the picture goes")
    arguments = parser.parse_args()

    env = babybench.make("self_touch", scene="base")
    env.reset(seed=0)
    env.action_space.seed(1)
    for _ in range(arguments.steps):
        env.step(env.action_space.sample())

    skin = env.touch.world_positions()
    sensors, vectors = env.touch.sparse()
    forces = np.linalg.norm(vectors, axis=1)
    sensors, forces = sensors[forces > 0], forces[forces > 0]
    figure = plt.figure(figsize=(13, 6), layout="constrained")
    figure.suptitle(f"{len(sensors)} of {len(skin)} sensors feel {forces.sum():.1f} N")
    for place, (elevation, azimuth) in enumerate([(25, -50), (80, -90)]):
        axes = figure.add_subplot(1, 2, place + 1, projection="3d")
        axes.scatter(*skin.T, s=5, c="#6f8fae", alpha=0.55, linewidths=0, depthshade=False)
        felt = axes.scatter(
            *skin[sensors].T, s=40, c=forces, cmap="autumn_r", norm="log", linewidths=0, depthshade=False
        )
        axes.view_init(elevation, azimuth)
        axes.set_box_aspect(np.ptp(skin, axis=0), zoom=1.3)
        axes.set_axis_off()
    figure.colorbar(felt, ax=figure.axes, shrink=0.7, label="force, N")
    figure.savefig(arguments.out, dpi=110)
    print(f"{arguments.out} shows {len(sensors)} sensors that feel something; the strongest {forces.max():.2f} N")


if __name__ == "__main__":
    main()
