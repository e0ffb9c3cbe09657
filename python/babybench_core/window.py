"""A window, made with pygame: an environment in real time, with a camera that turns and a spring that pulls."""

from __future__ import annotations

import math
import time
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from babybench_core import _native
from babybench_core.orbit import Orbit
from babybench_core.senses import Touch
from babybench_core.spring import Spring

HELP = (
    "drag: turn, or pull a body",
    "right button: shift   wheel: nearer",
    "space: pause   right: one step",
    "up, down: speed   home: camera",
    "c: contacts   t: touch   h: help",
)
"""The effect of keys and the pointer, as the window shows it."""

_FPS = 60
_SPEEDS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)
_REAL_TIME = _SPEEDS.index(1.0)


def _pygame() -> Any:
    try:
        import pygame
    except ImportError as error:
        from gymnasium.error import DependencyNotInstalled

        raise DependencyNotInstalled('render_mode="human" needs pygame: pip install pygame') from error
    return pygame


class Window:
    """A window that shows an environment while it steps, at its own pace or as fast as it can.

    Attributes:
        open: Whether the window is still open. A closed window shows nothing, and steps are as fast as without it.
        paused: Whether time is paused: :meth:`show` then returns only when the user requests a step, continues, or closes it.
        contacts, touch, help: What is drawn over the picture.
    """

    def __init__(self, title: str, core: _native.Env, size: tuple[int, int], camera: Optional[str] = None) -> None:
        """Opens a window of a size in pixels; without the name of a camera, users steer it from the start."""
        self._pg = _pygame()
        self._core, self._size, self._camera = core, size, camera
        self._pg.display.init()
        self._pg.font.init()
        self._pg.display.set_caption(title)
        self._screen = self._pg.display.set_mode(size)
        self._font = self._pg.font.Font(None, 20)
        self._touch: Optional[Touch] = None
        self.spring = Spring(core)
        self.orbit = self._start()
        self.open, self.paused, self.contacts, self.touch, self.help = True, False, False, False, False
        self._speed, self._single = _REAL_TIME, False
        self._depth = 1.0
        self._drawn, self._due = -math.inf, time.perf_counter()  # nothing has been drawn

    def _start(self) -> Orbit:
        bodies = self._core.blueprint.model_names["body"]
        orbit = Orbit()
        if "hip" in bodies:
            orbit.lookat = np.array(self._core.state_array("xpos")[bodies.index("hip")])
        return orbit

    @property
    def speed(self) -> float:
        """Simulated seconds per second."""
        return _SPEEDS[self._speed]

    # --- time ---

    def show(self, seconds: float) -> None:
        """Shows the environment after a step of this many simulated seconds, and waits until it is time for the next."""
        self._listen()
        while self.open and self.paused and not self._single:
            self._draw()
            time.sleep(1 / _FPS)
            self._due = time.perf_counter()
            self._listen()
        self._single = False
        if not self.open:
            return
        now = time.perf_counter()
        # lost time is not made up: the window would race
        self._due = max(self._due + seconds / self.speed, now - 0.1)
        if now - self._drawn >= 1 / _FPS:
            self._draw()
        while self.open and (wait := self._due - time.perf_counter()) > 0.001:
            time.sleep(min(wait, 1 / _FPS))
            self._listen()
        self.spring.pull(seconds)

    def close(self) -> None:
        """Closes the window."""
        if self.open:
            self.open = False
            self.spring.let_go()
            self._pg.display.quit()

    # --- input ---

    def _listen(self) -> None:
        if not self.open:
            return
        pg = self._pg
        for event in pg.event.get():
            if event.type == pg.QUIT or (event.type == pg.KEYDOWN and event.key == pg.K_ESCAPE):
                self.close()
                return
            if event.type == pg.KEYDOWN:
                self._press(event.key)
            elif event.type == pg.MOUSEWHEEL:
                self._steer().zoom(0.9**event.y)
            elif event.type == pg.MOUSEBUTTONDOWN and event.button == 1:
                self._grab(*event.pos)
            elif event.type == pg.MOUSEBUTTONUP and event.button == 1:
                self.spring.let_go()
            elif event.type == pg.MOUSEMOTION:
                self._drag(event)

    def _press(self, key: int) -> None:
        pg = self._pg
        if key == pg.K_SPACE:
            self.paused = not self.paused
        elif key == pg.K_RIGHT:
            self.paused = self._single = True
        elif key in (pg.K_UP, pg.K_DOWN):
            faster = 1 if key == pg.K_UP else -1
            self._speed = min(max(self._speed + faster, 0), len(_SPEEDS) - 1)
        elif key == pg.K_HOME:
            self._camera, self.orbit = None, self._start()
        elif key == pg.K_c:
            self.contacts = not self.contacts
        elif key == pg.K_t:
            self.touch = not self.touch
        elif key == pg.K_h:
            self.help = not self.help

    def _steer(self) -> Orbit:
        """Returns the camera that users steer, and switches the view to it."""
        self._camera = None
        return self.orbit

    def _grab(self, x: int, y: int) -> None:
        """Grabs the body under the pointer, if one can be moved."""
        if self._camera is not None:
            return
        camera = self.orbit.camera
        geom = int(self._core.segmentation(camera, *self._size)[y, x])
        if geom < 0:
            return
        body = int(self._core.model_array("geom_bodyid")[geom])
        if self._core.model_array("body_weldid")[body] == 0:
            return  # it cannot move
        self._depth = float(self._core.depth(camera, *self._size)[y, x])
        self.spring.hold(body, self.orbit.place(x, y, self._depth, self._size))

    def _drag(self, event: Any) -> None:
        left, _, right = event.buttons
        across, down = event.rel
        if left and self.spring.holds:
            x, y = event.pos
            self.spring.target = self.orbit.place(x, y, self._depth, self._size)
        elif left:
            self._steer().turn(across * 0.4, down * 0.4)
        elif right:
            self._steer().shift(across / self._size[1], down / self._size[1])

    # --- output ---

    def picture(self) -> npt.NDArray[np.uint8]:
        """Returns the contents of the window, (height, width, 3)."""
        shown: npt.NDArray[np.uint8] = self._pg.surfarray.array3d(self._screen).swapaxes(0, 1)
        return shown

    def _draw(self) -> None:
        if not self.open:
            return
        pg = self._pg
        self._drawn = time.perf_counter()
        image = self._core.render(self._camera or self.orbit.camera, *self._size)
        self._screen.blit(pg.surfarray.make_surface(image.swapaxes(0, 1)), (0, 0))
        if self._camera is None:
            self._draw_over()
        self._draw_text()
        pg.display.flip()

    def _draw_over(self) -> None:
        """Draws forces over the picture: red where skin is touched, yellow along contacts, green for the spring."""
        pg, screen, orbit, size = self._pg, self._screen, self.orbit, self._size
        if self.touch:
            for x, y in orbit.pixels(self._touched(), size):
                pg.draw.circle(screen, (230, 40, 40), (int(x), int(y)), 2)
        if self.contacts:
            contacts = self._core.contacts()
            starts = contacts["pos"]
            normals = contacts["frame"].reshape(-1, 9)[:, :3]
            ends = starts + normals * np.clip(contacts["force"][:, :1] * 0.005, 0.01, 0.5)
            for start, end in zip(starts, ends):
                line = orbit.pixels(np.stack([start, end]), size)
                if len(line) == 2:
                    pg.draw.line(screen, (240, 200, 40), line[0].tolist(), line[1].tolist(), 2)
        if self.spring.holds:
            line = orbit.pixels(np.stack([self.spring.at, self.spring.target]), size)
            if len(line) == 2:
                pg.draw.line(screen, (60, 200, 90), line[0].tolist(), line[1].tolist(), 2)

    def _touched(self) -> npt.NDArray[np.float64]:
        """Returns where the skin is touched, (K, 3), m."""
        if not self._core.touch_width:
            return np.zeros((0, 3))
        self._touch = self._touch or Touch(self._core)
        sensors, forces = self._touch.sparse()
        felt: npt.NDArray[np.float64] = self._touch.world_positions()[sensors[np.abs(forces).max(axis=1) > 0]]
        return felt

    def _draw_text(self) -> None:
        lines = [f"{self._core.time:.2f} s" + (", paused" if self.paused else "")]
        if self._speed != _REAL_TIME:
            lines[0] += f", {self.speed:g} times"
        lines += HELP if self.help else ("h: help",)
        for row, line in enumerate(lines):
            self._screen.blit(self._font.render(line, True, (20, 20, 20), (235, 235, 235)), (6, 6 + 20 * row))
