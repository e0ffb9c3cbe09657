"""``MjSpec``: documents edited in a program, alone and beside MuJoCo 3.3.0."""

from __future__ import annotations

import copy
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import spec_edits

from babybench import mujoco

INFANT = """<mujoco><default><default class="limb"><geom rgba="1 0 0 1" size=".03"/></default></default>
 <worldbody><geom name="floor" type="plane" size="0 0 1"/>
 <body name="hip" pos="0 0 .4"><freejoint name="root"/><geom name="hip" size=".05"/>
  <body name="head" pos="0 0 .15" childclass="limb"><joint name="tilt" axis="0 1 0" range="-70 81"/><geom name="head"/>
   <site name="s"/></body></body></worldbody>
 <actuator><motor name="act" joint="tilt" gear="3.3" ctrlrange="-1 1" user="1 2"/></actuator>
 <sensor><accelerometer name="acc" site="s"/></sensor></mujoco>"""


def infant() -> Any:
    return mujoco.MjSpec.from_string(INFANT)


def test_a_model_is_written_without_a_document() -> None:
    spec = mujoco.MjSpec()
    spec.modelname = "room"
    spec.option.timestep = 0.005
    floor = spec.worldbody.add_geom()
    floor.name, floor.type, floor.size = "floor", mujoco.mjtGeom.mjGEOM_PLANE, [0, 0, 0.25]
    toy = spec.worldbody.add_body(name="toy", pos=[0, 0, 0.5])
    toy.add_freejoint()
    toy.add_geom(name="cube", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.025] * 3, mass=0.03)
    toy.add_site(name="top", pos=[0, 0, 0.025])
    toy.add_camera(name="eye", fovy=60)
    toy.add_light(name="lamp", diffuse=[1, 0.5, 0.25])
    model = spec.compile()
    assert (model.nq, model.nv, model.nbody, model.ngeom, model.nsite, model.ncam, model.nlight) == (
        7,
        6,
        2,
        2,
        1,
        1,
        1,
    )
    assert model.body("toy").mass == 0.03
    assert model.opt.timestep == 0.005
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=200)
    assert data.body("toy").xpos[2] == pytest.approx(0.02489224457064234, abs=2e-6)  # MuJoCo 3.3.0
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert spec_edits.differences(model, again) == []


def test_elements_are_found_and_their_arrays_are_written_through() -> None:
    spec = infant()
    assert [body.name for body in spec.bodies] == ["world", "hip", "head"]
    assert spec.body("nobody") is None
    head = spec.body("head")
    assert (head.parent.name, head.parent.parent.name, head.parent.parent.parent) == ("hip", "world", None)
    assert [joint.name for joint in spec.joints] == ["root", "tilt"]
    assert spec.joint("tilt").range.tolist() == [-70, 81]
    geom = head.geoms[0]
    assert geom.rgba.dtype == np.float32
    assert geom.rgba.tolist() == [1, 0, 0, 1]
    assert geom.classname.name == "limb"
    assert np.isnan(geom.mass)
    geom.size[:1] = 0.04
    geom.pos[2] += 0.01
    geom.mass = 0.5
    spec.actuators[0].gear[0] *= 2
    spec.actuators[0].userdata = [3, 4]
    model = spec.compile()
    assert model.geom("head").size[0] == 0.04
    assert model.geom("head").pos[2] == 0.01
    assert model.body("head").mass == 0.5
    assert model.actuator("act").gear[0] == 6.6
    assert model.actuator_user.tolist() == [[3, 4]]
    assert spec.worldbody.find_child("head") == head
    assert [geom.name for geom in spec.body("hip").find_all("geom")] == ["hip", "head"]
    assert spec.worldbody.first_body().next_body is not None
    assert head.first_joint() == spec.joint("tilt")


def test_a_second_infant_is_attached_by_frame_by_site_and_whole() -> None:
    spec, other = infant(), infant()
    frame = spec.worldbody.add_frame(pos=[0.5, 0, 0.1])
    root = frame.attach_body(other.body("hip"), "b_", "")
    assert root.name == "b_hip"
    spec.worldbody.add_site(name="place", pos=[1, 0, 0]).attach_body(other.body("head"), "", "_2")
    spec.attach(infant(), prefix="c_", frame=spec.worldbody.add_frame())
    model = spec.compile()
    names = [model.actuator(number).name for number in range(model.nu)]
    assert names == ["act", "b_act", "act_2", "c_act"]
    assert (model.nq, model.nsensor, model.ngeom) == (25, 4, 9)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.body("b_head").xpos == pytest.approx([0.5, 0, 0.65])
    assert data.body("head_2").xpos == pytest.approx([1, 0, 0.15])
    assert model.geom("b_head").rgba.tolist() == [1, 0, 0, 1]
    with pytest.raises(ValueError, match=r'body name "b_h(ip|ead)" is used twice'):
        frame.attach_body(other.body("hip"), "b_", "")


