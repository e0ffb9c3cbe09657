"""One environment: what it returns, its moments, its senses."""

from __future__ import annotations

import copy
import gc
import pickle
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import SEEING, SMALL
from gymnasium.utils.env_checker import check_env

import babybench


def run(env, steps, seed=0):
    """Steps with random actions of a seed; returns everything that was seen."""
    rng = np.random.default_rng(seed)
    low, high = env.action_space.low, env.action_space.high
    return [env.step(rng.uniform(low, high).astype(np.float32)) for _ in range(steps)]


def same(one, other):
    """Whether two runs have the same bits."""
    assert len(one) == len(other)
    for (a, *flags_a, info_a), (b, *flags_b, info_b) in zip(one, other):
        assert a.keys() == b.keys()
        for key in a:
            np.testing.assert_array_equal(a[key], b[key], err_msg=key, strict=True)
        assert (flags_a, info_a) == (flags_b, info_b)
    return True


def test_observations_are_in_their_space_and_fresh(env):
    first, *_ = env.step(env.action_space.sample())
    kept = {key: value.copy() for key, value in first.items()}
    assert list(first) == ["observation", "touch", "vestibular"]
    second, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert (reward, terminated, truncated, info["steps"]) == (0.0, False, False, 2)
    for key, space in env.observation_space.items():
        assert space.contains(second[key])
        assert not np.shares_memory(first[key], second[key])
        np.testing.assert_array_equal(first[key], kept[key])
    assert not np.array_equal(first["observation"], second["observation"])


def test_an_episode_is_truncated_and_its_seed_repeats_it(env):
    once = run(env, 6)
    assert [step[3] for step in once] == [False] * 5 + [True]
    env.reset(seed=0)
    assert same(once, run(env, 6))
    env.reset(seed=1)
    assert not np.array_equal(once[0][0]["observation"], run(env, 1)[0][0]["observation"])


def test_views_are_the_same_numbers_without_copies():
    fresh, views = babybench.Env(SMALL), babybench.Env(SMALL, views=True)
    first, _ = views.reset(seed=0)
    assert np.array_equal(first["touch"], fresh.reset(seed=0)[0]["touch"])
    for _ in range(4):
        action = fresh.action_space.sample()
        a, b = fresh.step(action)[0], views.step(action)[0]
        assert b["touch"] is first["touch"]
        for key in a:
            np.testing.assert_array_equal(a[key], b[key], strict=True)
    with pytest.raises(ValueError, match="read-only"):
        first["touch"][0] = 1


@pytest.mark.parametrize("config", [SMALL, SEEING], ids=["self_touch", "hand_regard"])
def test_snapshots_pickles_and_copies_go_on_with_the_same_bits(config):
    env = babybench.Env(config)
    env.reset(seed=3)
    run(env, 2)
    env.lock("head", 0.1)
    snapshot, pickled, copied = env.snapshot(), pickle.dumps(env), copy.deepcopy(env)
    once = run(env, 2, seed=9)
    env.restore(snapshot)
    assert same(once, run(env, 2, seed=9))
    assert same(once, run(copied, 2, seed=9))
    loaded = pickle.loads(pickled)
    assert same(once, run(loaded, 2, seed=9))
    # the generator goes on as well
    for one in (env, copied, loaded):
        one.reset()
    assert same(run(env, 1), run(copied, 1))
    assert len(pickled) < 100_000


def test_a_closed_environment_stays_closed_when_pickled(env):
    env.close()
    loaded = pickle.loads(pickle.dumps(env))
    with pytest.raises(RuntimeError, match="closed"):
        loaded.reset()


def test_configurations_are_files_mappings_examples_and_keywords(tmp_path):
    file = tmp_path / "my.yml"
    file.write_text("behavior: hand_regard\nscene: cubes\ntouch_active: False\nvision_resolution: 16\n", "utf-8")
    for config in (str(file), file):
        env = babybench.make(config, vision_resolution=8)
        assert (env.config["scene"], env.config["vision_resolution"]) == ("cubes", 8)
        assert env.reset()[0]["eye_left"].shape == (8, 8, 3)
    assert babybench.make({"save_dir": Path("somewhere")}, touch_scale=np.float64(2)).config["save_dir"] == "somewhere"
    behaviors = {"self_touch", "hand_regard", "test_installation"}
    tasks = {"reach", "standup", "selfbody", "catch", "roll_over", "mobile", "play"}
    assert set(babybench.config_examples()) == behaviors | tasks
    assert babybench.config_keys()["compat"]["choices"] == ["api", "reference"]


