//! Measures of a recorded part of a phase.

use super::sample::Sample;
use crate::eval::EpisodeError;
use crate::eval::measures::{Measures, RegionMeasures, Surroundings};
use crate::eval::movement::{Movement, MovementError, MovementOptions};
use crate::runs::Record;

/// Segments that may lead a roll.
const SEGMENTS: [&str; 5] = ["head", "shoulders", "pelvis", "right_leg", "left_leg"];

/// Measures an episode of a record.
pub(super) fn observe(
    record: &Record,
    episode: u64,
    camera: &MovementOptions,
    sample: &mut Sample,
) -> Result<(), EpisodeError> {
    let movement = Movement::of_episode(record, episode, camera).map_err(|error| match error {
        MovementError::Record(error) => EpisodeError::from(error),
        other => EpisodeError::Observer(other.into()),
    })?;
    roll(&movement, sample);
    sample.seconds = movement.seconds;
    sample.values.extend(movement.values);
    let measures = Measures::of_episode(record, episode)?;
    let around = Surroundings::of_episode(record, episode)?;
    hands(&measures, &around, sample);
    sample.areas = around.bodies;
    Ok(())
}

/// Measures whether MIMo rolled, and which segment led.
fn roll(movement: &Movement, sample: &mut Sample) {
    let leading = movement.leading.first();
    sample.put("rolls", f64::from(u8::from(leading.is_some())));
    if let Some(leading) = leading {
        for segment in SEGMENTS {
            let first = f64::from(u8::from(segment == leading));
            sample.put(&format!("led_by_{segment}"), first);
        }
    }
}

/// Measures what the hands touched.
fn hands(measures: &Measures, around: &Surroundings, sample: &mut Sample) {
    let hands = [&measures.right_hand, &measures.left_hand];
    let body: f64 = hands.iter().map(|hand| hand.per_minute).sum();
    let region = |wanted: &str| -> f64 {
        let regions = hands.iter().flat_map(|hand| &hand.regions);
        let of = |(name, found): (&String, &RegionMeasures)| {
            (name.split(' ').next_back() == Some(wanted)).then_some(found.per_minute)
        };
        regions.filter_map(of).sum()
    };
    let time: f64 = hands.iter().map(|hand| hand.per_minute * hand.duration).sum();
    let [head, trunk, legs] = [region("head"), region("trunk"), region("leg") + region("foot")];
    let regions = head + trunk + legs + region("arm") + region("hand");
    sample.put("touches_per_minute", body);
    sample.put("floor_touches_per_minute", around.per_minute);
    sample.put("contacts", body + around.per_minute);
    sample.put("touch_duration", (body > 0.0).then(|| time / body));
    sample.put("between_contacts", around.free);
    sample.put("body_against_floor", balance(body, around.per_minute));
    sample.put("head_against_trunk", balance(head, trunk));
    sample.put("legs_share", (regions > 0.0).then(|| legs / regions));
    sample.put("handedness", (body > 0.0).then_some(measures.handedness));
    sample.put("hand_to_hand", measures.hand_to_hand);
    sample.put("double_touch", measures.double_touch);
    sample.put("smoothness", measures.smoothness);
    sample.put("symmetry", measures.symmetry);
}

/// Returns the difference of two rates over their sum; `None` if both are 0.
fn balance(a: f64, b: f64) -> Option<f64> {
    (a + b > 0.0).then(|| (a - b) / (a + b))
}
