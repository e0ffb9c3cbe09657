"""The tutorials in ``docs/tutorials`` work as they are typed: their files, programs and commands, and the output that they show.

Blocks of code run in the order of a page, in a folder of their own. What readers save is the block after "Save ... as `NAME`".
Blocks marked ``install`` do not run, because the tests have installed the package. Those marked ``serve`` run until their page
has been loaded. A block ``text`` is the output of the block before it, in which ``...`` stands for any text. Tutorials in Rust
and on the web are tested as documentation of the library and in ``web/tests``.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import urllib.request
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = DOCS / "tutorials"
CHAPTERS = ("surprises", "known-faults")  # of the guide
FENCE = re.compile(r"^```(\w+)(?: (\w+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NEEDS = {
    "ten-minutes": ("matplotlib",),
    "curiosity": ("matplotlib",),
    "ages": ("matplotlib",),
    "switching": ("babybench_kit",),
}
TESTED_ELSEWHERE = {"own-task", "page"}


class Block(NamedTuple):
    """A block of code on a page."""

    language: str
    mark: str
    text: str
    name: str
    """The file that readers save it as; empty for others."""


def blocks(page: str) -> Iterator[Block]:
    """Yields the blocks of a page."""
    folder = DOCS / "guide" if page in CHAPTERS else PAGES
    text = (folder / f"{page}.md").read_text("utf-8")
    for found in FENCE.finditer(text):
        before = text[: found.start()].rstrip().splitlines()[-1]
        names = (
            re.findall(r"\bSave (?:[^.`]|\.(?! ))*`([^`]+)`", before)
            if found[1] in ("yaml", "xml", "html", "python")
            else []
        )
        yield Block(found[1], found[2] or "", found[3], names[-1] if names else "")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which ``babybench`` and ``python`` are those of this test."""
    programs = tmp_path / "programs"
    programs.mkdir()
    for name, arguments in (("babybench", "-m babybench_core"), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments} "$@"\n')
        program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("MPLBACKEND", "Agg")
    place = tmp_path / "place"
    place.mkdir()
    return place


def run(command: list[str], folder: Path) -> str:
    """Runs a program, which succeeds, and returns what it prints."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def serve(command: str, folder: Path) -> None:
    """Runs a program until it has printed an address, and loads the page there."""
    process = subprocess.Popen(
        ["sh", "-c", f"exec {command}"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    timer = threading.Timer(60, process.kill)
    timer.start()
    try:
        assert process.stdout is not None
        address = next((found[0] for line in process.stdout if (found := re.search(r"http://[^\s]+", line))), None)
        assert address, f"{command} printed no address"
        with urllib.request.urlopen(address, timeout=30) as page:
            assert b"<html" in page.read()
    finally:
        timer.cancel()
        process.kill()
        process.communicate()


def check_output(said: str, shown: str) -> None:
    """Compares output with a block of a page."""
    parts = [re.escape(part) for part in shown.split("...")]
    pattern = ".*".join(parts)
    assert re.fullmatch(pattern, said if said.endswith("\n") else said + "\n", re.DOTALL), (
        f"said:\n{said}\nshown:\n{shown}"
    )


@pytest.mark.skipif(os.name == "nt", reason="the tutorials' commands are for a POSIX shell")
@pytest.mark.parametrize(
    "page",
    [*sorted(path.stem for path in PAGES.glob("*.md") if path.stem not in {"README", *TESTED_ELSEWHERE}), *CHAPTERS],
)
def test_tutorial(page: str, folder: Path) -> None:
    for package in NEEDS.get(page, ()):
        pytest.importorskip(package, reason=f"the tutorial needs {package}")
    program: list[str] = []
    said = ""
    for block in blocks(page):
        if block.mark == "install" or block.language == "rust":
            continue
        if block.language == "text":
            check_output(said, block.text)
        elif block.name and block.language != "python":
            path = folder / block.name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, "utf-8")
        elif block.language == "python" and block.mark == "script":
            (folder / block.name).write_text(block.text, "utf-8")
        elif block.language == "python":
            # blocks of one program go on where the last has ended: only the output of the new one counts
            program.append(block.text)
            marker = "print('-- next block --')\n"
            (folder / "program.py").write_text(marker.join(program), "utf-8")
            said = run([sys.executable, "program.py"], folder).split("-- next block --\n")[-1]
        elif block.language == "sh" and block.mark == "serve":
            serve(block.text.strip(), folder)
        elif block.language == "sh":
            said = run(["sh", "-ec", block.text], folder)
        else:
            pytest.fail(f"{page}.md has a block of {block.language} that nothing runs")


def test_each_tutorial_is_tested_somewhere() -> None:
    languages = {path.stem: {block.language for block in blocks(path.stem)} for path in PAGES.glob("*.md")}
    assert languages.pop("README") == set()
    assert "rust" in languages["own-task"]
    assert "html" in languages["page"]
    assert len(languages) == 8


@pytest.mark.parametrize("name", ["ten_minutes", "curiosity", "ages"])
def test_notebook_of_a_tutorial(name: str, folder: Path) -> None:
    nbclient = pytest.importorskip("nbclient", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("ipykernel", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("matplotlib", reason="the pictures need matplotlib")
    import nbformat

    root = DOCS.parent
    done = subprocess.run(
        [sys.executable, str(root / "scripts" / "notebooks.py"), "--check"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    cells = nbformat.read(root / "python" / "examples" / f"{name}.ipynb", as_version=4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Jupyter's own
        client = nbclient.NotebookClient(
            cells, timeout=600, startup_timeout=600, resources={"metadata": {"path": str(folder)}}
        )
        client.execute(env={**os.environ, "MPLBACKEND": "module://matplotlib_inline.backend_inline"})
    outputs = [out for cell in cells.cells for out in cell.get("outputs", [])]
    said = "".join(out.get("text", "") for out in outputs)
    if name == "ten_minutes":
        assert "1000 steps" in said
        assert (folder / "mimo.gif").is_file()
    elif name == "curiosity":
        assert any("image/png" in out.get("data", {}) for out in outputs)
    else:
        assert "figures/benchmark.svg" in said
