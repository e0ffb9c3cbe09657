//! MIMo at other ages than that of his original proportions, from birth to 24 months.
//!
//! Sizes follow 18 measurements of AnthroKids (1977), fitted over age; masses follow volumes at the density of the original
//! parts, and the strength of a motor or muscle follows the volume of the part that carries it. Joint ranges, stiffness,
//! damping, friction and armature stay those of the original, unless `springs: weight`. With `strength: infant` torques follow ratios to
//! that of gravity (`ratios`, `maturity`), and with `proportions: measured` trunk and legs those of infants (`proportions`). Below one month four of the curves fall steeply, so the
//! proportions of a newborn are the least certain.
//!
//! Source: MIMo's authors, arXiv 2509.09805 (ICDL 2025), and the code of their repository. Their model is MIMo 3, which has a chest; in
//! MIMo 2 the chest's parts belong to the upper body. Its muscles keep their strength at all ages, as here for MIMo 3 under
//! `compat: reference`; otherwise they follow the motors.

mod blame;
mod body;
mod fingers;
mod gravity;
mod landmarks;
mod lengths;
mod maturity;
mod mitten;
mod proportions;
mod ratios;
mod shapes;
mod strength;

use thiserror::Error;

use super::error::SceneError;
use super::sources::SourcedConstant;
use super::third::CHEST;
use super::{EYES, JOINT_PREFIX, ROOT, Version};
use crate::assets::AssetSource;
use crate::config::{Compat, Config, MAX_AGE, SpringModel, StrengthModel};
use crate::math::Vec3;
use crate::mjcf_loader::Draft;
pub(super) use blame::blame;
use lengths::Lengths;
pub use maturity::StrengthRow;
use maturity::{Maturity, without_side};
use proportions::Stretch;
use shapes::{BodyShapes, Side};
use strength::carrier;

/// Half the diameter of an eyeball of the original proportions, m: how far its camera is before its centre.
const EYEBALL: f64 = 0.01125;

/// A reason why a body cannot grow.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GrowthError {
    /// The age is out of range.
    #[error("`{key}`: {age} is not an age that MIMo can have; it must be from 0 to {MAX_AGE} months")]
    Age {
        /// Key of the configuration.
        key: &'static str,
        /// The requested age, months.
        age: f64,
    },
    /// Measurements make an impossible body.
    #[error("{keys}: at {age} months {reason}; change it, or leave it to the age")]
    Measurements {
        /// Keys of the configuration at fault, with their values.
        keys: String,
        /// Age, months.
        age: f64,
        /// Description of the fault.
        reason: String,
    },
    /// The scene lacks a part that grows.
    #[error("the scene's MIMo has no {what}, which `age` would change; its assets are of another MIMo")]
    Missing {
        /// Kind and name of the element.
        what: String,
    },
}

/// The age of a body, in months: that of its proportions, and that of its strength.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    age: f64,
    version: Version,
    /// Whether it is MIMo 3.
    has_chest: bool,
    /// Whether muscles keep their strength.
    same_muscles: bool,
    body: BodyShapes,
    /// The body of the strength's age.
    strong: BodyShapes,
    strength_age: f64,
    camera: f64,
    /// The strength of infants and springs by weight; `None` if neither is asked for.
    maturity: Option<Maturity>,
}

impl Growth {
    /// Returns how a MIMo of some version grows to the `age` of a configuration; `None` if it has none.
    ///
    /// # Errors
    /// An age out of range, measurements that make a part vanish.
    pub fn of(config: &Config, version: Version) -> Result<Option<Self>, GrowthError> {
        let Some(age) = config.age else { return Ok(None) };
        let strength_age = config.strength_age.unwrap_or(age);
        for (key, age) in [("age", age), ("strength_age", strength_age)] {
            if !(0.0..=MAX_AGE).contains(&age) {
                return Err(GrowthError::Age { key, age });
            }
        }
        let base = Lengths::base();
        let has_chest = config.mimo_version == CHEST;
        let now = Lengths::new(age, &config.measurements);
        let grown = |age: f64, config: &Config| {
            let lengths = Lengths::new(age, &config.measurements);
            let stretch = Stretch::of(config.proportions, age, &lengths, &base);
            let shapes = shapes(version, has_chest, &lengths, &base, stretch);
            check(&shapes).map(|()| shapes)
        };
        let made = |age: f64| {
            grown(age, config).map_err(|reason| blame(config, age, reason, |other| grown(age, other).is_ok()))
        };
        let (body, strong) = (made(age)?, made(strength_age)?);
        let camera = match config.compat {
            Compat::Api => EYEBALL * now.head_circumference / base.head_circumference,
            Compat::Reference => EYEBALL, // where it was, outside a newborn's eye
        };
        Ok(Some(Self {
            age,
            version,
            has_chest,
            same_muscles: has_chest && config.compat == Compat::Reference,
            body,
            strong,
            strength_age,
            camera,
            maturity: None,
        }))
    }

