//! Sine and cosine.

/// The polynomials below are valid up to this angle, rad.
const SMALL: f64 = 0.049;
/// Coefficients of `sin(x) - x` and `cos(x) - 1`, of the powers 3, 5, 7, 9 and 2, 4, 6, 8: Taylor's, whose next terms are less than 2^-54
/// of the first up to [`SMALL`].
const SIN: [f64; 4] = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0];
const COS: [f64; 4] = [-0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0];

/// Returns sine and cosine of an angle (rad), correctly rounded as those of `pxfm`.
///
/// Joints that are held are turned by a thousandth of a radian or less. There `pxfm` nearly always finds the error bound of its fast way too
/// wide and computes the sine with twice the digits. The difference between sine and angle is so small that its error leaves the rounding in doubt
/// a few times in a million.
#[inline(always)]
pub fn sincos(x: f64) -> (f64, f64) {
    if x.abs() < SMALL && x != 0.0 {
        let x2 = x * x;
        let rest = |c: &[f64; 4]| c[0] + x2 * (c[1] + x2 * (c[2] + x2 * c[3]));
        if let (Some(sin), Some(cos)) = (rounded(x, x * (x2 * rest(&SIN))), rounded(1.0, x2 * rest(&COS))) {
            return (sin, cos);
        }
    }
    pxfm::f_sincos(x)
}

/// Returns the sum of a number and a much smaller one with an error of some units in its last place, if the error cannot change how the
/// sum is rounded (Ziv's test).
#[inline(always)]
fn rounded(large: f64, small: f64) -> Option<f64> {
    // the sum is `high + low` exactly
    let high = large + small;
    let low = (large - high) + small;
    let error = small.abs() * (8.0 * f64::EPSILON);
    let (above, below) = (high + (low + error), high + (low - error));
    (above == below).then_some(above)
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::Rng;

    use super::*;

    #[test]
    fn angles_of_every_size_have_the_sine_and_cosine_of_pxfm() {
        let mut generator = Pcg64::new(1, 2);
        let mut fast = 0;
        const N: u32 = 1_000_000;
        for _ in 0..N {
            let word = generator.next_u64();
            // between 2^-40 and 1 rad, of either sign
            let mantissa = 1.0 + (word >> 12) as f64 / (1_u64 << 52) as f64;
            let x = mantissa * 0.5_f64.powi(1 + (word % 40) as i32) * if word & 64 == 0 { 1.0 } else { -1.0 };
            let (expect, found) = (pxfm::f_sincos(x), sincos(x));
            assert_eq!(
                (found.0.to_bits(), found.1.to_bits()),
                (expect.0.to_bits(), expect.1.to_bits()),
                "{x:e}"
            );
            fast += u32::from(x.abs() < SMALL);
        }
        assert!(fast > N / 2, "most are small: {fast}");
        for x in [
            0.0,
            -0.0,
            f64::MIN_POSITIVE,
            -5e-324,
            1e-160,
            SMALL,
            -SMALL,
            1e300,
            f64::INFINITY,
            f64::NAN,
        ] {
            let (expect, found) = (pxfm::f_sincos(x), sincos(x));
            assert_eq!(
                (found.0.to_bits(), found.1.to_bits()),
                (expect.0.to_bits(), expect.1.to_bits()),
                "{x:e}"
            );
        }
    }
}
