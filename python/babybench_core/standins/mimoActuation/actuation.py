"""MIMo's actuation models."""

from babybench_core.mimo.actuation import ActuationModel, PositionalModel, SpringDamperModel

__all__ = ["ActuationModel", "PositionalModel", "SpringDamperModel"]
