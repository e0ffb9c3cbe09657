#!/usr/bin/env python3
"""Keeps figures over time in docs/history.csv: instructions of a step, sizes of the released files, times of the tests.

    scripts/history.py measure        # prints the figures of the working tree
    scripts/history.py add [NOTE]     # appends them to docs/history.csv, and draws docs/history.svg
    scripts/history.py check          # fails if instructions or sizes have risen by more than 3 %

`check` compares the working tree with the last line of the file, and this line with the one before unless it has a note.
Valgrind counts the instructions, in the profile of the tests, so that a busy machine prints the same. Sizes and times are
those that the tests have left in target; what is not there is empty. Needs Cargo and Valgrind; `add` needs Matplotlib.
"""

from __future__ import annotations

import csv
import datetime
import gzip
import io
import os
import platform
import re
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
FILE = ROOT / "docs" / "history.csv"
MOST = 1.03
"""The factor by which a figure may rise without a note."""
STEPS = {"self_touch": 40, "muscles": 40, "cubes": 40, "eyes": 12, "picture": 4}
"""The cases of examples/steps.rs, and how many steps are counted."""
SIZES = ("module_kB", "module_gzip_kB", "wheel_kB", "crate_kB")
TIMES = ("tests_rust_s", "tests_python_s", "tests_web_s")
COLUMNS = ("date", "processor", *(f"{case}_kinstr" for case in STEPS), *SIZES, *TIMES, "note")

Row = dict[str, str]


def instructions(program: Path, case: str, count: int) -> int:
    """Counts the instructions of a run."""
    command = [
        "valgrind",
        "--tool=cachegrind",
        "--cache-sim=no",
        "--cachegrind-out-file=/dev/null",
        program,
        case,
        str(count),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if done.returncode or not found:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr[-2000:]}")
    return int(found[1].replace(",", ""))


def steps() -> Row:
    """Counts thousands of instructions of a step, without those of making the environment and of the first steps."""
    build = [
        "cargo",
        "build",
        "--quiet",
        "--locked",
        "--profile",
        "testing",
        "--workspace",
        "--all-features",
        "--example",
        "steps",
    ]
    subprocess.run(
        build, cwd=ROOT, check=True, env={**os.environ, "CARGO_INCREMENTAL": "0"}
    )  # incremental code is slower
    program = TARGET / "testing" / "examples" / "steps"
    row = {}
    for case, count in STEPS.items():
        more = instructions(program, case, 2 * count) - instructions(program, case, count)
        row[f"{case}_kinstr"] = f"{more / count / 1000:.0f}"
    return row


def archive_size(package: str) -> int:
    """Returns the size of a crate's archive, bytes. Cargo itself packs no crate whose dependencies are not published."""
    command = [
        "cargo",
        "package",
        "--list",
        "--locked",
        "--allow-dirty",
        "--package",
        package,
    ]
    files = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz", compresslevel=9) as archive:
        for file in files:
            if (ROOT / file).is_file():  # Cargo adds some that it makes
                archive.add(ROOT / file)
    return packed.tell()


def sizes() -> Row:
    """Measures files, kB."""
    row = {}
    module = ROOT / "web/dist/babybench/core_bg.wasm"
    if module.is_file():
        data = module.read_bytes()
        row |= {"module_kB": len(data), "module_gzip_kB": len(gzip.compress(data, 9))}
    for wheel in (TARGET / "python/dist").glob("babybench-*.whl"):
        row["wheel_kB"] = wheel.stat().st_size
    row["crate_kB"] = archive_size("babybench")
    return {name: f"{size / 1000:.0f}" for name, size in row.items()}


def times() -> Row:
    """Adds up the seconds of the steps of each part of the last tests."""
    results = ROOT / "target/tests/results"
    seconds: dict[str, int] = {}
    for line in results.read_text("utf-8").splitlines() if results.is_file() else []:
        part, _, _, took, *_ = line.split("\t")
        seconds[part] = seconds.get(part, 0) + int(took)
    return {f"tests_{part}_s": str(took) for part, took in seconds.items() if f"tests_{part}_s" in TIMES}


