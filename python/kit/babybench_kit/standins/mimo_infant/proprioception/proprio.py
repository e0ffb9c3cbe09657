"""MIMo 3's proprioception."""

from babybench_kit.senses import Proprioception, SimpleProprioception

__all__ = ["Proprioception", "SimpleProprioception"]
