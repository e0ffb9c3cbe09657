"""Environments, pictures and videos for scripts that were written for BabyBench's Python kit."""

from babybench.build_xml import build
from babybench_core.mimo.pictures import (
    evaluation_img,
    evaluation_video,
    render,
    to_grayscale,
    view_binocular,
    view_touches,
)
from babybench_core.mimo.runs import ENVS, make_dir, make_env, make_save_dirs

__all__ = [
    "ENVS",
    "EPS",
    "build",
    "evaluation_img",
    "evaluation_video",
    "make_dir",
    "make_env",
    "make_save_dirs",
    "render",
    "to_grayscale",
    "view_binocular",
    "view_touches",
]

EPS = 1e-6
