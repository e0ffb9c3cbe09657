//! libccd's comparisons of numbers.

/// The greatest number that libccd treats as zero (`CCD_EPS`).
pub(super) const EPS: f64 = f64::EPSILON;

/// Returns whether a number is zero up to rounding errors.
#[inline(always)]
pub(super) fn is_zero(x: f64) -> bool {
    x.abs() < EPS
}

/// Returns whether two numbers are equal up to rounding errors.
pub(super) fn equal(a: f64, b: f64) -> bool {
    let apart = (a - b).abs();
    let greater = if b.abs() > a.abs() { b.abs() } else { a.abs() };
    apart < EPS || apart < EPS * greater
}
