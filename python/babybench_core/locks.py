"""Messages about locks: suggestions for wrong names, and angles out of range."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Union

from babybench_core import _native, hints
from babybench_core.records import LockReport

_PARTS = ("hands", "fingers", "arms", "feet", "legs", "body", "head", "eyes")
"""Parts whose joints can be locked together."""


@contextmanager
def known(target: Union[str, int], blueprint: _native.Blueprint) -> Iterator[None]:
    """Adds a suggestion to the error of a joint that does not exist."""
    try:
        yield
    except KeyError as error:
        names = [name for name in blueprint.model_names["joint"] if name.startswith("robot:")]
        raise KeyError(f"{error.args[0]}{hints.nearest(str(target), (*_PARTS, *names))}") from None


def within_limits(report: LockReport, angle: float, blueprint: _native.Blueprint) -> LockReport:
    """Warns about joints that were locked beyond their limits, and returns the report."""
    if report["beyond_limits"]:
        joints, ranges = blueprint.model_names["joint"], blueprint.model_array("jnt_range")
        limits = {name: ranges[joints.index(name)] for name in report["beyond_limits"]}
        each = ", ".join(f"{name} ({low:.3g} to {high:.3g})" for name, (low, high) in limits.items())
        warnings.warn(
            f"locked at {angle} rad, beyond the limits of {each} rad: lock and limit pull against each other; "
            "choose an angle within the limits",
            stacklevel=3,
        )
    return report
