//! NumPy's types of numbers, and bytes in them.

use super::Array;

/// Types of real numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NumberKind {
    Float,
    Signed,
    Unsigned,
    Bool,
}

/// A NumPy type of real numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dtype {
    kind: NumberKind,
    size: usize,
    pub big_endian: bool,
}

/// Greatest length of a dimension of an array without numbers.
const EMPTY: usize = 1 << 24;

impl Dtype {
    /// Returns the type with NumPy's short name, such as `f8`.
    pub fn named(name: &str) -> Option<Self> {
        let (kind, size) = match name {
            "f8" => (NumberKind::Float, 8),
            "f4" => (NumberKind::Float, 4),
            "i8" => (NumberKind::Signed, 8),
            "i4" => (NumberKind::Signed, 4),
            "i2" => (NumberKind::Signed, 2),
            "i1" => (NumberKind::Signed, 1),
            "u8" => (NumberKind::Unsigned, 8),
            "u4" => (NumberKind::Unsigned, 4),
            "u2" => (NumberKind::Unsigned, 2),
            "u1" => (NumberKind::Unsigned, 1),
            "b1" => (NumberKind::Bool, 1),
            _ => return None,
        };
        Some(Self {
            kind,
            size,
            big_endian: false,
        })
    }

    /// Decodes a number. Integers beyond 2^53 lose digits here, but not in [`Dtype::integer`].
    fn number(self, bytes: &[u8]) -> f64 {
        match (self.kind, bytes) {
            (NumberKind::Float, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (NumberKind::Float, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => self.integer(bytes) as f64,
        }
    }

    /// Decodes an integer; floats have none.
    fn integer(self, bytes: &[u8]) -> i128 {
        let unsigned = bytes.iter().rev().fold(0_i128, |n, &b| n << 8 | i128::from(b));
        let sign_bit = 1_i128 << (8 * self.size - 1);
        match self.kind {
            NumberKind::Signed if unsigned & sign_bit != 0 => unsigned - 2 * sign_bit,
            NumberKind::Bool => i128::from(unsigned != 0),
            _ => unsigned,
        }
    }

    /// Decodes a single number that fits `i64`, if this is a type of integers.
    pub fn scalar_integer(self, bytes: &[u8]) -> Option<i64> {
        let whole = self.kind != NumberKind::Float && !self.big_endian && bytes.len() == self.size;
        whole.then(|| i64::try_from(self.integer(bytes)).ok()).flatten()
    }

    /// Returns the number of values in some bytes.
    pub fn count(self, bytes: &[u8]) -> usize {
        bytes.len() / self.size
    }

    /// Decodes an array; `fortran` means that the first dimension varies fastest.
    pub fn array(self, bytes: &[u8], shape: Vec<usize>, fortran: bool) -> Result<Array, &'static str> {
        if self.big_endian {
            return Err("big-endian numbers are not supported");
        }
        if fortran && shape.len() > 1 {
            return Err("arrays in column order are not supported");
        }
        let length = shape.iter().try_fold(self.size, |n, &k| n.checked_mul(k));
        // an array of nothing has no other length that would mean anything
        let empty_but_long = bytes.is_empty() && shape.iter().any(|&k| k > EMPTY);
        if length != Some(bytes.len()) || empty_but_long {
            return Err("an array's data does not fit its shape");
        }
        let data = bytes.chunks_exact(self.size).map(|b| self.number(b)).collect();
        Ok(Array { shape, data })
    }
}
