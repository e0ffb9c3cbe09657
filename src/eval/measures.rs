//! Measures of behavior, computed from records: contacts of the hands, their number and duration, smoothness and symmetry of movements.
//! The guide defines each by a formula (`docs/guide/benchmark.md`).

mod movement;
mod regards;
mod surroundings;
mod touches;

use std::collections::BTreeMap;

use movement::{smoothness, symmetry};
use serde::{Deserialize, Serialize};
pub(super) use surroundings::Surroundings;
use touches::{TouchBouts, TouchSteps};

use crate::env::PerEyeAndHand;
use crate::formats::npz::{Npz, NpzError};
use crate::json;
use crate::runs::{Manifest, Record, RecordError};

/// The measures of an episode, or the means of several.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Measures {
    /// Number of episodes.
    pub episodes: u64,
    /// Number of steps, of all episodes.
    pub steps: u64,
    /// Simulated time, of all episodes, s.
    pub seconds: f64,
    /// Parts that both palms touch in an episode, counted separately for each palm.
    pub parts_per_episode: Option<f64>,
    /// Touches of the right hand.
    pub right_hand: HandMeasures,
    /// Touches of the left hand.
    pub left_hand: HandMeasures,
    /// Share of the time in which the hands touch each other.
    pub hand_to_hand: f64,
    /// Share of the time in which at least one hand touches the body, so both the hand and the body feel it.
    pub double_touch: f64,
    /// Difference of touches of the right and the left hand, over their sum; 0 without touches.
    pub handedness: f64,
    /// Smoothness of the movements: minus the logarithm of dimensionless jerk, mean over the joints that move. Greater is smoother.
    pub smoothness: Option<f64>,
    /// Symmetry of the movements of right and left limbs: 1 for mirror images, 0 for independence, -1 for opposites.
    pub symmetry: Option<f64>,
    /// Share of the time in which each eye has each hand in view, by the counters of the information, for the behavior `hand_regard`.
    pub regards: Option<PerEyeAndHand<f64>>,
    /// Share of the recorded images in which pixels of a hand lie within 15 degrees of the axis of an eye, if segmentation was recorded.
    pub hands_seen: Option<PerEyeAndHand<f64>>,
}

/// Touches of MIMo's own body by a hand with its fingers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct HandMeasures {
    /// Touches, all regions together, per minute.
    pub per_minute: f64,
    /// Mean duration of a touch, s; 0 without touches.
    pub duration: f64,
    /// Share of the time in which the hand touches the body.
    pub share: f64,
    /// The same by region and side of the touched part: `head`, `trunk`, `own arm`, `other leg`, ...
    pub regions: BTreeMap<String, RegionMeasures>,
}

/// Touches of a region by a hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RegionMeasures {
    /// Touches per minute.
    pub per_minute: f64,
    /// Mean duration of a touch, s.
    pub duration: f64,
    /// Share of the time.
    pub share: f64,
}

impl Measures {
    /// Computes the measures of an episode of a record.
    ///
    /// # Errors
    /// An episode that does not exist, or an archive that cannot be read or does not match its description.
    pub fn of_episode(record: &Record, episode: u64) -> Result<Self, RecordError> {
        let npz = record.npz(episode)?;
        let unfit = |reason: &str| RecordError::Unfit {
            path: record.dir().join(format!("episode_{episode}.npz")),
            reason: reason.to_string(),
        };
        let manifest = record.manifest();
        let steps =
            TouchSteps::read(&npz, manifest)?.ok_or_else(|| unfit("its contacts do not match its description"))?;
        let velocity = npz.get_f64("qvel")?;
        let (dt, t) = (manifest.dt, steps.len());
        if !(dt.is_finite() && dt > 0.0) {
            return Err(unfit("the time of a step is not a positive number"));
        }
        let joints = RecordJoints::of(manifest);
        let columns = velocity.shape.get(1).copied().unwrap_or(0);
        if velocity.shape.first() != Some(&t) || velocity.shape.len() != 2 || joints.dof.iter().any(|&d| d >= columns) {
            return Err(unfit("its velocities do not match its description"));
        }
        let series = |dof: usize| -> Vec<f64> {
            velocity
                .data
                .iter()
                .skip(dof)
                .step_by(columns.max(1))
                .copied()
                .collect()
        };
        let each: Vec<Vec<f64>> = joints.dof.iter().map(|&dof| series(dof)).collect();
        let pairs = joints
            .pairs
            .iter()
            .map(|&(right, left)| (&each[right][..], &each[left][..]));
        let seconds = t as f64 * dt;
        let hands = [0, 1].map(|hand| hand_measures(&steps, hand, dt, seconds));
        let touches = hands.each_ref().map(|(_, touches)| *touches as f64);
        let [(right_hand, _), (left_hand, _)] = hands;
        Ok(Self {
            episodes: 1,
            steps: t as u64,
            seconds,
            parts_per_episode: parts(&npz)?,
            right_hand,
            left_hand,
            hand_to_hand: steps.share(|step| step.hand_to_hand),
            double_touch: steps.share(|step| step.double_touch),
            handedness: ratio(touches[0] - touches[1], touches[0] + touches[1]),
            smoothness: smoothness(&each, dt),
            symmetry: symmetry(pairs),
            regards: regards::counted(&npz)?,
            hands_seen: regards::seen(&npz, manifest)?,
        })
    }

    /// Computes the measures of all episodes of a record, one after another.
    ///
    /// # Errors
    /// As [`Measures::of_episode`].
    pub fn of_record(record: &Record) -> Result<Vec<Self>, RecordError> {
        let episodes = record.manifest().episodes.iter();
        episodes
            .map(|episode| Self::of_episode(record, episode.episode))
            .collect()
    }

