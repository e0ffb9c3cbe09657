//! Contact forces, computed from the forces of their rows.

use crate::detected::Contact;
use crate::model::{ConeType, Model};
use crate::state::State;

/// Fills in the force of each contact (MuJoCo's `mj_contactForce`).
#[doc(alias = "mj_contactForce")]
#[inline(always)]
pub fn contact_forces(model: &Model, s: &mut State) {
    let (cone, rows) = (model.opt.cone, &s.efc.force[..]);
    for c in &mut s.contact {
        c.force = force(c, cone, rows);
    }
    for c in &mut s.flex_contact {
        c.contact.force = force(&c.contact, cone, rows);
    }
}

/// Returns the force and torque of a contact from those of all rows.
#[inline(always)]
fn force(c: &Contact, cone: ConeType, rows: &[f64]) -> [f64; 6] {
    let mut force = [0.0; 6];
    match c.efc_address {
        Some(row) if cone == ConeType::Pyramidal && c.dim > 1 => {
            force = decode_pyramid(&rows[row..row + 2 * (c.dim - 1)], &c.friction);
        }
        Some(row) => force[..c.dim].copy_from_slice(&rows[row..row + c.dim]),
        None => {}
    }
    force
}

/// Returns the sum of the forces along the edges of a contact's pyramid, as force and torque in the frame of the contact
/// (MuJoCo's `mju_decodePyramid`).
fn decode_pyramid(edges: &[f64], friction: &[f64; 5]) -> [f64; 6] {
    let mut force = [0.0; 6];
    for (k, (edge, f)) in edges.chunks_exact(2).zip(friction).enumerate() {
        force[0] += edge[0] + edge[1];
        force[k + 1] = (edge[0] - edge[1]) * f;
    }
    force
}
