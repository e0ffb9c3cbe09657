//! NumPy's default generator, so that a seed means the same here and in Gymnasium.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;

use super::normal;

/// NumPy's default generator: PCG64, seeded like `numpy.random.default_rng(seed)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumpyRng {
    generator: Pcg64,
    seed: u64,
    drawn: u64,
}

impl NumpyRng {
    /// Creates the generator that NumPy creates for a seed.
    pub fn seed(seed: u64) -> Self {
        let word = SeedSequence::new(seed).words();
        let wide = |i: usize| {
            let part = |k: usize| u128::from(word[k]);
            // 64-bit values are little end first, 128-bit values high half first
            (part(i) | part(i + 1) << 32) << 64 | part(i + 2) | part(i + 3) << 32
        };
        Self {
            generator: Pcg64::new(wide(0), wide(4)),
            seed,
            drawn: 0,
        }
    }

    /// Creates the generator of a seed in the state it has after `drawn` numbers.
    pub fn at(seed: u64, drawn: u64) -> Self {
        let mut rng = Self::seed(seed);
        rng.generator.advance(u128::from(drawn));
        rng.drawn = drawn;
        rng
    }

    /// Returns the seed the generator was made from.
    pub fn seed_value(&self) -> u64 {
        self.seed
    }

    /// Returns the number of values drawn.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }

    /// Draws a number in [0, 1) with 53 random bits.
    pub fn uniform(&mut self) -> f64 {
        normal::unit(self.word())
    }

    /// Draws a number from the standard normal distribution, by the ziggurat method: the same bits on every target, but not
    /// NumPy's numbers. It nearly always takes one word of the generator, sometimes more.
    pub fn normal(&mut self) -> f64 {
        normal::normal(|| self.word())
    }

    /// Draws 64 random bits.
    pub(crate) fn word(&mut self) -> u64 {
        self.drawn = self.drawn.wrapping_add(1);
        self.generator.next_u64()
    }

    /// Draws a number between `low` and `high`, as NumPy's `uniform` does.
    pub fn uniform_in(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Draws a whole number below `count`, or 0 if `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.uniform() * count as f64) as usize).min(count.saturating_sub(1))
    }
}

/// NumPy's `SeedSequence` for one integer: mixes entropy into a pool of four words and draws from it
/// (after M. E. O'Neill, "Developing a seed_seq Alternative").
struct SeedSequence {
    pool: [u32; 4],
}

const INIT_A: u32 = 0x43b0_d7e5;
const MULT_A: u32 = 0x931e_8875;
const INIT_B: u32 = 0x8b51_f9dd;
const MULT_B: u32 = 0x58f3_8ded;
const MIX_L: u32 = 0xca01_f9dd;
const MIX_R: u32 = 0x4973_f715;

/// Hashes a word; the multiplier changes from call to call.
fn hash(value: u32, constant: &mut u32, multiplier: u32) -> u32 {
    let mut v = value ^ *constant;
    *constant = constant.wrapping_mul(multiplier);
    v = v.wrapping_mul(*constant);
    v ^ v >> 16
}

impl SeedSequence {
    fn new(seed: u64) -> Self {
        let entropy = [seed as u32, (seed >> 32) as u32, 0, 0];
        let mut constant = INIT_A;
        let mut pool = entropy.map(|e| hash(e, &mut constant, MULT_A));
        for source in 0..4 {
            for target in 0..4 {
                if source != target {
                    let h = hash(pool[source], &mut constant, MULT_A);
                    let mixed = MIX_L.wrapping_mul(pool[target]).wrapping_sub(MIX_R.wrapping_mul(h));
                    pool[target] = mixed ^ mixed >> 16;
                }
            }
        }
        Self { pool }
    }

    /// Returns the eight words of state.
    fn words(&self) -> [u32; 8] {
        let mut constant = INIT_B;
        std::array::from_fn(|i| hash(self.pool[i % 4], &mut constant, MULT_B))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seed_0_gives_the_numbers_of_numpy() {
        let mut rng = NumpyRng::seed(0);
        let expect = [0.6369616873214543, 0.2697867137638703, 0.04097352393619469];
        assert_eq!(expect, std::array::from_fn(|_| rng.uniform()));
    }

    #[test]
    fn normal_numbers_have_the_moments_and_the_tails_of_the_distribution() {
        let mut rng = NumpyRng::seed(1);
        const N: usize = 1_000_000;
        let drawn: Vec<f64> = (0..N).map(|_| rng.normal()).collect();
        let moment = |k: i32| drawn.iter().map(|v| v.powi(k)).sum::<f64>() / N as f64;
        // five standard errors of each mean
        for (k, expect, spread) in [
            (1, 0.0, 1.0),
            (2, 1.0, 2.0),
            (3, 0.0, 15.0),
            (4, 3.0, 96.0),
            (6, 15.0, 10_170.0),
        ] {
            let (found, error) = (moment(k), f64::sqrt(spread / N as f64));
            assert!(
                (found - expect).abs() < 5.0 * error,
                "moment {k}: {found}, expected {expect}"
            );
        }
        // 1 - erf(x / sqrt 2)
        for (beyond, share) in [
            (0.5, 0.617_075),
            (1.0, 0.317_311),
            (2.0, 0.045_500),
            (3.5, 4.652_6e-4),
            (4.0, 6.334_2e-5),
        ] {
            let found = drawn.iter().filter(|v| v.abs() > beyond).count() as f64;
            let expect = share * N as f64;
            assert!(
                (found - expect).abs() < 5.0 * expect.sqrt(),
                "beyond {beyond}: {found}, expected {expect}"
            );
        }
        let words = rng.drawn() as f64 / N as f64;
        assert!((1.0..1.05).contains(&words), "{words} words for each");
    }

    #[test]
    fn a_generator_can_be_continued() {
        let mut rng = NumpyRng::seed(3);
        for _ in 0..1000 {
            rng.uniform();
        }
        assert_eq!(NumpyRng::at(rng.seed_value(), rng.drawn()), rng);
    }

    #[test]
    fn large_seeds_use_all_bits() {
        // numpy.random.default_rng(2**40 + 7).random()
        assert_eq!(NumpyRng::seed((1 << 40) + 7).uniform(), 0.829812891829413);
    }
}
