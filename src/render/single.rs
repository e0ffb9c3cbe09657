//! Rounding to single precision, in which MuJoCo draws.

/// Rounds numbers to single precision.
pub(super) fn single<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}
