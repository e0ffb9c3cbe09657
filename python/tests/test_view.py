"""The page that shows an environment, as a browser asks for it."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core import notebook


def ask(view: babybench.View, words: str = "") -> tuple[dict[str, Any], bytes]:
    """Says what people do; returns what the program says and the picture.

    A program that is busy is asked again, with nothing new to do.
    """
    try:
        with urllib.request.urlopen(f"{view.url}frame", words.encode(), timeout=60) as answer:
            said, picture = answer.read().split(b"\n", 1)
    except urllib.error.HTTPError as error:
        if error.code != 503:
            raise
        error.close()
        return ask(view)
    return json.loads(said), picture


def until(view: babybench.View, fits: Any) -> dict[str, Any]:
    for _ in range(2000):
        said, _ = ask(view)
        if fits(said):
            return said
    raise AssertionError("never")


def test_an_environment_lives_on_a_page_until_it_is_given_back() -> None:
    env = babybench.Env({**SMALL, "max_episode_steps": 100_000})
    with babybench.view(gymnasium.wrappers.OrderEnforcing(env), "held", title="<MIMo>") as view:
        assert view.running
        said, picture = ask(view, "size 120 80")
        assert picture.startswith(b"\xff\xd8")
        assert picture.endswith(b"\xff\xd9")
        assert said["title"] == "<MIMo>"
        assert "page.js" in urllib.request.urlopen(view.url, timeout=60).read().decode()
        stands = ask(view, "pause 1")[0]["steps"]
        assert ask(view)[0]["steps"] == stands
        ask(view, "step")
        assert until(view, lambda said: said["steps"] > stands)["steps"] == stands + 1
        view.stop()
        assert not view.running
        env.step(env.action_space.sample())
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(view.url, timeout=5)
    env.close()


def test_a_notebook_shows_the_page_in_a_frame() -> None:
    with babybench.view(SMALL, height=300) as view:
        frame = view._repr_html_()
        assert frame.startswith(f'<iframe src="{view.url}"')
        assert "height:300px" in frame
        assert view.url in repr(view)
        view.stop()
        view.env.close()


class Handles:
    """Stands in for the outputs of a cell: what each shows now."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.outputs: list[str] = []
        monkeypatch.setattr(notebook, "_display", self.display)
        monkeypatch.setattr(notebook, "_update", self.update)
        monkeypatch.setattr(notebook, "FASTEST", 0.0)
        monkeypatch.setattr(notebook, "SHARE", 1.0)

    def display(self, html: str) -> int:
        self.outputs.append(html)
        return len(self.outputs) - 1

    def update(self, handle: int, html: str) -> None:
        self.outputs[handle] = html


def test_a_notebook_far_from_its_kernel_shows_pictures(env: babybench.Env, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("PIL", reason="pictures in notebooks need Pillow")
    handles = Handles(monkeypatch)
    action = np.zeros(env.action_space.shape, np.float32)
    with babybench.view(env, height=96) as view:
        view._ipython_display_()
        view.show()
        assert handles.outputs == [f"<div>{view._repr_html_()}</div>", ""]
        monkeypatch.setattr(notebook, "PATIENCE", 0.0)
        view.show()
        frame, first = handles.outputs
        assert "does not reach the machine of the kernel" in frame
        assert first.startswith('<img src="data:image/webp;base64,')
        assert 'width="128" height="96"' in first
        for _ in range(20):
            env.step(action + 1)
        view.show()
        assert handles.outputs[1] != first


def test_a_notebook_beside_its_kernel_keeps_the_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "PATIENCE", 0.0)
    handles = Handles(monkeypatch)
    output = notebook.NotebookOutput("page", "note", lambda: pytest.fail("a picture was drawn"))
    output.update(watched=True)
    output.update(watched=False)
    assert handles.outputs == ["page", ""]


