"""``babybench.mujoco``: MuJoCo's names on the engine of this package, MuJoCo not needed."""

from __future__ import annotations

import copy
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mujoco_documents import ALL, ARM, SHAPES

from babybench import mujoco

Pair = tuple[Any, Any]


def pair(text: str = ARM) -> Pair:
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def python(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_an_arm_falls_and_its_arrays_are_live() -> None:
    model, data = pair()
    qpos, site = data.qpos, data.site_xpos
    assert not data.xpos.any()  # nothing is computed yet
    mujoco.mj_step(model, data, nstep=50)
    assert data.time == pytest.approx(0.1)
    assert qpos[0] == data.qpos[0] > 0.05
    mujoco.mj_forward(model, data)
    assert site[0, 2] == pytest.approx(1 - 0.3 * np.sin(qpos[0]))
    data.ctrl = -1
    mujoco.mj_forward(model, data)
    assert data.actuator("pull").force == -1
    assert data.joint("shoulder").qfrc_actuator == -2
    mujoco.mj_resetData(model, data)
    assert data.time == 0
    assert not data.qpos.any()
    assert not data.xpos.any()


def test_a_model_comes_from_a_file_and_its_names_are_found(tmp_path: Path) -> None:
    (tmp_path / "part.xml").write_text(ARM)
    (tmp_path / "whole.xml").write_text('<mujoco><include file="part.xml"/></mujoco>')
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "whole.xml"))
    joint = mujoco.mjtObj.mjOBJ_JOINT
    assert mujoco.mj_name2id(model, joint, "shoulder") == 0
    assert mujoco.mj_id2name(model, joint, 0) == "shoulder"
    assert mujoco.mj_name2id(model, joint, "knee") == -1
    assert mujoco.mj_id2name(model, joint, 7) is None
    assert model.joint("shoulder").damping == 0.1
    assert model.body("upper").jntadr == model.body(1).jntadr == 0
    assert model.body_jntadr.tolist() == [-1, 0]
    assert model.key("up").qpos == -1.5
    with_assets = mujoco.MjModel.from_xml_string((tmp_path / "whole.xml").read_text(), {"part.xml": ARM.encode()})
    assert with_assets.nq == model.nq == 1
    with pytest.raises(KeyError, match=r"Invalid name 'knee'\. Valid names: \['shoulder'\]"):
        model.joint("knee")
    with pytest.raises(IndexError, match=r"Invalid index 3\. Valid indices from 0 to 1"):
        model.body(3)


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (
            lambda m, d: mujoco.mj_addContact(m, d),
            AttributeError,
            "has no mj_addContact: contacts are found by the engine",
        ),
        (lambda m, d: m.mesh_graph.size, AttributeError, "model.mesh_graph: babybench.mujoco does not have it"),
        (lambda m, d: d.qLD[0], AttributeError, "data.qLD: babybench.mujoco does not have it"),
        (lambda m, d: m.opt.apirate, AttributeError, "opt.apirate"),
        (lambda m, d: m.vis.quality, AttributeError, "vis.quality"),
        (lambda m, d: setattr(m, "nonsense", 1), AttributeError, "model.nonsense"),
        (lambda m, d: setattr(d, "nonsense", 1), AttributeError, "data.nonsense"),
        (lambda m, d: setattr(d, "nefc", 1), AttributeError, "data.nefc is computed"),
        (lambda m, d: setattr(m, "nq", 3), AttributeError, "model.nq cannot be changed here"),
        (lambda m, d: setattr(m.stat, "extent", 3.0), AttributeError, "model.stat.extent cannot be changed here"),
        (lambda m, d: m.dof_bodyid.__setitem__(0, 1), ValueError, "model.dof_bodyid cannot be changed here"),
        (
            lambda m, d: np.multiply(m.body_ipos, 2, out=m.body_ipos),
            ValueError,
            "model.body_ipos cannot be changed here",
        ),
        (lambda m, d: m.body("world").ipos.fill(0), ValueError, "read-only"),
        (lambda m, d: setattr(m.opt, "integrator", 4), AttributeError, "opt.integrator cannot be 4 here"),
        (lambda m, d: setattr(m.opt, "solver", 0), AttributeError, "opt.solver cannot be 0 here"),
        (lambda m, d: setattr(m.opt, "enableflags", 1), AttributeError, "opt.enableflags cannot be 1 here"),
        (lambda m, d: mujoco.MjModel(), TypeError, "from_xml_path"),
        (lambda m, d: mujoco.MjModel.from_xml_path("no_such.xml"), ValueError, "no_such.xml"),
        (lambda m, d: mujoco.MjModel.from_xml_string("<mujoco><nonsense/></mujoco>"), ValueError, "nonsense"),
        (lambda m, d: mujoco.MjModel.from_binary_path("a.mjb"), ValueError, "MJB"),
        (
            lambda m, d: mujoco.MjData("model"),
            TypeError,
            "MjData needs an MjModel of babybench.mujoco, not builtins.str",
        ),
        (lambda m, d: mujoco.mj_step("m", d), TypeError, "builtins.str"),
        (lambda m, d: mujoco.mj_step(pair()[0], d), ValueError, "belongs to another model"),
        (lambda m, d: mujoco.mj_resetDataKeyframe(m, d, 1), IndexError, "keyframe 1 does not exist: the model has 1"),
        (lambda m, d: mujoco.mj_resetDataKeyframe(m, d, -1), IndexError, "keyframe -1 does not exist"),
        (
            lambda m, d: mujoco.mj_jac(m, d, np.zeros((3, 2)), None, np.zeros(3), 1),
            TypeError,
            r"jacp should be of shape \(3, nv\)",
        ),
        (lambda m, d: mujoco.mj_jac(m, d, None, None, np.zeros(3), 9), ValueError, "body 9 does not exist"),
        (lambda m, d: mujoco.mj_step2(m, d), RuntimeError, "call mj_step1 before it"),
        (lambda m, d: mujoco.mj_name2id(m, 99, "a"), ValueError, "99 is not a kind of element"),
        (lambda m, d: mujoco.mj_stateSize(m, 1 << 20), ValueError, "not a sum of parts"),
    ],
)
def test_what_is_not_there_says_so(call: Callable[[Any, Any], object], error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        call(*pair())


def test_options_of_the_document_are_there_and_can_be_changed() -> None:
    model, _ = pair(
        """<mujoco><option noslip_iterations="3" actuatorgroupdisable="2">
        <flag multiccd="enable" energy="enable" autoreset="disable" nativeccd="disable"/></option>
        <worldbody><body><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    )
    opt = model.opt
    # MuJoCo 3.3.0's numbers
    assert (opt.enableflags, opt.disableflags, opt.disableactuator, opt.noslip_iterations) == (18, 98304, 4, 3)
    opt.enableflags |= 4
    opt.disableflags &= ~65536
    opt.disableactuator = 0
    opt.noslip_iterations = 0
    copied = copy.copy(model).opt
    assert (copied.enableflags, copied.disableflags, copied.disableactuator, copied.noslip_iterations) == (
        22,
        32768,
        0,
        0,
    )


def test_reference_sites_and_data_of_programs_have_their_places() -> None:
    model, data = pair(
        """<mujoco><size nuserdata="7"/><worldbody><light active="false"/><camera orthographic="true"/>
        <body><joint name="j"/><geom size=".1" contype="-1"/><site name="a"/><site name="b"/></body></worldbody>
        <actuator><motor site="b" refsite="a"/><motor joint="j"/></actuator></mujoco>"""
    )
    assert model.actuator_trnid.tolist() == [[1, 0], [0, -1]]
    assert (model.nuserdata, data.userdata.tolist()) == (7, [0.0] * 7)
    data.userdata[2] = 5.0
    assert copy.copy(data).userdata[2] == 5.0
    mujoco.mj_resetData(model, data)
    assert data.userdata[2] == 0.0
    assert (model.light_active.tolist(), model.cam_orthographic.tolist()) == ([False], [True])
    assert model.geom_contype.tolist() == [-1]


def test_a_simulation_that_diverges_restarts_with_a_warning() -> None:
    model, data = pair()
    mujoco.mj_step(model, data)
    start = data.qpos.copy()
    data.qvel[0] = 1e11
    with pytest.warns(RuntimeWarning, match=r"diverged in step .* restarts"):
        mujoco.mj_step(model, data, 3)
    assert data.time == pytest.approx(3 * model.opt.timestep)
    other = mujoco.MjData(model)
    mujoco.mj_step(model, other, 3)
    assert np.array_equal(data.qpos, other.qpos)
    assert not np.array_equal(data.qpos, start)


def test_numbers_that_are_not_finite_are_errors() -> None:
    model, data = pair()
    data.ctrl[0] = np.nan
    with pytest.raises(ValueError, match=r"state.ctrl\[0\] is NaN"):
        mujoco.mj_step(model, data)
    data.ctrl[0] = 0
    mujoco.mj_step(model, data)
    model.body_mass[1] = np.inf
    with pytest.raises(ValueError, match=r"model.body_mass, number 1, is inf"):
        mujoco.mj_step(model, data)
    model.body_mass[1] = 1
    model.opt.timestep = 0
    with pytest.raises(ValueError, match=r"opt\.timestep is 0: it must be > 0"):
        mujoco.mj_step(model, data)


def test_all_gears_of_an_actuator_act() -> None:
    model, data = (
        pair("""<mujoco><option gravity="0 0 0"/><worldbody><body><freejoint name="root"/><geom size=".1"/></body>
      </worldbody><actuator><motor joint="root"/></actuator></mujoco>""")
    )
    model.actuator_gear[0] = [0, 0, 0, 0, 0, 2]
    data.ctrl[0] = 1
    mujoco.mj_step(model, data)
    assert data.qvel[5] > 0
    assert not data.qvel[:5].any()


def test_meshes_and_height_fields_have_names_and_numbers() -> None:
    model, data = pair(SHAPES)
    assert (model.nmesh, model.nhfield) == (1, 1)
    assert model.geom_type.tolist() == [int(mujoco.mjtGeom.mjGEOM_HFIELD), int(mujoco.mjtGeom.mjGEOM_MESH)]
    assert model.geom_dataid.tolist() == [0, 0]
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_MESH, "wedge") == 0
    assert mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_HFIELD, 0) == "hills"
    for _ in range(400):
        mujoco.mj_step(model, data)
    assert data.ncon > 0
    assert 0 < data.body("stone").xpos[2] < 0.3


def test_skins_are_drawn_and_bent_by_their_bodies() -> None:
    model, data = pair("""<mujoco><visual><headlight ambient="1 1 1"/></visual><deformable>
      <skin name="sheet" rgba="1 0 0 1" vertex="-1 -1 0 1 -1 0 1 1 0 -1 1 0" face="0 1 2 0 2 3">
        <bone body="left" bindpos="-1 0 0" bindquat="1 0 0 0" vertid="0 3" vertweight="1 1"/>
        <bone body="right" bindpos="1 0 0" bindquat="1 0 0 0" vertid="1 2" vertweight="1 1"/></skin></deformable>
      <worldbody><body name="left" pos="-1 0 0"><geom size=".01" rgba="0 0 0 0"/></body>
        <body name="right" pos="1 0 0"><joint type="slide" axis="1 0 0"/><geom size=".01" rgba="0 0 0 0"/></body>
        <camera name="above" pos="0 0 6"/></worldbody></mujoco>""")
    assert model.nskin == 1
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SKIN, "sheet") == 0

    def red() -> int:
        mujoco.mj_forward(model, data)
        with mujoco.Renderer(model, 60, 80) as renderer:
            renderer.update_scene(data, camera="above")
            return int((renderer.render()[..., 0] > 100).sum())

    flat = red()
    data.qpos[0] = -1
    assert flat > 100
    assert red() == pytest.approx(flat / 2, rel=0.1)


def test_a_mocap_body_is_moved_by_the_program() -> None:
    text = """<mujoco><worldbody><body name="led" mocap="true" pos="0 0 1"><geom size=".1"/></body>
      <body><freejoint/><geom size=".1"/></body></worldbody><keyframe><key mpos="0 0 3" mquat="0 2 0 0"/></keyframe></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    assert (model.nmocap, list(model.body_mocapid)) == (1, [-1, 0, -1])
    assert model.key_mpos.tolist() == [[0, 0, 3]]
    assert model.key_mquat.tolist() == [[0, 1, 0, 0]]
    data.mocap_pos[0] = [1, 2, 3]
    data.mocap_quat[0] = [0, 0, 0, 2]
    mujoco.mj_forward(model, data)
    assert data.xpos[1].tolist() == [1, 2, 3]
    assert data.xquat[1].tolist() == [0, 0, 0, 1]
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert data.mocap_pos.tolist() == [[0, 0, 3]]
    assert data.mocap_quat.tolist() == [[0, 1, 0, 0]]


def test_numbers_of_a_model_that_change_change_the_next_step() -> None:
    def speed(change: Callable[[Any], None]) -> float:
        model, data = pair()
        mujoco.mj_step(model, data)
        change(model)
        data.qvel[0] = data.qpos[0] = 0
        data.ctrl[0] = 0.5
        mujoco.mj_step(model, data)
        return float(data.qvel[0])

    def gear(model: Any) -> None:
        model.actuator("pull").gear[0] = 4

    plain = speed(lambda model: None)
    assert speed(lambda model: setattr(model.opt, "timestep", 0.004)) == pytest.approx(2 * plain, rel=0.01)
    assert speed(lambda model: model.opt.gravity.fill(0)) < plain
    assert speed(lambda model: setattr(model.opt, "disableflags", int(mujoco.mjtDisableBit.mjDSBL_GRAVITY))) < plain
    assert speed(gear) > plain
    heavier = speed(lambda model: model.body_mass.__imul__(10))
    assert heavier != plain
    model, data = pair()
    original = copy.copy(model)
    model.body_mass[1] = 7
    model.opt.iterations = 3
    assert original.body_mass[1] != 7
    assert copy.copy(model).body_mass[1] == 7
    assert copy.copy(model).opt.iterations == 3


def test_halves_of_a_step_make_a_whole() -> None:
    whole, data = pair(ALL)
    halves, other = pair(ALL)
    mujoco.mj_resetDataKeyframe(whole, data, 0)
    mujoco.mj_resetDataKeyframe(halves, other, 0)
    for step in range(30):
        data.ctrl[:] = np.sin(step)
        mujoco.mj_step(whole, data)
        mujoco.mj_step1(halves, other)
        other.ctrl[:] = np.sin(step)
        mujoco.mj_step2(halves, other)
    assert np.array_equal(data.qpos, other.qpos)
    assert np.array_equal(data.sensordata, other.sensordata)
    mujoco.mj_step1(halves, other)
    other.qpos[0] += 1
    with pytest.raises(RuntimeError, match="call mj_step1 again"):
        mujoco.mj_step2(halves, other)
    halves.opt.integrator = int(mujoco.mjtIntegrator.mjINT_RK4)
    mujoco.mj_step1(halves, other)
    with pytest.raises(NotImplementedError, match="Euler"):
        mujoco.mj_step2(halves, other)


def test_a_state_is_kept_copied_and_put_back() -> None:
    model, data = pair(ALL)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, 20)
    spec = int(mujoco.mjtState.mjSTATE_INTEGRATION)
    state = np.empty(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    twin = copy.copy(data)
    assert twin.ncon == data.ncon
    assert np.array_equal(twin.xpos, data.xpos)
    mujoco.mj_step(model, data, 20)
    there = data.qpos.copy()
    mujoco.mj_step(model, twin, 20)
    assert np.array_equal(twin.qpos, there)
    mujoco.mj_setState(model, data, state, spec)
    mujoco.mj_step(model, data, 20)
    assert np.array_equal(data.qpos, there)
    data.eq_active[0] = 1
    mujoco.mj_forward(model, data)
    assert data.ne == 1


def test_jacobians_and_inertia_are_what_moves_the_hand() -> None:
    model, data = pair(ALL)
    mujoco.mj_resetDataKeyframe(model, data, 1)
    mujoco.mj_forward(model, data)
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, "sb")
    jacp, jacr = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacSite(model, data, jacp, jacr, site)
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_SITE, site, velocity, 0)
    assert np.allclose(np.concatenate([jacr, jacp]) @ data.qvel, velocity)
    before, there = data.site_xpos[site].copy(), data.qpos.copy()
    mujoco.mj_integratePos(model, data.qpos, data.qvel, 1e-6)
    moved = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, moved, 1e-6, there, data.qpos)
    assert np.allclose(moved, data.qvel, atol=1e-8)
    mujoco.mj_kinematics(model, data)
    assert np.allclose((data.site_xpos[site] - before) / 1e-6, velocity[3:], atol=1e-5)
    inertia, product, back = np.zeros((model.nv, model.nv)), np.zeros(model.nv), np.zeros(model.nv)
    mujoco.mj_fullM(model, inertia, data.qM)
    mujoco.mj_mulM(model, data, product, data.qvel)
    mujoco.mj_solveM(model, data, back, product)
    assert np.allclose(inertia @ data.qvel, product)
    assert np.allclose(back, data.qvel)