def test_environments_of_one_configuration_share_its_scene():
    one, other = babybench.Env(SMALL), babybench.Env(SMALL)
    from babybench_core import scenes

    before = len(scenes._shared)
    third = babybench.Env(SMALL)
    assert len(scenes._shared) == before
    del one, other, third
    gc.collect()
    assert len(scenes._shared) < before


def test_every_number_has_a_name(env):
    names = env.proprioception.names
    assert len(names) == len(set(names)) == env.observation_space["observation"].shape[0]
    slices = env.proprioception.slices
    assert list(slices) == ["angles", "velocities", "torques", "limits", "actuation"]
    assert slices["actuation"].stop == len(names)
    elbow = env.proprioception.where("angles", "robot:right_elbow")
    assert names[elbow] == ["angles robot:right_elbow"]
    joints = env._core.blueprint.model_names["joint"]
    place = env.array("jnt_qposadr")[joints.index("robot:right_elbow")]
    observation, *_ = env.step(env.action_space.sample())
    assert observation["observation"][elbow][0] == env.array("qpos")[place]
    assert len(env.touch.names) == env.observation_space["touch"].shape[0]
    assert len(env.actuator_names) == env.action_space.shape[0]
    with pytest.raises(KeyError, match="no 'knee'"):
        env.proprioception.where("angles", "knee")


def test_touch_is_sparse_by_body_and_in_the_world(env):
    for _ in range(3):
        observation, *_ = env.step(env.action_space.sample())
    touch, width = env.touch, env.touch.width
    sensors, forces = touch.sparse()
    assert len(sensors) > 0
    dense = np.zeros((touch.sensors, width), np.float32)
    dense[sensors] = forces
    np.testing.assert_array_equal(dense.ravel(), observation["touch"])
    for body in touch.bodies:
        np.testing.assert_array_equal(touch.of(body).ravel(), observation["touch"][touch.slices[body]])
        assert touch.positions[body].shape == (len(touch.of(body)), 3)
    assert touch.world_positions().shape == (touch.sensors, 3)
    # a sensor that feels is near a contact
    points = touch.contacts()["point"]
    at = touch.world_positions()[sensors[np.abs(forces).sum(1) > 0]]
    nearest = np.linalg.norm(at[:, None] - points[None], axis=-1).min(1)
    assert nearest.max() < 0.2
    with pytest.raises(KeyError, match="no touch sensors"):
        touch.of("world")


def test_information_names_what_was_touched():
    env = babybench.make("self_touch")
    env.reset(seed=0)
    rng = np.random.default_rng(0)
    for _ in range(15):
        action = rng.choice([-1.0, 1.0], env.action_space.shape)  # held for a while, so that hands get somewhere
        for _ in range(40):
            *_, info = env.step(action)
    touched = info["right_hand_touches"] + info["left_hand_touches"]
    names = info["right_hand_parts"] + info["left_hand_parts"]
    assert "head" in names
    assert names == [env.part_names[geom] for geom in touched]


def test_pictures_depth_and_segmentation_show_one_scene():
    env = babybench.Env(SEEING, render_mode="rgb_array")
    observation, info = env.reset(seed=0)
    assert set(info) == {"steps", "page_regards", "kit_regards", *babybench_regards()}
    assert list(info["page_regards"]) == list(info["kit_regards"]) == babybench_regards()
    assert env.render().shape == (48, 48, 3)
    np.testing.assert_array_equal(env.picture("eye_left", 16, 16), observation["eye_left"])
    depth, geoms = env.depth("closeup", 40, 30), env.segmentation("closeup", 40, 30)
    assert depth.shape == geoms.shape == (30, 40)
    assert np.isfinite(depth[geoms >= 0]).all()
    assert geoms.max() < len(env.geom_names)
    *_, info = env.step(env.action_space.sample())
    assert set(info["gaze_angles"]) == set(babybench_regards())
    assert babybench.Env(SEEING, render_mode="depth_array").metadata["render_fps"] == 200
    with pytest.raises(KeyError, match="camera"):
        env.picture("kitchen", 10, 10)


@pytest.mark.parametrize("views", [False, True])
def test_eyes_see_depth_and_geoms_on_request(views):
    config = {**SEEING, "vision_outputs": ["rgb", "gray", "depth", "segmentation"]}
    env, envs = babybench.Env(config, views=views), babybench.VectorEnv(config, 2, copy=not views)
    env.reset(seed=0)
    envs.reset(seed=0)
    action = env.action_space.sample()
    observation, *_ = env.step(action)
    rows, *_ = envs.step(np.stack([action, action]))
    assert set(observation) == set(rows) == set(env.observation_space)
    assert env.observation_space.contains(dict(observation))
    for key, value in observation.items():
        np.testing.assert_array_equal(rows[key][0], value, err_msg=key, strict=True)
    np.testing.assert_array_equal(observation["eye_left_depth"], env.depth("eye_left", 16, 16))
    np.testing.assert_array_equal(observation["eye_right_segmentation"], env.segmentation("eye_right", 16, 16))


