"""What scripts write into ``env.model`` and ``env.data`` acts or is refused by name, where MuJoCo is not installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mimoEnv.envs.dummy import MIMoDummyEnv
from mimoEnv.envs.mimo_env import SCENE_DIRECTORY

import mujoco

pytestmark = pytest.mark.skipif(not getattr(mujoco, "stands_in", False), reason="MuJoCo's own arrays say less")

FIXED = ("body_ipos", "body_iquat", "geom_contype", "geom_condim", "site_size")
SCENE = """<mujoco>
  <option gravity="0 0 0" timestep="0.005" iterations="50" tolerance="1e-10" cone="elliptic" jacobian="dense"/>
  <compiler angle="degree" inertiafromgeom="true"/>
  <include file="{folder}/mimo/MIMo_meta.xml"/>
  <worldbody>
    <body name="mimo_location" pos="0 0 1"><freejoint/><include file="{folder}/mimo/MIMo_model.xml"/></body>
    <body name="toy" pos="2 0 1"><freejoint/><geom size=".05" mass="1"/></body>
    <body name="hand" mocap="true" pos="3 0 1"><geom size=".02"/></body>
  </worldbody>
</mujoco>"""
LEVER = SCENE.replace(
    "  </worldbody>\n",
    """    <body name="lever" pos="0 3 1"><geom size=".05" mass="1"/>
      <joint name="lever" type="slide" range="-.1 .1" limited="true" springref=".1" stiffness="3"/></body>
  </worldbody>
  <tendon><fixed name="string" range="-.2 .2" limited="true" stiffness="5" springlength="0 .1" frictionloss=".1">
    <joint joint="lever" coef="1"/></fixed></tendon>
  <actuator><general name="servo" joint="lever" gainprm="10" biastype="affine" biasprm="0 -10 -1" dyntype="filter" dynprm=".1"
    forcerange="-5 5" forcelimited="true"/></actuator>
