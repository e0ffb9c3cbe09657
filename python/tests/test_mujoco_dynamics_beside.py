"""Energies, inverse dynamics, distances, derivatives and arithmetic of ``babybench.mujoco`` beside MuJoCo 3.3.0."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mujoco_all_names
import numpy as np
import pytest
from mujoco_documents import ALL, ARM

from babybench import mujoco as ours

theirs = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
if getattr(theirs, "stands_in", False):
    pytest.skip("MuJoCo is not installed", allow_module_level=True)
ASSETS = Path(pytest.importorskip("gymnasium.envs.mujoco").__path__[0]) / "assets"

CONES = """<mujoco><option cone="elliptic" impratio="2"/><worldbody><geom type="plane" size="1 1 1"/>
<body pos="0 0 .11"><freejoint/><geom type="box" size=".1 .1 .1"/></body>
<body pos=".5 0 .3"><joint type="ball" stiffness="3" damping=".1"/>
<geom type="capsule" size=".05 .1"/></body></worldbody></mujoco>"""
SHAPES = """<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1 1 1 1"/>
<hfield name="h" nrow="2" ncol="3" size="1 1 .2 .1" elevation="0 1 2 3 4 5"/></asset>
<worldbody><geom type="hfield" hfield="h"/><body><freejoint/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""
DOCUMENTS = {"all": ALL, "arm": ARM, "cones": CONES} | {
    name: (ASSETS / f"{name}.xml").read_text() for name in ("humanoid", "ant", "half_cheetah", "pusher")
}
INPUTS = ("qpos", "qvel", "act", "ctrl", "qfrc_applied", "xfrc_applied", "qacc_warmstart")


def apart(one: Any, other: Any) -> float:
    one, other = np.asarray(one, np.float64), np.asarray(other, np.float64)
    assert one.shape == other.shape
    return float(np.abs(one - other).max() / max(1, np.abs(other).max())) if one.size else 0.0


class Both:
    """Both modules, each with its model and a state."""

    def __init__(self, text: str, steps: int = 30) -> None:
        self.sides = []
        for module in (ours, theirs):
            model = module.MjModel.from_xml_string(text)
            self.sides.append((module, model, module.MjData(model)))
        _, (_, model, data) = self.sides
        rng = np.random.default_rng(0)
        data.qvel[:] = 0.3 * rng.normal(size=model.nv)
        for _ in range(steps):
            data.ctrl[:] = rng.uniform(-1, 1, model.nu)
            theirs.mj_step(model, data)
        self.teach()

    def teach(self) -> None:
        (_, _, mine), (_, _, its) = self.sides
        for name in INPUTS:
            getattr(mine, name)[:] = getattr(its, name)

    def call(self, name: str, *arguments: Any) -> list[Any]:
        return [getattr(module, name)(model, data, *arguments) for module, model, data in self.sides]

    def apart(self, field: str) -> float:
        return apart(*(getattr(data, field) for _, _, data in self.sides))


@pytest.fixture(params=sorted(DOCUMENTS))
def both(request: pytest.FixtureRequest) -> Both:
    return Both(DOCUMENTS[request.param])


def test_the_list_of_names_is_that_of_mujoco() -> None:
    # parts that are there once something has imported them
    parts = {"rollout", "viewer"}
    assert set(mujoco_all_names.names()) - parts == {name for name in dir(theirs) if not name.startswith("_")} - parts


def test_energies_and_subtrees(both: Both) -> None:
    for name in ("mj_forward", "mj_energyPos", "mj_energyVel", "mj_subtreeVel"):
        both.call(name)
    for field in ("energy", "subtree_linvel", "subtree_angmom"):
        assert both.apart(field) < 1e-12, field


def test_the_flag_of_energies_computes_them_in_each_step() -> None:
    both = Both(ALL)
    for _, model, _ in both.sides:
        model.opt.enableflags |= int(theirs.mjtEnableBit.mjENBL_ENERGY)
    for _ in range(3):
        both.teach()
        both.call("mj_step", 3)
        assert both.apart("energy") < 1e-10


def test_inverse_dynamics(both: Both) -> None:
    both.call("mj_forward")
    rng = np.random.default_rng(1)
    for scale in (0.0, 1.0, 30.0):
        acceleration = both.sides[1][2].qacc + scale * rng.normal(size=both.sides[1][1].nv)
        for _, _, data in both.sides:
            data.qacc[:] = acceleration
        both.call("mj_inverse")
        assert both.apart("qfrc_inverse") < 1e-10
        assert both.apart("qfrc_constraint") < 1e-10
        for flag in (0, 1):
            found = [np.zeros(model.nv) for _, model, _ in both.sides]
            for (module, model, data), result in zip(both.sides, found):
                module.mj_rne(model, data, flag, result)
            assert apart(*found) < 1e-10
    both.call("mj_forward")
    both.call("mj_compareFwdInv")
    assert np.abs(both.sides[0][2].solver_fwdinv - both.sides[1][2].solver_fwdinv).max() < 1e-5


