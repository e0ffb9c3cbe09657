"""The command line: ``python -m babybench``, or ``python -m babybench_core`` where a checkout has a ``babybench`` of its own."""

from __future__ import annotations

import argparse
import importlib
import os
import runpy
import signal
import sys
from collections.abc import Sequence
from typing import Optional

from babybench_core import _native, doctor, starter_kit

_SCRIPTS = """
figures RESULTS ... --out DIR draws figures for papers of runs, records and benchmarks.
export RECORD --to FORMATS --out DIR writes a record as Parquet, HDF5, NWB, for Rerun, TensorBoard or Minari.
run [-m] SCRIPT [ARGUMENT ...] runs a Python script that was written for the starter kit on the engine of this package,
wherever MIMo is installed; processes that the script starts inherit that (pip install "babybench[kit]")."""


def _parser(program: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"{program} run", usage="%(prog)s [-m] SCRIPT [ARGUMENT ...]", allow_abbrev=False
    )
    parser.add_argument("-m", dest="module", action="store_true", help="SCRIPT is the name of a module")
    parser.add_argument("script", metavar="SCRIPT", help="a Python file")
    parser.add_argument("arguments", metavar="ARGUMENT", nargs=argparse.REMAINDER, help="arguments of the script")
    return parser


def _run(script: str, arguments: Sequence[str], module: bool) -> None:
    """Runs a script as Python does, except that this package provides ``mimoEnv``; its child processes inherit that."""
    try:
        with starter_kit.needed("babybench run SCRIPT"):
            from babybench_kit import swap
    except ModuleNotFoundError as error:
        raise SystemExit(f"error: {error}") from None
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


def _program() -> str:
    """Returns the command that users type to get here."""
    called = os.path.basename(sys.argv[0] or "")
    if called != "__main__.py":
        return "babybench"
    return f"python -m {os.path.basename(os.path.dirname(os.path.abspath(sys.argv[0])))}"


def main(arguments: Optional[Sequence[str]] = None) -> None:
    """Runs the command with the arguments of a command line.

    Raises:
        SystemExit: The command failed.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    program = _program()
    if given[:1] == ["run"] and len(given) > 1 and (given[1] == "-m" or not given[1].startswith("-")):
        args = _parser(program).parse_args(given[1:])
        _run(args.script, args.arguments, args.module)
        return
    if given[:1] in (["export"], ["figures"]):
        command = importlib.import_module(f"babybench_core.{given[0]}.command")
        command.main(given[1:], program)
        return
    if given[:1] == ["doctor"] and not {"-h", "--help"} & set(given):
        doctor.main()
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # commands save what they have when they are interrupted
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = _native.command_line(given, program)
    if not given or given[0] in ("-h", "--help", "help") or (given[0] == "run" and code == 2):
        print(_SCRIPTS, file=sys.stderr if code else sys.stdout)
    if code:
        raise SystemExit(code)