def test_wrenches_are_computed_when_they_are_asked_for() -> None:
    model, data = pair()
    mujoco.mj_step(model, data, 5)
    assert not data.cfrc_int.any()
    mujoco.mj_rnePostConstraint(model, data)
    assert data.cfrc_int[1].any()
    model, data = pair(ALL)  # has a sensor that needs them
    mujoco.mj_step(model, data)
    assert data.cacc.any()


def test_quaternions_turn_and_turn_back() -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        quat, other, vec = rng.normal(size=4), rng.normal(size=4), rng.normal(size=3)
        assert mujoco.mju_normalize4(quat) > 0
        mujoco.mju_normalize4(other)
        mat, same, turned = np.zeros(9), np.zeros(4), np.zeros(3)
        mujoco.mju_quat2Mat(mat, quat)
        mujoco.mju_mat2Quat(same, mat)
        assert np.allclose(same * np.sign(same @ quat), quat)
        mujoco.mju_rotVecQuat(turned, vec, quat)
        assert np.allclose(turned, mat.reshape(3, 3) @ vec)
        difference = np.zeros(3)
        mujoco.mju_subQuat(difference, quat, other)
        mujoco.mju_quatIntegrate(other, difference, 1.0)
        assert np.allclose(other * np.sign(other @ quat), quat)