""",
)
LAWS: dict[str, float] = {
    "qpos0": 0.05,
    "qpos_spring": -0.2,
    "jnt_margin": 0.3,
    "jnt_pos": 0.1,
    "jnt_axis": 0.7,
    "tendon_range": 0.01,
    "tendon_margin": 0.3,
    "tendon_stiffness": 50.0,
    "tendon_damping": 4.0,
    "tendon_frictionloss": 2.0,
    "tendon_lengthspring": 0.05,
    "actuator_forcerange": 0.5,
    "actuator_dynprm": 0.5,
    "actuator_gainprm": 90.0,
    "actuator_biasprm": -1.0,
}
"""Arrays, and what is written into a number of their last row."""


@pytest.fixture
def env(tmp_path: Path) -> Any:
    path = tmp_path / "toy.xml"
    path.write_text(SCENE.format(folder=SCENE_DIRECTORY))
    env = MIMoDummyEnv(path, frame_skip=20, touch_params=None, vision_params=None)
    env.reset(seed=0)
    return env


@pytest.mark.parametrize("name", FIXED)
def test_writing_to_a_fixed_array_names_it(env: Any, name: str) -> None:
    before = np.array(getattr(env.model, name))
    with pytest.raises(ValueError, match=rf"model\.{name} cannot be changed"):
        getattr(env.model, name)[0] = 0.5
    with pytest.raises(AttributeError, match=name):
        setattr(env.model, name, before)
    assert np.array_equal(getattr(env.model, name), before)


def _law(model: Any, name: str, value: float) -> None:
    array = getattr(model, name)
    if name in ("qpos0", "qpos_spring"):
        array[model.joint("lever").qposadr[0]] = value
    elif name.startswith("jnt_"):
        array[model.joint("robot:left_elbow" if name in ("jnt_axis", "jnt_pos") else "lever").id, ...] = value
    elif array.ndim == 1:
        array[-1] = value
    else:
        array[-1, 1 if name in ("tendon_range", "tendon_lengthspring") else 0] = value


@pytest.mark.parametrize("name", LAWS)
def test_laws_that_are_written_act(tmp_path: Path, name: str) -> None:
    path = tmp_path / "lever.xml"
    path.write_text(LEVER.format(folder=SCENE_DIRECTORY))
    env = MIMoDummyEnv(path, frame_skip=20, touch_params=None, vision_params=None)
    env.reset(seed=0)
    model, data = env.model, env.data
    plain = mujoco.MjModel.from_xml_path(env.fullpath)
    copy, unchanged = mujoco.MjData(plain), mujoco.MjData(mujoco.MjModel.from_xml_path(env.fullpath))
    _law(model, name, LAWS[name])
    _law(plain, name, LAWS[name])
    # the environment sets what its actuation model needs: the same in all three
    for own in (plain, unchanged.model):
        for kept in ("jnt_stiffness", "dof_damping", "actuator_gear", "actuator_forcelimited"):
            getattr(own, kept)[...] = getattr(model, kept)
    start = np.array(data.qpos)
    lever = model.joint("lever").qposadr[0]
    for one in (data, copy, unchanged):
        one.qpos[:] = start
        one.qpos[lever] = 0.15
        one.qvel[:] = 0
        one.act[:] = 0
        one.ctrl[:] = 0
        one.ctrl[model.actuator("servo").id] = 0.7
    for _ in range(10):
        mujoco.mj_step(model, data)
        mujoco.mj_step(plain, copy)
        mujoco.mj_step(unchanged.model, unchanged)
    np.testing.assert_allclose(data.qpos, copy.qpos, rtol=0, atol=1e-10)
    np.testing.assert_allclose(data.qvel, copy.qvel, rtol=0, atol=1e-8)
    np.testing.assert_allclose(data.xpos, copy.xpos, rtol=0, atol=1e-10)
    # a slide is where its position is beyond qpos0
    seen = "xpos" if name == "qpos0" else "qpos"
    assert np.abs(getattr(data, seen) - getattr(unchanged, seen)).max() > 1e-6


def test_a_simulation_that_diverges_restarts_with_a_warning(env: Any) -> None:
    toy = env.model.joint("robot:hip_lean1").dofadr[0]
    env.data.qvel[toy] = 1e11
    with pytest.warns(RuntimeWarning, match="diverged in step .* restarts"):
        env.step(np.zeros(env.action_space.shape))
    assert env.data.time == pytest.approx(env.frame_skip * env.model.opt.timestep)
    assert np.abs(env.data.qvel).max() < 1e3
    env.step(np.zeros(env.action_space.shape))


def test_poses_that_are_written_act(env: Any) -> None:
    model, data = env.model, env.data
    eye, hand = model.camera("eye_left").id, model.body("hip").id
    before = np.array(data.cam_xpos[eye]), np.array(data.xpos[hand])
    model.cam_pos[eye, 0] += 0.01
    model.body_pos[hand, 2] += 0.05
    mujoco.mj_forward(model, data)
    assert np.linalg.norm(data.xpos[hand] - before[1]) == pytest.approx(0.05, abs=1e-3)
    assert np.linalg.norm(data.cam_xpos[eye] - before[0]) > 0.03
    env.step(np.zeros(env.action_space.shape))


def test_pictures_follow_what_is_written(env: Any) -> None:
    model, data = env.model, env.data
    toy = model.geom_bodyid.tolist().index(model.body("toy").id)

    def look() -> np.ndarray[Any, Any]:
        return np.asarray(env.mujoco_renderer.render("rgb_array", camera_id=eye), float)

    eye, state = model.camera("eye_left").id, np.array(data.qpos)
    data.qpos[-7:-4] = data.cam_xpos[eye] - 0.3 * data.cam_xmat[eye].reshape(3, 3)[:, 2]
    mujoco.mj_forward(model, data)
    first = look()
    model.geom_rgba[toy] = 1, 0, 0, 1
    red = look()
    assert red[..., 0].sum() > first[..., 0].sum()
    assert red[..., 1].sum() < first[..., 1].sum()
    model.cam_fovy[eye] /= 2
    near = look()
    assert (near - red).std() > 5
    model.geom_group[toy] = 3
    assert (look() - near).std() > 5
    model.vis.headlight.ambient[:] = 1
    assert np.isfinite(look()).all()
    assert np.array_equal(data.qpos[:-7], state[:-7])
    env.step(np.zeros(env.action_space.shape))
    env.reset()
    assert (look() - first).std() > 5


def test_a_copy_looks_the_same(env: Any) -> None:
    import copy

    env.model.geom_rgba[3] = 1, 0, 0, 1
    env.step(np.zeros(env.action_space.shape))
    other = copy.deepcopy(env)
    assert other.model.geom_rgba[3].tolist() == [1, 0, 0, 1]
    for each in (env, other):
        mujoco.mj_forward(each.model, each.data)  # a picture shows the start of the last physics step
    pictures = [each.mujoco_renderer.render("rgb_array", camera_name="eye_left") for each in (env, other)]
    assert np.array_equal(*pictures)
    other.step(np.zeros(env.action_space.shape))


def test_a_face_that_is_written_is_drawn(env: Any) -> None:
    model = env.model
    head = model.material("head").id
    before = np.array(model.mat_texid[head])
    assert before.tolist() == [-1, env.facial_expressions["default"], *[-1] * 8]
    model.mat_texid[head, 1] = env.facial_expressions["angry"]
    env.step(np.zeros(env.action_space.shape))
    model.mat_texid[head, 1] = 99
    with pytest.raises(ValueError, match="mat_texid"):
        env.step(np.zeros(env.action_space.shape))


def test_a_force_on_a_body_acts(env: Any) -> None:
    env.data.xfrc_applied[env.model.body("toy").id, 0] = 1.0
    env.step(np.zeros(env.action_space.shape))
    assert env.data.qvel[-6] == pytest.approx(0.1)  # 1 N on 1 kg for 20 steps of 5 ms
    env.data.xfrc_applied[:] = 0
    env.data.qfrc_applied[-6] = -1.0
    env.step(np.zeros(env.action_space.shape))
    assert env.data.qvel[-6] == pytest.approx(0.0, abs=1e-9)


def test_a_mocap_body_goes_where_it_is_put(env: Any) -> None:
    env.data.mocap_pos[0] = 0.5, 0.6, 0.7
    env.data.mocap_quat[0] = 0, 1, 0, 0
    env.step(np.zeros(env.action_space.shape))
    assert np.allclose(env.data.body("hand").xpos, [0.5, 0.6, 0.7])
    assert np.allclose(env.data.body("hand").xquat, [0, 1, 0, 0])


def test_locks_hold_from_the_next_reset_on(env: Any) -> None:
    lock = env.model.equality("robot:right_elbow").id
    with pytest.raises(AttributeError, match="eq_active0"):
        env.data.eq_active = np.ones(env.model.neq)
    assert env.data.eq_active[lock] == 0
    env.model.eq_active0[lock] = 1
    env.model.eq_data[lock, 0] = -0.5
    env.reset()
    assert env.data.eq_active[lock] == 1
    for _ in range(30):
        env.step(np.zeros(env.action_space.shape))
    assert env.data.joint("robot:right_elbow").qpos[0] == pytest.approx(-0.5, abs=0.02)


def test_constants_follow_masses(env: Any) -> None:
    toy = env.model.body("toy").id
    env.model.body_mass[toy] = 0.25
    env.model.body_inertia[toy] = 0.0001
    mujoco.mj_setConst(env.model, env.data)
    assert np.allclose(env.model.body_invweight0[toy], [4, 10000])
    assert np.allclose(env.model.dof_M0[-6:], [0.25] * 3 + [0.0001] * 3)
    env.step(np.zeros(env.action_space.shape))


def test_the_viewer_shows_an_environment(env: Any, capsys: pytest.CaptureFixture[str]) -> None:
    import mujoco.viewer

    with mujoco.viewer.launch_passive(env.model, env.data) as viewer:
        assert viewer.is_running()
        assert viewer.url in capsys.readouterr().out
        mujoco.mj_step(env.model, env.data)
        viewer.sync()
        with pytest.raises(AttributeError, match="cam: the page of this viewer"):
            _ = viewer.cam
    assert not viewer.is_running()
    with pytest.raises(TypeError, match=r"env\.model and env\.data of one environment, not NoneType"):
        mujoco.viewer.launch_passive(None, None)
    with pytest.raises(NotImplementedError, match="key_callback"):
        mujoco.viewer.launch_passive(env.model, env.data, key_callback=print)