    /// Returns the means of the measures of episodes, each weighted by its time; `None` without time.
    pub fn mean(all: &[Self]) -> Option<Self> {
        let seconds: f64 = all.iter().map(|m| m.seconds).sum();
        let any = all.iter().any(|m| m.seconds > 0.0);
        any.then(|| {
            let of = |value: &dyn Fn(&Self) -> f64| all.iter().map(|m| m.seconds * value(m)).sum::<f64>() / seconds;
            let known = |value: &dyn Fn(&Self) -> Option<f64>| {
                let found: Vec<(f64, f64)> = all.iter().filter_map(|m| Some((m.seconds, value(m)?))).collect();
                let time: f64 = found.iter().map(|(seconds, _)| seconds).sum();
                (time > 0.0).then(|| found.iter().map(|(seconds, v)| seconds * v).sum::<f64>() / time)
            };
            let pairs = |value: &dyn Fn(&Self) -> Option<PerEyeAndHand<f64>>| {
                let of = |k: usize| known(&|m| value(m).map(|pairs| pairs.to_array()[k]));
                Some([of(0)?, of(1)?, of(2)?, of(3)?].into())
            };
            let parts: Vec<f64> = all.iter().filter_map(|m| m.parts_per_episode).collect();
            Self {
                episodes: all.iter().map(|m| m.episodes).sum(),
                steps: all.iter().map(|m| m.steps).sum(),
                seconds,
                parts_per_episode: (!parts.is_empty()).then(|| parts.iter().sum::<f64>() / parts.len() as f64),
                right_hand: HandMeasures::mean(all, seconds, |m| &m.right_hand),
                left_hand: HandMeasures::mean(all, seconds, |m| &m.left_hand),
                hand_to_hand: of(&|m| m.hand_to_hand),
                double_touch: of(&|m| m.double_touch),
                handedness: of(&|m| m.handedness),
                smoothness: known(&|m| m.smoothness),
                symmetry: known(&|m| m.symmetry),
                regards: pairs(&|m| m.regards),
                hands_seen: pairs(&|m| m.hands_seen),
            }
        })
    }

    /// Returns the measures as a line of JSON.
    pub fn to_json(&self) -> String {
        json::text(self)
    }
}

impl HandMeasures {
    fn mean(all: &[Measures], seconds: f64, hand: impl Fn(&Measures) -> &Self) -> Self {
        let of = |value: &dyn Fn(&Self) -> RegionMeasures| {
            let (mut touches, mut time, mut share) = (0.0, 0.0, 0.0);
            for measures in all {
                let found = value(hand(measures));
                let number = found.per_minute * measures.seconds / 60.0;
                touches += number;
                time += number * found.duration;
                share += found.share * measures.seconds;
            }
            RegionMeasures {
                per_minute: 60.0 * touches / seconds,
                duration: ratio(time, touches),
                share: share / seconds,
            }
        };
        let whole = of(&|hand| RegionMeasures {
            per_minute: hand.per_minute,
            duration: hand.duration,
            share: hand.share,
        });
        let names: std::collections::BTreeSet<&String> = all.iter().flat_map(|m| hand(m).regions.keys()).collect();
        let region = |name: &String| of(&|hand: &Self| hand.regions.get(name).copied().unwrap_or_default());
        Self {
            per_minute: whole.per_minute,
            duration: whole.duration,
            share: whole.share,
            regions: names.iter().map(|&name| (name.clone(), region(name))).collect(),
        }
    }
}

/// Returns a quotient, or 0 if the divisor is 0.
fn ratio(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

/// Measures one hand. Also returns the number of its touches.
fn hand_measures(steps: &TouchSteps, hand: usize, dt: f64, seconds: f64) -> (HandMeasures, usize) {
    let measure = |touching: &[bool]| {
        let bouts = TouchBouts::of(touching, dt);
        let region = RegionMeasures {
            per_minute: ratio(60.0 * bouts.number as f64, seconds),
            duration: ratio(bouts.steps as f64 * dt, bouts.number as f64),
            share: ratio(
                touching.iter().filter(|touching| **touching).count() as f64,
                touching.len() as f64,
            ),
        };
        (region, bouts.number)
    };
    let (whole, number) = measure(&steps.any(hand));
    let regions = steps
        .regions(hand)
        .into_iter()
        .map(|(name, touching)| (name, measure(&touching).0));
    let measures = HandMeasures {
        per_minute: whole.per_minute,
        duration: whole.duration,
        share: whole.share,
        regions: regions.collect(),
    };
    (measures, number)
}

/// Returns the number of parts that both palms touched, if the record is one of self-touch.
fn parts(npz: &Npz) -> Result<Option<f64>, NpzError> {
    if npz.arrays().all(|array| array.name != "first_touch_geom") {
        return Ok(None);
    }
    Ok(Some(npz.get_i64("first_touch_geom")?.data.len() as f64))
}

/// MIMo's joints in a record.
struct RecordJoints {
    /// Indices into `qvel`.
    dof: Vec<usize>,
    /// The right and the left joint of a pair, as indices into `dof`.
    pairs: Vec<(usize, usize)>,
}

impl RecordJoints {
    fn of(manifest: &Manifest) -> Self {
        let at = |name: &str| manifest.joints.iter().position(|joint| joint.name == name);
        let pair = |(right, joint): (usize, &crate::runs::JointDescription)| {
            let left = joint.name.replacen("right_", "left_", 1);
            (left != joint.name)
                .then(|| at(&left))
                .flatten()
                .map(|left| (right, left))
        };
        Self {
            dof: manifest.joints.iter().map(|joint| joint.dof).collect(),
            pairs: manifest.joints.iter().enumerate().filter_map(pair).collect(),
        }
    }
}
