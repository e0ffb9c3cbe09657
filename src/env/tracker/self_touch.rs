//! Which parts of the body the palms touch.

use super::body;
use crate::env::{EnvError, PartNames, PerHand};
use crate::model::Model;
use crate::physics::State;

/// The geoms (ngeom) that are palms, and those that are MIMo's.
#[derive(Clone, Debug)]
pub(in crate::env) struct SelfTouch {
    right_palm: Vec<bool>,
    left_palm: Vec<bool>,
    own: Vec<bool>,
    pub names: PartNames,
}

impl SelfTouch {
    pub fn new(model: &Model) -> Result<Self, EnvError> {
        let purpose = "behavior self_touch";
        let (right, left) = (body(model, "right_hand", purpose)?, body(model, "left_hand", purpose)?);
        let hip = body(model, "hip", purpose)?;
        let of = |f: &dyn Fn(usize) -> bool| model.geom_bodyid.iter().map(|&b| f(b)).collect::<Vec<bool>>();
        Ok(Self {
            right_palm: of(&|b| b == right),
            left_palm: of(&|b| b == left),
            own: of(&|b| model.in_subtree(b, hip)),
            names: PartNames::new(model),
        })
    }

    /// Returns the number of geoms.
    pub fn ngeom(&self) -> usize {
        self.own.len()
    }

    /// Adds the parts that the palms touch. A contact counts for the first rule that fits: right palm as first geom, as
    /// second, left palm as first, as second.
    pub fn update(&self, s: &State, touches: &mut PerHand<Vec<usize>>) {
        for c in &s.contact {
            let [a, b] = c.geom;
            let (list, other) = if self.right_palm[a] {
                (&mut touches.right_hand, b)
            } else if self.right_palm[b] {
                (&mut touches.right_hand, a)
            } else if self.left_palm[a] {
                (&mut touches.left_hand, b)
            } else if self.left_palm[b] {
                (&mut touches.left_hand, a)
            } else {
                continue;
            };
            if self.own[other] && !list.contains(&other) {
                list.push(other);
            }
        }
    }
}