def babybench_regards():
    return [f"{eye}_eye_{hand}_hand" for eye in ("right", "left") for hand in ("right", "left")]


def test_a_lock_holds_a_joint(env):
    place = env.proprioception.where("angles", "robot:right_elbow")
    report = env.lock("robot:right_elbow", -1.0)
    assert report["changed"] == ["robot:right_elbow"]
    for _ in range(60):
        observation, *_ = env.step(env.action_space.sample())
    assert abs(observation["observation"][place][0] + 1.0) < 0.1
    assert env.unlock("robot:right_elbow")["changed"] == ["robot:right_elbow"]
    with pytest.raises(KeyError, match="no joint"):
        env.lock("elbow")


def test_a_state_can_be_set(env):
    qpos, qvel = env.array("qpos"), env.array("qvel")
    qpos[-1] += 0.05
    observation = env.set_state(qpos, qvel)
    np.testing.assert_array_equal(env.array("qpos"), qpos)
    assert env.observation_space.contains(observation)
    with pytest.raises(ValueError, match="shape"):
        env.set_state(qpos[1:], qvel)


def test_steps_leave_no_references_behind(env):
    action = env.action_space.sample()
    env.step(action)
    gc.collect()
    before = sys.getrefcount(action), len(gc.get_objects())
    for _ in range(200):
        env.step(action)
    gc.collect()
    assert sys.getrefcount(action) == before[0]
    assert len(gc.get_objects()) < before[1] + 50


def test_muscles_and_servos_have_their_own_actions():
    muscles = babybench.Env(SMALL, actuation_model="muscle")
    servos = babybench.Env(SMALL, actuation_model="positional")
    motors = babybench.Env(SMALL)
    assert muscles.action_space.shape[0] == 2 * motors.action_space.shape[0]
    assert (muscles.action_space.low == 0).all()
    for env in (muscles, servos):
        env.reset(seed=0)
        assert env.observation_space.contains(env.step(env.action_space.sample())[0])


ROOM = """<mujoco>
  <include file="mimo_settings.xml"/>
  <include file="mimo_actuators.xml"/>
  <worldbody>
    <geom type="plane" size="2 2 0.1"/>
    <body name="mimo_location" pos="0 0 0.1" euler="0 -90 0">
      <freejoint/>
      <include file="mimo.xml"/>
    </body>
    <body name="left_ffdistal" pos="0.5 0.5 0.1"><freejoint/><geom name="toy" size="0.05"/></body>
  </worldbody>
</mujoco>
"""


def test_a_scene_may_be_a_room_of_ones_own(tmp_path, monkeypatch):
    (tmp_path / "nursery").mkdir()
    (tmp_path / "nursery" / "room.xml").write_text(ROOM)
    config = tmp_path / "room.yml"
    config.write_text("scene: nursery/room.xml\nvision_active: false\ntouch_scale: 3\n")
    in_file = babybench.make(config)
    monkeypatch.chdir(tmp_path)
    by_key = babybench.make(SMALL, scene="nursery/room.xml")
    bare = babybench.make(SMALL)
    assert by_key.action_space == bare.action_space
    assert by_key.observation_space == bare.observation_space
    assert by_key.config["scene"] == "nursery/room.xml"
    assert in_file.config["scene"] == str(tmp_path / "nursery" / "room.xml")
    for env in (in_file, by_key):
        observation, _ = env.reset(seed=0)
        assert env.observation_space.contains(observation)
        env.step(env.action_space.sample())
    (tmp_path / "nursery" / "room.xml").write_text(ROOM.replace("mimo_settings", "mimo_setup"))
    with pytest.raises(ValueError, match=r"room\.xml:2:3: .*mimo_setup\.xml.* does not exist"):
        babybench.make(config)


def test_the_model_is_changed_for_this_and_for_later_episodes():
    plain, moon = babybench.Env(SMALL), babybench.Env(SMALL)
    for env in (plain, moon):
        env.reset(seed=0)
    moon.change_model({"opt.gravity": [0, 0, 3.0], "body_mass": {"head": 2.0}})
    assert moon.array("opt.gravity").tolist() == [0, 0, 3.0]
    assert np.count_nonzero(moon.array("body_mass") != plain.array("body_mass")) == 1
    run(plain, 30), run(moon, 30)
    assert moon.array("subtree_com")[1, 2] > plain.array("subtree_com")[1, 2] + 0.01  # a weld holds the hip
    copied = pickle.loads(pickle.dumps(moon))
    assert same(run(copied, 3), run(moon, 3))
    original = {name: plain.array(name) for name in ("opt.gravity", "body_mass")}
    moon.reset(seed=4, options={"model": original})
    plain.reset(seed=4)
    assert same(run(plain, 5), run(moon, 5))
    moon.reset(options={"model": {"opt.timestep": 0.004, "dof_damping": {"robot:right_elbow": 3.0}}})
    assert moon.dt == 0.004
    with pytest.raises(ValueError, match=r"model.dof_damping was another one; model.opt.timestep"):
        plain.restore(moon.snapshot())


