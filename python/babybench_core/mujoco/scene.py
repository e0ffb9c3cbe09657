"""Scenes with geoms that programs add to pictures: ``MjvScene``, ``MjvGeom``, ``mjv_initGeom`` and the like."""

from __future__ import annotations

from typing import Any, ClassVar, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .enums import mjtGeom
from .maths import matrix, mju_quatZ2Vec
from .structs import Struct

__all__ = ["MjvGLCamera", "MjvGeom", "MjvLight", "MjvScene", "mjv_connector", "mjv_initGeom"]


def _zeros(*shape: int) -> NDArray[np.float32]:
    return np.zeros(shape, np.float32)


class MjvGeom(Struct):
    """A geom that a program adds to a picture.

    Attributes:
        type: Shape, one of ``mjtGeom``.
        size: Radii and half lengths, (3,), m.
        pos: Position of the centre, (3,), m.
        mat: Orientation, (3, 3).
        rgba: Colour and opacity, (4,), 0 to 1.
        label: Text beside it, which is not drawn.
    """

    FIELDS: ClassVar = {
        **{
            "type": int(mjtGeom.mjGEOM_NONE),
            "dataid": -1,
            "objtype": 0,
            "objid": 0,
            "category": 0,
            "matid": -1,
            "texcoord": 0,
        },
        **{"segid": 0, "size": np.full(3, 0.1, np.float32), "pos": _zeros(3), "mat": np.eye(3, dtype=np.float32)},
        **{"rgba": np.array([0.5, 0.5, 0.5, 1], np.float32), "emission": 0.0, "specular": 0.5, "shininess": 0.5},
        **{"reflectance": 0.0, "label": "", "camdist": 0.0, "modelrbound": 0.0, "transparent": 0},
    }


class MjvLight(Struct):
    """A light of a scene. Pictures have the lights of the model, whatever is here."""

    FIELDS: ClassVar = {
        **{
            "pos": _zeros(3),
            "dir": _zeros(3),
            "attenuation": _zeros(3),
            "cutoff": 0.0,
            "exponent": 0.0,
            "ambient": _zeros(3),
        },
        **{
            "diffuse": _zeros(3),
            "specular": _zeros(3),
            "headlight": 0,
            "directional": 0,
            "castshadow": 0,
            "bulbradius": 0.0,
        },
    }


class MjvGLCamera(Struct):
    """A camera in OpenGL's terms, which pictures do not follow."""

    FIELDS: ClassVar = {
        **{"pos": _zeros(3), "forward": _zeros(3), "up": _zeros(3)},
        **dict.fromkeys([f"frustum_{name}" for name in ("center", "width", "bottom", "top", "near", "far")], 0.0),
        "orthographic": 0,
    }


class MjvScene(Struct):
    """Geoms that a program adds to pictures. Those of the model are not in it: they are drawn from the state."""

    FIELDS: ClassVar = {
        **{"maxgeom": 0, "nlight": 0, "nskin": 0, "nflex": 0, "enabletransform": 0, "stereo": 0, "framewidth": 0},
        **{"translate": _zeros(3), "rotate": np.array([1, 0, 0, 0], np.float32), "scale": 1.0, "framergb": _zeros(3)},
        "flags": np.array([1, 0, 1, 0, 1, 0, 1, 0, 0, 1], np.uint8),
    }

    def __init__(self, model: Any = None, maxgeom: int = 0) -> None:
        """Takes the number of geoms that may be added."""
        super().__init__()
        self.maxgeom = int(maxgeom)
        self.__dict__.update(_geoms=[], _ngeom=0)
        self.__dict__["camera"] = (MjvGLCamera(), MjvGLCamera())

    @property
    def geoms(self) -> tuple[MjvGeom, ...]:
        """All geoms that may be added; the first :attr:`ngeom` of them are drawn."""
        known: list[MjvGeom] = self._geoms
        while len(known) < self.maxgeom:
            known.append(MjvGeom())
        return tuple(known)

    @property
    def ngeom(self) -> int:
        """Number of geoms that are drawn."""
        return int(self._ngeom)

    @ngeom.setter
    def ngeom(self, value: int) -> None:
        if not 0 <= int(value) <= self.maxgeom:
            raise ValueError(f"ngeom is {value}: the scene has room for 0 to {self.maxgeom} geoms")
        self.__dict__["_ngeom"] = int(value)


