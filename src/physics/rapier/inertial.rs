//! Principal axes and moments of inertia in the order that Rapier needs.

use rapier3d_f64::parry::math::{Pose, Vector};

use crate::scene::pose;
use mjcf_sim_model::math::{quat_mul, quat_normalize};
use mjcf_sim_model::model::Model;

/// Returns the principal axes of a body and their moments, in ascending order of the moments.
///
/// Rapier adds up the mass properties of a body and its colliders and diagonalises the sum, which fails for moments
/// below about 1e-5 kg m^2 unless it is diagonal and ascending already.
pub(super) fn inertial(model: &Model, b: usize) -> (Pose, Vector) {
    let (mut quat, mut moments) = (model.body_iquat[b], model.body_inertia[b]);
    let half = 0.5_f64.sqrt();
    for first in [0, 1, 0] {
        if moments[first] > moments[first + 1] {
            moments.swap(first, first + 1);
            let mut rotation = [half, 0.0, 0.0, 0.0];
            rotation[1 + (first + 2) % 3] = half;
            quat = quat_mul(quat, rotation);
        }
    }
    (
        pose(model.body_ipos[b], quat_normalize(quat)),
        Vector::new(moments[0], moments[1], moments[2]),
    )
}
