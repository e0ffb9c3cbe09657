"""MIMo's proprioception."""

from babybench_core.mimo.senses import Proprioception, SimpleProprioception

__all__ = ["Proprioception", "SimpleProprioception"]
