"""MIMo 3, run by this library; registers the ids of its environments with Gymnasium."""

import importlib

from babybench_kit import utils as mimo_utils
from babybench_kit.actuation import MuscleModel, PositionalModel, SpringDamperModel
from babybench_kit.third.env import MIMoEnv
from babybench_kit.third.growth import adjust_mimo_to_age, delete_growth_scene
from babybench_kit.third.roll_over import MIMoRollOverEnv
from babybench_kit.third.simulate import main as simulate
from babybench_kit.third.tasks import MIMoCatchEnv, MIMoReachEnv, MIMoSelfBodyEnv, MIMoStandupEnv

__version__ = "3.0.0"

__all__ = [
    "MIMoCatchEnv",
    "MIMoEnv",
    "MIMoReachEnv",
    "MIMoRollOverEnv",
    "MIMoSelfBodyEnv",
    "MIMoStandupEnv",
    "MuscleModel",
    "PositionalModel",
    "SpringDamperModel",
    "__version__",
    "adjust_mimo_to_age",
    "delete_growth_scene",
    "mimo_utils",
    "simulate",
]

importlib.import_module("mimo_infant.simulation.envs")
