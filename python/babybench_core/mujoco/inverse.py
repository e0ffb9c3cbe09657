"""Energies, single parts of the dynamics, and inverse dynamics: ``mj_energyPos``, ``mj_fwdActuation``, ``mj_inverse``."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .data import MjData
from .enums import mjtConstraint, mjtDisableBit, mjtEnableBit, mjtJoint
from .functions import mj_forward, mj_fwdPosition, mj_fwdVelocity
from .jacobians import check
from .maths import mju_normalize, mju_subQuat
from .model import MjModel

__all__ = [
    *("mj_compareFwdInv", "mj_crb", "mj_energyPos", "mj_energyVel", "mj_factorM", "mj_fwdAcceleration"),
    *("mj_fwdActuation", "mj_fwdConstraint", "mj_geomDistance", "mj_invConstraint", "mj_invPosition", "mj_invVelocity"),
    *("mj_inverse", "mj_isDual", "mj_isSparse", "mj_makeConstraint", "mj_mulJacTVec", "mj_mulJacVec", "mj_passive"),
    *("mj_rne", "mj_setTotalmass", "mj_subtreeVel"),
]

_Floats = NDArray[np.float64]


def _off(m: MjModel, bit: mjtDisableBit) -> bool:
    return bool(m.opt.disableflags & bit)


def _only(d: MjData, groups: tuple[str, ...], names: tuple[str, ...]) -> None:
    """Computes groups of arrays and updates some of their arrays; the others keep their numbers."""
    bits = sum(_native.PhysicsData.GROUPS[group] for group in groups)
    others = [d._arrays[name] for name, group, _ in d._own.layout if group & bits and name not in names]
    kept = [array.copy() for array in others]
    d._compute(*groups)
    for array, values in zip(others, kept):
        array[...] = values


def mj_fwdActuation(m: MjModel, d: MjData) -> None:
    """Computes the forces of actuators."""
    check(m, d)
    d._compute("actuation")


def mj_fwdAcceleration(m: MjModel, d: MjData) -> None:
    """Computes the acceleration without constraints, ``qfrc_smooth`` and ``qacc_smooth``."""
    check(m, d)
    _only(d, ("acceleration",), ("qfrc_smooth", "qacc_smooth"))


def mj_fwdConstraint(m: MjModel, d: MjData) -> None:
    """Computes the forces of constraints, and the acceleration with them."""
    check(m, d)
    d._compute("acceleration", "constraints")


def mj_makeConstraint(m: MjModel, d: MjData) -> None:
    """Makes the constraint rows, with contacts, at the poses of ``qpos``."""
    check(m, d)
    d._compute("constraints")


def mj_crb(m: MjModel, d: MjData) -> None:
    """Does nothing: ``qM`` is computed when it is read."""
    check(m, d)


def mj_factorM(m: MjModel, d: MjData) -> None:
    """Does nothing: :func:`mj_solveM` factorizes."""
    check(m, d)


def mj_passive(m: MjModel, d: MjData) -> None:
    """Computes the forces of springs, dampers, gravity compensation and the medium, ``qfrc_passive``."""
    check(m, d)
    _only(d, ("velocity",), ("qfrc_passive",))


def mj_rne(m: MjModel, d: MjData, flg_acc: int, result: _Floats) -> None:
    """Computes the forces due to gravity and velocities (nv), and to accelerations if ``flg_acc``; without armature."""
    check(m, d)
    before = d.qfrc_bias.copy()
    _only(d, ("velocity",), ("qfrc_bias",))
    result[...] = d.qfrc_bias
    d.qfrc_bias[:] = before
    if flg_acc:
        result += d._own.inertia() @ d.qacc - m.dof_armature * d.qacc


def mj_isSparse(m: MjModel) -> int:
    """Returns whether MuJoCo stores the Jacobian of constraints sparsely."""
    return int(m.opt.jacobian == 1 or (m.opt.jacobian == 2 and m.nv >= 60))


def mj_isDual(m: MjModel) -> int:
    """Returns whether the solver works on forces (PGS) or on accelerations."""
    return int(m.opt.solver == 0)


def mj_mulJacVec(m: MjModel, d: MjData, res: _Floats, vec: ArrayLike) -> None:
    """Multiplies a vector (nv) by the Jacobian of the constraints."""
    check(m, d)
    res[...] = d._own.jacobian() @ np.asarray(vec, np.float64)


def mj_mulJacTVec(m: MjModel, d: MjData, res: _Floats, vec: ArrayLike) -> None:
    """Multiplies a vector (nefc) by the transposed Jacobian of the constraints."""
    check(m, d)
    res[...] = d._own.jacobian().T @ np.asarray(vec, np.float64)


def mj_setTotalmass(m: MjModel, newmass: float) -> None:
    """Scales the masses and inertias of all bodies to a total, kg."""
    scale = max(1e-15, newmass / max(1e-15, float(m.body_mass.sum())))
    m.body_mass[:] *= scale
    m.body_inertia[:] *= scale


def mj_geomDistance(m: MjModel, d: MjData, geom1: int, geom2: int, distmax: float, fromto: Optional[_Floats]) -> float:
    """Returns the distance between two geoms, m: negative where they overlap, at most ``distmax``.

    ``fromto`` (6) receives the points between which it is measured, or zeros where it is ``distmax``.

    Raises:
        ValueError: A geom does not exist.
    """
    check(m, d)
    for geom in (geom1, geom2):
        if not 0 <= geom < m.ngeom:
            raise ValueError(f"geom {geom} does not exist: the model has {m.ngeom} geoms, numbered from 0")
    found = d._own.distance((int(geom1), int(geom2)), float(distmax))
    if fromto is not None:
        fromto[...] = (
            np.zeros(np.shape(fromto)) if found is None else np.reshape([*found[1], *found[2]], np.shape(fromto))
        )
    return float(distmax) if found is None else float(found[0])


def mj_energyPos(m: MjModel, d: MjData) -> None:
    """Computes the potential energy of gravity and springs, ``data.energy[0]``, J."""
    check(m, d)
    gravity = np.zeros(3) if _off(m, mjtDisableBit.mjDSBL_GRAVITY) else np.asarray(m.opt.gravity)
    energy = -float(sum(m.body_mass[body] * (gravity @ d.xipos[body]) for body in range(1, m.nbody)))
    if not _off(m, mjtDisableBit.mjDSBL_PASSIVE):
        energy += sum((_spring(m, d, int(joint)) for joint in np.flatnonzero(m.jnt_stiffness)), 0.0)
        stretched = np.maximum(d.ten_length - m.tendon_lengthspring[:, 1], 0) if m.ntendon else np.zeros(0)
        slack = np.maximum(m.tendon_lengthspring[:, 0] - d.ten_length, 0) if m.ntendon else np.zeros(0)
        energy += float(0.5 * m.tendon_stiffness @ (stretched + slack) ** 2)
    d.energy[0] = energy


def _spring(m: MjModel, d: MjData, joint: int) -> float:
    """Returns the energy of the spring of a joint, J."""
    stiffness, at, kind = float(m.jnt_stiffness[joint]), int(m.jnt_qposadr[joint]), m.jnt_type[joint]
    if kind in (mjtJoint.mjJNT_SLIDE, mjtJoint.mjJNT_HINGE):
        return float(0.5 * stiffness * (d.qpos[at] - m.qpos_spring[at]) ** 2)
    energy, quat_at = 0.0, at
    if kind == mjtJoint.mjJNT_FREE:
        # MuJoCo 3.3.0 normalizes the first four coordinates of the free joint here
        first = d.qpos[at : at + 4].copy()
        mju_normalize(first)
        apart = first[:3] - m.qpos_spring[at : at + 3]
        energy, quat_at = float(0.5 * stiffness * apart @ apart), at + 3
    turn, quat = np.zeros(3), d.qpos[quat_at : quat_at + 4].copy()
    mju_normalize(quat)
    mju_subQuat(turn, quat, m.qpos_spring[quat_at : quat_at + 4])
    return energy + float(0.5 * stiffness * turn @ turn)


def mj_energyVel(m: MjModel, d: MjData) -> None:
    """Computes the kinetic energy, ``data.energy[1]``, J."""
    check(m, d)
    d.energy[1] = 0.5 * d.qvel @ (d._own.inertia() @ d.qvel)


def mj_subtreeVel(m: MjModel, d: MjData) -> None:
    """Computes velocities of the centres of mass of subtrees, m/s, and their angular momenta, kg m^2/s."""
    check(m, d)
    d.subtree_linvel[...], d.subtree_angmom[...] = d._subtree_velocities()


def mj_invPosition(m: MjModel, d: MjData) -> None:
    """Computes what inverse dynamics need from positions."""
    mj_fwdPosition(m, d)


def mj_invVelocity(m: MjModel, d: MjData) -> None:
    """Computes what inverse dynamics need from velocities."""
    mj_fwdVelocity(m, d)


def _friction_losses(m: MjModel, rows: dict[str, NDArray[Any]]) -> _Floats:
    """Returns the largest force of each row of dry friction; 0 for other rows."""
    kinds, ids = rows["type"], rows["id"]
    losses = np.zeros(len(kinds))
    of_dofs, of_tendons = kinds == mjtConstraint.mjCNSTR_FRICTION_DOF, kinds == mjtConstraint.mjCNSTR_FRICTION_TENDON
    losses[of_dofs] = m.dof_frictionloss[ids[of_dofs]]
    losses[of_tendons] = m.tendon_frictionloss[ids[of_tendons]]
    return losses


def _cone(jar: _Floats, weights: _Floats, mu: float, friction: _Floats) -> _Floats:
    """Returns the force of a contact with an elliptic cone: zero, inside the cone, or on its surface."""
    scaled = jar * np.concatenate([[mu], friction])
    normal, tangent = scaled[0], float(np.linalg.norm(scaled[1:]))
    if normal >= mu * tangent or (tangent <= 0 and normal >= 0):
        return np.zeros(len(jar))
    if mu * normal + tangent <= 0 or (tangent <= 0 and normal < 0):
        return np.asarray(-weights * jar)
    stiffness = weights[0] / max(1e-15, mu * mu * (1 + mu * mu))
    force = np.empty(len(jar))
    force[0] = -stiffness * (normal - mu * tangent) * mu
    force[1:] = -force[0] / tangent * scaled[1:] * friction
    return force


def constraint_force(m: MjModel, d: MjData, jar: _Floats) -> _Floats:
    """Returns the constraint forces (nefc) for ``jar``, the constraints' accelerations minus their reference accelerations."""
    rows = d._own.rows()
    kinds, weights = rows["type"], np.asarray(rows["D"], np.float64)
    losses = _friction_losses(m, rows)
    force = np.asarray(-weights * jar)
    rubs = (kinds == mjtConstraint.mjCNSTR_FRICTION_DOF) | (kinds == mjtConstraint.mjCNSTR_FRICTION_TENDON)
    force[rubs] = np.clip(force[rubs], -losses[rubs], losses[rubs])
    one_sided = (kinds >= mjtConstraint.mjCNSTR_LIMIT_JOINT) & (kinds < mjtConstraint.mjCNSTR_CONTACT_ELLIPTIC)
    force[one_sided & (jar >= 0)] = 0
    if (kinds == mjtConstraint.mjCNSTR_CONTACT_ELLIPTIC).any():
        contact: Any
        for contact in d.contact:
            first, dim = int(contact.efc_address), int(contact.dim)
            if first >= 0 and kinds[first] == mjtConstraint.mjCNSTR_CONTACT_ELLIPTIC:
                span = slice(first, first + dim)
                friction = np.asarray(contact.friction)[: dim - 1]
                force[span] = _cone(jar[span], weights[span], float(contact.mu), friction)
    return force


