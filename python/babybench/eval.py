"""Evaluation of trained policies, for scripts for BabyBench's Python kit (``pip install "babybench[kit]"``)."""

from babybench_core.starter_kit import needed as _needed

with _needed(__name__):
    from babybench_kit.evaluation import EVALS, Eval, EvalHandRegard, EvalSelfTouch

__all__ = ["EVALS", "Eval", "EvalHandRegard", "EvalSelfTouch"]
