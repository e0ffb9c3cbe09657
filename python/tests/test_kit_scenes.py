"""MIMo's own scenes compile to the numbers of a checkout of the starter kit, which the variable BABYBENCH_KIT names."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mimoEnv.envs.mimo_env import SCENE_DIRECTORY

from babybench import mujoco

KIT = Path(os.environ.get("BABYBENCH_KIT", "")) / "MIMo" / "mimoEnv" / "assets"
pytestmark = pytest.mark.skipif(
    not os.environ.get("BABYBENCH_KIT") or not KIT.is_dir(), reason="BABYBENCH_KIT names no checkout of the starter kit"
)
SCENES = (
    *("benchmark_scene", "benchmarkv2_scene", "showroom", "compliance_test_scene", "muscle_static_test"),
    *(
        "muscle_velocity_test",
        "muscle_velocity_test_v2",
        "reach_scene",
        "standup_scene",
        "selfbody_scene",
        "catch_scene",
    ),
)
"""All but ``muscle_static_test_v2``, which names a joint that the kit's MIMo does not have."""
ARRAYS = (
    *(
        "qpos0",
        "qpos_spring",
        "body_pos",
        "body_quat",
        "body_ipos",
        "body_iquat",
        "body_mass",
        "body_inertia",
        "body_parentid",
    ),
    *(
        "jnt_type",
        "jnt_pos",
        "jnt_axis",
        "jnt_range",
        "jnt_stiffness",
        "dof_damping",
        "dof_armature",
        "dof_frictionloss",
    ),
    *("geom_type", "geom_size", "geom_pos", "geom_quat", "geom_friction", "geom_solref", "geom_solimp", "geom_condim"),
    *("site_pos", "actuator_gear", "actuator_forcerange", "actuator_user", "actuator_trnid", "eq_data", "eq_active0"),
    *("eq_solref", "eq_solimp", "body_invweight0", "dof_invweight0"),
)


def names(model: Any) -> dict[str, list[str]]:
    counts = {
        "body": model.nbody,
        "joint": model.njnt,
        "actuator": model.nu,
        "sensor": model.nsensor,
        "texture": model.ntex,
    }
    return {kind: [getattr(model, kind)(k).name for k in range(count)] for kind, count in counts.items()}


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_has_the_numbers_of_mimo_s(scene: str) -> None:
    own, kit = (mujoco.MjModel.from_xml_path(str(Path(folder) / f"{scene}.xml")) for folder in (SCENE_DIRECTORY, KIT))
    assert names(own) == names(kit)
    assert np.array_equal(own.opt.gravity, kit.opt.gravity)
    assert (own.opt.timestep, own.opt.density) == (kit.opt.timestep, kit.opt.density)
    for array in ARRAYS:
        found, known = getattr(own, array), getattr(kit, array)
        assert found.shape == known.shape, array
        assert np.allclose(found, known, rtol=1e-12, atol=1e-12), array
