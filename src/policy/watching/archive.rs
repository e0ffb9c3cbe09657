//! The postures in which hands were seen best, and the choice of the next one.

use super::limbs::{DrivenJoints, DrivenPart, HANDS};
use crate::spaces::NumpyRng;

/// Number of postures that are kept for each hand, and for both together.
const KEPT: usize = 8;
/// Standard deviations of variations, in half ranges of the joints; one is drawn at random.
const VARIATIONS: [f64; 4] = [0.03, 0.07, 0.15, 0.3];
/// Minimum visibility of a hand for its posture to be varied.
const SEEN: f64 = 0.01;
/// Share of the trials that repeat the best one: hands seen by chance are not seen again.
const AGAIN: f64 = 0.15;
/// Share of the trials that vary one of the best postures of both hands, instead of combining those of each.
const TOGETHER: f64 = 0.6;

/// A posture, and the visibility of each hand in it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trial {
    pub(super) posture: Vec<f64>,
    pub(super) seen: [f64; HANDS],
    /// Number of trials that `seen` averages.
    times: u32,
}

impl Trial {
    pub(super) fn new(posture: Vec<f64>, seen: [f64; HANDS]) -> Self {
        let times = 1;
        Self { posture, seen, times }
    }

    /// Adds an earlier observation of the same posture.
    fn join(&mut self, before: &Self) {
        let all = f64::from(self.times + before.times);
        for (seen, other) in self.seen.iter_mut().zip(before.seen) {
            *seen = (f64::from(self.times) * *seen + f64::from(before.times) * other) / all;
        }
        self.times += before.times;
    }

    fn worth(&self, hand: Option<usize>) -> f64 {
        hand.map_or_else(|| self.seen.iter().sum(), |hand| self.seen[hand])
    }
}

/// The best trials: for each hand, then for both, the best ones first.
#[derive(Clone, Debug, Default)]
pub(super) struct TrialArchive {
    hands: [Vec<Trial>; HANDS],
    both: Vec<Trial>,
}

impl TrialArchive {
    /// Returns the best trial for both hands.
    pub(super) fn best(&self) -> Option<&Trial> {
        self.both.first()
    }

    pub(super) fn add(&mut self, mut trial: Trial) {
        let mut lists: Vec<&mut Vec<Trial>> = self.hands.iter_mut().chain([&mut self.both]).collect();
        let same = |other: &Trial| other.posture == trial.posture;
        if let Some(before) = lists.iter().find_map(|list| list.iter().find(|&t| same(t)).cloned()) {
            lists.iter_mut().for_each(|list| list.retain(|other| !same(other)));
            trial.join(&before);
        }
        for (hand, list) in self.hands.iter_mut().enumerate() {
            insert(list, &trial, Some(hand));
        }
        insert(&mut self.both, &trial, None);
    }

    /// Returns the posture of the next trial. `random` is the share of new random ones.
    pub(super) fn propose(&self, limbs: &DrivenJoints, rng: &mut NumpyRng, random: f64) -> Vec<f64> {
        let chance = rng.uniform();
        if let Some(best) = self.best().filter(|_| chance < AGAIN) {
            return best.posture.clone();
        }
        let mut posture = limbs.random(rng);
        let some = |rng: &mut NumpyRng, list: &'_ Vec<Trial>| -> Option<Trial> {
            // the best ones most often
            let k = ((rng.uniform() * rng.uniform()) * list.len() as f64) as usize;
            list.get(k).cloned()
        };
        let together = rng.uniform() < TOGETHER;
        let parents: [Option<Trial>; HANDS] = if together {
            let parent = some(rng, &self.both);
            [parent.clone(), parent]
        } else {
            [some(rng, &self.hands[0]), some(rng, &self.hands[1])]
        };
        if rng.uniform() < random {
            return posture;
        }
        let lead = usize::from(rng.uniform() < 0.5);
        let head = parents[lead].as_ref().or(parents[1 - lead].as_ref());
        let deviation = VARIATIONS[rng.below(VARIATIONS.len())];
        for (k, limb) in limbs.limbs().enumerate() {
            let parent = match limb {
                DrivenPart::Head => head,
                // an arm whose hand was not seen gets a new random posture
                _ => limb
                    .hand()
                    .and_then(|hand| parents[hand].as_ref().filter(|trial| trial.seen[hand] > SEEN)),
            };
            if let Some(parent) = parent {
                posture[k] = limbs.vary(k, parent.posture[k], deviation * rng.normal());
            }
        }
        posture
    }
}

/// Adds a trial to the best ones if a hand is seen in it.
fn insert(list: &mut Vec<Trial>, trial: &Trial, hand: Option<usize>) {
    let worth = trial.worth(hand);
    if worth <= SEEN {
        return;
    }
    let place = list.partition_point(|other| other.worth(hand) >= worth);
    if place < KEPT {
        list.insert(place, trial.clone());
        list.truncate(KEPT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_seen_again_falls_back() {
        let mut archive = TrialArchive::default();
        archive.add(Trial::new(vec![0.0], [0.0, 0.9]));
        archive.add(Trial::new(vec![1.0], [0.3, 0.4]));
        assert_eq!(archive.best().map(|t| &t.posture[..]), Some(&[0.0][..]));
        archive.add(Trial::new(vec![0.0], [0.0, 0.0]));
        assert_eq!(archive.best().map(|t| &t.posture[..]), Some(&[1.0][..]));
        assert_eq!(archive.both.len(), 2);
        assert!((archive.both[1].seen[1] - 0.45).abs() < 1e-12);
        // what was never seen is not kept
        archive.add(Trial::new(vec![2.0], [0.0, 0.0]));
        assert_eq!((archive.both.len(), archive.hands[0].len()), (2, 1));
    }
}
