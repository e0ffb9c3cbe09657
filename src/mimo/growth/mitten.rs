//! Hands and toes of MIMo v1: a palm, all fingers as one, all toes as one.

use super::body::SLACK;
use super::leg_lengths::FootLengths;
use super::lengths::Lengths;
use super::shapes::{BodyShapes, Side, long, on_x, on_z};

/// Adds hands and fingers at the end of a forearm of given radius and half length.
pub(super) fn hands(now: &Lengths, base: &Lengths, forearm: (f64, f64), out: &mut BodyShapes) {
    let thickness = 0.01 * (now.hand_length + now.hand_breadth) / (base.hand_length + base.hand_breadth);
    let breadth = 0.0281 * now.fist_breadth / base.fist_breadth;
    let ratio = now.hand_length / base.hand_length;
    let (palm, fingers) = (0.0208 * ratio, 0.0207 * ratio);
    let hand = [
        ([breadth, thickness, palm], [thickness / 2.0, 0.0, palm]),
        (
            long(thickness + 2.0 * SLACK, breadth),
            [thickness / 2.0, 0.0, 2.0 * palm],
        ),
    ];
    out.geoms(Side::Both, "hand", hand);
    let mitten = [
        ([now.hand_breadth - 2.0 * SLACK, thickness, fingers], on_z(fingers)),
        (long(thickness + 2.0 * SLACK, now.hand_breadth), on_z(2.0 * fingers)),
    ];
    out.geoms(Side::Both, "fingers", mitten);
    let (radius, half) = forearm;
    out.bodies(
        Side::Both,
        [
            ("hand", on_z(87.0 / 97.0 * (radius + 2.0 * half))),
            ("fingers", on_z(2.0 * palm)),
        ],
    );
    out.joints(Side::Both, [("hand1", [0.0; 3])]);
}

/// Adds the toes.
pub(super) fn toes(now: &Lengths, foot: &FootLengths, out: &mut BodyShapes) {
    let half = 0.007 * foot.ratio;
    let (breadth, thickness) = (now.foot_breadth, foot.thickness);
    let toes = [
        ([half, breadth - SLACK, thickness - SLACK], on_x(half)),
        (long(thickness, breadth), on_x(2.0 * half)),
    ];
    out.geoms(Side::Both, "toes", toes);
    out.bodies(Side::Both, [("toes", on_x(foot.ball))]);
}
