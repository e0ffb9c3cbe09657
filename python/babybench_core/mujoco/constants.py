"""Constants that follow from a model's masses, ``mj_setConst``, and contacts alone, ``mj_collision``."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .data import MjData
from .jacobians import _columns, check
from .model import MjModel, _fixed

__all__ = ["mj_collision", "mj_setConst"]

_Floats = NDArray[np.float64]
_FREE, _BALL = 0, 1


def mj_collision(m: MjModel, d: MjData) -> None:
    """Finds contacts, with their constraint rows, at the poses of ``qpos``."""
    check(m, d)
    d._compute("kinematics", "com", "constraints")


def _mass_matrix(m: MjModel, d: MjData) -> _Floats:
    """Returns the joint-space inertia at the poses of the state."""
    matrix = np.diag(np.array(m.dof_armature, np.float64))
    for body in range(1, m.nbody):
        dofs, translation, rotation = _columns(m, d, d.xipos[body], body)
        frame = np.reshape(d.ximat[body], (3, 3))
        inertia = frame * m.body_inertia[body] @ frame.T
        matrix[np.ix_(dofs, dofs)] += m.body_mass[body] * translation @ translation.T + rotation @ inertia @ rotation.T
    return matrix


def _of_bodies(m: MjModel, d: MjData, inverse: _Floats) -> _Floats:
    """Returns the inverse weight of each body for a force and for a torque at its centre of mass, (nbody, 2)."""
    found = np.zeros((m.nbody, 2))
    for body in range(1, m.nbody):
        dofs, *columns = _columns(m, d, d.xipos[body], body)
        for k, rows in enumerate(columns if len(dofs) else ()):
            found[body, k] = np.trace(rows.T @ inverse[np.ix_(dofs, dofs)] @ rows) / 3
    return found


def _of_joints(m: MjModel, inverse: _Floats) -> _Floats:
    """Returns the inverse weight of each degree of freedom, (nv,), averaged over a ball joint and each half of a free joint."""
    found: _Floats = np.diag(inverse).copy()
    for kind, first in zip(m.jnt_type, m.jnt_dofadr):
        halves = (0, 3) if kind == _FREE else (0,) if kind == _BALL else ()
        for half in halves:
            found[first + half : first + half + 3] = found[first + half : first + half + 3].mean()
    return found


def _check_tendons(m: MjModel, gives_way: _Floats) -> None:
    """Refuses changes to bodies that a tendon may involve: all but those that are alone in the world."""
    known = np.asarray(m.body_invweight0)
    changed = np.flatnonzero((abs(gives_way - known) > 1e-6 * abs(known)).any(axis=1))
    parents = np.asarray(m.body_parentid)
    if any(parents[body] != 0 or body in parents for body in changed):
        raise NotImplementedError(
            f"mj_setConst: the model has {m.ntendon} tendons, whose constants follow from masses and are computed when a "
            "document is compiled. Bodies without parts may change; write other masses into the document, and compile it"
        )


def _show(m: Any, name: str, values: _Floats) -> None:
    """Replaces an array of a model that programs cannot write to."""
    getattr(m, name)  # raises where there is no such array
    m.__dict__[name] = _fixed(values, name)


def mj_setConst(m: MjModel, d: MjData) -> None:
    """Recomputes what follows from masses: ``body_invweight0``, ``dof_invweight0``, ``dof_M0``, ``body_subtreemass``.

    As in MuJoCo, the state is then at the positions of the springs, ``qpos_spring``. The statistics (``model.stat``) and
    ``actuator_acc0`` do not change.

    Raises:
        NotImplementedError: The model has tendons, whose constants are not computed here, and the mass of a body that is not
            alone changed.
    """
    check(m, d)
    d.qpos[:] = m.qpos0
    d._compute("kinematics", "com")
    matrix = _mass_matrix(m, d)
    inverse = np.asarray(np.linalg.inv(matrix), np.float64) if m.nv else matrix
    gives_way = _of_bodies(m, d, inverse)
    if m.ntendon:
        _check_tendons(m, gives_way)
    m.body_invweight0[:] = gives_way
    m.dof_invweight0[:] = _of_joints(m, inverse)
    total = np.array(m.body_mass, np.float64)
    for body in range(m.nbody - 1, 0, -1):
        total[m.body_parentid[body]] += total[body]
    _show(m, "dof_M0", np.diag(matrix))
    _show(m, "body_subtreemass", total)
    d.qpos[:] = m.qpos_spring
    d._compute("kinematics", "com")
