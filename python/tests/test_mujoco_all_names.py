"""All public names of MuJoCo 3.3.0: each is there, or an error says what to do; the page lists them."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import mujoco_all_names
import numpy as np
import pytest
from mujoco_documents import ALL, ARM

from babybench import mujoco
from babybench_core.mujoco.missing import WHY

LIT = """<mujoco><visual><headlight ambient="1 1 1" diffuse="0 0 0"/></visual>
<worldbody><camera name="eye" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
<geom type="box" size=".1 .1 .1" pos="0 9 0"/></worldbody></mujoco>"""


@pytest.mark.parametrize("name", mujoco_all_names.names())
def test_each_name_is_there_or_says_what_to_do(name: str) -> None:
    if name not in WHY:
        assert getattr(mujoco, name) is not None
        return
    with pytest.raises(AttributeError, match=f"babybench.mujoco has no {name}: ") as error:
        getattr(mujoco, name)
    assert WHY[name] in str(error.value)


def test_names_that_mujoco_lacks_say_so() -> None:
    with pytest.raises(AttributeError, match=r"no mj_nonsense: MuJoCo 3\.3\.0 does not have it either"):
        _ = mujoco.mj_nonsense


def test_the_page_lists_the_names() -> None:
    assert mujoco_all_names.page() == mujoco_all_names.PAGE.read_text(encoding="utf-8")


def test_models_and_states_are_pickled_with_what_was_written() -> None:
    model = mujoco.MjModel.from_xml_string(ALL)
    data = mujoco.MjData(model)
    model.body_mass[1] *= 2
    model.opt.timestep, model.opt.iterations = 0.003, 7
    data.qvel[:] = 0.1
    mujoco.mj_step(model, data, 5)
    again = pickle.loads(pickle.dumps(data))
    assert again.model is not model
    assert again.model.opt.iterations == 7
    assert again.model.body_mass.tobytes() == model.body_mass.tobytes()
    for name, array in data._arrays.items():
        assert again._arrays[name].tobytes() == array.tobytes(), name
    for m, d in ((model, data), (again.model, again)):
        mujoco.mj_step(m, d, 20)
    assert again.qpos.tobytes() == data.qpos.tobytes()
    deep, shallow = copy.deepcopy(data), copy.copy(data)
    assert deep.model is not model
    assert shallow.model is model
    assert deep.qpos.tobytes() == data.qpos.tobytes()


def test_the_document_of_a_model_is_saved(tmp_path: Path) -> None:
    model = mujoco.MjModel.from_xml_string(ALL)
    mujoco.mj_saveLastXML(tmp_path / "saved.xml", model)
    again = mujoco.MjModel.from_xml_path(tmp_path / "saved.xml")
    for name, array in model._arrays.items():
        assert again._arrays[name].tobytes() == array.tobytes(), name
    model.body_mass[1] *= 2
    with pytest.raises(NotImplementedError, match="body_mass was written into the model"):
        mujoco.mj_saveLastXML(tmp_path / "saved.xml", model)


def test_markers_are_drawn_and_forgotten() -> None:
    model = mujoco.MjModel.from_xml_string(LIT)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    red = np.array([1, 0, 0, 1], np.float32)
    kinds = mujoco.mjtGeom
    shown = {}
    with mujoco.Renderer(model, 60, 60) as renderer:
        for kind in (
            kinds.mjGEOM_SPHERE,
            kinds.mjGEOM_CAPSULE,
            kinds.mjGEOM_ELLIPSOID,
            kinds.mjGEOM_CYLINDER,
            kinds.mjGEOM_BOX,
        ):
            renderer.update_scene(data, camera="eye")
            assert renderer.scene.ngeom == 0
            renderer.scene.ngeom += 1
            mujoco.mjv_initGeom(renderer.scene.geoms[0], kind, [0.5, 0.5, 0.5], np.zeros(3), np.eye(3).flatten(), red)
            picture = renderer.render()
            shown[kind] = int(((picture[..., 0] > 60) & (picture[..., 1] < 120)).sum())
            renderer.enable_segmentation_rendering()
            assert (renderer.render()[30, 30] == 0).all()
            renderer.disable_segmentation_rendering()
        renderer.update_scene(data, camera="eye")
        assert not ((renderer.render()[..., 0] > 60) & (renderer.render()[..., 1] < 120)).any()
        renderer.scene.ngeom += 1
        line = renderer.scene.geoms[0]
        mujoco.mjv_initGeom(line, kinds.mjGEOM_LINE, None, None, None, red)
        mujoco.mjv_connector(line, kinds.mjGEOM_LINE, 20, [-1, 0, 0], [1, 0, 0])
        row = renderer.render()[30]
        assert (row[5:55, 0] > 60).sum() > 30
        mujoco.mjv_initGeom(line, kinds.mjGEOM_ARROW, None, None, None, red)
        with pytest.raises(ValueError, match="mjGEOM_ARROW"):
            renderer.render()
        with pytest.raises(ValueError, match="room for 0 to 10000"):
            renderer.scene.ngeom = 10001
    # a ball of radius 0.5 m at 3 m, a box of the same half length, a capsule twice as long
    assert shown[kinds.mjGEOM_SPHERE] == shown[kinds.mjGEOM_ELLIPSOID]
    assert shown[kinds.mjGEOM_SPHERE] < shown[kinds.mjGEOM_BOX] < shown[kinds.mjGEOM_CAPSULE]
    assert shown[kinds.mjGEOM_CYLINDER] > shown[kinds.mjGEOM_SPHERE] > 100


def test_fields_that_are_not_kept_say_so_when_they_are_used() -> None:
    model = mujoco.MjModel.from_xml_string(ARM)
    data = mujoco.MjData(model)
    assert {"qLD", "qpos", "energy"} <= set(dir(mujoco.MjData))
    assert {"names", "geom_size", "flex_vert", "mesh_graph"} <= set(dir(mujoco.MjModel))
    assert model.flex_vert.shape == (0, 3)
    for use in (len, np.asarray, iter, lambda field: field[0], lambda field: field + 1, lambda field: field.shape):
        with pytest.raises(AttributeError, match=r"data\.qLD: babybench\.mujoco does not have it"):
            use(data.qLD)
    with pytest.raises(AttributeError, match="does not have it"):
        _ = model.nonsense


def test_structs_have_their_fields_and_no_others() -> None:
    rect = mujoco.MjrRect(1, 2, 3, 4)
    assert (rect.left, rect.bottom, rect.width, rect.height) == (1, 2, 3, 4)
    pull = mujoco.MjvPerturb()
    pull.select, pull.refpos = 2, [1, 2, 3]
    assert (pull.select, pull.refpos.tolist()) == (2, [1, 2, 3])
    mujoco.mjv_defaultPerturb(pull)
    assert (pull.select, pull.refpos.tolist()) == (0, [0, 0, 0])
    with pytest.raises(AttributeError, match="MjvPerturb has no nonsense"):
        pull.nonsense = 1
    with pytest.raises(NotImplementedError, match="no OpenGL here"):
        mujoco.MjrContext(None, 100)
    mujoco.set_mjcb_control(None)
    assert mujoco.get_mjcb_control() is None
    with pytest.raises(NotImplementedError, match="set_mjcb_control: the engine calls no functions of programs"):
        mujoco.set_mjcb_control(print)
    data = mujoco.MjData(mujoco.MjModel.from_xml_string(ARM))
    assert data.warning.number.tolist() == [0] * 8
    assert data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number == 0
