//! The shapes of a body, by the formulas of its age and by what distinguishes an infant.

use super::blame::blame;
use super::error::GrowthError;
use super::fit::{PartMasses, Target, fit};
use super::lengths::{Factors, Lengths};
use super::maturity::bare_scene;
use super::proportions::Stretch;
use super::shapes::BodyShapes;
use super::sizes::{check, shapes};
use crate::assets::AssetSource;
use crate::config::Config;
use crate::mimo::document::DOCUMENT;
use crate::mimo::error::SceneError;
use crate::mimo::preterm::Development;
use crate::mimo::{Individual, Version};
use crate::mjcf_loader::Draft;

/// The lengths of a body and the shapes made of them.
pub(super) struct GrownBody {
    pub lengths: Lengths,
    pub shapes: BodyShapes,
}

/// A builder of bodies of a version of MIMo.
pub(super) struct BodyBuilder {
    version: Version,
    has_chest: bool,
    pub base: Lengths,
    /// The masses of the parts, for bodies of a given weight.
    masses: Option<PartMasses>,
}

impl BodyBuilder {
    /// Creates the builder of a configuration's bodies. `assets` have the masses of MIMo's parts.
    ///
    /// # Errors
    /// Assets that cannot be read, if the configuration describes an individual.
    pub fn new(
        config: &Config,
        version: Version,
        has_chest: bool,
        assets: &dyn AssetSource,
    ) -> Result<Self, SceneError> {
        let mut builder = Self {
            version,
            has_chest,
            base: Lengths::base(),
            masses: None,
        };
        if Individual::of(config).is_some() {
            let original = builder.make(config, 0.0, &builder.base, &Factors::NONE).shapes;
            let mut draft = Draft::read_str(&bare_scene(version), DOCUMENT, assets)?;
            builder.masses = Some(PartMasses::read(&original, &mut draft)?);
        }
        Ok(builder)
    }

    /// Builds the body of a development.
    ///
    /// # Errors
    /// The keys of a body that cannot be built, with the reason.
    pub fn body(&self, config: &Config, age: f64, development: &Development) -> Result<GrownBody, GrowthError> {
        let works = |other: &Config| self.grown(other, development).is_ok();
        self.grown(config, development)
            .map_err(|reason| blame(config, age, reason, works))
    }

    /// Builds a body, or returns why it cannot be built.
    fn grown(&self, config: &Config, development: &Development) -> Result<GrownBody, String> {
        let given = &config.measurements;
        let plain = Lengths::new(development.months, given);
        let (Some(infant), Some(masses)) = (Individual::of(config), &self.masses) else {
            let body = self.make(config, development.months, &plain, &Factors::NONE);
            return check(&body.shapes).map(|()| body);
        };
        let described = |reason: String| {
            let Individual {
                sex,
                length_z,
                weight_z,
                head_z,
            } = infant;
            format!(
                "the {sex} has z-scores {length_z:.2} of length, {weight_z:.2} of weight and {head_z:.2} of head, and {reason}"
            )
        };
        let mut standards = development.standards.iter();
        let standard = standards.find(|standard| standard.is_of(infant.sex));
        let standard = standard.ok_or_else(|| described("there is no standard".to_string()))?;
        let head = match given.head_circumference {
            Some(_) => 1.0,
            None => Lengths::head(standard.head.value(infant.head_z)) / plain.head_circumference,
        };
        let start = Factors { head, ..Factors::NONE };
        let target = Target {
            length: standard.length.value(infant.length_z) / 100.0,
            weight: standard.weight.value(infant.weight_z),
        };
        let make = |factors: &Factors| {
            let lengths = plain.scaled(given, factors);
            self.make(config, development.months, &lengths, factors)
        };
        let factors = fit(target, masses, start, |factors| make(factors).shapes).ok_or_else(|| {
            let Target { length, weight } = target;
            described(format!(
                "no body with the given measurements is {length:.3} m long and weighs {weight:.2} kg"
            ))
        })?;
        let body = make(&factors);
        check(&body.shapes).map_err(described)?;
        Ok(body)
    }

    /// Makes a body of given lengths, whose trunk is as high as the factors say.
    fn make(&self, config: &Config, months: f64, lengths: &Lengths, factors: &Factors) -> GrownBody {
        let trunk = factors.trunk(&config.measurements);
        let stretch = Stretch::of(config.proportions, months, lengths, &self.base, trunk);
        let shapes = shapes(self.version, self.has_chest, lengths, &self.base, stretch);
        GrownBody {
            lengths: *lengths,
            shapes,
        }
    }
}
