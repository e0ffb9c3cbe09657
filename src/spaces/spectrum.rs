//! Noise whose power falls with a power of the frequency, in blocks, with the same bits on every target.
//!
//! The libraries for Fourier transforms choose their algorithm by the processor's instructions, so that the last bits differ between
//! machines.

use std::f64::consts::TAU;

use super::NumpyRng;

/// Steps of a block.
const BLOCK: usize = 1 << 12;

/// Gaussian noise of some numbers whose power is `f^-exponent`, of deviation 1.
///
/// Each block has the spectrum exactly, in expectation; blocks are independent. Between a frequency of two in 1,024 steps and one of a
/// quarter of the steps, series of any length have the exponent within 0.02 (0 to 2).
#[derive(Clone, Debug)]
pub(crate) struct ColoredNoise {
    exponent: f64,
    seed: u64,
    /// Step of the next sample.
    step: u64,
    len: usize,
    /// The numbers of the last sample's block, (BLOCK, len).
    values: Vec<f32>,
    /// Amplitudes by frequency, roots of unity of half the circle, and a buffer: later blocks allocate nothing.
    amplitudes: Vec<f64>,
    turns: Vec<[f64; 2]>,
    spectrum: Vec<[f64; 2]>,
}

impl ColoredNoise {
    /// Creates the noise of `len` numbers.
    pub fn new(exponent: f64, len: usize, seed: u64) -> Self {
        Self {
            exponent,
            seed,
            step: 0,
            len,
            values: Vec::new(),
            amplitudes: Vec::new(),
            turns: Vec::new(),
            spectrum: Vec::new(),
        }
    }

    /// Continues a noise from a position.
    pub fn at(exponent: f64, len: usize, seed: u64, step: u64) -> Self {
        Self {
            step,
            ..Self::new(exponent, len, seed)
        }
    }

    /// Returns the seed and the step of the next numbers, from which [`ColoredNoise::at`] continues.
    pub fn position(&self) -> [u64; 2] {
        [self.seed, self.step]
    }

    /// Returns its memory, bytes.
    pub fn memory(&self) -> usize {
        size_of_val(self.values.as_slice())
    }

    /// Returns the numbers of the next step.
    pub fn next_values(&mut self) -> &[f32] {
        let place = (self.step % BLOCK as u64) as usize;
        if place == 0 || self.values.is_empty() {
            self.make();
        }
        self.step += 1;
        &self.values[place * self.len..(place + 1) * self.len]
    }

    /// Computes the tables that all blocks share.
    fn prepare(&mut self) {
        self.amplitudes = (0..BLOCK)
            .map(|k| match k.min(BLOCK - k) {
                0 => 0.0,
                frequency => pxfm::f_exp(-0.5 * self.exponent * pxfm::f_log(frequency as f64)),
            })
            .collect();
        // the power of both parts is 1
        let power = self.amplitudes.iter().map(|a| a * a).sum::<f64>();
        self.amplitudes.iter_mut().for_each(|a| *a /= power.sqrt());
        self.turns = turns(BLOCK);
        self.spectrum = vec![[0.0; 2]; BLOCK];
    }

    /// Makes the block of the next sample: its spectrum has random phases and amplitudes. Real and imaginary parts are two series.
    fn make(&mut self) {
        // blocks are a function of seed and number, so that any step can be found again
        let mut rng = NumpyRng::seed(
            self.seed
                .wrapping_add((self.step / BLOCK as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)),
        );
        if self.amplitudes.is_empty() {
            self.prepare();
        }
        self.values.resize(BLOCK * self.len, 0.0);
        for first in (0..self.len).step_by(2) {
            for (z, amplitude) in self.spectrum.iter_mut().zip(&self.amplitudes) {
                *z = [amplitude * rng.normal(), amplitude * rng.normal()];
            }
            transform(&mut self.spectrum, &self.turns);
            for (row, z) in self.values.chunks_exact_mut(self.len).zip(&self.spectrum) {
                for (value, part) in row[first..].iter_mut().zip(z) {
                    *value = *part as f32;
                }
            }
        }
    }
}

/// Returns the roots of unity of half the circle for transforms of a length.
fn turns(length: usize) -> Vec<[f64; 2]> {
    let turn = |k| pxfm::f_sincos(TAU * k as f64 / length as f64);
    (0..length / 2).map(turn).map(|(sin, cos)| [cos, sin]).collect()
}

/// Returns the Fourier transform of a series whose length is a power of two, up to the conjugate.
#[cfg(any(test, all(feature = "eval", feature = "npz")))]
pub(crate) fn fourier(series: &[f64]) -> Vec<[f64; 2]> {
    let turns = turns(series.len());
    let mut z: Vec<[f64; 2]> = series.iter().map(|x| [*x, 0.0]).collect();
    transform(&mut z, &turns);
    z
}

/// Fourier transform in place, for a length that is a power of two (J. W. Cooley and J. W. Tukey, 1965). `turns` are the roots of unity of
/// half the circle.
fn transform(z: &mut [[f64; 2]], turns: &[[f64; 2]]) {
    let n = z.len();
    let bits = n.trailing_zeros();
    for k in 0..n {
        let other = k.reverse_bits() >> (usize::BITS - bits);
        if other > k {
            z.swap(k, other);
        }
    }
    let mut half = 1;
    while half < n {
        let stride = n / (2 * half);
        for group in z.chunks_exact_mut(2 * half) {
            let (low, high) = group.split_at_mut(half);
            for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let [cos, sin] = turns[k * stride];
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                (*b, *a) = (
                    [a[0] - turned[0], a[1] - turned[1]],
                    [a[0] + turned[0], a[1] + turned[1]],
                );
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_has_one_frequency() {
        let turns = turns(16);
        let mut z: Vec<[f64; 2]> = (0..16)
            .map(|k| pxfm::f_sincos(TAU * 3.0 * f64::from(k) / 16.0))
            .map(|(s, c)| [c, s])
            .collect();
        transform(&mut z, &turns);
        for (k, [re, im]) in z.into_iter().enumerate() {
            // the sign of the exponent is that of the inverse transform
            let expect = if k == 13 { 16.0 } else { 0.0 };
            assert!((re - expect).abs() < 1e-12 && im.abs() < 1e-12, "{k}: {re} {im}");
        }
    }
}
