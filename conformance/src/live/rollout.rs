//! Open-loop rollouts: the growth of errors, compared with that of MuJoCo's own from a start 1e-7 away.

use babybench::mimo::MimoJoints;
use babybench::model::EqualityKind;
use babybench::physics::Engine;
use babybench::physics::{ConstraintType, EfcRow};

use super::one_step::Maker;
use super::speed::copy_motion;
use super::{Case, Drive, Motion, parallel};
use crate::measure::{Summary, max_abs, pick, relative, rms};
use crate::mujoco::{Mujoco, Release, Simulation, load};

/// Distance of the starts of the floor, rad.
const NUDGE: f64 = 1e-7;

/// Steps with controls 0 before a rollout.
const SETTLING: usize = 100;

/// A plan of rollouts.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The way MIMo is moved.
    pub motion: Motion,
    /// Steps.
    pub steps: usize,
    /// Episodes.
    pub rollouts: usize,
    /// Starts of the floor for each episode.
    pub floors: u64,
}

/// A rollout of MuJoCo, for others to follow.
pub struct Path {
    seed: u64,
    qpos0: Vec<f64>,
    qvel0: Vec<f64>,
    warmstart0: Vec<f64>,
    ctrl: Vec<Vec<f64>>,
    qpos: Vec<Vec<f64>>,
    qacc: Vec<Vec<f64>>,
}

/// Distances to a rollout after each step.
#[derive(Clone, Debug, Default)]
pub struct Distance {
    /// Root mean square over MIMo's joint angles, rad.
    pub joints: Vec<f64>,
    /// Largest difference of a coordinate of the free bodies, m or 1.
    pub free: Vec<f64>,
    /// Acceleration of the first step, relative to its largest value.
    pub first_qacc: f64,
    /// Why it ended early, if it did.
    pub failure: Option<String>,
}

/// A rollout with its floor.
pub struct Rollout {
    /// Distances of the engine.
    pub ours: Distance,
    /// MuJoCo from each of some starts 1e-7 away: rms over joints, rad.
    pub floors: Vec<Vec<f64>>,
}

impl Rollout {
    /// Returns our distance after step `k`, rad; infinite if the rollout ended before it.
    pub fn ours_at(&self, k: usize) -> f64 {
        self.ours.joints.get(k).copied().unwrap_or(f64::INFINITY)
    }

    /// Returns the average of MuJoCo's distances from itself after step `k`, rad.
    pub fn floor_at(&self, k: usize) -> f64 {
        self.floors.iter().map(|f| f[k]).sum::<f64>() / self.floors.len() as f64
    }
}

/// Summarises the distances of some rollouts after a step: ours and the averaged floors.
pub fn at(rollouts: &[Rollout], k: usize) -> [Summary; 2] {
    [
        Summary::new(rollouts.iter().map(|r| r.ours_at(k))),
        Summary::new(rollouts.iter().map(|r| r.floor_at(k))),
    ]
}

/// Rolls MuJoCo out.
///
/// # Errors
/// MuJoCo does not load the scene.
pub fn paths(api: &'static Mujoco, case: &Case, plan: Plan) -> Result<Vec<Path>, String> {
    let seeds: Vec<u64> = (0..plan.rollouts as u64).collect();
    let all = parallel(
        &seeds,
        || case.simulation(api),
        |simulation, &seed| {
            let simulation = simulation.as_mut().map_err(|e| e.clone())?;
            Ok(path(case, simulation, plan, seed))
        },
    );
    all.into_iter().collect()
}

