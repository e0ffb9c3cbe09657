"""The way to the package ``babybench-kit``, which serves the modules of the BabyBench starter kit; this one runs without it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

PACKAGE = "babybench_kit"


@contextmanager
def needed(by: str) -> Iterator[None]:
    """Adds advice on installing ``babybench-kit`` to import errors raised inside.

    Args:
        by: The name of the caller, for the message.

    Raises:
        ModuleNotFoundError: It is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        if error.name != PACKAGE:
            raise
        text = f'{by} needs the package babybench-kit, which is not installed: pip install "babybench[kit]"'
        raise ModuleNotFoundError(text, name=PACKAGE) from None


def claim() -> None:
    """If ``babybench-kit`` is installed, records that ``babybench`` was imported: its ``mimoEnv`` serves from now on."""
    try:
        from babybench_kit import swap
    except ModuleNotFoundError as error:
        if error.name != PACKAGE:
            raise
        return
    swap.claim()