def test_parts_of_the_dynamics(both: Both) -> None:
    both.call("mj_forward")
    _, model, data = both.sides[1]
    data.ctrl[:] = both.sides[0][2].ctrl[:] = 0.5
    for name, fields in {
        "mj_fwdActuation": ("actuator_force", "qfrc_actuator", "act_dot"),
        "mj_fwdAcceleration": ("qfrc_smooth", "qacc_smooth", "qacc"),
        "mj_fwdConstraint": ("qacc", "qfrc_constraint"),
        "mj_passive": ("qfrc_passive", "qfrc_bias"),
    }.items():
        both.call(name)
        for field in fields:
            assert both.apart(field) < 1e-6, (name, field)
    assert ours.mj_isSparse(both.sides[0][1]) == theirs.mj_isSparse(model)
    assert ours.mj_isDual(both.sides[0][1]) == theirs.mj_isDual(model)
    vector = np.random.default_rng(3).normal(size=model.nv)
    results = [np.zeros(data.nefc) for data in (both.sides[0][2], data)]
    for (module, own, state), result in zip(both.sides, results):
        module.mj_mulJacVec(own, state, result, vector)
    assert apart(*results) < 1e-9


def test_distances_of_geoms(both: Both) -> None:
    both.call("mj_forward")
    (_, m, d), (_, model, data) = both.sides
    for first in range(model.ngeom):
        for second in range(model.ngeom):
            if first == second or {int(model.geom_type[first]), int(model.geom_type[second])} == {0}:
                continue
            points, expected = np.zeros(6), np.zeros(6)
            one = ours.mj_geomDistance(m, d, first, second, 2.0, points)
            assert one == pytest.approx(theirs.mj_geomDistance(model, data, first, second, 2.0, expected), abs=1e-12)
            assert apart(points, expected) < 1e-12
    with pytest.raises(ValueError, match="geom 99 does not exist"):
        ours.mj_geomDistance(m, d, 99, 0, 1.0, None)


@pytest.mark.parametrize("name", ["all", "arm", "half_cheetah"])
@pytest.mark.parametrize("centered", [0, 1])
def test_derivatives_of_steps(name: str, centered: int) -> None:
    both = Both(DOCUMENTS[name])
    both.call("mj_forward")
    found = []
    for module, model, data in both.sides:
        states = 2 * model.nv + model.na
        shapes = ((states, states), (states, model.nu), (model.nsensordata, states), (model.nsensordata, model.nu))
        matrices = [np.zeros(shape) for shape in shapes]
        module.mjd_transitionFD(model, data, 1e-6, centered, *matrices)
        inverse = [np.zeros((model.nv, model.nv)) for _ in range(3)]
        module.mj_forward(model, data)
        module.mjd_inverseFD(model, data, 1e-6, 0, *inverse, None, None, None, None)
        found.append([*matrices, *inverse])
    for one, other in zip(*found):
        assert apart(one, other) < 1e-6  # rounding over a difference of 1e-6


def test_halves_of_a_step_from_other_positions_advance_them_as_mujoco_does() -> None:
    both = Both(CONES)
    both.call("mj_step1")
    for _, _, data in both.sides:
        data.qpos[2] += 0.01
        data.qvel[3] += 0.1
    both.call("mj_step2")
    for field in ("qpos", "qvel"):
        assert both.apart(field) < 1e-8, field
    both.call("mj_step1")
    both.call("mj_step2")
    for field in ("qpos", "qvel", "xpos"):
        assert both.apart(field) < 1e-8, field


def test_arrays_of_meshes_and_height_fields() -> None:
    mine, its = ours.MjModel.from_xml_string(SHAPES), theirs.MjModel.from_xml_string(SHAPES)
    compared = 0
    for name in dir(mine):
        if name.startswith(("mesh_", "hfield_", "name", "nmesh", "nhfield")) and not callable(getattr(mine, name)):
            one, other = getattr(mine, name), getattr(its, name)
            if isinstance(other, np.ndarray):
                assert one.dtype == other.dtype, name
                assert apart(one, other) < 1e-7, name
            else:
                assert one == other, name
            compared += 1
    assert compared > 40


