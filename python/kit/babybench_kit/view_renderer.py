"""``mujoco.Renderer`` of the model of an environment."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core.mujoco.enums import mjtCamera
from babybench_core.mujoco.renderer import MjvCamera, finished


class ViewRenderer:
    """Draws the scene of an environment, as MuJoCo's ``Renderer`` does, without shadows and reflections.

    Attributes:
        model: ``env.model``.
        height, width: Size of pictures, pixels.
    """

    def __init__(self, model: Any, height: int, width: int) -> None:
        """Creates a renderer for pictures of a size, pixels."""
        self.model, self.height, self.width = model, height, width
        self._data: Any = None
        self._camera: Any = None
        self._what = "rgb"

    def update_scene(self, data: Any, camera: int | str | MjvCamera = -1, scene_option: Any = None) -> None:
        """Takes ``env.data`` and the camera of the next picture.

        Args:
            data: The state; it is drawn as it is when :meth:`render` is called.
            camera: A camera of the model, by number or name, a free or tracking ``MjvCamera``, or -1 for one that sees all.
            scene_option: Must be ``None``: the environment's own settings apply.

        Raises:
            ValueError: The model has no such camera, or the state is that of another environment.
        """
        if getattr(data, "model", None) is not self.model:
            raise ValueError(
                "the state belongs to another model: give it env.data of the environment whose env.model this is"
            )
        if scene_option is not None:
            raise ValueError(
                "scene_option: write env.model.geom_group, or make a model of your own with babybench.mujoco"
            )
        self._data, self._camera = data, self._place(data, camera)

    def _place(self, data: Any, camera: int | str | MjvCamera) -> Any:
        """Returns the camera as the engine takes it."""
        names = self.model._names["camera"]
        if isinstance(camera, MjvCamera):
            if camera.type == mjtCamera.mjCAMERA_FIXED:
                camera = int(camera.fixedcamid)
            else:
                tracks = camera.type == mjtCamera.mjCAMERA_TRACKING
                lookat = data.subtree_com[camera.trackbodyid] if tracks else camera.lookat
                turned = float(camera.azimuth), float(camera.elevation)
                return np.asarray(lookat, np.float64).tolist(), float(camera.distance), *turned
        if isinstance(camera, str):
            if camera not in names:
                raise ValueError(f'The camera "{camera}" does not exist.')
            return camera
        if not -1 <= camera < len(names):
            raise ValueError(f"The camera id {camera} is out of range [-1, {len(names)}).")
        if camera >= 0:
            return names[camera]
        view, size = self.model.vis.global_, self.model.stat
        return np.array(size.center).tolist(), 1.5 * size.extent, float(view.azimuth), float(view.elevation)

    def enable_depth_rendering(self) -> None:
        """Draws distances from the camera's plane from now on."""
        self._what = "depth"

    def enable_segmentation_rendering(self) -> None:
        """Draws ids and kinds of elements from now on."""
        self._what = "segmentation"

    def disable_depth_rendering(self) -> None:
        """Draws colours from now on."""
        self._what = "rgb"

    disable_segmentation_rendering = disable_depth_rendering

    def render(self, *, out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Draws the picture, as ``babybench.mujoco.Renderer.render`` does."""
        if self._data is None:
            raise RuntimeError("call update_scene(env.data) before render()")
        sync = self._data._sync
        sync.core.pull()
        engine = sync.core.engine
        draw = {"rgb": engine.render, "depth": engine.depth, "segmentation": engine.segmentation}[self._what]
        picture: NDArray[Any] = draw(self._camera, self.width, self.height)
        return finished(picture, self._what, out, self.model.ngeom)

    def close(self) -> None:
        """Releases the picture's state; :meth:`update_scene` takes another."""
        self._data = None

    def __enter__(self) -> ViewRenderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
