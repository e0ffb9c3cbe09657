//! Impulses of contacts on a body in a step.

use mjcf_sim_model::math::{Vec3, scale};

/// An impulse, N s, and its moment about the centre of mass of a slot's body, N m s, in the frame of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Impulse {
    pub linear: Vec3,
    pub angular: Vec3,
}

impl Impulse {
    /// Returns a share of the impulse.
    pub fn times(self, share: f64) -> Self {
        Self {
            linear: scale(self.linear, share),
            angular: scale(self.angular, share),
        }
    }
}