def test_pictures_show_the_model() -> None:
    model, data = pair(ALL)
    renderer = mujoco.Renderer(model, 48, 64)
    with pytest.raises(RuntimeError, match="update_scene"):
        renderer.render()
    renderer.update_scene(data)
    with pytest.raises(ValueError, match="call mj_forward"):
        renderer.render()
    mujoco.mj_forward(model, data)
    renderer.update_scene(data, camera="ca")
    rgb = renderer.render()
    assert rgb.shape == (48, 64, 3)
    assert rgb.std() > 5
    renderer.enable_segmentation_rendering()
    ids = renderer.render()
    assert ids.shape == (48, 64, 2)
    assert model.geom("ga").id in ids[..., 0]
    renderer.disable_segmentation_rendering()
    renderer.enable_depth_rendering()
    depth = renderer.render(out=np.zeros((48, 64), np.float32))
    assert 0.5 < depth.min() < 1.5
    camera = mujoco.MjvCamera()
    camera.type, camera.trackbodyid, camera.distance = int(mujoco.mjtCamera.mjCAMERA_TRACKING), 1, 1.0
    renderer.update_scene(data, camera)
    assert np.abs(renderer.render() - depth).max() > 0.1
    with pytest.raises(ValueError, match='The camera "no" does not exist'):
        renderer.update_scene(data, "no")
    with pytest.raises(TypeError, match="it must be an MjvOption"):
        renderer.update_scene(data, scene_option=object())
    renderer.close()
    with pytest.raises(RuntimeError, match="after close"):
        renderer.render()


