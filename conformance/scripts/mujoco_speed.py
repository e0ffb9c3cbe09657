"""Prints the cost of MuJoCo's mj_step in the scenes of the three example configurations, with random torques.

    python mujoco_speed.py [--assets DIR] [--steps N]

To be compared with `babybench run` on the same machine at the same time. Only mj_step is timed: no senses, no Python
environment around it. A new random action is applied each step, as `run` does.
"""

import argparse
import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np

from check_assets import GROUPS, compile_model, slim_copy

CONFIGURATIONS = {
    "config_selftouch": (1, "crib", ("body", "head", "arms", "hands", "fingers", "legs")),
    "config_handregard": (2, "cubes", ("head", "arms", "hands")),
    "config_test_installation": (1, "base", GROUPS),
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--assets", type=Path, default=Path(__file__).parents[2] / "assets")
    parser.add_argument("--steps", type=int, default=1000)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        directory = slim_copy(arguments.assets, Path(folder))
        for name, (version, scene, groups) in CONFIGURATIONS.items():
            model = compile_model(directory, version, scene, "motor", groups)
            data = mujoco.MjData(model)
            rng = np.random.default_rng(0)
            for _ in range(100):
                mujoco.mj_step(model, data)
            spent = []
            for _ in range(arguments.steps):
                data.ctrl[:] = rng.uniform(-1, 1, model.nu)
                start = time.perf_counter()
                mujoco.mj_step(model, data)
                spent.append(time.perf_counter() - start)
            mean, median = 1e6 * np.mean(spent), 1e6 * np.median(spent)
            print(f"{name:26} mj_step mean {mean:7.0f} us, median {median:7.0f} us, {1e6 / mean:6.0f} steps/s")


if __name__ == "__main__":
    main()
