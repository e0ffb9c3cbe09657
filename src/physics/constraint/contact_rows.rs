//! The rows of contacts, with cones or pyramids.

use super::append::{RowAppender, RowParameters};
use super::impedance::is_solref;
use super::{ConstraintType, impedance};
use crate::detected::Contact;
use crate::math::{MINVAL, row};
use crate::model::{ConeType, Model};
use crate::state::State;
use crate::tiles::Lanes;

/// Appends the rows of contact `i`.
#[doc(alias = "mj_instantiateContact")]
#[inline(always)]
pub fn contact(rows: &mut RowAppender, s: &mut State, i: usize) {
    s.contact[i].efc_address = None;
    let c = &s.contact[i];
    // within its gap a contact is listed, for programs to see, but gives no force
    if c.dist >= c.includemargin {
        return;
    }
    let first = rows.efc.pos.len();
    let added = match rows.model.opt.cone {
        ConeType::Pyramidal if c.dim > 1 => pyramid(rows, s, i),
        _ => cone(rows, s, i),
    };
    if added {
        s.contact[i].efc_address = Some(first);
    }
}

/// Appends the rows of a contact with an elliptic cone, or without friction: the normal, then friction. The friction rows
/// have no stiffness; their regularisation follows from that of the normal so that the cone keeps its shape. Returns
/// whether there are any.
#[inline(always)]
fn cone(rows: &mut RowAppender, s: &State, i: usize) -> bool {
    let model = rows.model;
    let c = &s.contact[i];
    let [b1, b2] = c.geom.map(|g| model.geom_bodyid[g]);
    let kind = if c.dim == 1 {
        ConstraintType::ContactFrictionless
    } else {
        ConstraintType::ContactElliptic
    };
    rows.relative(
        (kind, i, c.dim),
        s,
        (b1, c.pos),
        (b2, c.pos),
        #[inline(always)]
        |translation, rotation, out| cone_lines(c, translation, rotation, out),
    );
    if rows.block_mut().ncol == 0 && !keeps_without_effect(model, [b1, b2]) {
        rows.drop_block();
        return false;
    }
    let diag = s.params.body_invweight0[b1][0] + s.params.body_invweight0[b2][0];
    cone_parameters(rows, c, diag);
    true
}

/// Appends the rows of the last block, a contact with an elliptic cone or without friction. `diag` approximates the diagonal of
/// `J M^-1 J'`.
#[inline(always)]
pub(super) fn cone_parameters(rows: &mut RowAppender, c: &Contact, diag: f64) {
    let model = rows.model;
    let first = rows.efc.pos.len();
    let spec = RowParameters {
        solref: c.solref,
        solimp: c.solimp,
        diag,
    };
    let mut damping = rows.row(c.dist, c.includemargin, c.dist - c.includemargin, spec);
    if c.dim > 1 {
        if is_solref(c.solreffriction) {
            damping = impedance(c.solreffriction, c.solimp, 0.0, model.opt.least_timeconst()).b;
        }
        let normal = rows.efc.r[first];
        // `impratio` says how many times as stiff friction is as the normal
        let sliding = normal / model.opt.impratio.max(MINVAL);
        for f in c.friction.iter().take(c.dim - 1) {
            let r = sliding * c.friction[0] * c.friction[0] / (f * f);
            rows.push(0.0, 0.0, diag, r, 0.0, damping);
        }
        rows.efc.r[first + 1] = sliding;
        rows.efc.d[first + 1] = 1.0 / sliding;
        rows.cone(c.friction[0] * (sliding / normal).sqrt(), c.friction);
    }
}

