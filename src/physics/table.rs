//! Structs of arrays, each defined by a table: [`State`](super::State) and [`Params`](super::Params).
//!
//! A row is a field. From it follow the struct, its first value, copies that keep their memory, the check that it fits the
//! model, and what a snapshot holds of it:
//!
//! ```text
//! dynamic {                                            // what decides how a run goes on: copied and in snapshots
//!     pub qvel: [f64; model.nv] finite = 0.0;          // a vector of that length, each element with this value;
//!                                                      // `finite`: the engine refuses NaN and infinity
//!     pub qpos: [f64; model.nq] finite => model.qpos0.clone();   // the whole vector
//!     pub torque: [f64; maybe model.nu()] finite;      // empty at first; then empty or of that length
//!     pub act: [f64; any];                             // empty at first, unless a value follows; its length is another's business
//!     pub time: (f64) = 0.0;                           // a value of that type
//! }
//! computed { .. }                                      // what every step computes anew
//! ```
//!
//! A row that `dynamic` gains, loses or moves changes the bytes of snapshots: their `VERSION` goes up with it.

use crate::error::EngineError;

/// A row, or a struct of rows, for snapshots: its numbers and flags, in order.
pub trait Row {
    /// Appends the numbers.
    fn numbers<'a>(&'a self, _: &mut Vec<&'a [f64]>) {}

    /// Appends the numbers, to be written.
    fn numbers_mut<'a>(&'a mut self, _: &mut Vec<&'a mut [f64]>) {}

    /// Appends the flags.
    fn flags<'a>(&'a self, _: &mut Vec<&'a [bool]>) {}

    /// Appends the flags, to be written.
    fn flags_mut<'a>(&'a mut self, _: &mut Vec<&'a mut [bool]>) {}
}

/// A row that consists of numbers.
pub(super) trait Numbers {
    fn flat(&self) -> &[f64];

    fn flat_mut(&mut self) -> &mut [f64];
}

impl Numbers for f64 {
    fn flat(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn flat(&self) -> &[f64] {
        self
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self
    }
}

impl Numbers for Vec<f64> {
    fn flat(&self) -> &[f64] {
        self
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self
    }
}

impl<const N: usize> Numbers for Vec<[f64; N]> {
    fn flat(&self) -> &[f64] {
        self.as_flattened()
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self.as_flattened_mut()
    }
}

impl<T: Numbers> Row for T {
    fn numbers<'a>(&'a self, out: &mut Vec<&'a [f64]>) {
        out.push(self.flat());
    }

    fn numbers_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [f64]>) {
        out.push(self.flat_mut());
    }
}

impl Row for Vec<bool> {
    fn flags<'a>(&'a self, out: &mut Vec<&'a [bool]>) {
        out.push(self);
    }

    fn flags_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [bool]>) {
        out.push(self);
    }
}

/// Counters are not part of the snapshot's numbers or flags.
impl Row for u64 {}

/// Checks the length of a vector.
#[inline]
pub(super) fn length(what: &'static str, found: usize, expected: usize) -> Result<(), EngineError> {
    if found == expected {
        Ok(())
    } else {
        Err(EngineError::Shape { what, found, expected })
    }
}

/// Checks that numbers are finite.
#[inline]
pub(super) fn finite(what: &'static str, row: &impl Numbers) -> Result<(), EngineError> {
    let values = row.flat();
    // all at once and without branches, as numbers are nearly always finite: this runs in every step
    if values.iter().fold(true, |all, v| all & (v.abs() <= f64::MAX)) {
        return Ok(());
    }
    match values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        Some((index, &value)) => Err(EngineError::NotFinite { what, index, value }),
        None => Ok(()),
    }
}

