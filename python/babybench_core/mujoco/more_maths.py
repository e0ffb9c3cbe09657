"""More of MuJoCo's functions on numbers, vectors and matrices, ``mju_*`` and ``mjd_*``."""

from __future__ import annotations

import math
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .enums import mjtObj, mjtWarning
from .maths import angular, matrix, product

__all__ = [
    *("mjd_quatIntegrate", "mjd_subQuat", "mju_Halton", "mju_cholFactor", "mju_cholSolve", "mju_cholUpdate", "mju_d2n"),
    *("mju_dense2sparse", "mju_f2n", "mju_insertionSort"),
    *("mju_insertionSortInt", "mju_isBad", "mju_isZero", "mju_mulQuatAxis", "mju_muscleBias", "mju_muscleDynamics"),
    *("mju_muscleGain", "mju_n2d", "mju_n2f", "mju_printMat", "mju_round", "mju_sigmoid", "mju_sparse2dense"),
    *("mju_springDamper", "mju_sqrMatTD", "mju_str2Type", "mju_trnVecPose", "mju_type2Str", "mju_warningText"),
    *("mju_writeNumBytes",),
]

_Floats = NDArray[np.float64]
_LEAST = 1e-15
_NO_ELEMENTS = tuple(
    kind for kind in mjtObj if kind.name in ("mjNOBJECT", "mjOBJ_FRAME", "mjOBJ_DEFAULT", "mjOBJ_MODEL")
)
"""Kinds that MJCF has no name for."""


def mju_type2Str(type: int) -> str | None:
    """Returns the name of a kind of element, as MJCF writes it; nothing for others."""
    try:
        kind = mjtObj(int(type))
    except ValueError:
        return None
    return None if kind in (mjtObj.mjOBJ_UNKNOWN, *_NO_ELEMENTS) else kind.name[len("mjOBJ_") :].lower()


def mju_str2Type(str: str | bytes) -> int:
    """Returns the kind of element, ``mjtObj``, of a name; 0 for others."""
    name = str.decode() if isinstance(str, bytes) else str
    return next((int(kind) for kind in mjtObj if name and mju_type2Str(kind) == name), 0)


def mju_round(x: float) -> int:
    """Returns the nearest whole number."""
    return math.floor(x + 0.5) if x - math.floor(x) != 0.5 or x > 0 else math.floor(x)


def mju_isBad(x: float) -> int:
    """Returns whether a number is NaN or beyond 1e10."""
    return int(not -1e10 <= x <= 1e10)


def mju_isZero(vec: ArrayLike) -> int:
    """Returns whether all numbers are 0."""
    return int(not np.any(vec))


def mju_Halton(index: int, base: int) -> float:
    """Returns a number of a Halton sequence, 0 to 1."""
    found, fraction, rest = 0.0, 1.0 / base, int(index)
    while rest > 0:
        found += fraction * (rest % base)
        rest //= base
        fraction /= base
    return found


def mju_sigmoid(x: float) -> float:
    """Returns a smooth step from 0 to 1, a polynomial of degree five."""
    if x <= 0:
        return 0.0
    return 1.0 if x >= 1 else x * x * x * (3 * x * (2 * x - 5) + 10)


def mju_springDamper(pos0: float, vel0: float, Kp: float, Kv: float, dt: float) -> float:
    """Returns the position of a damped spring after some time, s."""
    det = Kv * Kv / 4 - Kp
    if det > _LEAST:
        r1, r2 = (-Kv + math.sqrt(4 * det)) / 2, (-Kv - math.sqrt(4 * det)) / 2
        c2 = (vel0 - pos0 * r1) / (r2 - r1)
        return (pos0 - c2) * math.exp(r1 * dt) + c2 * math.exp(r2 * dt)
    if det < -_LEAST:
        w = math.sqrt(-det)
        return math.exp(-Kv / 2 * dt) * (pos0 * math.cos(w * dt) + (vel0 + pos0 * Kv / 2) / w * math.sin(w * dt))
    return (pos0 + (vel0 + pos0 * Kv / 2) * dt) * math.exp(-Kv / 2 * dt)


def _peak_force(acc0: float, prm: ArrayLike) -> float:
    force, scale = float(np.asarray(prm)[2]), float(np.asarray(prm)[3])
    return scale / max(_LEAST, acc0) if force < 0 else force


def _normal_length(length: float, lengthrange: ArrayLike, prm: ArrayLike) -> tuple[float, float]:
    """Returns the resting length of a muscle, and its length in units of that."""
    low, high = (float(x) for x in np.asarray(prm)[:2])
    first, last = (float(x) for x in np.asarray(lengthrange))
    rest = (last - first) / max(_LEAST, high - low)
    return rest, low + (length - first) / max(_LEAST, rest)


