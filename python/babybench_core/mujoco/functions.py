"""MuJoCo's functions on models and states."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .data import MjData
from .derived import matrix_places
from .enums import mjtDisableBit, mjtEnableBit, mjtIntegrator, mjtObj, mjtState
from .jacobians import check
from .maths import mju_normalize, mju_quatIntegrate, mju_subQuat, mju_transformSpatial
from .model import MjModel

__all__ = [
    "mj_camlight",
    "mj_comPos",
    "mj_comVel",
    "mj_contactForce",
    "mj_copyData",
    "mj_differentiatePos",
    "mj_forward",
    "mj_fullM",
    "mj_fwdPosition",
    "mj_fwdVelocity",
    "mj_getState",
    "mj_getTotalmass",
    "mj_id2name",
    "mj_integratePos",
    "mj_isPyramidal",
    "mj_kinematics",
    "mj_mulM",
    "mj_name2id",
    "mj_normalizeQuat",
    "mj_objectVelocity",
    "mj_resetData",
    "mj_resetDataKeyframe",
    "mj_rnePostConstraint",
    "mj_setKeyframe",
    "mj_setState",
    "mj_solveM",
    "mj_stateSize",
    "mj_step",
    "mj_step1",
    "mj_step2",
    "mj_tendon",
    "mj_transmission",
    "mj_version",
    "mj_versionString",
]

_Floats = NDArray[np.float64]
_Position = ("kinematics", "com", "cameras", "tendon", "transmission")
_Velocity = ("com_velocity", "velocity")


def mj_version() -> int:
    """Returns the version of MuJoCo that this module follows."""
    return 330


def mj_versionString() -> str:
    """Returns the version of MuJoCo that this module follows."""
    return "3.3.0"


def _kind(type: int) -> str:
    try:
        kind = mjtObj(int(type))
    except ValueError:
        raise ValueError(f"{type} is not a kind of element: see mjtObj") from None
    name = kind.name[len("mjOBJ_") :].lower()
    return "body" if name == "xbody" else name


def _names(m: Any, type: int) -> list[str]:
    kind, names = _kind(type), m._names
    if kind in names:
        found: list[str] = names[kind]
        return found
    if kind in ("flex", "plugin"):
        return []
    raise ValueError(f"names of {mjtObj(int(type)).name} are not kept here: there are those of {', '.join(names)}")


def mj_id2name(m: MjModel, type: int, id: int) -> str | None:
    """Returns the name of an element; ``None`` if it has none or does not exist."""
    names = _names(m, type)
    return (names[id] or None) if 0 <= id < len(names) else None


def mj_name2id(m: MjModel, type: int, name: str | bytes) -> int:
    """Returns the id of an element; -1 if it does not exist."""
    names = _names(m, type)
    name = name.decode() if isinstance(name, bytes) else name
    return names.index(name) if name and name in names else -1


def _anew(d: MjData) -> None:
    """Records that a step started by :func:`mj_step1` will not continue."""
    d.__dict__["_start"] = None


def mj_step(m: MjModel, d: MjData, nstep: int = 1) -> None:
    """Advances by time steps.

    A simulation that diverges restarts at ``qpos0``, with a ``RuntimeWarning``, and the step is made from there, unless the
    document has ``<flag autoreset="disable"/>``.

    Raises:
        ValueError: A number in the arrays is not finite.
        RuntimeError: The simulation diverged, and does not restart.
    """
    start, nstep = d.time, int(nstep)
    try:
        advance(m, d, nstep)
    except RuntimeError as error:
        if not has_diverged(error) or getattr(m.opt, "disableflags", 0) & mjtDisableBit.mjDSBL_AUTORESET:
            raise
        # the arrays show a step before the one that failed, from which the others are made one by one
        done = round((d.time - start) / m.opt.timestep)
        for _ in range(nstep - done):
            _step_or_restart(m, d)


def has_diverged(error: RuntimeError) -> bool:
    """Returns whether an error of the engine is a divergence."""
    return "diverged" in str(error)


def _step_or_restart(m: MjModel, d: MjData) -> None:
    try:
        advance(m, d, 1)
    except RuntimeError as error:
        if not has_diverged(error):
            raise
        warnings.warn(f"{error} (it restarts at qpos0, as in MuJoCo)", RuntimeWarning, stacklevel=3)
        mj_resetData(m, d)
        advance(m, d, 1)


def advance(m: MjModel, d: MjData, nstep: int) -> None:
    """Advances by time steps, without a restart.

    Raises:
        ValueError: A number in the arrays is not finite.
        RuntimeError: The simulation diverged.
    """
    check(m, d)
    _anew(d)
    if getattr(m.opt, "enableflags", 0) & mjtEnableBit.mjENBL_ENERGY:
        from .inverse import step_with_energy

        step_with_energy(m, d, nstep)
    else:
        d._own.step(nstep)


def mj_forward(m: MjModel, d: MjData) -> None:
    """Computes everything that follows from positions, velocities and controls, without advancing."""
    check(m, d)
    _anew(d)
    d._compute("input", *_Position, *_Velocity, "actuation", "acceleration", "sensors", "constraints")
    d.__dict__["_start"] = _fixed_between(d)


def mj_fwdPosition(m: MjModel, d: MjData) -> None:
    """Computes all that follows from positions: poses, inertia, contacts, constraint rows."""
    check(m, d)
    d._compute(*_Position, "constraints")


def mj_fwdVelocity(m: MjModel, d: MjData) -> None:
    """Computes all that follows from velocities: rates, passive and bias forces."""
    check(m, d)
    d._compute(*_Velocity)


def mj_kinematics(m: MjModel, d: MjData) -> None:
    """Computes the poses of bodies, joints, geoms and sites."""
    check(m, d)
    d._compute("kinematics")


def mj_comPos(m: MjModel, d: MjData) -> None:
    """Computes quantities about the centres of mass: ``subtree_com``, ``cinert``, ``cdof``."""
    check(m, d)
    d._compute("com")


def mj_comVel(m: MjModel, d: MjData) -> None:
    """Computes the velocities of bodies: ``cvel``, ``cdof_dot``."""
    check(m, d)
    d._compute("com_velocity")


def mj_camlight(m: MjModel, d: MjData) -> None:
    """Computes the poses of cameras."""
    check(m, d)
    d._compute("cameras")


def mj_tendon(m: MjModel, d: MjData) -> None:
    """Computes the lengths of tendons."""
    check(m, d)
    d._compute("tendon")


def mj_transmission(m: MjModel, d: MjData) -> None:
    """Computes the lengths of actuators."""
    check(m, d)
    d._compute("transmission")


def _fixed_between(d: MjData) -> list[_Floats]:
    return [d.qpos.copy(), d.qvel.copy(), d.act.copy(), np.array([d.time]), d.eq_active.copy()]


def mj_step1(m: MjModel, d: MjData) -> None:
    """Computes the part of a step that does not depend on controls; :func:`mj_step2` does the rest."""
    check(m, d)
    d._compute(*_Position, *_Velocity, "constraints")
    early = np.repeat(m.sensor_needstage < 3, m.sensor_dim)
    d.sensordata[early] = d._own.sensordata()[early]
    d.__dict__["_start"] = _fixed_between(d)


def _moved(start: list[_Floats], d: MjData) -> bool:
    """Returns whether a program has changed positions or velocities, and nothing else, since a step began."""
    same = [np.array_equal(was, now) for was, now in zip(start, _fixed_between(d))]
    return same[2:] == [True, True, True] and not all(same)


def _advance_from(m: MjModel, d: MjData, start: list[_Floats]) -> None:
    """Advances the current positions and velocities by the accelerations of the state where the step began, as MuJoCo does."""
    at = d.qpos.copy(), d.qvel.copy()
    d.qpos[:], d.qvel[:] = start[:2]
    mj_forward(m, d)
    _anew(d)
    acceleration, damping = d.qacc.copy(), m.dof_damping * m.opt.timestep
    if damping.any() and not m.opt.disableflags & mjtDisableBit.mjDSBL_EULERDAMP:
        forces = d.qfrc_smooth + d.qfrc_constraint
        acceleration = np.linalg.solve(d._own.inertia() + np.diag(damping), forces)
    d.qacc_warmstart[:] = d.qacc
    d.qpos[:], d.qvel[:] = at
    d.qvel += m.opt.timestep * acceleration
    mj_integratePos(m, d.qpos, d.qvel, m.opt.timestep)
    d.time += m.opt.timestep


def mj_step2(m: MjModel, d: MjData) -> None:
    """Does the rest of a step that :func:`mj_step1` or :func:`mj_forward` began: actuators, accelerations, integration.

    Raises:
        NotImplementedError: The integrator is Runge-Kutta's, which has no such halves.
        RuntimeError: No step began; or positions or velocities have changed since, and the model has activations or an
            implicit integrator.
    """
    check(m, d)
    if m.opt.integrator == mjtIntegrator.mjINT_RK4:
        raise NotImplementedError(
            "mj_step2 is there for Euler's and the implicit integrators: MuJoCo's would use Euler instead of RK4. Set "
            "model.opt.integrator to 0, or call mj_step"
        )
    start = d._start
    if start is not None and not m.na and m.opt.integrator == mjtIntegrator.mjINT_EULER and _moved(start, d):
        _advance_from(m, d, start)
        return
    if start is None:
        raise RuntimeError("mj_step2 goes on with what mj_step1 began: call mj_step1 before it, or mj_step alone")
    if not all(np.array_equal(was, now) for was, now in zip(start, _fixed_between(d))):
        raise RuntimeError(
            "positions, velocities, activations, time or constraints have changed since mj_step1: call mj_step1 again, "
            "and change only controls and applied forces in between"
        )
    mj_step(m, d)


def mj_rnePostConstraint(m: MjModel, d: MjData) -> None:
    """Computes ``cacc``, ``cfrc_ext`` and ``cfrc_int``, which steps leave out unless a sensor reads them."""
    check(m, d)
    d._own.rne_post_constraint()


def mj_resetData(m: MjModel, d: MjData) -> None:
    """Resets to ``qpos0``, at rest. Computed quantities become zero."""
    check(m, d)
    _anew(d)
    d._own.reset()
    if getattr(m, "nuserdata", 0):
        d.userdata[:] = 0


def mj_resetDataKeyframe(m: MjModel, d: MjData, key: int) -> None:
    """Resets to a keyframe.

    Raises:
        IndexError: The keyframe does not exist; MuJoCo is silent.
    """
    check(m, d)
    _anew(d)
    if key < 0:
        raise IndexError(f"keyframe {key} does not exist: the model has {m.nkey}, numbered from 0")
    d._own.reset(int(key))
    d.userdata[:] = 0


def mj_setKeyframe(m: MjModel, d: MjData, k: int) -> None:
    """Writes a state into a keyframe of its model.

    Raises:
        IndexError: The keyframe does not exist.
        ValueError: Mocap bodies are not at their poses in the keyframe, which cannot be changed.
    """
    check(m, d)
    if not 0 <= k < m.nkey:
        raise IndexError(f"keyframe {k} does not exist: the model has {m.nkey}, numbered from 0")
    if m.nmocap and not (np.array_equal(m.key_mpos[k], d.mocap_pos) and np.array_equal(m.key_mquat[k], d.mocap_quat)):
        raise ValueError(f"keyframe {k}: mocap poses of keyframes come from the document: write them there")
    m.key_time[k] = d.time
    for name in ("qpos", "qvel", "act", "ctrl"):
        getattr(m, f"key_{name}")[k] = getattr(d, name)


def mj_copyData(dest: MjData, m: MjModel, src: MjData) -> MjData:
    """Copies a state, with everything that was computed, into another of the same model, and returns that."""
    check(m, src)
    check(m, dest)
    return dest._take(src)


def mj_fullM(m: MjModel, dst: _Floats, M: ArrayLike) -> None:
    """Expands an inertia in MuJoCo's sparse order, ``data.qM``, to a full matrix, (nv, nv)."""
    values = np.asarray(M, np.float64).reshape(-1)
    rows, columns = matrix_places(m)
    if np.shape(dst) != (m.nv, m.nv) or values.shape != rows.shape:
        raise TypeError(f"dst should be of shape (nv, nv) = ({m.nv}, {m.nv}), and M of length nM = {len(rows)}")
    dst[...] = 0.0
    dst[rows, columns] = values
    dst[columns, rows] = values


