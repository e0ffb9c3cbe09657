"""Runs the command line."""

from babybench_core.command import main

main()
