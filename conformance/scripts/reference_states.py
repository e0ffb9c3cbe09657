"""Writes conformance/data/reference_{v1,v2}_{base,crib,cubes}.npz: MuJoCo's results for the models in assets/.

    python reference_states.py [--assets DIR] [--out DIR]

All motor groups are on, the options are the scene's. Every array is float64, counts and indices too. Sizes: N = 6 states,
nq, nv, nu, neq, nbody, ngeom, nsite and nsensordata as in mjModel.

Model
    body_invweight0     (nbody, 2)  inverse weights of translation and rotation
    dof_invweight0      (nv)
    tendon_invweight0   (ntendon)
    stat                (7)         meaninertia, meanmass, meansize, extent, center x, y, z

States: after 100 steps with ctrl 0 from qpos0 come 400 steps with random ctrl, each held 10 steps; the states are those
after STATE_STEPS of them. The results are mj_forward's, with contacts, from a zero warm start. To keep the files small
poses and mass matrices are those of the first K states only: K = 2 for v1, 1 for v2.
    st_qpos (N, nq)  st_qvel (N, nv)  st_ctrl (N, nu)
    st_xpos (K, nbody, 3)  st_xquat (K, nbody, 4)  st_xmat (K, nbody, 9)
    st_geom_xpos (K, ngeom, 3)  st_geom_xmat (K, ngeom, 9)  st_site_xpos (K, nsite, 3)  st_site_xmat (K, nsite, 9)
    st_qM (K, nv, nv)               full
    st_qfrc_bias, st_qfrc_passive, st_qfrc_actuator, st_qacc_smooth, st_qacc, st_qfrc_constraint (N, nv)
    st_sensordata (N, nsensordata)
    st_ncon (N)  st_nefc (N)
    st_next_qpos (N, nq)  st_next_qvel (N, nv)   after one mj_step from the state, again from a zero warm start

Motion without contacts: mjDSBL_CONTACT set, 1000 steps from qpos0 with qvel 0.
    cf_ctrl (200, nu)               row t // 5 is the ctrl of step t; -0.25, 0 or 0.25, at random
    cf_active (neq)                 eq_active during the run, here as compiled
    cf_step (8)                     numbers of steps done when the next two were recorded
    cf_qpos (8, nq)  cf_qvel (8, nv)
    cfl_*                           the same with every third of the switched-off joint equalities switched on

Settling: 100 steps from qpos0 with contacts and ctrl 0.
    settle_qpos (nq)  settle_qvel (nv)                   after step 100
    settle_step (3)  settle_at_qpos (3, nq)  settle_at_qvel (3, nv)   on the way there
"""

import argparse
import tempfile
from pathlib import Path

import mujoco
import numpy as np

from check_assets import GROUPS, POSES, compile_model, slim_copy

STATE_STEPS = (40, 91, 160, 235, 320, 400)
FREE_STEPS = (1, 2, 5, 10, 30, 100, 300, 1000)
SETTLE_STEPS = (1, 5, 20)
HOLD = 5
POSES_OF_STATE = ("xpos", "xquat", "xmat", "geom_xpos", "geom_xmat", "site_xpos", "site_xmat")
FORWARD = (
    "qfrc_bias", "qfrc_passive", "qfrc_actuator", "qacc_smooth", "qacc", "qfrc_constraint", "sensordata", "ncon", "nefc",
)


def at_state(model, qpos, qvel, ctrl):
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = qpos, qvel, ctrl
    return data


def settled(model):
    data = mujoco.MjData(model)
    out = {"settle_step": SETTLE_STEPS, "settle_at_qpos": [], "settle_at_qvel": []}
    for step in range(1, 101):
        mujoco.mj_step(model, data)
        if step in SETTLE_STEPS:
            out["settle_at_qpos"].append(data.qpos.copy())
            out["settle_at_qvel"].append(data.qvel.copy())
    out["settle_qpos"], out["settle_qvel"] = data.qpos.copy(), data.qvel.copy()
    return data, out


