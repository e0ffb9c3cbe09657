"""The attributes of the kit's environment and of the one in its place: names, types, shapes, order and values."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from .conftest import CONFIGS

Recordings = Callable[[str, str], dict[str, Any]]

TOLERANCE = 1e-9
SECTIONS = (
    "env",
    "touch",
    "proprioception",
    "vestibular",
    "vision",
    "actuation_model",
    "mujoco_renderer",
    "model",
    "data",
)
WHOLE = ("spaces", "order", "elements", "contacts", "counts", "empty")

# what is another thing on purpose
APART = {
    # folders of the recordings
    "env.fullpath",
    "env.save_dir",
    # sensors are points here, not meshes; OpenGL's window
    "touch.meshes",
    "touch.active_vertices",
    "mujoco_renderer.viewer",
    # textures are small ones here
    "model.nbuffer",
    "model.ntexdata",
    "model.tex_adr",
    "model.tex_height",
    "model.tex_width",
    "model.tex_nchannel",
    "model.tex_pathadr",
    "model.npaths",
    "model.paths",
    "model.vis",
    # MuJoCo's memory, and what its solver left there
    *(f"data.maxuse_{of}" for of in ("arena", "con", "efc", "stack", "threadstack")),
    *(
        f"data.{of}"
        for of in ("narena", "nbuffer", "parena", "pstack", "pbase", "timer", "warning", "solver", "threadpool")
    ),
    *(f"data.solver_{of}" for of in ("nisland", "niter", "nnz", "fwdinv")),
    *(f"data.{of}" for of in ("nisland", "dof_island", "dof_islandind", "efc_island", "efc_state", "efc_b")),
    *(f"data.island_{of}" for of in ("dofadr", "dofind", "dofnum", "efcadr", "efcind", "efcnum")),
    *(f"data.efc_{j}_{of}" for j in ("J", "JT", "AR") for of in ("colind", "rowadr", "rownnz", "rowsuper")),
    *(f"data.{of}" for of in ("efc_AR", "efc_J", "efc_JT", "qH", "qHDiagInv", "qLU", "qDeriv", "act_dot")),
    *(f"data.{of}" for of in ("qfrc_inverse", "bvh_active", "bvh_aabb_dyn", "subtree_linvel", "subtree_angmom")),
    "data.time",
    # the kit inverts normals in place, in MuJoCo's own memory
    "contacts.frame",
    "contacts.single",
}
# the names of the types of what stands for MuJoCo's
STANDING_IN = {
    "DataView": "MjData",
    "ModelView": "MjModel",
    "Options": "MjOption",
    "Settings": "MjStatistic",
    "ContactList": "_MjContactList",
    "Spacings": "dict",
}
# what the solver computes: relative to the largest number
SOLVED = {
    # where a hundred steps end; of hand regard's objects 8e-9 away
    "env.init_qpos",
    "env.init_qvel",
    *(f"data.{of}" for of in ("qacc", "qacc_smooth", "qacc_warmstart", "qfrc_constraint", "qfrc_smooth", "efc_force")),
    *(f"data.{of}" for of in ("sensordata", "cacc", "cfrc_int", "cfrc_ext", "efc_KBIP", "efc_R", "efc_D", "efc_aref")),
    *(f"data.{of}" for of in ("efc_diagApprox", "efc_vel", "efc_pos", "qfrc_bias", "cvel", "qM", "qLD", "qLDiagInv")),
    "touch.sensor_outputs",
    "touch.contact_tuples",
    "proprioception.sensor_outputs",
    "vestibular.sensor_outputs",
    "vision.sensor_outputs",
}


def differences(path: str, a: Any, b: Any, relative: bool) -> Iterator[str]:
    """Names where two values differ."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        a, b = np.asarray(a), np.asarray(b)
        if (a.shape, a.dtype) != (b.shape, b.dtype):
            yield f"{path}: {a.dtype}{a.shape} is {b.dtype}{b.shape}"
        elif a.size and a.dtype.kind in "fiub":
            x, y = a.astype(float), b.astype(float)
            known = np.isfinite(x) & np.isfinite(y)
            most = float(np.abs(x[known] - y[known]).max(initial=0.0))
            if path.startswith("vision") and most <= 2:
                return
            limit = 1e-6 * max(1.0, float(np.abs(x[known]).max(initial=0.0))) if relative else TOLERANCE
            if most > limit:
                yield f"{path}: differs by {most:.1e}"
    elif isinstance(a, dict) and isinstance(b, dict):
        if list(a) != list(b):
            yield f"{path}: the keys {list(a)} are {list(b)}"
        for key in a:
            yield from differences(f"{path}[{key!r}]", a[key], b.get(key), relative)
    elif isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        if len(a) != len(b):
            yield f"{path}: {len(a)} are {len(b)}"
        for k, (x, y) in enumerate(zip(a, b)):
            yield from differences(f"{path}[{k}]", x, y, relative)
    elif isinstance(a, float) and isinstance(b, float):
        if abs(a - b) > TOLERANCE * max(1.0, abs(a) if relative else 1.0) and not relative:
            yield f"{path}: {a} is {b}"
    elif type(a) is not type(b) or a != b:
        yield f"{path}: {a!r:.60} is {b!r:.60}"


def of_sections(kit: dict[str, Any], own: dict[str, Any], alone: bool) -> Iterator[str]:
    """Names where the attributes of one object after the other differ."""
    for section in SECTIONS:
        if kit[section] is None or own[section] is None:
            if kit[section] is not own[section]:
                yield f"{section}: one of them is None"
            continue
        for name, (kind, value) in kit[section].items():
            path = f"{section}.{name}"
            if path in APART:
                continue
            if name not in own[section]:
                # what stands for MuJoCo's objects has the attributes that scripts use
                if not (alone and section in ("model", "data")):
                    yield f"{path}: is missing"
                continue
            own_kind, own_value = own[section][name]
            if STANDING_IN.get(own_kind, own_kind) != kind:
                yield f"{path}: the type {kind} is {own_kind}"
            elif own_kind == kind:
                yield from differences(path, value, own_value, path in SOLVED)
        more = set(own[section]) - set(kit[section])
        if more:
            yield f"{section}: there are {sorted(more)} more"


@pytest.mark.parametrize("who", ["mujoco", "alone"])
@pytest.mark.parametrize("config", CONFIGS)
def test_attributes_are_the_kits(recordings: Recordings, config: str, who: str) -> None:
    kit, own = recordings(config, "kit"), recordings(config, who)
    found = list(of_sections(kit, own, who == "alone"))
    for section in WHOLE:
        assert (section in kit) == (section in own)
        entries = kit.get(section, {})
        for name, value in entries.items() if isinstance(entries, dict) else enumerate(entries):
            if f"{section}.{name}" not in APART:
                relative = section == "contacts"
                found += differences(f"{section}.{name}", value, own[section][name], relative)
    assert not found, "\n".join(found)


def test_the_stand_ins_have_what_scripts_use(recordings: Recordings) -> None:
    own = recordings("selftouch", "alone")
    for name in (
        "nbody",
        "njnt",
        "ngeom",
        "nu",
        "ncam",
        "nq",
        "nv",
        "geom_bodyid",
        "jnt_range",
        "jnt_qposadr",
        "jnt_dofadr",
        "opt",
    ):
        assert name in own["model"] or name in ("jnt_range", "jnt_qposadr", "jnt_dofadr", "geom_bodyid"), name
    for name in ("contact", "ncon", "time"):
        assert name in own["data"], name