    /// Adds the strength of infants and springs by weight, if a configuration asks for them. They follow the weight of the MIMo of `assets`.
    ///
    /// # Errors
    /// Assets that cannot be compiled.
    pub(super) fn mature(mut self, config: &Config, assets: &dyn AssetSource) -> Result<Self, SceneError> {
        if config.strength != StrengthModel::Volume || config.springs != SpringModel::Fixed {
            self.maturity = Some(Maturity::of(config, &self, assets)?);
        }
        Ok(self)
    }

    /// Returns the strength of this age by both settings of `strength`.
    ///
    /// # Errors
    /// Assets that cannot be compiled.
    pub(super) fn strength_rows(
        &self,
        config: &Config,
        assets: &dyn AssetSource,
    ) -> Result<Vec<StrengthRow>, SceneError> {
        Ok(Maturity::of(config, self, assets)?.rows().to_vec())
    }

    /// Returns the age of the proportions, months.
    pub fn age(&self) -> f64 {
        self.age
    }

    /// Gives a document's MIMo, of his original proportions, the sizes, masses and strength of this age.
    ///
    /// # Errors
    /// Parts that the document lacks.
    pub fn apply(&self, draft: &mut Draft) -> Result<(), GrowthError> {
        self.strengthen(draft)?; // first, as it needs the original volumes
        self.resize(&self.body, draft)
    }

    /// Gives a document's MIMo the sizes, masses and places of a body.
    fn resize(&self, body: &BodyShapes, draft: &mut Draft) -> Result<(), GrowthError> {
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

    /// Gives actuators and joints the strength of the age.
    fn strengthen(&self, draft: &mut Draft) -> Result<(), GrowthError> {
        let own = draft.joints_below(ROOT);
        if let Some(maturity) = &self.maturity {
            maturity.apply(draft, &own);
        }
        let ratios = self.volume_ratios(draft)?;
        let infant = self.maturity.as_ref().is_some_and(Maturity::has_strength);
        for actuator in draft
            .actuators()
            .filter(|actuator| own.iter().any(|joint| joint == actuator.joint))
        {
            // the eyes, whose muscles carry no weight, follow their volume in any case
            if infant && ratios::rule(without_side(actuator.name)).is_some() {
                continue;
            }
            let Some(ratio) = self.volume_ratio(&ratios, actuator.name) else {
                continue;
            };
            *actuator.gear *= ratio;
            if !self.has_chest {
                *actuator.gear *= strength::share(actuator.name, self.version);
            }
            if self.same_muscles {
                continue;
            }
            // VMAX, the velocity of the muscles, stays; FMAX of the negative and of the positive muscle follow
            actuator.user.iter_mut().skip(1).for_each(|fmax| *fmax *= ratio);
        }
        Ok(())
    }

    /// Returns the ratios of the volumes of the geoms of the strength's age to those of a document's original MIMo, each with its body and
    /// its index among the geoms of that body.
    fn volume_ratios(&self, draft: &mut Draft) -> Result<Vec<(String, usize, f64)>, GrowthError> {
        let mut ratios = Vec::new();
        for geom in &self.strong.geoms {
            for (body, _) in sides(geom.side, geom.body) {
                let found = draft.geom(&body, geom.index);
                let grown = found.ok_or_else(|| missing_geom(&body, geom.index))?;
                let (volume, old) = (grown.volume(), *grown.size);
                *grown.size = geom.size;
                ratios.push((body, geom.index, grown.volume() / volume));
                // only measured: the strength may be of another age than the body
                *grown.size = old;
            }
        }
        Ok(ratios)
    }

    /// Returns the ratio of the volume of the part that carries an actuator; `None` for actuators that are not MIMo's.
    fn volume_ratio(&self, ratios: &[(String, usize, f64)], actuator: &str) -> Option<f64> {
        let (body, index) = carrier(actuator, self.version)?;
        let found = ratios.iter().find(|(b, i, _)| *b == body && *i == index);
        found.map(|(.., ratio)| *ratio)
    }
}

/// Lists the constants of strength and proportions.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let mut all = maturity::constants();
    all.extend(proportions::constants());
    all
}

/// Returns the sizes and positions of a version of MIMo with given lengths.
fn shapes(version: Version, has_chest: bool, now: &Lengths, base: &Lengths, stretch: Stretch) -> BodyShapes {
    let mut out = BodyShapes::default();
    let foot = body::foot(now, base);
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

/// Checks that every geom has a size; otherwise says which has none.
fn check(shapes: &BodyShapes) -> Result<(), String> {
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
fn sides(side: Side, name: &str) -> impl Iterator<Item = (String, bool)> {
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

fn missing(what: String) -> GrowthError {
    GrowthError::Missing { what }
}

fn missing_geom(body: &str, index: usize) -> GrowthError {
    missing(format!("geom {index} of the body {body:?}"))
}
