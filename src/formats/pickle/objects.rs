//! The entries of a pickle's stack.

use std::borrow::Cow;
use std::sync::Arc;

use super::Array;
use super::numbers::Dtype;

/// An entry of the stack: small values themselves, others by their number.
#[derive(Clone, Copy, Debug)]
pub(super) enum StackItem {
    None,
    Bool(bool),
    Int(i64),
    Float(f64),
    Object(usize),
}

/// A value that the stack refers to.
#[derive(Debug)]
pub(super) enum PickleObject<'a> {
    Text(&'a str),
    Bytes(Cow<'a, [u8]>),
    List(Vec<StackItem>),
    Tuple(Vec<StackItem>),
    Dict(Vec<(StackItem, StackItem)>),
    Callable(Callable),
    Dtype(Dtype),
    /// `None` until its state is known.
    Array(Option<Arc<Array>>),
}

/// The constructors that logs name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callable {
    Reconstruct,
    Frombuffer,
    Ndarray,
    Dtype,
    Scalar,
    Encode,
}

impl Callable {
    /// Returns the constructor of a module and a name.
    pub fn named(module: &str, name: &str) -> Option<Self> {
        Some(match (module, name) {
            ("numpy.core.multiarray" | "numpy._core.multiarray", "_reconstruct") => Self::Reconstruct,
            ("numpy.core.numeric" | "numpy._core.numeric", "_frombuffer") => Self::Frombuffer,
            ("numpy.core.multiarray" | "numpy._core.multiarray", "scalar") => Self::Scalar,
            ("numpy", "ndarray") => Self::Ndarray,
            ("numpy", "dtype") => Self::Dtype,
            // how protocol 2 writes bytes
            ("_codecs", "encode") => Self::Encode,
            _ => return None,
        })
    }
}