def mj_invConstraint(m: MjModel, d: MjData) -> None:
    """Computes the forces of constraints, ``qfrc_constraint``, from accelerations; ``efc_force`` does not change."""
    check(m, d)
    if not d.nefc:
        d.qfrc_constraint[:] = 0
        return
    jacobian = d._own.jacobian()
    jar = jacobian @ d.qacc - d._own.rows()["aref"]
    d.qfrc_constraint[:] = jacobian.T @ constraint_force(m, d, jar)


def mj_inverse(m: MjModel, d: MjData) -> None:
    """Computes the forces, ``qfrc_inverse``, that cause ``qacc`` at the current positions and velocities.

    Raises:
        NotImplementedError: The model has the flag ``invdiscrete``.
    """
    check(m, d)
    if m.opt.enableflags & mjtEnableBit.mjENBL_INVDISCRETE:
        raise NotImplementedError(
            "mj_inverse: accelerations of discrete time (the flag invdiscrete) are not converted here"
        )
    acceleration = d.qacc.copy()
    mj_invPosition(m, d)
    mj_invVelocity(m, d)
    if m.opt.enableflags & mjtEnableBit.mjENBL_ENERGY:
        mj_energyPos(m, d)
        mj_energyVel(m, d)
    d.qacc[:] = acceleration
    mj_invConstraint(m, d)
    d.qfrc_inverse[:] = d._own.inertia() @ acceleration + d.qfrc_bias - d.qfrc_passive - d.qfrc_constraint


