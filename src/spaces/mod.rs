//! Action and observation spaces, as in Gymnasium.

mod noise;
mod normal;
mod rng;
mod spectrum;
mod values;

pub use noise::{ActionNoise, Noise, NoiseError};
pub(crate) use noise::{INFANT_EXPONENT, INFANT_WEEKS};
pub use rng::NumpyRng;
pub(crate) use spectrum::ColoredNoise;
#[cfg(all(feature = "eval", feature = "npz"))]
pub(crate) use spectrum::fourier;
pub(crate) use values::Number;
pub use values::Values;
pub use values::{Array, ValuesMut};

/// A box of single-precision vectors with separate bounds for each component.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxSpace {
    low: Vec<f32>,
    high: Vec<f32>,
}

impl BoxSpace {
    /// Creates a space from bounds of equal length; if one is longer, its excess components are dropped.
    pub fn new(mut low: Vec<f32>, mut high: Vec<f32>) -> Self {
        let n = low.len().min(high.len());
        low.truncate(n);
        high.truncate(n);
        Self { low, high }
    }

    /// Returns the number of components.
    pub fn len(&self) -> usize {
        self.low.len()
    }

    /// Returns whether there are no components.
    pub fn is_empty(&self) -> bool {
        self.low.is_empty()
    }

    /// Returns the lower bounds.
    pub fn low(&self) -> &[f32] {
        &self.low
    }

    /// Returns the upper bounds.
    pub fn high(&self) -> &[f32] {
        &self.high
    }

    /// Returns whether `x` has the right length and is within the bounds.
    pub fn contains(&self, x: &[f32]) -> bool {
        x.len() == self.len()
            && x.iter()
                .zip(&self.low)
                .zip(&self.high)
                .all(|((x, lo), hi)| lo <= x && x <= hi)
    }

    /// Clips `x` to the bounds of component `i`; returns it unchanged if the component does not exist.
    pub fn clip(&self, i: usize, x: f32) -> f32 {
        match (self.low.get(i), self.high.get(i)) {
            (Some(low), Some(high)) => x.max(*low).min(*high),
            _ => x,
        }
    }

    /// Fills `out` with a uniform sample, the same that Gymnasium's `Box.sample` draws from the same generator.
    pub fn sample(&self, rng: &mut NumpyRng, out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.low.iter().zip(&self.high).map(|(&lo, &hi)| {
            let (lo, hi) = (f64::from(lo), f64::from(hi));
            (lo + (hi - lo) * rng.uniform()) as f32
        }));
    }
}

/// The number type of an observation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dtype {
    /// 64-bit float.
    F64,
    /// 32-bit float.
    F32,
    /// 8-bit unsigned integer.
    U8,
    /// 32-bit integer.
    I32,
}

impl Dtype {
    /// Returns NumPy's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F64 => "float64",
            Self::F32 => "float32",
            Self::U8 => "uint8",
            Self::I32 => "int32",
        }
    }

    /// Returns the size of a number, bytes.
    pub const fn bytes(self) -> usize {
        match self {
            Self::F64 => 8,
            Self::F32 | Self::I32 => 4,
            Self::U8 => 1,
        }
    }
}

/// The shape and bounds of one entry of the observation.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservationSpace {
    /// Key in the observation: one of those of [`ObservationEntry`](crate::sensors::ObservationEntry).
    pub key: &'static str,
    /// Shape.
    pub shape: Vec<usize>,
    /// Number type.
    pub dtype: Dtype,
    /// Lower bound of every number.
    pub low: f64,
    /// Upper bound of every number.
    pub high: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_equal_those_of_gymnasium() {
        let space = BoxSpace::new(vec![-1.0, -0.6875, -1.0], vec![0.765, 1.0, 0.64]);
        let mut rng = NumpyRng::seed(0);
        let mut x = Vec::new();
        for expect in [
            [0.124_237_366_f32, -0.23223493, -0.9328034],
            [-0.9708287, 0.68489355, 0.49691913],
        ] {
            space.sample(&mut rng, &mut x);
            assert_eq!(x, expect);
            assert!(space.contains(&x));
        }
        let space = BoxSpace::new(vec![-1.0; 4], vec![1.0; 4]);
        space.sample(&mut NumpyRng::seed(42), &mut x);
        assert_eq!(x, [0.5479121, -0.122_243_12, 0.71719587, 0.394_736_05]);
    }
}
