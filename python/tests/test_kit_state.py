"""The state and the model that scripts written for the starter kit hold and write to."""

from __future__ import annotations

import copy
import pickle

import mimoEnv.utils as env_utils
import numpy as np
import pytest
from kit_scripts import Make, steps

import mujoco

# --- what scripts hold ---


def test_a_held_state_shows_the_present_and_changes_nothing(make: Make) -> None:
    held, free = make(), make()
    for env in (held, free):
        env.reset()
    data = held.unwrapped.data
    for k, (a, b) in enumerate(zip(steps(held, 8), steps(free, 8))):
        assert all(np.array_equal(a[0][key], b[0][key]) for key in a[0]), k
    core = held.unwrapped._core
    assert np.array_equal(data.qpos, core.engine.state_array("qpos"))
    np.testing.assert_allclose(data.xpos, core.engine.state_array("xpos"), rtol=0, atol=1e-12)
    np.testing.assert_allclose(data.sensordata, core.engine.state_array("sensordata"), rtol=0, atol=1e-9)
    assert data.time == pytest.approx(core.engine.time)


def test_a_state_that_is_first_asked_for_within_an_episode_has_the_contacts_of_that_instant(make: Make) -> None:
    env = make()
    env.reset()
    steps(env, 5)
    contacts = env.unwrapped._core.engine.contacts()
    data = env.unwrapped.data
    assert data.ncon == len(data.contact.geom1) == len(contacts["geom1"]) > 0
    assert np.array_equal(data.contact.geom1, contacts["geom1"])
    np.testing.assert_allclose(data.contact.pos, contacts["pos"], rtol=0, atol=1e-12)
    assert data.contact[0].geom2 == contacts["geom2"][0]
    force = np.zeros(6)
    mujoco.mj_contactForce(env.unwrapped.model, data, 0, force)
    np.testing.assert_allclose(force[:3], contacts["force"][0][:3], rtol=1e-6)


def test_an_array_alone_keeps_the_state_up_to_date(make: Make) -> None:
    env = make()
    env.reset()
    qpos = env.unwrapped.data.qpos
    before = qpos.copy()
    steps(env, 2)
    assert not np.array_equal(qpos, before)
    assert np.array_equal(qpos, env.unwrapped._core.engine.state_array("qpos"))


def test_nobody_pays_for_a_state_that_nobody_holds(make: Make) -> None:
    env = make()
    env.reset()
    assert env.unwrapped.data.ncon >= 0
    live = env.unwrapped._core._live
    refreshed = []
    live.refresh = lambda: refreshed.append(1)
    steps(env, 3)
    assert not refreshed
    held = env.unwrapped._core._live.data
    steps(env, 1)
    assert refreshed
    assert held is not None


def test_contacts_come_when_they_are_asked_for_and_belong_to_the_instant(make: Make) -> None:
    asking, looking = make(), make()
    for env in (asking, looking):
        env.reset()
    always, late = asking.unwrapped.data, looking.unwrapped.data
    found = []
    for k in range(8):
        steps(asking, 1), steps(looking, 1)
        found.append(always.ncon)
        if k >= 5:
            assert late.ncon == always.ncon == len(late.contact.geom1)
            assert np.array_equal(late.contact.geom1, always.contact.geom1)
            assert np.array_equal(late.contact.pos, always.contact.pos)
            for i in range(late.ncon):
                forces = np.zeros(6), np.zeros(6)
                for env, data, force in zip((asking, looking), (always, late), forces):
                    mujoco.mj_contactForce(env.unwrapped.model, data, i, force)
                assert np.array_equal(*forces)
    assert max(found) > 0


def test_asking_for_contacts_leaves_what_a_script_has_written(make: Make) -> None:
    env = make()
    env.reset()
    steps(env, 3)
    u = env.unwrapped
    data = u.data
    elbow = int(u.model.joint("robot:right_elbow").qposadr[0])
    data.qpos[elbow] = -1.25
    data.ctrl[0] = 0.5
    assert data.ncon >= 0
    assert data.qpos[elbow] == -1.25
    assert data.ctrl[0] == 0.5
    mujoco.mj_forward(u.model, data)
    moved = np.array(data.xpos)
    assert data.ncon >= 0
    assert np.array_equal(data.xpos, moved)
    u._get_obs()
    assert u._core.engine.state_array("qpos")[elbow] == -1.25


def test_a_copy_of_the_state_has_its_contacts(make: Make) -> None:
    if getattr(mujoco, "stands_in", False):
        pytest.skip("the stand-in for MjData is no object of its own")
    env = make()
    env.reset()
    steps(env, 3)
    data = env.unwrapped.data
    fresh = copy.copy(data), pickle.loads(pickle.dumps(data))
    assert data.ncon > 0
    for other in fresh:
        assert type(other) is mujoco.MjData
        assert other.ncon == data.ncon
        assert np.array_equal(other.contact.pos, data.contact.pos)
        assert np.array_equal(other.qpos, data.qpos)


def test_what_the_skin_felt_stays_with_who_holds_it(make: Make) -> None:
    env = make()
    env.reset()
    touch, kept = env.unwrapped.touch, []
    for k in range(8):
        observation = steps(env, 1)[0][0]
        outputs = touch.sensor_outputs
        assert touch.sensor_outputs is outputs
        assert np.array_equal(touch.flatten_sensor_dict(outputs).ravel(), observation["touch"])
        for values in outputs.values():
            values += 5  # the next moment is written anew
        if k % 3 == 0:
            body = next(iter(outputs))
            kept.append((outputs[body][:, 1:], outputs[body][:, 1:].copy()))
        del outputs, values
    for held, values in kept:
        assert np.array_equal(held, values)