def test_what_is_deleted_is_gone_and_what_needs_it_says_so() -> None:
    spec = infant()
    spec.sensors[0].delete()
    spec.joint("tilt").delete()
    with pytest.raises(ValueError, match='joint: there is no joint "tilt"'):
        spec.compile()
    spec.actuators[0].delete()
    assert spec.compile().nv == 6
    spec = infant()
    head = spec.body("head")
    spec.detach_body(head)
    model = spec.compile()
    assert (model.nbody, model.nu, model.nsensor) == (2, 0, 0)
    with pytest.raises(ValueError, match=r"not in this document|was deleted"):
        head.pos = [0, 0, 1]


def test_a_default_class_counts_for_what_is_added_afterwards() -> None:
    spec = infant()
    limb = spec.find_default("limb")
    limb.geom.rgba = [0, 1, 0, 1]
    spec.default.joint.damping = 0.5
    spec.worldbody.add_geom(limb, name="new")
    toy = spec.add_default("toy", limb)
    toy.geom.size[0] = 0.07
    spec.body("head").add_geom(toy, name="toy")
    spec.body("head").add_geom(name="plain", pos=[0.01, 0, 0])
    model = spec.compile()
    assert model.geom("head").rgba.tolist() == [1, 0, 0, 1]
    assert model.geom("new").rgba.tolist() == [0, 1, 0, 1]
    assert model.geom("toy").rgba.tolist() == [0, 1, 0, 1]
    assert model.geom("toy").size[0] == 0.07
    assert model.geom("plain").rgba.tolist() == [0, 1, 0, 1]  # the class of the body
    assert model.geom("plain").size[0] == 0.03
    assert model.joint("tilt").damping == 0


def test_a_state_is_taken_over_when_a_document_is_compiled_again() -> None:
    spec = infant()
    model = spec.compile()
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.3
    mujoco.mj_step(model, data, nstep=20)
    before = spec.copy()
    first = spec.worldbody.add_body(name="first", pos=[1, 0, 0.3])
    first.add_freejoint(name="f")
    first.add_geom(size=[0.05, 0, 0])
    newer, state = spec.recompile(model, data)
    assert (newer.nq, state.time) == (15, data.time)
    assert state.joint("tilt").qpos == data.joint("tilt").qpos
    assert (state.joint("root").qvel == data.joint("root").qvel).all()
    assert state.joint("f").qpos[:3].tolist() == [1, 0, 0.3]
    assert state.ctrl[0] == 0.3
    assert before.compile().nq == copy.copy(before).compile().nq == 8


def test_documents_are_files(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "ball.xml").write_text(
        "<mujoco><asset><mesh file='w.obj'/></asset><worldbody><geom type='mesh' mesh='w'/></worldbody></mujoco>"
    )
    wedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"
    (tmp_path / "parts" / "w.obj").write_text(wedge)
    (tmp_path / "all.xml").write_text('<mujoco><include file="parts/ball.xml"/></mujoco>')
    spec = mujoco.MjSpec.from_file(str(tmp_path / "all.xml"))
    assert spec.compile().nmesh == 1
    # attached to a document elsewhere, the mesh is still found
    other = mujoco.MjSpec()
    other.attach(spec, prefix="p_", frame=other.worldbody.add_frame())
    assert other.compile().nmesh == 1
    given = mujoco.MjSpec.from_string(
        "<mujoco><asset><mesh file='v.obj'/></asset></mujoco>", assets={"v.obj": wedge.encode()}
    )
    assert given.compile().nmesh == 1
    given.to_file(tmp_path / "given.xml")
    given.to_zip(str(tmp_path / "given.zip"))
    assert sorted(zipfile.ZipFile(tmp_path / "given.zip").namelist()) == ["MuJoCo Model.xml", "v.obj"]
    with pytest.raises(ValueError, match=r"no\.xml"):
        mujoco.MjSpec.from_file(str(tmp_path / "no.xml"))


