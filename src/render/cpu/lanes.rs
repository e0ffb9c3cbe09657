//! Arrays of three and four elements built without a loop (`array::map` with a closure that may panic is a call for each
//! array, which costs more than the work itself), and lane operations that are cheaper because they know more about the numbers than `wide` can
//! assume.

use wide::bytemuck::cast;
use wide::{f32x4, i32x4};

/// Makes three elements from their indices.
#[inline(always)]
pub fn three<T>(mut of: impl FnMut(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// Makes four elements from their indices.
#[inline(always)]
pub fn four<T>(mut of: impl FnMut(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}

/// Returns `v` where it is above `low`, which must be a number, and `low` elsewhere, including where `v` is NaN.
///
/// [`f32x4::max`] checks both sides for NaN, which takes five more instructions. The instructions here have a defined result
/// for NaN on one side.
#[inline(always)]
pub fn at_least(v: f32x4, low: f32x4) -> f32x4 {
    if cfg!(target_arch = "wasm32") {
        // the first, unless the second is greater
        low.fast_max(v)
    } else if cfg!(all(target_arch = "x86_64", target_feature = "sse")) {
        // the second, unless the first is greater
        v.fast_max(low)
    } else {
        v.max(low)
    }
}

/// Converts whole numbers between -2^22 and 2^22. For other inputs the result depends on the platform.
///
/// WebAssembly's own conversion saturates, which x86 has to emulate with seven instructions.
#[inline(always)]
pub fn integers(v: f32x4) -> i32x4 {
    if cfg!(target_arch = "wasm32") {
        // the last bits of a sum with 1.5 * 2^23 are the other summand
        cast::<_, i32x4>(v + 12_582_912.0) - i32x4::splat(0x4b40_0000)
    } else {
        v.fast_trunc_int()
    }
}

/// Rounds down numbers between 0 and 2^20 that are whole quarters.
#[inline(always)]
pub fn rounded_down(quarters: f32x4) -> i32x4 {
    if cfg!(target_arch = "wasm32") {
        // this makes the nearest integer the one below
        integers(quarters - 0.375)
    } else {
        quarters.fast_trunc_int()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_the_least() {
        let of = |v: f32, low: f32| at_least(f32x4::splat(v), f32x4::splat(low)).to_array()[3];
        for (v, low, expected) in [
            (2.0, 0.0, 2.0),
            (-2.0, 0.0, 0.0),
            (-2.0, -1.0, -1.0),
            (f32::NAN, 0.0, 0.0),
            (f32::NAN, -1.0, -1.0),
            (f32::INFINITY, 0.0, f32::INFINITY),
            (f32::NEG_INFINITY, -1.0, -1.0),
        ] {
            assert_eq!(of(v, low), expected, "{v} {low}");
        }
        assert!(of(-0.0, 0.0).is_sign_positive());
    }

    #[test]
    fn whole_numbers_are_integers() {
        for v in [0, 1, -1, 2, 255, -256, 65_535, 1 << 20, (1 << 22) - 1, 1 - (1 << 22)] {
            assert_eq!(integers(f32x4::splat(v as f32)).to_array(), [v; 4]);
        }
        for quarters in 0..1024 {
            let v = f32x4::splat(quarters as f32 * 0.25);
            assert_eq!(rounded_down(v).to_array(), [quarters / 4; 4]);
        }
    }
}
