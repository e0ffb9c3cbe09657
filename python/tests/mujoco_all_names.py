"""Writes what is there of MuJoCo 3.3.0's names into ``docs/mujoco.md``: ``python tests/mujoco_all_names.py``.

``tests/mujoco_all_names.txt`` lists ``dir(mujoco)`` of 3.3.0.
"""

from __future__ import annotations

from pathlib import Path

from babybench import mujoco
from babybench_core.mujoco.missing import WHY

FOLDER = Path(__file__).resolve().parent
PAGE = FOLDER.parent / "docs" / "mujoco.md"
START, END = "<!-- names: tests/mujoco_all_names.py writes from here -->", "<!-- names: to here -->"
WIDTH = 150

GROUPS = (
    ("`mj_`", "models and states", "mj_"),
    ("`mju_`", "numbers, vectors, quaternions, matrices", "mju_"),
    ("`mjd_`", "derivatives", "mjd_"),
    ("`mjv_`", "scenes", "mjv_"),
    ("`mjr_`", "OpenGL", "mjr_"),
    ("`mjt`", "enumerations", "mjt"),
    ("`mj`...", "constants", "mj"),
    ("`Mj`...", "classes", "Mj"),
    ("", "others", ""),
)


def names() -> list[str]:
    """Returns the public names of MuJoCo 3.3.0."""
    return (FOLDER / "mujoco_all_names.txt").read_text().split()


def _wrapped(words: list[str]) -> str:
    lines = [""]
    for word in words:
        if len(lines[-1]) + len(word) > WIDTH:
            lines.append("")
        lines[-1] += f"{word} "
    return "\n".join(line.rstrip() for line in lines)


def table() -> str:
    """Returns how many names of each kind are there, and which are not, by what to do without them."""
    left, rows, total = names(), [], [0, 0]
    for prefix, what, start in GROUPS:
        group = [name for name in left if name.startswith(start)]
        left = [name for name in left if name not in group]
        here = sum(hasattr(mujoco, name) for name in group)
        total = [total[0] + here, total[1] + len(group)]
        rows.append(f"| {prefix} | {what} | {here} of {len(group)} |")
    rows.append(f"| | all | {total[0]} of {total[1]} |")
    text = ["| names | | there |\n|---|---|--:|\n" + "\n".join(rows)]
    by_reason: dict[str, list[str]] = {}
    for name in names():
        if not hasattr(mujoco, name):
            by_reason.setdefault(WHY[name], []).append(f"`{name}`")
    text.append("These are not there. Each is an `AttributeError` that says what to do:")
    text += [
        _wrapped([*f"{reason[0].upper()}{reason[1:]}:".split(" "), *missing]) for reason, missing in by_reason.items()
    ]
    return "\n\n".join(text)


def page() -> str:
    """Returns the page with the current table."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(START)
    return f"{before}{START}\n\n{table()}\n\n{END}{rest.split(END)[1]}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
