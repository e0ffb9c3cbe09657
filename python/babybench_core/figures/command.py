"""``python -m babybench figures RESULTS ... --out DIR``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from babybench_core import data, figures
from babybench_core.figures import curves, logs


def main(arguments: Sequence[str], program: str) -> None:
    """Runs the command with its arguments.

    Raises:
        SystemExit: The command failed.
    """
    parser = argparse.ArgumentParser(
        prog=f"{program} figures",
        description="Draws figures of results: learning curves of trainings, touch of records on the body and over time, means"
        " and touch by age of benchmarks.",
        epilog="RESULTS are folders: runs (save_dir), records (--record), benchmarks (--out of benchmark). NAME=FOLDER gives them"
        " names in legends; runs with one name are its seeds, and so are runs without names in one folder.",
        allow_abbrev=False,
    )
    parser.add_argument("results", metavar="[NAME=]RESULTS", nargs="+", help="folders of runs, records or benchmarks")
    parser.add_argument("--out", required=True, metavar="DIR", type=Path, help="folder for the figures")
    parser.add_argument("--format", default="svg,pdf", help="svg, pdf, png; svg,pdf by default")
    parser.add_argument("--metric", help=f"metric of learning curves: {', '.join(logs.METRICS)}")
    parser.add_argument("--what", default="own", choices=["own", "all"], help="which touch is drawn on the body")
    args = parser.parse_args(arguments)
    formats = [name.strip() for name in args.format.split(",") if name.strip()]
    try:
        for name, made in draw(args.results, args.metric, args.what):
            args.out.mkdir(parents=True, exist_ok=True)
            for file in figures.save(made, args.out / name, formats):
                print(file)
    except (OSError, ValueError, ModuleNotFoundError) as error:
        raise SystemExit(f"error: {error}") from None


def draw(results: Sequence[str], metric: str | None, what: str) -> list[tuple[str, Any]]:
    """Draws the results in folders: names and figures.

    Raises:
        FileNotFoundError: A folder has nothing to draw.
        ValueError: Damaged results.
    """
    runs: dict[str, list[Path]] = {}
    records: dict[str, data.Record] = {}
    benchmarks: list[Path] = []
    for result in results:
        name, path = _named(result)
        if (path / "manifest.json").is_file():
            records[name or path.name] = data.open(path)
        elif (path / "benchmark.json").is_file():
            benchmarks.append(path)
        else:
            logs.find(path)
            runs.setdefault(name or path.resolve().parent.name, []).append(path)
    made = []
    if runs:
        made.append(("learning-curves", figures.learning_curves(runs, metric)))
    for path in benchmarks:
        stem = f"benchmark-{path.resolve().name}" if len(benchmarks) > 1 else "benchmark"
        made.append((stem, figures.benchmark_bars(path)))
        ages = _ages(path)
        if ages:
            made.append((f"{stem}-touch-by-age", figures.touch_on_body(ages, what=what)))
    touching = {name: record for name, record in records.items() if record.has_skin and len(record)}
    if touching:
        made.append(("touch-on-body", figures.touch_on_body(touching, what=what)))
    for name, record in records.items():
        plain = "".join(c if c.isalnum() or c in "-_." else "_" for c in name)
        made += [(f"touches-{plain}-{number}", figures.touch_raster(episode)) for number, episode in record.items()]
    return made


def _named(result: str) -> tuple[str, Path]:
    name, equals, path = result.partition("=")
    # a folder may have an equals sign in its name
    return (name, Path(path)) if equals and not Path(result).exists() else ("", Path(result))


def _ages(path: Path) -> dict[str, data.Record]:
    """Returns a record for each age of a benchmark, of its first policy that has them."""
    found: dict[str, data.Record] = {}
    policy = None
    for run in curves.read_benchmark(path).get("runs", []):
        folder = path / "records" / run["name"]
        if Path(run["name"]).name != run["name"] or not (folder / "manifest.json").is_file():
            continue
        policy = policy or run["policy"]
        label = "18 months" if run["age"] is None else curves.months(run["age"])
        record = data.open(folder)
        if run["policy"] == policy and label not in found and record.has_skin and len(record):
            found[label] = record
    return found
