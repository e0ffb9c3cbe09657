"""Films for notebooks whose browser does not reach the kernel."""

from __future__ import annotations

import base64
import io
import os
import re
import shutil
import subprocess
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from conftest import SMALL

import babybench

Image = pytest.importorskip("PIL.Image", reason="films need Pillow")
PICTURE = {"width": 80, "height": 60}


def test_a_program_films_its_own_steps(tmp_path: Path) -> None:
    env = babybench.Env({**SMALL, "touch_active": False})
    film = babybench.Film(gymnasium.wrappers.OrderEnforcing(env), camera="corner", fps=10, **PICTURE)
    env.reset(seed=0)
    steps = round(1 / env.dt)
    for _ in range(steps):
        env.step(env.action_space.sample())
        film.add()
    assert len(film) == 10
    for suffix in (".gif", ".webp", ".png"):
        film.save(tmp_path / f"mimo{suffix}")
        with Image.open(tmp_path / f"mimo{suffix}") as image:
            assert image.size == (80, 60)
            assert image.n_frames > 1
    with pytest.raises(ValueError, match=r"\.webp, \.gif, \.png"):
        film.save(tmp_path / "mimo.avi")


def test_a_film_is_part_of_the_notebook() -> None:
    film = babybench.film({**SMALL, "touch_active": False}, "held", seconds=0.5, fps=10, **PICTURE)
    shown = film._repr_html_()
    assert "http" not in shown
    found = re.fullmatch(
        r'<img src="data:image/webp;base64,([A-Za-z0-9+/=]+)" width="80" height="60" alt="[^"]+">', shown
    )
    assert found
    with Image.open(io.BytesIO(base64.b64decode(found[1]))) as image:
        assert image.n_frames == len(film) == 5
        assert len(np.unique(np.asarray(image.convert("L")))) > 10


def test_the_same_seed_gives_the_same_film() -> None:
    config = {**SMALL, "touch_active": False}
    one, other = (babybench.film(config, seconds=0.2, seed=3, **PICTURE)._repr_html_() for _ in range(2))
    assert one == other


@pytest.mark.parametrize(
    ("arguments", "error", "said"),
    [
        ({"fps": 0}, ValueError, "fps is 0"),
        ({"fps": 100}, ValueError, "at most 50"),
        ({"policy": 3}, TypeError, "a function of the observation"),
    ],
)
def test_what_cannot_be_filmed_is_refused(arguments: dict[str, object], error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        babybench.film({**SMALL, "touch_active": False}, seconds=0.1, **arguments)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="an environment of babybench"):
        babybench.Film(gymnasium.make("CartPole-v1"))
    env = babybench.Env({**SMALL, "touch_active": False})
    with pytest.raises(ValueError, match="no pictures"):
        babybench.Film(env)._repr_html_()


def test_a_browser_without_the_kernel_plays_it(tmp_path: Path) -> None:
    nbclient = pytest.importorskip("nbclient", reason="notebooks need nbclient and ipykernel")
    pytest.importorskip("ipykernel", reason="notebooks need nbclient and ipykernel")
    chromium = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    if not chromium:
        pytest.skip("there is no Chromium")
    import nbformat

    code = f"import babybench\nbabybench.film({ {**SMALL, 'touch_active': False}!r}, 'held', seconds=1, fps=10, camera='corner')"
    cells = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Jupyter's own
        nbclient.NotebookClient(
            cells, timeout=300, startup_timeout=300, resources={"metadata": {"path": str(tmp_path)}}
        ).execute()
    (shown,) = [out["data"]["text/html"] for out in cells.cells[0]["outputs"] if "data" in out]
    # the kernel has ended, and this page comes from no server
    page = tmp_path / "page.html"
    page.write_text(f"<!doctype html><body style='margin:0'>{shown}")
    picture = tmp_path / "picture.png"
    command = [
        chromium,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--screenshot={picture}",
        "--window-size=480,360",
        page.as_uri(),
    ]
    subprocess.run(command, check=True, capture_output=True, timeout=600)
    with Image.open(picture) as image:
        assert len(np.unique(np.asarray(image.convert("L")))) > 50
