"""Flexes of ``babybench.mujoco`` beside MuJoCo 3.3.0: arrays of models, and of states while they fall."""

from __future__ import annotations

import numpy as np
import pytest

from babybench import mujoco as ours

theirs = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
if getattr(theirs, "stands_in", False):
    pytest.skip("MuJoCo is not installed", allow_module_level=True)

FLEXES = """<mujoco><asset><material name="red" rgba="1 0 0 1"/></asset><worldbody>
  <geom type="plane" size="1 1 1"/>
  <flexcomp name="cloth" dim="2" count="4 5 1" spacing=".05 .05 .05" pos="0 0 .05" mass=".2" radius=".01" material="red">
    <edge equality="true" damping=".01"/><contact selfcollide="none" internal="false"/>
  </flexcomp>
  <flexcomp name="rope" dim="1" count="6 1 1" spacing=".05 .05 .05" pos=".5 0 .1" mass=".1" radius=".01">
    <pin id="0"/><contact selfcollide="none" internal="false"/><edge stiffness="30" damping=".1"/>
  </flexcomp>
  <flexcomp name="cube" dim="3" count="3 3 3" spacing=".05 .05 .05" pos="-.5 0 .1" mass=".2"
      radius=".005" rgba=".1 .2 .3 .4" flatskin="true">
    <elasticity young="1e3" poisson=".1" damping=".01"/><contact selfcollide="none" internal="false"/>
  </flexcomp></worldbody>
  <deformable><flex name="fixed" body="world" vertex="0 0 1 1 0 1 0 1 1" element="0 1 2"
    texcoord="0 0 1 0 0 1" group="2"/></deformable></mujoco>"""
NOT_KEPT = {"flex_bvhadr", "flex_bvhnum", "flex_vert0", "flexelem_aabb", "name_flexadr"}


def test_models_have_the_arrays_of_flexes() -> None:
    model, its = ours.MjModel.from_xml_string(FLEXES), theirs.MjModel.from_xml_string(FLEXES)
    names = [name for name in dir(its) if name.startswith(("flex_", "flexedge_", "nflex")) and name not in NOT_KEPT]
    assert len(names) > 60
    for name in names:
        mine, expected = getattr(model, name), getattr(its, name)
        if name.startswith("n"):
            assert mine == expected, name
            continue
        assert (mine.dtype, mine.shape) == (expected.dtype, expected.shape), name
        np.testing.assert_allclose(mine, expected, rtol=1e-9, atol=1e-12, err_msg=name)
    with pytest.raises(AttributeError):
        len(model.flex_bvhadr)


def test_models_without_flexes_have_empty_arrays() -> None:
    model, its = ours.MjModel.from_xml_string("<mujoco/>"), theirs.MjModel.from_xml_string("<mujoco/>")
    for name in dir(its):
        if name.startswith("flex"):
            mine, expected = getattr(model, name), getattr(its, name)
            assert (mine.dtype, mine.shape) == (expected.dtype, expected.shape), name


def test_states_have_the_arrays_of_flexes() -> None:
    model, its = ours.MjModel.from_xml_string(FLEXES), theirs.MjModel.from_xml_string(FLEXES)
    mine, expected = ours.MjData(model), theirs.MjData(its)
    for _ in range(20):
        ours.mj_step(model, mine)
        theirs.mj_step(its, expected)
        for name in ("flexvert_xpos", "flexedge_length", "flexedge_velocity"):
            a, b = getattr(mine, name), getattr(expected, name)
            assert (a.dtype, a.shape) == (b.dtype, b.shape), name
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-6, err_msg=name)
    with pytest.raises(AttributeError):
        len(mine.flexedge_J)
