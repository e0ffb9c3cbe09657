"""The progress of an environment between two changes of its state: everything besides the numbers of the simulation.

A :class:`Course` has three parts, each of which changes only as its table says; ``-`` is refused.

What is known of the current instant, :class:`Moment`:

| at               | clear     | compute    | write      | sense            | feel           |
|------------------|-----------|------------|------------|------------------|----------------|
| `CLEARED`        | `CLEARED` | `COMPUTED` | `CLEARED`  | `CLEARED_SENSED` | -              |
| `CLEARED_SENSED` | `CLEARED` | `COMPUTED` | `CLEARED`  | -                | `CLEARED_FELT` |
| `CLEARED_FELT`   | `CLEARED` | `COMPUTED` | `CLEARED`  | -                | `CLEARED_FELT` |
| `COMPUTED`       | `CLEARED` | `COMPUTED` | `COMPUTED` | `SENSED`         | -              |
| `SENSED`         | `CLEARED` | `COMPUTED` | `COMPUTED` | -                | `FELT`         |
| `FELT`           | `CLEARED` | `COMPUTED` | `COMPUTED` | -                | `FELT`         |

What the copy of the state that scripts hold shows of it, :class:`Copy`:

| at           | advance      | show    | complete |
|--------------|--------------|---------|----------|
| `LATE`       | `LATE`       | `POSES` | -        |
| `POSES`      | `LATE`       | `POSES` | `WHOLE`  |
| `LATE_WHOLE` | `LATE_WHOLE` | `WHOLE` | -        |
| `WHOLE`      | `LATE_WHOLE` | `WHOLE` | -        |

Who may write to that copy, :class:`Turn`:

| at       | begin    | end      |
|----------|----------|----------|
| `SCRIPT` | `ENGINE` | -        |
| `ENGINE` | -        | `SCRIPT` |
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any


class Moment(Enum):
    """The progress of the current instant: whether its forces and contacts are known, sensed, and felt by the skin."""

    CLEARED = (False, False, False)
    """The simulation was reset, and nothing is computed: after ``mujoco.mj_resetData``."""
    CLEARED_SENSED = (False, True, False)
    CLEARED_FELT = (False, True, True)
    COMPUTED = (True, False, False)
    """After a physics step, or at positions that were set."""
    SENSED = (True, True, False)
    FELT = (True, True, True)
    """Touch was observed. The kit's own inverts normals then, so feeling again gives other forces."""

    def __init__(self, computed: bool, sensed: bool, felt: bool) -> None:
        """Names the three parts."""
        self.computed, self.sensed, self.felt = computed, sensed, felt


class Copy(Enum):
    """The instant that the scripts' copy of the state shows."""

    LATE = "late"
    """An earlier instant, or none if no script has requested a copy."""
    POSES = "poses"
    """The current instant, except for contacts and constraints."""
    LATE_WHOLE = "late, then whole"
    """An earlier instant; contacts were requested once, so the next instant will have them."""
    WHOLE = "whole"
    """The current instant, contacts and constraints included."""

    @property
    def present(self) -> bool:
        """Whether it shows the current instant."""
        return self is Copy.POSES or self is Copy.WHOLE

    @property
    def contacts(self) -> bool:
        """Whether contacts and constraints were requested, and are therefore computed whenever it shows the current instant."""
        return self is Copy.LATE_WHOLE or self is Copy.WHOLE


class Turn(Enum):
    """The code that is running."""

    SCRIPT = "script"
    """Code that may hold the copy and write to it."""
    ENGINE = "engine"
    """Only the engine, from an action to its observation, with no method that a subclass has replaced."""


class Share(Enum):
    """How much of an environment or of a sense a script has replaced: fixed when it is made."""

    NOTHING = "nothing"
    """The engine does everything."""
    STEP = "step"
    """Methods between an action and its observation."""
    SENSES = "senses"
    """The observation, too."""


class IllegalChange(RuntimeError):
    """A change that is not in the tables: a fault in this package, not in a script."""


_MOMENTS: dict[str, dict[Moment, Moment]] = {
    "clear": dict.fromkeys(Moment, Moment.CLEARED),
    "compute": dict.fromkeys(Moment, Moment.COMPUTED),
    "write": {moment: Moment.COMPUTED if moment.computed else Moment.CLEARED for moment in Moment},
    "sense": {Moment.CLEARED: Moment.CLEARED_SENSED, Moment.COMPUTED: Moment.SENSED},
    "feel": {m: Moment.FELT if m.computed else Moment.CLEARED_FELT for m in Moment if m.sensed},
}
_COPIES: dict[str, dict[Copy, Copy]] = {
    "advance": {copy: Copy.LATE_WHOLE if copy.contacts else Copy.LATE for copy in Copy},
    "show": {copy: Copy.WHOLE if copy.contacts else Copy.POSES for copy in Copy},
    "complete": {Copy.POSES: Copy.WHOLE},
}
_TURNS: dict[str, dict[Turn, Turn]] = {"begin": {Turn.SCRIPT: Turn.ENGINE}, "end": {Turn.ENGINE: Turn.SCRIPT}}

_TABLES: dict[str, Mapping[str, Mapping[Any, Any]]] = {"moment": _MOMENTS, "copy": _COPIES, "turn": _TURNS}
_PARTS = {change: part for part, table in _TABLES.items() for change in table}
"""The part of a course that each change concerns."""
_FOLLOWING: dict[tuple[str, str], Any] = {}
"""The next member by the names of the change and of the current member: members as keys would be hashed in Python."""
for _table in _TABLES.values():
    _FOLLOWING.update(
        {(change, present.name): following for change, pairs in _table.items() for present, following in pairs.items()}
    )


class Course:
    """The progress of an environment.

    Attributes:
        moment: What is known of the current instant.
        copy: What the copy that scripts hold shows of it.
        turn: Who may write to that copy.
    """

    def __init__(self) -> None:
        """Begins before anything is computed."""
        self.moment, self.copy, self.turn = Moment.CLEARED, Copy.LATE, Turn.SCRIPT

    def change(self, change: str) -> None:
        """Applies a transition of one of the tables.

        Raises:
            IllegalChange: The table does not have it here.
        """
        part = _PARTS[change]
        present = getattr(self, part)
        following = _FOLLOWING.get((change, present._name_))
        if following is None:
            raise IllegalChange(f"{change} does not follow {type(present).__name__}.{present.name}: see {__name__}")
        setattr(self, part, following)
