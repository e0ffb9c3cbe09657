"""Stands in for the package ``mimoGrowth`` where that is not installed."""

from babybench_kit.standin import serve

serve(__name__)