def mj_compareFwdInv(m: MjModel, d: MjData) -> None:
    """Compares forward with inverse dynamics: writes the differences of constraint and other forces to ``data.solver_fwdinv``."""
    check(m, d)
    before, acceleration = d.qfrc_constraint.copy(), d.qacc.copy()
    applied = d.qfrc_applied + d.qfrc_actuator + _applied(m, d)
    mj_inverse(m, d)
    d.solver_fwdinv[0] = np.linalg.norm(before - d.qfrc_constraint)
    d.solver_fwdinv[1] = np.linalg.norm(applied - d.qfrc_inverse)
    d.qfrc_constraint[:], d.qacc[:] = before, acceleration


def _applied(m: MjModel, d: MjData) -> _Floats:
    """Returns the generalised forces of the forces on bodies, ``xfrc_applied``."""
    from .jacobians import mj_applyFT

    total = np.zeros(m.nv)
    for body in np.flatnonzero(d.xfrc_applied.any(axis=1)):
        wrench = d.xfrc_applied[body]
        mj_applyFT(m, d, wrench[:3], wrench[3:], d.xipos[body], int(body), total)
    return total


def step_with_energy(m: MjModel, d: MjData, nstep: int) -> None:
    """Advances by time steps, and computes the energies of the state from which the last one started."""
    if nstep > 1:
        d._own.step(nstep - 1)
    mj_forward(m, d)
    mj_energyPos(m, d)
    mj_energyVel(m, d)
    d._own.step(1)