def mj_mulM(m: MjModel, d: MjData, res: _Floats, vec: ArrayLike) -> None:
    """Multiplies a vector (nv) by the inertia matrix."""
    check(m, d)
    res[...] = d._own.inertia() @ np.asarray(vec, np.float64)


def mj_solveM(m: MjModel, d: MjData, x: _Floats, y: ArrayLike) -> None:
    """Multiplies vectors, (nv,) or (n, nv), by the inverse of the inertia matrix."""
    check(m, d)
    x[...] = np.linalg.solve(d._own.inertia(), np.asarray(y, np.float64).T).T


def mj_getTotalmass(m: MjModel) -> float:
    """Returns the mass of all bodies, kg."""
    return float(m.body_mass.sum())


def mj_isPyramidal(m: MjModel) -> int:
    """Returns whether friction cones are pyramidal."""
    return int(m.opt.cone == 0)


def mj_contactForce(m: MjModel, d: MjData, id: int, result: _Floats) -> None:
    """Writes the force of a contact in its frame, (6,), N and N m."""
    if isinstance(d, MjData):
        check(m, d)
    np.reshape(result, -1)[:] = d.contact._forces[id]


def mj_objectVelocity(m: MjModel, d: MjData, objtype: int, objid: int, res: _Floats, flg_local: int) -> None:
    """Computes the velocity of an object (6): rotation, rad/s, translation, m/s, in its own axes or in the world's."""
    check(m, d)
    kind = mjtObj(int(objtype))
    frames: dict[mjtObj, tuple[Any, Any, Any]] = {
        mjtObj.mjOBJ_BODY: (None, d.xipos, d.ximat),
        mjtObj.mjOBJ_XBODY: (None, d.xpos, d.xmat),
        mjtObj.mjOBJ_GEOM: (m.geom_bodyid, d.geom_xpos, d.geom_xmat),
        mjtObj.mjOBJ_SITE: (m.site_bodyid, d.site_xpos, d.site_xmat),
        mjtObj.mjOBJ_CAMERA: (m.cam_bodyid, d.cam_xpos, d.cam_xmat),
    }
    if kind not in frames:
        raise ValueError(f"{kind.name} has no velocity: give a body, a geom, a site or a camera")
    bodies, positions, matrices = frames[kind]
    body = objid if bodies is None else int(bodies[objid])
    axes = matrices[objid] if flg_local else None
    mju_transformSpatial(res, d.cvel[body], 0, positions[objid], d.subtree_com[m.body_rootid[body]], axes)


