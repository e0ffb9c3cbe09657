"""``python -m babybench export RECORD --to parquet,nwb --out DIR``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from babybench_core import data
from babybench_core.export import FORMATS, export


def main(arguments: Sequence[str], program: str) -> None:
    """Runs the command with its arguments.

    Raises:
        SystemExit: The command failed.
    """
    parser = argparse.ArgumentParser(
        prog=f"{program} export",
        description="Writes a record in formats of other programs.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="\n".join(
            f"{name:12} {what.what} (pip install 'babybench[{what.extra}]')" for name, what in FORMATS.items()
        ),
        allow_abbrev=False,
    )
    parser.add_argument("record", metavar="RECORD", type=Path, help="folder of a record: --record of run and evaluate")
    parser.add_argument("--to", required=True, metavar="FORMATS", help=f"one or more of {','.join(FORMATS)}")
    parser.add_argument("--out", required=True, metavar="DIR", type=Path, help="folder for the files")
    args = parser.parse_args(arguments)
    formats = [name.strip() for name in args.to.split(",") if name.strip()]
    try:
        written = export(data.open(args.record), formats, args.out)
    except (OSError, ValueError, ModuleNotFoundError) as error:
        raise SystemExit(f"error: {error}") from None
    for name, path in written.items():
        print(f"{path}: {FORMATS[name].what}")
