"""MIMo 3 at other ages, as documents."""

from babybench_kit.third.growth import adjust_mimo_to_age, get_growth_params, get_version

__all__ = ["adjust_mimo_to_age", "get_growth_params", "get_version"]
