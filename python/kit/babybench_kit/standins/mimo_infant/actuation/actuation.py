"""MIMo 3's actuation models."""

from babybench_kit.actuation import ActuationModel, PositionalModel, SpringDamperModel

__all__ = ["ActuationModel", "PositionalModel", "SpringDamperModel"]
