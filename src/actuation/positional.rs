//! Position servos: the action is the desired angle.

use crate::actuation::{Actuation, ActuationError, named};
use crate::config::Compat;
use crate::env::BoxSpace;
use crate::model::{BiasType, EqualityKind, Model};
use crate::physics::State;

/// The positional model: a servo of 1 N m/rad on each joint pulls it to the action, an angle in rad within the joint's
/// range.
///
/// The target of a joint that an active joint equality holds (the scene's or a lock) is 0, whatever the action. The
/// observation is the clipped action itself, for those joints too.
///
/// With a `frame_skip` above 1 the target holds for all substeps; under `compat: reference` every substep but the first
/// has the target and the observed action 0. The metabolic cost is 0.
#[derive(Clone, Debug)]
pub struct Positional {
    space: BoxSpace,
    /// The clipped action (nu), rad.
    control: Vec<f64>,
    /// Joint equalities of actuated joints: equality and actuator.
    equalities: Vec<(usize, usize)>,
    compat: Compat,
}

impl Positional {
    /// For the servos of `model`.
    ///
    /// # Errors
    /// An actuator that is not a servo, or whose joint has no range.
    pub fn new(model: &Model, compat: Compat) -> Result<Self, ActuationError> {
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for (i, &j) in model.actuator_trnid.iter().enumerate() {
            let actuator = || model.actuator_name[i].clone();
            if model.actuator_biastype[i] != BiasType::Affine {
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
                    allowed: "limited and more than nothing",
                });
            }
            low.push(lo as f32);
            high.push(hi as f32);
        }
        let mut equalities = Vec::new();
        for (e, kind) in model.eq_kind.iter().enumerate() {
            if let EqualityKind::Joint { joint1, joint2, .. } = kind {
                let holds = |j: usize| joint1.0 == j || joint2.is_some_and(|k| k.0 == j);
                let of = |i: &usize| holds(model.actuator_trnid[*i]);
                equalities.extend((0..model.nu()).filter(of).map(|i| (e, i)));
            }
        }
        Ok(Self {
            control: vec![0.0; low.len()],
            space: BoxSpace::new(low, high),
            equalities,
            compat,
        })
    }

    fn apply(&mut self, state: &mut State) {
        state.ctrl.copy_from_slice(&self.control);
        for &(e, i) in &self.equalities {
            if state.params.eq_active[e] {
                state.ctrl[i] = 0.0;
            }
        }
    }

    fn zero(&mut self, state: &mut State) {
        for (i, c) in self.control.iter_mut().enumerate() {
            *c = f64::from(self.space.clip(i, 0.0));
        }
        self.apply(state);
    }
}

impl Actuation for Positional {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        named(model, " angle")
    }

    fn set_action(&mut self, _model: &Model, state: &mut State, action: &[f32]) {
        for (i, (c, &a)) in self.control.iter_mut().zip(action).enumerate() {
            *c = f64::from(self.space.clip(i, a));
        }
        self.apply(state);
    }

    fn substep(&mut self, _model: &Model, state: &mut State) {
        if self.compat == Compat::Reference {
            self.zero(state);
        }
    }

    fn reset(&mut self, _model: &Model, state: &mut State) {
        self.zero(state);
    }

    fn observation_len(&self) -> usize {
        self.control.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        named(model, " angle")
    }

    /// The clipped action, rad.
    fn observe(&self, _model: &Model, _state: &State, out: &mut [f64]) {
        for (v, c) in out.iter_mut().zip(&self.control) {
            *v = *c;
        }
    }

    fn cost(&self, _model: &Model, _state: &State) -> f64 {
        0.0
    }

    fn memory(&self) -> Vec<&[f64]> {
        vec![&self.control]
    }

    fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        vec![&mut self.control]
    }
}
