//! Lengths of legs and feet, which shapes and proportions share.

use super::lengths::Lengths;

/// Lengths from which the feet and the toes of both versions are derived.
pub(super) struct FootLengths {
    /// Ratio of the foot's length to that of the base body.
    pub ratio: f64,
    /// Half thickness, m.
    pub thickness: f64,
    /// Distance of the toes from the ankle, m.
    pub ball: f64,
}

/// Returns the lengths of the feet.
pub(super) fn foot(now: &Lengths, base: &Lengths) -> FootLengths {
    let ratio = now.foot_length / base.foot_length;
    FootLengths {
        ratio,
        thickness: 0.01 * (now.foot_length + now.foot_breadth) / (base.foot_length + base.foot_breadth),
        ball: 0.054 * ratio,
    }
}

/// Returns the radius and the half length of a thigh, m.
pub(super) fn thigh(now: &Lengths, base: &Lengths) -> (f64, f64) {
    let bone = |l: &Lengths| l.rump_knee_length - l.thigh_circumference;
    (
        0.037 * now.thigh_circumference / base.thigh_circumference,
        0.0625 * bone(now) / bone(base),
    )
}

/// Returns the lengths of a thigh and of a shank, and the height of a sole, m.
pub(super) fn leg(now: &Lengths, base: &Lengths) -> [f64; 3] {
    let (radius, half) = thigh(now, base);
    let shin = now.knee_sole_length / base.knee_sole_length;
    [2.0 * radius + half, 4.0 * 0.044 * shin, foot(now, base).thickness]
}
