"""MIMo 3's environments; registers their ids with Gymnasium."""

from babybench_kit.third.registration import register_mimo_envs

register_mimo_envs()
