"""Replaces ``gymnasium.envs.mujoco.mujoco_rendering``: pictures of Gymnasium's environments without OpenGL."""

from __future__ import annotations

import time
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .data import MjData
from .enums import mjtCamera
from .model import MjModel
from .renderer import MjvCamera, draw
from .window import Window

__all__ = ["MujocoRenderer", "OffScreenViewer"]

_MODES = ("rgb_array", "depth_array", "rgbd_tuple")


class OffScreenViewer:
    """Draws one environment; ``cam`` is where the free camera is."""

    def __init__(
        self, model: MjModel, data: MjData, width: int | None = None, height: int | None = None, *_: Any
    ) -> None:
        """Places the free camera as Gymnasium does: it looks at the median of the geoms."""
        self.model, self.data = model, data
        self.width = int(width or model.vis.global_.offwidth)
        self.height = int(height or model.vis.global_.offheight)
        self.cam = MjvCamera()
        self.cam.lookat[:] = np.median(data.geom_xpos, axis=0)
        self.cam.distance = model.stat.extent
        self._native = _native.PhysicsRenderer(model._own)

    def render(self, render_mode: str | None, camera_id: int | None = None, segmentation: bool = False) -> Any:
        """Draws from a camera of the model, or from the free one: colours, the depth buffer (0 near, 1 far), or both."""
        if segmentation:
            raise NotImplementedError(
                "segmentation is not available here: use babybench.mujoco.Renderer.enable_segmentation_rendering"
            )
        if camera_id is not None:
            self.cam.type = int(mjtCamera.mjCAMERA_FREE if camera_id == -1 else mjtCamera.mjCAMERA_FIXED)
            self.cam.fixedcamid = camera_id
        size = (self.width, self.height)
        if render_mode == "rgb_array":
            return draw(self._native, self.data, self.cam, size, "rgb")
        depth = self._depth(draw(self._native, self.data, self.cam, size, "depth"))
        return depth if render_mode == "depth_array" else (draw(self._native, self.data, self.cam, size, "rgb"), depth)

    def _depth(self, distance: NDArray[Any]) -> NDArray[np.float32]:
        planes, extent = self.model.vis.map, self.model.stat.extent
        near, far = planes.znear * extent, planes.zfar * extent
        distance = np.minimum(distance.astype(np.float64), far)
        return np.asarray((1 / near - 1 / distance) / (1 / near - 1 / far), np.float32)

    def close(self) -> None:
        """Has no effect, because there is no window and no context."""

    def __getattr__(self, name: str) -> NoReturn:
        raise AttributeError(
            f"{name}: pictures are drawn without OpenGL here, and have render() and cam alone; draw markers and text on them "
            "afterwards"
        )


class MujocoRenderer:
    """Draws the environments of Gymnasium that MuJoCo runs, with its arguments and results; its window is a page."""

    def __init__(
        self,
        model: MjModel,
        data: MjData,
        default_cam_config: dict[str, Any] | None = None,
        width: int | None = None,
        height: int | None = None,
        max_geom: int = 1000,
        camera_id: int | None = None,
        camera_name: str | None = None,
        visual_options: dict[int, bool] | None = None,
    ) -> None:
        """Takes the size of pictures, pixels, and the camera: a free one unless one of the model's is requested."""
        if visual_options:
            raise NotImplementedError("visual_options are not supported: pictures show what MuJoCo shows by default")
        self.model, self.data = model, data
        self.viewer: OffScreenViewer | None = None
        self._window: Window | None = None
        self._shown = (0.0, 0.0)
        self.default_cam_config = default_cam_config
        self.width, self.height, self.max_geom = width, height, max_geom
        self.camera_id = self._camera(camera_id, camera_name)

    def _camera(self, camera_id: int | None, camera_name: str | None) -> int:
        if camera_id is not None and camera_name is not None:
            raise ValueError("Both `camera_id` and `camera_name` cannot be specified at the same time.")
        if camera_name is None:
            return -1 if camera_id is None else camera_id
        names = self.model._names["camera"]
        if camera_name not in names:
            raise ValueError(f"there is no camera {camera_name!r}; there are {', '.join(names) or 'none'}")
        return names.index(camera_name)

    def render(self, render_mode: str | None, camera_id: int | None = None, camera_name: str | None = None) -> Any:
        """Draws the environment: ``rgb_array``, ``depth_array`` or ``rgbd_tuple``; before Gymnasium 1.0 with a camera.

        ``human`` shows it on a page of this machine and returns ``None``. The first call prints the address. While a browser
        shows it, the environment runs in real time.
        """
        if render_mode == "human":
            self._show()
            return None
        if render_mode not in _MODES:
            raise AttributeError(f"Unexpected mode: {render_mode}, expected modes: human, {', '.join(_MODES)}")
        if self.viewer is None:
            self.viewer = OffScreenViewer(self.model, self.data, self.width, self.height)
            self._place(self.viewer.cam)
        chosen = self.camera_id
        if camera_id is not None or camera_name is not None:
            chosen = self._camera(camera_id, camera_name)
        return self.viewer.render(render_mode, chosen)

    def _place(self, cam: MjvCamera) -> None:
        """Places a free camera as the environment asks."""
        for key, value in (self.default_cam_config or {}).items():
            if isinstance(value, np.ndarray):
                getattr(cam, key)[:] = value
            else:
                setattr(cam, key, value)

    def _show(self) -> None:
        """Shows the state on the page and waits until it is due."""
        if self._window is None:
            self._window = Window(self.model, self.data)
            self._window.cam.lookat[:] = np.median(self.data.geom_xpos, axis=0)
            self._window.cam.distance = self.model.stat.extent
            self._place(self._window.cam)
            if self.camera_id >= 0:
                self._window.choose(self.camera_id)
        if not self._window.is_running() or not self._window.watched:
            return
        self._window.sync()
        time_shown, at = self._shown
        ahead = float(self.data.time) - time_shown - (time.monotonic() - at)
        if 0 < ahead < 1:  # otherwise an episode has begun, or the page was just opened
            time.sleep(ahead)
        self._shown = (float(self.data.time), time.monotonic())

    def close(self) -> None:
        """Closes the page, if there is one."""
        if self._window is not None:
            self._window.close()


def __getattr__(name: str) -> NoReturn:
    raise AttributeError(
        f"gymnasium.envs.mujoco.mujoco_rendering.{name}: pictures are drawn without OpenGL here, by {' and '.join(__all__)} alone"
    )
