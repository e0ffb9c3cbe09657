//! Where a body lies among infants of its age.

use super::{BodyFigures, GrowthError, GrowthStandard};
use crate::config::Config;
use crate::model::Model;

/// The z-scores of a body by a standard of growth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyScores {
    /// The standard.
    pub standard: GrowthStandard,
    /// The z-score of the length.
    pub length: f64,
    /// The z-score of the weight.
    pub weight: f64,
    /// The z-score of the head circumference.
    pub head: f64,
}

impl BodyScores {
    /// Returns the z-scores of a model's MIMo among infants of his sex, or among boys and among girls; none without an age.
    ///
    /// ```
    /// use babybench::config::Sex;
    /// use babybench::mimo::BodyScores;
    /// use babybench::{Blueprint, Config};
    ///
    /// let mut config = Config { age: Some(6.0), touch_active: false, vision_active: false, ..Config::default() };
    /// (config.individual.sex, config.individual.weight_z) = (Sex::Girl, Some(1.5));
    /// let blueprint = Blueprint::new(config)?;
    /// let girls = BodyScores::of(blueprint.model(), blueprint.config())?[0];
    /// assert!((girls.weight - 1.5).abs() < 1e-6 && girls.length.abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// An age that no standard covers.
    pub fn of(model: &Model, config: &Config) -> Result<Vec<Self>, GrowthError> {
        let (figures, head) = (BodyFigures::of(model), BodyFigures::head_circumference(model));
        let (Some(figures), Some(head)) = (figures, head) else {
            return Ok(Vec::new());
        };
        let standards = GrowthStandard::of_config(config)?;
        let scores = standards.into_iter().map(|standard| Self {
            standard,
            length: standard.length.z(100.0 * figures.stature),
            weight: standard.weight.z(figures.mass),
            head: standard.head.z(100.0 * head),
        });
        Ok(scores.collect())
    }
}
