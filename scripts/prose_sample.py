#!/usr/bin/env python3
"""Draws lines that people read, so that their language can be judged one by one.

    scripts/prose_sample.py [--seed 1] [--lines 200]

Prints a numbered list with the place of each line. The same seed and commit give the same list. The kinds are sentences and
table rows of Markdown, summary lines of rustdoc (which are also the help texts of the command line), of docstrings and of JSDoc,
and messages of errors.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# The share of each kind, in percent.
SHARES = {"markdown": 35, "rustdoc": 30, "message": 15, "docstring": 10, "jsdoc": 10}
# Written by programs, or not prose: tables of measurements, licences, expected outputs.
LEFT_OUT = re.compile(
    r"^(docs/(worlds|differential)\.md|LICENSE|.*/node_modules/|.*/generated/|.*/tests?/|tests/|.*_tests?\.)"
)

Line = tuple[str, int, str]


def files(*endings: str) -> Iterator[tuple[str, str]]:
    """Yields the path and text of each tracked file with one of these endings."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for path in listed.splitlines():
        if path.endswith(endings) and not LEFT_OUT.match(path):
            yield path, (ROOT / path).read_text("utf-8")


def is_prose(text: str) -> bool:
    """Returns whether a text has enough words to judge, and more words than numbers."""
    words, numbers = re.findall(r"[A-Za-z]{2,}", text), re.findall(r"\d+", text)
    return len(words) >= 4 and len(words) > len(numbers)


def markdown() -> Iterator[Line]:
    """Yields the sentences and table rows of Markdown outside code blocks."""
    for path, text in files(".md"):
        block: list[str] = []
        start, fenced = 0, False
        for number, line in enumerate([*text.splitlines(), ""], 1):
            stripped = line.strip()
            fence = stripped.startswith("```")
            starts = not stripped or fence or re.match(r"[-*#|]|\d+\. ", stripped)
            if block and (starts or fenced):
                for sentence in re.split(r"(?<=[.:?!]) (?=[A-Z`*\[])", " ".join(block)):
                    if is_prose(sentence):
                        yield path, start, sentence
                block = []
            if fence:
                fenced = not fenced
            elif stripped and not fenced:
                if not block:
                    start = number
                block.append(stripped)


def rustdoc() -> Iterator[Line]:
    """Yields the first paragraph of each documentation comment in Rust."""
    for path, text in files(".rs"):
        paragraph: list[str] = []
        start, inside = 0, False
        for number, line in enumerate([*text.splitlines(), ""], 1):
            comment = re.match(r"\s*//[/!](?!/) ?(.*)", line)
            if comment and comment[1]:
                if not inside:
                    paragraph, start = [], number
                if not inside or paragraph:
                    paragraph.append(comment[1])
                inside = True
                continue
            if paragraph and is_prose(" ".join(paragraph)):
                yield path, start, " ".join(paragraph)
            paragraph = []
            inside = comment is not None and inside


def docstrings() -> Iterator[Line]:
    """Yields the first paragraph of each docstring in Python."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for path, text in files(".py", ".pyi"):
        for node in ast.walk(ast.parse(text)):
            found = ast.get_docstring(node) if isinstance(node, kinds) else None
            if found and is_prose(found):
                yield path, getattr(node, "lineno", 1), " ".join(found.split("\n\n")[0].split())


def jsdoc() -> Iterator[Line]:
    """Yields the first sentence of each JSDoc comment in JavaScript."""
    for path, text in files(".js", ".mjs"):
        for match in re.finditer(r"/\*\*(.*?)\*/", text, re.DOTALL):
            words = " ".join(re.sub(r"^\s*\*", "", line).strip() for line in match[1].splitlines())
            words = words.split(" @")[0].strip()
            if is_prose(words) and not words.startswith("@"):
                yield path, text.count("\n", 0, match.start()) + 1, words.split(". ")[0]


def messages() -> Iterator[Line]:
    """Yields messages of errors in Rust, Python and JavaScript."""
    patterns = {
        ".rs": r'(?:#\[error\(|write!\(f, |Err\(format!\(|bail!\(|ensure!\([^"]*)"((?:[^"\\]|\\.)*)"',
        ".py": r'raise \w+\(\s*f?"((?:[^"\\]|\\.)*)"',
        ".js": r'new \w*Error\(\s*[`"]((?:[^`"\\]|\\.)*)[`"]',
    }
    for ending, pattern in patterns.items():
        for path, text in files(ending):
            for match in re.finditer(pattern, text):
                if is_prose(match[1]):
                    yield path, text.count("\n", 0, match.start()) + 1, match[1]


def main() -> None:
    """Prints the sample."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lines", type=int, default=200)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    sources = {"markdown": markdown, "rustdoc": rustdoc, "message": messages, "docstring": docstrings, "jsdoc": jsdoc}
    count = 0
    for kind, share in SHARES.items():
        found = sorted(set(sources[kind]()))
        for path, number, text in sorted(chance.sample(found, min(len(found), options.lines * share // 100))):
            count += 1
            print(f"{count}. {kind}, {path}:{number}: {text}")


if __name__ == "__main__":
    main()
