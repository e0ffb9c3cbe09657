//! The touches in a record.

use std::collections::{BTreeMap, BTreeSet};

use crate::formats::npz::{Npz, NpzError};
use crate::runs::{GeomDescription, Manifest};

/// A touch continues across gaps of less than this, s.
const GAP: f64 = 0.1;

/// The touches of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct TouchStep {
    /// The regions that the right and the left hand touch, by number.
    regions: [Vec<usize>; 2],
    pub hand_to_hand: bool,
    pub double_touch: bool,
    /// Whether the right and the left hand touch something that is not MIMo's.
    pub outside: [bool; 2],
}

/// The touches of an episode, step by step.
#[derive(Debug, Default)]
pub(super) struct TouchSteps {
    steps: Vec<TouchStep>,
    /// Names of regions, seen from the hand that touches them.
    names: Vec<String>,
    /// Bodies of MIMo that a hand touches.
    pub bodies: BTreeSet<String>,
}

/// Returns which hand a geom belongs to, 0 right or 1 left, with its fingers.
fn hand_of(geom: &GeomDescription) -> Option<usize> {
    match (geom.region.as_deref(), geom.side.as_deref()) {
        (Some("hand"), Some("right")) => Some(0),
        (Some("hand"), Some("left")) => Some(1),
        _ => None,
    }
}

/// Names the region of a geom as a hand sees it: the head, its own arm, the other leg.
fn region_of(geom: &GeomDescription, hand: usize) -> Option<String> {
    let region = geom.region.as_deref()?;
    let own = ["right", "left"][hand];
    Some(match geom.side.as_deref() {
        None => region.to_string(),
        Some(side) if side == own => format!("own {region}"),
        Some(_) => format!("other {region}"),
    })
}

impl TouchSteps {
    /// Reads the contacts of an episode; `None` if they do not fit the description.
    pub fn read(npz: &Npz, manifest: &Manifest) -> Result<Option<Self>, NpzError> {
        let (ptr, geoms) = (npz.get_i64("contact_ptr")?.data, npz.get_i64("contact_geom")?);
        let distance = npz.get_f64("contact_dist")?.data;
        let count = distance.len();
        let ascending = ptr.windows(2).all(|w| w[0] <= w[1]);
        if !ascending || ptr.first() != Some(&0) || ptr.last() != Some(&(count as i64)) || geoms.shape != [count, 2] {
            return Ok(None);
        }
        let mut out = Self::default();
        for ends in ptr.windows(2) {
            let mut step = TouchStep::default();
            for c in ends[0] as usize..ends[1] as usize {
                let describe = |k: usize| {
                    usize::try_from(geoms.data[2 * c + k])
                        .ok()
                        .and_then(|g| manifest.geoms.get(g))
                };
                let (Some(a), Some(b)) = (describe(0), describe(1)) else {
                    return Ok(None);
                };
                // within the margin, but not touching
                if distance[c] <= 0.0 {
                    out.touch(&mut step, a, b);
                }
            }
            out.steps.push(step);
        }
        Ok(Some(out))
    }

    fn touch(&mut self, step: &mut TouchStep, a: &GeomDescription, b: &GeomDescription) {
        let hands = (hand_of(a), hand_of(b));
        if a.region.is_none() || b.region.is_none() {
            for hand in [hands.0, hands.1].into_iter().flatten() {
                step.outside[hand] = true;
            }
            return;
        }
        // a hand that touches itself, with its fingers, does not touch the body
        if hands.0.is_some() && hands.0 == hands.1 {
            return;
        }
        step.double_touch |= hands.0.is_some() || hands.1.is_some();
        step.hand_to_hand |= hands.0.is_some() && hands.1.is_some();
        for (hand, other) in [(hands.0, b), (hands.1, a)] {
            if hand.is_some() {
                self.bodies.insert(other.body.clone());
            }
            if let Some((hand, name)) = hand.and_then(|hand| Some((hand, region_of(other, hand)?))) {
                let region = self.names.iter().position(|known| *known == name).unwrap_or_else(|| {
                    self.names.push(name);
                    self.names.len() - 1
                });
                if !step.regions[hand].contains(&region) {
                    step.regions[hand].push(region);
                }
            }
        }
    }

    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Returns the share of the steps that satisfy a condition.
    pub fn share(&self, holds: impl Fn(&TouchStep) -> bool) -> f64 {
        super::ratio(
            self.steps.iter().filter(|step| holds(step)).count() as f64,
            self.len() as f64,
        )
    }

    /// Returns the steps in which a hand touches the body.
    pub fn any(&self, hand: usize) -> Vec<bool> {
        self.steps.iter().map(|step| !step.regions[hand].is_empty()).collect()
    }

    /// Returns the steps in which a hand touches something that is not MIMo's.
    pub fn outside(&self, hand: usize) -> Vec<bool> {
        self.steps.iter().map(|step| step.outside[hand]).collect()
    }

    /// Returns, for each region that a hand touches, the steps in which it does.
    pub fn regions(&self, hand: usize) -> BTreeMap<String, Vec<bool>> {
        let of = |region: usize| {
            self.steps
                .iter()
                .map(|step| step.regions[hand].contains(&region))
                .collect::<Vec<_>>()
        };
        let each = self
            .names
            .iter()
            .enumerate()
            .map(|(region, name)| (name.clone(), of(region)));
        each.filter(|(_, touching)| touching.contains(&true)).collect()
    }
}

/// Touches: runs of steps with contact, across short gaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TouchBouts {
    pub number: usize,
    /// Steps of all of them, with the gaps within.
    pub steps: usize,
}

impl TouchBouts {
    /// Finds the touches in steps of `dt` s.
    pub fn of(touching: &[bool], dt: f64) -> Self {
        let mut found = Self::default();
        let mut last: Option<usize> = None;
        for (step, _) in touching.iter().enumerate().filter(|(_, touching)| **touching) {
            match last {
                Some(last) if (step - last - 1) as f64 * dt < GAP => found.steps += step - last,
                _ => {
                    found.number += 1;
                    found.steps += 1;
                }
            }
            last = Some(step);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touches_go_on_through_short_gaps() {
        let steps = |text: &str| text.chars().map(|c| c == 'x').collect::<Vec<bool>>();
        let of = |text: &str, dt: f64| {
            let TouchBouts { number, steps } = TouchBouts::of(&steps(text), dt);
            (number, steps)
        };
        assert_eq!(of("", 0.01), (0, 0));
        assert_eq!(of("..xx..", 0.01), (1, 2));
        assert_eq!(of("x...xx", 0.01), (1, 6));
        // two missing steps of 50 ms are 0.1 s, which ends a touch
        assert_eq!(of("x..x.x", 0.05), (2, 4));
    }
}
