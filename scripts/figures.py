#!/usr/bin/env python3
"""Checks the figures that pages quote against the files that they come from, as docs/site/figures.toml lists them.

Usage: scripts/figures.py. Needs Python 3.11. Fails with a line for each figure that no longer agrees.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIST = ROOT / "docs/site/figures.toml"
NUMBERS = {"twelve": 12, "fifteen": 15}


def text(path: str) -> str:
    """Returns a file's text with each run of white space reduced to one space, so that quotes may span lines."""
    return re.sub(r"\s+", " ", (ROOT / path).read_text("utf-8"))


def fault(figure: dict[str, str]) -> str | None:
    """Returns the fault of a figure, or None."""
    page, quote, source, value = (figure[key] for key in ("page", "quote", "source", "value"))
    for path in (page, source.partition("*")[0]):
        if not (ROOT / path).exists():
            return f"there is no {path}"
    if quote not in text(page):
        return f"{page} does not say {quote!r} any more: change or remove its entry"
    if "count" in figure:
        pattern = re.compile(figure["count"], re.MULTILINE)
        if "*" in source:
            found = sum(bool(pattern.search(str(path))) for path in ROOT.glob(source))
        else:
            found = len(pattern.findall((ROOT / source).read_text("utf-8")))
        if found != NUMBERS.get(value, None) and str(found) != value:
            return f"{page} says {quote!r}, but {source} has {found}"
    elif "row" in figure:
        rows = (ROOT / source).read_text("utf-8").splitlines()
        if not any(value in row and all(word in row for word in figure["row"]) for row in rows):
            return f"{page} says {quote!r}, but no row of {source} with {figure['row']} has {value!r}"
    elif value not in text(source):
        return f"{page} says {quote!r}, but {source} does not say {value!r}"
    return None


def main() -> None:
    """Checks every figure."""
    figures = tomllib.loads(LIST.read_text("utf-8"))["figure"]
    faults = [found for figure in figures if (found := fault(figure))]
    for found in faults:
        print(f"docs/site/figures.toml: {found}", file=sys.stderr)
    if faults:
        sys.exit(1)
    print(f"{len(figures)} quoted figures agree with their sources")


if __name__ == "__main__":
    main()
