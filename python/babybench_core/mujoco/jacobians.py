"""Jacobians of points and frames: ``mj_jac`` and the like. ``jacp`` and ``jacr`` are (3, nv) or ``None``."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .data import MjData
from .model import MjModel

__all__ = [
    "mj_applyFT",
    "mj_jac",
    "mj_jacBody",
    "mj_jacBodyCom",
    "mj_jacDot",
    "mj_jacGeom",
    "mj_jacPointAxis",
    "mj_jacSite",
    "mj_jacSubtreeCom",
]

_Floats = NDArray[np.float64]
_Out = Optional[NDArray[np.float64]]


def chain(m: MjModel, body: int) -> NDArray[np.intp]:
    """Returns the degrees of freedom that move a body."""
    known: dict[int, NDArray[np.intp]] = m._chains
    if body not in known:
        if not 0 <= body < m.nbody:
            raise ValueError(f"body {body} does not exist: the model has {m.nbody} bodies, numbered from 0")
        found: list[int] = []
        at = body
        while at > 0:
            first, count = int(m.body_dofadr[at]), int(m.body_dofnum[at])
            found.extend(range(first, first + count))
            at = int(m.body_parentid[at])
        known[body] = np.array(sorted(found), np.intp)
    return known[body]


def check(m: Any, d: Any) -> None:
    """Refuses models and states of other modules, and states of other models."""
    if getattr(d, "__dict__", {}).get("_sync") is not None:
        # the state of an environment: its arrays have the same names, and the environment does the rest
        if d.model is not m:
            raise ValueError("the state belongs to another model: give the functions env.model and env.data")
        return
    if not isinstance(m, MjModel) or not isinstance(d, MjData):
        raise TypeError(
            "expected an MjModel and an MjData of babybench.mujoco, or env.model and env.data of one environment, but these are "
            f"{type(m).__module__}.{type(m).__name__} and {type(d).__module__}.{type(d).__name__}"
        )
    if d.model is not m:
        raise ValueError("the state belongs to another model: give the functions data.model")


def _columns(m: MjModel, d: MjData, point: ArrayLike, body: int) -> tuple[NDArray[np.intp], _Floats, _Floats]:
    """Returns the degrees of freedom that move a body, and how they move a point of it: translation, rotation."""
    dofs = chain(m, int(body))
    offset = np.asarray(point, np.float64).reshape(3) - d.subtree_com[m.body_rootid[body]]
    axes = d.cdof[dofs]
    return dofs, axes[:, 3:] + np.cross(axes[:, :3], offset), axes[:, :3]


def _fill(m: MjModel, out: _Out, name: str, dofs: NDArray[np.intp], rows: _Floats) -> None:
    if out is None:
        return
    if np.shape(out) != (3, m.nv):
        raise TypeError(f"{name} should be of shape (3, nv)")
    out[...] = 0.0
    out[:, dofs] = rows.T


def mj_jac(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, point: ArrayLike, body: int) -> None:
    """Computes the Jacobian of a point (world, m) that moves with a body: translation and rotation."""
    check(m, d)
    dofs, translation, rotation = _columns(m, d, point, body)
    _fill(m, jacp, "jacp", dofs, translation)
    _fill(m, jacr, "jacr", dofs, rotation)


def mj_jacBody(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, body: int) -> None:
    """Computes the Jacobian of the frame of a body."""
    mj_jac(m, d, jacp, jacr, d.xpos[body], body)


def mj_jacBodyCom(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, body: int) -> None:
    """Computes the Jacobian of the centre of mass of a body."""
    mj_jac(m, d, jacp, jacr, d.xipos[body], body)


def mj_jacGeom(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, geom: int) -> None:
    """Computes the Jacobian of the frame of a geom."""
    mj_jac(m, d, jacp, jacr, d.geom_xpos[geom], int(m.geom_bodyid[geom]))


def mj_jacSite(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, site: int) -> None:
    """Computes the Jacobian of the frame of a site."""
    mj_jac(m, d, jacp, jacr, d.site_xpos[site], int(m.site_bodyid[site]))


def mj_jacSubtreeCom(m: MjModel, d: MjData, jacp: _Floats, body: int) -> None:
    """Computes the Jacobian of the centre of mass of a body and all below it."""
    check(m, d)
    total = np.zeros((3, m.nv))
    below = np.zeros(m.nbody, bool)
    below[body] = True
    for other in range(body, m.nbody):
        below[other] |= other > body and below[m.body_parentid[other]]
        if below[other]:
            dofs, translation, _ = _columns(m, d, d.xipos[other], other)
            total[:, dofs] += m.body_mass[other] * translation.T
    _fill(m, jacp, "jacp", np.arange(m.nv), total.T / m.body_subtreemass[body])


def mj_jacPointAxis(
    m: MjModel, d: MjData, jacPoint: _Out, jacAxis: _Out, point: ArrayLike, axis: ArrayLike, body: int
) -> None:
    """Computes the Jacobians of a point and of a unit vector (both world) that move with a body."""
    check(m, d)
    dofs, translation, rotation = _columns(m, d, point, body)
    _fill(m, jacPoint, "jacPoint", dofs, translation)
    _fill(m, jacAxis, "jacAxis", dofs, np.cross(rotation, np.asarray(axis, np.float64).reshape(3)))


def mj_jacDot(m: MjModel, d: MjData, jacp: _Out, jacr: _Out, point: ArrayLike, body: int) -> None:
    """Computes the rate of the Jacobian of a point (world, m) of a body, as MuJoCo 3.3.0 does.

    It contains only the rates of the axes, ``data.cdof_dot`` at the point, not the part that comes from the velocity of the
    point itself.
    """
    check(m, d)
    dofs = chain(m, int(body))
    offset = np.asarray(point, np.float64).reshape(3) - d.subtree_com[m.body_rootid[body]]
    axes, rates = d.cdof[dofs], d.cdof_dot[dofs].copy()
    # the axes of the rotation of a free or ball joint turn with the whole body
    joints = m.dof_jntid[dofs]
    kinds = m.jnt_type[joints]
    turning = (kinds == 0) & (dofs >= m.jnt_dofadr[joints] + 3) | (kinds == 1)
    for k in np.flatnonzero(turning):
        moving, axis = d.cvel[m.dof_bodyid[dofs[k]]], axes[k]
        rates[k, :3] = np.cross(moving[:3], axis[:3])
        rates[k, 3:] = np.cross(moving[:3], axis[3:]) + np.cross(moving[3:], axis[:3])
    _fill(m, jacp, "jacp", dofs, rates[:, 3:] + np.cross(rates[:, :3], offset))
    _fill(m, jacr, "jacr", dofs, rates[:, :3])


def mj_applyFT(
    m: MjModel, d: MjData, force: ArrayLike, torque: ArrayLike, point: ArrayLike, body: int, qfrc_target: _Floats
) -> None:
    """Adds the effect of a force and a torque at a point of a body (world frame, N, N m, m) to generalised forces (nv)."""
    check(m, d)
    dofs, translation, rotation = _columns(m, d, point, body)
    qfrc_target[dofs] += translation @ np.asarray(force, np.float64).reshape(3)
    qfrc_target[dofs] += rotation @ np.asarray(torque, np.float64).reshape(3)