def test_gymnasium_s_environments_run_unchanged() -> None:
    told = python(
        """
        import babybench.mujoco
        babybench.mujoco.install()
        import sys, warnings
        import gymnasium, mujoco
        assert mujoco is babybench.mujoco.install()
        warnings.simplefilter("ignore")
        names = [name for name in gymnasium.registry if name.startswith(("Ant", "HalfCheetah", "Hopper", "Humanoid", "Inverted",
            "Pusher", "Reacher", "Swimmer", "Walker2d")) and name.endswith(("v4", "v5")) and name != "Pusher-v4"]
        for name in names:
            try:
                env = gymnasium.make(name, render_mode="rgb_array")
            except ValueError as error:  # old documents, which MuJoCo 3.3.0 refuses as well
                assert 'coordinate="global"' in str(error) or 'unknown attribute "collision"' in str(error)
                continue
            env.reset(seed=0)
            env.action_space.seed(0)
            for _ in range(20):
                observation, *_ = env.step(env.action_space.sample())
                assert env.observation_space.contains(observation)
            print(name, env.render().std() > 1)
            env.close()
        assert "glfw" not in sys.modules
        """
    )
    lines = told.split("\n")[:-1]
    assert len(lines) >= 7
    assert all(line.endswith(" True") for line in lines)


