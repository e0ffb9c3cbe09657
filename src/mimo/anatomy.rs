//! The bodies of MIMo, with their parts and the spacing of their touch sensors.

use crate::config::Part;

/// A body of MIMo, or a pair of a left and a right one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyKind {
    /// Its name without `left_` and `right_`.
    pub name: &'static str,
    /// The part it belongs to.
    pub part: Part,
    /// Distance between its touch sensors at `touch_scale: 1`, m.
    pub touch_spacing: f64,
    /// Whether it is only in MIMo v2's table of touch scales, such as the five fingers and the big toes.
    pub only_v2: bool,
}

/// Returns the kind of a body of MIMo by its name, such as `left_hand`.
///
/// ```
/// use babybench::config::Part;
/// use babybench::mimo::body_kind;
///
/// let hand = body_kind("left_hand").expect("MIMo has hands");
/// assert_eq!((hand.name, hand.part, hand.touch_spacing), ("hand", Part::Hands, 0.007));
/// assert!(body_kind("cube").is_none());
/// ```
pub fn body_kind(body: &str) -> Option<&'static BodyKind> {
    let plain = body.strip_prefix("left_").or_else(|| body.strip_prefix("right_"));
    let plain = plain.unwrap_or(body);
    BODIES.iter().find(|kind| kind.name == plain)
}

const fn both(name: &'static str, part: Part, touch_spacing: f64) -> BodyKind {
    BodyKind {
        name,
        part,
        touch_spacing,
        only_v2: false,
    }
}

const fn only_v2(name: &'static str, part: Part, touch_spacing: f64) -> BodyKind {
    BodyKind {
        only_v2: true,
        ..both(name, part, touch_spacing)
    }
}

/// Every body.
const BODIES: [BodyKind; 31] = [
    both("toes", Part::Feet, 0.010),
    both("foot", Part::Feet, 0.015),
    both("lower_leg", Part::Legs, 0.038),
    both("upper_leg", Part::Legs, 0.027),
    both("hip", Part::Body, 0.025),
    both("lower_body", Part::Body, 0.025),
    both("upper_body", Part::Body, 0.030),
    both("chest", Part::Body, 0.030),
    both("head", Part::Head, 0.013),
    both("eye", Part::Eyes, 1.0),
    both("upper_arm", Part::Arms, 0.024),
    both("lower_arm", Part::Arms, 0.024),
    both("hand", Part::Hands, 0.007),
    both("fingers", Part::Fingers, 0.002),
    only_v2("big_toe", Part::Feet, 0.010),
    only_v2("ffknuckle", Part::Fingers, 0.004),
    only_v2("ffmiddle", Part::Fingers, 0.004),
    only_v2("ffdistal", Part::Fingers, 0.002),
    only_v2("mfknuckle", Part::Fingers, 0.004),
    only_v2("mfmiddle", Part::Fingers, 0.004),
    only_v2("mfdistal", Part::Fingers, 0.002),
    only_v2("rfknuckle", Part::Fingers, 0.004),
    only_v2("rfmiddle", Part::Fingers, 0.004),
    only_v2("rfdistal", Part::Fingers, 0.002),
    only_v2("lfmetacarpal", Part::Fingers, 0.007),
    only_v2("lfknuckle", Part::Fingers, 0.004),
    only_v2("lfmiddle", Part::Fingers, 0.004),
    only_v2("lfdistal", Part::Fingers, 0.002),
    only_v2("thbase", Part::Fingers, 0.004),
    only_v2("thhub", Part::Fingers, 0.004),
    only_v2("thdistal", Part::Fingers, 0.002),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Behavior, Config};
    use crate::mimo::{build_model, embedded};

    #[test]
    fn every_body_of_mimo_is_listed_and_only_those() {
        let mut found = Vec::new();
        let versions = [2, 3].map(|version| {
            [
                (Behavior::SelfTouch, false, version),
                (Behavior::HandRegard, true, version),
            ]
        });
        for (behavior, v2, mimo_version) in versions.into_iter().flatten() {
            let config = Config {
                behavior,
                mimo_version,
                ..Config::default()
            };
            let model = build_model(&config, &embedded()).expect("a scene");
            let hip = model.body("hip").expect("MIMo");
            for (body, name) in model
                .body_name
                .iter()
                .enumerate()
                .filter(|(b, _)| model.in_subtree(*b, hip))
            {
                let kind = body_kind(name);
                if model.body_geomnum[body] > 0 {
                    assert!(kind.is_some_and(|k| v2 || !k.only_v2), "{name}");
                }
                found.extend(kind.map(|k| k.name));
            }
        }
        for kind in &BODIES {
            assert!(found.contains(&kind.name), "{} is not a body of MIMo", kind.name);
        }
    }
}