macro_rules! table {
    (
        |$($arg:ident: $of:ty),+|
        $(#[$meta:meta])*
        pub struct $name:ident, $prefix:literal;
        dynamic {$(
            $(#[$doc:meta])* $vis:vis $field:ident: $kind:tt $($finite:ident)? $(= $each:expr)? $(=> $all:expr)?;
        )*}
        computed {$(
            $(#[$cdoc:meta])* $cvis:vis $cfield:ident: $ckind:tt $(= $ceach:expr)? $(=> $call:expr)?;
        )*}
    ) => {
        $(#[$meta])*
        pub struct $name {
            $($(#[$doc])* $vis $field: $crate::table::row_type!($kind),)*
            $($(#[$cdoc])* $cvis $cfield: $crate::table::row_type!($ckind),)*
        }

        impl Clone for $name {
            fn clone(&self) -> Self {
                Self {
                    $($field: self.$field.clone(),)*
                    $($cfield: self.$cfield.clone(),)*
                }
            }

            /// Reuses memory, so that copying between values of one model allocates nothing.
            fn clone_from(&mut self, other: &Self) {
                self.copy_dynamic(other);
                $(self.$cfield.clone_from(&other.$cfield);)*
            }
        }

        impl $name {
            fn first($($arg: $of),+) -> Self {
                Self {
                    $($field: $crate::table::row_first!($kind $(, = $each)? $(, => $all)?),)*
                    $($cfield: $crate::table::row_first!($ckind $(, = $ceach)? $(, => $call)?),)*
                }
            }

            fn copy_dynamic(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)*
            }

            /// Exchanges the dynamic fields without copying numbers.
            #[allow(dead_code, reason = "not every table is taken apart")]
            pub fn swap_dynamic(&mut self, other: &mut Self) {
                $(std::mem::swap(&mut self.$field, &mut other.$field);)*
            }

            /// Frees the memory of the fields that every step recomputes.
            #[allow(dead_code, reason = "not every table is taken apart")]
            pub fn drop_computed(&mut self) {
                $(self.$cfield = Default::default();)*
            }

            /// Checks the lengths of all vectors.
            pub fn fits(&self $(, $arg: $of)+) -> Result<(), $crate::EngineError> {
                $($crate::table::row_fits!(concat!($prefix, stringify!($field)), self.$field, $kind);)*
                $($crate::table::row_fits!(concat!($prefix, stringify!($cfield)), self.$cfield, $ckind);)*
                Ok(())
            }

            /// Checks that the inputs of a step are finite.
            pub fn finite(&self) -> Result<(), $crate::EngineError> {
                $($($crate::table::$finite(concat!($prefix, stringify!($field)), &self.$field)?;)?)*
                Ok(())
            }
        }

        /// The dynamic fields: they determine the rest of a run.
        impl $crate::table::Row for $name {
            fn numbers<'a>(&'a self, out: &mut Vec<&'a [f64]>) {
                $($crate::table::Row::numbers(&self.$field, out);)*
            }

            fn numbers_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [f64]>) {
                $($crate::table::Row::numbers_mut(&mut self.$field, out);)*
            }

            fn flags<'a>(&'a self, out: &mut Vec<&'a [bool]>) {
                $($crate::table::Row::flags(&self.$field, out);)*
            }

            fn flags_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [bool]>) {
                $($crate::table::Row::flags_mut(&mut self.$field, out);)*
            }
        }
    };
}

/// The type of a row.
macro_rules! row_type {
    ([$element:ty; $($len:tt)+]) => { Vec<$element> };
    (($type:ty)) => { $type };
}

/// The first value of a row.
macro_rules! row_first {
    ([$element:ty; $($len:tt)+]) => {
        Vec::new()
    };
    ([$element:ty; $len:expr], = $each:expr) => {
        vec![$each; $len]
    };
    ([$element:ty; $($len:tt)+], => $all:expr) => {
        $all
    };
    (($type:ty), = $value:expr) => {
        $value
    };
}

/// The check of the length of a row, which returns the error.
macro_rules! row_fits {
    ($what:expr, $value:expr, [$element:ty; any]) => {};
    ($what:expr, $value:expr, [$element:ty; maybe $len:expr]) => {
        if !$value.is_empty() {
            $crate::table::length($what, $value.len(), $len)?;
        }
    };
    ($what:expr, $value:expr, [$element:ty; $len:expr]) => {
        $crate::table::length($what, $value.len(), $len)?;
    };
    ($what:expr, $value:expr, ($type:ty)) => {};
}

pub(super) use {row_first, row_fits, row_type, table};
