"""Environments, pictures and videos, for scripts for BabyBench's Python kit (``pip install "babybench[kit]"``)."""

from babybench_core.starter_kit import needed as _needed

with _needed(__name__):
    from babybench_kit.build_xml import build
    from babybench_kit.pictures import (
        evaluation_img,
        evaluation_video,
        render,
        to_grayscale,
        view_binocular,
        view_touches,
    )
    from babybench_kit.runs import ENVS, make_dir, make_env, make_save_dirs

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
