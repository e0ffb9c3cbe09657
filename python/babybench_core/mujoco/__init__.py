"""What :mod:`babybench.mujoco` is made of: MuJoCo's names on the engine of this package."""