def processor() -> str:
    """Names the instruction set, on which the counts depend."""
    known = Path("/proc/cpuinfo")
    flags = known.read_text("utf-8") if known.is_file() else ""
    return f"{platform.machine()}{' avx2' if ' avx2 ' in flags else ''}"


def measure() -> Row:
    """Measures everything."""
    return {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "processor": processor(),
        **steps(),
        **sizes(),
        **times(),
    }


def history() -> list[Row]:
    """Reads the file."""
    with FILE.open(encoding="utf-8", newline="") as opened:
        return list(csv.DictReader(opened))


def risen(before: Row, after: Row) -> list[str]:
    """Names the sizes that have risen too much, and the instructions if both processors are of the same kind."""
    same = before["processor"] == after["processor"]
    names = [name for name in COLUMNS if name in SIZES or (same and name.endswith("_kinstr"))]
    known = [name for name in names if before.get(name) and after.get(name)]
    return [
        f"{name} {before[name]} -> {after[name]}" for name in known if float(after[name]) > MOST * float(before[name])
    ]


def check() -> None:
    """Compares the tree with the last line, and the last line with the one before."""
    rows, now = history(), measure()
    print("\n".join(f"{name}: {now.get(name) or '-'} ({rows[-1][name] or '-'})" for name in COLUMNS[:-1]))
    faults = [f"since the last line of docs/history.csv: {one}" for one in risen(rows[-1], now)]
    if len(rows) > 1 and not rows[-1]["note"]:
        faults += [f"in the last line, without a note: {one}" for one in risen(rows[-2], rows[-1])]
    if faults:
        sys.exit(
            "\n".join(
                [
                    *faults,
                    'If the rise is right, say why: scripts/history.py add "NOTE"',
                ]
            )
        )


def draw(rows: list[Row]) -> None:
    """Draws each figure relative to its first value."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "history", "font.size": 9})
    from matplotlib import pyplot

    groups = {
        "instructions of a step": [name for name in COLUMNS if name.endswith("_kinstr")],
        "sizes": list(SIZES),
        "seconds of the tests": list(TIMES),
    }
    figure, axes = pyplot.subplots(1, len(groups), figsize=(11, 3.2), sharex=True, layout="constrained")
    for axis, (title, names) in zip(axes, groups.items()):
        for name in names:
            points = [(k, float(row[name])) for k, row in enumerate(rows, 1) if row[name]]
            if points:
                label = name.rsplit("_", 1)[0].replace("_", " ")
                axis.plot(
                    [k for k, _ in points],
                    [value / points[0][1] for _, value in points],
                    marker="o",
                    markersize=3,
                    label=label,
                )
        axis.set(
            title=title,
            ylabel="relative to the first line",
            xlabel="line of docs/history.csv",
        )
        axis.xaxis.get_major_locator().set_params(integer=True)
        axis.set_ylim(bottom=0)
        if axis.lines:
            axis.legend(frameon=False, fontsize=8, loc="lower left")
        axis.spines[["top", "right"]].set_visible(False)
    figure.savefig(FILE.with_suffix(".svg"), metadata={"Date": None})


def add(note: str) -> None:
    """Appends a line and draws all of them."""
    row = measure()
    with FILE.open("a", encoding="utf-8", newline="") as opened:
        csv.DictWriter(opened, COLUMNS, restval="", lineterminator="\n").writerow({**row, "note": note})
    rows = history()
    if len(rows) > 1:  # a chart of one line shows nothing
        draw(rows)


def main() -> None:
    """Runs a command."""
    match sys.argv[1:]:
        case ["measure"]:
            for name, value in measure().items():
                print(f"{name}: {value}")
        case ["add"]:
            add("")
        case ["add", note]:
            add(note)
        case ["check"]:
            check()
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
