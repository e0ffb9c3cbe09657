"""Mistakes raise Python's own exceptions, and nothing hangs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core import _native


@pytest.mark.parametrize(
    ("config", "error", "text"),
    [
        ({"behaviour": "self_touch"}, ValueError, "did you mean `behavior`"),
        ({"scene": "crip"}, ValueError, "did you mean `crib`"),
        ({"frame_skip": 0}, ValueError, "`frame_skip` is 0"),
        ({"frame_skip": -1}, ValueError, "`frame_skip` is -1"),
        ({"frame_skip": 2**70}, ValueError, "`frame_skip`"),
        ({"frame_skip": 10**400}, ValueError, "`frame_skip`"),
        ({"touch_scale": float("nan")}, ValueError, "`touch_scale`"),
        ({"touch_active": "yes"}, ValueError, "`touch_active` is 'yes' in quotes"),
        ({"touch_active": None}, ValueError, "`touch_active` needs a value"),
        ({"touch_active": [True]}, ValueError, "`touch_active` is a list"),
        ({"touch_active": {1}}, TypeError, "`touch_active` is a set"),
        ({1: 2}, TypeError, "is not a str"),
        ({"touch_function": "normal_force"}, ValueError, "compat: reference"),
        ("no_such_file.yml", FileNotFoundError, "no_such_file.yml"),
        (3, TypeError, "int"),
    ],
)
def test_configurations_that_are_not_allowed(config, error, text):
    with pytest.raises(error, match=text):
        babybench.Env(config)


@pytest.mark.parametrize("make", [babybench.Env, babybench.VectorEnv, babybench.make])
def test_a_keyword_that_is_no_key_is_an_unexpected_one(make):
    # TorchRL offers frameskip to every environment, and does without where a TypeError says so
    for config in ("self_touch", SMALL):
        with pytest.raises(
            TypeError, match=r"unexpected keyword argument 'frameskip'.*did you mean `frame_skip`"
        ) as caught:
            make(config, frameskip=1)
        assert isinstance(caught.value, ValueError)  # as the same key in a file is
    with pytest.raises(ValueError, match="did you mean `crib`") as caught:
        make(SMALL, scene="crip")
    assert not isinstance(caught.value, TypeError)


def test_files_name_the_line(tmp_path):
    file = tmp_path / "my.yml"
    file.write_text("behavior: self_touch\nscene: garden\n", "utf-8")
    with pytest.raises(ValueError, match=r"my\.yml:2:8: `scene` is garden"):
        babybench.Env(file)
    file.write_bytes(b"scene: \xff\n")
    with pytest.raises(ValueError, match="UTF-8"):
        babybench.Env(file)


def test_assets_that_are_not_there(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        babybench.Env(SMALL, assets=tmp_path / "nowhere")
    with pytest.raises(ValueError, match="cannot load the scene"):
        babybench.Env(SMALL, assets=tmp_path)


def test_arguments_that_are_not_allowed():
    with pytest.raises(ValueError, match="render_mode is 'ansi'"):
        babybench.Env(SMALL, render_mode="ansi")
    with pytest.raises(ValueError, match="camera is 'kitchen', expected one of"):
        babybench.Env(SMALL, camera="kitchen")


def bad_actions(width):
    good = np.zeros(width, np.float32)
    yield np.zeros(width - 1, np.float32), ValueError, "shape"
    yield np.zeros((width, 1), np.float32), ValueError, "shape"
    yield np.float32(0), ValueError, "shape"
    for number in (np.nan, np.inf, -np.inf):
        broken = good.copy()
        broken[3] = number
        yield broken, ValueError, r"action\[3\]"
    yield "up", ValueError, "could not convert"
    yield ["a"] * width, ValueError, "could not convert"
    yield None, ValueError, "shape"
    yield [object()] * width, TypeError, "float"
    for kind in (np.float32, np.float64):
        yield np.ma.masked_array(good.astype(kind), mask=good == 0), TypeError, r"masked array.*filled\(0\)"
    yield good + 1j, TypeError, "number type complex"
    yield [1j] * width, TypeError, "number type complex"
    yield np.zeros(width, [("torque", "f4")]), TypeError, "real numbers are needed"
    yield np.zeros(width, "datetime64[s]"), TypeError, "real numbers are needed"
    yield np.zeros(width, "timedelta64[s]"), TypeError, "real numbers are needed"


def test_actions_that_are_not_allowed_change_nothing(env):
    before = env.snapshot()
    for action, error, text in bad_actions(env.action_space.shape[0]):
        with pytest.raises(error, match=text):
            env.step(action)
        assert env.snapshot() == before
    envs = babybench.VectorEnv(SMALL, 2)
    with pytest.raises(RuntimeError, match="needs a reset"):
        envs.step(envs.action_space.sample())
    envs.reset(seed=0)
    before = [envs.snapshot(i) for i in range(2)]
    actions = np.zeros(envs.action_space.shape, np.float32)
    actions[1, 3] = np.nan
    with pytest.raises(ValueError, match=r"environment 1: action\[3\]"):
        envs.step(actions)
    for wrong in (actions[:1], actions[0], actions[:, 1:]):
        with pytest.raises(ValueError, match="shape"):
            envs.step(wrong)
    for wrong in (np.ma.masked_array(actions, mask=actions == 0), actions + 1j):
        with pytest.raises(TypeError, match=r"masked array|real numbers"):
            envs.step(wrong)
        with pytest.raises(TypeError, match=r"masked array|real numbers"):
            envs.send(wrong)
    assert before == [envs.snapshot(i) for i in range(2)]


def test_actions_of_any_number_type_are_taken(env):
    twin = babybench.Env(SMALL)
    twin.reset(seed=0)
    action = np.zeros(env.action_space.shape[0], np.float32)
    action[::2] = 1
    expected = twin.step(action)[0]["observation"]
    start = env.snapshot()
    strided = np.zeros(2 * len(action), np.float32)
    strided[::2] = action
    for kind in (action.astype(np.float64), action.astype(int), action.tolist(), strided[::2], action.astype(">f4")):
        env.restore(start)
        np.testing.assert_array_equal(env.step(kind)[0]["observation"], expected)


def test_a_step_needs_a_reset():
    with pytest.raises(RuntimeError, match="call reset before step"):
        babybench.Env(SMALL).step(np.zeros(44))


def test_what_is_closed_says_so(env):
    env.close()
    env.close()
    for call in (env.reset, env.snapshot, lambda: env.step(np.zeros(44)), lambda: env.picture("top")):
        with pytest.raises(RuntimeError, match="environment is closed"):
            call()
    envs = babybench.VectorEnv(SMALL, 2)
    envs.close()
    envs.close()
    for call in (envs.reset, envs.recv, lambda: envs.snapshot(0), lambda: envs.step(np.zeros((2, 44)))):
        with pytest.raises(RuntimeError, match="vector is closed"):
            call()


def test_snapshots_of_something_else(env):
    for bytes_ in (b"", b"nonsense", env.snapshot()[:-3], babybench.make("hand_regard").snapshot()):
        with pytest.raises(ValueError, match="snapshot"):
            env.restore(bytes_)
    damaged = bytearray(env.snapshot())
    damaged[200] ^= 1
    with pytest.raises(ValueError, match="damaged"):
        env.restore(bytes(damaged))


def test_a_scene_that_diverges_says_so_and_can_be_reset(env):
    with pytest.raises((RuntimeError, ValueError), match=r"."):
        env.set_state(env.array("qpos"), np.full(env.array("qvel").shape, 1e12))
    with pytest.raises(RuntimeError, match="reset"):
        env.step(np.zeros(44))
    assert env.observation_space.contains(env.reset(seed=0)[0])


def test_vectors_that_are_not_allowed():
    for number in (0, -1):
        with pytest.raises(ValueError, match="num_envs"):
            babybench.VectorEnv(SMALL, number)
    with pytest.raises(MemoryError, match="use at most"):
        babybench.VectorEnv(SMALL, 10_000, max_memory=10**8)
    with pytest.raises(ValueError, match="at least one environment"):
        _native.VectorEnv([])
    envs = babybench.VectorEnv(SMALL, 2)
    with pytest.raises(TypeError, match="seed is -1"):
        envs.reset(seed=-1)
    with pytest.raises(ValueError, match="seeds"):
        envs.reset(seed=[1, 2, 3])
    envs.reset(seed=0)
    with pytest.raises(IndexError, match="environment 2 does not exist"):
        envs.send(np.zeros((1, 44)), [2])
    envs.send(np.zeros((1, 44)), [1])
    with pytest.raises(RuntimeError, match="environment 1 is in flight"):
        envs.send(np.zeros((1, 44)), [1])
    with pytest.raises(RuntimeError, match="environment 1 is in flight"):
        envs.reset()
    with pytest.raises(RuntimeError, match="environment 1 is in flight"):
        envs.snapshot(1)
    assert envs.recv()[4]["env_id"].tolist() == [1]


def test_threads_step_environments_side_by_side_and_share_none():
    envs = [babybench.Env(SMALL) for _ in range(4)]
    alone = babybench.Env(SMALL)
    results = {}

    def steps(number):
        rng = np.random.default_rng(7)
        envs[number].reset(seed=0)
        results[number] = [envs[number].step(rng.uniform(-1, 1, 44))[0]["touch"].sum() for _ in range(20)]

    threads = [threading.Thread(target=steps, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    rng = np.random.default_rng(7)
    alone.reset(seed=0)
    assert all(results[n] == results[0] for n in range(4))
    assert results[0] == [alone.step(rng.uniform(-1, 1, 44))[0]["touch"].sum() for _ in range(20)]


def test_a_shared_environment_is_refused_or_served_never_broken():
    env = babybench.VectorEnv("hand_regard", 2, vision_resolution=128, threads=1)
    env.reset(seed=0)
    errors = []

    def step():
        for _ in range(10):
            try:
                env.step(np.zeros(env.action_space.shape))
            except RuntimeError as error:  # noqa: PERF203
                errors.append(str(error))

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all("another thread is using the vector" in error for error in errors)
    env.step(np.zeros(env.action_space.shape))


def python(script, **options):
    """Runs a script in a process of its own, which may not take long."""
    command = [sys.executable, "-W", "ignore", "-c", textwrap.dedent(script)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, **options)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_vector_in_a_forked_process_is_refused_and_ends_in_order():
    done = python("""
        import os, numpy as np, babybench
        envs = babybench.VectorEnv("self_touch", 4, threads=2, touch_scale=2.0)
        env = babybench.make("self_touch", touch_scale=2.0)
        eyes = babybench.make("hand_regard", touch_active=False, vision_threads=2)
        eyes.reset(seed=0)
        envs.reset(seed=0)
        envs.step(envs.action_space.sample())
        child = os.fork()
        if child == 0:
            try:
                envs.step(envs.action_space.sample())
            except RuntimeError as error:
                assert "another process" in str(error), error
                env.reset(seed=0)  # one environment has no threads
                env.step(env.action_space.sample())
                alone = babybench.make("hand_regard", touch_active=False)
                seen, sought = [e.reset(seed=1)[0]["eye_right"] for e in (eyes, alone)]  # its thread stayed behind
                assert (seen == sought).all()
                del eyes
                babybench.VectorEnv("self_touch", 2, threads=2, touch_scale=2.0).reset(seed=0)
                del envs
                print("refused", flush=True)
            os._exit(0)
        assert os.waitpid(child, 0)[1] == 0
        envs.step(envs.action_space.sample())
        eyes.step(eyes.action_space.sample())
        print("goes on")
    """)
    assert (done.stdout.split("\n")[:2], done.stderr) == (["refused", "goes on"], "")


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_an_interrupt_in_the_middle_of_a_step_ends_it_in_order():
    script = textwrap.dedent("""
        import signal, numpy as np, babybench
        # a shell starts what runs in the background with this signal ignored
        signal.signal(signal.SIGINT, signal.default_int_handler)
        envs = babybench.VectorEnv("hand_regard", 16, threads=2, frame_skip=5)
        envs.reset(seed=0)
        actions = np.zeros(envs.action_space.shape, np.float32)
        print("ready", flush=True)
        interrupted = False
        for _ in range(100_000):
            try:
                envs.step(actions)
            except KeyboardInterrupt:
                interrupted = True
                break
        observations, *_ = envs.step(actions)
        assert interrupted and all(np.isfinite(rows).all() for rows in observations.values())
        envs.close()
        print("in order")
    """)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        try:
            assert process.communicate(timeout=600)[0] == "in order\n"
        finally:
            process.kill()


def test_a_vector_that_is_dropped_in_flight_ends_its_threads():
    envs = babybench.VectorEnv(SMALL, 4, threads=2)
    envs.reset(seed=0)
    envs.send(np.zeros((4, 44)))
    del envs


def test_examples_and_joints_that_may_be_meant(env):
    with pytest.raises(FileNotFoundError, match="did you mean `self_touch`"):
        babybench.make("selftouch")
    for lock in (env.lock, babybench.VectorEnv(SMALL, num_envs=2).__getattribute__("lock")):
        target = () if lock == env.lock else (1,)
        with pytest.raises(KeyError, match='no joint "right_elbow"; did you mean `robot:right_elbow`'):
            lock(*target, "right_elbow", -1.0)
    with pytest.raises(KeyError, match="did you mean `head`"):
        env.unlock("headd")
    with pytest.raises(KeyError, match=r"no joint \"999\"'?$"):
        env.lock(999)


def test_an_angle_out_of_range_is_said(env):
    with pytest.warns(
        UserWarning, match=r"locked at -10.0 rad, beyond the limits of robot:right_elbow \(-2.55 to 0.0873\)"
    ):
        assert env.lock("robot:right_elbow", -10.0)["beyond_limits"] == ["robot:right_elbow"]
    envs = babybench.VectorEnv(SMALL, num_envs=2)
    with pytest.warns(UserWarning, match="beyond the limits of robot:right_elbow"):
        envs.lock(1, "robot:right_elbow", 1.0)


@pytest.mark.parametrize(
    ("attribute", "instead"),
    [
        ("data", r"env\.array\('qpos'\)"),
        ("model", r"env\.array\('jnt_range'\)"),
        ("mujoco_renderer", r"env\.picture\("),
        ("init_qpos", r"env\.reset\(\)"),
        ("touch.sensor_outputs", r"env\.touch\.of\(body\)"),
        ("touch.get_contacts", r"env\.touch\.contacts\(\)"),
        ("proprioception.sensor_outputs", r"env\.proprioception\.slices"),
        ("compute_reward", "has no goals"),
        ("nonsense", "'Env' object has no attribute 'nonsense'"),
        ("touch.nonsense", "'Touch' object has no attribute 'nonsense'"),
    ],
)
def test_attributes_of_the_starter_kit_name_what_to_use(env, attribute, instead):
    *path, name = attribute.split(".")
    owner = env if not path else getattr(env, path[0])
    assert not hasattr(owner, name)
    with pytest.raises(AttributeError, match=instead):
        getattr(owner, name)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no timers of processes")
@pytest.mark.parametrize("many", [False, True])
def test_a_long_run_heeds_ctrl_c(many):
    endless = {**SMALL, "max_episode_steps": 1_000_000_000}
    steps = 200_000
    if many:
        envs = babybench.VectorEnv(endless, num_envs=2)
        envs.reset(seed=0)
        core, shape = envs._core, (steps, 2, envs.single_action_space.shape[0])
    else:
        env = babybench.Env(endless)
        env.reset(seed=0)
        core, shape = env._core, (steps, env.action_space.shape[0])
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    actions = np.zeros(shape, np.float32)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            core.run(actions)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    done = (core.info(1) if many else core.info())["steps"]
    assert 0 < done < steps  # it was not heard at the end only
