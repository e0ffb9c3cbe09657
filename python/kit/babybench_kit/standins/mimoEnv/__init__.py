"""MIMo's environments, run by this library; registers the ids of BabyBench with Gymnasium."""

from babybench_kit.registration import register_kit

register_kit()
