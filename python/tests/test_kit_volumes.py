"""Volumes of geoms that overlap, and the masses that MIMo's helper makes of them."""

from __future__ import annotations

import numpy as np
import pytest

from babybench import mujoco
from babybench_kit import utils
from babybench_kit.volumes import Solid, union


def model_of(*geoms: str) -> mujoco.MjModel:
    """Returns a model of one body with these geoms."""
    text = "".join(f"<geom {geom}/>" for geom in geoms)
    return mujoco.MjModel.from_xml_string(f'<mujoco><worldbody><body name="part">{text}</body></worldbody></mujoco>')


def volume_of(*geoms: str) -> float:
    """Returns the volume that geoms fill together, m^3."""
    model = model_of(*geoms)
    return union([Solid.of_geom(model, geom) for geom in range(model.ngeom)])


@pytest.mark.parametrize(
    ("geom", "volume"),
    [
        ('type="sphere" size=".1"', 4 / 3 * np.pi * 0.1**3),
        ('type="ellipsoid" size=".1 .2 .3"', 4 / 3 * np.pi * 0.1 * 0.2 * 0.3),
        ('type="capsule" size=".1 .2"', np.pi * 0.1**2 * 0.4 + 4 / 3 * np.pi * 0.1**3),
        ('type="cylinder" size=".1 .2"', np.pi * 0.1**2 * 0.4),
        ('type="box" size=".1 .2 .3"', 8 * 0.1 * 0.2 * 0.3),
    ],
)
@pytest.mark.parametrize("turn", ["", 'euler="90 0 0"', 'pos=".3 .1 -.2" euler="20 40 70"'])
def test_volume_of_a_shape_in_any_position(geom: str, volume: float, turn: str) -> None:
    """A geom alone is exact; with a copy of itself it is measured on the grid."""
    assert volume_of(f"{geom} {turn}") == pytest.approx(volume, rel=1e-12)
    assert volume_of(f"{geom} {turn}", f"{geom} {turn}") == pytest.approx(volume, rel=5e-4)


def test_overlaps_count_once() -> None:
    """Boxes, balls and a ball in a box: overlaps that have a formula."""
    box = 'type="box" size=".1 .1 .1"'
    assert volume_of(box, f'{box} pos=".1 0 0"') == pytest.approx(0.012, rel=1e-3)
    lens = np.pi * (4 * 0.1 + 0.1) * (2 * 0.1 - 0.1) ** 2 / 12
    balls = volume_of('type="sphere" size=".1"', 'type="sphere" size=".1" pos="0 0 .1"')
    assert balls == pytest.approx(2 * 4 / 3 * np.pi * 0.1**3 - lens, rel=5e-4)
    assert volume_of(box, 'type="sphere" size=".1"') == pytest.approx(0.008, rel=1e-3)
    apart = volume_of(
        'type="sphere" size=".1"', 'type="sphere" size=".1" pos="1 0 0"', 'type="sphere" size=".1" pos="0 0 1"'
    )
    assert apart == pytest.approx(3 * 4 / 3 * np.pi * 0.1**3, rel=5e-3)


def test_masses_of_a_target(capsys: pytest.CaptureFixture[str]) -> None:
    """Masses add up to the target, with one density for all bodies, and geoms of a body in proportion to their volumes."""
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="trunk"><geom size=".1"/><geom size=".1" pos="0 0 .1"/></body>'
        '<body name="head" pos="0 0 1"><geom type="box" size=".1 .1 .1"/></body><body name="ghost"/></worldbody></mujoco>'
    )
    masses = utils.determine_geom_masses(model, mujoco.MjData(model), [1, 2], 5.0, print_out=True)
    assert list(masses) == ["trunk", "head"]
    assert sum(map(sum, masses.values())) == pytest.approx(5, rel=1e-12)
    assert masses["trunk"][0] == masses["trunk"][1]
    lens = np.pi * (4 * 0.1 + 0.1) * (2 * 0.1 - 0.1) ** 2 / 12
    trunk = 2 * 4 / 3 * np.pi * 0.1**3 - lens
    assert sum(masses["trunk"]) / masses["head"][0] == pytest.approx(trunk / 0.008, rel=1e-3)
    assert "target: 5 kg" in capsys.readouterr().out
    with pytest.raises(ValueError, match="body 'ghost' has no geoms"):
        utils.determine_geom_masses(model, mujoco.MjData(model), [3], 1.0)
    floor = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/></worldbody></mujoco>'
    )
    with pytest.raises(ValueError, match="'floor' is a plane"):
        utils.determine_geom_masses(floor, mujoco.MjData(floor), [0], 1.0)
