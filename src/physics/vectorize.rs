//! The instruction set for which the hot parts of a step are compiled.

/// Runs `work` with the vector instructions that the processor supports: AVX2, or else those of every processor of the target.
///
/// Code that is inlined into `work` is compiled once for each, so hot functions are `#[inline(always)]` down to their kernels,
/// and `work` is a closure with the same attribute. The bits are those of any other target: the compiler neither reorders
/// sums nor fuses products with them.
#[inline(always)]
pub fn vectorize<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = fearless_simd::Level::new().as_avx2() {
        return fearless_simd::Simd::vectorize(avx2, work);
    }
    work()
}

/// Evaluates an expression with [`vectorize`]. It borrows the fields that it names, one by one.
macro_rules! vectorized {
    ($work:expr) => {
        $crate::vectorize::vectorize(
            #[inline(always)]
            || $work,
        )
    };
}

pub(crate) use vectorized;
