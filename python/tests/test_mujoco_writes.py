"""What programs write into the arrays of a model acts: in the next step or the next picture, as in MuJoCo 3.3.0."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from babybench import mujoco

try:
    import mujoco as theirs
except ImportError:
    theirs = mujoco
if getattr(theirs, "stands_in", False):
    theirs = mujoco

SCENE = """<mujoco>
  <asset>
    <texture name="calm" type="cube" builtin="flat" width="8" height="48" rgb1=".9 .1 .1" rgb2=".9 .1 .1"/>
    <texture name="angry" type="cube" builtin="flat" width="8" height="48" rgb1=".1 .1 .9" rgb2=".1 .1 .9"/>
    <material name="face" texture="calm"/><material name="plain" rgba="0 1 0 1"/>
  </asset>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <light name="lamp" pos="0 0 3" diffuse=".1 .1 .1"/>
    <camera name="eye" pos="0 -1 0" xyaxes="1 0 0 0 0 1"/>
    <body name="ball"><freejoint/><geom name="ball" size=".2" rgba="1 0 0 1" contype="0" conaffinity="0"/>
      <site name="mark" pos=".1 0 0"/></body>
    <body name="arm" pos="1 0 0"><joint name="hinge" axis="0 1 0" damping=".1" range="-1 1" limited="true"/>
      <geom name="arm" type="capsule" fromto="0 0 0 .3 0 0" size=".03" contype="0" conaffinity="0"/></body>
    <body name="box" pos="3 0 0"><geom name="box" type="box" size=".2 .2 .2" material="face"/></body>
  </worldbody>
  <actuator><motor name="motor" joint="hinge" gear="2"/></actuator>
  <equality><weld name="held" body1="ball" active="false"/><joint name="lock" joint1="hinge" active="false"/></equality>
  <keyframe><key name="start" qpos="0 0 0 1 0 0 0 .3"/></keyframe>
