"""Modules of MIMo 3 that are not served."""

from __future__ import annotations

from typing import NoReturn


def refuse(module: str, instead: str) -> NoReturn:
    """Raises an error that says what to use instead of a module.

    Raises:
        ImportError: Always.
    """
    raise ImportError(
        f"{module} is not served by babybench-kit: {instead}; or run this with BABYBENCH_MIMO=original where MIMo 3 is installed",
        name=module,
    )
