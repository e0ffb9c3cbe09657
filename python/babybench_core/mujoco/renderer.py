"""Pictures: :class:`Renderer` and :class:`MjvCamera`, drawn without a GPU or a driver."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .data import MjData
from .enums import mjtCamera, mjtObj
from .jacobians import check
from .model import MjModel, is_compiled
from .scene import MjvScene, marker
from .scene_option import MjvOption, shown

__all__ = ["MjvCamera", "Renderer", "mjv_defaultCamera", "mjv_defaultFreeCamera"]


class MjvCamera:
    """A camera: one of the model, or a free one that looks at a point or follows a body.

    Attributes:
        type: One of ``mjtCamera``: free, tracking or fixed.
        fixedcamid: Camera of the model, if the type is fixed.
        trackbodyid: Body that a tracking camera looks at: the centre of mass of it and of all below it.
        lookat: Point that a free camera looks at, world, m.
        distance: Distance from it, m.
        azimuth: Direction of view about the vertical axis, degrees.
        elevation: Direction of view above the horizon, degrees.
    """

    __slots__ = ("azimuth", "distance", "elevation", "fixedcamid", "lookat", "trackbodyid", "type")

    def __init__(self) -> None:
        """Makes the free camera of MuJoCo."""
        self.type = int(mjtCamera.mjCAMERA_FREE)
        self.fixedcamid = self.trackbodyid = -1
        self.lookat = np.zeros(3)
        self.distance, self.azimuth, self.elevation = 2.0, 90.0, -45.0


def mjv_defaultCamera(cam: MjvCamera) -> None:
    """Sets a camera to the free one that MuJoCo starts with."""
    new = MjvCamera()
    for name in MjvCamera.__slots__:
        setattr(cam, name, getattr(new, name))


def mjv_defaultFreeCamera(m: MjModel, cam: MjvCamera) -> None:
    """Sets a camera to a free one that sees the whole model, from the direction of ``<visual><global azimuth elevation/>``."""
    mjv_defaultCamera(cam)
    view = m.vis.global_
    cam.azimuth, cam.elevation = float(view.azimuth), float(view.elevation)
    cam.lookat[:] = m.stat.center
    cam.distance = 1.5 * m.stat.extent


def draw(
    native: _native.PhysicsRenderer,
    data: MjData,
    camera: MjvCamera,
    size: tuple[int, int],
    what: str,
    scene: MjvScene | None = None,
) -> NDArray[Any]:
    """Draws what the arrays of a state show: ``rgb``, ``depth`` (m) or ``segmentation`` (ids of geoms); size is width, height.

    ``scene`` has the added geoms.
    """
    fixed: int | None = None
    lookat = camera.lookat
    if camera.type == mjtCamera.mjCAMERA_FIXED:
        fixed = int(camera.fixedcamid)
        if not 0 <= fixed < data.model.ncam:
            raise ValueError(f"camera id {fixed} is out of range [-1, {data.model.ncam}]")
    elif camera.type == mjtCamera.mjCAMERA_TRACKING:
        if not 0 <= camera.trackbodyid < data.model.nbody:
            raise ValueError(
                f"the camera cannot follow body {camera.trackbodyid}: the model has {data.model.nbody} bodies, numbered from 0"
            )
        lookat = data.subtree_com[camera.trackbodyid]
    elif camera.type != mjtCamera.mjCAMERA_FREE:
        raise ValueError(
            "a camera of the type user is placed by OpenGL's own matrices: use a free, tracking or fixed one"
        )
    if not data.xquat[0].any():
        raise ValueError("this state has no computed quantities: call mj_forward before a picture")
    free = (tuple(map(float, lookat)), float(camera.distance), float(camera.azimuth), float(camera.elevation))
    markers = [] if scene is None else [marker(geom) for geom in scene.geoms[: scene.ngeom]]
    return native.draw(data._own, (fixed, free), size, what, markers)


def finished(picture: NDArray[Any], what: str, out: NDArray[Any] | None, ngeom: int) -> NDArray[Any]:
    """Returns a picture as ``Renderer.render`` does: segmentation with the kinds of elements, in ``out`` if that is given.

    Ids from ``ngeom`` on are markers.

    Raises:
        ValueError: ``out`` has another shape.
    """
    if what == "segmentation":
        # markers are elements of no kind
        added = picture >= ngeom
        kinds = np.where(picture >= 0, np.int32(mjtObj.mjOBJ_GEOM), np.int32(-1))
        picture, kinds = np.where(added, np.int32(0), picture), np.where(added, np.int32(0), kinds)
        picture = np.stack([picture, kinds], axis=2)
    if out is None:
        return picture
    if np.shape(out) != picture.shape:
        raise ValueError(f"Expected `out.shape == {picture.shape}`. Got `out.shape={np.shape(out)}` instead.")
    out[...] = picture
    return out


class Renderer:
    """Draws states of a model, as MuJoCo's ``Renderer`` does, without shadows and reflections."""

    def __new__(cls, model: Any, height: int = 240, width: int = 320, max_geom: int = 10000) -> Any:
        """Makes a renderer of an environment if the model belongs to one."""
        of_environment = getattr(type(model), "_renderer", None)
        return object.__new__(cls) if of_environment is None else of_environment(model, int(height), int(width))

    def __init__(self, model: MjModel, height: int = 240, width: int = 320, max_geom: int = 10000) -> None:
        """Takes the size of pictures, pixels."""
        if not is_compiled(model):
            raise TypeError(
                f"Renderer needs an MjModel of babybench.mujoco, not {type(model).__module__}.{type(model).__name__}"
            )
        self._model, self._width, self._height = model, int(width), int(height)
        self._native: _native.PhysicsRenderer | None = _native.PhysicsRenderer(model._own)
        self._natives: dict[Any, _native.PhysicsRenderer] = {None: self._native}
        self._data: MjData | None = None
        self._camera = MjvCamera()
        self._what = "rgb"
        self._scene = MjvScene(model, int(max_geom))

    @property
    def scene(self) -> MjvScene:
        """Geoms that programs add to the next pictures, until the next :meth:`update_scene`."""
        return self._scene

    @property
    def model(self) -> MjModel:
        """The model that is drawn."""
        return self._model

    @property
    def height(self) -> int:
        """Height of pictures, pixels."""
        return self._height

    @property
    def width(self) -> int:
        """Width of pictures, pixels."""
        return self._width

    def update_scene(
        self, data: MjData, camera: int | str | MjvCamera = -1, scene_option: MjvOption | None = None
    ) -> None:
        """Takes the state and the camera of the next picture.

        Args:
            data: The state; it is drawn as it is when :meth:`render` is called.
            camera: A camera of the model, by number or name, a :class:`MjvCamera`, or -1 for a free one that sees all.
            scene_option: Which groups of geoms, sites, tendons and skins are shown; 0 to 2 by default.

        Raises:
            ValueError: The model has no such camera, or ``scene_option`` requests decorations that are not drawn.
        """
        check(self._model, data)
        if self._native is None:
            raise RuntimeError("update_scene cannot be called after close.")
        if scene_option is not None and not isinstance(scene_option, MjvOption):
            raise TypeError(f"scene_option is {type(scene_option).__name__}: it must be an MjvOption")
        visible = None if scene_option is None else shown(self._model, scene_option)
        if visible not in self._natives:
            self._natives[visible] = _native.PhysicsRenderer(self._model._own, visible)
        self._native = self._natives[visible]
        if isinstance(camera, MjvCamera):
            self._camera = camera
        else:
            number = camera
            if isinstance(number, str):
                names = self._model._names["camera"]
                if number not in names:
                    raise ValueError(f'The camera "{number}" does not exist.')
                number = names.index(number)
            if not -1 <= number < self._model.ncam:
                raise ValueError(f"The camera id {number} is out of range [-1, {self._model.ncam}).")
            self._camera = MjvCamera()
            mjv_defaultFreeCamera(self._model, self._camera)
            if number >= 0:
                self._camera.type, self._camera.fixedcamid = int(mjtCamera.mjCAMERA_FIXED), number
        self._data = data
        self._scene.ngeom = 0

    def enable_depth_rendering(self) -> None:
        """Draws distances from the camera's plane from now on."""
        self._what = "depth"

    def disable_depth_rendering(self) -> None:
        """Draws colours from now on."""
        self._what = "rgb"

    def enable_segmentation_rendering(self) -> None:
        """Draws ids and kinds of elements from now on."""
        self._what = "segmentation"

    def disable_segmentation_rendering(self) -> None:
        """Draws colours from now on."""
        self._what = "rgb"

    def render(self, *, out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Draws the picture, rows from the top.

        Args:
            out: The array to write into; a new one by default.

        Returns:
            Red, green and blue, (height, width, 3) bytes; or distances, (height, width), m, the far plane's where there
            is nothing; or ids and kinds (``mjtObj``), (height, width, 2), -1 where there is no geom.

        Raises:
            RuntimeError: There was no :meth:`update_scene` before, or the renderer is closed.
        """
        if self._native is None:
            raise RuntimeError("render cannot be called after close.")
        if self._data is None:
            raise RuntimeError("call update_scene(data) before render()")
        picture = draw(self._native, self._data, self._camera, (self._width, self._height), self._what, self._scene)
        if self._what == "depth":
            far = self._model.vis.map.zfar * self._model.stat.extent
            picture = np.minimum(picture, np.float32(far))
        return finished(picture, self._what, out, self._model.ngeom)

    def close(self) -> None:
        """Frees the memory; no picture can be drawn afterwards."""
        self._native = self._data = None
        self._natives = {}

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
