"""MIMo's sense of touch."""

from babybench_core.mimo.touch import DiscreteTouch, Touch, TrimeshTouch, scale_linear

__all__ = ["DiscreteTouch", "Touch", "TrimeshTouch", "scale_linear"]
