//! Touches of what is not MIMo's, beside those of his body.

use std::collections::BTreeSet;

use super::ratio;
use super::touches::{TouchBouts, TouchSteps};
use crate::runs::{Record, RecordError};

/// What the hands of an episode touched besides the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Touches of other things by either hand, per minute.
    pub per_minute: f64,
    /// Share of the time in which a hand touches nothing, mean of both hands.
    pub free: f64,
    /// Bodies of MIMo that either hand touched.
    pub bodies: BTreeSet<String>,
}

impl Surroundings {
    /// Reads the contacts of an episode.
    ///
    /// # Errors
    /// An episode that does not exist, or an archive that cannot be read or does not match its description.
    pub fn of_episode(record: &Record, episode: u64) -> Result<Self, RecordError> {
        let manifest = record.manifest();
        let steps = TouchSteps::read(&record.npz(episode)?, manifest)?.ok_or_else(|| RecordError::Unfit {
            path: record.dir().join(format!("episode_{episode}.npz")),
            reason: "its contacts do not match its description".to_string(),
        })?;
        let (mut number, mut free) = (0, 0);
        for hand in [0, 1] {
            let outside = steps.outside(hand);
            number += TouchBouts::of(&outside, manifest.dt).number;
            let body = steps.any(hand);
            free += outside
                .iter()
                .zip(&body)
                .filter(|(outside, body)| !**outside && !**body)
                .count();
        }
        Ok(Self {
            per_minute: ratio(60.0 * number as f64, steps.len() as f64 * manifest.dt),
            free: ratio(0.5 * free as f64, steps.len() as f64),
            bodies: steps.bodies,
        })
    }
}
