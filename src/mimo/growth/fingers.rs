//! Hands and toes of MIMo v2: five fingers, a big toe.

use super::body::SLACK;
use super::leg_lengths::FootLengths;
use super::lengths::Lengths;
use super::shapes::{BodyShapes, Side, long, on_x, on_z};

/// A finger: the names of its bodies, and its thickness and length relative to the middle finger's.
struct FingerShape {
    bodies: [&'static str; 3],
    thickness: f64,
    length: f64,
}

const FINGERS: [FingerShape; 4] = [
    FingerShape {
        bodies: ["ffknuckle", "ffmiddle", "ffdistal"],
        thickness: 0.95,
        length: 0.9,
    },
    FingerShape {
        bodies: ["mfknuckle", "mfmiddle", "mfdistal"],
        thickness: 1.0,
        length: 1.0,
    },
    FingerShape {
        bodies: ["rfknuckle", "rfmiddle", "rfdistal"],
        thickness: 0.95,
        length: 0.9,
    },
    FingerShape {
        bodies: ["lfknuckle", "lfmiddle", "lfdistal"],
        thickness: 0.91,
        length: 0.88,
    },
];

/// Lengths of the palm, m.
struct PalmLengths {
    thickness: f64,
    /// Half breadths on the side of the thumb and of the little finger.
    sides: (f64, f64),
    half_length: f64,
    /// Ratio of the breadth to that of the base body.
    ratio: f64,
}

/// Adds hands and fingers at the end of a forearm of given radius and half length.
pub(super) fn hands(now: &Lengths, base: &Lengths, forearm: (f64, f64), out: &mut BodyShapes) {
    let thickness = 0.00584 * (now.hand_length + now.hand_breadth) / (base.hand_length + base.hand_breadth);
    let ratio = now.hand_breadth / base.hand_breadth;
    let side = 0.01712 * ratio;
    let palm = PalmLengths {
        thickness,
        sides: (side, now.hand_breadth - side),
        half_length: now.hand_length / 2.0 - thickness,
        ratio,
    };
    let (a, b) = palm.sides;
    let p = palm.half_length;
    let hand = [
        ([a, thickness, p], [0.0; 3]),
        ([b, thickness, p / 2.0], [-now.hand_breadth, 0.0, -p / 2.0]),
        (long(thickness, a - SLACK), on_z(p)),
        (long(thickness, now.hand_breadth - SLACK), [-b, 0.0, -p]),
    ];
    out.geoms(Side::Both, "hand", hand);
    let x = 0.007 * ratio;
    let (radius, half) = forearm;
    // the original hand begins 110.32 mm down a forearm of 120 mm
    out.bodies(Side::Both, [("hand", [x, 0.0, 0.11032 / 0.12 * 2.0 * (radius + half)])]);
    let wrist = |along: f64| [-x, 0.0, -along * p];
    out.joints(
        Side::Both,
        [("hand1", wrist(0.6)), ("hand2", wrist(0.8)), ("hand3", wrist(1.0))],
    );
    let length = now.hand_length / 2.0;
    for finger in &FINGERS {
        add_finger(finger, now.middle_finger_diameter, length, out);
    }
    let knuckle = |finger: &FingerShape| a - finger.thickness * now.middle_finger_diameter - SLACK;
    let [first, _, ring, _] = &FINGERS;
    let knuckles = [
        ("ffknuckle", [knuckle(first), 0.0, p]),
        ("mfknuckle", on_z(p)),
        ("rfknuckle", [-knuckle(ring), 0.0, p]),
    ];
    out.bodies(Side::Both, knuckles);
    metacarpal(&palm, out);
    thumb(now, base, &palm, length, out);
}

/// Adds the three segments of a finger, given the radius and the length of the middle finger.
fn add_finger(finger: &FingerShape, radius: f64, length: f64, out: &mut BodyShapes) {
    let [knuckle, middle, distal] = finger.bodies;
    let radius = finger.thickness * radius;
    let half = length / 2.0 * finger.length;
    let tip = half / 2.0 - 0.45125 * radius;
    out.geoms(Side::Both, knuckle, [(long(radius, half), on_z(half))]);
    out.geoms(
        Side::Both,
        middle,
        [(long(0.95 * radius, half / 2.0), on_z(half / 2.0))],
    );
    out.geoms(Side::Both, distal, [(long(0.9025 * radius, tip), on_z(tip))]);
    out.bodies(Side::Both, [(middle, on_z(2.0 * half)), (distal, on_z(half))]);
}

/// Adds the metacarpal of the little finger and the place of its knuckle.
fn metacarpal(palm: &PalmLengths, out: &mut BodyShapes) {
    let (a, b) = palm.sides;
    // half breadths in the original hand: 5.08 mm of the metacarpal, 5.88 mm of the palm's side
    let half = b * 508.0 / 588.0;
    let (body_x, body_z) = (-0.01498 * palm.ratio, 0.0031 * palm.ratio);
    let x = -(a + 2.0 * b - half + body_x + SLACK);
    let (thickness, length) = (palm.thickness + SLACK, palm.half_length / 2.0);
    let geoms = [
        ([half, thickness, length], [x, 0.0, -body_z]),
        (long(thickness, half - SLACK), [x, 0.0, length - body_z]),
    ];
    out.geoms(Side::Both, "lfmetacarpal", geoms);
    let knuckle = [-(body_x + a + b * 588.0 / 508.0), 0.0, length - body_z];
    out.bodies(
        Side::Both,
        [("lfmetacarpal", [body_x, 0.0, body_z]), ("lfknuckle", knuckle)],
    );
}

/// Adds the thumb.
fn thumb(now: &Lengths, base: &Lengths, palm: &PalmLengths, finger: f64, out: &mut BodyShapes) {
    let (radius, half) = (now.thumb_diameter, 0.375 * finger);
    for (body, thinner, shorter) in [("thbase", 1.0, 1.0), ("thhub", 0.95, 0.7), ("thdistal", 0.9025, 0.65)] {
        out.geoms(
            Side::Both,
            body,
            [(long(thinner * radius, shorter * half), on_z(shorter * half))],
        );
    }
    let root = [
        0.0123 * palm.ratio,
        // the original thumb is rooted 4.23 mm off the middle of a palm of 5.84 mm half thickness
        palm.thickness * 423.0 / 584.0,
        -0.01602 * now.hand_length / base.hand_length,
    ];
    out.bodies(
        Side::Both,
        [
            ("thbase", root),
            ("thhub", on_z(2.0 * half)),
            ("thdistal", on_z(1.4 * half)),
        ],
    );
}

/// Adds the toes and the big toe.
pub(super) fn toes(now: &Lengths, base: &Lengths, foot: &FootLengths, out: &mut BodyShapes) {
    let half = 0.0095 * foot.ratio;
    let ratio = now.foot_breadth / base.foot_breadth;
    for (body, breadth, edge) in [("toes", 0.016, 0.0165), ("big_toe", 0.007, 0.0075)] {
        let geoms = [
            ([half, breadth * ratio, foot.thickness - SLACK], on_x(half)),
            (long(foot.thickness, edge * ratio), on_x(2.0 * half)),
        ];
        out.geoms(Side::Both, body, geoms);
    }
    let at = |share: f64| [foot.ball, share * now.foot_breadth, 0.0];
    out.bodies(Side::Both, [("toes", at(0.3)), ("big_toe", at(-0.7))]);
}
