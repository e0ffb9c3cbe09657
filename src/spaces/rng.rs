//! NumPy's default generator, so that a seed means the same here and in Gymnasium.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;

/// NumPy's default generator: PCG64, seeded as `numpy.random.default_rng(seed)` does it.
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

    /// Returns how many numbers were drawn.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }

    /// Draws a number in [0, 1) with 53 random bits.
    pub fn uniform(&mut self) -> f64 {
        self.drawn = self.drawn.wrapping_add(1);
        (self.generator.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
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
