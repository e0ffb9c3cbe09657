"""The page that stands in for MuJoCo's window: what a browser asks of it, and what a program sees of its users."""

from __future__ import annotations

import json
import threading
import time
import urllib.error
import urllib.request
import zlib
from collections.abc import Callable, Iterator
from typing import Any, Optional

import numpy as np
import pytest

from babybench import mujoco
from babybench_core.mujoco import gymnasium_rendering
from babybench_core.mujoco import viewer as mujoco_viewer
from babybench_core.mujoco.window import Window

SCENE = """<mujoco model="ball"><visual><global azimuth="120" elevation="-30"/></visual><worldbody><light pos="0 0 3"/>
<camera name="side" pos="0 -2 .5" xyaxes="1 0 0 0 .2 1"/><geom type="plane" size="1 1 .1"/>
<body pos="0 0 .5"><freejoint/><geom size=".1" rgba="1 0 0 1"/><geom size=".1" pos=".2 0 0" rgba="0 1 0 1" group="3"/></body>
</worldbody></mujoco>"""


class Browser:
    """Asks for pictures in another thread, as a page does, while the program syncs."""

    def __init__(self, window: Window) -> None:
        self.window = window

    def ask(self, place: str, body: Optional[bytes] = None, **headers: str) -> tuple[int, bytes, Any]:
        """Returns status, body and headers of an answer. Like the page, it retries until there is a new picture."""
        while place.startswith("picture"):
            found = self._ask_once(place, body, **headers)
            if found[0] != 204:
                return found
        return self._ask_once(place, body, **headers)

    def _ask_once(self, place: str, body: Optional[bytes], **headers: str) -> tuple[int, bytes, Any]:
        request = urllib.request.Request(self.window.url + place, data=body, headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=10) as answer:
                return answer.status, answer.read(), answer.headers
        except urllib.error.HTTPError as error:
            return error.code, error.read(), error.headers

    def while_synced(self, ask: Callable[[], Any]) -> Any:
        """Returns what a request answers while the program syncs."""
        found: list[Any] = []
        thread = threading.Thread(target=lambda: found.append(ask()))
        thread.start()
        while thread.is_alive():
            self.window.sync()
            time.sleep(0.002)
        return found[0]

    def picture(self, width: int = 64, height: int = 48) -> tuple[np.ndarray[Any, Any], dict[str, Any]]:
        """Returns a picture and what the page says beside it."""
        status, body, headers = self.while_synced(lambda: self.ask(f"picture?width={width}&height={height}"))
        assert status == 200
        return np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, width, 3), json.loads(headers["X-Status"])

    def do(self, *events: Any) -> int:
        """Sends what a user does and returns the status; the program takes it."""
        status = self.ask("events", json.dumps(events).encode())[0]
        self.window.sync()
        return status


@pytest.fixture
def shown(capsys: pytest.CaptureFixture[str]) -> Iterator[tuple[Window, Browser]]:
    """Returns a page of a ball, and a browser."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    with mujoco.viewer.launch_passive(model, data, show_left_ui=False) as window:
        assert isinstance(window, Window)
        assert window.url in capsys.readouterr().out
        yield window, Browser(window)
    assert not window.is_running()


def test_a_page_shows_what_the_renderer_draws(shown: tuple[Window, Browser]) -> None:
    """Pictures are those of ``Renderer`` from the same camera, and follow state, groups, markers and camera."""
    window, browser = shown
    model, data = window.m, window.d
    picture, status = browser.picture()
    assert status == {"width": 64, "height": 48, "time": 0.0}
    with mujoco.Renderer(model, 48, 64) as renderer:
        renderer.update_scene(data, window.cam)
        assert np.array_equal(picture, renderer.render())
    mujoco.mj_step(model, data, nstep=100)
    moved, status = browser.picture()
    assert status["time"] == pytest.approx(0.2)
    assert not np.array_equal(moved, picture)
    window.opt.geomgroup[3] = 1
    both = browser.picture()[0]
    assert not np.array_equal(both, moved)
    assert window.user_scn is not None
    marker = window.user_scn.geoms[0]
    mujoco.mjv_initGeom(marker, mujoco.mjtGeom.mjGEOM_SPHERE, [0.2, 0, 0], [0, 0, 0.3], np.eye(3).ravel(), [0, 0, 1, 1])
    window.user_scn.ngeom = 1
    assert not np.array_equal(browser.picture()[0], both)


def test_users_steer_the_camera(shown: tuple[Window, Browser]) -> None:
    """Dragging turns and moves, the wheel zooms, and a list chooses one of the model's cameras."""
    window, browser = shown
    assert (window.cam.azimuth, window.cam.elevation) == (120, -30)
    before = window.cam.distance
    assert browser.do({"kind": "turn", "x": 0.5, "y": -0.1}, {"kind": "zoom", "y": -0.1}) == 204
    assert (window.cam.azimuth, window.cam.elevation) == pytest.approx((30, -12))
    assert window.cam.distance == pytest.approx(before * np.exp(-0.2))
    at = window.cam.lookat.copy()
    browser.do({"kind": "move", "x": 0.0, "y": 0.1})
    height = 2 * window.cam.distance * np.tan(np.radians(45) / 2)
    assert np.linalg.norm(window.cam.lookat - at) == pytest.approx(0.1 * height)
    assert window.cam.lookat[2] > at[2]
    browser.do({"kind": "camera", "number": 0})
    assert (window.cam.type, window.cam.fixedcamid) == (mujoco.mjtCamera.mjCAMERA_FIXED, 0)
    browser.do({"kind": "turn", "x": 0.5, "y": 0})
    assert window.cam.azimuth == pytest.approx(30)
    browser.do(
        {"kind": "camera", "number": -1},
        {"kind": "camera", "number": 7},
        {"kind": "turn", "x": "far"},
        {"kind": "turn", "x": 10**400},
        {"kind": "other"},
    )
    assert (window.cam.type, window.cam.azimuth) == (mujoco.mjtCamera.mjCAMERA_FREE, 120)