_FREE, _BALL = 0, 1


def _joints(m: MjModel) -> list[tuple[int, int, int]]:
    """Returns the type of each joint, and where its positions and velocities start."""
    return [(int(t), int(q), int(v)) for t, q, v in zip(m.jnt_type, m.jnt_qposadr, m.jnt_dofadr)]


def mj_integratePos(m: MjModel, qpos: _Floats, qvel: ArrayLike, dt: float) -> None:
    """Advances positions (nq) with velocities (nv) for some time, s."""
    velocity = np.asarray(qvel, np.float64)
    for kind, q, v in _joints(m):
        if kind == _FREE:
            qpos[q : q + 3] += dt * velocity[v : v + 3]
            mju_quatIntegrate(qpos[q + 3 : q + 7], velocity[v + 3 : v + 6], dt)
        elif kind == _BALL:
            mju_quatIntegrate(qpos[q : q + 4], velocity[v : v + 3], dt)
        else:
            qpos[q] += dt * velocity[v]


def mj_differentiatePos(m: MjModel, qvel: _Floats, dt: float, qpos1: ArrayLike, qpos2: ArrayLike) -> None:
    """Computes the velocities (nv) that lead from one position to another in a given time, s."""
    first, second = np.asarray(qpos1, np.float64), np.asarray(qpos2, np.float64)
    for kind, q, v in _joints(m):
        if kind == _FREE:
            qvel[v : v + 3] = (second[q : q + 3] - first[q : q + 3]) / dt
            mju_subQuat(qvel[v + 3 : v + 6], second[q + 3 : q + 7], first[q + 3 : q + 7])
            qvel[v + 3 : v + 6] /= dt
        elif kind == _BALL:
            mju_subQuat(qvel[v : v + 3], second[q : q + 4], first[q : q + 4])
            qvel[v : v + 3] /= dt
        else:
            qvel[v] = (second[q] - first[q]) / dt


