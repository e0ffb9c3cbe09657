"""MuJoCo's fields that are not kept: arrays of flexes and plugins, and those that are not computed."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .options import MISSING

_EMPTY: dict[str, dict[int, str]] = {
    "int32": {
        0: """flex_activelayers flex_bvhadr flex_bvhnum flex_conaffinity flex_condim flex_contype flex_dim flex_edgeadr
        flex_edgenum flex_elem flex_elemadr flex_elemdataadr flex_elemedge flex_elemedgeadr flex_elemlayer
        flex_elemnum flex_evpairadr flex_evpairnum flex_group flex_interp flex_matid flex_nodeadr
        flex_nodebodyid flex_nodenum flex_priority flex_selfcollide flex_shell flex_shelldataadr flex_shellnum
        flex_texcoordadr flex_vertadr flex_vertbodyid flex_vertnum plugin plugin_attradr plugin_stateadr
        plugin_statenum name_flexadr name_pluginadr flexedge_J_rowadr flexedge_J_rownnz""",
        2: "flex_edge flex_evpair",
        6: "flexedge_J_colind",
    },
    "uint8": {0: "flex_centered flex_edgeequality flex_flatskin flex_internal flex_rigid flexedge_rigid"},
    "int8": {0: "plugin_attr"},
    "uint64": {0: "plugin_data"},
    "float32": {2: "flex_texcoord", 4: "flex_rgba"},
    "float64": {
        0: """flex_damping flex_edgedamping flex_edgestiffness flex_gap flex_margin flex_radius flex_solmix
        flexedge_invweight0 flexedge_length0 flexedge_length flexedge_velocity plugin_state""",
        2: "flex_solref",
        3: "flex_friction flex_node flex_node0 flex_vert flex_vert0 flexvert_xpos",
        5: "flex_solimp",
        6: "flexedge_J flexelem_aabb",
        21: "flex_stiffness",
    },
}
"""Fields of flexes and plugins by type and numbers in a row. No plugins load here; most fields of flexes exist."""

EMPTY: dict[str, tuple[str, int]] = {
    name: (dtype, width) for dtype, rows in _EMPTY.items() for width, names in rows.items() for name in names.split()
}
"""Type and numbers in a row of fields that are empty in models without flexes."""

NO_PLUGINS = ("npluginattr", "npluginstate")
FLEX_SIZES = {
    "nflexedge": "flex_edge",
    "nflexelem": "flex_elemlayer",
    "nflexelemdata": "flex_elem",
    "nflexelemedge": "flex_elemedge",
    "nflexevpair": "flex_evpair",
    "nflexnode": "flex_nodebodyid",
    "nflexshelldata": "flex_shell",
    "nflextexcoord": "flex_texcoord",
    "nflexvert": "flex_vertbodyid",
}
"""Sizes of flexes, each with an array of that length."""

NOT_OF_MODELS = frozenset(
    (
        *("bvh_aabb", "bvh_child", "bvh_depth", "bvh_nodeid", "body_bvhadr"),
        *("body_bvhnum", "mesh_bvhadr", "mesh_bvhnum", "body_simple", "dof_simplenum"),
        *("mesh_graph", "mesh_graphadr", "mesh_facetexcoord", "mesh_pathadr", "mesh_polyadr"),
        *("mesh_polymap", "mesh_polymapadr", "mesh_polymapnum", "mesh_polynormal", "mesh_polynum"),
        *("mesh_polyvert", "mesh_polyvertadr", "mesh_polyvertnum", "hfield_pathadr", "skin_pathadr"),
        *("tex_pathadr", "paths", "names_map", "skin_boneadr", "skin_bonebindpos"),
        *("skin_bonebindquat", "skin_bonebodyid", "skin_bonenum", "skin_bonevertadr", "skin_bonevertid"),
        *("skin_bonevertnum", "skin_bonevertweight", "skin_face", "skin_faceadr", "skin_facenum"),
        *("skin_inflate", "skin_rgba", "skin_texcoord", "skin_texcoordadr", "skin_vert"),
        *("skin_vertadr", "skin_vertnum", "tex_adr", "tex_data", "tex_height"),
        *("tex_nchannel", "tex_type", "tex_width", "tuple_adr", "tuple_objid"),
        *("tuple_objprm", "tuple_objtype", "tuple_size", "light_bulbradius", "mat_metallic"),
        *("mat_roughness", "cam_ipd", "text_adr", "text_data", "text_size"),
    )
)
"""Fields of MuJoCo's models that are not kept here."""