def mju_muscleGain(len: float, vel: float, lengthrange: ArrayLike, acc0: float, prm: ArrayLike) -> float:
    """Returns the active force of a muscle, N."""
    lmin, lmax, vmax, _, fvmax = (float(x) for x in np.asarray(prm)[4:9])
    rest, at = _normal_length(len, lengthrange, prm)
    speed = vel / max(_LEAST, rest * vmax)
    middle_low, middle_high = 0.5 * (lmin + 1), 0.5 * (1 + lmax)
    if not lmin <= at <= lmax:
        by_length = 0.0
    elif at <= middle_low:
        by_length = 0.5 * ((at - lmin) / max(_LEAST, middle_low - lmin)) ** 2
    elif at <= 1:
        by_length = 1 - 0.5 * ((1 - at) / max(_LEAST, 1 - middle_low)) ** 2
    elif at <= middle_high:
        by_length = 1 - 0.5 * ((at - 1) / max(_LEAST, middle_high - 1)) ** 2
    else:
        by_length = 0.5 * ((lmax - at) / max(_LEAST, lmax - middle_high)) ** 2
    y = fvmax - 1
    if speed <= -1:
        by_speed = 0.0
    elif speed <= 0:
        by_speed = (speed + 1) * (speed + 1)
    elif speed <= y:
        by_speed = fvmax - (y - speed) * (y - speed) / max(_LEAST, y)
    else:
        by_speed = fvmax
    return -_peak_force(acc0, prm) * by_length * by_speed


def mju_muscleBias(len: float, lengthrange: ArrayLike, acc0: float, prm: ArrayLike) -> float:
    """Returns the passive force of a muscle, N."""
    lmax, fpmax = float(np.asarray(prm)[5]), float(np.asarray(prm)[7])
    _, at = _normal_length(len, lengthrange, prm)
    middle = 0.5 * (1 + lmax)
    if at <= 1:
        return 0.0
    stretch = (at - 1) / max(_LEAST, middle - 1)
    shape = 0.5 * stretch * stretch if at <= middle else 0.5 + stretch - 1
    return -_peak_force(acc0, prm) * fpmax * shape


def mju_muscleDynamics(ctrl: float, act: float, prm: ArrayLike) -> float:
    """Returns the rate of a muscle's activation, 1/s."""
    rise, fall, smooth = (float(x) for x in np.asarray(prm)[:3])
    ctrl, within = min(1.0, max(0.0, ctrl)), min(1.0, max(0.0, act))
    rise, fall = rise * (0.5 + 1.5 * within), fall / (0.5 + 1.5 * within)
    apart = ctrl - act
    share = float(apart > 0) if smooth < _LEAST else mju_sigmoid(apart / smooth + 0.5)
    tau = fall + (rise - fall) * share
    return apart / max(_LEAST, tau)


def mju_n2f(res: NDArray[np.float32], vec: ArrayLike) -> None:
    """Copies doubles into singles."""
    res[...] = vec


def mju_f2n(res: _Floats, vec: ArrayLike) -> None:
    """Copies singles into doubles."""
    res[...] = vec


mju_n2d = mju_d2n = mju_f2n


def mju_insertionSort(list: _Floats) -> None:
    """Sorts numbers in place."""
    list.sort()


def mju_insertionSortInt(list: NDArray[np.int32]) -> None:
    """Sorts whole numbers in place."""
    list.sort()


def mju_mulQuatAxis(res: _Floats, quat: ArrayLike, axis: ArrayLike) -> None:
    """Computes the product of a quaternion and an axis."""
    res[...] = product(quat, [0.0, *np.reshape(np.asarray(axis, np.float64), 3)])


def mju_trnVecPose(res: _Floats, pos: ArrayLike, quat: ArrayLike, vec: ArrayLike) -> None:
    """Moves and turns a point by a pose."""
    res[...] = np.reshape(pos, 3) + matrix(quat) @ np.reshape(vec, 3)


def mju_cholFactor(mat: _Floats, mindiag: float) -> int:
    """Replaces a symmetric matrix by its Cholesky factor in the lower triangle, and returns the rank."""
    size, rank = len(mat), len(mat)
    for column in range(size):
        square = mat[column, column] - mat[column, :column] @ mat[column, :column]
        if square < mindiag:
            square = mindiag
            rank -= 1
        mat[column, column] = math.sqrt(square)
        below = slice(column + 1, size)
        mat[below, column] = (mat[below, column] - mat[below, :column] @ mat[column, :column]) / mat[column, column]
    return rank


def mju_cholSolve(res: _Floats, mat: ArrayLike, vec: ArrayLike) -> None:
    """Divides a vector by a matrix given by its Cholesky factor."""
    lower = np.tril(np.asarray(mat, np.float64))
    res[...] = np.linalg.solve(lower.T, np.linalg.solve(lower, np.asarray(vec, np.float64)))


