"""BabyBench: the infant model MIMo behind Gymnasium's interface, on a physics engine in Rust.

Example:
    >>> import babybench
    >>> env = babybench.make("self_touch")
    >>> observation, info = env.reset(seed=0)
    >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    >>> env.close()

:func:`make` and :class:`Env` give one environment, :class:`VectorEnv` many, ``babybench.sb3`` many for
Stable-Baselines3, and ``babybench.pettingzoo`` two infants in one room. :class:`ActionNoise` moves them at random,
:func:`view` shows them in a browser or a notebook, and :func:`film` makes a recording for notebooks.
Importing the package registers with Gymnasium ``babybench/SelfTouch-v0``,
``babybench/HandRegard-v0``, ``babybench/Installation-v0`` and, for tasks with a reward, ``babybench/Reach-v0``,
``babybench/Standup-v0``, ``babybench/SelfBody-v0``, ``babybench/Catch-v0``, ``babybench/RollOver-v0``,
``babybench/Mobile-v0`` and ``babybench/Play-v0``.
``babybench.utils``, ``babybench.eval``, ``babybench.build_xml`` and ``mimoEnv`` are those of the BabyBench starter
kit, for scripts written for it: ``pip install "babybench[kit]"``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from babybench_core._native import __version__, config_examples, config_keys
from babybench_core._paths import extended as _extended
from babybench_core.starter_kit import claim as _claim

if TYPE_CHECKING:
    from babybench_core.env import Env, make
    from babybench_core.film import Film, film
    from babybench_core.noise import ActionNoise
    from babybench_core.scenes import read_config
    from babybench_core.vector import VectorEnv
    from babybench_core.view import View, view

__all__ = [
    "ActionNoise",
    "Env",
    "Film",
    "VectorEnv",
    "View",
    "__version__",
    "config_examples",
    "config_keys",
    "film",
    "make",
    "read_config",
    "view",
]

__path__ = _extended(__path__)

_HOMES = {
    "ActionNoise": "babybench_core.noise",
    "Env": "babybench_core.env",
    "Film": "babybench_core.film",
    "data": "babybench.data",
    "figures": "babybench.figures",
    "film": "babybench_core.film",
    "VectorEnv": "babybench_core.vector",
    "View": "babybench_core.view",
    "make": "babybench_core.env",
    "pettingzoo": "babybench.pettingzoo",
    "protocol": "babybench.protocol",
    "read_config": "babybench_core.scenes",
    "sb3": "babybench.sb3",
    "view": "babybench_core.view",
}


def __getattr__(name: str) -> Any:
    """Imports modules on first use."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    home = import_module(_HOMES[name])
    return home if name in ("data", "figures", "pettingzoo", "protocol", "sb3") else getattr(home, name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])


def _tell_gymnasium() -> None:
    from babybench_core.registration import register

    register()


_tell_gymnasium()
_claim()