def mj_normalizeQuat(m: MjModel, qpos: _Floats) -> None:
    """Normalizes the quaternions in positions (nq)."""
    for kind, q, _ in _joints(m):
        if kind in (_FREE, _BALL):
            start = q + 3 if kind == _FREE else q
            mju_normalize(qpos[start : start + 4])


_STATE = (
    *("time", "qpos", "qvel", "act", "qacc_warmstart", "ctrl", "qfrc_applied", "xfrc_applied", "eq_active"),
    *("mocap_pos", "mocap_quat", "userdata"),
)
"""The parts of a state, in the order of the bits of ``mjtState``."""


def _parts(d: MjData, spec: int) -> list[NDArray[Any]]:
    if not 0 <= spec < 1 << mjtState.mjNSTATE:
        raise ValueError(f"{spec} is not a sum of parts of a state; see mjtState")
    arrays: dict[str, NDArray[Any]] = {**d._arrays, "time": d._clock}
    return [arrays[name] for bit, name in enumerate(_STATE) if spec >> bit & 1]


def mj_stateSize(m: MjModel, spec: int) -> int:
    """Returns the number of values in parts of a state, given as a sum of ``mjtState``."""
    moved = (3 * m.nmocap, 4 * m.nmocap)
    sizes = (1, m.nq, m.nv, m.na, m.nv, m.nu, m.nv, 6 * m.nbody, m.neq, *moved, m.nuserdata)
    if not 0 <= int(spec) < 1 << mjtState.mjNSTATE:
        raise ValueError(f"{spec} is not a sum of parts of a state; see mjtState")
    return sum(size for bit, size in enumerate(sizes) if int(spec) >> bit & 1)


def mj_getState(m: MjModel, d: MjData, state: _Floats, spec: int) -> None:
    """Writes parts of a state into a vector."""
    check(m, d)
    values = [np.asarray(part, np.float64).reshape(-1) for part in _parts(d, int(spec))]
    state[...] = np.concatenate([np.zeros(0), *values])


def mj_setState(m: MjModel, d: MjData, state: ArrayLike, spec: int) -> None:
    """Takes parts of a state from a vector."""
    check(m, d)
    values = np.asarray(state, np.float64).reshape(-1)
    if len(values) != mj_stateSize(m, spec):
        raise TypeError(f"state should have {mj_stateSize(m, spec)} numbers, not {len(values)}")
    at = 0
    for part in _parts(d, int(spec)):
        part[...] = values[at : at + part.size].reshape(part.shape)
        at += part.size
