"""MuJoCo's functions on vectors and matrices, ``mju_*``."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Floats = NDArray[np.float64]

__all__ = [
    "mju_L1",
    "mju_add",
    "mju_add3",
    "mju_addScl",
    "mju_addScl3",
    "mju_addTo",
    "mju_addTo3",
    "mju_addToScl",
    "mju_addToScl3",
    "mju_clip",
    "mju_copy",
    "mju_copy3",
    "mju_copy4",
    "mju_dist3",
    "mju_dot",
    "mju_dot3",
    "mju_eye",
    "mju_fill",
    "mju_max",
    "mju_min",
    "mju_mulMatMat",
    "mju_mulMatMatT",
    "mju_mulMatTMat",
    "mju_mulMatTVec",
    "mju_mulMatTVec3",
    "mju_mulMatVec",
    "mju_mulMatVec3",
    "mju_mulVecMatVec",
    "mju_norm",
    "mju_norm3",
    "mju_scl",
    "mju_scl3",
    "mju_sign",
    "mju_sub",
    "mju_sub3",
    "mju_subFrom",
    "mju_subFrom3",
    "mju_sum",
    "mju_symmetrize",
    "mju_transpose",
    "mju_unit4",
    "mju_zero",
    "mju_zero3",
    "mju_zero4",
]


def _into(res: _Floats, value: Any, name: str, size: int | None = None) -> None:
    value = np.asarray(value, np.float64)
    if res.size != value.size or (size is not None and res.size != size):
        raise TypeError(f"{name}: res has {res.size} numbers, and the result {value.size if size is None else size}")
    res[...] = value.reshape(res.shape)


def mju_zero(res: _Floats) -> None:
    """Sets all numbers to 0."""
    res[...] = 0


def mju_fill(res: _Floats, val: float) -> None:
    """Sets all numbers to a value."""
    res[...] = val


def mju_copy(res: _Floats, vec: ArrayLike) -> None:
    """Copies a vector."""
    _into(res, vec, "mju_copy")


def mju_add(res: _Floats, vec1: ArrayLike, vec2: ArrayLike) -> None:
    """Writes a sum of vectors."""
    _into(res, np.add(vec1, vec2), "mju_add")


def mju_sub(res: _Floats, vec1: ArrayLike, vec2: ArrayLike) -> None:
    """Writes a difference of vectors."""
    _into(res, np.subtract(vec1, vec2), "mju_sub")


def mju_addTo(res: _Floats, vec: ArrayLike) -> None:
    """Adds a vector."""
    _into(res, res + np.asarray(vec), "mju_addTo")


def mju_subFrom(res: _Floats, vec: ArrayLike) -> None:
    """Subtracts a vector."""
    _into(res, res - np.asarray(vec), "mju_subFrom")


def mju_addToScl(res: _Floats, vec: ArrayLike, scl: float) -> None:
    """Adds a vector times a number."""
    _into(res, res + np.asarray(vec) * scl, "mju_addToScl")


def mju_addScl(res: _Floats, vec1: ArrayLike, vec2: ArrayLike, scl: float) -> None:
    """Writes a vector plus another times a number."""
    _into(res, np.asarray(vec1) + np.asarray(vec2) * scl, "mju_addScl")


def mju_scl(res: _Floats, vec: ArrayLike, scl: float) -> None:
    """Writes a vector times a number."""
    _into(res, np.asarray(vec) * scl, "mju_scl")


mju_zero3 = mju_zero4 = mju_zero
mju_copy3 = mju_copy4 = mju_copy
mju_add3, mju_sub3, mju_scl3 = mju_add, mju_sub, mju_scl
mju_addTo3, mju_subFrom3, mju_addToScl3, mju_addScl3 = mju_addTo, mju_subFrom, mju_addToScl, mju_addScl


def mju_unit4(res: _Floats) -> None:
    """Writes the identity quaternion."""
    _into(res, [1.0, 0.0, 0.0, 0.0], "mju_unit4")


def mju_sum(vec: ArrayLike) -> float:
    """Returns the sum of the numbers."""
    return float(np.sum(vec))


def mju_L1(vec: ArrayLike) -> float:
    """Returns the sum of the magnitudes."""
    return float(np.abs(vec).sum())


def mju_dot(vec1: ArrayLike, vec2: ArrayLike) -> float:
    """Returns a scalar product."""
    return float(np.dot(vec1, vec2))


def mju_norm(vec: ArrayLike) -> float:
    """Returns the length of a vector."""
    return float(np.sqrt(np.dot(vec, vec)))


mju_dot3, mju_norm3 = mju_dot, mju_norm


def mju_dist3(pos1: ArrayLike, pos2: ArrayLike) -> float:
    """Returns the distance between two points."""
    return mju_norm(np.subtract(pos1, pos2))


def mju_mulMatVec(res: _Floats, mat: ArrayLike, vec: ArrayLike) -> None:
    """Writes a matrix times a vector."""
    _into(res, np.asarray(mat) @ np.asarray(vec), "mju_mulMatVec")


def mju_mulMatTVec(res: _Floats, mat: ArrayLike, vec: ArrayLike) -> None:
    """Writes a transposed matrix times a vector."""
    _into(res, np.asarray(mat).T @ np.asarray(vec), "mju_mulMatTVec")


def mju_mulMatVec3(res: _Floats, mat: ArrayLike, vec: ArrayLike) -> None:
    """Writes a matrix of nine numbers times a vector."""
    _into(res, np.reshape(mat, (3, 3)) @ np.asarray(vec), "mju_mulMatVec3")


def mju_mulMatTVec3(res: _Floats, mat: ArrayLike, vec: ArrayLike) -> None:
    """Writes a transposed matrix of nine numbers times a vector."""
    _into(res, np.reshape(mat, (3, 3)).T @ np.asarray(vec), "mju_mulMatTVec3")


def mju_mulVecMatVec(vec1: ArrayLike, mat: ArrayLike, vec2: ArrayLike) -> float:
    """Returns a vector times a square matrix times a vector."""
    return float(np.asarray(vec1) @ np.asarray(mat) @ np.asarray(vec2))


def mju_mulMatMat(res: _Floats, mat1: ArrayLike, mat2: ArrayLike) -> None:
    """Writes a product of matrices."""
    _into(res, np.asarray(mat1) @ np.asarray(mat2), "mju_mulMatMat")


def mju_mulMatMatT(res: _Floats, mat1: ArrayLike, mat2: ArrayLike) -> None:
    """Writes a matrix times a transposed one."""
    _into(res, np.asarray(mat1) @ np.asarray(mat2).T, "mju_mulMatMatT")


def mju_mulMatTMat(res: _Floats, mat1: ArrayLike, mat2: ArrayLike) -> None:
    """Writes a transposed matrix times a matrix."""
    _into(res, np.asarray(mat1).T @ np.asarray(mat2), "mju_mulMatTMat")


def mju_transpose(res: _Floats, mat: ArrayLike) -> None:
    """Writes a transposed matrix."""
    _into(res, np.asarray(mat).T.copy(), "mju_transpose")


def mju_symmetrize(res: _Floats, mat: ArrayLike) -> None:
    """Writes the mean of a matrix and its transpose."""
    matrix = np.asarray(mat, np.float64)
    _into(res, 0.5 * (matrix + matrix.T), "mju_symmetrize")


def mju_eye(mat: _Floats) -> None:
    """Writes the identity matrix."""
    _into(mat, np.eye(mat.shape[0]), "mju_eye")


def mju_min(a: float, b: float) -> float:
    """Returns the smaller number."""
    return min(float(a), float(b))


def mju_max(a: float, b: float) -> float:
    """Returns the greater number."""
    return max(float(a), float(b))


def mju_clip(x: float, min: float, max: float) -> float:
    """Returns a number within bounds."""
    return float(np.clip(x, min, max))


def mju_sign(x: float) -> float:
    """Returns the sign of a number: 1, 0 or -1."""
    return math.copysign(1.0, x) if x else 0.0
