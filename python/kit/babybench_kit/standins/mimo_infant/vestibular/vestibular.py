"""MIMo 3's sense of balance."""

from babybench_kit.senses import SimpleVestibular, Vestibular

__all__ = ["SimpleVestibular", "Vestibular"]
