"""The implementation of :mod:`babybench.mujoco`: MuJoCo's names on the engine of this package."""
