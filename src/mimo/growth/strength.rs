//! The part that carries the muscles of an actuator.

use crate::mimo::Version;

/// Returns the geom whose volume the strength of an actuator follows, as its body and its index among the geoms of that
/// body; `None` for actuators that are not MIMo's.
pub(super) fn carrier(actuator: &str, version: Version) -> Option<(String, usize)> {
    let name = actuator.strip_prefix("act:")?;
    let (side, name) = match name.split_once('_') {
        Some((side @ ("left" | "right"), rest)) => (Some(side), rest),
        _ => (None, name),
    };
    let (body, index) = match (version, name) {
        (Version::V1, "toes") => ("foot", SOLE),
        _ => CARRIERS
            .iter()
            .find(|(_, _, actuators)| actuators.contains(&name))
            .map(|&(body, index, _)| (body, index))?,
    };
    let body = match side {
        Some(side) => format!("{side}_{body}"),
        None => body.to_string(),
    };
    Some((body, index))
}

/// Returns the factor on the gear of an actuator of MIMo 2 at any age. The authors' growth gives v2's toes the strength of its big toe, half of that
/// of the original body.
pub(super) fn share(actuator: &str, version: Version) -> f64 {
    match (version, actuator) {
        (Version::V2, "act:left_toes" | "act:right_toes") => 0.5,
        _ => 1.0,
    }
}

/// Index of the sole among the geoms of a foot.
const SOLE: usize = 1;

/// Bodies without a side, the index of the geom in the body, and the actuators that it carries.
const CARRIERS: [(&str, usize, &[&str]); 28] = [
    ("chest", 0, &["chest_twist", "chest_lean"]),
    ("lower_body", 0, &["hip_bend", "hip_twist", "hip_lean"]),
    ("head", 0, &["head_swivel", "head_tilt", "head_tilt_side"]),
    ("eye", 0, &["eye_horizontal", "eye_vertical", "eye_torsional"]),
    (
        "upper_arm",
        0,
        &["shoulder_horizontal", "shoulder_abduction", "shoulder_internal"],
    ),
    ("lower_arm", 0, &["elbow"]),
    (
        "hand",
        0,
        &["wrist_rotation", "wrist_flexion", "wrist_ulnar", "fingers"],
    ),
    ("upper_leg", 0, &["hip_flex", "hip_abduction", "hip_rotation"]),
    ("lower_leg", 0, &["knee"]),
    ("foot", SOLE, &["foot_flexion", "foot_inversion", "foot_rotation"]),
    ("toes", 0, &["toes"]),
    ("big_toe", 0, &["big_toe"]),
    ("ffknuckle", 0, &["ff_side", "ff_knuckle"]),
    ("ffmiddle", 0, &["ff_middle"]),
    ("ffdistal", 0, &["ff_distal"]),
    ("mfknuckle", 0, &["mf_side", "mf_knuckle"]),
    ("mfmiddle", 0, &["mf_middle"]),
    ("mfdistal", 0, &["mf_distal"]),
    ("rfknuckle", 0, &["rf_side", "rf_knuckle"]),
    ("rfmiddle", 0, &["rf_middle"]),
    ("rfdistal", 0, &["rf_distal"]),
    ("lfmetacarpal", 0, &["lf_meta"]),
    ("lfknuckle", 0, &["lf_side", "lf_knuckle"]),
    ("lfmiddle", 0, &["lf_middle"]),
    ("lfdistal", 0, &["lf_distal"]),
    ("thbase", 0, &["thumb_side", "thumb_add"]),
    ("thhub", 0, &["thumb_pivot", "thumb_middle"]),
    ("thdistal", 0, &["thumb_distal"]),
];
