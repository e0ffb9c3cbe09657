#!/usr/bin/env python3
"""Makes the notebooks of tutorials from their Markdown, so that both say the same.

Usage: scripts/notebooks.py [--check]    # --check: fails if a notebook in python/examples is not the one of its tutorial

Programs become cells, files cells that write them, and commands cells that run them. Outputs are left out.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TUTORIALS = {"ten-minutes": "ten_minutes", "curiosity": "curiosity", "ages": "ages"}
FENCE = re.compile(r"^```(\w+)(?: (\w+))?\n(.*?)^```\n?", re.MULTILINE | re.DOTALL)


def cell(kind: str, number: int, text: str) -> dict[str, object]:
    """Returns a cell of a notebook."""
    lines = text.strip("\n").splitlines(keepends=True)
    made: dict[str, object] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": lines}
    if kind == "code":
        made |= {"execution_count": None, "outputs": []}
    return made


def code(before: str, language: str, mark: str, text: str) -> str | None:
    """Returns the code of a cell for a block, or None for a block that stays text."""
    if mark in ("install", "serve") or language == "text":
        return None
    if language == "sh":
        return "".join(f"!{line}\n" for line in text.splitlines())
    if language in ("yaml", "xml"):
        name = re.findall(r"`([^`]+)`", before)[-1]
        return f"%%writefile {name}\n{text}"
    return text


def words(text: str) -> str:
    """Returns text for a cell, without the links and pictures of the documentation, which lead nowhere in a notebook."""
    text = re.sub(r"^!\[[^\]]*\]\([^)]*\)\n?", "", text, flags=re.MULTILINE)
    return re.sub(r"\[([^\]]*)\]\((?!https?:)[^)]*\)", r"\1", text)


def notebook(tutorial: str) -> str:
    """Returns the notebook of a tutorial as JSON."""
    text = (ROOT / "docs/tutorials" / f"{tutorial}.md").read_text("utf-8")
    cells: list[dict[str, object]] = []
    kept, at = "", 0
    for block in FENCE.finditer(text):
        before = text[at : block.start()]
        made = code(before.rstrip().splitlines()[-1] if before.strip() else "", block[1], block[2] or "", block[3])
        kept += before
        at = block.end()
        if made is None:
            kept += f"```{block[1]}\n{block[3]}```\n"
            continue
        if kept.strip():
            cells.append(cell("markdown", len(cells), words(kept)))
        kept = ""
        cells.append(cell("code", len(cells), made))
    if (kept + text[at:]).strip():
        cells.append(cell("markdown", len(cells), words(kept + text[at:])))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    made_of = {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(made_of, indent=1, ensure_ascii=False) + "\n"


def main() -> None:
    """Writes or compares the notebooks."""
    old = []
    for tutorial, name in TUTORIALS.items():
        path, made = ROOT / "python/examples" / f"{name}.ipynb", notebook(tutorial)
        if sys.argv[1:] == ["--check"]:
            if not path.is_file() or path.read_text("utf-8") != made:
                old.append(path.relative_to(ROOT))
        else:
            path.write_text(made, "utf-8")
    for path in old:
        print(f"{path} is old: run scripts/notebooks.py", file=sys.stderr)
    sys.exit(bool(old))


if __name__ == "__main__":
    main()
