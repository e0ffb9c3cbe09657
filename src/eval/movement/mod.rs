//! Measures of spontaneous movement from records: spectra of the limbs' velocities, movements and their timing, coupling of joints,
//! variety, laterality, and the order of segments in a roll.
//!
//! What a camera sees of infants depends on its frame rate and its errors, and an exponent of a spectrum on the band in which it is
//! fitted. So [`MovementOptions`] has all of them, and the results repeat them. The guide has each formula (`docs/guide/movement.md`).

mod coupling;
mod filmed;
mod kicks;
mod paths;
mod rolling;
mod spectrum;
mod table;
mod variety;

use std::collections::BTreeMap;

use paths::BodyPaths;
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use table::{MOVEMENT_MEASURES, MeasureDescription};

use crate::json;
use crate::math::Vec3;
use crate::runs::{Record, RecordError};

/// The ends of the limbs, in the order of all arrays of four.
const LIMBS: [&str; 4] = ["right_hand", "left_hand", "right_foot", "left_foot"];

/// The frame in which limbs move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MovementFrame {
    /// The world: what a fixed camera sees.
    #[default]
    World,
    /// The hip, without the movement of the trunk.
    Hip,
}

impl MovementFrame {
    /// All frames.
    pub const ALL: [Self; 2] = [Self::World, Self::Hip];

    /// Returns the frame of a name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|frame| frame.name() == name)
    }

    /// Returns its name in options and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Hip => "hip",
        }
    }
}

/// The way in which movements are observed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct MovementOptions {
    /// Frames a second, Hz.
    pub fps: f64,
    /// Band in which exponents are fitted, Hz.
    pub band: [f64; 2],
    /// Frames of a window of the spectrum, a power of two; shorter records take the largest one that fits.
    pub window: usize,
    /// Standard deviation of the error of each coordinate in each frame, mm.
    pub jitter: f64,
    /// Seed of these errors.
    pub seed: u64,
    /// The frame in which limbs move.
    pub frame: MovementFrame,
}

impl Default for MovementOptions {
    fn default() -> Self {
        Self {
            fps: 25.0,
            band: [0.1, 5.0],
            window: 1024,
            jitter: 0.0,
            seed: 0,
            frame: MovementFrame::World,
        }
    }
}

/// The highest frame rate, Hz, and the longest window, frames, so that a typing error does not take hours.
const MOST: [f64; 2] = [10_000.0, 1_048_576.0];

impl MovementOptions {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number outside its range.
    pub fn check(&self) -> Result<(), MovementError> {
        let wrong =
            |what: &'static str, value: String, expected: &'static str| MovementError::Option { what, value, expected };
        if !(self.fps > 0.0 && self.fps <= MOST[0]) {
            return Err(wrong(
                "fps",
                self.fps.to_string(),
                "a number of frames a second, above 0 and up to 10000",
            ));
        }
        let [low, high] = self.band;
        if !(low > 0.0 && high > low && high <= 0.5 * self.fps) {
            let found = format!("{low},{high}");
            return Err(wrong(
                "band",
                found,
                "two frequencies above 0, the lower one first, up to half of fps",
            ));
        }
        if !self.window.is_power_of_two() || self.window < 16 || self.window as f64 > MOST[1] {
            return Err(wrong(
                "window",
                self.window.to_string(),
                "a power of two from 16 to 1048576",
            ));
        }
        if !(self.jitter >= 0.0 && self.jitter.is_finite()) {
            return Err(wrong("jitter", self.jitter.to_string(), "a length of at least 0 mm"));
        }
        Ok(())
    }
}

