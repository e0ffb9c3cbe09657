"""Pictures and videos: ``babybench.utils``."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native

from .utils import body_pos_to_world, get_body_id, get_child_bodies

Image = NDArray[np.uint8]

_LEAST = 1e-7
"""Least force of a sensor that is drawn as touched, N."""

_HALF_WIDTH = 0.75
"""Half width of what the picture of touch shows, m."""

_CROP = (slice(160, 400), slice(195, 435))
"""The part of a plot of 600 by 600 pixels that is shown."""


def render(env: Any, camera: str = "corner") -> Image:
    """Draws the scene from a camera, (render_size, render_size, 3), red, green and blue."""
    picture = env.unwrapped.mujoco_renderer.render(render_mode="rgb_array", camera_name=camera)
    return np.asarray(picture, dtype=np.uint8)


def to_grayscale(x: NDArray[Any]) -> NDArray[np.float64]:
    """Returns the brightness of each pixel of a picture (height, width, 3), in the picture's own range."""
    weighted: NDArray[np.float64] = 0.2989 * x[:, :, 0] + 0.5870 * x[:, :, 1] + 0.1140 * x[:, :, 2]
    return weighted


def view_binocular(env: Any) -> NDArray[np.float64]:
    """Draws what both eyes see as an anaglyph, (240, 240, 3): the left eye red, the right one green and blue."""
    left, right = (to_grayscale(render(env, eye)[::2, ::2]) for eye in ("eye_left", "eye_right"))
    return np.stack([left, right, right], axis=2)


def _panel(env: Any, view: str) -> NDArray[Any] | None:
    """Draws a quarter of an evaluation picture, (240, 240, 3)."""
    if view in ("top", "side1", "side2", "closeup"):
        return render(env, view)[::2, ::2]
    if view == "binocular":
        return view_binocular(env)
    if view == "touches_with_hands":
        return view_touches(env, contact_with="hands")
    return None


def evaluation_img(env: Any, up: str = "side2", down: str = "top") -> Image:
    """Draws a frame of an evaluation's video, (480, 720, 3): the room, and two small pictures next to it.

    Args:
        env: The environment; its ``render_size`` is 480.
        up: The upper small picture: a camera (``top``, ``side1``, ``side2``, ``closeup``), ``binocular`` or
            ``touches_with_hands``; anything else leaves it black.
        down: The lower small picture, likewise.

    Raises:
        ValueError: ``render_size`` is not 480.
    """
    room = render(env, "corner")
    if room.shape != (480, 480, 3):
        raise ValueError(f"evaluation pictures need render_size: 480, but it is {room.shape[0]}")
    img = np.zeros((480, 720, 3), dtype=np.uint8)
    img[:, :480] = room
    for view, rows in ((down, slice(240, 480)), (up, slice(0, 240))):
        panel = _panel(env, view)
        if panel is not None:
            img[rows, 480:] = panel.astype(np.uint8)
    return img


def evaluation_video(
    images: Iterable[NDArray[Any]],
    save_name: str | os.PathLike[str] | None = None,
    frame_rate: float = 60,
    resolution: tuple[int, int] = (720, 480),
) -> None:
    """Writes a video, with OpenCV where it is installed and as motion JPEG by this library where it is not.

    Args:
        images: Frames, (height, width, 3) bytes, red, green and blue. Those of another size are left out, as OpenCV does.
        save_name: The file, usually ``.avi``.
        frame_rate: Frames per second.
        resolution: Width and height, pixels.
    """
    if save_name is None:
        raise TypeError("evaluation_video needs save_name, the file to write")
    width, height = resolution
    frames = (np.ascontiguousarray(image, dtype=np.uint8) for image in images)
    fitting = (frame for frame in frames if frame.shape == (height, width, 3))
    try:
        import cv2  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        _native.write_video(os.fspath(save_name), list(fitting), float(frame_rate), width, height)
        return
    codec = cv2.VideoWriter_fourcc(*"mp4v")
    video = cv2.VideoWriter(os.fspath(save_name), codec, frame_rate, (width, height))
    for frame in fitting:
        video.write(cv2.cvtColor(frame, cv2.COLOR_RGB2BGR))
    video.release()


def _felt(env: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the positions of all sensors, (n, 3), m, and the forces that they feel, (n,), N."""
    root = get_body_id(env.model, body_name="mimo_location")
    points, forces = [], []
    for body in get_child_bodies(env.model, root):
        if body in env.touch.sensor_positions and body in env.touch.sensor_outputs:
            points.append(body_pos_to_world(env.data, env.touch.sensor_positions[body], body))
            forces.append(np.linalg.norm(env.touch.sensor_outputs[body], axis=-1))
    return np.concatenate(points), np.concatenate(forces)


def _hand_contacts(env: Any) -> NDArray[np.float64]:
    """Returns the points at which the palms touch MIMo, (n, 3), world, m."""
    contacts = env.data.contact
    hands, own = [*env.right_hand_geoms, *env.left_hand_geoms], env.mimo_geoms
    first, second = np.asarray(contacts.geom1), np.asarray(contacts.geom2)
    touching = (np.isin(first, hands) & np.isin(second, own)) | (np.isin(second, hands) & np.isin(first, own))
    return np.asarray(contacts.pos).reshape(-1, 3)[touching]


def view_touches(env: Any, focus_body: str | None = "hip", contact_with: str | None = None) -> Image:
    """Plots MIMo's skin from above, (240, 240, 3): sensors that feel something red, the others grey.

    Args:
        env: The environment.
        focus_body: The body in the middle; without one, the origin.
        contact_with: ``hands`` marks where the palms touch MIMo in yellow, at their place in the room.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    env = env.unwrapped
    points, forces = _felt(env)
    points = points - (env.data.body(focus_body).xpos if focus_body else 0.0)
    on = forces > _LEAST
    figure = Figure(figsize=(6, 6), dpi=100)
    canvas = FigureCanvasAgg(figure)
    axes: Any = figure.add_subplot(111, projection="3d")
    axes.view_init(elev=90, azim=0, roll=0)
    axes.scatter(*points[~on].T, color="k", s=10, depthshade=False, alpha=0.15)
    if on.any():
        strength = forces[on] / forces[on].max()
        colors = np.tile([1.0, 0.0, 0.0, 0.0], (len(strength), 1))
        colors[:, 3] = 0.4 + 0.1 * strength
        axes.scatter(*points[on].T, color=colors, s=5 + 5 * strength, depthshade=False)
    for limits in (axes.set_xlim, axes.set_ylim, axes.set_zlim):
        limits([-_HALF_WIDTH, _HALF_WIDTH])
    axes.set_axis_off()
    if contact_with == "hands":
        for point in _hand_contacts(env):
            axes.scatter(*point, color="y", s=20, depthshade=True, alpha=0.8)
    canvas.draw()  # type: ignore[no-untyped-call]
    picture = np.asarray(canvas.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]
    return np.ascontiguousarray(picture[_CROP])