/// Appends the rows of a contact with a pyramidal cone: for each direction of friction two edges, the normal plus and
/// minus that direction times its coefficient. Returns whether there are any.
///
/// All edges have one regularisation, `2 mu^2 R` with `mu = friction_0 / sqrt(impratio)` and `R` that of the first edge:
/// then the pyramid resists pressing as the normal alone would.
#[inline(always)]
fn pyramid(rows: &mut RowAppender, s: &State, i: usize) -> bool {
    let model = rows.model;
    let c = &s.contact[i];
    let [b1, b2] = c.geom.map(|g| model.geom_bodyid[g]);
    let edges = 2 * (c.dim - 1);
    rows.relative(
        (ConstraintType::ContactPyramidal, i, edges),
        s,
        (b1, c.pos),
        (b2, c.pos),
        #[inline(always)]
        |translation, rotation, out| pyramid_lines(c, translation, rotation, out),
    );
    if rows.block_mut().ncol == 0 && !keeps_without_effect(model, [b1, b2]) {
        rows.drop_block();
        return false;
    }
    let [w1, w2] = [b1, b2].map(|b| s.params.body_invweight0[b][0]);
    pyramid_parameters(rows, c, w1 + w2);
    true
}

/// Appends the rows of the last block, a contact with a pyramidal cone. `diag` approximates the diagonal of `J M^-1 J'` along the
/// normal.
#[inline(always)]
pub(super) fn pyramid_parameters(rows: &mut RowAppender, c: &Contact, diag: f64) {
    let model = rows.model;
    let first = rows.efc.pos.len();
    let spec = RowParameters {
        solref: c.solref,
        solimp: c.solimp,
        diag: diag * (1.0 + c.friction[0] * c.friction[0]),
    };
    let violation = c.dist - c.includemargin;
    for _ in 0..2 * (c.dim - 1) {
        rows.row(c.dist, c.includemargin, violation, spec);
    }
    let mu = c.friction[0] * (1.0 / model.opt.impratio.max(MINVAL)).sqrt();
    let r = (2.0 * mu * mu * rows.efc.r[first]).max(MINVAL);
    rows.efc.r[first..].fill(r);
    rows.efc.d[first..].fill(1.0 / r);
    rows.cone(mu, c.friction);
}

/// Writes the rows of a tile for an elliptic cone, or none.
#[inline(always)]
pub(super) fn cone_lines(c: &Contact, translation: &[Lanes; 3], rotation: &[Lanes; 3], out: &mut Vec<Lanes>) {
    for r in 0..c.dim {
        out.push(contact_row(c, r, translation, rotation));
    }
}

/// Writes the rows of a tile for a pyramidal cone.
#[inline(always)]
pub(super) fn pyramid_lines(c: &Contact, translation: &[Lanes; 3], rotation: &[Lanes; 3], out: &mut Vec<Lanes>) {
    let normal = contact_row(c, 0, translation, rotation);
    for r in 1..c.dim {
        let (along, f) = (contact_row(c, r, translation, rotation), c.friction[r - 1]);
        out.push(std::array::from_fn(|k| normal[k] + f * along[k]));
        out.push(std::array::from_fn(|k| normal[k] - f * along[k]));
    }
}

/// Returns whether MuJoCo gives rows to a contact of two bodies that no degree of freedom moves relative to each other. Such
/// rows move nothing, but the contact has a force; sparse, it drops those that no degree of freedom moves at all.
fn keeps_without_effect(model: &Model, bodies: [usize; 2]) -> bool {
    let fixed = bodies.iter().all(|&b| model.body_weldid[b] == 0);
    model.nv > 0 && !(fixed && model.opt.jacobian.is_sparse(model.nv))
}

/// Returns row `r` of the frame of a contact applied to the motion of a tile: translation along its three axes, then
/// rotation about them.
#[inline(always)]
fn contact_row(c: &Contact, r: usize, translation: &[Lanes; 3], rotation: &[Lanes; 3]) -> Lanes {
    let (axis, motion) = (row(&c.frame, r % 3), if r < 3 { translation } else { rotation });
    let mut lanes = [0.0; 4];
    for k in 0..4 {
        lanes[k] = axis[0] * motion[0][k] + axis[1] * motion[1][k] + axis[2] * motion[2][k];
    }
    lanes
}
