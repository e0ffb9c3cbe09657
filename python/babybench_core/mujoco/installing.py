"""Makes ``import mujoco`` import :mod:`babybench.mujoco`, so that programs run unchanged."""

from __future__ import annotations

import importlib
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

__all__ = ["install", "uninstall"]

_NAME = "mujoco"
_OWN = "babybench.mujoco"
_RENDERING = "gymnasium.envs.mujoco.mujoco_rendering"
_ENVIRONMENTS = "gymnasium.envs.mujoco.mujoco_env"


def _beside_this_package() -> None:
    """Imports :mod:`babybench.mujoco` where ``babybench`` is another package, as for scripts in the starter kit's folder."""
    folder = Path(__file__).parents[2].joinpath(*_OWN.split("."))
    spec = spec_from_file_location(_OWN, folder / "__init__.py", submodule_search_locations=[str(folder)])
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[_OWN] = module_from_spec(spec)
    spec.loader.exec_module(module)


def _own() -> dict[str, ModuleType]:
    try:
        importlib.import_module(_OWN)
    except ModuleNotFoundError as error:
        if error.name != _OWN:
            raise
        _beside_this_package()
    names = {_NAME: _OWN, _RENDERING: "babybench_core.mujoco.gymnasium_rendering"}
    names.update({f"{_NAME}.{part}": f"{_OWN}.{part}" for part in ("rollout", "viewer")})
    return {name: importlib.import_module(own) for name, own in names.items()}


def put() -> ModuleType:
    """Puts the modules in place of MuJoCo's and of Gymnasium's renderer, unless those were imported already."""
    own = _own()
    sys.modules[_NAME] = own[_NAME]
    for name, module in own.items():
        sys.modules.setdefault(name, module)
    return own[_NAME]


def _real(module: ModuleType | None) -> bool:
    """Returns whether a module is MuJoCo's own and not a stand-in."""
    return module is not None and not getattr(module, "stands_in", False)


def install() -> ModuleType:
    """Makes ``import mujoco`` import :mod:`babybench.mujoco` in this process, and lets Gymnasium draw without OpenGL.

    Gymnasium's own MuJoCo environments then run unchanged on the engine of this package, whether MuJoCo is installed or
    not. Call it before anything imports ``mujoco``; calling it again does nothing.

    Example:
        >>> import babybench.mujoco
        >>> _ = babybench.mujoco.install()
        >>> import gymnasium
        >>> env = gymnasium.make("Ant-v5")

    Returns:
        The module :mod:`babybench.mujoco`.

    Raises:
        RuntimeError: MuJoCo itself was imported already, or Gymnasium's environments with a stand-in for it; nothing is
            changed.
    """
    own = _own()
    present = sys.modules.get(_NAME)
    if present is own[_NAME]:
        return present
    environments = sys.modules.get(_ENVIRONMENTS)
    if _real(present):
        raise RuntimeError(
            f"MuJoCo itself was imported already ({getattr(present, '__file__', None)}): its importers would keep it. Call "
            "babybench.mujoco.install() before anything imports mujoco, or import babybench.mujoco under a name of its own"
        )
    if environments is not None and getattr(environments, _NAME, None) is not own[_NAME]:
        raise RuntimeError(
            "gymnasium.envs.mujoco was imported already: call babybench.mujoco.install() before it is, and before the first "
            "gymnasium.make of one of its environments"
        )
    sys.modules.update(own)
    return own[_NAME]


def uninstall() -> None:
    """Reverts :func:`install` for later imports. Modules that have imported ``mujoco`` keep it.

    Raises:
        RuntimeError: Gymnasium's environments were imported meanwhile, and would mix both.
    """
    own = _own()
    if sys.modules.get(_NAME) is not own[_NAME]:
        return
    if _ENVIRONMENTS in sys.modules:
        raise RuntimeError(
            "gymnasium.envs.mujoco has been imported and keeps babybench.mujoco: start another process for MuJoCo itself"
        )
    for name in own:
        sys.modules.pop(name, None)
