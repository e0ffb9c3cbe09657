"""A page that stands in for the window of ``mujoco.viewer``, for any model."""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Iterator
from typing import Any, Callable, Optional

import numpy as np

from .. import _native
from .data import MjData
from .enums import mjtCamera
from .model import MjModel
from .page_server import PageServer
from .renderer import MjvCamera, draw, mjv_defaultFreeCamera
from .scene import MjvScene
from .scene_option import MjvOption, shown

__all__ = ["Window"]

MARKERS = 10000
"""Geoms that a program may add to the picture."""


class Window:
    """A page that shows a state while a program steps it: MuJoCo's handle of a passive viewer.

    Attributes:
        url: The address of the page, on this machine alone, with a secret token. From another machine, forward its port:
            ``ssh -L PORT:127.0.0.1:PORT``.
        cam: The camera, which the page's users turn; programs may set it, too.
        opt: Which groups of geoms, sites, tendons and skins are shown.
        user_scn: Geoms that the program adds to the picture, or ``None`` after :meth:`close`.
    """

    def __init__(
        self,
        model: MjModel,
        data: MjData,
        key_callback: Optional[Callable[[int], None]] = None,
        *,
        controls: bool = False,
        port: int = 0,
    ) -> None:
        """Opens the page and prints its address."""
        self._model, self._data, self._key_callback = model, data, key_callback
        self.cam, self.opt = MjvCamera(), MjvOption()
        mjv_defaultFreeCamera(model, self.cam)
        self.user_scn: Optional[MjvScene] = MjvScene(model, MARKERS)
        self._natives: dict[Any, _native.PhysicsRenderer] = {}
        self._lock = threading.RLock()
        cameras = [name or f"camera {number}" for number, name in enumerate(model._names["camera"])]
        self._page: Optional[PageServer] = PageServer(model._model_name, controls, cameras, port)
        self.url = self._page.url
        self.commands: list[dict[str, Any]] = []
        self.status: dict[str, Any] = {}
        print(f"mujoco.viewer: {self.url}")

    @property
    def m(self) -> Optional[MjModel]:
        """The model that is shown, or ``None`` after :meth:`close`."""
        return self._model if self._page else None

    @property
    def d(self) -> Optional[MjData]:
        """The state that is shown, or ``None`` after :meth:`close`."""
        return self._data if self._page else None

    def is_running(self) -> bool:
        """Returns whether the page is there: until :meth:`close`, until users close it, or until the last browser has left it."""
        if self._page is not None and self._page.left:
            self.close()
        return self._page is not None

    @property
    def watched(self) -> bool:
        """Whether a browser shows the page."""
        return self._page is not None and self._page.watched

    def sync(self) -> None:
        """Shows the state of this moment and carries out what users have done, if a browser shows the page."""
        if self._page is None:
            return
        with self._lock:
            for event in self._page.events():
                self._carry_out(event)
            if self._page is None:
                return
            size = self._page.wanted()
            if size is not None:
                visible = shown(self._model, self.opt)
                if visible not in self._natives:
                    self._natives[visible] = _native.PhysicsRenderer(self._model._own, visible)
                picture = draw(self._natives[visible], self._data, self.cam, size, "rgb", self.user_scn)
                self._page.deliver(picture, {"time": float(self._data.time), **self.status})

    def close(self) -> None:
        """Closes the page."""
        page, self._page = self._page, None
        self.user_scn = None
        if page is not None:
            page.close()

    @contextlib.contextmanager
    def lock(self) -> Iterator[None]:
        """Keeps :meth:`sync` of other threads away."""
        with self._lock:
            yield

    def _carry_out(self, event: dict[str, Any]) -> None:
        """Does what a user has requested; what a page of ours does not send is left out."""
        kind = event.get("kind")
        if kind == "close":
            self.close()
        elif kind == "key" and isinstance(event.get("code"), int):
            if self._key_callback is not None:
                self._key_callback(event["code"])
        elif kind == "camera" and isinstance(event.get("number"), int):
            self.choose(event["number"])
        elif kind in ("turn", "move", "zoom"):
            by = [event.get(axis, 0.0) for axis in ("x", "y")]
            if all(isinstance(part, (int, float)) and abs(part) < 100 for part in by):  # NaN is not, either
                self._steer(kind, float(by[0]), float(by[1]))
        elif kind in ("pause", "step", "restart", "speed"):
            self.commands.append(event)

    def choose(self, number: int) -> None:
        """Looks through a camera of the model, or freely for -1."""
        if number < 0:
            mjv_defaultFreeCamera(self._model, self.cam)
        elif number < self._model.ncam:
            self.cam.type, self.cam.fixedcamid = int(mjtCamera.mjCAMERA_FIXED), number

    def _steer(self, kind: str, x: float, y: float) -> None:
        """Moves a camera that is not one of the model, by fractions of the picture's height to the right and down."""
        cam = self.cam
        if cam.type == mjtCamera.mjCAMERA_FIXED:
            return
        if kind == "turn":
            cam.azimuth -= 180 * x
            cam.elevation = min(max(cam.elevation - 180 * y, -90.0), 90.0)
        elif kind == "zoom":
            least = 1e-3 * self._model.stat.extent
            cam.distance = max(least, cam.distance * math.exp(min(max(2 * y, -5.0), 5.0)))
        elif cam.type == mjtCamera.mjCAMERA_FREE:
            azimuth, elevation = np.radians([cam.azimuth, cam.elevation])
            right = np.array([np.sin(azimuth), -np.cos(azimuth), 0])
            up = np.array(
                [-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)]
            )
            height = 2 * cam.distance * math.tan(math.radians(self._model.vis.global_.fovy) / 2)
            cam.lookat += height * (y * up - x * right)

    def __enter__(self) -> Window:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(
            f"{name}: the page that stands in for MuJoCo's window has no such setting; install mujoco (pip install mujoco) for "
            "MuJoCo's own viewer"
        )


def run(window: Window, step: Callable[[], None], restart: Callable[[], None]) -> None:
    """Steps a state in real time until its page is closed; users pause it, make single steps, choose the speed and restart it."""
    paused, speed = False, 1.0
    due = time.monotonic()
    while window.is_running():
        window.sync()
        commands, window.commands = window.commands, []
        for command in commands:
            kind = command["kind"]
            if kind == "pause":
                paused = not paused
            elif kind == "step":
                paused = True
                step()
            elif kind == "restart":
                restart()
            elif isinstance(command.get("factor"), (int, float)) and 0 < command["factor"] <= 100:
                speed = float(command["factor"])
        window.status = {"paused": paused, "speed": speed}
        now, timestep = time.monotonic(), window._model.opt.timestep / speed
        if paused or now - due > 0.1:  # what is late is not made up for
            due = now
        if not paused and due <= now:
            # several steps for a picture, so that short time steps keep up
            until = now + 1 / 60
            while due <= now and time.monotonic() < until:
                step()
                due += timestep
        else:
            time.sleep(min(1 / 120, max(0.0, due - now)) or 1 / 120)