fn path(case: &Case, simulation: &mut Simulation, plan: Plan, seed: u64) -> Path {
    let mut drive = Drive::new(&case.model, plan.motion, 1000 + seed);
    simulation.reset();
    simulation.set_params(&case.model, &case.params);
    let mut qvel = vec![0.0; case.model.nv];
    for d in MimoJoints::new(&case.model).dof {
        qvel[d] = 2.0 * (drive.rng().f64() - 0.5);
    }
    let qpos = simulation.qpos().to_vec();
    simulation.set_motion(&qpos, &qvel);
    (0..SETTLING).for_each(|_| simulation.step());
    let mut out = Path {
        seed,
        qpos0: simulation.qpos().to_vec(),
        qvel0: simulation.qvel().to_vec(),
        warmstart0: simulation.qacc_warmstart().to_vec(),
        ctrl: Vec::with_capacity(plan.steps),
        qpos: Vec::with_capacity(plan.steps),
        qacc: Vec::with_capacity(plan.steps),
    };
    let mut ctrl = vec![0.0; case.model.nu()];
    for k in 0..plan.steps {
        drive.set(k, &mut ctrl);
        simulation.set_ctrl(&ctrl);
        simulation.step();
        out.ctrl.push(ctrl.clone());
        out.qpos.push(simulation.qpos().to_vec());
        out.qacc.push(simulation.qacc().to_vec());
    }
    out
}

/// The coordinates over which distances are measured.
struct Ruler {
    joints: Vec<usize>,
    free: Vec<usize>,
}

impl Ruler {
    fn new(case: &Case) -> Self {
        let joints = MimoJoints::new(&case.model).qpos;
        let free = (0..case.model.nq).filter(|q| !joints.contains(q)).collect();
        Self { joints, free }
    }

    fn add(&self, out: &mut Distance, qpos: &[f64], theirs: &[f64]) {
        out.joints
            .push(rms(&pick(qpos, &self.joints), &pick(theirs, &self.joints)));
        out.free
            .push(max_abs(&pick(qpos, &self.free), &pick(theirs, &self.free)));
    }
}

/// Follows a rollout with an engine, from the same state with the same controls.
pub fn follow(case: &Case, engine: &mut dyn Engine, path: &Path) -> Distance {
    let (mut out, ruler) = (Distance::default(), Ruler::new(case));
    let mut state = engine.new_state();
    state.params.clone_from(&case.params);
    state.qpos.copy_from_slice(&path.qpos0);
    state.qvel.copy_from_slice(&path.qvel0);
    state.qacc_warmstart.copy_from_slice(&path.warmstart0);
    for (k, (ctrl, qpos)) in path.ctrl.iter().zip(&path.qpos).enumerate() {
        state.ctrl.copy_from_slice(ctrl);
        if let Err(e) = engine.step(&mut state) {
            out.failure = Some(e.to_string());
            break;
        }
        if k == 0 {
            out.first_qacc = relative(&state.qacc, &path.qacc[0]);
        }
        ruler.add(&mut out, &state.qpos, qpos);
    }
    out
}

/// Rolls MuJoCo 3.3.0 out from a start 1e-7 rad away in each joint: rms over joints after each step, rad.
fn floor(case: &Case, simulation: &mut Simulation, path: &Path, start: u64) -> Vec<f64> {
    let ruler = Ruler::new(case);
    let mut rng = fastrand::Rng::with_seed(1000 * path.seed + start);
    let mut qpos = path.qpos0.clone();
    for &q in &ruler.joints {
        qpos[q] += if rng.bool() { NUDGE } else { -NUDGE };
    }
    simulation.reset();
    simulation.set_params(&case.model, &case.params);
    simulation.set_motion(&qpos, &path.qvel0);
    simulation.set_warmstart(&path.warmstart0);
    let mut distance = Distance::default();
    for (ctrl, theirs) in path.ctrl.iter().zip(&path.qpos) {
        simulation.set_ctrl(ctrl);
        simulation.step();
        ruler.add(&mut distance, simulation.qpos(), theirs);
    }
    distance.joints
}

