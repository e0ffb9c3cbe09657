"""Elements are found by name as in MuJoCo, by bytes as well, and a name that does not exist is answered with a similar one."""

from __future__ import annotations

import pytest

from babybench import mujoco

ROOM = """<mujoco>
  <asset>
    <hfield name="flat" nrow="3" ncol="4" size="1 1 1 1"/>
    <hfield name="hill" nrow="2" ncol="5" size="1 1 1 1"/>
    <mesh name="wedge" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
  </asset>
  <worldbody>
    <geom type="hfield" hfield="hill"/>
    <body name="head"><joint name="neck"/><geom size=".1"/><site name="eye"/></body>
  </worldbody>
</mujoco>"""


@pytest.fixture
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(ROOM)


def test_height_fields_and_meshes_are_found_by_name(model: mujoco.MjModel) -> None:
    hill = model.hfield("hill")
    assert (hill.nrow, hill.ncol, hill.data.shape) == (2, 5, (2, 5))
    assert hill.size.tolist() == [1, 1, 1, 1]
    hill.data[1, 4] = 0.5
    assert model.hfield_data.tolist() == [0] * 21 + [0.5]
    assert model.mesh("wedge").vertnum == 4
    with pytest.raises(KeyError, match="did you mean `hill`"):
        model.hfield("hil")


def test_names_may_be_bytes(model: mujoco.MjModel) -> None:
    assert model.body(b"head").id == model.body("head").id == 1
    kind = mujoco.mju_str2Type(b"site")
    assert mujoco.mj_name2id(model, kind, b"eye") == mujoco.mj_name2id(model, kind, "eye") == 0
    assert mujoco.mj_name2id(model, kind, b"ear") == -1


def test_a_name_that_does_not_exist_is_answered_with_a_similar_one(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    for owner in (model, data):
        with pytest.raises(
            KeyError, match=r"Invalid name 'heads'; did you mean `head`\? Valid names: \['head', 'world'\]"
        ):
            owner.body("heads")
        with pytest.raises(KeyError, match=r"Invalid name 'shoulder'\. Valid names: \['neck'\]"):
            owner.joint("shoulder")
