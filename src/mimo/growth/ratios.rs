//! The strength of infants as ratios to the torque of gravity, by groups of joints and age.
//!
//! Nobody has measured the joint torques of infants. The ratios are calibrated so that MIMo reaches the milestones of infants of each age:
//! `docs/guide/infant.md` lists the milestones and shows the sweep.

use crate::config::StrengthFactors;
use crate::mimo::sources::Mark;

/// Ages of the ratios, months. At [`GROWN`] and later the ratio is that of the original body.
pub(crate) const RATIO_AGES: [f64; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0];

/// The age of the original proportions, months.
pub(super) const GROWN: f64 = 18.0;

/// The reference of a ratio: the torque to which the strength is relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Against {
    /// The greatest torque of gravity about a joint.
    Joint(&'static str),
    /// Half the weight times the length of a thigh.
    Support,
    /// Half the weight times the arm of a grip. The numbers are shares of the original body's ratio.
    Grip,
    /// The strength that follows the volume of the part. The numbers are shares of that strength.
    Volume,
}

/// A ratio over age.
#[derive(Clone, Copy, Debug)]
pub(super) struct RatioCurve {
    /// The movement to which the strength belongs.
    pub name: &'static str,
    /// The motor whose torque has the ratio, and the direction: 0 negative, 1 positive.
    pub reference: (&'static str, usize),
    pub against: Against,
    /// At [`RATIO_AGES`].
    pub ratios: [f64; RATIO_AGES.len()],
    pub source: &'static str,
    pub mark: Mark,
}

impl RatioCurve {
    /// Returns the ratio at an age, linear between ages; `grown` is that of the original body.
    pub fn at(&self, age: f64, grown: f64) -> f64 {
        let last = RATIO_AGES.len() - 1;
        let k = RATIO_AGES.partition_point(|a| *a <= age).saturating_sub(1);
        if RATIO_AGES[k] == age {
            return self.ratios[k];
        }
        let (high, end) = if k < last {
            (self.ratios[k + 1], RATIO_AGES[k + 1])
        } else {
            (grown, GROWN)
        };
        if age >= end {
            return high;
        }
        let share = (age - RATIO_AGES[k]) / (end - RATIO_AGES[k]);
        self.ratios[k] + share * (high - self.ratios[k])
    }
}

/// A group of joints whose strength has its own factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Group {
    Neck,
    Trunk,
    Shoulder,
    Elbow,
    Wrist,
    Grip,
    Hip,
    Knee,
    Ankle,
}

impl Group {
    /// Returns the factor of a configuration.
    pub fn factor(self, factors: &StrengthFactors) -> f64 {
        match self {
            Self::Neck => factors.neck,
            Self::Trunk => factors.trunk,
            Self::Shoulder => factors.shoulder,
            Self::Elbow => factors.elbow,
            Self::Wrist => factors.wrist,
            Self::Grip => factors.grip,
            Self::Hip => factors.hip,
            Self::Knee => factors.knee,
            Self::Ankle => factors.ankle,
        }
    }
}

macro_rules! curves {
    ($($name:ident, $label:literal, $actuator:literal, $direction:literal, $against:expr, $ratios:expr, $mark:ident, $source:literal;)*) => {
        $(const $name: RatioCurve = RatioCurve {
            name: $label,
            reference: ($actuator, $direction),
            against: $against,
            ratios: $ratios,
            source: $source,
            mark: Mark::$mark,
        };)*

        /// All curves.
        pub(super) const CURVES: &[RatioCurve] = &[$($name),*];
    };
}