def test_keys_reach_the_program() -> None:
    """The callback of a passive viewer gets GLFW's codes, in ``sync``."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    pressed: list[int] = []
    with mujoco_viewer.launch_passive(model, mujoco.MjData(model), key_callback=pressed.append) as window:
        Browser(window).do({"kind": "key", "code": 32}, {"kind": "key", "code": 265})
    assert pressed == [32, 265]


def test_a_page_without_a_browser_draws_nothing(shown: tuple[Window, Browser]) -> None:
    """``sync`` needs no computed quantities while nobody looks."""
    window, _ = shown
    assert not window.watched
    mujoco.mj_resetData(window.m, window.d)  # a picture would be an error now
    window.sync()


def test_a_page_that_is_left_ends(shown: tuple[Window, Browser], monkeypatch: pytest.MonkeyPatch) -> None:
    """A reload keeps the viewer running. The button and leaving the page end it."""
    from babybench_core.mujoco import page_server

    window, browser = shown
    browser.do({"kind": "left"})
    browser.picture()
    monkeypatch.setattr(page_server, "GRACE", 0.0)
    assert window.is_running()
    browser.do({"kind": "left"})
    time.sleep(0.01)
    assert not window.is_running()
    assert (window.m, window.d, window.user_scn) == (None, None, None)
    window.sync()


def test_strangers_are_refused(shown: tuple[Window, Browser]) -> None:
    """Other hosts, addresses without the token, sizes and events that a page would not send."""
    window, browser = shown
    assert browser.ask("", Host="example.org")[0] == 403
    assert b"mujoco.viewer" in browser.ask("")[1]
    assert json.loads(browser.ask("start")[1]) == {"title": "ball", "controls": False, "cameras": ["side"]}
    assert browser.ask("../other/")[0] == 404
    assert browser.ask("nothing")[0] == 404
    for size in ("", "?width=0&height=3", "?width=5000&height=3", "?width=a&height=3"):
        assert browser.ask(f"picture{size}")[0] == 400
    for body in (b"", b"{}", b"[1]", b"[", b"\xff", b"[" + b" " * 70000 + b"]", b"[" * 60000):
        assert browser.ask("events", body)[0] == 400
    with pytest.raises(
        AttributeError, match="perturb: the page that stands in for MuJoCo's window has no such setting"
    ):
        _ = window.perturb


def test_launch_steps_in_real_time(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """``launch`` steps until its page is closed; users pause it, make a step and start again."""
    made: list[Window] = []

    class Noted(Window):
        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            made.append(self)

    monkeypatch.setattr(mujoco_viewer, "Window", Noted)
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    thread = threading.Thread(target=lambda: mujoco_viewer.launch(loader=lambda: (model, data)))
    thread.start()
    while not made or data.time < 0.02:
        time.sleep(0.01)
    browser = Browser(made[0])

    def after(*events: Any) -> dict[str, Any]:
        browser.ask("events", json.dumps(events).encode())
        for _ in range(2):  # the first picture may be older than the events
            headers = browser.ask("picture?width=8&height=8")[2]
        status: dict[str, Any] = json.loads(headers["X-Status"])
        return status

    paused = after({"kind": "pause"})
    assert paused["paused"]
    assert after()["time"] == paused["time"]
    assert after({"kind": "step"})["time"] == pytest.approx(paused["time"] + 0.002)
    assert after({"kind": "restart"})["time"] == 0
    assert after({"kind": "speed", "factor": 2})["speed"] == 2
    assert not after({"kind": "pause"})["paused"]
    browser.ask("events", b'[{"kind": "close"}]')
    thread.join(10)
    assert not thread.is_alive()
    assert data.time > 0
    for given in ({}, {"model": model, "loader": lambda: (model, data)}):
        with pytest.raises(TypeError):
            mujoco_viewer.launch(**given)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="belongs to another model"):
        mujoco_viewer.launch_passive(mujoco.MjModel.from_xml_string(SCENE), data)


def test_gymnasium_s_human_mode_is_a_page(capsys: pytest.CaptureFixture[str]) -> None:
    """``render_mode="human"`` opens a page with the environment's camera."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = gymnasium_rendering.MujocoRenderer(model, data, {"distance": 3.0, "lookat": np.array([0.0, 0, 1])})
    assert renderer.render("human") is None
    window = renderer._window
    assert window is not None
    assert window.url in capsys.readouterr().out
    assert (window.cam.distance, *window.cam.lookat) == (3, 0, 0, 1)
    browser = Browser(window)
    status = browser.while_synced(lambda: browser.ask("picture?width=8&height=8"))[0]
    assert status == 200
    mujoco.mj_step(model, data)
    assert renderer.render("human") is None
    renderer.close()
    assert not window.is_running()
    fixed = gymnasium_rendering.MujocoRenderer(model, data, camera_name="side")
    fixed.render("human")
    assert fixed._window is not None
    assert fixed._window.cam.fixedcamid == 0
    fixed.close()
