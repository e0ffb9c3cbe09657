//! Trunk, head, arms and legs, which both versions of MIMo share.

use super::leg_lengths::{FootLengths, thigh};
use super::lengths::Lengths;
use super::proportions::Stretch;
use super::shapes::{BodyShapes, Side, long, on_x, on_z, sphere};

/// Slack by which the edge of a rounded part lies within it, m.
pub(super) const SLACK: f64 = 1e-4;
/// Height of the remaining stump of the neck, m.
const NECK: f64 = 2e-6;

/// Radius of the original head, m.
pub(super) const HEAD_RADIUS: f64 = 0.0735;

/// Adds the trunk, which follows the breadth of the hip; its heights have a factor. A separate chest takes the upper body's last geom
/// and leaves a stump of a neck there.
pub(super) fn trunk(now: &Lengths, base: &Lengths, has_chest: bool, stretch: Stretch, out: &mut BodyShapes) {
    let h = now.hip_breadth / base.hip_breadth;
    let up = h * stretch.trunk;
    let capsule = |radius: f64, half: f64, x: f64, z: f64| (long(radius * h, half * h), [x, 0.0, z * up]);
    out.geoms(Side::Middle, "hip", [capsule(0.048, 0.043, -0.002, 0.005)]);
    out.geoms(Side::Middle, "lower_body", [capsule(0.053, 0.035, 0.005, -0.008)]);
    let (waist, ribs) = (capsule(0.052, 0.035, 0.007, -0.032), capsule(0.048, 0.039, 0.004, 0.03));
    if has_chest {
        let radius = head_radius(now, base) / 4.0;
        let neck = (long(radius, NECK / 2.0), on_z(0.131 * up + NECK / 2.0));
        out.geoms(Side::Middle, "upper_body", [waist, ribs, neck]);
        out.geoms(Side::Middle, "chest", [capsule(0.041, 0.047, 0.0, 0.0)]);
        out.bodies(Side::Middle, [("chest", on_z(0.09 * up))]);
    } else {
        out.geoms(
            Side::Middle,
            "upper_body",
            [waist, ribs, capsule(0.041, 0.047, 0.0, 0.09)],
        );
    }
    let bodies = [
        ("hip", [0.0; 3]),
        ("lower_body", [0.002, 0.0, 0.076 * up]),
        ("upper_body", [-0.002, 0.0, 0.091 * up]),
        ("head", on_z(0.131 * up + NECK)),
    ];
    out.bodies(Side::Middle, bodies);
    let (lower, upper) = (on_z(-0.053 * up), on_z(-0.052 * up));
    out.joints(
        Side::Middle,
        [("hip_lean1", lower), ("hip_rot1", lower), ("hip_bend1", lower)],
    );
    out.joints(
        Side::Middle,
        [("hip_lean2", upper), ("hip_rot2", upper), ("hip_bend2", upper)],
    );
}

/// Returns the radius of the head, m.
fn head_radius(now: &Lengths, base: &Lengths) -> f64 {
    HEAD_RADIUS * (now.head_circumference / base.head_circumference)
}

/// Adds the head with the eyes, which follow its circumference.
pub(super) fn head(now: &Lengths, base: &Lengths, out: &mut BodyShapes) {
    let k = now.head_circumference / base.head_circumference;
    let radius = head_radius(now, base);
    out.geoms(Side::Middle, "head", [(sphere(radius), [0.01 * k, 0.0, radius])]);
    out.geoms(Side::Both, "eye", [(sphere(0.01125 * k), [0.0; 3])]);
    out.bodies(Side::Both, [("eye", [0.07, 0.0245, 0.067375].map(|x| x * k))]);
    out.joints(
        Side::Middle,
        [("head_tilt", on_z(0.01225 * k)), ("head_tilt_side", on_z(0.0245 * k))],
    );
    let (name, side) = ("vestibular", Side::Middle);
    let pos = [0.01, 0.0, radius];
    out.sites.push(super::shapes::PartPosition { name, side, pos });
}

/// Adds the arms without hands. Returns the radius and half length of the forearm.
pub(super) fn arms(
    now: &Lengths,
    base: &Lengths,
    has_chest: bool,
    stretch: Stretch,
    out: &mut BodyShapes,
) -> (f64, f64) {
    let h = now.hip_breadth / base.hip_breadth;
    let bone = |l: &Lengths| l.shoulder_elbow_length - l.upper_arm_circumference;
    let upper = (
        0.024 * now.upper_arm_circumference / base.upper_arm_circumference,
        0.0536 * bone(now) / bone(base),
    );
    let bone = |l: &Lengths| l.elbow_hand_length - l.hand_length - l.forearm_circumference;
    let lower = (
        0.023 * now.forearm_circumference / base.forearm_circumference,
        0.037 * bone(now) / bone(base),
    );
    out.geoms(Side::Both, "upper_arm", [(long(upper.0, upper.1), on_z(upper.1))]);
    out.geoms(Side::Both, "lower_arm", [(long(lower.0, lower.1), on_z(lower.1))]);
    let height = if has_chest { 0.0 } else { 0.09 * (h * stretch.trunk) };
    let shoulder = [0.0, 0.088 * h + 0.25 * upper.0, height];
    out.bodies(Side::Both, [("upper_arm", shoulder)]);
    out.bodies(Side::Both, [("lower_arm", on_z(2.0 * upper.1))]);
    out.joints(Side::Both, [("shoulder_horizontal", [0.0; 3])]);
    lower
}

/// Adds the legs with feet, without toes; the lengths of thighs and shanks have a factor.
pub(super) fn legs(now: &Lengths, base: &Lengths, foot: &FootLengths, stretch: Stretch, out: &mut BodyShapes) {
    let h = now.hip_breadth / base.hip_breadth;
    let mut thigh = thigh(now, base);
    if stretch.leg != 1.0 {
        // the thickness stays
        thigh.1 = stretch.leg * (2.0 * thigh.0 + thigh.1) - 2.0 * thigh.0;
    }
    let shin = now.knee_sole_length / base.knee_sole_length * stretch.leg;
    let calf = 0.044 * shin;
    out.geoms(
        Side::Both,
        "upper_leg",
        [(long(thigh.0, thigh.1), on_z(-1.032 * thigh.1))],
    );
    let lower = [
        (long(now.calf_circumference, calf), on_z(-calf)),
        (long(now.ankle_circumference, 0.028 * shin), on_z(-3.0 * calf)),
    ];
    out.geoms(Side::Both, "lower_leg", lower);
    let (length, breadth, thickness) = (0.035 * foot.ratio, now.foot_breadth, foot.thickness);
    let sole = [
        (long(breadth - SLACK, thickness - SLACK), on_x(-0.016 * foot.ratio)),
        ([length, breadth, thickness], on_x(0.019 * foot.ratio)),
        (long(thickness - SLACK, breadth - 2.0 * SLACK), on_x(foot.ball)),
    ];
    out.geoms(Side::Both, "foot", sole);
    let bodies = [
        ("upper_leg", [0.005, 0.051 * h, -0.007]),
        ("lower_leg", on_z(-(2.0 * thigh.0 + thigh.1))),
        ("foot", on_z(-4.0 * calf)),
    ];
    out.bodies(Side::Both, bodies);
    let ankle = on_z(1.5 * thickness);
    out.joints(Side::Both, [("foot1", ankle), ("foot2", ankle), ("foot3", ankle)]);
}
