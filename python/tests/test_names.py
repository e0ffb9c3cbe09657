"""Names of bodies, joints, geoms and sites, and what takes them; pushes."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import SMALL

import babybench

EXTRA = (
    "<body name='caregiver' mocap='true' pos='0 1 1'><geom name='palm' size='.03'/><geom size='.01' pos='.05 0 0'/>"
    "<site name='finger'/></body>"
    "<body name='toy' pos='0 2 1'><freejoint name='toy'/><geom size='.05' mass='1' contype='0' conaffinity='0'/></body>"
)
ROOM = {**SMALL, "scene_extra": EXTRA, "touch_active": False, "frame_skip": 20}


@pytest.fixture(name="room")
def made():
    env = babybench.Env(ROOM)
    env.reset(seed=0)
    return env


def test_names_are_those_of_the_document_by_id(room):
    assert room.body_names[-2:] == ["caregiver", "toy"]
    assert room.joint_names[-1] == "toy"
    assert room.site_names[-1] == "finger"
    assert room.geom_names[-3:] == ["palm", "caregiver 2/2", "toy"]
    assert room.part_names[-3:] == ["caregiver 1/2", "caregiver 2/2", "toy"]
    for names, array in (("body", "xpos"), ("joint", "jnt_range"), ("geom", "geom_xpos"), ("site", "site_xpos")):
        assert len(getattr(room, f"{names}_names")) == len(room.array(array))
    named = [name for name in room.geom_names if name]
    assert len(set(named)) == len(named) == len(room.array("geom_size"))


def test_names_choose_rows(room):
    hand = room.body_names.index("right_hand")
    assert np.array_equal(room.array("xpos", "right_hand"), room.array("xpos")[hand])
    assert room.array("body_mass", "toy") == 1.0
    assert np.array_equal(room.array("geom_xpos", "palm"), room.array("geom_xpos")[-3])
    assert np.array_equal(room.array("site_xpos", "finger"), [0, 1, 1])
    assert room.array("qpos", "toy").tolist() == room.array("qpos")[-7:].tolist()
    assert room.array("qvel", "toy").shape == (6,)
    assert np.ndim(room.array("dof_damping", "robot:right_elbow")[0]) == 0
    with pytest.raises(KeyError, match="did you mean `palm`"):
        room.array("geom_size", "plam")
    with pytest.raises(KeyError, match="did you mean `qpos`"):
        room.array("qpso")
    with pytest.raises(TypeError, match="a row for each element"):
        room.array("opt.gravity", "toy")


def test_every_name_of_a_geom_can_be_changed(room):
    for name in ("palm", "caregiver 1/2", "caregiver 2/2", room.geom_names[5]):
        room.change_model({"geom_friction": {name: [2, 0.1, 0.1]}})
        assert room.array("geom_friction", name).tolist() == [2, 0.1, 0.1]
    room.change_model({"body_mass": {"toy": 2.0}})
    assert room.array("body_mass", "toy") == 2.0


def test_a_mocap_body_is_put_by_name_or_number(room):
    for body in ("caregiver", room.body_names.index("caregiver")):
        room.set_mocap(body, [0.1, 0.2, 0.3])
        room.step(room.action_space.sample() * 0)
        assert room.array("xpos", "caregiver").tolist() == [0.1, 0.2, 0.3]
        room.reset(seed=0)
    with pytest.raises(KeyError, match="did you mean `caregiver`"):
        room.set_mocap("caregivr", [0, 0, 0])


def test_a_push_accelerates_as_newton_says():
    env = babybench.Env({**ROOM, "scene_extra": EXTRA + "<option gravity='0 0 0'/>"})
    for body, point in (("toy", None), (env.body_names.index("toy"), None), ("toy", [0, 2, 1])):
        env.reset(seed=0)
        env.push(body, [1, 0, 0], point=point)
        env.step(env.action_space.sample() * 0)
        np.testing.assert_allclose(env.array("qvel", "toy"), [0.1, 0, 0, 0, 0, 0], rtol=0, atol=1e-12)
    env.push("toy", [0, 0, 0], torque=[0, 0, 0.01])
    env.step(env.action_space.sample() * 0)
    velocity = env.array("qvel", "toy")
    assert velocity[0] == pytest.approx(0.1, abs=1e-12)
    assert velocity[5] == pytest.approx(0.01 * 0.1 / (0.4 * 0.05**2), rel=1e-6)
    env.reset(seed=0)
    assert not env.array("xfrc_applied").any()


def test_pushes_that_are_none_are_refused(room):
    room.push("toy", [1, 0, 0])
    for body, force, error in (
        ("nothing", [1, 0, 0], KeyError),
        (999, [1, 0, 0], KeyError),
        ("toy", [np.nan, 0, 0], ValueError),
    ):
        with pytest.raises(error):
            room.push(body, force)
    assert room.array("xfrc_applied", "toy").tolist() == [1, 0, 0, 0, 0, 0]


@pytest.mark.parametrize(("extra", "place"), [("ball.xml", "1:1"), ("<geom size='.1'/>\n  ball.xml", "2:3")])
def test_text_that_adds_nothing_is_an_error(extra, place):
    with pytest.raises(ValueError, match=f"scene_extra:{place}: .*ball.xml.* adds nothing"):
        babybench.Env({**SMALL, "scene_extra": extra})


def test_messages_name_what_to_use():
    env = babybench.Env(SMALL)
    assert str(env) == repr(env) == "<babybench.Env self_touch in crib>"
    for call, error, message in (
        (lambda: env.proprioception.where("angles", "right_elbow"), KeyError, "did you mean `robot:right_elbow`"),
        (lambda: env.proprioception.where("angels", "right_elbow"), KeyError, "did you mean `angles`"),
        (lambda: babybench.VectorEnv(SMALL, 2, threads=-1), ValueError, "threads is -1, expected at least 0"),
        (lambda: babybench.VectorEnv(SMALL, 2.0), TypeError, "num_envs is 2.0, expected a whole number"),
        (lambda: babybench.VectorEnv(SMALL, 2, autoreset_mode="same_step"), ValueError, "did you mean `SameStep`"),
        (lambda: babybench.VectorEnv(SMALL, 2).reset(seed=[1]), ValueError, "there are 1 seeds"),
        (lambda: babybench.ActionNoise("pink", env, seed=-1), ValueError, "seed is -1"),
        (lambda: babybench.make(5), TypeError, "a mapping, the name of an example"),
        (lambda: babybench.make([{}]), TypeError, "a mapping, the name of an example"),
        (lambda: env.set_goal([1]), ValueError, "has no goals"),
        (lambda: babybench.make(scene="missing.xml"), FileNotFoundError, "missing.xml"),
    ):
        with pytest.raises(error, match=message):
            call()
