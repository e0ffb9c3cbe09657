"""Rays against geoms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .data import MjData
from .jacobians import check
from .model import MjModel

__all__ = ["mj_multiRay", "mj_ray"]


def _hidden(m: MjModel, geomgroup: ArrayLike | None, flg_static: int) -> list[int]:
    """Returns the geoms that a ray passes through."""
    hidden = np.zeros(m.ngeom, bool)
    if geomgroup is not None:
        shown = np.asarray(geomgroup).ravel()
        if shown.size != 6:
            raise TypeError(f"geomgroup has {shown.size} numbers: it must have 6")
        hidden |= shown[np.clip(np.asarray(m.geom_group), 0, 5)] == 0
    if not flg_static:
        hidden |= np.asarray(m.body_weldid)[np.asarray(m.geom_bodyid)] == 0
    return [int(geom) for geom in np.flatnonzero(hidden)]


def _vector(values: ArrayLike, name: str) -> tuple[float, float, float]:
    vector = np.asarray(values, np.float64).ravel()
    if vector.size != 3:
        raise TypeError(f"{name} has {vector.size} numbers: it must have 3")
    x, y, z = (float(value) for value in vector)
    return x, y, z


def _cast(
    m: MjModel, d: MjData, pnt: ArrayLike, vec: ArrayLike, hidden: Sequence[int], bodyexclude: int
) -> tuple[int, float]:
    without = int(bodyexclude) if bodyexclude >= 0 else None
    hit = d._own.ray(_vector(pnt, "pnt"), _vector(vec, "vec"), without, hidden)
    return (-1, -1.0) if hit is None else hit


def mj_ray(
    m: MjModel,
    d: MjData,
    pnt: ArrayLike,
    vec: ArrayLike,
    geomgroup: ArrayLike | None,
    flg_static: int,
    bodyexclude: int,
    geomid: NDArray[np.int32] | None = None,
) -> float:
    """Returns the distance at which a ray meets a geom, in lengths of ``vec``; -1 if it meets none.

    Args:
        m: The model.
        d: The state, with poses computed.
        pnt: The start of the ray, m.
        vec: The direction of the ray.
        geomgroup: Which of the six groups of geoms count; all by default.
        flg_static: Whether geoms that cannot move count.
        bodyexclude: A body whose geoms do not count; -1 for none.
        geomid: Receives the id of the geom, -1 for none.
    """
    check(m, d)
    geom, distance = _cast(m, d, pnt, vec, _hidden(m, geomgroup, flg_static), bodyexclude)
    if geomid is not None:
        geomid[...] = geom
    return distance


def mj_multiRay(
    m: MjModel,
    d: MjData,
    pnt: ArrayLike,
    vec: ArrayLike,
    geomgroup: ArrayLike | None,
    flg_static: int,
    bodyexclude: int,
    geomid: Any,
    dist: NDArray[np.float64],
    nray: int,
    cutoff: float,
) -> None:
    """Writes the distances at which rays from one point meet geoms, and the geoms; -1 for none, or none within ``cutoff``."""
    check(m, d)
    directions = np.asarray(vec, np.float64).reshape(-1, 3)
    if len(directions) != nray or np.size(dist) != nray or (geomid is not None and np.size(geomid) != nray):
        raise TypeError(f"nray is {nray}: vec must have 3 numbers for each, dist and geomid one")
    hidden = _hidden(m, geomgroup, flg_static)
    for number, direction in enumerate(directions):
        geom, distance = _cast(m, d, pnt, direction, hidden, bodyexclude)
        if distance > cutoff:
            geom, distance = -1, -1.0
        dist[number] = distance
        if geomid is not None:
            geomid[number] = geom
