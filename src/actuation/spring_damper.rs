//! Torque motors that respond at once; springs and dampers are in the joints.

use super::{Actuation, MotorCommand, clear_muscles, named};
use crate::config::Compat;
use crate::mimo::MimoBodies;
use crate::model::Model;
use crate::physics::State;
use crate::spaces::BoxSpace;

/// Drives joints by torque motors: the torque on a joint is gear times the control.
///
/// Under `compat: api` the action space is [-1, 1] and the motor's force range limits the torque; under
/// `compat: reference` the action space is the force range itself.
#[derive(Clone, Debug)]
pub struct SpringDamperModel {
    space: BoxSpace,
    actuators: Vec<usize>,
    compat: Compat,
}

impl SpringDamperModel {
    /// Builds the actuation for the motors of MIMo in `model`.
    pub fn new(model: &Model, compat: Compat) -> Self {
        let bounds = |i: usize| match compat {
            Compat::Api => [-1.0, 1.0],
            Compat::Reference => model.actuator_forcerange[i],
        };
        let actuators = MimoBodies::of(model).actuators();
        let low = actuators.iter().map(|&i| bounds(i)[0] as f32).collect();
        let high = actuators.iter().map(|&i| bounds(i)[1] as f32).collect();
        Self {
            space: BoxSpace::new(low, high),
            actuators,
            compat,
        }
    }

    /// Returns the control before the gear: after the limits of the motor, or under `compat: reference` unlimited, where single precision
    /// exceeds the limits in the last digits.
    fn effective(&self, model: &Model, state: &State, i: usize) -> f64 {
        let u = state.ctrl[i];
        if self.compat == Compat::Api && state.params.actuator_forcelimited[i] {
            let [lo, hi] = model.actuator_forcerange[i];
            u.max(lo).min(hi)
        } else {
            u
        }
    }
}

impl Actuation for SpringDamperModel {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn actuators(&self) -> &[usize] {
        &self.actuators
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        named(model, &self.actuators, " control")
    }

    fn prepare(&self, model: &Model, state: &mut State) {
        clear_muscles(model, state);
        state.actuator_target.clear();
    }

    fn set_action(&self, _model: &Model, state: &mut State, action: &[f32]) {
        for (k, (&i, &a)) in self.actuators.iter().zip(action).enumerate() {
            state.ctrl[i] = f64::from(self.space.clip(k, a));
        }
    }

    fn substep(&self, _model: &Model, _state: &mut State) {}

    fn drive(&self, _model: &Model, state: &mut State, action: &[f32], commands: &[MotorCommand]) {
        for (k, (&i, command)) in self.actuators.iter().zip(commands).enumerate() {
            let own = f64::from(self.space.clip(k, action[k])) * (1.0 - command.suppress);
            let gear = state.params.actuator_gear[i];
            let reflex = if gear == 0.0 { 0.0 } else { command.torque / gear };
            let [low, high] = [self.space.low()[k], self.space.high()[k]].map(f64::from);
            state.ctrl[i] = (own + reflex).max(low).min(high);
        }
    }

    fn strength(&self, model: &Model) -> Vec<[f64; 2]> {
        let torques = |&i: &usize| {
            let [low, high] = if model.actuator_forcelimited[i] {
                model.actuator_forcerange[i]
            } else {
                [-1.0, 1.0]
            };
            [-low.max(-1.0), high.min(1.0)].map(|share| (share * model.actuator_gear[i]).max(0.0))
        };
        self.actuators.iter().map(torques).collect()
    }

    fn reset(&self, _model: &Model, state: &mut State) {
        state.act.fill(0.0);
        state.ctrl.fill(0.0);
        for (k, &i) in self.actuators.iter().enumerate() {
            state.ctrl[i] = f64::from(self.space.clip(k, 0.0));
        }
    }

    fn observation_len(&self) -> usize {
        2 * self.space.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        [" control", " torque"]
            .map(|ending| named(model, &self.actuators, ending))
            .concat()
    }

    /// Writes controls, then torques (N m): gear times the control within the motor's limits.
    fn observe(&self, model: &Model, state: &State, out: &mut [f64]) {
        let (controls, torques) = out.split_at_mut(self.actuators.len());
        let gears = &state.params.actuator_gear;
        for ((control, t), &i) in controls.iter_mut().zip(torques).zip(&self.actuators) {
            *control = state.ctrl[i];
            *t = gears[i] * self.effective(model, state, i);
        }
    }

    /// Returns `sum |u^2 T| / (n sum T)` over the controls `u` within the motors' limits and the gears `T`.
    fn cost(&self, model: &Model, state: &State) -> f64 {
        let gears = &state.params.actuator_gear;
        let total: f64 = self.actuators.iter().map(|&i| gears[i]).sum();
        let spent: f64 = self
            .actuators
            .iter()
            .map(|&i| (self.effective(model, state, i).powi(2) * gears[i]).abs())
            .sum();
        if total == 0.0 {
            0.0
        } else {
            spent / (self.actuators.len() as f64 * total)
        }
    }
}
