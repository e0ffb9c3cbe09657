//! Motion over many steps: without contacts, and settling.

use babybench::Model;
use babybench::mimo::MimoJoints;
use babybench::model::JointType;
use babybench::physics::Engine;

use crate::measure::{Summary, max_abs, pick, relative};
use crate::reference::Reference;

/// Distance to MuJoCo after some steps.
pub struct Drift {
    /// Steps done.
    pub step: usize,
    /// Error of each of MIMo's joints, rad.
    pub joints: Vec<f64>,
    /// Largest error of the coordinates of MIMo's free joint, m or 1.
    pub root: f64,
    /// Largest error of the coordinates of the free joints of objects, m or 1.
    pub objects: f64,
    /// Largest error of velocities, relative to the largest velocity.
    pub qvel: f64,
}

impl Drift {
    /// Compares our position and velocity with MuJoCo's.
    pub fn new(model: &Model, step: usize, ours: (&[f64], &[f64]), theirs: (&[f64], &[f64])) -> Self {
        let free = |own: bool| -> Vec<usize> {
            let is_free = |&j: &usize| model.jnt_type[j] == JointType::Free && (model.jnt_name[j].is_empty() != own);
            let joints = (0..model.njnt()).filter(is_free);
            joints
                .flat_map(|j| model.jnt_qposadr[j]..model.jnt_qposadr[j] + 7)
                .collect()
        };
        let error = |at: &[usize]| max_abs(&pick(ours.0, at), &pick(theirs.0, at));
        let joints = MimoJoints::new(model).qpos;
        Self {
            step,
            joints: joints.iter().map(|&q| (ours.0[q] - theirs.0[q]).abs()).collect(),
            root: error(&free(true)),
            objects: error(&free(false)),
            qvel: relative(ours.1, theirs.1),
        }
    }

    /// Summarises the errors of MIMo's joints.
    pub fn summary(&self) -> Summary {
        Summary::new(self.joints.iter().copied())
    }
}

/// Takes 1000 steps without contacts and compares the recorded ones; `run` is `cf` or, with locked joints, `cfl`.
pub fn contact_free(reference: &Reference, run: &str) -> Vec<Drift> {
    let mut engine = reference.engine(true);
    let mut state = engine.new_state();
    let active = reference.array(&format!("{run}_active")).data;
    state.params.eq_active = active.iter().map(|&v| v != 0.0).collect();
    let ctrl = reference.rows(&format!("{run}_ctrl"));
    let steps = reference.array(&format!("{run}_step")).data;
    let (qpos, qvel) = (
        reference.rows(&format!("{run}_qpos")),
        reference.rows(&format!("{run}_qvel")),
    );
    let mut drift = Vec::new();
    for (k, &until) in steps.iter().enumerate() {
        while state.step < until as u64 {
            state.ctrl.copy_from_slice(&ctrl[state.step as usize / 5]);
            engine.step(&mut state).expect("motion that MuJoCo simulated");
        }
        let ours = (&state.qpos[..], &state.qvel[..]);
        drift.push(Drift::new(&reference.model, until as usize, ours, (&qpos[k], &qvel[k])));
    }
    drift
}

/// Takes 100 steps from `qpos0` with contacts and ctrl 0, and compares on the way and at the end.
pub fn settling(reference: &Reference) -> Vec<Drift> {
    let mut engine = reference.engine(false);
    let mut state = engine.new_state();
    let mut marks: Vec<usize> = reference
        .array("settle_step")
        .data
        .iter()
        .map(|&v| v as usize)
        .collect();
    let (mut qpos, mut qvel) = (reference.rows("settle_at_qpos"), reference.rows("settle_at_qvel"));
    marks.push(100);
    qpos.push(reference.array("settle_qpos").data);
    qvel.push(reference.array("settle_qvel").data);
    let mut drift = Vec::new();
    for (k, &until) in marks.iter().enumerate() {
        while state.step < until as u64 {
            engine.step(&mut state).expect("motion that MuJoCo simulated");
        }
        let ours = (&state.qpos[..], &state.qvel[..]);
        drift.push(Drift::new(&reference.model, until, ours, (&qpos[k], &qvel[k])));
    }
    drift
}
