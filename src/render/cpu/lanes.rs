//! Arrays of a few elements, made without a loop. (`array::map` of closures that may panic is a call for each array, which
//! costs more than what is done here.)

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
