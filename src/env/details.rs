//! What the information of a step tells beyond the keys of the reference.

use std::fmt::Write as _;
use std::sync::Arc;

use crate::env::BehaviorInfo;
use crate::model::Model;

/// Additions to the reference's information. The pickles of logs leave them out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Details {
    /// Names of the parts that the right and the left palm have touched, in the order of the lists of geoms, if the
    /// behavior is `self_touch`; see [`PartNames`].
    pub touched_parts: Option<[Vec<Arc<str>>; 2]>,
    /// How far each hand is off the axis of each eye, rad, in the order of [`BehaviorInfo::REGARDS`], if the behavior is
    /// `hand_regard`. Less than 15 degrees count. None right after a reset or a restored snapshot.
    pub gaze_angles: Option<[f64; 4]>,
}

impl Details {
    /// The touched parts of a record by name.
    pub(crate) fn of(behavior: &BehaviorInfo, names: &PartNames) -> Self {
        let mut details = Self::default();
        details.name_parts(behavior, names);
        details
    }

    /// Room for the names of all parts, so that no step allocates.
    pub(crate) fn reserve(&mut self, behavior: &BehaviorInfo, names: &PartNames) {
        let room = || Vec::with_capacity(names.0.len());
        self.touched_parts = behavior.touches().map(|_| [room(), room()]);
        self.gaze_angles = None;
    }

    /// Forgets everything, but keeps the room.
    pub(crate) fn clear(&mut self) {
        self.touched_parts.iter_mut().flatten().for_each(Vec::clear);
        self.gaze_angles = None;
    }

    /// Brings the names up to date with the lists of geoms, which have grown or been cleared.
    pub(crate) fn name_parts(&mut self, behavior: &BehaviorInfo, names: &PartNames) {
        let Some(touches) = behavior.touches() else {
            self.touched_parts = None;
            return;
        };
        let parts = self.touched_parts.get_or_insert_default();
        for (parts, geoms) in parts.iter_mut().zip(touches) {
            parts.truncate(geoms.len());
            let known = parts.len();
            parts.extend(geoms[known..].iter().map(|&g| names.get(g)));
        }
    }

    /// Members of a JSON object, each followed by a comma and a space.
    pub(crate) fn write_json(&self, json: &mut String) {
        // writing to a string cannot fail
        if let Some([right, left]) = &self.touched_parts {
            let _ = write!(json, "\"right_hand_parts\": {right:?}, \"left_hand_parts\": {left:?}, ");
        }
        if let Some(angles) = &self.gaze_angles {
            json.push_str("\"gaze_angles\": {");
            for (k, (name, angle)) in BehaviorInfo::REGARDS.iter().zip(angles).enumerate() {
                let comma = if k > 0 { ", " } else { "" };
                let _ = write!(json, "{comma}\"{name}\": {angle:?}");
            }
            json.push_str("}, ");
        }
    }
}

/// Names of MIMo's geoms as parts of the body: the name of the body, with the number of the geom among the body's if there
/// are several, as in `right_foot 2/3`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartNames(Arc<[Arc<str>]>);

impl PartNames {
    /// Of all geoms of a scene.
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

    /// Name of a geom; one that does not exist has its number.
    pub fn get(&self, geom: usize) -> Arc<str> {
        let number = || format!("geom {geom}").into();
        self.0.get(geom).cloned().unwrap_or_else(number)
    }
}