@pytest.mark.parametrize(
    ("changes", "error", "match"),
    [
        ({"body_mas": 1}, KeyError, "nothing of the model that can change is called .*body_mas"),
        ({"body_ipos": np.zeros((3, 3))}, KeyError, "nothing of the model that can change is called"),
        ({"body_mass": [1.0, 2.0]}, ValueError, r"body_mass has the shape \(2,\)"),
        ({"body_mass": {"haed": 1.0}}, KeyError, "there is no body 'haed'; did you mean `head`"),
        ({"body_mass": {"head": [1.0, 2.0]}}, ValueError, "'head' has numbers of the shape"),
        ({"opt.gravity": {"head": 1.0}}, TypeError, "not an array with a row for each element"),
        ({"opt.timestep": 0.0}, ValueError, "opt.timestep, number 0, is 0: it must be above 0"),
        ({"opt.gravity": [0, 0, np.inf]}, ValueError, "opt.gravity, number 2, is inf"),
        ({"opt.gravity": np.zeros(3) + 1j}, TypeError, "real numbers are needed"),
        ([1], TypeError, "expected a mapping"),
        ({3: 1}, TypeError, "3 is not the name"),
    ],
)
def test_changes_of_the_model_that_are_none(env, changes, error, match):
    before = env.snapshot()
    with pytest.raises(error, match=match):
        env.change_model(changes)
    with pytest.raises(error, match=match):
        env.reset(options={"model": changes})
    assert env.snapshot() == before


@pytest.mark.parametrize("views", [False, True])
def test_eyes_are_drawn_for_those_who_ask(views):
    keys = {"vision_resolution": 16, "vision_outputs": ["rgb", "depth"], "touch_scale": 4}
    every = babybench.make("test_installation", **keys)
    some = babybench.make("test_installation", views=views, vision_lazy=True, **keys)
    images = ["eye_left", "eye_right", "eye_left_depth", "eye_right_depth"]
    assert [key for key in every.observation_space.spaces if key not in some.observation_space.spaces] == sorted(images)
    whole, _ = every.reset(seed=3)
    blind, _ = some.reset(seed=3)
    for step in range(9):
        assert blind in some.observation_space
        if step % 3 == 0:
            seen = some.eyes()
            assert list(seen) == images
            for key, image in {**blind, **seen, **some.eyes()}.items():
                np.testing.assert_array_equal(image, whole[key], err_msg=f"{key} of step {step}")
        for key, array in every.eyes().items():
            np.testing.assert_array_equal(array, whole[key])
        action = every.action_space.sample()
        whole, blind = every.step(action)[0], some.step(action)[0]
    assert some.snapshot() == every.snapshot()


@pytest.mark.filterwarnings("ignore:.*infinity. This is probably too")
def test_a_restored_environment_has_no_picture_to_draw():
    env = babybench.make("test_installation", vision_lazy=True, touch_active=False)
    env.reset(seed=0)
    env.restore(env.snapshot())
    assert env.eyes() == {}
    env.step(env.action_space.sample())
    assert set(env.eyes()) == {"eye_left", "eye_right"}
    check_env(env, skip_render_check=True)


HAND = "<body name='hand' mocap='true' pos='.4 0 .4'><geom size='.04'/></body>"


def test_a_body_follows_its_path_or_is_put_somewhere():
    path = "time,hand.x,hand.y,hand.z\n0,1,0,1\n0.5,2,0,1\n"
    for motion in (path, ""):
        env = babybench.Env({**SMALL, "behavior": "none", "scene_extra": HAND, "mocap_motion": motion})
        env.reset(seed=0)
        env.set_mocap("hand", [0.1, 0.2, 0.3])
        env.step(np.zeros(env.action_space.shape))
        x, y, z = env.array("mocap_pos").reshape(-1)
        if motion:
            assert 1.0 <= x < 1.2
            assert (y, z) == (0.0, 1.0)
        else:
            assert (x, y, z) == (0.1, 0.2, 0.3)
    with pytest.raises(KeyError, match="nobody"):
        env.set_mocap("nobody", [0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="line 1"):
        babybench.Env({**SMALL, "mocap_motion": path})