/// An error in measuring movements.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MovementError {
    /// An option is outside its range.
    #[error("{what} is {value}, expected {expected}")]
    Option {
        /// The name of the option.
        what: &'static str,
        /// Its value.
        value: String,
        /// The accepted values.
        expected: &'static str,
    },
    /// The record cannot be read, or its scene cannot be made.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Measures of the movements in an episode, or the means of several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Movement {
    /// Number of episodes.
    pub episodes: u64,
    /// Simulated time, of all episodes, s.
    pub seconds: f64,
    /// The way in which they were observed; the window is the one that was used.
    pub options: MovementOptions,
    /// The measures by name, in the units that [`MOVEMENT_MEASURES`] has. Those that are undefined, such as the exponent of a limb at
    /// rest, are left out.
    pub values: BTreeMap<String, f64>,
    /// The segment that turned first, by episode, for those in which MIMo rolled over.
    pub leading: Vec<String>,
}

impl Movement {
    /// Measures an episode of a record.
    ///
    /// # Errors
    /// An option outside its range; an episode that does not exist; an archive that cannot be read or does not match its description.
    pub fn of_episode(record: &Record, episode: u64, options: &MovementOptions) -> Result<Self, MovementError> {
        options.check()?;
        Ok(Self::of_paths(&BodyPaths::of_episode(record, episode)?, options))
    }

    /// Measures all episodes of a record, one after another.
    ///
    /// # Errors
    /// As [`Movement::of_episode`].
    pub fn of_record(record: &Record, options: &MovementOptions) -> Result<Vec<Self>, MovementError> {
        let episodes = record.manifest().episodes.iter();
        episodes
            .map(|episode| Self::of_episode(record, episode.episode, options))
            .collect()
    }

    /// Returns the means of the measures of episodes, each weighted by its time, over those that have it; `None` without time.
    pub fn mean(all: &[Self]) -> Option<Self> {
        let first = all.iter().find(|m| m.seconds > 0.0)?;
        let mut sums: BTreeMap<String, [f64; 2]> = BTreeMap::new();
        for m in all {
            for (name, value) in &m.values {
                let [sum, time] = sums.entry(name.clone()).or_default();
                *sum += m.seconds * value;
                *time += m.seconds;
            }
        }
        Some(Self {
            episodes: all.iter().map(|m| m.episodes).sum(),
            seconds: all.iter().map(|m| m.seconds).sum(),
            options: first.options,
            values: sums
                .into_iter()
                .filter(|(_, [_, time])| *time > 0.0)
                .map(|(name, [sum, time])| (name, sum / time))
                .collect(),
            leading: all.iter().flat_map(|m| m.leading.clone()).collect(),
        })
    }

    /// Returns the measures as a line of JSON.
    pub fn to_json(&self) -> String {
        json::text(self)
    }

    fn of_paths(body: &BodyPaths, options: &MovementOptions) -> Self {
        let mut values = Values::default();
        let window = spectrum::measure(body, options, &mut values);
        kicks::measure(body, &mut values);
        coupling::measure(body, &mut values);
        variety::measure(body, options, &mut values);
        let leading = rolling::measure(body, &mut values);
        Self {
            episodes: 1,
            seconds: body.len() as f64 * body.dt,
            options: MovementOptions { window, ..*options },
            values: values.0,
            leading: leading.into_iter().collect(),
        }
    }
}

/// Measures during collection.
#[derive(Debug, Default)]
struct Values(BTreeMap<String, f64>);

impl Values {
    /// Keeps a measure, unless it is undefined.
    fn put(&mut self, name: impl Into<String>, value: impl Into<Option<f64>>) {
        if let Some(value) = value.into().filter(|value| value.is_finite()) {
            self.0.insert(name.into(), value);
        }
    }
}

/// Returns the mean; `None` if there are no values.
fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (n, sum) = values.into_iter().fold((0_usize, 0.0), |(n, sum), v| (n + 1, sum + v));
    (n > 0).then(|| sum / n as f64)
}

/// Returns the velocities between positions that are `dt` apart.
fn velocities(path: &[Vec3], dt: f64) -> Vec<Vec3> {
    path.windows(2)
        .map(|w| std::array::from_fn(|k| (w[1][k] - w[0][k]) / dt))
        .collect()
}
