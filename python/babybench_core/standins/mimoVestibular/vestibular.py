"""MIMo's sense of balance."""

from babybench_core.mimo.senses import SimpleVestibular, Vestibular

__all__ = ["SimpleVestibular", "Vestibular"]
