"""Evaluation of trained policies, for scripts that were written for BabyBench's Python kit."""

from babybench_core.mimo.evaluation import EVALS, Eval, EvalHandRegard, EvalSelfTouch

__all__ = ["EVALS", "Eval", "EvalHandRegard", "EvalSelfTouch"]
