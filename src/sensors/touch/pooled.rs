//! Touch pooled over whole parts of the body.

use super::{SkinLayout, Touch};
use crate::math::add;

/// Number of values of a body: normal force, active sensors, force vector.
pub const POOLED: usize = 5;

/// Touch pooled over each body with skin, in the order of their ids. The values of a body are
/// - the sum of the normal forces that its sensors feel, N,
/// - the number of its sensors whose value is not zero,
/// - the sum of the forces that its sensors feel, N, x, y and z in the frame of the body.
///
/// This sense is babybench's own. No version of MIMo has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TouchPool {
    /// For each body of the skin, in its order, the place among the values.
    place: Vec<usize>,
    /// The bodies, by id, in the order of the values.
    bodies: Vec<usize>,
}

impl TouchPool {
    /// Creates the sense of a skin.
    pub fn new(layout: &SkinLayout) -> Self {
        let mut bodies: Vec<usize> = layout.bodies().iter().map(|b| b.body).collect();
        bodies.sort_unstable();
        let place = |body: usize| bodies.partition_point(|&b| b < body);
        Self {
            place: layout.bodies().iter().map(|b| place(b.body)).collect(),
            bodies,
        }
    }

    /// Returns the bodies, by id, in the order of the values.
    pub fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    /// Returns the number of values: [`POOLED`] for each body.
    pub fn len(&self) -> usize {
        POOLED * self.bodies.len()
    }

    /// Returns whether there are no bodies with skin.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Writes the sums of `touch`, the sense of touch that this one was built for.
    pub fn observe(&self, touch: &Touch, out: &mut [f64]) {
        out.fill(0.0);
        for contact in touch.contacts().iter().filter(|c| c.felt) {
            let at = POOLED * self.place[contact.index];
            out[at] += contact.normal;
            let force = add([out[at + 2], out[at + 3], out[at + 4]], contact.force_body);
            out[at + 2..at + POOLED].copy_from_slice(&force);
        }
        for sensor in touch.active() {
            if let Ok(at) = self.bodies.binary_search(&sensor.body) {
                out[POOLED * at + 1] += 1.0;
            }
        }
    }
}