def mjv_initGeom(
    geom: MjvGeom,
    type: int,
    size: Optional[ArrayLike],
    pos: Optional[ArrayLike],
    mat: Optional[ArrayLike],
    rgba: Optional[ArrayLike],
) -> None:
    """Makes a geom of a type, with MuJoCo's default values where nothing is given."""
    MjvGeom.__init__(geom)
    geom.type = int(type)
    for name, value in (("size", size), ("pos", pos), ("mat", mat), ("rgba", rgba)):
        if value is not None:
            own = geom.__dict__[name]
            own[...] = np.reshape(np.asarray(value, np.float64), own.shape)
    if size is not None and type in (mjtGeom.mjGEOM_SPHERE, mjtGeom.mjGEOM_CAPSULE, mjtGeom.mjGEOM_CYLINDER):
        # in a scene both radii come first, then the half length
        radius, half = geom.size[0], geom.size[0 if type == mjtGeom.mjGEOM_SPHERE else 1]
        geom.size[:] = [radius, radius, half]


def mjv_connector(geom: MjvGeom, type: int, width: float, from_: ArrayLike, to: ArrayLike) -> None:
    """Makes a geom connect two points, m: a capsule, cylinder, arrow or line of a width (radius; pixels of a line)."""
    start, end = (np.reshape(np.asarray(point, np.float64), 3) for point in (from_, to))
    kinds = ("CAPSULE", "CYLINDER", "ARROW", "ARROW1", "ARROW2", "LINE")
    if type not in [mjtGeom[f"mjGEOM_{kind}"] for kind in kinds]:
        raise ValueError(f"mjv_connector: invalid geom type {int(type)}: it must be a {', '.join(kinds).lower()}")
    apart, quat = end - start, np.zeros(4)
    length = float(np.linalg.norm(apart))
    mju_quatZ2Vec(quat, apart)
    whole = type in (mjtGeom.mjGEOM_ARROW, mjtGeom.mjGEOM_ARROW1, mjtGeom.mjGEOM_ARROW2, mjtGeom.mjGEOM_LINE)
    geom.type = int(type)
    geom.size[:] = [width, width, length if whole else length / 2]
    if type in (mjtGeom.mjGEOM_CAPSULE, mjtGeom.mjGEOM_CYLINDER):
        geom.size[:] = [width, width, length / 2]
    geom.pos[:] = start if whole else (start + end) / 2
    geom.mat[:] = matrix(quat)


_DRAWN = {
    mjtGeom.mjGEOM_SPHERE: mjtGeom.mjGEOM_SPHERE,
    mjtGeom.mjGEOM_CAPSULE: mjtGeom.mjGEOM_CAPSULE,
    mjtGeom.mjGEOM_ELLIPSOID: mjtGeom.mjGEOM_ELLIPSOID,
    mjtGeom.mjGEOM_CYLINDER: mjtGeom.mjGEOM_CYLINDER,
    mjtGeom.mjGEOM_BOX: mjtGeom.mjGEOM_BOX,
    mjtGeom.mjGEOM_LINE: mjtGeom.mjGEOM_CAPSULE,
    mjtGeom.mjGEOM_LINEBOX: mjtGeom.mjGEOM_BOX,
}
_LINE_RADIUS = 0.002
"""Radius of the capsule that a line one pixel wide is drawn as, m."""


def marker(geom: MjvGeom) -> tuple[int, list[float], list[float], list[float], list[float]]:
    """Returns shape, size, position, orientation and colour with which a geom is drawn.

    Raises:
        ValueError: Geoms of its type are not drawn.
    """
    shape = _DRAWN.get(mjtGeom(geom.type))
    if shape is None:
        raise ValueError(
            f"a geom of the scene is a {mjtGeom(geom.type).name}: spheres, capsules, ellipsoids, cylinders, boxes and lines are "
            "drawn; make an arrow of a cylinder and a sphere"
        )
    size, pos = geom.size.astype(np.float64), geom.pos.astype(np.float64)
    turn = geom.mat.astype(np.float64)
    if geom.type == mjtGeom.mjGEOM_LINE:
        pos = pos + turn[:, 2] * size[2] / 2
        size = np.array([_LINE_RADIUS * size[0], size[2] / 2, 0])
    elif shape in (mjtGeom.mjGEOM_CAPSULE, mjtGeom.mjGEOM_CYLINDER):
        # the half length is the last of three numbers in a scene, and the second in a model
        size = np.array([size[0], size[2], 0])
    return int(shape), size.tolist(), pos.tolist(), turn.reshape(-1).tolist(), geom.rgba.astype(np.float64).tolist()
