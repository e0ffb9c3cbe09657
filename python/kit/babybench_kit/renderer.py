"""Pictures for people: ``env.mujoco_renderer``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .core import Core

ROOM = "corner"
"""The camera of pictures for which none is asked."""


class MujocoRenderer:
    """Draws the scene in the engine, as Gymnasium's ``MujocoRenderer`` does with OpenGL."""

    def __init__(self, core: Core, default_cam_config: dict[str, Any] | None = None) -> None:
        """Draws one environment."""
        self._core = core
        self._viewers: dict[str, Any] = {}
        self.viewer = None
        self.default_cam_config = default_cam_config

    @property
    def model(self) -> Any:
        """Returns the environment's model."""
        return self._core.model

    @property
    def data(self) -> Any:
        """Returns the environment's state."""
        return self._core.data

    def _camera(self, camera_id: int | None, camera_name: str | None) -> str:
        cameras = self._core.names["camera"]
        if camera_id is not None and camera_name is not None:
            raise ValueError("Both `camera_id` and `camera_name` cannot be specified at the same time.")
        if camera_name is not None:
            if camera_name not in cameras:
                raise ValueError(f"there is no camera {camera_name!r}; there are {', '.join(cameras)}")
            return camera_name
        if camera_id is None or camera_id == -1:
            return ROOM
        if not 0 <= camera_id < len(cameras):
            raise ValueError(f"there is no camera {camera_id}; there are {len(cameras)}: {', '.join(cameras)}")
        return cameras[camera_id]

    def render(
        self, render_mode: str | None = None, camera_id: int | None = None, camera_name: str | None = None, **_: Any
    ) -> NDArray[Any] | None:
        """Draws the scene as it was at the start of the last physics step.

        Args:
            render_mode: ``rgb_array``, or ``depth_array`` for the depth buffer: 0 at the near plane, 1 at the far one.
            camera_id: Id of the camera.
            camera_name: Name of the camera: ``corner`` (also without any), ``top``, ``side1``, ``side2``, ``closeup``,
                ``eye_left``, ``eye_right``.

        Returns:
            Red, green and blue, (height, width, 3) bytes, or depths, (height, width); rows from the top.
        """
        if render_mode is None:
            return None
        core = self._core
        core.pull()
        if render_mode == "rgb_array":
            return core.engine.render(self._camera(camera_id, camera_name), core.width, core.height)
        if render_mode == "depth_array":
            distance = core.engine.depth(self._camera(camera_id, camera_name), core.width, core.height)
            options = core.blueprint.model_options
            near, far = (options[plane] * options["extent"] for plane in ("znear", "zfar"))
            depth = (1 / near - 1 / distance.astype(np.float64)) / (1 / near - 1 / far)
            return np.asarray(depth, dtype=np.float32)
        if render_mode == "human":
            raise NotImplementedError(
                "render_mode human: there is no window here. Show render_mode='rgb_array' with matplotlib or OpenCV, or use "
                "babybench.make(..., render_mode='human')"
            )
        raise ValueError(f"render_mode: {render_mode!r} does not exist; there are rgb_array and depth_array")

    def close(self) -> None:
        """Does nothing: there is no window and no context."""
