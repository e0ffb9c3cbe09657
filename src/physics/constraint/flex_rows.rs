//! The rows of flex contacts, which several bodies on either side may move.

use super::ConstraintType;
use super::append::RowAppender;
use super::contact_rows::{cone_lines, cone_parameters, pyramid_lines, pyramid_parameters};
use crate::detected::{ContactSide, FlexContact};
use crate::math::{MINVAL, Vec3, norm, sub};
use crate::model::{ConeType, Model};
use crate::state::State;

/// Maximum number of bodies that move both sides of a contact.
const MOST: usize = 8;

/// The bodies that move a contact, each with its weight, which is negative on the first side.
#[derive(Default)]
struct WeightedBodies {
    bodies: [(usize, f64); MOST],
    count: usize,
}

impl WeightedBodies {
    fn add(&mut self, body: usize, weight: f64) {
        if let Some(place) = self.bodies.get_mut(self.count) {
            *place = (body, weight);
            self.count += 1;
        }
    }

    /// Collects the bodies of a contact.
    fn of(model: &Model, s: &State, contact: &FlexContact) -> Self {
        let mut all = Self::default();
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            match contact.sides[side] {
                ContactSide::Geom(geom) => all.add(model.geom_bodyid[geom], sign),
                ContactSide::Vertex { flex, vertex } => all.add(model.flexes[flex].vertbodyid[vertex], sign),
                ContactSide::Element { flex, element } => {
                    let other = match contact.sides[1 - side] {
                        ContactSide::Vertex { vertex, .. } => Some(vertex),
                        _ => None,
                    };
                    all.element(model, s, (flex, element), other, (contact.contact.pos, sign));
                }
            }
        }
        all
    }

    /// Adds the bodies of an element's vertices, weighted by their inverse distances from a point. As in MuJoCo the squares of the weights
    /// add up to 1; a vertex that touches its own element is left out.
    fn element(
        &mut self,
        model: &Model,
        s: &State,
        (flex, element): (usize, usize),
        without: Option<usize>,
        (point, sign): (Vec3, f64),
    ) {
        let (flex, first) = (&model.flexes[flex], self.count);
        let vertices = flex.element(element).iter().filter(|v| Some(**v) != without);
        for &v in vertices {
            let distance = norm(sub(point, s.flexvert_xpos[flex.vertadr + v]));
            self.add(flex.vertbodyid[v], 1.0 / distance.max(MINVAL));
        }
        let own = &mut self.bodies[first..self.count];
        let length = own.iter().map(|(_, weight)| weight * weight).sum::<f64>().sqrt();
        own.iter_mut().for_each(|(_, weight)| *weight *= sign / length);
    }
}

/// Appends the rows of a contact of a flex; `k` is its place among those of flexes.
#[inline(never)]
pub fn flex_contact(rows: &mut RowAppender, s: &mut State, k: usize) {
    let model = rows.model;
    let first = rows.efc.pos.len();
    let touch = &s.flex_contact[k];
    let c = &touch.contact;
    let included = c.dist < c.includemargin && {
        let all = WeightedBodies::of(model, s, touch);
        let bodies = &all.bodies[..all.count];
        let weight = |(body, weight): &(usize, f64)| s.params.body_invweight0[*body][0] * weight.abs();
        let diag: f64 = bodies.iter().map(weight).sum();
        let pyramidal = model.opt.cone == ConeType::Pyramidal && c.dim > 1;
        let (kind, dim) = match c.dim {
            1 => (ConstraintType::ContactFrictionless, 1),
            dim if pyramidal => (ConstraintType::ContactPyramidal, 2 * (dim - 1)),
            dim => (ConstraintType::ContactElliptic, dim),
        };
        rows.weighted(
            (kind, s.contact.len() + k, dim),
            s,
            c.pos,
            bodies,
            |translation, rotation, out| {
                if pyramidal {
                    pyramid_lines(c, translation, rotation, out);
                } else {
                    cone_lines(c, translation, rotation, out);
                }
            },
        );
        let fixed = bodies.iter().all(|&(b, _)| model.body_weldid[b] == 0);
        let keeps = rows.block_mut().ncol > 0 || model.nv > 0 && !(fixed && model.opt.jacobian.is_sparse(model.nv));
        if !keeps {
            rows.drop_block();
        } else if pyramidal {
            pyramid_parameters(rows, c, diag);
        } else {
            cone_parameters(rows, c, diag);
        }
        keeps
    };
    s.flex_contact[k].contact.efc_address = included.then_some(first);
}