def test_it_is_not_installed_over_what_came_first(tmp_path: Path) -> None:
    (tmp_path / "mujoco").mkdir()
    (tmp_path / "mujoco" / "__init__.py").write_text("")
    told = python(
        f"""
        import sys
        sys.path.insert(0, {str(tmp_path)!r})
        import mujoco
        import babybench.mujoco
        try:
            babybench.mujoco.install()
        except RuntimeError as error:
            print(error)
        assert sys.modules["mujoco"] is mujoco
        del sys.modules["mujoco"]
        ours = babybench.mujoco.install()
        import mujoco
        assert mujoco is ours
        babybench.mujoco.uninstall()
        assert "mujoco" not in sys.modules
        babybench.mujoco.uninstall()
        """
    )
    assert "MuJoCo itself was imported already" in told
    assert "before anything imports mujoco" in told


def test_gymnasium_s_renderer_says_what_it_has_not() -> None:
    from babybench_core.mujoco import gymnasium_rendering

    model, data = pair(ALL)
    mujoco.mj_forward(model, data)
    renderer = gymnasium_rendering.MujocoRenderer(model, data, {"distance": 2.0}, 32, 24, camera_name="ca")
    assert renderer.render("rgb_array").shape == (24, 32, 3)
    rgb, depth = renderer.render("rgbd_tuple")
    assert rgb.shape == (24, 32, 3)
    assert 0 < depth.min() < depth.max() <= 1
    with pytest.raises(AttributeError, match="Unexpected mode"):
        renderer.render("other")
    with pytest.raises(NotImplementedError, match="visual_options"):
        gymnasium_rendering.MujocoRenderer(model, data, visual_options={0: True})
    with pytest.raises(AttributeError, match="without OpenGL"):
        gymnasium_rendering.WindowViewer  # noqa: B018
    with pytest.raises(AttributeError, match="without OpenGL"):
        renderer.viewer.add_marker()


