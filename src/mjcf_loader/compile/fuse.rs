//! Fuses bodies without joints with their parents, if the document requests it (`<compiler fusestatic>`).

use super::context::Context;
use super::geometry::{Solid, merge};
use crate::document::TypedDocument;
use crate::error::LoadError;
use crate::math::{MINVAL, Quat, Vec3, add, quat_mul, quat_rotate};

/// A body that is not fused with its parent.
pub(super) struct KeptBody {
    /// Its index in the document.
    pub body: usize,
    /// The id of its parent, and its pose in the parent's frame.
    pub parent: usize,
    pub pos: Vec3,
    pub quat: Quat,
    /// The bodies that are fused with it, in document order.
    pub fused: Vec<FusedBody>,
}

/// A body that is fused with an ancestor.
pub(super) struct FusedBody {
    /// Its index in the document.
    pub body: usize,
    /// Its pose in the ancestor's frame.
    pos: Vec3,
    quat: Quat,
}

impl FusedBody {
    /// Transforms poses from the body's frame to the ancestor's.
    pub fn carry(&self, pos: &mut [Vec3], quat: &mut [Quat]) {
        for (pos, quat) in pos.iter_mut().zip(quat) {
            (*pos, *quat) = self.seen(*pos, *quat);
        }
    }

    /// Returns the ancestor's mass properties with those of the body added.
    pub fn added_to(&self, whole: Solid, mut own: Solid) -> Result<Solid, &'static str> {
        // a body of markers alone: two bodies without mass cannot be merged
        if own.mass < MINVAL {
            return Ok(whole);
        }
        (own.pos, own.quat) = self.seen(own.pos, own.quat);
        // one body after the other, as in MuJoCo: merging all at once would round differently
        merge(&[whole, own])
    }

    fn seen(&self, pos: Vec3, quat: Quat) -> (Vec3, Quat) {
        (add(self.pos, quat_rotate(self.quat, pos)), quat_mul(self.quat, quat))
    }
}

/// Returns the bodies that remain, in document order.
pub(super) fn places(context: &Context, document: &TypedDocument) -> Result<Vec<KeptBody>, LoadError> {
    let fuses = fuses(document);
    let mut places: Vec<KeptBody> = Vec::with_capacity(document.bodies.len());
    // for each body of the document: the id of the body that it becomes or is fused with, and in the second case its index among those
    let mut ends: Vec<(usize, Option<usize>)> = Vec::with_capacity(document.bodies.len());
    for (at, body) in document.bodies.iter().enumerate() {
        let quat = context.quat_of(body.at, &body.frame)?;
        let (mut pos, mut quat) = context.placed(body.within, body.frame.pos, quat);
        // the world has itself as its parent, and no entry yet
        let (parent, among) = ends.get(body.parent).copied().unwrap_or((0, None));
        // a child of a fused body hangs on the ancestor that remains, so its pose is composed with that of its parent
        if let Some(carrier) = among.map(|k| &places[parent].fused[k]) {
            (pos, quat) = carrier.seen(pos, quat);
        }
        // the world has no parent, and programs move mocap bodies
        if fuses && at > 0 && !body.mocap && body.joints.is_empty() {
            let fused = &mut places[parent].fused;
            ends.push((parent, Some(fused.len())));
            fused.push(FusedBody { body: at, pos, quat });
        } else {
            ends.push((places.len(), None));
            places.push(KeptBody {
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

/// Returns whether bodies of a document are fused. As in MuJoCo 3.3.0, none is fused if the document has a camera, a light, or any element
/// of a kind that can refer to a body or to an element of a body, even if it refers to something else.
fn fuses(d: &TypedDocument) -> bool {
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
    // fusing concerns the whole tree, so settings of attached models do not count
    d.compilers[0].fusestatic && blind && named.iter().all(|&count| count == 0)
}