def test_what_a_script_writes_is_where_the_engine_goes_on(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    elbow = int(u.model.joint("robot:right_elbow").qposadr[0])
    u.data.qpos[elbow] = -1.0
    mujoco.mj_forward(u.model, u.data)
    observation = u._get_obs()
    at = u.proprioception.joint_names.index("robot:right_elbow")
    assert u.proprioception.sensor_outputs["qpos"][at] == -1.0
    assert observation["observation"].shape == env.observation_space["observation"].shape
    env_utils.set_joint_qpos(u.model, u.data, "robot:right_elbow", -1.5)
    env.step(np.zeros(env.action_space.shape, np.float32))
    assert abs(u.data.qpos[elbow] + 1.5) < 0.1
    u.set_state(u.init_qpos, u.init_qvel)
    assert np.array_equal(u.data.qpos, u.init_qpos)


def test_forces_from_outside_act_and_others_are_refused(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    arm = int(u.model.joint("robot:right_shoulder_horizontal").dofadr[0])
    u.data.qfrc_applied[arm] = 2.0
    assert u._core.engine.state_array("qfrc_applied")[arm] == 0.0
    before = u.data.qvel[arm]
    steps(env, 1)
    assert u._core.engine.state_array("qfrc_applied")[arm] == 2.0
    assert u.data.qvel[arm] > before


def test_what_is_written_into_the_model_acts_in_the_next_step(make: Make) -> None:
    plain, env = make(), make()
    for one in (plain, env):
        one.reset(seed=0)
    model, held = env.unwrapped.model, plain.unwrapped.model
    steps(plain, 2), steps(env, 2)

    def height(one: object) -> float:
        steps(one, 20)
        return float(one.unwrapped._core.engine.state_array("subtree_com")[1, 2])

    model.opt.gravity[2] = 9.81
    assert height(env) > height(plain) + 0.01  # a weld holds the hip
    assert list(env.unwrapped._core.engine.model_changes) == ["opt.gravity"]
    model.opt.gravity[:] = held.opt.gravity
    steps(env, 1)
    assert env.unwrapped._core.engine.model_changes == {}
    writes = {
        "body_mass": lambda: model.body_mass.__setitem__(3, 2 * model.body_mass[3]),
        "body_inertia": lambda: model.body_inertia.__imul__(1.1),
        "geom_size": lambda: model.geom_size.__setitem__((1, 0), model.geom_size[1, 0] * 1.01),
        "geom_friction": lambda: setattr(model.geom(1), "friction", [0.3, 0.001, 0.001]),
        "dof_damping": lambda: model.dof_damping.__imul__(2),
        "jnt_stiffness": lambda: setattr(model.joint("robot:right_elbow"), "stiffness", 3.0),
        "dof_armature": lambda: setattr(model.joint("robot:right_elbow"), "armature", 0.01),
        "actuator_gear": lambda: model.actuator_gear.__imul__(1.1),
        "opt.timestep": lambda: setattr(model.opt, "timestep", 0.004),
    }
    for name, write in writes.items():
        write()
        steps(env, 1)
        assert name in env.unwrapped._core.engine.model_changes
    assert set(env.unwrapped._core.engine.model_changes) == set(writes)
    assert env.unwrapped.dt == pytest.approx(0.004)
    copied = pickle.loads(pickle.dumps(env))
    assert copied.unwrapped.model.body_mass[3] == model.body_mass[3]
    for a, b in zip(steps(copied, 3), steps(env, 3)):
        np.testing.assert_array_equal(a[0]["observation"], b[0]["observation"])
    env.reset()
    assert set(env.unwrapped._core.engine.model_changes) == set(writes), "a reset keeps them"


def test_what_the_engine_cannot_take_over_is_refused_at_once(make: Make) -> None:
    env = make()
    env.reset()
    model = env.unwrapped.model
    for name in ("body_ipos", "geom_contype", "geom_condim"):
        with pytest.raises(ValueError, match=r"read-only|cannot be changed here"):
            getattr(model, name)[:] = 0
    model.body_mass[3] = -1
    with pytest.raises(ValueError, match=r"body_mass, number 3, is -1: it must be above 0"):
        steps(env, 1)


def test_joints_are_locked_through_the_model(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    env_utils.lock_joint(u.model, "robot:right_elbow", -1.0)
    env.reset()
    for _ in range(60):
        u.step(np.zeros(env.action_space.shape, np.float32))
    elbow = int(u.model.joint("robot:right_elbow").qposadr[0])
    assert u.data.qpos[elbow] == pytest.approx(-1.0, abs=0.02)
    env_utils.unlock_joint(u.model, "robot:right_elbow")
    env.reset()
    for _ in range(60):
        u.step(np.zeros(env.action_space.shape, np.float32))
    assert abs(u.data.qpos[elbow] + 1.0) > 0.05


def test_elements_are_found_by_name_and_by_number(make: Make) -> None:
    u = make().unwrapped
    model, data = u.model, u.data
    hand = model.body("right_hand").id
    assert mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, hand) == "right_hand"
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "right_hand") == hand
    assert np.array_equal(data.body("right_hand").xpos, data.xpos[hand])
    assert data.body(hand).xmat.shape == (9,)
    with pytest.raises(KeyError, match="Invalid name"):
        model.body("third_hand")
    point = env_utils.body_pos_to_world(data, np.array([[0.0, 0.0, 0.1]]), hand)
    back = env_utils.world_pos_to_body(data, point, hand)
    np.testing.assert_allclose(back, [[0.0, 0.0, 0.1]], atol=1e-12)
    assert hand in env_utils.get_child_bodies(model, model.body("hip").id)
