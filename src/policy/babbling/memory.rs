//! Movements and their outcomes.

use crate::spaces::NumpyRng;

/// Width of the kernel over postures: root mean square of the differences of joint angles, rad. Random postures are about 0.5 apart.
const WIDTH: f64 = 0.2;
/// Weight of an imagined experience in which a movement led to nothing, so that a movement tried only once, in another posture, promises little.
const DOUBT: f64 = 0.1;
/// Weight of an experience in a dissimilar posture, so that there is a choice in new postures.
const ANYWHERE: f64 = 1e-5;
/// Number of the latest experiences of a movement that are kept.
const OUTCOMES: usize = 10;
/// Maximum number of movements in memory, enough for a million steps.
const MOVEMENTS: usize = 12_000;

/// An action that is held for some steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Movement {
    pub(super) action: Vec<f32>,
    pub(super) steps: u32,
}

impl Movement {
    /// Makes a movement that does nothing.
    pub(super) fn rest(len: usize, steps: u32) -> Self {
        let action = vec![0.0; len];
        Self { action, steps }
    }
}

/// Result of one movement.
#[derive(Clone, Debug)]
pub(super) struct MovementOutcome {
    /// Joint angles before it, rad.
    pub(super) posture: Vec<f32>,
    /// Pairs of a palm and a geom that felt each other.
    pub(super) felt: Vec<u32>,
}

/// The most promising movements: for both hands together, and for each hand.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BestMovements {
    pub(super) both: Option<usize>,
    pub(super) hands: [Option<usize>; 2],
    promises: [f64; 2],
}

impl BestMovements {
    /// Returns the more promising of the movements for one hand.
    pub(super) fn lead(&self) -> Option<usize> {
        let [right, left] = self.promises;
        self.hands[usize::from(left > right)]
    }
}

/// All movements that led to a touch, each with its last outcomes.
#[derive(Clone, Debug, Default)]
pub(super) struct MovementMemory {
    movements: Vec<(Movement, Vec<MovementOutcome>)>,
}

impl MovementMemory {
    pub(super) fn len(&self) -> usize {
        self.movements.len()
    }

    pub(super) fn movement(&self, index: usize) -> &Movement {
        &self.movements[index].0
    }

    /// Adds a movement. If the memory is full, it replaces a random one that was not repeated.
    pub(super) fn add(&mut self, movement: Movement, outcome: MovementOutcome, rng: &mut NumpyRng) {
        let entry = (movement, vec![outcome]);
        if self.movements.len() < MOVEMENTS {
            return self.movements.push(entry);
        }
        let places = [(); 8].map(|()| rng.below(MOVEMENTS));
        let once = places.into_iter().find(|&k| self.movements[k].1.len() == 1);
        self.movements[once.unwrap_or(places[0])] = entry;
    }

    pub(super) fn add_outcome(&mut self, index: usize, outcome: MovementOutcome) {
        let outcomes = &mut self.movements[index].1;
        if outcomes.len() == OUTCOMES {
            outcomes.remove(0);
        }
        outcomes.push(outcome);
    }

    /// Finds the most promising movement in a posture. `worth` returns the hand of a pair and the current value of its touch.
    ///
    /// The promise of a movement is the mean worth of its outcomes, weighted by how near their postures are, over the square root of its
    /// time: long movements touch more, but not in proportion.
    pub(super) fn best(&self, posture: &[f32], worth: impl Fn(u32) -> (usize, f64)) -> BestMovements {
        let mut choice = BestMovements::default();
        let mut most = 0.0;
        for (index, (movement, outcomes)) in self.movements.iter().enumerate() {
            let (mut sums, mut weights) = ([0.0; 2], DOUBT);
            for outcome in outcomes {
                let weight = nearness(posture, &outcome.posture);
                weights += weight;
                for &pair in &outcome.felt {
                    let (hand, worth) = worth(pair);
                    sums[hand] += weight * worth;
                }
            }
            let scale = 1.0 / (weights * f64::from(movement.steps).sqrt());
            let both = (sums[0] + sums[1]) * scale;
            if both > most {
                (most, choice.both) = (both, Some(index));
            }
            for (hand, sum) in sums.into_iter().enumerate() {
                if sum * scale > choice.promises[hand] {
                    choice.promises[hand] = sum * scale;
                    choice.hands[hand] = Some(index);
                }
            }
        }
        choice
    }
}

fn nearness(a: &[f32], b: &[f32]) -> f64 {
    let squares = a.iter().zip(b).map(|(x, y)| f64::from((x - y) * (x - y)));
    let mean = squares.sum::<f64>() / a.len().max(1) as f64;
    pxfm::f_exp(-mean / (2.0 * WIDTH * WIDTH)) + ANYWHERE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(angle: f32, felt: &[u32]) -> MovementOutcome {
        let (posture, felt) = (vec![angle], felt.to_vec());
        MovementOutcome { posture, felt }
    }

    #[test]
    fn what_works_here_is_chosen_here() {
        let (mut memory, mut rng) = (MovementMemory::default(), NumpyRng::seed(0));
        for (angle, pair) in [(0.0, 0), (1.0, 1)] {
            memory.add(Movement::rest(1, 10), outcome(angle, &[pair]), &mut rng);
        }
        let at = |memory: &MovementMemory, angle| memory.best(&[angle], |pair| (pair as usize, 1.0));
        assert_eq!(at(&memory, 0.1).both, Some(0));
        assert_eq!(at(&memory, 0.9).both, Some(1));
        assert_eq!(at(&memory, 0.9).hands, [Some(0), Some(1)]);
        assert_eq!(at(&memory, 0.9).lead(), Some(1));
        // what failed when it was tried again promises less
        memory.add_outcome(0, outcome(0.5, &[]));
        memory.add_outcome(0, outcome(0.5, &[]));
        assert_eq!(at(&memory, 0.5).both, Some(1));
        // and what is worth nothing is not chosen
        assert_eq!(memory.best(&[0.0], |_| (0, 0.0)).both, None);
    }

    #[test]
    fn memory_is_bounded() {
        let (mut memory, mut rng) = (MovementMemory::default(), NumpyRng::seed(0));
        for k in 0..MOVEMENTS as u32 + 100 {
            memory.add(Movement::rest(1, k), outcome(0.0, &[0]), &mut rng);
        }
        assert_eq!(memory.len(), MOVEMENTS);
        for _ in 0..2 * OUTCOMES {
            memory.add_outcome(7, outcome(0.0, &[0]));
        }
        assert_eq!(memory.movements[7].1.len(), OUTCOMES);
    }
}
