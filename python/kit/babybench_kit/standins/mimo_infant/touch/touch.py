"""MIMo 3's touch."""

from babybench_kit.touch import DiscreteTouch, Touch, TrimeshTouch, scale_linear

__all__ = ["DiscreteTouch", "Touch", "TrimeshTouch", "scale_linear"]
