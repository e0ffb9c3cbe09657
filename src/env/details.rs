//! Details of a step's info beyond the keys of the reference.

use std::sync::Arc;

use super::{PerEyeAndHand, PerHand};
use crate::config::Reflex;
use crate::model::Model;

/// Additions to the reference's information. The pickles of logs leave them out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InfoDetails {
    /// Names of the parts that the right and the left palm have touched, in the order of the lists of geoms, for the behavior
    /// `self_touch`; see [`PartNames`].
    pub touched_parts: Option<PerHand<Vec<Arc<str>>>>,
    /// Angle of each hand from the axis of each eye, rad, for the behavior `hand_regard`. Angles of less than 15 degrees count. `None` right after
    /// a reset or a restored snapshot.
    pub gaze_angles: Option<PerEyeAndHand<f64>>,
    /// Age of the pictures of the eyes, s, without their delay, with a [`vision_rate`](crate::Config::vision_rate). `None` right after a
    /// reset or a restored snapshot.
    pub vision_age: Option<f64>,
    /// Both ways to count hands in view, for the behavior `hand_regard`. [`BehaviorInfo`](crate::env::BehaviorInfo) holds the one that
    /// [`Compat`](crate::config::Compat) selects.
    pub regards: Option<RegardCounts>,
    /// Age of MIMo's body, months, with an [`age_schedule`](crate::Config::age_schedule).
    pub age: Option<f64>,
    /// How often each reflex acted, with [`reflexes`](crate::Config::reflexes). `None` right after a reset or a restored snapshot.
    pub reflexes: Option<ReflexShares>,
}

/// The shares of an episode's physics steps in which each reflex acted with more than a tenth of its strength.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReflexShares([Option<f64>; Reflex::ALL.len()]);

impl ReflexShares {
    /// Creates shares from a function, which returns `None` for reflexes that are off.
    pub fn from_fn(share: impl Fn(Reflex) -> Option<f64>) -> Self {
        Self(std::array::from_fn(|k| share(Reflex::ALL[k])))
    }

    /// Returns the share of a reflex, 0 to 1; `None` if it is off.
    pub fn get(&self, reflex: Reflex) -> Option<f64> {
        self.0[reflex as usize]
    }
}

/// Steps in which a hand was in the central field of view of an eye, counted in two ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegardCounts {
    /// As the API page describes it: within 15 degrees of the axis of the eye's camera.
    pub page: PerEyeAndHand<u64>,
    /// As the starter kit computes it: within 15 degrees of the -z axis of the eye's body, which points down the face.
    pub kit: PerEyeAndHand<u64>,
}

impl InfoDetails {
    /// Reserves space for the names of all parts, so that no step allocates.
    pub(crate) fn reserve(&mut self, names: &PartNames) {
        self.touched_parts = Some(PerHand::from_fn(|_| Vec::with_capacity(names.0.len())));
        self.gaze_angles = None;
    }

    /// Clears everything but keeps the allocations.
    pub(crate) fn clear(&mut self) {
        if let Some(parts) = &mut self.touched_parts {
            parts.each_mut().into_iter().for_each(Vec::clear);
        }
        (self.gaze_angles, self.vision_age, self.regards) = (None, None, None);
        (self.reflexes, self.age) = (None, None);
    }

    /// Updates the names from the geoms that each hand has touched, if the behavior lists them. The lists have grown or been cleared.
    pub(crate) fn name_parts(&mut self, touches: Option<[&[usize]; 2]>, names: &PartNames) {
        let Some(touches) = touches else {
            self.touched_parts = None;
            return;
        };
        let parts = self.touched_parts.get_or_insert_default();
        for (parts, geoms) in parts.each_mut().into_iter().zip(touches) {
            parts.truncate(geoms.len());
            let known = parts.len();
            parts.extend(geoms[known..].iter().map(|&g| names.get(g)));
        }
    }
}

/// The names of MIMo's geoms as parts of the body, such as `right_foot 2/3`.
///
/// A name is the body's, with the number of the geom within the body if there are several.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PartNames(Arc<[Arc<str>]>);

impl PartNames {
    /// Names all geoms of a scene.
    pub fn new(model: &Model) -> Self {
        let name = |g: usize| -> Arc<str> {
            let body = model.geom_bodyid[g];
            let name = &model.body_name[body];
            match model.body_geomnum[body] {
                1 => name.as_str().into(),
                of => format!("{name} {}/{of}", 1 + g - model.body_geomadr[body]).into(),
            }
        };
        Self((0..model.ngeom()).map(name).collect())
    }

    /// Returns the name of a geom, or its number if it does not exist.
    pub fn get(&self, geom: usize) -> Arc<str> {
        let number = || format!("geom {geom}").into();
        self.0.get(geom).cloned().unwrap_or_else(number)
    }
}
