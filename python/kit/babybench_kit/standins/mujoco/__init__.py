"""MuJoCo's functions on the model and the state of environments, ``env.model`` and ``env.data``.

Everything else is MuJoCo's own business: ``pip install mujoco``.
"""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from babybench_core.mujoco import constants as _constants
from babybench_core.mujoco import enums as _enums
from babybench_core.mujoco import functions as _functions
from babybench_core.mujoco import jacobians as _jacobians
from babybench_core.mujoco import maths as _maths
from babybench_core.mujoco import more_enums as _more_enums
from babybench_core.mujoco.constants import *  # noqa: F403
from babybench_core.mujoco.enums import *  # noqa: F403
from babybench_core.mujoco.functions import *  # noqa: F403
from babybench_core.mujoco.jacobians import *  # noqa: F403
from babybench_core.mujoco.maths import *  # noqa: F403
from babybench_core.mujoco.more_enums import *  # noqa: F403
from babybench_kit.views import DataView as MjData
from babybench_kit.views import ModelView as MjModel

stands_in = True
"""Tells these bindings from MuJoCo's own."""

__version__ = "0.0.0+babybench"

__all__ = ["MjData", "MjModel", "Renderer"]
__all__ += (
    _constants.__all__ + _enums.__all__ + _more_enums.__all__ + _functions.__all__ + _jacobians.__all__ + _maths.__all__
)


class Renderer:
    """Draws the scene of a state, as MuJoCo's renderer does."""

    def __init__(self, model: MjModel, height: int = 240, width: int = 320, max_geom: int = 10000) -> None:
        """Takes the size of pictures, pixels."""
        self.height, self.width = height, width
        self._model = model
        self._data: MjData | None = None
        self._camera = "corner"

    def update_scene(self, data: MjData, camera: int | str = -1, scene_option: Any = None) -> None:
        """Takes the state and the camera of the next picture; without a camera, the one in the corner of the room."""
        cameras = self._model._names["camera"]
        self._camera = camera if isinstance(camera, str) else (cameras[camera] if camera >= 0 else "corner")
        self._data = data

    def render(self, *, out: NDArray[np.uint8] | None = None) -> NDArray[np.uint8]:
        """Draws the picture, (height, width, 3), red, green and blue."""
        if self._data is None:
            raise RuntimeError("call update_scene(env.data) before render()")
        picture: NDArray[np.uint8] = self._data._env.render(self._camera, self.width, self.height)
        if out is None:
            return picture
        out[...] = picture
        return out

    def close(self) -> None:
        """Does nothing."""

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def __getattr__(name: str) -> NoReturn:
    import importlib

    more = hasattr(importlib.import_module("babybench.mujoco"), name)
    raise AttributeError(
        f"mujoco.{name}: MuJoCo is not installed, and what stands in for it here does not have that; "
        + (f"babybench.mujoco.{name} is there (babybench.mujoco.install() makes it this module); or " if more else "")
        + "pip install mujoco"
    )