NOT_OF_STATES = frozenset(
    (
        *("B_colind", "B_rowadr", "B_rownnz", "C_colind", "C_rowadr"),
        *("C_rownnz", "D_colind", "D_diag", "D_rowadr", "D_rownnz"),
        *("actuator_moment", "bvh_aabb_dyn", "bvh_active", "crb", "dof_island"),
        *("dof_islandind", "efc_AR", "efc_AR_colind", "efc_AR_rowadr", "efc_AR_rownnz"),
        *("efc_JT", "efc_JT_colind", "efc_JT_rowadr", "efc_JT_rownnz", "efc_JT_rowsuper"),
        *("efc_J_colind", "efc_J_rowadr", "efc_J_rownnz", "efc_J_rowsuper", "efc_KBIP"),
        *("efc_b", "efc_diagApprox", "efc_frictionloss", "efc_island", "efc_state"),
        *("island_dofadr", "island_dofind", "island_dofnum", "island_efcadr", "island_efcind"),
        *("island_efcnum", "light_xdir", "light_xpos", "mapD2M", "mapM2C"),
        *("mapM2D", "moment_colind", "moment_rowadr", "moment_rownnz", "qDeriv"),
        *("qH", "qHDiagInv", "qLD", "qLDiagInv", "qLU"),
        *("qfrc_damper", "qfrc_fluid", "qfrc_gravcomp", "qfrc_spring", "solver_niter"),
        *("solver_nnz", "ten_J_colind", "ten_J_rowadr", "ten_J_rownnz", "ten_wrapadr"),
        *("ten_wrapnum", "tendon_efcadr", "wrap_obj", "wrap_xpos", "nisland"),
        *("timer", "solver", "solver_nisland", "maxuse_arena", "maxuse_con"),
        *("maxuse_efc", "maxuse_stack", "maxuse_threadstack", "threadpool", "nA"),
        *("nJ", "narena", "nbuffer", "parena", "pbase"),
        *("pstack", "nplugin"),
    )
)
"""Fields of MuJoCo's states that are not computed here."""


def empty(name: str, flexes: int, of: str) -> Any:
    """Returns an empty array of a field; for a field of flexes that is not kept, a placeholder if the model has flexes."""
    if flexes and "flex" in name:
        return Absent(f"{of}.{name}")
    dtype, width = EMPTY[name]
    return np.zeros((0, width) if width else 0, dtype)


class Absent:
    """A placeholder for a field of MuJoCo's that is not kept here. Programs that list fields may hold it; any use is an error."""

    __slots__ = ("_text",)

    def __init__(self, name: str) -> None:
        """Takes the name of the field."""
        object.__setattr__(self, "_text", MISSING.format(name=name))

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise AttributeError(object.__getattribute__(self, "_text"))

    def __getattr__(self, name: str) -> NoReturn:
        self._refuse()

    __setattr__ = __getitem__ = __setitem__ = __len__ = __iter__ = __array__ = __call__ = _refuse
    __int__ = __float__ = __index__ = __bool__ = __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _refuse
    __eq__ = __ne__ = __lt__ = __le__ = __gt__ = __ge__ = _refuse
    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<{object.__getattribute__(self, '_text')}>"


_KINDS = {
    **{
        "body": "body",
        "jnt": "joint",
        "geom": "geom",
        "site": "site",
        "cam": "camera",
        "light": "light",
        "mesh": "mesh",
    },
    **{"skin": "skin", "hfield": "hfield", "tex": "texture", "mat": "material", "eq": "equality", "tendon": "tendon"},
    **{"actuator": "actuator", "sensor": "sensor", "numeric": "numeric", "text": "text", "key": "key"},
}
"""Kinds of elements whose names a model keeps, in the order in which MuJoCo has them one after another."""
_UNNAMED = ("pair", "exclude", "tuple")
"""Kinds of elements whose names are not kept: they have none here."""

NAME_ADDRESSES = tuple(f"name_{kind}adr" for kind in (*_KINDS, *_UNNAMED))


def name_block(
    model_name: str, names: dict[str, list[str]], unnamed: dict[str, int]
) -> tuple[bytes, dict[str, NDArray[np.int32]]]:
    """Returns all names, each with a terminating zero, that of the model first, and where those of each kind start.

    ``unnamed`` are numbers of elements without names, by kind.
    """
    block = bytearray(model_name.encode() + b"\0")
    found = {}
    for short, kind in _KINDS.items():
        starts = []
        for name in names[kind]:
            starts.append(len(block))
            block += name.encode() + b"\0"
        found[f"name_{short}adr"] = np.array(starts, np.int32)
    for kind in _UNNAMED:
        found[f"name_{kind}adr"] = np.full(unnamed.get(kind, 0), len(block) - 1, np.int32)
    return bytes(block), found
