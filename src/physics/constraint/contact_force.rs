//! Forces of contacts from those of their rows.

use crate::model::{ConeType, Model};
use crate::state::State;

/// Fills in the force of each contact (MuJoCo's `mj_contactForce`).
#[doc(alias = "mj_contactForce")]
#[inline(always)]
pub fn contact_forces(model: &Model, s: &mut State) {
    for c in &mut s.contact {
        c.force = [0.0; 6];
        match c.efc_address {
            Some(row) if model.opt.cone == ConeType::Pyramidal && c.dim > 1 => {
                c.force = decode_pyramid(&s.efc.force[row..row + 2 * (c.dim - 1)], &c.friction);
            }
            Some(row) => c.force[..c.dim].copy_from_slice(&s.efc.force[row..row + c.dim]),
            None => {}
        }
    }
}

/// Returns the force and torque in the frame of a contact that the forces along the edges of its pyramid add up to
/// (MuJoCo's `mju_decodePyramid`).
fn decode_pyramid(edges: &[f64], friction: &[f64; 5]) -> [f64; 6] {
    let mut force = [0.0; 6];
    for (k, (edge, f)) in edges.chunks_exact(2).zip(friction).enumerate() {
        force[0] += edge[0] + edge[1];
        force[k + 1] = (edge[0] - edge[1]) * f;
    }
    force
}
