//! An infant among others of his age: his sex and the z-scores of length, weight and head circumference.

use super::sources::{Mark, SourcedConstant};
use crate::config::{Config, Sex};
use crate::spaces::NumpyRng;

/// Correlations of the z-scores of a population: length with weight, length with head, weight with head.
const CORRELATIONS: [f64; 3] = [0.7, 0.5, 0.5];
/// The greatest z-score of an infant.
const MAX_SCORE: f64 = 3.0;
/// The number of draws after which z-scores beyond [`MAX_SCORE`] are moved to it.
const DRAWS: usize = 1000;

/// What distinguishes an infant from others of his age.
///
/// ```
/// use babybench::Config;
/// use babybench::config::Sex;
/// use babybench::mimo::Individual;
///
/// let mut config = Config { age: Some(6.0), ..Config::default() };
/// assert_eq!(Individual::of(&config), None);
/// (config.individual.sex, config.individual.length_z) = (Sex::Girl, Some(1.0));
/// let girl = Individual { sex: Sex::Girl, length_z: 1.0, weight_z: 0.0, head_z: 0.0 };
/// assert_eq!(Individual::of(&config), Some(girl));
/// // the spread of the standards around her; another number is another girl
/// config.individual.random = 1.0;
/// assert_ne!(Individual::of(&config), Some(girl));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Individual {
    /// Boy or girl.
    pub sex: Sex,
    /// The z-score of his length.
    pub length_z: f64,
    /// The z-score of his weight.
    pub weight_z: f64,
    /// The z-score of his head circumference.
    pub head_z: f64,
}

/// The difference of the z-scores of length and weight up to which no part of a body runs into another.
const USUAL: f64 = 3.0;

impl Individual {
    /// Returns whether he is so heavy or so light for his length that parts of his body may run into each other.
    pub(super) fn is_unusual(&self) -> bool {
        (self.length_z - self.weight_z).abs() > USUAL
    }

    /// Returns the infant of a configuration, drawn from its population if there is one; `None` if his body follows the formulas of
    /// MIMo's authors. Keys of z-scores are the centre of the population.
    pub fn of(config: &Config) -> Option<Self> {
        let own = &config.individual;
        let centre = [own.length_z, own.weight_z, own.head_z].map(Option::unwrap_or_default);
        let (sex, [length_z, weight_z, head_z]) = if own.random > 0.0 {
            let (sex, scores) = drawn(own.seed, own.number, centre, own.random);
            (if own.sex == Sex::None { sex } else { own.sex }, scores)
        } else {
            (own.sex, centre)
        };
        (sex != Sex::None && config.age.is_some()).then_some(Self {
            sex,
            length_z,
            weight_z,
            head_z,
        })
    }
}

/// Draws an infant of a population. Boys and girls are equally frequent, and z-scores are drawn again until all are within the greatest.
fn drawn(seed: u64, number: u64, centre: [f64; 3], deviation: f64) -> (Sex, [f64; 3]) {
    // an odd factor gives each number of a seed another generator; those of neighbouring seeds do not coincide
    let mut rng = NumpyRng::seed(seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let sex = if rng.uniform() < 0.5 { Sex::Boy } else { Sex::Girl };
    let mut scores = centre;
    for _ in 0..DRAWS {
        let normal = correlated(std::array::from_fn(|_| rng.normal()));
        scores = std::array::from_fn(|k| centre[k] + deviation * normal[k]);
        if scores.iter().all(|z| z.abs() <= MAX_SCORE) {
            break;
        }
    }
    (sex, scores.map(|z| z.clamp(-MAX_SCORE, MAX_SCORE)))
}

/// Turns three independent numbers into those of length, weight and head with [`CORRELATIONS`].
fn correlated([a, b, c]: [f64; 3]) -> [f64; 3] {
    let [weight, head, both] = CORRELATIONS;
    let own = (1.0 - weight * weight).sqrt();
    let shared = (both - weight * head) / own;
    let rest = (1.0 - head * head - shared * shared).sqrt();
    [a, weight * a + own * b, head * a + shared * b + rest * c]
}

/// Lists the constants of populations.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let names = ["length and weight", "length and head", "weight and head"];
    let each = names.into_iter().zip(CORRELATIONS);
    each.map(|(name, value)| SourcedConstant {
        name: format!("population, correlation of the z-scores of {name}"),
        values: vec![value],
        ages: Vec::new(),
        unit: "1",
        source: "ours; taller infants are heavier and have larger heads",
        mark: Mark::Unsourced,
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_population_has_its_mean_spread_and_correlations() {
        let n = 20_000;
        let all: Vec<_> = (0..n).map(|number| drawn(3, number, [0.5, 0.0, -0.5], 0.8)).collect();
        let boys = all.iter().filter(|(sex, _)| *sex == Sex::Boy).count() as f64 / n as f64;
        assert!((boys - 0.5).abs() < 0.02, "{boys}");
        let mean = |of: &dyn Fn(&[f64; 3]) -> f64| all.iter().map(|(_, z)| of(z)).sum::<f64>() / n as f64;
        let middle: [f64; 3] = std::array::from_fn(|k| mean(&|z| z[k]));
        let spread: [f64; 3] = std::array::from_fn(|k| mean(&|z| (z[k] - middle[k]).powi(2)).sqrt());
        for (k, centre) in [0.5, 0.0, -0.5].into_iter().enumerate() {
            assert!(
                (middle[k] - centre).abs() < 0.03 && (spread[k] - 0.8).abs() < 0.03,
                "{middle:?}, {spread:?}"
            );
        }
        for ([a, b], should) in [[0, 1], [0, 2], [1, 2]].into_iter().zip(CORRELATIONS) {
            let found = mean(&|z| (z[a] - middle[a]) * (z[b] - middle[b])) / spread[a] / spread[b];
            assert!((found - should).abs() < 0.03, "{a}, {b}: {found}");
        }
    }

    #[test]
    fn draws_beyond_the_tables_stay_within_them() {
        for number in 0..2000 {
            let (_, scores) = drawn(0, number, [3.0, -3.0, 3.0], 2.0);
            assert!(scores.iter().all(|z| z.abs() <= MAX_SCORE), "{scores:?}");
        }
        // a seed and a number always give the same infant, and others another
        assert_eq!(drawn(1, 2, [0.0; 3], 1.0), drawn(1, 2, [0.0; 3], 1.0));
        assert_ne!(drawn(1, 2, [0.0; 3], 1.0).1, drawn(2, 1, [0.0; 3], 1.0).1);
    }
}