curves! {
    NECK_FORWARD, "neck, forward", "act:head_tilt", 1, Against::Joint("robot:head_tilt"),
        [0.50, 0.60, 0.75, 0.95, 1.15, 1.40, 1.55, 1.60], Measured, "calibrated on head lag in a pull to sit (Denver II: 50 % without at 3.5 months, 75 % at 4)";
    NECK_BACK, "neck, back", "act:head_tilt", 0, Against::Joint("robot:head_tilt"),
        [1.05, 1.2, 1.5, 1.9, 2.2, 2.6, 2.8, 2.9], Unsourced, "prone head lift at 1 month, held at 3 (Pediatrics in Review 2016, table of Scharf et al.)";
    NECK_SIDE, "neck, to a side", "act:head_tilt_side", 1, Against::Joint("robot:head_tilt_side"),
        [0.7, 0.85, 1.0, 1.15, 1.3, 1.5, 1.65, 1.8], Unsourced, "head level to a side at 2 months (muscle function score 1, Pediatr Phys Ther)";
    TRUNK_BACK, "trunk, back", "act:hip_bend", 0, Against::Joint("robot:hip_bend1"),
        [0.15, 0.2, 0.35, 0.5, 0.65, 0.80, 0.81, 0.82], Measured, "calibrated on supported sitting: sits alone at 6 months (WHO 2006, doi:10.1111/j.1651-2227.2006.tb02379.x)";
    TRUNK_FORWARD, "trunk, forward", "act:hip_bend", 1, Against::Joint("robot:hip_bend1"),
        [0.1, 0.12, 0.18, 0.25, 0.35, 0.50, 0.60, 0.62], Unsourced, "ours; leaning and turning of the trunk follow it";
    SHOULDER, "shoulder, abduction", "act:left_shoulder_abduction", 1, Against::Joint("robot:left_shoulder_ad_ab"),
        [2.0, 2.0, 2.2, 2.6, 3.2, 4.0, 5.0, 5.5], Unsourced, "arms wave at birth and reach at 4 months; the numbers are our choice, other shoulder motors follow";
    ARM, "elbow and wrist", "act:left_elbow", 0, Against::Volume,
        [0.5, 0.5416666666666666, 0.5833333333333334, 0.625, 0.6666666666666666, 0.75, 0.875, 1.0], Unsourced, "ours";
    HIP_BEND, "hip, bend", "act:left_hip_flex", 0, Against::Joint("robot:left_hip1"),
        [2.0, 1.5, 1.3, 1.5, 1.8, 2.5, 3.5, 4.0], Unsourced, "kicks at birth, steps lost at 2 to 3 months (Thelen et al. 1982); spreading and turning follow, and bending of the knee";
    HIP_STRETCH, "hip, stretch", "act:left_hip_flex", 1, Against::Support,
        [0.4, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.05], Unsourced, "partial support at birth, stands with help at 7.6 months (WHO 2006); the numbers are our choice";
    KNEE_STRETCH, "knee, stretch", "act:left_knee", 1, Against::Support,
        [0.2, 0.2, 0.25, 0.3, 0.35, 0.45, 0.8, 1.1], Measured, "calibrated on support by the legs: stands with help at 7.6 months (WHO 2006); ankles and toes follow";
    GRIP, "grip", "act:left_fingers", 0, Against::Grip,
        [1.64, 1.56, 1.25, 0.94, 0.94, 0.94, 0.97, 0.98], Unsourced, "hangs by two hands at birth, no more at 3 months (after Robinson and Richter 1934); not calibrated";
}

/// Returns the group of a motor, without `act:` and side, and the curves of its negative and of its positive direction; `None` for those of
/// the eyes.
pub(super) fn rule(name: &str) -> Option<(Group, [&'static RatioCurve; 2])> {
    Some(match name {
        "head_tilt" => (Group::Neck, [&NECK_BACK, &NECK_FORWARD]),
        "head_tilt_side" | "head_swivel" => (Group::Neck, [&NECK_SIDE, &NECK_SIDE]),
        "hip_bend" => (Group::Trunk, [&TRUNK_BACK, &TRUNK_FORWARD]),
        "hip_lean" | "hip_twist" => (Group::Trunk, [&TRUNK_FORWARD, &TRUNK_FORWARD]),
        "elbow" => (Group::Elbow, [&ARM, &ARM]),
        "hip_flex" => (Group::Hip, [&HIP_BEND, &HIP_STRETCH]),
        "hip_abduction" | "hip_rotation" => (Group::Hip, [&HIP_BEND, &HIP_BEND]),
        "knee" => (Group::Knee, [&HIP_BEND, &KNEE_STRETCH]),
        "toes" | "big_toe" => (Group::Ankle, [&KNEE_STRETCH, &KNEE_STRETCH]),
        _ if name.starts_with("foot_") => (Group::Ankle, [&KNEE_STRETCH, &KNEE_STRETCH]),
        _ if name.starts_with("shoulder_") => (Group::Shoulder, [&SHOULDER, &SHOULDER]),
        _ if name.starts_with("wrist_") => (Group::Wrist, [&ARM, &ARM]),
        "fingers" => (Group::Grip, [&GRIP, &GRIP]),
        _ if ["ff_", "mf_", "rf_", "lf_", "thumb_"]
            .iter()
            .any(|finger| name.starts_with(finger)) =>
        {
            (Group::Grip, [&GRIP, &GRIP])
        }
        _ => return None,
    })
}