</mujoco>"""
PHYSICS = {
    "body_pos": lambda m: m.body_pos.__setitem__((2, 2), 0.4),
    "body_quat": lambda m: m.body_quat.__setitem__(2, [np.sqrt(0.5), 0, 0, np.sqrt(0.5)]),
    "body_mass": lambda m: m.body_mass.__setitem__(2, 0.7),
    "body_inertia": lambda m: m.body_inertia.__imul__(2),
    "dof_damping": lambda m: m.dof_damping.__setitem__(6, 3),
    "jnt_stiffness": lambda m: m.jnt_stiffness.__setitem__(1, 5),
    "jnt_range": lambda m: m.jnt_range.__setitem__((1, 1), 0.1),
    "qpos_spring": lambda m: (m.jnt_stiffness.__setitem__(1, 5), m.qpos_spring.__setitem__(7, 1)),
    "actuator_gear": lambda m: m.actuator_gear.__setitem__((0, 0), 7),
    "actuator_gainprm": lambda m: m.actuator_gainprm.__setitem__((0, 0), 3),
    "site_pos": lambda m: m.site_pos.__setitem__(0, [0.3, 0.2, 0.1]),
    "eq_data": lambda m: (m.eq_active0.__setitem__(1, 1), m.eq_data.__setitem__((1, 0), 0.2)),
    "weld": lambda m: (m.eq_active0.__setitem__(0, 1), m.eq_data.__setitem__((0, 5), -0.3)),
    "gravity": lambda m: m.opt.gravity.__setitem__(2, 3),
    "key_qpos": lambda m: m.key_qpos.__setitem__((0, 7), 0.5),
}


def moved(module: Any, write: Any) -> dict[str, np.ndarray[Any, Any]]:
    """Returns where a model is after three steps, with what a program has written."""
    model = module.MjModel.from_xml_string(SCENE)
    if write is not None:
        write(model)
    data = module.MjData(model)
    module.mj_resetDataKeyframe(model, data, 0)
    data.ctrl[0] = 0.5
    for _ in range(3):
        module.mj_step(model, data)
    module.mj_forward(model, data)
    return {
        name: np.array(getattr(data, name)) for name in ("qpos", "qvel", "xpos", "xquat", "site_xpos", "sensordata")
    }


@pytest.mark.parametrize("name", PHYSICS)
def test_the_next_step_follows(name: str) -> None:
    found, before, expected = moved(mujoco, PHYSICS[name]), moved(mujoco, None), moved(theirs, PHYSICS[name])
    assert any(not np.array_equal(found[key], before[key]) for key in found)
    for key, value in expected.items():
        assert np.allclose(found[key], value, atol=1e-9), key


class Pictures:
    """A model and a renderer of its camera."""

    def __init__(self, size: int = 60) -> None:
        self.model = mujoco.MjModel.from_xml_string(SCENE)
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self.size = size
        self.renderer = mujoco.Renderer(self.model, size, size)

    def look(self, camera: Any = "eye") -> np.ndarray[Any, Any]:
        """Returns the picture of the model as it is."""
        self.renderer.update_scene(self.data, camera=camera)
        return np.asarray(self.renderer.render())

    def middle(self) -> list[int]:
        """Returns the colour in the middle of the picture."""
        colour: list[int] = self.look()[self.size // 2, self.size // 2].tolist()
        return colour


def test_colours_groups_and_materials_follow() -> None:
    pictures = Pictures()
    model, ball = pictures.model, pictures.model.geom("ball").id
    assert pictures.middle() == [255, 0, 0]
    model.geom_rgba[ball] = 0, 0, 1, 1
    assert pictures.middle() == [0, 0, 255]
    model.geom_rgba[ball] = 0.5, 0.5, 0.5, 1  # the colour that gives way to that of a material
    model.geom_matid[ball] = model.material("plain").id
    assert pictures.middle() == [0, 255, 0]
    model.mat_rgba[model.material("plain").id] = 1, 1, 0, 1
    assert pictures.middle() == [255, 255, 0]
    model.vis.headlight.ambient[:] = 0.5
    assert pictures.middle() == [128, 128, 0]
    model.geom_group[ball] = 3
    assert pictures.middle() == [0, 0, 0]


def test_fields_of_view_follow() -> None:
    pictures = Pictures(120)
    pictures.renderer.enable_segmentation_rendering()
    limb = np.tan(np.arcsin(0.2))
    for fovy in (60, 100, 30):
        pictures.model.cam_fovy[0] = fovy
        radius = np.sqrt((pictures.look()[..., 0] == 0).sum() / np.pi)
        assert radius == pytest.approx(60 * limb / np.tan(np.radians(fovy / 2)), abs=0.6)
    seen = []
    free = mujoco.MjvCamera()
    free.lookat[:], free.distance, free.elevation = 0, 1, 0
    for fovy in (60, 30):
        pictures.model.vis.global_.fovy = fovy
        assert pictures.model.vis.global_.fovy == fovy
        seen.append((pictures.look(free)[..., 0] == 0).sum())
    assert seen[1] > 3 * seen[0]


def test_a_renderer_keeps_the_textures_that_materials_had_when_it_was_made() -> None:
    pictures = Pictures()
    pictures.model.cam_pos[0] = 3, -1, 0
    mujoco.mj_forward(pictures.model, pictures.data)
    assert pictures.middle() == [229, 25, 25]
    face, role = pictures.model.material("face").id, int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    pictures.model.mat_texid[face, role] = pictures.model.texture("angry").id
    assert pictures.middle() == [229, 25, 25]
    pictures.renderer = mujoco.Renderer(pictures.model, pictures.size, pictures.size)
    assert pictures.middle() == [25, 25, 229]


@pytest.mark.parametrize(
    ("write", "text"),
    [
        (lambda m: m.geom_rgba.__setitem__((0, 0), np.nan), "model.geom_rgba, element 0"),
        (lambda m: m.geom_matid.__setitem__(0, 7), "model.geom_matid, element 0"),
        (lambda m: m.mat_texid.__setitem__((0, 1), 9), "model.mat_texid, element 0"),
        (lambda m: m.mat_texid.__setitem__((0, 3), 0), "mjTEXROLE_RGB"),
        (lambda m: m.geom_matid.__setitem__(1, -2), "model.geom_matid, element 1"),
        (lambda m: m.eq_data.__setitem__((0, 0), np.inf), "model.eq_data, element 0"),
    ],
)
def test_numbers_that_no_model_has_are_refused_by_name(write: Any, text: str) -> None:
    pictures = Pictures()
    write(pictures.model)
    with pytest.raises(ValueError, match=text):
        pictures.look()
    with pytest.raises(ValueError, match=text):
        mujoco.mj_step(pictures.model, pictures.data)


def test_a_copy_of_a_model_has_what_was_written() -> None:
    import copy

    pictures = Pictures()
    pictures.model.geom_rgba[0] = 0, 0, 1, 1
    other = copy.copy(pictures.model)
    pictures.model.geom_rgba[0] = 0, 1, 0, 1
    assert other.geom_rgba[0].tolist() == [0, 0, 1, 1]


def test_what_never_moves_is_placed_anew_where_it_is_written() -> None:
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><geom name="goal" size=".1" pos="1 0 0"/><body name="post"><site name="top" size=".1"/></body>
        <body pos="0 0 1"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    model.geom_pos[0] = [0, 2, 0]
    model.body_pos[1] = [0, 0, 3]
    mujoco.mj_forward(model, data)
    assert data.geom("goal").xpos.tolist() == [0, 2, 0]
    assert data.site("top").xpos.tolist() == [0, 0, 3]
    model.geom_pos[0, 0] = 5
    mujoco.mj_kinematics(model, data)
    assert data.geom("goal").xpos.tolist() == [5, 2, 0]
