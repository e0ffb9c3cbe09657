//! Contacts with skin, seen from the touched body.

use super::SkinLayout;
use crate::config::Compat;
use crate::math::*;
use crate::model::Model;
use crate::physics::{Contact, ContactSide, FlexContact};

/// Least normal force (N) of a contact that is felt.
pub(crate) const MIN_FORCE: f64 = 1e-9;

/// One side of a contact: a body with skin, and the geom or the part of a flex that touches it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchContact {
    /// Index in the list of contacts; contacts of flexes are counted after all those of geoms.
    pub contact: usize,
    /// Body with the skin, by id.
    pub body: usize,
    /// Its geom in the contact, by id.
    pub geom: usize,
    /// Geom that touches it, or vertex or element of a flex.
    pub other: ContactSide,
    /// Normal force, N, >= 0.
    pub normal: f64,
    /// Force that the other side exerts on the body, N, world frame.
    pub force: Vec3,
    /// Force that the other side exerts on the body, N, frame of the body.
    pub force_body: Vec3,
    /// Point of contact, m, world frame.
    pub point: Vec3,
    /// Point of contact, m, frame of the body.
    pub point_body: Vec3,
    /// Whether a sensor is near enough to sense it; set by [`Touch::sense`](super::Touch::sense).
    pub felt: bool,
    /// Index of the body in [`SkinLayout::bodies`].
    pub(super) index: usize,
    /// Index of the touched geom among the contact's two sides.
    pub(super) side: usize,
}

impl TouchContact {
    /// Returns the sign of the contact's force on this side: -1 for the first of the contact's sides, 1 for the second.
    pub(super) fn sign(&self) -> f64 {
        2.0 * self.side as f64 - 1.0
    }
}

/// Appends to `out` the sides of `contacts` whose bodies have skin, the side of the first geom first.
///
/// `xpos` (m) and `xmat` are the poses of all bodies at the instant of the contacts. The point of a contact, halfway
/// between the surfaces, is moved to the surface of the body with skin; under `compat: reference` both sides of a contact
/// whose first body has skin are at the first body's point, as the Python code inverts the normal in place.
pub fn touch_contacts(
    layout: &SkinLayout,
    model: &Model,
    contacts: &[Contact],
    xpos: &[Vec3],
    xmat: &[Mat3],
    compat: Compat,
    out: &mut Vec<TouchContact>,
) {
    let touched = TouchedBodies {
        layout,
        model,
        poses: (xpos, xmat),
        compat,
    };
    for (k, c) in contacts.iter().enumerate() {
        touched.add(k, c.geom.map(ContactSide::Geom), c, out);
    }
}

/// Appends to `out` the sides of contacts of flexes whose bodies have skin, as [`touch_contacts`] does. The contacts are numbered from `first`.
pub(super) fn touch_flexes(
    touched: &TouchedBodies,
    first: usize,
    contacts: &[FlexContact],
    out: &mut Vec<TouchContact>,
) {
    for (k, c) in contacts.iter().enumerate() {
        touched.add(first + k, c.sides, &c.contact, out);
    }
}

/// Bodies that may have skin, at the instant of the contacts.
pub(super) struct TouchedBodies<'a> {
    pub layout: &'a SkinLayout,
    pub model: &'a Model,
    /// Positions (m) and orientations of all bodies.
    pub poses: (&'a [Vec3], &'a [Mat3]),
    pub compat: Compat,
}

impl TouchedBodies<'_> {
    /// Adds the sides of a contact that have skin.
    #[inline(always)]
    fn add(&self, contact: usize, sides: [ContactSide; 2], c: &Contact, out: &mut Vec<TouchContact>) {
        let (xpos, xmat) = self.poses;
        let touched = sides.map(|side| {
            let geom = side.geom()?;
            let body = self.model.geom_bodyid[geom];
            self.layout.index(body).map(|index| (geom, body, index))
        });
        if touched == [None; 2] || c.force[0].abs() < MIN_FORCE {
            return;
        }
        let normal = row(&c.frame, 0);
        let force = mat_t_vec(&c.frame, [c.force[0], c.force[1], c.force[2]]);
        for side in 0..2 {
            let Some((geom, b, index)) = touched[side] else {
                continue;
            };
            let sign = 2.0 * side as f64 - 1.0;
            let outward = match self.compat {
                Compat::Api => sign,
                Compat::Reference if side == 1 && touched[0].is_some() => -1.0,
                Compat::Reference => sign,
            };
            let point = if c.dist < 0.0 {
                add_scaled(c.pos, normal, outward * c.dist / 2.0)
            } else {
                c.pos
            };
            let force = scale(force, sign);
            out.push(TouchContact {
                contact,
                body: b,
                geom,
                other: sides[1 - side],
                normal: c.force[0].max(0.0),
                force,
                force_body: mat_t_vec(&xmat[b], force),
                point,
                point_body: mat_t_vec(&xmat[b], sub(point, xpos[b])),
                felt: false,
                index,
                side,
            });
        }
    }
}
