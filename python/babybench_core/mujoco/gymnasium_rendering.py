"""Replaces ``gymnasium.envs.mujoco.mujoco_rendering``: pictures of Gymnasium's environments without OpenGL."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .data import MjData
from .enums import mjtCamera
from .model import MjModel
from .renderer import MjvCamera, draw

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
    """Draws the environments of Gymnasium that MuJoCo runs, with its arguments and results; there is no window."""

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

        Raises:
            NotImplementedError: ``human``: there is no window.
        """
        if render_mode == "human":
            raise NotImplementedError(
                "render_mode human: there is no window here. Show pictures of render_mode='rgb_array' with matplotlib or pygame "
                "(gymnasium.wrappers.HumanRendering)"
            )
        if render_mode not in _MODES:
            raise AttributeError(f"Unexpected mode: {render_mode}, expected modes: {', '.join(_MODES)}")
        if self.viewer is None:
            self.viewer = OffScreenViewer(self.model, self.data, self.width, self.height)
            for key, value in (self.default_cam_config or {}).items():
                if isinstance(value, np.ndarray):
                    getattr(self.viewer.cam, key)[:] = value
                else:
                    setattr(self.viewer.cam, key, value)
        chosen = self.camera_id
        if camera_id is not None or camera_name is not None:
            chosen = self._camera(camera_id, camera_name)
        return self.viewer.render(render_mode, chosen)

    def close(self) -> None:
        """Has no effect, because there is no window and no context."""


def __getattr__(name: str) -> NoReturn:
    raise AttributeError(
        f"gymnasium.envs.mujoco.mujoco_rendering.{name}: pictures are drawn without OpenGL here, by {' and '.join(__all__)} alone"
    )
