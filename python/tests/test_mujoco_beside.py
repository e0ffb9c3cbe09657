"""``babybench.mujoco`` beside MuJoCo 3.3.0: Gymnasium's environments, compiled arrays, functions. ``.ci/python`` has both."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco_runs
import numpy as np
import pytest
from mujoco_documents import ALL, ARM

from babybench import mujoco as ours

theirs = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
if getattr(theirs, "stands_in", False):
    pytest.skip("MuJoCo is not installed", allow_module_level=True)
gymnasium_assets = pytest.importorskip("gymnasium.envs.mujoco").__path__[0] + "/assets"

DOCUMENTS = {
    "all": ALL,
    "arm": ARM,
    **{path.stem: path.read_text() for path in sorted(Path(gymnasium_assets).glob("*.xml"))},
}
INPUTS = ("qpos", "qvel", "act", "ctrl", "qfrc_applied", "xfrc_applied", "qacc_warmstart")
LEFT_TO_MUJOCO = ("opt", "stat", "vis", "writable")


@pytest.fixture(scope="session")
def repeated(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, float]]:
    """Runs of MuJoCo, repeated on this package in a process of its own."""
    folder = tmp_path_factory.mktemp("runs")
    for name in mujoco_runs.names():
        mujoco_runs.record(name, folder)
    command = [sys.executable, mujoco_runs.__file__, str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1800, check=False)
    assert done.returncode == 0, done.stderr
    told: dict[str, dict[str, float]] = json.loads(done.stdout)
    return told


@pytest.mark.parametrize("name", mujoco_runs.names())
def test_gymnasium_s_environments_see_what_they_see_on_mujoco(name: str, repeated: dict[str, dict[str, float]]) -> None:
    away = repeated[name]
    print(name, away)
    assert away["observations"] < 1e-11  # 3.7e-13, of the 1e-9 that are promised
    assert away["rewards"] < 1e-11
    assert away["terminations"] == 0
    # from the first state alone: no further than runs of MuJoCo that start 1e-12 away
    assert away["over_floor"] < 3


def test_all_of_gymnasium_s_environments_are_there() -> None:
    kinds = {name[:-3] for name in mujoco_runs.names()}
    assert {
        "Ant",
        "HalfCheetah",
        "Hopper",
        "Humanoid",
        "HumanoidStandup",
        "InvertedPendulum",
        "InvertedDoublePendulum",
    } <= kinds
    assert {"Pusher", "Reacher", "Swimmer", "Walker2d"} <= kinds


class Both:
    """A document in both, and states that are kept together."""

    def __init__(self, text: str) -> None:
        self.ours, self.theirs = ours.MjModel.from_xml_string(text), theirs.MjModel.from_xml_string(text)
        self.mine, self.its = ours.MjData(self.ours), theirs.MjData(self.theirs)

    def call(self, function: str, *arguments: Any) -> None:
        getattr(ours, function)(self.ours, self.mine, *arguments)
        getattr(theirs, function)(self.theirs, self.its, *arguments)

    def teach(self) -> None:
        for name in INPUTS:
            getattr(self.mine, name)[:] = getattr(self.its, name)
        self.mine.time = self.its.time

    def compare_arrays(self, limit: float) -> None:
        for name in self.mine._arrays:
            same(name, getattr(self.mine, name), getattr(self.its, name), limit)

    def compare(self, limit: float = 1e-9) -> None:
        self.compare_arrays(limit)
        for name in ("ncon", "nefc", "ne", "nf", "nl"):
            assert getattr(self.mine, name) == getattr(self.its, name), name
        assert self.mine.time == pytest.approx(self.its.time, abs=1e-12)

    def filled(self, function: str, shapes: list[tuple[int, ...]], *arguments: Any) -> None:
        found, expected = ([np.zeros(shape) for shape in shapes] for _ in range(2))
        getattr(ours, function)(self.ours, self.mine, *found, *arguments)
        getattr(theirs, function)(self.theirs, self.its, *expected, *arguments)
        for one, other in zip(found, expected):
            same(f"{function} {arguments}", one, other, 1e-8)


def same(name: str, one: Any, other: Any, limit: float = 1e-9) -> None:
    if not isinstance(other, np.ndarray):
        assert one == other, name
        return
    assert one.shape == other.shape, name
    assert one.dtype == other.dtype, name
    if one.size:
        assert np.abs(one - other).max() <= limit * max(1, np.abs(other).max()), name


@pytest.fixture(params=sorted(DOCUMENTS))
def both(request: pytest.FixtureRequest) -> Both:
    return Both(DOCUMENTS[request.param])


def test_compiled_arrays_are_mujoco_s(both: Both) -> None:
    compared = 0
    for name in dir(both.ours):
        value = getattr(both.ours, name)
        if callable(value) or name in LEFT_TO_MUJOCO:
            continue
        same(name, value, getattr(both.theirs, name))
        compared += 1
    assert compared > 180
    for name in dir(both.ours.opt):
        same(f"opt.{name}", getattr(both.ours.opt, name), getattr(both.theirs.opt, name))
    for name in ("extent", "center", "meaninertia", "meanmass", "meansize"):
        assert getattr(both.ours.stat, name) == pytest.approx(getattr(both.theirs.stat, name), rel=1e-9)
    for name in ("offwidth", "offheight", "fovy", "azimuth", "elevation"):
        assert getattr(both.ours.vis.global_, name) == pytest.approx(getattr(both.theirs.vis.global_, name))
    assert both.ours.vis.map.znear == pytest.approx(both.theirs.vis.map.znear)
    one, other = ours.MjvCamera(), theirs.MjvCamera()
    ours.mjv_defaultFreeCamera(both.ours, one)
    theirs.mjv_defaultFreeCamera(both.theirs, other)
    for name in ("lookat", "distance", "azimuth", "elevation"):
        assert getattr(one, name) == pytest.approx(getattr(other, name)), name


def test_steps_and_their_parts_leave_what_mujoco_leaves(both: Both) -> None:
    rng = np.random.default_rng(0)
    both.compare()
    both.call("mj_forward")
    both.compare()
    for step in range(40):
        both.its.ctrl[:] = rng.uniform(-1, 1, both.theirs.nu)
        if step % 7 == 0:
            both.its.xfrc_applied[1] = rng.normal(size=6)
        both.teach()
        both.call("mj_step", 1 + step % 3)
        both.compare(1e-8)
        if step % 2:
            both.call("mj_rnePostConstraint")
            both.compare(1e-8)
    if both.theirs.opt.integrator == 0:
        for _ in range(10):
            both.teach()
            both.call("mj_step1")
            both.compare(1e-8)
            both.its.ctrl[:] = both.mine.ctrl[:] = rng.uniform(-1, 1, both.theirs.nu)
            both.call("mj_step2")
            both.compare(1e-8)
    both.its.qpos[-1] += 0.01
    both.its.qvel[-1] += 0.1
    both.teach()
    for function in (
        "mj_kinematics",
        "mj_comPos",
        "mj_camlight",
        "mj_tendon",
        "mj_transmission",
        "mj_fwdPosition",
        "mj_comVel",
    ):
        both.call(function)
        if function != "mj_fwdPosition":  # contacts come with it
            both.compare_arrays(1e-8)
        else:
            both.compare(1e-8)
    both.call("mj_resetData")
    both.compare()
    for key in range(both.theirs.nkey):
        both.call("mj_resetDataKeyframe", key)
        both.compare()


def test_functions_compute_what_mujoco_s_do(both: Both) -> None:
    rng = np.random.default_rng(1)
    for _ in range(5):
        both.its.ctrl[:] = rng.uniform(-1, 1, both.theirs.nu)
        both.call("mj_step", 20)
        both.teach()
    both.call("mj_forward")
    nv, point = both.theirs.nv, rng.normal(size=3)
    two: list[tuple[int, ...]] = [(3, nv), (3, nv)]
    for body in range(both.theirs.nbody):
        both.filled("mj_jacBody", two, body)
        both.filled("mj_jacBodyCom", two, body)
        both.filled("mj_jac", two, point, body)
        both.filled("mj_jacDot", two, point, body)
        both.filled("mj_jacPointAxis", two, point, rng.normal(size=3), body)
        if both.theirs.body_subtreemass[body] > 0:
            both.filled("mj_jacSubtreeCom", two[:1], body)
        wrench, (one, other) = rng.normal(size=(2, 3)), np.zeros((2, nv))
        ours.mj_applyFT(both.ours, both.mine, *wrench, point, body, one)
        theirs.mj_applyFT(both.theirs, both.its, *wrench, point, body, other)
        same("mj_applyFT", one, other, 1e-8)
        for kind, local in ((1, 0), (1, 1), (2, 0), (2, 1)):
            one, other = np.zeros((2, 6))
            ours.mj_objectVelocity(both.ours, both.mine, kind, body, one, local)
            theirs.mj_objectVelocity(both.theirs, both.its, kind, body, other, local)
            same("mj_objectVelocity", one, other, 1e-8)
    for kind, count in (("Geom", both.theirs.ngeom), ("Site", both.theirs.nsite)):
        for number in range(count):
            both.filled(f"mj_jac{kind}", two, number)
    inertia, other = np.zeros((2, nv, nv))
    ours.mj_fullM(both.ours, inertia, both.mine.qM)
    theirs.mj_fullM(both.theirs, other, both.its.qM)
    same("mj_fullM", inertia, other)
    for name in ("J", "force", "pos", "type", "id", "margin", "R", "D", "vel", "aref"):
        same(f"efc_{name}", getattr(both.mine, f"efc_{name}"), getattr(both.its, f"efc_{name}"), 1e-7)
    same("ten_J", both.mine.ten_J, both.its.ten_J)
    for spec in (15, 4111, 4064, 8191):
        one, other = np.zeros((2, theirs.mj_stateSize(both.theirs, spec)))
        ours.mj_getState(both.ours, both.mine, one, spec)
        theirs.mj_getState(both.theirs, both.its, other, spec)
        same("mj_getState", one, other, 1e-7)
    fields = (
        "geom1",
        "geom2",
        "geom",
        "dist",
        "pos",
        "frame",
        "dim",
        "friction",
        "solref",
        "solimp",
        "includemargin",
        "mu",
        "exclude",
    )
    for number in range(both.its.ncon):
        one, other = both.mine.contact[number], both.its.contact[number]
        for name in fields:
            assert np.allclose(getattr(one, name), getattr(other, name), atol=1e-8), name
        force, its = np.zeros((2, 6))
        ours.mj_contactForce(both.ours, both.mine, number, force)
        theirs.mj_contactForce(both.theirs, both.its, number, its)
        same("mj_contactForce", force, its, 1e-7)


def test_numbers_written_into_a_model_change_both_alike() -> None:
    names = (
        "body_mass",
        "body_inertia",
        "geom_friction",
        "dof_damping",
        "dof_armature",
        "jnt_stiffness",
        "actuator_gainprm",
        "geom_solref",
    )
    more = ("jnt_pos", "jnt_axis", "jnt_actfrcrange", "wrap_prm", "actuator_length0", "tendon_frictionloss")
    for name in (*names, "geom_size", "body_pos", "qpos_spring", "jnt_range", "dof_frictionloss", *more):
        both = Both(ALL)
        for model in (both.ours, both.theirs):
            getattr(model, name)[...] *= 1.05
            model.opt.timestep, model.opt.gravity[0], model.opt.integrator = 0.003, 0.5, 1
        both.call("mj_resetDataKeyframe", 0)
        for step in range(40):
            both.teach()
            if step == 20:
                both.ours.opt.integrator = both.theirs.opt.integrator = 0
                both.ours.opt.disableflags = both.theirs.opt.disableflags = int(theirs.mjtDisableBit.mjDSBL_EULERDAMP)
            both.its.ctrl[:] = both.mine.ctrl[:] = np.sin(step)
            both.call("mj_step")
            both.compare(1e-8)


def test_flags_and_bits_written_into_a_model_change_both_alike() -> None:
    changes: dict[str, Callable[[Any], Any]] = {
        "geom_contype": lambda bits: bits * 3 % 4,
        "geom_conaffinity": lambda bits: bits * 3 % 4,
        "geom_priority": lambda values: np.arange(len(values)),
        **dict.fromkeys(("tendon_limited", "actuator_ctrllimited", "actuator_forcelimited"), lambda flags: 1 - flags),
        **dict.fromkeys(("body_sameframe", "geom_sameframe", "site_sameframe"), np.zeros_like),
    }
    for name, change in changes.items():
        both = Both(ALL)
        for model in (both.ours, both.theirs):
            getattr(model, name)[...] = change(getattr(model, name))
        both.call("mj_resetDataKeyframe", 0)
        for step in range(40):
            both.teach()
            both.its.ctrl[:] = both.mine.ctrl[:] = np.sin(step)
            both.call("mj_step")
            both.compare(1e-8)


def test_quaternions_are_mujoco_s() -> None:
    rng = np.random.default_rng(2)
    for _ in range(200):
        q, r = rng.normal(size=(2, 4))
        q, r = q / np.linalg.norm(q), r / np.linalg.norm(r)
        v, w = rng.normal(size=(2, 3))
        rotation = np.zeros(9)
        theirs.mju_quat2Mat(rotation, q)
        for name, sizes, arguments in (
            ("mju_mulQuat", (4,), (q, r)),
            ("mju_negQuat", (4,), (q,)),
            ("mju_rotVecQuat", (3,), (v, q)),
            ("mju_axisAngle2Quat", (4,), (v / np.linalg.norm(v), w[0])),
            ("mju_quat2Mat", (9,), (q,)),
            ("mju_mat2Quat", (4,), (rotation,)),
            ("mju_quat2Vel", (3,), (q, 0.3)),
            ("mju_subQuat", (3,), (q, r)),
            ("mju_derivQuat", (4,), (q, v)),
            ("mju_quatZ2Vec", (4,), (v,)),
            ("mju_euler2Quat", (4,), (v, "xYz")),
            ("mju_mulPose", (3, 4), (v, q, w, r)),
            ("mju_negPose", (3, 4), (v, q)),
            ("mju_cross", (3,), (v, w)),
            ("mju_transformSpatial", (6,), (np.concatenate([v, w]), 0, w, v, rotation)),
            ("mju_transformSpatial", (6,), (np.concatenate([v, w]), 1, w, v, rotation)),
        ):
            found, expected = ([np.zeros(size) for size in sizes] for _ in range(2))
            getattr(ours, name)(*found, *arguments)
            getattr(theirs, name)(*expected, *arguments)
            for one, other in zip(found, expected):
                same(name, one, other, 1e-12)
        one, other = q.copy(), q.copy()
        ours.mju_quatIntegrate(one, v, 0.2)
        theirs.mju_quatIntegrate(other, v, 0.2)
        same("mju_quatIntegrate", one, other, 1e-12)


def test_numbers_of_enumerations_are_mujoco_s() -> None:
    from babybench_core.mujoco import enums, more_enums

    assert sorted([*enums.__all__, *more_enums.__all__]) == [name for name in dir(theirs) if name.startswith("mjt")]
    for name in [*enums.__all__, *more_enums.__all__]:
        own = {member: int(value) for member, value in getattr(ours, name).__members__.items()}
        assert own == {member: int(value) for member, value in getattr(theirs, name).__members__.items()}


def test_beside_mujoco_itself_installing_is_refused() -> None:
    with pytest.raises(RuntimeError, match="MuJoCo itself was imported already"):
        ours.install()


@pytest.mark.parametrize("name", ["arm", "half_cheetah", "walker2d"])
def test_constants_are_mujoco_s(name: str) -> None:
    models = [library.MjModel.from_xml_string(DOCUMENTS[name]) for library in (ours, theirs)]
    states = [library.MjData(model) for library, model in zip((ours, theirs), models)]
    for library, model, data in zip((ours, theirs), models, states):
        model.body_mass[1:] *= 1.5
        library.mj_setConst(model, data)
    for array in ("body_invweight0", "dof_invweight0", "dof_M0", "body_subtreemass"):
        assert np.allclose(getattr(models[0], array), getattr(models[1], array), rtol=1e-9), array
    assert np.allclose(states[0].qpos, states[1].qpos)


def test_positions_and_jacobians_of_ball_joints_are_mujoco_s() -> None:
    document = """<mujoco><worldbody><body><freejoint/><geom size=".1"/><body pos=".3 0 0"><joint type="ball"/><geom size=".1"/>
        <body name="tip" pos=".3 0 0"><joint axis="0 1 0"/><geom size=".1"/></body></body></body></worldbody></mujoco>"""
    rng = np.random.default_rng(0)
    for _ in range(5):
        positions, others, velocities = rng.normal(size=12), rng.normal(size=12), rng.normal(size=10)
        results = []
        for mujoco in (theirs, ours):
            model = mujoco.MjModel.from_xml_string(document)
            data, unit, moved = mujoco.MjData(model), positions.copy(), others.copy()
            mujoco.mj_normalizeQuat(model, unit)
            mujoco.mj_normalizeQuat(model, moved)
            difference = np.zeros(model.nv)
            mujoco.mj_differentiatePos(model, difference, 0.1, unit, moved)
            mujoco.mj_integratePos(model, moved, velocities, 0.01)
            data.qpos[:], data.qvel[:] = unit, velocities
            mujoco.mj_forward(model, data)
            rates = np.zeros((2, 3, model.nv))
            mujoco.mj_jacDot(model, data, rates[0], rates[1], np.array([0.1, 0.2, 0.3]), model.body("tip").id)
            results.append(np.concatenate([unit, moved, difference, rates.ravel()]))
        np.testing.assert_allclose(results[1], results[0], atol=1e-12)


def test_the_guide_s_known_faults_are_those_of_mujoco_3_3_0(monkeypatch: pytest.MonkeyPatch) -> None:
    # docs/guide/known-faults.md has the table of conformance/scripts/known_faults.py
    root = Path(__file__).parents[2]
    monkeypatch.syspath_prepend(str(root / "conformance" / "scripts"))
    known_faults = importlib.import_module("known_faults")
    reference, here = known_faults.measured(theirs), known_faults.measured(ours)
    page = (root / "docs" / "guide" / "known-faults.md").read_text("utf-8")
    for name, _ in known_faults.MEASUREMENTS:
        if theirs.__version__ == "3.3.0":
            row = next(line for line in page.splitlines() if line.startswith(f"| {name} |"))
            assert row.split(" | ")[1] == known_faults.cell(reference[name]), row
            # babybench.mujoco has no rays and no vertices of meshes
            if not str(here[name]).startswith("AttributeError"):
                assert known_faults.cell(here[name]) == known_faults.cell(reference[name]), name


def test_rollouts_are_mujoco_s(both: Both) -> None:
    its_rollout = importlib.import_module("mujoco.rollout")
    rng = np.random.default_rng(2)
    full = theirs.mjtState.mjSTATE_FULLPHYSICS
    begin = np.zeros(theirs.mj_stateSize(both.theirs, full))
    theirs.mj_getState(both.theirs, both.its, begin, full)
    begin = np.stack([begin, begin])
    begin[1, 1 + both.theirs.nq : 1 + both.theirs.nq + both.theirs.nv] = 0.1 * rng.normal(size=both.theirs.nv)
    control = rng.uniform(-1, 1, (2, 10, both.theirs.nu))
    mine = ours.rollout.rollout(both.ours, both.mine, begin, control)
    its = its_rollout.rollout(both.theirs, both.its, begin, control)
    for name, one, other in zip(("states", "sensors"), mine, its):
        same(name, one, other, 1e-6)
