"""The window for people, on a screen that is not there."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core.orbit import Orbit
from babybench_core.window import Window

pygame = pytest.importorskip("pygame", reason="render_mode human needs pygame")
SIZE = (160, 120)
LATE = 0.12
"""How much a window catches up with at most, s: the tenth that it may be late, and what waits leave."""


@pytest.fixture(autouse=True)
def _no_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


@pytest.fixture
def shown() -> Any:
    """An environment and its window."""
    env = babybench.Env({**SMALL, "scene": "base", "touch_active": True})  # nothing holds MIMo
    env.reset(seed=0)
    window = Window("test", env._core, SIZE)
    yield env, window
    window.close()
    env.close()


def step(env: Any, window: Window, count: int = 1) -> None:
    for _ in range(count):
        env.step(np.zeros(env.action_space.shape, np.float32))
        window.show(env.dt)


def do(window: Window, kind: int, **what: Any) -> None:
    """Does something with keys or the pointer."""
    pygame.event.post(pygame.event.Event(kind, what))
    window._listen()


def press(window: Window, key: int) -> None:
    do(window, pygame.KEYDOWN, key=key)


def test_an_environment_for_people_opens_a_window_that_can_be_closed() -> None:
    env = babybench.Env({**SMALL, "render_size": 64}, render_mode="human")
    env.reset(seed=0)
    action = env.action_space.sample()
    env.step(action)
    window = env._window
    assert window is not None
    assert window.picture().shape == (64, 64, 3)
    assert len(np.unique(window.picture())) > 20
    assert env.render() is None
    do(window, pygame.QUIT)
    assert not window.open
    started = time.perf_counter()
    for _ in range(50):
        env.step(action)
    assert time.perf_counter() - started < 50 * env.dt * 20, "a closed window does not hold steps"
    env.close()


def test_time_passes_as_fast_as_it_is_told_and_stands_while_paused(shown: Any) -> None:
    env, window = shown
    step(env, window, 5)
    started = time.perf_counter()
    step(env, window, 120)
    assert time.perf_counter() - started > 120 * env.dt - LATE
    for _ in range(3):
        press(window, pygame.K_DOWN)
    assert window.speed == 0.1
    started = time.perf_counter()
    step(env, window, 8)
    assert time.perf_counter() - started > 8 * env.dt / 0.1 - LATE
    press(window, pygame.K_SPACE)
    assert window.paused
    # one step at a time
    press(window, pygame.K_RIGHT)
    step(env, window)
    pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_SPACE))
    step(env, window)
    assert not window.paused
    press(window, pygame.K_SPACE)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    step(env, window)
    assert not window.open, "it can be closed while time stands"


def test_the_camera_turns_shifts_and_goes_nearer(shown: Any) -> None:
    env, window = shown
    step(env, window)
    seen = [window.picture().copy()]
    buttons = {"left": (1, 0, 0), "right": (0, 0, 1)}
    for change in (
        lambda: do(window, pygame.MOUSEMOTION, pos=(50, 50), rel=(30, 5), buttons=buttons["left"]),
        lambda: do(window, pygame.MOUSEMOTION, pos=(50, 50), rel=(10, 10), buttons=buttons["right"]),
        lambda: do(window, pygame.MOUSEWHEEL, y=3),
        lambda: press(window, pygame.K_c),
        lambda: press(window, pygame.K_t),
        lambda: press(window, pygame.K_h),
    ):
        change()
        window._draw()
        assert not np.array_equal(window.picture(), seen[-1])
        seen.append(window.picture().copy())
    press(window, pygame.K_HOME)
    assert window.orbit.azimuth == 135
    assert window.orbit.elevation == -25


def test_the_pointer_pulls_a_body_and_lets_it_go(shown: Any) -> None:
    env, window = shown
    step(env, window)
    centre = (SIZE[0] // 2, SIZE[1] // 2)
    do(window, pygame.MOUSEBUTTONDOWN, button=1, pos=centre)
    assert window.spring.holds, "MIMo is in the middle"
    np.testing.assert_allclose(window.spring.at, window.spring.target, atol=1e-9)
    before = env.array("qpos")[2]
    do(window, pygame.MOUSEMOTION, pos=(centre[0], centre[1] - 40), rel=(0, -40), buttons=(1, 0, 0))
    assert window.orbit.azimuth == 135, "the camera stays"
    press(window, pygame.K_UP)
    step(env, window, 60)
    assert env.array("qpos")[2] > before + 0.02
    assert np.any(env.array("xfrc_applied"))
    do(window, pygame.MOUSEBUTTONUP, button=1, pos=centre)
    assert not window.spring.holds
    assert not np.any(env.array("xfrc_applied"))


def test_points_of_the_world_are_where_the_picture_shows_them(shown: Any) -> None:
    env, _ = shown
    orbit = Orbit(lookat=np.array([0.0, 0.0, 0.2]), azimuth=70.0, elevation=-40.0)
    depth = env._core.depth(orbit.camera, *SIZE)
    geoms = env._core.segmentation(orbit.camera, *SIZE)
    place = orbit.place(81, 62, float(depth[62, 81]), SIZE)
    np.testing.assert_array_equal(orbit.pixels(place[None], SIZE), [[81, 62]])
    # the centre of a ball of the skin is where its geom is drawn
    spheres = [g for g in np.unique(geoms[geoms >= 0]) if env.array("geom_type")[g] == 2]
    assert spheres
    hits = sum(
        g in geoms[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2]
        for g in spheres
        for x, y in orbit.pixels(env.array("geom_xpos")[g][None], SIZE)
    )
    assert hits >= len(spheres) / 2
    assert orbit.pixels(np.array([[0.0, 0.0, 500.0]]), SIZE).shape[1] == 2