/// Rolls out an engine along MuJoCo's paths, with the floor, in threads.
///
/// # Errors
/// MuJoCo does not load the scene.
pub fn rollouts(
    api: &'static Mujoco,
    case: &Case,
    make: Maker,
    plan: Plan,
    paths: &[Path],
) -> Result<Vec<Rollout>, String> {
    let all = parallel(
        paths,
        || (case.simulation(api), make(case)),
        |(simulation, engine), path| {
            let simulation = simulation.as_mut().map_err(|e| e.clone())?;
            let ours = follow(case, &mut **engine, path);
            let floors = (0..plan.floors)
                .map(|start| floor(case, simulation, path, start))
                .collect();
            Ok(Rollout { ours, floors })
        },
    );
    all.into_iter().collect()
}

/// Follows rollouts with another release of MuJoCo.
///
/// # Errors
/// The release is not there, or does not load the scene.
pub fn follow_release(version: &str, case: &Case, paths: &[Path]) -> Result<Vec<Distance>, String> {
    let mut release: Release = case.release(load(version)?, version)?;
    let ruler = Ruler::new(case);
    let follow = |path: &Path| {
        let mut out = Distance::default();
        release.set_state(&path.qpos0, &path.qvel0, &path.warmstart0, &case.params.eq_active);
        for (k, (ctrl, qpos)) in path.ctrl.iter().zip(&path.qpos).enumerate() {
            release.step(ctrl);
            if k == 0 {
                out.first_qacc = relative(&release.qacc(), &path.qacc[0]);
            }
            ruler.add(&mut out, &release.qpos(), qpos);
        }
        out
    };
    Ok(paths.iter().map(follow).collect())
}

/// Vertical forces on MIMo, N.
pub struct Resting {
    /// From contacts with the world and objects.
    pub contacts: f64,
    /// From welds to the world.
    pub welds: f64,
    /// Its weight.
    pub weight: f64,
    /// Number of contacts.
    pub number: usize,
}

impl Resting {
    /// Returns the deviation of the forces from MIMo's weight, relative to that weight.
    pub fn error(&self) -> f64 {
        ((self.contacts + self.welds) / self.weight - 1.0).abs()
    }
}

/// Measures the forces on MIMo after `steps` steps without controls.
///
/// # Errors
/// MuJoCo does not load the scene; the engine fails.
pub fn resting(api: &'static Mujoco, case: &Case, make: Maker, steps: usize) -> Result<Resting, String> {
    let mut simulation = case.simulation(api)?;
    (0..SETTLING).for_each(|_| simulation.step());
    let (m, mut engine) = (&case.model, make(case));
    let mut state = engine.new_state();
    state.params.clone_from(&case.params);
    copy_motion(&simulation, &mut state);
    for _ in 0..steps {
        engine.step(&mut state).map_err(|e| e.to_string())?;
    }
    let root = m.body_rootid[m.dof_bodyid[MimoJoints::new(m).dof[0]]];
    let mut out = Resting {
        contacts: 0.0,
        welds: 0.0,
        weight: -m.opt.gravity[2] * m.body_subtreemass[root],
        number: 0,
    };
    for c in &state.contact {
        let [first, second] = c.geom.map(|g| m.body_rootid[m.geom_bodyid[g]] == root);
        if first != second {
            let up: f64 = (0..3).map(|k| c.force[k] * c.frame[3 * k + 2]).sum();
            out.contacts += if second { up } else { -up };
            out.number += 1;
        }
    }
    for (id, kind) in m.eq_kind.iter().enumerate() {
        let EqualityKind::Weld { body1, body2, .. } = *kind else {
            continue;
        };
        let of_weld = |row: &EfcRow| row.kind == ConstraintType::Equality && row.id == id;
        // rows push the first body along x, y and z, and the second body back
        let up = state.efc_rows().filter(of_weld).nth(2).map_or(0.0, |row| row.force);
        out.welds += if m.body_rootid[body1] == root { up } else { 0.0 };
        out.welds -= if m.body_rootid[body2] == root { up } else { 0.0 };
    }
    Ok(out)
}
