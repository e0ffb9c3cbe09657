"""Files that documents name: found where MuJoCo finds them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from babybench import mujoco as ours

theirs = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
if getattr(theirs, "stands_in", False):
    pytest.skip("MuJoCo is not installed", allow_module_level=True)

FACES = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
"""Of a tetrahedron, in the format OBJ."""
MODEL = """<mujoco model="part"><asset><mesh name="t" file="../meshes/t.obj"/></asset>
  <worldbody><body name="b"><geom type="mesh" mesh="t"/></body></worldbody></mujoco>"""


def tetrahedron(side: int) -> str:
    return f"v 0 0 0\nv {side} 0 0\nv 0 1 0\nv 0 0 1\n{FACES}"


def document(compiler: str, assets: str, file: str = "") -> str:
    mesh = f'<mesh name="t" file="{file}"/>' if file else ""
    return (
        f"<mujoco><compiler {compiler}/>{assets}<asset>{mesh}</asset>"
        '<worldbody><geom type="mesh" mesh="t"/></worldbody></mujoco>'
    )


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with rooms, meshes, and what rooms include; rooms are the working directory."""
    for name, text in {
        "meshes/t.obj": tetrahedron(1),
        "rooms/near.obj": tetrahedron(2),
        "part.xml": '<mujoco><asset><mesh name="t" file="t.obj"/></asset></mujoco>',
        "parts/model.xml": MODEL,
    }.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    monkeypatch.chdir(tmp_path / "rooms")
    return tmp_path


def size(mujoco: Any, text: str, assets: Mapping[str, bytes] | None, path: Path | None) -> list[float]:
    if path is None:
        model = mujoco.MjModel.from_xml_string(text, assets)
    else:
        path.write_text(text)
        model = mujoco.MjModel.from_xml_path(str(path), assets)
    return [*model.geom_size[0]]


def alike(robot: Path, text: str, assets: Mapping[str, bytes] | None = None) -> None:
    """As a file and as a text."""
    for path in (robot / "rooms/room.xml", None):
        expected = size(theirs, text, assets, path)
        assert size(ours, text, assets, path) == pytest.approx(expected, abs=1e-10), path


@pytest.mark.parametrize(
    ("compiler", "assets", "file"),
    [
        ("", "", "near.obj"),
        ("", "", "../meshes/t.obj"),
        ('meshdir="../meshes"', "", "t.obj"),
        ('meshdir="../meshes/"', "", "./t.obj"),
        ('meshdir="..\\meshes"', "", "t.obj"),
        ('meshdir="nowhere"', "", "{robot}/meshes/t.obj"),
        ('meshdir="{robot}/meshes"', "", "t.obj"),
        ('meshdir="{robot}/rooms"', "", "../meshes/t.obj"),
        ('meshdir="../meshes"', '<include file="../part.xml"/>', ""),
        ('meshdir="../meshes"', '<include file="{robot}/part.xml"/>', ""),
    ],
)
def test_files_are_found_beside_above_and_by_absolute_path(robot: Path, compiler: str, assets: str, file: str) -> None:
    alike(robot, document(compiler, assets, file).replace("{robot}", str(robot)))


@pytest.mark.parametrize("path", ["../parts/model.xml", "{robot}/parts/model.xml"])
def test_a_model_names_files_from_its_own_folder(robot: Path, path: str) -> None:
    attached = '<body><attach model="part" body="b" prefix="a"/></body>'
    text = f'<mujoco><asset><model name="part" file="{path}"/></asset><worldbody>{attached}</worldbody></mujoco>'
    alike(robot, text.replace("{robot}", str(robot)))


@pytest.mark.parametrize("key", ["t.obj", "T.obj", "meshes/t.obj", "other/t.obj", "/t.obj"])
@pytest.mark.parametrize("file", ["t.obj", "../meshes/t.obj", "/nowhere/t.obj"])
def test_assets_replace_files_by_name_alone(robot: Path, key: str, file: str) -> None:
    alike(robot, document('meshdir="m"', "", file), {key: tetrahedron(3).encode()})


def test_assets_stand_beside_files(robot: Path) -> None:
    alike(robot, document("", "", "near.obj"), {"t.obj": tetrahedron(3).encode()})


def test_two_assets_of_one_name_are_refused(robot: Path) -> None:
    text = document("", "", "near.obj")
    twice = {"a/t.obj": b"", "b/t.obj": b""}
    for mujoco in (ours, theirs):
        with pytest.raises(ValueError, match=r"t\.obj"):
            mujoco.MjModel.from_xml_string(text, twice)


def test_what_is_not_there_is_named(robot: Path) -> None:
    with pytest.raises(ValueError, match=r'"\.\./meshes/none\.obj" does not exist'):
        ours.MjModel.from_xml_string(document('meshdir="../meshes"', "", "none.obj"))


def test_pictures_use_what_lies_above(robot: Path) -> None:
    text = document("", "", "../meshes/t.obj").replace("<worldbody>", '<worldbody><light pos="0 0 3"/>')
    model = ours.MjModel.from_xml_string(text)
    with ours.Renderer(model, 32, 32) as renderer:
        data = ours.MjData(model)
        ours.mj_forward(model, data)
        renderer.update_scene(data)
        assert np.ptp(renderer.render()) > 0
