//! Actuators of bodies that are not MIMo's.

use super::{Actuation, MotorCommand, named, set_controls};
use crate::model::Model;
use crate::physics::State;
use crate::spaces::BoxSpace;

/// Bound of a control without a range.
const UNLIMITED: [f64; 2] = [-1.0, 1.0];

/// Drives MIMo by an actuation model, and the scene's other actuators by the rest of the action, which has one control for each.
///
/// The controls are within the range of the actuator (`ctrlrange`), or within -1 and 1 if it has none. The observation has these
/// controls, then angle and velocity (rad, rad/s, or m, m/s) of every joint with one degree of freedom that such an actuator drives.
pub(super) struct WithExtraActuators {
    mimo: Box<dyn Actuation>,
    space: BoxSpace,
    extra: Vec<usize>,
    joints: Vec<usize>,
}

impl WithExtraActuators {
    /// Adds the actuators that `mimo` does not drive.
    pub fn new(mimo: Box<dyn Actuation>, model: &Model) -> Self {
        let extra: Vec<usize> = (0..model.nu()).filter(|i| !mimo.actuators().contains(i)).collect();
        let bounds = |&i: &usize| {
            let range = model.actuator_ctrlrange[i];
            // an infinite bound is no limit and cannot be sampled
            if model.actuator_ctrllimited[i] && range.iter().all(|v| v.is_finite()) {
                range
            } else {
                UNLIMITED
            }
        };
        let side = |of: &[f32], k: usize| {
            let more = extra.iter().map(|i| bounds(i)[k] as f32);
            of.iter().copied().chain(more).collect::<Vec<f32>>()
        };
        let space = BoxSpace::new(side(mimo.action_space().low(), 0), side(mimo.action_space().high(), 1));
        let mut joints: Vec<usize> = Vec::new();
        for &i in &extra {
            if let Some(joint) = model.actuator_joint(i).filter(|&j| is_single(model, j))
                && !joints.contains(&joint)
            {
                joints.push(joint);
            }
        }
        Self {
            mimo,
            space,
            extra,
            joints,
        }
    }

    /// Returns the number of MIMo's values in an action.
    fn own(&self) -> usize {
        self.mimo.action_space().len()
    }
}

/// Returns whether a joint has one degree of freedom.
fn is_single(model: &Model, joint: usize) -> bool {
    let next = model.jnt_dofadr.get(joint + 1).copied().unwrap_or(model.nv);
    next == model.jnt_dofadr[joint] + 1
}

impl Actuation for WithExtraActuators {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn actuators(&self) -> &[usize] {
        self.mimo.actuators()
    }

    fn extra_actuators(&self) -> &[usize] {
        &self.extra
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        let mut names = self.mimo.action_names(model);
        names.extend(named(model, &self.extra, " control"));
        names
    }

    fn prepare(&self, model: &Model, state: &mut State) {
        self.mimo.prepare(model, state);
    }

    fn set_action(&self, model: &Model, state: &mut State, action: &[f32]) {
        let (own, rest) = action.split_at(self.own().min(action.len()));
        self.mimo.set_action(model, state, own);
        set_controls(&mut state.ctrl, &self.space, &self.extra, self.own(), rest);
    }

    fn substep(&self, model: &Model, state: &mut State) {
        self.mimo.substep(model, state);
    }

    fn drive(&self, model: &Model, state: &mut State, action: &[f32], commands: &[MotorCommand]) {
        let (own, rest) = action.split_at(self.own().min(action.len()));
        self.mimo.drive(model, state, own, commands);
        set_controls(&mut state.ctrl, &self.space, &self.extra, self.own(), rest);
    }

    fn strength(&self, model: &Model) -> Vec<[f64; 2]> {
        self.mimo.strength(model)
    }

    fn reset(&self, model: &Model, state: &mut State) {
        self.mimo.reset(model, state);
    }

    fn observation_len(&self) -> usize {
        self.mimo.observation_len() + self.extra.len() + 2 * self.joints.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        let mut names = self.mimo.observation_names(model);
        names.extend(named(model, &self.extra, " control"));
        for ending in ["angle", "velocity"] {
            names.extend(self.joints.iter().map(|&j| format!("{} {ending}", model.jnt_name[j])));
        }
        names
    }

    fn observe(&self, model: &Model, state: &State, out: &mut [f64]) {
        let (own, rest) = out.split_at_mut(self.mimo.observation_len().min(out.len()));
        self.mimo.observe(model, state, own);
        let controls = self.extra.iter().map(|&i| state.ctrl[i]);
        let angles = self.joints.iter().map(|&j| state.qpos[model.jnt_qposadr[j]]);
        let velocities = self.joints.iter().map(|&j| state.qvel[model.jnt_dofadr[j]]);
        for (out, value) in rest.iter_mut().zip(controls.chain(angles).chain(velocities)) {
            *out = value;
        }
    }

    fn cost(&self, model: &Model, state: &State) -> f64 {
        self.mimo.cost(model, state)
    }
}