def test_geoms_of_scenes() -> None:
    size, pos, turn, rgba = [0.1, 0.2, 0.3], [1, 2, 3], np.eye(3).ravel(), np.array([1, 0, 0, 0.5], np.float32)
    for kind in ("SPHERE", "CAPSULE", "ELLIPSOID", "CYLINDER", "BOX", "LINE", "ARROW", "PLANE"):
        made = []
        for module in (ours, theirs):
            geom = module.MjvGeom()
            module.mjv_initGeom(
                geom,
                module.mjtGeom[f"mjGEOM_{kind}"] if module is ours else getattr(module.mjtGeom, f"mjGEOM_{kind}"),
                size,
                pos,
                turn,
                rgba,
            )
            made.append(geom)
            if kind in ("CAPSULE", "CYLINDER", "LINE", "ARROW"):
                other = module.MjvGeom()
                module.mjv_connector(
                    other,
                    getattr(module.mjtGeom, f"mjGEOM_{kind}"),
                    0.05,
                    np.array([1.0, 2, 3]),
                    np.array([2.0, 2.5, 1]),
                )
                made.append(other)
        half = len(made) // 2
        for one, other in zip(made[:half], made[half:]):
            for field in one.FIELDS:
                assert (
                    np.allclose(getattr(one, field), getattr(other, field), atol=1e-6) if field != "label" else True
                ), (kind, field)


def test_arithmetic() -> None:
    rng = np.random.default_rng(0)
    for kind in range(-1, 30):
        assert ours.mju_type2Str(kind) == theirs.mju_type2Str(kind)
    for name in ("body", "joint", "actuator", "nonsense", ""):
        assert ours.mju_str2Type(name) == theirs.mju_str2Type(name)
    range_of, prm = np.array([0.1, 0.4]), np.array([0.75, 1.05, -1, 200, 0.5, 1.6, 1.5, 1.3, 1.2])
    for _ in range(200):
        x, y, z = rng.normal(size=3)
        assert ours.mju_sigmoid(x) == pytest.approx(theirs.mju_sigmoid(x), abs=1e-15)
        assert ours.mju_round(10 * x) == theirs.mju_round(10 * x)
        assert ours.mju_springDamper(x, y, z + 2, 3, 0.1) == pytest.approx(
            theirs.mju_springDamper(x, y, z + 2, 3, 0.1), abs=1e-12
        )
        length, speed = 0.25 + 0.15 * x, y
        for name, arguments in (
            ("mju_muscleGain", (length, speed, range_of, 0.7, prm)),
            ("mju_muscleBias", (length, range_of, 0.7, prm)),
            ("mju_muscleDynamics", (x, y, np.array([0.01, 0.04, 0.0]))),
            ("mju_muscleDynamics", (x, y, np.array([0.01, 0.04, 0.3]))),
        ):
            assert getattr(ours, name)(*arguments) == pytest.approx(
                getattr(theirs, name)(*arguments), rel=1e-11, abs=1e-11
            ), name
        a, b = rng.normal(size=(2, 4))
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        for name, arguments, shapes in (
            ("mju_mulQuatAxis", (a, b[:3]), [(4,)]),
            ("mju_trnVecPose", (b[:3], a, rng.normal(size=3)), [(3,)]),
        ):
            compare(name, arguments, shapes)
        compare("mjd_subQuat", (a, b), [(3, 3), (3, 3)], last=True)
        compare("mjd_quatIntegrate", (rng.normal(size=3), 0.3), [(9,), (9,), (3,)], last=True)
        square = rng.normal(size=(4, 4))
        square = square @ square.T + np.eye(4)
        factors = [square.copy(), square.copy()]
        assert ours.mju_cholFactor(factors[0], 1e-10) == theirs.mju_cholFactor(factors[1], 1e-10)
        assert apart(np.tril(factors[0]), np.tril(factors[1])) < 1e-12
        compare("mju_cholSolve", (factors[1], a), [(4,)])
        vectors = [b.copy(), b.copy()]
        assert ours.mju_cholUpdate(factors[0], vectors[0], 1) == theirs.mju_cholUpdate(factors[1], vectors[1], 1)
        assert apart(np.tril(factors[0]), np.tril(factors[1])) < 1e-12
        compare("mju_sqrMatTD", (square, rng.uniform(size=4)), [(4, 4)])
    for index in range(20):
        assert ours.mju_Halton(index, 3) == pytest.approx(theirs.mju_Halton(index, 3), abs=1e-15)
    for count in (0, 1, 1023, 1024, 5 * 1024**2, 3 * 1024**3):
        assert ours.mju_writeNumBytes(count) == theirs.mju_writeNumBytes(count)
    for name in (
        "mjMINVAL",
        "mjMAXCONPAIR",
        "mjVISSTRING",
        "mjRNDSTRING",
        "mjDISABLESTRING",
        "mjTIMERSTRING",
        "mjLABELSTRING",
    ):
        assert getattr(ours, name) == getattr(theirs, name), name


def compare(name: str, arguments: tuple[Any, ...], shapes: list[tuple[int, ...]], last: bool = False) -> None:
    found = [[np.zeros(shape) for shape in shapes] for _ in range(2)]
    for module, results in zip((ours, theirs), found):
        getattr(module, name)(*(*arguments, *results) if last else (*results, *arguments))
    for one, other in zip(*found):
        assert apart(one, other) < 1e-11, name
