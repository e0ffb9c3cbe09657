//! Names, units and meanings of the measures of movement.

use serde::Serialize;

/// The definition of a measure of movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MeasureDescription {
    /// Its name. `LIMB` stands for right_hand, left_hand, right_foot and left_foot; `SIDES` for hands and feet; `PAIR` for pairs of
    /// joints, such as right_hip_knee and right_left_hip; `SEGMENT` for head, shoulders, pelvis, right_leg and left_leg.
    pub name: &'static str,
    /// Its unit; empty for ratios.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

impl MeasureDescription {
    /// Returns the description of a measure of [`Movement::values`](super::Movement::values).
    pub fn of(name: &str) -> Option<&'static Self> {
        let parts = |kind: &str| match kind {
            "LIMB" => &super::LIMBS[..],
            "SIDES" => &["hands", "feet"],
            "SEGMENT" => &super::paths::SEGMENTS,
            _ => &[],
        };
        MOVEMENT_MEASURES.iter().find(|measure| {
            let Some((kind, rest)) = measure.name.split_once('_') else {
                return measure.name == name;
            };
            match kind {
                "PAIR" => name.strip_suffix(rest).is_some_and(|pair| pair.ends_with('_')),
                "LIMB" | "SIDES" | "SEGMENT" => parts(kind)
                    .iter()
                    .any(|part| name.strip_prefix(part).and_then(|name| name.strip_prefix('_')) == Some(rest)),
                _ => measure.name == name,
            }
        })
    }
}

const fn of(name: &'static str, unit: &'static str, meaning: &'static str) -> MeasureDescription {
    MeasureDescription { name, unit, meaning }
}

/// The measures of movement.
pub const MOVEMENT_MEASURES: &[MeasureDescription] = &[
    of(
        "exponent",
        "",
        "Exponent of the velocities' spectra, mean over the limbs.",
    ),
    of(
        "LIMB_exponent",
        "",
        "Exponent of the spectrum of the limb's velocity in the band.",
    ),
    of(
        "LIMB_speed",
        "m/s",
        "Mean speed of the end of the limb, as the camera sees it.",
    ),
    of("LIMB_movements", "1/min", "Movements of the limb per minute."),
    of("LIMB_duration", "s", "Mean duration of a movement."),
    of("LIMB_acceleration", "m/s^2", "Mean acceleration within movements."),
    of(
        "LIMB_peak_acceleration",
        "m/s^2",
        "Peak acceleration of a movement, mean over movements.",
    ),
    of("LIMB_sample_entropy", "nat", "Sample entropy of the limb's speed."),
    of(
        "SIDES_laterality",
        "",
        "Movements of the right less those of the left, over their sum.",
    ),
    of(
        "SIDES_together",
        "",
        "Share of movements whose other side begins within 0.2 s.",
    ),
    of(
        "SIDES_alternating",
        "",
        "Share of movements whose other side begins within 0.2 to 1 s.",
    ),
    of("SIDES_alone", "", "Share of the other movements."),
    of("PAIR_correlation", "", "Correlation of the velocities of two joints."),
    of(
        "PAIR_peak",
        "",
        "Their correlation of the largest magnitude within lags of 0.5 s.",
    ),
    of(
        "PAIR_lag",
        "s",
        "The lag of that peak; positive where the first joint leads.",
    ),
    of("PAIR_phase_locking", "", "Steadiness of their relative phase, 0 to 1."),
    of(
        "entropy",
        "bit",
        "Entropy of joint velocities every 40 ms in 16 bins, mean over the joints that move.",
    ),
    of(
        "sample_entropy",
        "nat",
        "Sample entropy of the limbs' speeds, mean over the limbs.",
    ),
    of(
        "dimensions",
        "",
        "Participation ratio of the covariance of joint velocities.",
    ),
    of(
        "LIMB_across",
        "",
        "Share of the time that a hand is across the midline of the hip.",
    ),
    of(
        "SEGMENT_turns",
        "s",
        "Time at which the segment's front has turned 45 degrees from supine.",
    ),
];