@pytest.mark.parametrize(
    ("act", "error", "text"),
    [
        (lambda s: setattr(s.geoms[0], "sizes", 1), AttributeError, "MjsGeom has no sizes; did you mean size"),
        (lambda s: s.geoms[0].plugin, AttributeError, "plugins are programs of MuJoCo's own"),
        (lambda s: setattr(s.geoms[0], "size", [1.0]), ValueError, "size has 1 numbers: it must have 3"),
        (lambda s: setattr(s.geoms[0], "type", 99), ValueError, "type is 99: it must be one of 0"),
        (lambda s: setattr(s.geoms[0], "condim", 9), ValueError, "condim: 9 must be from 1 to 6"),
        (lambda s: s.worldbody.add_geom(nonsense=1), AttributeError, "MjsGeom has no nonsense"),
        (lambda s: s.worldbody.add_joint(), ValueError, "<worldbody> cannot hold <joint>"),
        (lambda s: s.add_plugin(), AttributeError, "plugins are not simulated here"),
        (lambda s: s.delete, AttributeError, r"element\.delete\(\)"),
        (lambda s: setattr(s, "nonsense", 1), AttributeError, "MjSpec has no nonsense"),
        (lambda s: s.attach(infant()), ValueError, "either a frame or a site"),
        (lambda s: s.find_default("limb").actuator.flex, AttributeError, "MjsActuator has no flex"),
        (lambda s: mujoco.MjSpec.from_string("<mujoco><nonsense/></mujoco>"), ValueError, 'unknown element "nonsense"'),
    ],
)
def test_what_cannot_be_says_so(act: Callable[[Any], object], error: type[Exception], text: str) -> None:
    spec = infant()
    before = spec.to_xml()
    with pytest.raises(error, match=text):
        act(spec)
    spec.find_default("limb")
    assert len(spec.geoms) == 3
    assert mujoco.MjModel.from_xml_string(before).ngeom == spec.compile().ngeom


def test_servos_welds_and_textures_are_mujoco_s() -> None:
    spec = infant()
    weld = spec.add_equality()
    weld.type, weld.name1, weld.objtype = mujoco.mjtEq.mjEQ_WELD, "hip", mujoco.mjtObj.mjOBJ_BODY
    assert weld.data.tolist() == [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    weld.data[1] = 0
    texture = spec.add_texture(name="t", width=8, height=48, builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT)
    material = spec.add_material(name="m")
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture.name
    servo = spec.add_actuator(name="servo", target="tilt", trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.gainprm[0], servo.biasprm[1:3] = 20, [-20, -2]
    servo.biastype = mujoco.mjtBias.mjBIAS_AFFINE
    tendon = spec.add_tendon(name="string")
    tendon.wrap_joint("tilt", 2)
    sensor = spec.add_sensor(name="length", type=mujoco.mjtSensor.mjSENS_TENDONPOS)
    sensor.objtype, sensor.objname = mujoco.mjtObj.mjOBJ_TENDON, "string"
    model = spec.compile()
    assert model.eq_type.tolist() == [int(mujoco.mjtEq.mjEQ_WELD)]
    assert model.eq_data[0, 3:7].any()
    assert model.actuator("servo").biasprm[:3].tolist() == [0, -20, -2]
    assert (model.ntex, model.ntendon, model.nsensor) == (1, 1, 2)


@pytest.fixture(scope="module")
def theirs() -> Any:
    module = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    if getattr(module, "stands_in", False):
        pytest.skip("MuJoCo is not installed")
    return module


@pytest.mark.parametrize("first", range(0, 60, 20))
def test_random_edits_compile_to_mujoco_s_models(first: int, theirs: Any) -> None:
    """``python tests/spec_edits.py 10000`` compares more."""
    told = [spec_edits.compare(mujoco, theirs, seed, 1e-12) for seed in range(first, first + 20)]
    assert [one for one in told if one] == []


def test_every_name_of_mujoco_is_there_or_says_what_to_do(theirs: Any) -> None:
    for name in dir(theirs):
        if name.startswith("_"):
            continue
        try:
            getattr(mujoco, name)
        except AttributeError as error:
            assert "`pip install mujoco` and `import mujoco` have everything" in str(error)  # noqa: PT017


def test_new_elements_start_with_mujoco_s_values(theirs: Any) -> None:
    compared = 0
    for module_elements in zip(new_elements(mujoco), new_elements(theirs)):
        mine, its = module_elements
        for name in dir(its):
            value = None if name.startswith("_") or name in ("parent", "classname", "frame") else getattr(its, name)
            if not isinstance(value, (int, float, str, np.ndarray)):
                continue
            if name in (
                "info",
                "childclass",
                "intrinsic",
                "userfacetexcoord",
                "content_type",
                "bindpos",
                "bindquat",
            ) or (type(mine).__name__ == "MjsSkin"):
                continue
            one = getattr(mine, name)
            assert np.array_equal(one, value, equal_nan=not isinstance(value, str)), (
                f"{type(mine).__name__}.{name}: {one}"
            )
            if isinstance(value, np.ndarray):
                assert one.dtype == value.dtype, f"{type(mine).__name__}.{name}"
            compared += 1
    assert compared > 200


def new_elements(module: Any) -> list[Any]:
    spec = module.MjSpec()
    body = spec.worldbody.add_body(name="b")
    kinds = ("frame", "joint", "geom", "site", "camera", "light")
    parts = (
        "key",
        "pair",
        "exclude",
        "equality",
        "tendon",
        "actuator",
        "sensor",
        "texture",
        "material",
        "mesh",
        "hfield",
    )
    return [
        body,
        *(getattr(body, f"add_{kind}")() for kind in kinds),
        *(getattr(spec, f"add_{kind}")() for kind in (*parts, "numeric", "text")),
        *(spec.compiler, spec.option, spec.stat),
    ]
