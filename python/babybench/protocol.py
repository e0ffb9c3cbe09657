"""Protocols, experiments with infants: see :func:`names`, :func:`describe` and :func:`run`."""

from babybench_core.protocol import describe, names, run

__all__ = ["describe", "names", "run"]
