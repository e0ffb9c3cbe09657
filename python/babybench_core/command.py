"""The command line: ``python -m babybench``, or ``python -m babybench_core`` where a checkout has a ``babybench`` of its own."""

from __future__ import annotations

import argparse
import os
import runpy
import sys
from collections.abc import Sequence
from typing import Optional

from babybench_core import swap


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m babybench", description="BabyBench for Python.", allow_abbrev=False
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    run = commands.add_parser(
        "run",
        help="run a script for the starter kit on the engine of this package, wherever MIMo is installed",
        usage="%(prog)s [-m] SCRIPT [ARGUMENT ...]",
        allow_abbrev=False,
    )
    run.add_argument("-m", dest="module", action="store_true", help="SCRIPT is the name of a module")
    run.add_argument("script", metavar="SCRIPT", help="a Python file")
    run.add_argument("arguments", metavar="ARGUMENT", nargs=argparse.REMAINDER, help="what the script is given")
    return parser


def _run(script: str, arguments: Sequence[str], module: bool) -> None:
    """Runs a script as Python does, but for who serves ``mimoEnv``; processes that it starts inherit that."""
    os.environ[swap.CHOICE] = "babybench"
    swap.watch()
    sys.argv = [script, *arguments]
    if module:
        sys.path[0] = os.getcwd()
        runpy.run_module(script, run_name="__main__", alter_sys=True)
        return
    if not os.path.isfile(script):
        raise SystemExit(f"python -m babybench run: there is no file {script!r}")
    sys.path[0] = os.path.dirname(os.path.abspath(script))
    runpy.run_path(script, run_name="__main__")


def main(arguments: Optional[Sequence[str]] = None) -> None:
    """Does what the arguments of a command line say."""
    args = _parser().parse_args(arguments)
    _run(args.script, args.arguments, args.module)
