"""Where an environment of the starter kit's stands: every change is one of the tables that its module documents."""

from __future__ import annotations

import ast
import re
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kit_scripts import Make, steps

from babybench_kit import course
from babybench_kit.course import Copy, Course, IllegalChange, Moment, Share, Turn

PARTS: tuple[tuple[str, type[Enum]], ...] = (("moment", Moment), ("copy", Copy), ("turn", Turn))


def tables() -> list[list[list[str]]]:
    """Returns the tables of the module's documentation, row by row."""
    found: list[list[list[str]]] = []
    for line in (course.__doc__ or "").splitlines():
        if line.startswith("| at"):
            found.append([])
        if line.startswith("|") and not line.startswith("|-"):
            found[-1].append([cell.strip(" `") for cell in line.strip("|").split("|")])
    return found


def documented() -> list[tuple[str, Enum, str, str]]:
    """Returns every cell of the tables: part, present value, change, and what follows or ``-``."""
    cells = []
    for (part, kind), (head, *rows) in zip(PARTS, tables()):
        assert [row[0] for row in rows] == [member.name for member in kind]
        cells += [(part, kind[row[0]], change, then) for row in rows for change, then in zip(head[1:], row[1:])]
    return cells


@pytest.mark.parametrize(("part", "at", "change", "then"), documented())
def test_the_tables_are_what_happens(part: str, at: Enum, change: str, then: str) -> None:
    stand = Course()
    setattr(stand, part, at)
    others = [getattr(stand, other) for other, _ in PARTS if other != part]
    if then == "-":
        with pytest.raises(IllegalChange, match=re.escape(f"{change} does not follow {type(at).__name__}.{at.name}")):
            stand.change(change)
        assert getattr(stand, part) is at
    else:
        stand.change(change)
        assert getattr(stand, part).name == then
    assert [getattr(stand, other) for other, _ in PARTS if other != part] == others


def test_there_are_no_changes_beside_the_documented_ones() -> None:
    assert {change for _, _, change, _ in documented()} == {*course._MOMENTS, *course._COPIES, *course._TURNS}
    with pytest.raises(KeyError):
        Course().change("guess")


def test_an_environment_goes_through_its_course(make: Make) -> None:
    u = make().unwrapped
    stand = u._core.course
    u.reset()
    assert (stand.moment, stand.copy, stand.turn) == (Moment.FELT, Copy.LATE, Turn.SCRIPT)
    u._core.reset_data()
    assert stand.moment is Moment.CLEARED
    data = u.data
    assert stand.copy is Copy.POSES
    steps(u, 1)
    assert stand.moment is Moment.FELT
    u.set_state(u.init_qpos, u.init_qvel)
    assert stand.moment is Moment.COMPUTED
    u._core.observe()
    assert stand.moment is Moment.SENSED
    data.qpos[7] += 0.01
    u._core.pull()
    assert stand.moment is Moment.COMPUTED
    assert stand.copy.present
    del data
    u._single_mujoco_step()
    assert not stand.copy.present


def test_a_script_that_takes_no_part_has_no_turn_within_a_step(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    u = make().unwrapped
    u.reset()
    turns: list[Turn] = []
    step = u._core.physics_step
    monkeypatch.setattr(u._core, "physics_step", lambda: (turns.append(u._core.course.turn), step()))
    assert u._share is Share.NOTHING
    steps(u, 1)
    monkeypatch.setattr(type(u), "_step_callback", lambda self: None)
    assert u._share_of_the_script() is Share.STEP
    u._share = Share.STEP
    steps(u, 1)
    assert turns == [Turn.ENGINE, Turn.SCRIPT]


def test_a_step_that_fails_gives_the_turn_back(make: Make) -> None:
    u = make().unwrapped
    u.reset()
    with pytest.raises(ValueError, match="shape"):
        u.step(np.zeros(3))
    assert u._core.course.turn is Turn.SCRIPT
    steps(u, 1)


def test_an_observation_of_ones_own_is_the_scripts_share(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    u = make().unwrapped

    def pressed(self: Any) -> Any:
        return np.zeros((1, 3), np.float32)

    monkeypatch.setattr(type(u), "get_touch_obs", pressed)
    assert u._share_of_the_script() is Share.SENSES


def test_core_state_and_model_do_not_import_each_other_in_a_circle() -> None:
    folder = Path(course.__file__).parent
    files = {file.stem: ast.parse(file.read_text()) for file in folder.glob("*.py")}
    imports = {
        name: {
            node.module
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module in files
        }
        for name, tree in files.items()
    }

    def reached(name: str, seen: frozenset[str] = frozenset()) -> set[str]:
        found = imports[name] - seen
        return found.union(*(reached(other, seen | found) for other in found))

    below = {"core", "live", "models", "mujoco_live", "beneath", "course", "views"}
    assert {name for name in below if name in reached(name)} == set()
