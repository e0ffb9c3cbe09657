"""MIMo's own experiments: ``mimoEnv.envs``. Four are tasks of this package; errors of the others name what to use."""

from __future__ import annotations

from typing import Any, ClassVar, NoReturn

from babybench_core.env import Env

from .swap import CHOICE

_MIMOS_ARGUMENTS = frozenset(
    {
        "model_path",
        "initial_qpos",
        "camera_id",
        "camera_name",
        "width",
        "height",
        "default_camera_config",
        "proprio_params",
        "touch_params",
        "vision_params",
        "vestibular_params",
        "goals_in_observation",
        "done_active",
    }
)
"""Arguments of MIMo's constructors that are not keys of a configuration."""

_REACH_FOR = "take MIMo's own with " + CHOICE + "=original where MIMo is installed (pip install -e MIMo)"


class Experiment(Env):
    """A MIMo experiment as a task of this package: ``babybench.make`` under MIMo's name.

    The keys of a configuration take the place of the arguments of MIMo's constructors.
    """

    task: ClassVar[str] = ""
    """The example configuration that it is."""

    def __init_subclass__(cls, **_: Any) -> None:
        """Refuses subclasses of a script: what they replace would not be called."""
        if cls.__module__ != __name__:
            raise TypeError(
                f"{cls.__name__}: a task runs in the engine, which calls no method of a subclass. Subclass "
                "mimoEnv.envs.mimo_env.MIMoEnv or BabyBenchEnv, wrap the environment (gymnasium.Wrapper), or "
                + _REACH_FOR
            )

    def __init__(self, **keys: Any) -> None:
        """Builds the environment; arguments and keys are those of :class:`babybench.Env`.

        Raises:
            TypeError: A MIMo argument that this package does not have.
        """
        strange = sorted(_MIMOS_ARGUMENTS & set(keys))
        if strange:
            raise TypeError(
                f"{type(self).__name__}: {', '.join(strange)} of MIMo's constructor cannot be given here; keys of a "
                f"configuration decide (touch_active, vision_resolution, ...: babybench.config_keys()). Or {_REACH_FOR}"
            )
        super().__init__(self.task, **keys)


class MIMoReachEnv(Experiment):
    """MIMo reaches for a ball: ``babybench.make("reach")``."""

    task = "reach"


class MIMoStandupEnv(Experiment):
    """MIMo pulls itself up in a crib: ``babybench.make("standup")``."""

    task = "standup"


class MIMoSelfBodyEnv(Experiment):
    """MIMo touches a part of its body: ``babybench.make("selfbody")``."""

    task = "selfbody"


class MIMoCatchEnv(Experiment):
    """MIMo catches a falling ball: ``babybench.make("catch")``."""

    task = "catch"


IDS = {
    "MIMoReach-v0": (MIMoReachEnv, 1000),
    "MIMoStandup-v0": (MIMoStandupEnv, 500),
    "MIMoSelfBody-v0": (MIMoSelfBodyEnv, 500),
    "MIMoCatch-v0": (MIMoCatchEnv, 800),
}
"""The ids of the experiments that are tasks here, with the steps of an episode."""

_SCENE = (
    "gymnasium.make('BabyBench') is MIMo in an empty scene, babybench.make(actuation_model=...) chooses its actuators"
)
_MUSCLES = "babybench.make('self_touch', actuation_model='muscle') has MIMo's muscles"
ELSEWHERE = {
    "MIMoBench-v0": ("MIMoDummyEnv", _SCENE),
    "MIMoBenchV2-v0": ("MIMoV2DummyEnv", "babybench.make('hand_regard') has MIMo v2"),
    "MIMoShowroom-v0": ("MIMoV2DummyEnv", "babybench.make('hand_regard') has MIMo v2"),
    "MIMoMuscle-v0": ("MIMoMuscleDummyEnv", _MUSCLES),
    "MIMoMuscleStaticTest-v0": ("MIMoStaticMuscleTestEnv", _MUSCLES),
    "MIMoVelocityMuscleTest-v0": ("MIMoVelocityMuscleTestEnv", _MUSCLES),
    "MIMoMuscleStaticTestV2-v0": ("MIMoStaticMuscleTestV2Env", _MUSCLES),
    "MIMoVelocityMuscleTestV2-v0": ("MIMoVelocityMuscleTestV2Env", _MUSCLES),
    "MIMoComplianceTest-v0": ("MIMoComplianceEnv", _SCENE),
    "MIMoComplianceMuscleTest-v0": ("MIMoComplianceMuscleEnv", _MUSCLES),
}
"""The ids of the others, with their classes and what is nearest to them here."""


def refuse(experiment: str, **_: Any) -> NoReturn:
    """Tells what to use instead of an experiment that is not a task here.

    Raises:
        NotImplementedError: Always.
    """
    raise NotImplementedError(f"{experiment} is not part of babybench: {ELSEWHERE[experiment][1]}; or {_REACH_FOR}")


def missing(module: str, name: str) -> NoReturn:
    """Tells what to use instead of a class that ``mimoEnv.envs`` does not have here.

    Raises:
        ImportError: It is one of MIMo's.
        AttributeError: It is not.
    """
    for cls, instead in ELSEWHERE.values():
        if cls == name:
            raise ImportError(f"{name} is not part of babybench: {instead}; or {_REACH_FOR}")
    raise AttributeError(f"module {module!r} has no attribute {name!r}")
