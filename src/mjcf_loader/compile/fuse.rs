//! Where bodies stand: bodies without joints become part of what carries them where the document asks for it.

use super::body::quat_of;
use super::context::Context;
use super::geometry::{Solid, merge};
use crate::document::Document;
use crate::error::LoadError;
use crate::math::{MINVAL, Quat, Vec3, add, quat_mul, quat_rotate};

/// A body that stays one.
pub(super) struct Place {
    /// Its place in the document.
    pub body: usize,
    /// The id of the body that carries it, and its pose in that.
    pub parent: usize,
    pub pos: Vec3,
    pub quat: Quat,
    /// The bodies that are fused with it, in their order.
    pub fused: Vec<Fused>,
}

/// A body that is fused with another one.
pub(super) struct Fused {
    /// Its place in the document.
    pub body: usize,
    /// Its pose in the other.
    pos: Vec3,
    quat: Quat,
}

impl Fused {
    /// Takes poses in the body to that with which it is fused.
    pub fn carry(&self, pos: &mut [Vec3], quat: &mut [Quat]) {
        for (pos, quat) in pos.iter_mut().zip(quat) {
            (*pos, *quat) = self.seen(*pos, *quat);
        }
    }

    /// Returns the body with which it is fused, with its mass.
    pub fn added_to(&self, whole: Solid, mut own: Solid) -> Result<Solid, &'static str> {
        if own.mass < MINVAL {
            return Ok(whole);
        }
        (own.pos, own.quat) = self.seen(own.pos, own.quat);
        merge(&[whole, own])
    }

    fn seen(&self, pos: Vec3, quat: Quat) -> (Vec3, Quat) {
        (add(self.pos, quat_rotate(self.quat, pos)), quat_mul(self.quat, quat))
    }
}

/// Returns the bodies that stay, in their order.
pub(super) fn places(context: &Context, document: &Document) -> Result<Vec<Place>, LoadError> {
    let fuses = fuses(document);
    let mut places: Vec<Place> = Vec::with_capacity(document.bodies.len());
    // the id with which each body ends, and if it is fused its place among what is fused with that
    let mut ends: Vec<(usize, Option<usize>)> = Vec::with_capacity(document.bodies.len());
    for (at, body) in document.bodies.iter().enumerate() {
        let quat = quat_of(context, body.at, &body.frame)?;
        let (mut pos, mut quat) = context.placed(body.within, body.frame.pos, quat);
        let (parent, among) = ends.get(body.parent).copied().unwrap_or((0, None));
        if let Some(carrier) = among.map(|k| &places[parent].fused[k]) {
            (pos, quat) = carrier.seen(pos, quat);
        }
        if fuses && at > 0 && !body.mocap && body.joints.is_empty() {
            let fused = &mut places[parent].fused;
            ends.push((parent, Some(fused.len())));
            fused.push(Fused { body: at, pos, quat });
        } else {
            ends.push((places.len(), None));
            places.push(Place {
                body: at,
                parent,
                pos,
                quat,
                fused: Vec::new(),
            });
        }
    }
    Ok(places)
}

/// Tells whether bodies of a document are fused. As in MuJoCo 3.3.0 none is where there is an element of a kind that may name a body or what
/// it carries, whatever it names, or a camera or a light.
fn fuses(d: &Document) -> bool {
    let named = [
        d.skins.len(),
        d.pairs.len(),
        d.excludes.len(),
        d.equalities.len(),
        d.tendons.len(),
        d.actuators.len(),
        d.sensors.len(),
        d.tuples.len(),
    ];
    let blind = d
        .bodies
        .iter()
        .all(|body| body.cameras.is_empty() && body.lights.is_empty());
    d.compilers[0].fusestatic && blind && named.iter().all(|&count| count == 0)
}
