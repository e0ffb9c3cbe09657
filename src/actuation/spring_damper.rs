//! Torque motors that respond at once; springs and dampers are in the joints.

use crate::actuation::{Actuation, clear_muscles, named};
use crate::config::Compat;
use crate::model::Model;
use crate::physics::State;
use crate::spaces::BoxSpace;

/// Drives joints by torque motors: the torque on a joint is gear times the control.
///
/// Under `compat: api` the action space is [-1, 1] and the motor's force range limits the torque; under
/// `compat: reference` the action space is the force range itself.
#[derive(Clone, Debug)]
pub struct SpringDamper {
    space: BoxSpace,
    compat: Compat,
}

impl SpringDamper {
    /// Builds the actuation for the motors of `model`.
    pub fn new(model: &Model, compat: Compat) -> Self {
        let bounds = |i: usize| match compat {
            Compat::Api => [-1.0, 1.0],
            Compat::Reference => model.actuator_forcerange[i],
        };
        let low = (0..model.nu()).map(|i| bounds(i)[0] as f32).collect();
        let high = (0..model.nu()).map(|i| bounds(i)[1] as f32).collect();
        Self {
            space: BoxSpace::new(low, high),
            compat,
        }
    }

    /// Returns the control before the gear: after the limits of the motor, or under `compat: reference` as it stands,
    /// where single precision exceeds the limits in the last digits.
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

impl Actuation for SpringDamper {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        named(model, " control")
    }

    fn prepare(&self, _model: &Model, state: &mut State) {
        clear_muscles(state);
        state.actuator_target.clear();
    }

    fn set_action(&self, _model: &Model, state: &mut State, action: &[f32]) {
        for (i, (ctrl, &a)) in state.ctrl.iter_mut().zip(action).enumerate() {
            *ctrl = f64::from(self.space.clip(i, a));
        }
    }

    fn substep(&self, _model: &Model, _state: &mut State) {}

    fn reset(&self, _model: &Model, state: &mut State) {
        for (i, ctrl) in state.ctrl.iter_mut().enumerate() {
            *ctrl = f64::from(self.space.clip(i, 0.0));
        }
    }

    fn observation_len(&self) -> usize {
        2 * self.space.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        [named(model, " control"), named(model, " torque")].concat()
    }

    /// Writes controls, then torques (N m): gear times the control within the motor's limits.
    fn observe(&self, model: &Model, state: &State, out: &mut [f64]) {
        let (controls, torques) = out.split_at_mut(model.nu());
        controls.copy_from_slice(&state.ctrl);
        for (i, t) in torques.iter_mut().enumerate() {
            *t = state.params.actuator_gear[i] * self.effective(model, state, i);
        }
    }

    /// Returns `sum |u^2 T| / (n sum T)` over the controls `u` within the motors' limits and the gears `T`.
    fn cost(&self, model: &Model, state: &State) -> f64 {
        let gears = &state.params.actuator_gear;
        let total: f64 = gears.iter().sum();
        let spent: f64 = (0..model.nu())
            .map(|i| (self.effective(model, state, i).powi(2) * gears[i]).abs())
            .sum();
        if total == 0.0 {
            0.0
        } else {
            spent / (model.nu() as f64 * total)
        }
    }
}