BALL = """<mujoco><worldbody>
  <body name='ball' pos='.24 -.04 .8'><freejoint/><geom name='b' size='.025' mass='.5'/></body>
  <body name='arm'><joint name='e' axis='0 1 0' stiffness='.13' springref='-20' armature='.01'/>
    <geom type='capsule' fromto='0 0 0 0 0 .1' size='.02'/>
    <body pos='0 0 .1'><joint type='ball'/><geom size='.03'/></body></body>
  </worldbody></mujoco>"""


def test_constants_follow_masses() -> None:
    model, data = pair(BALL)
    ball, before = (
        model.body("ball").id,
        (model.body_invweight0.copy(), model.dof_invweight0.copy(), model.dof_M0.copy()),
    )
    mujoco.mj_setConst(model, data)
    for name, known in zip(("body_invweight0", "dof_invweight0", "dof_M0"), before):
        assert np.allclose(getattr(model, name), known, rtol=1e-9), f"{name} of the compiler"
    model.body_mass[ball], model.body_inertia[ball] = 0.1, 2 * 0.1 * 0.01**2 / 5
    assert np.allclose(model.body_invweight0, before[0], rtol=1e-9), "nothing follows by itself"
    data.qpos[:3] += 0.01
    mujoco.mj_setConst(model, data)
    assert np.allclose(model.body_invweight0[ball], [10, 250000])
    assert np.allclose(model.dof_M0[:6], [0.1] * 3 + [4e-6] * 3)
    assert model.body_subtreemass[0] == pytest.approx(model.body_mass.sum())
    assert np.allclose(data.qpos, model.qpos_spring), "the positions of the springs"


def test_constants_of_tendons_are_not_computed() -> None:
    model, data = pair(
        BALL.replace("</worldbody>", "</worldbody><tendon><fixed><joint joint='e' coef='1'/></fixed></tendon>")
    )
    model.body_mass[model.body("ball").id] = 0.1
    mujoco.mj_setConst(model, data)
    model.body_mass[model.body("arm").id] *= 2
    with pytest.raises(NotImplementedError, match="1 tendons"):
        mujoco.mj_setConst(model, data)


