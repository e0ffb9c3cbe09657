//! Stands in for libFuzzer where targets are checked and not run.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

/// Checks the types of a target, as the macro of libfuzzer-sys would.
#[macro_export]
macro_rules! fuzz_target {
    (init: $init:expr, |$data:ident: &[u8]| $target:expr $(,)?) => {
        const _: fn() = || $init;
        const _: fn(&[u8]) = |$data| $target;
    };
    (|$data:ident: &[u8]| $target:expr $(,)?) => {
        const _: fn(&[u8]) = |$data| $target;
    };
}
