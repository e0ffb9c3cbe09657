//! Position servos: the action is the desired angle.

use super::{Actuation, ActuationError, MotorCommand, clear_muscles, named};
use crate::config::Compat;
use crate::mimo::MimoBodies;
use crate::model::{BiasType, DynType, EqualityKind, GainType, Model};
use crate::physics::State;
use crate::spaces::BoxSpace;

/// Drives joints by position servos: one of 1 N m/rad on each joint pulls it to the action, an angle in rad within the
/// joint's range.
///
/// The target of a joint that an active joint equality holds (the scene's or a lock) is 0, whatever the action. The observation is the
/// clipped action itself, also for those joints.
///
/// With a `frame_skip` above 1 the target holds for all substeps; under `compat: reference` every substep but the first
/// has the target and the observed action 0. The metabolic cost is 0.
#[derive(Clone, Debug)]
pub struct PositionalModel {
    space: BoxSpace,
    actuators: Vec<usize>,
    holds: Vec<HoldEquality>,
    compat: Compat,
}

/// A joint equality of an actuated joint.
#[derive(Clone, Copy, Debug)]
struct HoldEquality {
    equality: usize,
    /// By id.
    actuator: usize,
}

impl PositionalModel {
    /// Builds the actuation for the servos of MIMo in `model`.
    ///
    /// # Errors
    /// An actuator that is not a servo, or whose joint has no range.
    pub fn new(model: &Model, compat: Compat) -> Result<Self, ActuationError> {
        let (mut low, mut high) = (Vec::new(), Vec::new());
        let actuators = MimoBodies::of(model).actuators();
        for &i in &actuators {
            let Some(j) = model.actuator_joint(i) else { continue };
            let actuator = || model.actuator_name[i].clone();
            let follows = model.actuator_biastype[i] == BiasType::Affine
                && model.actuator_gaintype[i] == GainType::Fixed
                && model.actuator_dyntype[i] == DynType::None
                && model.actuator_gainprm[i][0] == -model.actuator_biasprm[i][1];
            if !follows {
                return Err(ActuationError::Kind {
                    actuator: actuator(),
                    model: "positional",
                    needs: "position servo",
                });
            }
            let [lo, hi] = model.jnt_range[j];
            // negated, so that NaN is an error too
            if !(model.jnt_limited[j] && lo < hi) {
                return Err(ActuationError::Parameter {
                    actuator: actuator(),
                    what: "the range of its joint",
                    value: hi - lo,
                    allowed: "limited and above 0",
                });
            }
            low.push(lo as f32);
            high.push(hi as f32);
        }
        let mut holds = Vec::new();
        for (equality, kind) in model.eq_kind.iter().enumerate() {
            if let EqualityKind::Joint { joint1, joint2, .. } = kind {
                let on = |j: usize| *joint1 == j || *joint2 == Some(j);
                let held = actuators.iter().filter(|&&i| model.actuator_joint(i).is_some_and(on));
                holds.extend(held.map(|&actuator| HoldEquality { equality, actuator }));
            }
        }
        Ok(Self {
            space: BoxSpace::new(low, high),
            actuators,
            holds,
            compat,
        })
    }

    /// Passes the targets to the servos, and 0 to those of held joints.
    fn update_ctrl(&self, state: &mut State) {
        for (&i, &target) in self.actuators.iter().zip(&state.actuator_target) {
            state.ctrl[i] = target;
        }
        self.hold(state);
    }

    /// Sets the controls of held joints to 0.
    fn hold(&self, state: &mut State) {
        for hold in &self.holds {
            if state.params.eq_active[hold.equality] {
                state.ctrl[hold.actuator] = 0.0;
            }
        }
    }

    /// Sets all targets to the action 0.
    fn target_zero(&self, state: &mut State) {
        state.actuator_target.resize(self.space.len(), 0.0);
        for (i, target) in state.actuator_target.iter_mut().enumerate() {
            *target = f64::from(self.space.clip(i, 0.0));
        }
        self.update_ctrl(state);
    }
}

impl Actuation for PositionalModel {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn actuators(&self) -> &[usize] {
        &self.actuators
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        named(model, &self.actuators, " angle")
    }

    fn prepare(&self, model: &Model, state: &mut State) {
        clear_muscles(model, state);
        state.actuator_target.clear();
        state.actuator_target.resize(self.space.len(), 0.0);
    }

    fn set_action(&self, _model: &Model, state: &mut State, action: &[f32]) {
        state.actuator_target.resize(self.space.len(), 0.0);
        for (i, (target, &a)) in state.actuator_target.iter_mut().zip(action).enumerate() {
            *target = f64::from(self.space.clip(i, a));
        }
        self.update_ctrl(state);
    }

    fn substep(&self, _model: &Model, state: &mut State) {
        // the Python code gives its target to the first physics step alone
        if self.compat == Compat::Reference {
            self.target_zero(state);
        }
    }

    /// The observed targets are those of the action; the servos get angles at which they also exert the reflexes' torques.
    fn drive(&self, model: &Model, state: &mut State, action: &[f32], commands: &[MotorCommand]) {
        self.set_action(model, state, action);
        for (&i, command) in self.actuators.iter().zip(commands) {
            let gear = state.params.actuator_gear[i];
            let stiffness = model.actuator_gainprm[i][0] * gear;
            if (command.torque, command.suppress) == (0.0, 0.0) || stiffness == 0.0 {
                continue;
            }
            let Some(joint) = model.actuator_joint(i) else { continue };
            // a servo pulls to its control over the gear
            let here = gear * state.qpos[model.jnt_qposadr[joint]];
            state.ctrl[i] = here + (state.ctrl[i] - here) * (1.0 - command.suppress) + command.torque / stiffness;
        }
        self.hold(state);
    }

    fn strength(&self, model: &Model) -> Vec<[f64; 2]> {
        let torques = |&i: &usize| {
            if model.actuator_forcelimited[i] {
                return model.actuator_forcerange[i].map(|force| (force * model.actuator_gear[i]).abs());
            }
            // without a limit a servo pulls at most from one end of its range to the other
            let [low, high] = model.actuator_joint(i).map_or([0.0; 2], |j| model.jnt_range[j]);
            [model.actuator_gainprm[i][0] * model.actuator_gear[i] * (high - low); 2]
        };
        self.actuators.iter().map(torques).collect()
    }

    fn reset(&self, _model: &Model, state: &mut State) {
        state.act.fill(0.0);
        state.ctrl.fill(0.0);
        self.target_zero(state);
    }

    fn observation_len(&self) -> usize {
        self.space.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        named(model, &self.actuators, " angle")
    }

    /// Writes the clipped action, rad.
    fn observe(&self, _model: &Model, state: &State, out: &mut [f64]) {
        for (v, target) in out.iter_mut().zip(&state.actuator_target) {
            *v = *target;
        }
    }

    fn cost(&self, _model: &Model, _state: &State) -> f64 {
        0.0
    }
}
