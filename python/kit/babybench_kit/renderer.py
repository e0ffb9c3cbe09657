"""Rendered pictures: ``env.mujoco_renderer``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from babybench_core.window import Window

if TYPE_CHECKING:
    from .core import Core

Camera = tuple[list[float], float, float, float]
"""A free camera: the point that it looks at, m, its distance from it, m, azimuth and elevation, degrees."""

ROOM = "corner"
"""The default camera of pictures."""


class MujocoRenderer:
    """Draws the scene in the engine, as Gymnasium's ``MujocoRenderer`` does with OpenGL."""

    def __init__(self, core: Core, default_cam_config: dict[str, Any] | None = None) -> None:
        """Draws one environment."""
        self._core = core
        self._viewers: dict[str, Any] = {}
        self.viewer = None
        self._window: Window | None = None
        self._shown = 0.0
        self.default_cam_config = default_cam_config

    @property
    def model(self) -> Any:
        """Returns the environment's model."""
        return self._core.model

    @property
    def data(self) -> Any:
        """Returns the environment's state."""
        return self._core.data

    def _free(self) -> Camera:
        """Returns the camera of scenes without one for the room: from a distance at the middle of the scene, or as configured."""
        core, given = self._core, self.default_cam_config or {}
        lookat = given.get("lookat", np.median(core.present.geom_xpos, axis=0))
        distance = given.get("distance", core.blueprint.model_options["extent"])
        turned = (float(given.get("azimuth", 90.0)), float(given.get("elevation", -45.0)))
        return np.asarray(lookat, dtype=np.float64).tolist(), float(distance), *turned

    def _camera(self, camera_id: int | None, camera_name: str | None) -> str | Camera:
        cameras = self._core.names["camera"]
        if camera_id is not None and camera_name is not None:
            raise ValueError("Both `camera_id` and `camera_name` cannot be specified at the same time.")
        if camera_name is not None:
            if camera_name not in cameras:
                raise ValueError(f"there is no camera {camera_name!r}; there are {', '.join(cameras)}")
            return camera_name
        if camera_id is None or camera_id == -1:
            return ROOM if ROOM in cameras else self._free()
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
            camera_name: Name of the camera: ``eye_left``, ``eye_right``, and in BabyBench's scenes ``corner`` (also without any),
                ``top``, ``side1``, ``side2``, ``closeup``. Other scenes have a free camera, ``default_camera_config``.

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
            camera = self._camera(camera_id, camera_name)
            self._show(camera if isinstance(camera, str) and (camera_id, camera_name) != (None, None) else None)
            return None
        raise ValueError(f"render_mode: {render_mode!r} does not exist; there are human, rgb_array and depth_array")

    def _show(self, camera: str | None) -> None:
        """Shows the current state in a window, and waits until it is time for the next step."""
        core = self._core
        if self._window is None:
            self._window = Window("MIMo", core.engine, (core.width, core.height), camera)
            self._shown = core.engine.time
        now = core.engine.time
        self._window.show(max(now - self._shown, 0.0))
        self._shown = now

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._window is not None:
            self._window.close()
        self._window = None
