//! Sizes, masses and positions of the parts of a grown body.

use super::error::{GrowthError, missing, missing_geom};
use super::lengths::Lengths;
use super::proportions::Stretch;
use super::shapes::{BodyShapes, Side};
use super::strength::carrier;
use super::{body, fingers, landmarks, leg_lengths, mitten};
use crate::math::Vec3;
use crate::mimo::{EYES, JOINT_PREFIX, Version};
use crate::mjcf_loader::Draft;

/// The sizes of a body, and those of the body whose strength it has.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sizes {
    pub version: Version,
    pub body: BodyShapes,
    /// The body of the strength's age.
    pub strong: BodyShapes,
    /// Distance of the cameras from the centres of the eyes, m.
    pub camera: f64,
}

impl Sizes {
    /// Sets the sizes, masses and positions of a body for a document's MIMo.
    pub fn resize(&self, body: &BodyShapes, draft: &mut Draft) -> Result<(), GrowthError> {
        for geom in &body.geoms {
            for (body, _) in sides(geom.side, geom.body) {
                let found = draft.geom(&body, geom.index);
                let grown = found.ok_or_else(|| missing_geom(&body, geom.index))?;
                let volume = grown.volume();
                (*grown.size, *grown.pos) = (geom.size, geom.pos);
                // the density stays
                *grown.mass = grown.mass.map(|mass| grown.volume() * (mass / volume));
            }
        }
        let placed = |found: Option<&mut Vec3>, kind: &str, name: &str, pos: Vec3| match found {
            Some(old) => {
                *old = pos;
                Ok(())
            }
            None => Err(missing(format!("{kind} {name:?}"))),
        };
        for place in &body.bodies {
            for (name, mirrored) in sides(place.side, place.name) {
                placed(draft.body_pos(&name), "body", &name, mirror(place.pos, mirrored))?;
            }
        }
        for place in &body.joints {
            for (name, mirrored) in sides(place.side, place.name) {
                let name = format!("{JOINT_PREFIX}{name}");
                placed(draft.joint_pos(&name), "joint", &name, mirror(place.pos, mirrored))?;
            }
        }
        for place in &body.sites {
            placed(draft.site_pos(place.name), "site", place.name, place.pos)?;
        }
        for name in EYES {
            placed(draft.camera_pos(name), "camera", name, [self.camera, 0.0, 0.0])?;
        }
        Ok(())
    }

    /// Returns the ratios of the volumes of the geoms of the strength's age to those of a document's original MIMo, each with its body and
    /// its index among the geoms of that body.
    pub fn volume_ratios(&self, draft: &mut Draft) -> Result<Vec<(String, usize, f64)>, GrowthError> {
        let mut ratios = Vec::new();
        for geom in &self.strong.geoms {
            for (body, _) in sides(geom.side, geom.body) {
                let found = draft.geom(&body, geom.index);
                let grown = found.ok_or_else(|| missing_geom(&body, geom.index))?;
                let (volume, old) = (grown.volume(), *grown.size);
                *grown.size = geom.size;
                ratios.push((body, geom.index, grown.volume() / volume));
                // only measured: strength and body may be of different ages
                *grown.size = old;
            }
        }
        Ok(ratios)
    }

    /// Returns the ratio of the volume of the part that carries an actuator; `None` for actuators that are not MIMo's.
    pub fn volume_ratio(&self, ratios: &[(String, usize, f64)], actuator: &str) -> Option<f64> {
        let (body, index) = carrier(actuator, self.version)?;
        let found = ratios.iter().find(|(b, i, _)| *b == body && *i == index);
        found.map(|(.., ratio)| *ratio)
    }
}

/// Returns the sizes and positions of a version of MIMo with given lengths.
pub(super) fn shapes(version: Version, has_chest: bool, now: &Lengths, base: &Lengths, stretch: Stretch) -> BodyShapes {
    let mut out = BodyShapes::default();
    let foot = leg_lengths::foot(now, base);
    body::trunk(now, base, has_chest, stretch, &mut out);
    body::head(now, base, &mut out);
    let forearm = body::arms(now, base, has_chest, stretch, &mut out);
    body::legs(now, base, &foot, stretch, &mut out);
    match version {
        Version::V1 => {
            mitten::hands(now, base, forearm, &mut out);
            mitten::toes(now, &foot, &mut out);
            if has_chest {
                landmarks::add(now, base, &foot, &mut out);
            }
        }
        Version::V2 => {
            fingers::hands(now, base, forearm, &mut out);
            fingers::toes(now, base, &foot, &mut out);
        }
    }
    out
}

/// Checks that every geom has a size; the error names the geom without one.
pub(super) fn check(shapes: &BodyShapes) -> Result<(), String> {
    for geom in &shapes.geoms {
        let gone = |s: &f64| !(s.is_finite() && *s >= 0.0);
        let axis = geom.size.iter().position(gone).or((geom.size[0] == 0.0).then_some(0));
        if let Some(axis) = axis {
            let body = sides(geom.side, geom.body)
                .next()
                .map(|(name, _)| name)
                .unwrap_or_default();
            let (index, size) = (geom.index, geom.size[axis]);
            return Err(format!(
                "geom {index} of the body {body:?} would vanish: its size {axis} is {size:.4} m"
            ));
        }
    }
    Ok(())
}

/// Returns the names of a part, and whether each is the mirror image.
pub(super) fn sides(side: Side, name: &str) -> impl Iterator<Item = (String, bool)> {
    let names = match side {
        Side::Middle => [Some((name.to_string(), false)), None],
        Side::Both => [
            Some((format!("left_{name}"), false)),
            Some((format!("right_{name}"), true)),
        ],
    };
    names.into_iter().flatten()
}

/// Returns the mirror image of a position, on the other side.
fn mirror(pos: Vec3, mirrored: bool) -> Vec3 {
    if mirrored { [pos[0], -pos[1], pos[2]] } else { pos }
}