def test_contacts_are_found_by_themselves() -> None:
    model, data = pair(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    data.qpos[2] = 0.09
    mujoco.mj_collision(model, data)
    assert data.ncon == 1
    assert data.contact[0].dist == pytest.approx(-0.01)
    data.qpos[2] = 0.2
    mujoco.mj_collision(model, data)
    assert data.ncon == 0


def test_enumerations_of_documents_and_windows_are_there() -> None:
    assert int(mujoco.mjtLimited.mjLIMITED_AUTO) == 2
    assert int(mujoco.mjtBuiltin.mjBUILTIN_FLAT) == 3
    assert int(mujoco.mjtTextureRole.mjTEXROLE_RGB) == 1


def test_groups_of_geoms_are_shown_and_hidden() -> None:
    model, data = pair(
        """<mujoco><worldbody><light pos="0 0 3"/><camera name="eye" pos="0 -1 0" xyaxes="1 0 0 0 0 1"/>
        <geom name="wall" type="box" size="1 .01 1" pos="0 1 0"/><geom name="target" size=".2" group="3"/></worldbody></mujoco>"""
    )
    mujoco.mj_forward(model, data)
    option = mujoco.MjvOption()
    assert option.geomgroup.tolist() == [1, 1, 1, 0, 0, 0]
    seen = []
    with mujoco.Renderer(model, 50, 50) as renderer:
        renderer.enable_segmentation_rendering()
        for shown in (0, 1):
            option.geomgroup[3] = shown
            renderer.update_scene(data, camera="eye", scene_option=option)
            seen.append(int((renderer.render()[..., 0] == 1).sum()))
        renderer.update_scene(data, camera="eye")
        assert not (renderer.render()[..., 0] == 1).any()
        option.flags[mujoco.mjtVisFlag.mjVIS_CONTACTPOINT] = 1
        with pytest.raises(ValueError, match=r"flags\[mjVIS_CONTACTPOINT\] is 1"):
            renderer.update_scene(data, camera="eye", scene_option=option)
        mujoco.mjv_defaultOption(option)
        renderer.update_scene(data, camera="eye", scene_option=option)
        with pytest.raises(AttributeError, match="MjvOption has no nonsense"):
            option.nonsense = 1
    assert seen[0] == 0
    assert seen[1] == pytest.approx(474, abs=12)  # 1896 of 100 x 100 pixels in MuJoCo 3.3.0


def test_rays_meet_what_they_may() -> None:
    model, data = pair(
        """<mujoco><worldbody><geom type="box" size="1 1 .1" pos="0 0 -.1"/>
        <body pos="0 0 1"><freejoint/><geom size=".1" group="4"/></body></worldbody></mujoco>"""
    )
    mujoco.mj_forward(model, data)
    found = np.zeros(1, np.int32)
    up, down = np.array([0.0, 0, 2]), np.array([0.0, 0, -1])
    assert mujoco.mj_ray(model, data, up, down, None, 1, -1, found) == pytest.approx(0.9)
    assert found[0] == 1
    assert mujoco.mj_ray(model, data, up, down, None, 1, 1, found) == pytest.approx(2)
    assert mujoco.mj_ray(model, data, up, down, [1, 1, 1, 1, 0, 1], 1, -1, found) == pytest.approx(2)
    assert mujoco.mj_ray(model, data, up, down, None, 0, 1, found) == -1
    assert found[0] == -1
    distances, geoms = np.zeros(2), np.zeros(2, np.int32)
    mujoco.mj_multiRay(model, data, up, np.array([0, 0, -1, 1, 0, 0.0]), None, 1, -1, geoms, distances, 2, 10.0)
    assert (distances.tolist(), geoms.tolist()) == (pytest.approx([0.9, -1]), [1, -1])
    data.qpos[2] = 0.5
    mujoco.mj_kinematics(model, data)
    assert mujoco.mj_ray(model, data, up, down, None, 1, -1, found) == pytest.approx(1.4)
    with pytest.raises(TypeError, match="geomgroup has 2 numbers"):
        mujoco.mj_ray(model, data, up, down, [1, 1], 1, -1, found)


def test_vectors_and_matrices_are_computed() -> None:
    res, matrix = np.zeros(3), np.arange(9.0).reshape(3, 3)
    mujoco.mju_mulMatVec(res, matrix, [1, 0, 2])
    assert res.tolist() == [4, 13, 22]
    mujoco.mju_addToScl3(res, [1, 1, 1], -2)
    assert res.tolist() == [2, 11, 20]
    assert mujoco.mju_dist3([0, 0, 0], [3, 4, 0]) == mujoco.mju_norm3([3, 4, 0]) == 5
    assert (mujoco.mju_clip(3, 0, 1), mujoco.mju_sign(-2), mujoco.mju_dot([1, 2], [3, 4])) == (1, -1, 11)
    with pytest.raises(TypeError, match="mju_add: res has 3 numbers, and the result 2"):
        mujoco.mju_add(res, [1, 2], [3, 4])
