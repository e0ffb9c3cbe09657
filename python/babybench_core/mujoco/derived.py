"""Arrays of a model that follow from others: addresses, trees, the sparse order of the inertia."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["DERIVED", "matrix_places"]


def _keys(name: str, size: str, each: int = 1) -> Callable[[Any], Any]:
    return lambda m: np.asarray(m._extras[name]).reshape(m.nkey, each * getattr(m, size))


def starts(counts: NDArray[Any]) -> NDArray[np.int32]:
    starts: NDArray[np.int32] = (np.cumsum(counts) - counts).astype(np.int32)
    return starts


def _trees(m: Any) -> NDArray[np.int32]:
    """Returns the number of the tree of each body: -1 for those that cannot move."""
    roots: dict[int, int] = {}
    found = np.full(m.nbody, -1, np.int32)
    parents, moves = m.body_parentid, m.body_dofnum
    for body in range(1, m.nbody):
        above = found[parents[body]]
        if above < 0 and moves[body]:
            above = roots.setdefault(body, len(roots))
        found[body] = above
    return found


def _matrix_addresses(m: Any) -> NDArray[np.int32]:
    """Returns where the row of each degree of freedom starts in ``qM``."""
    depth = np.zeros(m.nv, np.int32)
    for dof, parent in enumerate(m.dof_parentid):
        depth[dof] = 1 + (depth[parent] if parent >= 0 else 0)
    return starts(depth)


def matrix_places(m: Any) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Returns the row and the column in the full matrix of each number of ``qM``."""
    found = m.__dict__.get("_places")
    if found is None:
        rows, columns = [], []
        parents = m.dof_parentid
        for dof in range(m.nv):
            other = dof
            while other >= 0:
                rows.append(dof)
                columns.append(other)
                other = int(parents[other])
        found = np.array(rows, np.intp), np.array(columns, np.intp)
        m.__dict__["_places"] = found
    places: tuple[NDArray[np.intp], NDArray[np.intp]] = found
    return places


def _without_plugin(size: str) -> Callable[[Any], Any]:
    return lambda m: np.full(getattr(m, size), -1, np.int32)


def _bits_of_bodies(name: str) -> Callable[[Any], Any]:
    def found(m: Any) -> NDArray[np.int32]:
        bits = np.zeros(m.nbody, np.int32)
        np.bitwise_or.at(bits, m.geom_bodyid, getattr(m, name))
        return bits

    return found


def _body_margins(m: Any) -> NDArray[np.float64]:
    margins = np.zeros(m.nbody)
    np.maximum.at(margins, m.geom_bodyid, m.geom_margin)
    return margins


DERIVED: dict[str, Callable[[Any], Any]] = {
    "body_plugin": _without_plugin("nbody"),
    "geom_plugin": _without_plugin("ngeom"),
    "actuator_plugin": _without_plugin("nu"),
    "sensor_plugin": _without_plugin("nsensor"),
    "body_contype": _bits_of_bodies("geom_contype"),
    "body_conaffinity": _bits_of_bodies("geom_conaffinity"),
    "body_margin": _body_margins,
    "pair_signature": lambda m: (m.geom_bodyid[m.pair_geom1] << 16) + m.geom_bodyid[m.pair_geom2],
    "ngravcomp": lambda m: int(np.count_nonzero(m.body_gravcomp)),
    "nmeshvert": lambda m: len(m.mesh_vert),
    "nmeshnormal": lambda m: len(m.mesh_normal),
    "nmeshface": lambda m: len(m.mesh_face),
    "nmeshtexcoord": lambda m: len(m.mesh_texcoord),
    "nhfielddata": lambda m: len(m.hfield_data),
    "nnumericdata": lambda m: len(m.numeric_data),
    "nnames": lambda m: len(m.names),
    "cam_orthographic": lambda m: m._compiled("cam_orthographic").astype(np.int32),
    "dof_M0": lambda m: m._compiled("dof_m0"),
    "dof_Madr": _matrix_addresses,
    "dof_treeid": lambda m: m.body_treeid[m.dof_bodyid],
    "body_treeid": _trees,
    "nM": lambda m: len(matrix_places(m)[0]),
    "ntree": lambda m: int(m.body_treeid.max(initial=-1)) + 1,
    "pair_geom1": lambda m: m._compiled("pair_geom").reshape(-1, 2)[:, 0],
    "pair_geom2": lambda m: m._compiled("pair_geom").reshape(-1, 2)[:, 1],
    "exclude_signature": lambda m: m._compiled("exclude").reshape(-1, 2) @ np.array([1 << 16, 1], np.int32),
    "actuator_trnid": lambda m: np.stack([m._compiled("actuator_trnid"), m._compiled("actuator_refid")], axis=1),
    "actuator_actnum": lambda m: (m._compiled("actuator_actadr") >= 0).astype(np.int32),
    "tendon_adr": lambda m: starts(m.tendon_num),
    "numeric_size": lambda m: np.array([len(data) for data in m._extras["numeric_data"]], np.int32),
    "numeric_adr": lambda m: starts(m.numeric_size),
    "numeric_data": lambda m: np.array([value for data in m._extras["numeric_data"] for value in data], np.float64),
    "key_mpos": _keys("key_mpos", "nmocap", 3),
    "key_mquat": _keys("key_mquat", "nmocap", 4),
}