def test_a_kernel_sends_pictures_of_a_live_view(tmp_path: Path) -> None:
    nbclient = pytest.importorskip("nbclient", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("ipykernel", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("PIL", reason="pictures in notebooks need Pillow")
    import nbformat

    page = nbformat.v4.new_notebook()
    page.cells = [
        nbformat.v4.new_code_cell(
            "import babybench, babybench_core.notebook as notebook, time\nnotebook.PATIENCE = 0.1"
        ),
        nbformat.v4.new_code_cell(
            'view = babybench.view({"behavior": "self_touch", "touch_active": False}, "held", height=90)\nview'
        ),
        nbformat.v4.new_code_cell("while view._output._next == 0:\n    time.sleep(0.05)\nview.close()"),
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Jupyter's own
        nbclient.NotebookClient(
            page, timeout=300, startup_timeout=300, resources={"metadata": {"path": str(tmp_path)}}
        ).execute()
    outputs = page.cells[1]["outputs"]
    assert [out["output_type"] for out in outputs] == ["display_data"] * 2, outputs  # no warnings, either
    frame, picture = [out["data"]["text/html"] for out in outputs]
    assert "forward port" in frame
    assert picture.startswith('<img src="data:image/webp;base64,')


def test_a_program_shows_its_own_steps_and_is_not_held_while_nobody_looks(env: babybench.Env) -> None:
    action = np.zeros(env.action_space.shape, np.float32)
    with babybench.view(env) as view:
        assert not view.running
        started = time.perf_counter()
        for _ in range(200):
            assert view.show() is False
        assert time.perf_counter() - started < 200 * env.dt, "nobody looks"

        heard: list[Any] = []
        person = threading.Thread(target=lambda: heard.extend([ask(view, "pause 1"), ask(view, "pause 0\nreset")]))
        person.start()
        resets = 0
        while person.is_alive():
            env.step(action)
            if view.show():
                env.reset()
                resets += 1
        person.join()
        assert [said["paused"] for said, _ in heard] == [True, False]
        assert resets == 1 or view.show()


def test_what_moves_him_is_a_function_a_noise_or_nothing(env: babybench.Env) -> None:
    seen: list[Any] = []

    def policy(observation: Any) -> Any:
        seen.append(observation["observation"].shape)
        return np.zeros(env.action_space.shape)

    with babybench.view(env) as view:
        view.play(policy, episodes=2)
        assert len(seen) == 2 * SMALL["max_episode_steps"]  # type: ignore[operator]
        view.play(babybench.ActionNoise("pink", env), episodes=1)
        view.play(episodes=1)
        with pytest.raises(TypeError, match="function of the observation"):
            view.play(3)  # type: ignore[arg-type]
        with pytest.raises(ValueError, match="noise"):
            view.play("storm")

        def broken(observation: Any) -> Any:
            raise ArithmeticError("no idea")

        view.start(broken)
        while view.running:
            time.sleep(0.01)
        with pytest.raises(ArithmeticError, match="no idea"):
            view.stop()
    with pytest.raises(RuntimeError, match="closed"):
        view.play(episodes=1)


def test_what_cannot_be_shown_is_refused() -> None:
    with pytest.raises(TypeError, match="environment of babybench"):
        babybench.View(gymnasium.make("CartPole-v1"))
    with babybench.view(SMALL) as view:
        port = int(view.url.split(":")[2].split("/")[0])
        with pytest.raises(OSError, match=str(port)):
            babybench.view(SMALL, port=port)


def test_the_command_shows_mimo_until_he_has_lived_enough(tmp_path: Path) -> None:
    (tmp_path / "c.yml").write_text(
        "behavior: none\nscene: base\ntouch_active: false\nvision_active: false\nmax_episode_steps: 5\n"
    )
    call = [sys.executable, "-m", "babybench", "view", "--config", "c.yml", "--episodes", "2", "--policy", "zero"]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("http://127.0.0.1:")
