//! MIMo at ages from birth to 24 months, with other than his original proportions.
//!
//! Sizes follow 18 measurements of AnthroKids (1977), fitted over age; masses follow volumes at the density of the original
//! parts, and the strength of a motor or muscle follows the volume of the part that carries it. Joint ranges, stiffness,
//! damping, friction and armature stay those of the original, unless `springs: weight`. With `strength: infant` torques follow ratios to
//! that of gravity (`ratios`, `maturity`), and with `proportions: measured` trunk and legs those of infants (`proportions`). Below one month four of the curves fall steeply, so the
//! proportions of a newborn are the least certain.
//!
//! An individual has the length, weight and head circumference of his z-scores (`builder`, `fit`): his head has its own factor, and two factors, on
//! lengths and on girths, follow from length and weight.
//!
//! Source: MIMo's authors, arXiv 2509.09805 (ICDL 2025), and the code of their repository. Their model is MIMo 3, which has a chest; in
//! MIMo 2 the chest's parts belong to the upper body. Its muscles keep their strength at all ages, as here for MIMo 3 under
//! `compat: reference`; otherwise they follow the motors.

mod blame;
mod body;
mod builder;
mod error;
mod fingers;
mod fit;
mod gravity;
mod landmarks;
mod leg_lengths;
mod lengths;
mod maturity;
mod mitten;
mod proportions;
mod ratios;
mod shapes;
mod sizes;
mod strength;

use super::error::SceneError;
use super::preterm::Development;
use super::sources::SourcedConstant;
use super::third::CHEST;
use super::{ROOT, Version};
use crate::assets::AssetSource;
use crate::config::{Compat, Config, MAX_AGE, SpringModel, StrengthModel};
use crate::mjcf_loader::Draft;
pub(super) use blame::blame;
use builder::BodyBuilder;
pub use error::GrowthError;
use lengths::Lengths;
pub use maturity::StrengthRow;
use maturity::{Maturity, without_side};
use sizes::Sizes;

/// Radius of an eyeball of the original proportions, m, which is the distance of its camera from its centre.
const EYEBALL: f64 = 0.01125;

/// The age of a body, in months: that of its proportions, and that of its strength.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    age: f64,
    sizes: Sizes,
    /// Whether it is MIMo 3.
    has_chest: bool,
    /// Whether servos get their strength from their gears, which also scales their angles, as in the authors' code.
    gears_of_servos: bool,
    /// Whether muscles keep their strength.
    same_muscles: bool,
    /// The age of the strength, months, corrected as that of the body.
    strength_age: f64,
    /// The strength of infants and springs by weight; `None` if the configuration requests neither.
    maturity: Option<Maturity>,
}

impl Growth {
    /// Returns how a version of MIMo grows to the `age` of a configuration; `None` without an age. `assets` have the masses of his parts, by
    /// which an individual gets his weight.
    ///
    /// # Errors
    /// An age out of range, measurements or z-scores that make a part vanish.
    pub fn of(config: &Config, version: Version, assets: &dyn AssetSource) -> Result<Option<Self>, SceneError> {
        let Some(age) = config.age else { return Ok(None) };
        let strength_age = config.strength_age.unwrap_or(age);
        for (key, age) in [("age", age), ("strength_age", strength_age)] {
            if !(0.0..=MAX_AGE).contains(&age) {
                return Err(GrowthError::Age { key, age }.into());
            }
        }
        let has_chest = config.mimo_version == CHEST;
        let builder = BodyBuilder::new(config, version, has_chest, assets)?;
        let developed = Development::of(config, "age", age)?;
        let strengthened = Development::of(config, "strength_age", strength_age)?;
        let body = builder.body(config, age, &developed)?;
        let strong = builder.body(config, strength_age, &strengthened)?;
        let camera = match config.compat {
            Compat::Api => EYEBALL * body.lengths.head_circumference / builder.base.head_circumference,
            Compat::Reference => EYEBALL, // where it was, outside a newborn's eye
        };
        Ok(Some(Self {
            age,
            sizes: Sizes {
                version,
                body: body.shapes,
                strong: strong.shapes,
                camera,
            },
            has_chest,
            gears_of_servos: config.compat == Compat::Reference,
            same_muscles: has_chest && config.compat == Compat::Reference,
            strength_age: strengthened.months,
            maturity: None,
        }))
    }

    /// Adds the strength of infants and springs by weight, if a configuration requests them. They follow the weight of the MIMo of `assets`.
    ///
    /// # Errors
    /// Assets that cannot be compiled.
    pub(super) fn mature(mut self, config: &Config, assets: &dyn AssetSource) -> Result<Self, SceneError> {
        if config.strength != StrengthModel::Volume || config.springs != SpringModel::Fixed {
            self.maturity = Some(Maturity::of(config, self.strength_age, &self.sizes, assets)?);
        }
        Ok(self)
    }

    /// Returns the strength of this age under both settings of `strength`.
    ///
    /// # Errors
    /// Assets that cannot be compiled.
    pub(super) fn strength_rows(
        &self,
        config: &Config,
        assets: &dyn AssetSource,
    ) -> Result<Vec<StrengthRow>, SceneError> {
        Ok(Maturity::of(config, self.strength_age, &self.sizes, assets)?
            .rows()
            .to_vec())
    }

    /// Returns the age of the proportions, months.
    pub fn age(&self) -> f64 {
        self.age
    }

    /// Sets the sizes, masses and strength of this age for a document's MIMo with his original proportions.
    ///
    /// # Errors
    /// Parts that the document lacks.
    pub fn apply(&self, draft: &mut Draft) -> Result<(), GrowthError> {
        self.strengthen(draft)?; // first, because it needs the original volumes
        self.sizes.resize(&self.sizes.body, draft)
    }

    /// Sets the strength of actuators and joints to that of the age.
    fn strengthen(&self, draft: &mut Draft) -> Result<(), GrowthError> {
        let own = draft.joints_below(ROOT);
        if let Some(maturity) = &self.maturity {
            maturity.apply(draft, &own);
        }
        let ratios = self.sizes.volume_ratios(draft)?;
        let infant = self.maturity.as_ref().is_some_and(Maturity::has_strength);
        for mut actuator in draft
            .actuators()
            .filter(|actuator| own.iter().any(|joint| joint == actuator.joint))
        {
            // the eyes, whose muscles carry no weight, follow their volume in any case
            if infant && ratios::rule(without_side(actuator.name)).is_some() {
                continue;
            }
            let Some(ratio) = self.sizes.volume_ratio(&ratios, actuator.name) else {
                continue;
            };
            let share = if self.has_chest {
                1.0
            } else {
                strength::share(actuator.name, self.sizes.version)
            };
            if self.gears_of_servos {
                *actuator.gear *= ratio;
                *actuator.gear *= share;
            } else {
                actuator.strengthen(ratio);
                actuator.strengthen(share);
            }
            if self.same_muscles {
                continue;
            }
            // VMAX, the velocity of the muscles, stays; FMAX of the negative and of the positive muscle follow
            actuator.user.iter_mut().skip(1).for_each(|fmax| *fmax *= ratio);
        }
        Ok(())
    }
}

/// Returns the head circumference, cm, of a head whose geom has this radius, m.
pub(super) fn head_circumference(radius: f64) -> f64 {
    Lengths::head_circumference_of(radius)
}

/// Lists the constants of strength and proportions.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let mut all = maturity::constants();
    all.extend(proportions::constants());
    all
}
