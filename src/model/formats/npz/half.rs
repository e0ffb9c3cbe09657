//! The 16-bit numbers of IEEE 754: 11 bits of precision, up to 65504.

/// A 16-bit number, NumPy's `float16`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Half(u16);

impl Half {
    /// Rounds to the nearest number of 16 bits, ties to even. Numbers that are too large become infinite.
    pub fn new(value: f32) -> Self {
        let bits = value.to_bits();
        let sign = (bits >> 16 & 0x8000) as u16;
        let (exponent, fraction) = ((bits >> 23 & 0xff) as i32 - 127, bits & 0x7f_ffff);
        let magnitude = match exponent {
            128 => 0x7c00 | if fraction == 0 { 0 } else { 0x200 },
            16.. => 0x7c00,
            // a carry out of the fraction goes into the exponent, as it should
            -14.. => rounded(((exponent + 15) as u32) << 23 | fraction, 13),
            -25.. => rounded(fraction | 0x80_0000, (-exponent - 1) as u32),
            _ => 0,
        };
        Self(sign | magnitude)
    }

    /// Returns the number with these bits.
    pub fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// Returns the bits.
    pub fn to_bits(self) -> u16 {
        self.0
    }

    /// Returns the number, exactly.
    pub fn to_f64(self) -> f64 {
        let (exponent, fraction) = (self.0 >> 10 & 0x1f, f64::from(self.0 & 0x3ff));
        let magnitude = match exponent {
            0 => fraction / 16_777_216.0,
            31 if fraction == 0.0 => f64::INFINITY,
            31 => f64::NAN,
            _ => f64::from_bits(u64::from(exponent + 1008) << 52) * (1.0 + fraction / 1024.0),
        };
        if self.0 & 0x8000 == 0 { magnitude } else { -magnitude }
    }
}

/// Drops the lowest bits, rounding to the nearest, ties to even.
fn rounded(bits: u32, dropped: u32) -> u16 {
    let (kept, rest, half) = (bits >> dropped, bits & ((1 << dropped) - 1), 1 << (dropped - 1));
    let up = rest > half || rest == half && kept & 1 == 1;
    (kept + u32::from(up)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_is_what_it_says() {
        for bits in 0..=u16::MAX {
            let half = Half::from_bits(bits);
            let value = half.to_f64();
            if value.is_nan() {
                assert!(Half::new(value as f32).to_f64().is_nan());
            } else {
                assert_eq!(Half::new(value as f32), half, "{bits:#x}");
            }
        }
    }

    #[test]
    fn rounding_is_to_the_nearest_and_to_even() {
        for (value, expected) in [
            (1.0 + 1.0 / 2048.0, 1.0),
            (1.0 + 3.0 / 2048.0, 1.0 + 2.0 / 1024.0),
            (65519.0, 65504.0),
            (65520.0, f64::INFINITY),
            (-0.1, -0.099_975_585_937_5),
            (2.0_f32.powi(-25), 0.0),
            (1.5 * 2.0_f32.powi(-25), 2.0_f64.powi(-24)),
        ] {
            assert_eq!(Half::new(value).to_f64(), expected, "{value}");
        }
    }
}
