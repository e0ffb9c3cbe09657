//! The torque of gravity on the joints of a body, for comparison with its strength.

use crate::math::{Vec3, add_scaled, cross, norm, scale, sub};
use crate::mimo::{MimoJoints, ROOT};
use crate::model::Model;
use crate::physics::{State, Topology, kinematics};

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.81;

/// Distance from the palm at which a hand that hangs from a bar carries its share of the weight, m (u).
pub(super) const GRIP_ARM: f64 = 0.02;

/// The parts of a body with all joints at 0, and the effect of gravity on them.
pub(super) struct Weights<'m> {
    model: &'m Model,
    state: State,
}

impl<'m> Weights<'m> {
    /// Puts a model's MIMo into his pose with all joints at 0.
    pub fn of(model: &'m Model) -> Self {
        let mut state = State::new(model, &Topology::new(model));
        for q in MimoJoints::new(model).qpos {
            state.qpos[q] = 0.0;
        }
        kinematics(model, &mut state);
        Self { model, state }
    }

    /// Returns the mass beyond a joint, kg, and the vector from the joint to its centre, m.
    fn beyond(&self, joint: usize) -> (f64, Vec3) {
        let (model, state) = (self.model, &self.state);
        let body = model.jnt_bodyid[joint];
        let (mut mass, mut moment) = (0.0, [0.0; 3]);
        for b in (0..model.nbody()).filter(|&b| model.in_subtree(b, body)) {
            mass += model.body_mass[b];
            moment = add_scaled(moment, state.xipos[b], model.body_mass[b]);
        }
        (mass, sub(scale(moment, 1.0 / mass), state.xanchor[joint]))
    }

    /// Returns the greatest torque of gravity about a joint, over all directions of gravity, N m; `None` without the joint.
    pub fn torque(&self, joint: &str) -> Option<f64> {
        let joint = self.model.joint(joint)?;
        let (mass, arm) = self.beyond(joint);
        Some(GRAVITY * mass * norm(cross(self.state.xaxis[joint], arm)))
    }

    /// Returns the weight beyond a joint times the distance of its centre from the joint, N m: the largest torque about any axis. `None`
    /// if the joint does not exist.
    pub fn load(&self, joint: &str) -> Option<f64> {
        let (mass, arm) = self.beyond(self.model.joint(joint)?);
        Some(GRAVITY * mass * norm(arm))
    }

    /// Returns the weight of the body, N.
    pub fn weight(&self) -> Option<f64> {
        let (model, hip) = (self.model, self.model.body(ROOT)?);
        let masses = (0..model.nbody()).filter(|&b| model.in_subtree(b, hip));
        Some(GRAVITY * masses.map(|b| model.body_mass[b]).sum::<f64>())
    }

    /// Returns half the weight of the body times the length of a thigh, N m: the torque on a leg that carries half the body with its thigh
    /// horizontal.
    pub fn support(&self) -> Option<f64> {
        let at = |name| self.model.body(name).map(|b| self.state.xpos[b]);
        let thigh = norm(sub(at("left_upper_leg")?, at("left_lower_leg")?));
        Some(0.5 * self.weight()? * thigh)
    }

    /// Returns half the weight of the body times the arm of a hand's grip, N m.
    pub fn grip(&self) -> Option<f64> {
        Some(0.5 * self.weight()? * GRIP_ARM)
    }
}