def states(model, data, rng, detailed):
    """Steps on from `data` with random ctrl and evaluates the states on the way, the first `detailed` with poses and qM."""
    out = {}
    for step in range(1, STATE_STEPS[-1] + 1):
        if step % 10 == 1:
            data.ctrl[:] = rng.uniform(*model.actuator_ctrlrange.T)
        mujoco.mj_step(model, data)
        if step not in STATE_STEPS:
            continue
        state = data.qpos.copy(), data.qvel.copy(), data.ctrl.copy()
        at = at_state(model, *state)
        mujoco.mj_forward(model, at)
        after = at_state(model, *state)
        mujoco.mj_step(model, after)
        row = dict(zip(("qpos", "qvel", "ctrl"), state), next_qpos=after.qpos, next_qvel=after.qvel)
        row |= {name: getattr(at, name) for name in FORWARD}
        if len(out.get("st_qM", ())) < detailed:
            row |= {name: getattr(at, name) for name in POSES_OF_STATE}
            row["qM"] = np.zeros((model.nv, model.nv))
            mujoco.mj_fullM(model, row["qM"], at.qM)
        for name, value in row.items():
            out.setdefault(f"st_{name}", []).append(np.array(value, float))
    return out


def free_motion(model, ctrl, active, prefix):
    data = mujoco.MjData(model)
    data.eq_active[:] = active
    flags, model.opt.disableflags = model.opt.disableflags, model.opt.disableflags | mujoco.mjtDisableBit.mjDSBL_CONTACT
    out = {"ctrl": ctrl, "active": active.copy(), "step": FREE_STEPS, "qpos": [], "qvel": []}
    for step in range(FREE_STEPS[-1]):
        data.ctrl[:] = ctrl[step // HOLD]
        mujoco.mj_step(model, data)
        if step + 1 in FREE_STEPS:
            out["qpos"].append(data.qpos.copy())
            out["qvel"].append(data.qvel.copy())
    model.opt.disableflags = flags
    return {f"{prefix}_{name}": value for name, value in out.items()}


def reference(model, seed, detailed):
    rng = np.random.default_rng(seed)
    stat = model.stat
    out = {
        "body_invweight0": model.body_invweight0,
        "dof_invweight0": model.dof_invweight0,
        "tendon_invweight0": model.tendon_invweight0,
        "stat": [stat.meaninertia, stat.meanmass, stat.meansize, stat.extent, *stat.center],
    }
    data, settling = settled(model)
    out |= settling | states(model, data, rng, detailed)

    ctrl = rng.integers(-1, 2, (FREE_STEPS[-1] // HOLD, model.nu)) / 4
    active = model.eq_active0.copy()
    out |= free_motion(model, ctrl, active, "cf")
    active[np.flatnonzero((active == 0) & (model.eq_type == mujoco.mjtEq.mjEQ_JOINT))[::3]] = 1
    out |= free_motion(model, ctrl, active, "cfl")
    return {name: np.asarray(value, float) for name, value in out.items()}


def main():
    here = Path(__file__).resolve().parents[1]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--assets", type=Path, default=here.parent / "assets")
    parser.add_argument("--out", type=Path, default=here / "data")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        directory = slim_copy(args.assets, Path(temporary))
        for seed, (version, scene) in enumerate((v, s) for v in (1, 2) for s in POSES):
            model = compile_model(directory, version, scene, "motor", GROUPS)
            arrays = reference(model, seed, 2 if version == 1 else 1)
            for name, value in arrays.items():
                if not np.isfinite(value).all():
                    raise SystemExit(f"v{version} {scene}: {name} is not finite")
            path = args.out / f"reference_v{version}_{scene}.npz"
            np.savez_compressed(path, **arrays)
            counts = " ".join(f"{int(c)}/{int(e)}" for c, e in zip(arrays["st_ncon"], arrays["st_nefc"]))
            print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB, ncon/nefc of the states {counts}")


if __name__ == "__main__":
    main()
