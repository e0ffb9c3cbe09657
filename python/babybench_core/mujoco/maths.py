"""Quaternions, matrices and poses: the ``mju_`` functions that programs use. Results go into the first argument, as in MuJoCo."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "mju_axisAngle2Quat",
    "mju_cross",
    "mju_derivQuat",
    "mju_euler2Quat",
    "mju_mat2Quat",
    "mju_mulPose",
    "mju_mulQuat",
    "mju_negPose",
    "mju_negQuat",
    "mju_normalize",
    "mju_normalize3",
    "mju_normalize4",
    "mju_quat2Mat",
    "mju_quat2Vel",
    "mju_quatIntegrate",
    "mju_quatZ2Vec",
    "mju_rotVecQuat",
    "mju_subQuat",
    "mju_transformSpatial",
]

_Floats = NDArray[np.float64]
_LEAST = 1e-15


def _vector(values: ArrayLike, size: int) -> _Floats:
    array = np.asarray(values, np.float64).reshape(-1)
    if array.size != size:
        raise TypeError(f"expected {size} numbers, not {array.size}")
    return array


def product(left: ArrayLike, right: ArrayLike) -> _Floats:
    """Returns the product of two quaternions."""
    a, b = _vector(left, 4), _vector(right, 4)
    imaginary = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.concatenate([[a[0] * b[0] - a[1:] @ b[1:]], imaginary])


def turn(axis: ArrayLike, angle: float) -> _Floats:
    """Returns the quaternion that turns about a unit axis, rad."""
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * _vector(axis, 3)])


def matrix(quat: ArrayLike) -> _Floats:
    """Returns the matrix (3, 3) of a quaternion."""
    w, x, y, z = _vector(quat, 4)
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def angular(quat: ArrayLike) -> _Floats:
    """Returns the rotation vector of a quaternion, at most half a turn, rad."""
    q = _vector(quat, 4)
    length = float(np.linalg.norm(q[1:]))
    if length < _LEAST:
        return np.zeros(3)
    angle = 2 * np.arctan2(length, q[0])
    return np.asarray(q[1:] / length * (angle - 2 * np.pi if angle > np.pi else angle))


def mju_cross(res: _Floats, a: ArrayLike, b: ArrayLike) -> None:
    """Computes the cross product of two vectors."""
    res[...] = np.cross(_vector(a, 3), _vector(b, 3))


def mju_normalize(vec: _Floats) -> float:
    """Normalizes a vector and returns its earlier length; a zero vector becomes the first axis."""
    length = float(np.linalg.norm(vec))
    if length < _LEAST:
        vec[...] = 0.0
        vec[0] = 1.0
    else:
        vec /= length
    return length


def mju_normalize3(vec: _Floats) -> float:
    """As :func:`mju_normalize`, for three numbers."""
    _vector(vec, 3)
    return mju_normalize(vec)


def mju_normalize4(vec: _Floats) -> float:
    """As :func:`mju_normalize`, for a quaternion."""
    _vector(vec, 4)
    return mju_normalize(vec)


def mju_mulQuat(res: _Floats, quat1: ArrayLike, quat2: ArrayLike) -> None:
    """Computes the product of two quaternions."""
    res[...] = product(quat1, quat2)


def mju_negQuat(res: _Floats, quat: ArrayLike) -> None:
    """Computes the inverse of a unit quaternion."""
    res[...] = _vector(quat, 4) * [1.0, -1.0, -1.0, -1.0]


def mju_rotVecQuat(res: _Floats, vec: ArrayLike, quat: ArrayLike) -> None:
    """Turns a vector by a quaternion."""
    res[...] = matrix(quat) @ _vector(vec, 3)


def mju_axisAngle2Quat(res: _Floats, axis: ArrayLike, angle: float) -> None:
    """Computes the quaternion that turns about a unit axis, rad."""
    res[...] = turn(axis, angle)


def mju_quat2Mat(res: _Floats, quat: ArrayLike) -> None:
    """Computes the matrix of a quaternion, (9,) or (3, 3), row by row."""
    res[...] = matrix(quat).reshape(np.shape(res))


def mju_mat2Quat(quat: _Floats, mat: ArrayLike) -> None:
    """Computes the quaternion of a matrix, (9,) or (3, 3)."""
    m = _vector(mat, 9).reshape(3, 3)
    found = np.zeros(4)
    # this order decides which of the two quaternions results
    k = 0 if np.trace(m) > 0 else 1 + int(np.argmax(np.diag(m)))
    if k == 0:
        found[0] = np.sqrt(1 + np.trace(m)) / 2
        found[1:] = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]) / (4 * found[0])
    else:
        i, j, n = k - 1, k % 3, (k + 1) % 3
        found[1 + i] = np.sqrt(1 + m[i, i] - m[j, j] - m[n, n]) / 2
        found[0] = (m[n, j] - m[j, n]) / (4 * found[1 + i])
        found[1 + j] = (m[i, j] + m[j, i]) / (4 * found[1 + i])
        found[1 + n] = (m[i, n] + m[n, i]) / (4 * found[1 + i])
    quat[...] = found / np.linalg.norm(found)


def mju_quat2Vel(res: _Floats, quat: ArrayLike, dt: float) -> None:
    """Computes the angular velocity that turns by a quaternion in some time, rad/s."""
    res[...] = angular(quat) / dt


def mju_subQuat(res: _Floats, qa: ArrayLike, qb: ArrayLike) -> None:
    """Computes the rotation vector from one quaternion to another, in the frame of the second, rad."""
    difference = np.zeros(4)
    mju_negQuat(difference, qb)
    res[...] = angular(product(difference, qa))


def mju_quatIntegrate(quat: _Floats, vel: ArrayLike, scale: float) -> None:
    """Turns a quaternion by an angular velocity in its own frame, rad/s, for some time, s."""
    axis = _vector(vel, 3).copy()
    angle = scale * mju_normalize(axis)
    quat[...] = product(quat, turn(axis, angle))


def mju_derivQuat(res: _Floats, quat: ArrayLike, vel: ArrayLike) -> None:
    """Computes the rate of a quaternion at an angular velocity in the world, rad/s."""
    res[...] = 0.5 * product(np.concatenate([[0.0], _vector(vel, 3)]), quat)


def mju_quatZ2Vec(quat: _Floats, vec: ArrayLike) -> None:
    """Computes the quaternion that turns the z axis into the direction of a vector by the shortest rotation."""
    direction = _vector(vec, 3).copy()
    quat[...] = [1.0, 0.0, 0.0, 0.0]
    if mju_normalize(direction) < _LEAST:
        return
    axis = np.cross([0.0, 0.0, 1.0], direction)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-10:
        if direction[2] < 0:
            quat[...] = [0.0, 1.0, 0.0, 0.0]
        return
    quat[...] = turn(axis / sine, float(np.arctan2(sine, direction[2])))


def mju_euler2Quat(quat: _Floats, euler: ArrayLike, seq: str) -> None:
    """Computes the quaternion of three angles, rad; ``seq`` names axes: x, y, z turn with the body, X, Y, Z stay."""
    if len(seq) != 3 or any(axis not in "xyzXYZ" for axis in seq):
        raise ValueError(f"seq is {seq!r}, expected three of x, y, z, X, Y and Z")
    found = np.array([1.0, 0.0, 0.0, 0.0])
    for axis, angle in zip(seq, _vector(euler, 3)):
        part = turn(np.eye(3)["xyz".index(axis.lower())], float(angle))
        found = product(found, part) if axis.islower() else product(part, found)
    quat[...] = found


def mju_mulPose(
    posres: _Floats, quatres: _Floats, pos1: ArrayLike, quat1: ArrayLike, pos2: ArrayLike, quat2: ArrayLike
) -> None:
    """Computes the product of two poses: the second, given in the frame of the first."""
    position, orientation = matrix(quat1) @ _vector(pos2, 3) + _vector(pos1, 3), product(quat1, quat2)
    posres[...], quatres[...] = position, orientation / np.linalg.norm(orientation)


def mju_negPose(posres: _Floats, quatres: _Floats, pos: ArrayLike, quat: ArrayLike) -> None:
    """Computes the inverse of a pose."""
    inverse = _vector(quat, 4) * [1.0, -1.0, -1.0, -1.0]
    posres[...], quatres[...] = -(matrix(inverse) @ _vector(pos, 3)), inverse


def mju_transformSpatial(
    res: _Floats, vec: ArrayLike, flg_force: int, newpos: ArrayLike, oldpos: ArrayLike, rotnew2old: ArrayLike | None
) -> None:
    """Moves a motion (rotation, translation) or a force (torque, force) to another point, and into other axes if given."""
    v = _vector(vec, 6)
    offset = _vector(newpos, 3) - _vector(oldpos, 3)
    first, second = v[:3], v[3:]
    if flg_force:
        first = first - np.cross(offset, second)
    else:
        second = second - np.cross(offset, first)
    if rotnew2old is not None:
        rotation = _vector(rotnew2old, 9).reshape(3, 3)
        first, second = rotation.T @ first, rotation.T @ second
    res[...] = np.concatenate([first, second])