def mju_cholUpdate(mat: _Floats, x: _Floats, flg_plus: int) -> int:
    """Adds the square of a vector to a matrix given by its Cholesky factor, or subtracts it; returns the rank."""
    size, rank = len(mat), len(mat)
    for k in range(size):
        if x[k] == 0:
            continue
        square = mat[k, k] ** 2 + (x[k] ** 2 if flg_plus else -(x[k] ** 2))
        if square < _LEAST:
            square = _LEAST
            rank -= 1
        root = math.sqrt(square)
        c, s = root / mat[k, k], x[k] / mat[k, k]
        mat[k, k] = root
        below = slice(k + 1, size)
        mat[below, k] = (mat[below, k] + (s if flg_plus else -s) * x[below]) / c
        x[below] = c * x[below] - s * mat[below, k]
    return rank


def mju_sqrMatTD(res: _Floats, mat: ArrayLike, diag: Optional[ArrayLike]) -> None:
    """Writes a transposed matrix times a diagonal one, if given, times the matrix."""
    left = np.asarray(mat, np.float64)
    res[...] = left.T @ (left if diag is None else np.asarray(diag, np.float64)[:, None] * left)


def mju_dense2sparse(
    res: _Floats,
    mat: ArrayLike,
    rownnz: NDArray[np.int32],
    rowadr: NDArray[np.int32],
    colind: NDArray[np.int32],
) -> int:
    """Writes a matrix as rows of numbers that are not 0, and returns whether there is too little room."""
    at = 0
    for row, values in enumerate(np.asarray(mat, np.float64)):
        rownnz[row], rowadr[row] = 0, at
        for column in np.flatnonzero(values):
            if at >= len(res) or at >= len(colind):
                return 1
            res[at], colind[at] = values[column], column
            at += 1
            rownnz[row] += 1
    return 0


def mju_sparse2dense(res: _Floats, mat: ArrayLike, rownnz: ArrayLike, rowadr: ArrayLike, colind: ArrayLike) -> None:
    """Writes a sparse matrix as a dense one."""
    values, columns = np.asarray(mat, np.float64), np.asarray(colind)
    res[...] = 0.0
    for row, (first, count) in enumerate(zip(np.asarray(rowadr), np.asarray(rownnz))):
        res[row, columns[first : first + count]] = values[first : first + count]


def mju_printMat(mat: ArrayLike) -> None:
    """Prints a matrix."""
    for row in np.asarray(mat, np.float64):
        print("".join(f"{value:.8f} " for value in row))
    print()


def mju_warningText(warning: int, info: int) -> str:
    """Refuses: there are no warnings here.

    Raises:
        NotImplementedError: Always.
    """
    raise NotImplementedError(
        f"mju_warningText: {mjtWarning(int(warning)).name} is an error here, which says what is wrong"
    )


def mju_writeNumBytes(nbytes: int) -> str:
    """Returns a number of bytes as text, in units of powers of 1024."""
    units, power = " KMGTPE", 0
    while power < 6 and nbytes >> (10 * (power + 1)):
        power += 1
    return f"{nbytes}" if power == 0 else f"{nbytes >> (10 * power)}{units[power]}"


def mjd_subQuat(qa: ArrayLike, qb: ArrayLike, Da: Optional[_Floats], Db: Optional[_Floats]) -> None:
    """Computes how ``mju_subQuat`` changes with both quaternions, in their tangent spaces, (3, 3)."""
    inverse = np.asarray(qb, np.float64) * [1.0, -1, -1, -1]
    axis = angular(product(inverse, qa))
    half = 0.5 * float(np.linalg.norm(axis))
    by_b = -np.eye(3)
    if half >= 6e-8:
        unit = axis / np.linalg.norm(axis)
        cross = np.array([[0, -unit[2], unit[1]], [unit[2], 0, -unit[0]], [-unit[1], unit[0], 0]])
        curved = 1 - half / math.tan(half)
        by_b = -np.eye(3) - half * cross - curved * cross @ cross
    if Da is not None:
        Da[...] = -by_b.reshape(np.shape(Da))
    if Db is not None:
        Db[...] = by_b.T.reshape(np.shape(Db))


def mjd_quatIntegrate(vel: ArrayLike, scale: float, Dquat: _Floats, Dvel: _Floats, Dscale: _Floats) -> None:
    """Computes how ``mju_quatIntegrate`` changes with the quaternion, the velocity (each (3, 3)) and the time (3)."""
    velocity = np.asarray(vel, np.float64).reshape(3)
    angle = scale * float(np.linalg.norm(velocity))
    x, y, z = scale * velocity
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    if angle > 6e-8:
        a, b = math.sin(angle) / angle, (1 - math.cos(angle)) / angle**2
        c = (1 - a) / angle**2
    else:
        a, b, c = 1.0, 0.5, 1.0 / 6
    by_quat = np.eye(3) - a * cross + b * cross @ cross
    by_velocity = np.eye(3) - b * cross + c * cross @ cross
    Dquat[...] = by_quat.reshape(np.shape(Dquat))
    Dvel[...] = by_velocity.reshape(np.shape(Dvel))
    Dscale[...] = (by_velocity @ velocity).reshape(np.shape(Dscale))
