"""Stands in for MuJoCo's bindings where they are not installed, for scripts that import them together with BabyBench."""

from babybench_kit.standin import serve

serve(__name__)
