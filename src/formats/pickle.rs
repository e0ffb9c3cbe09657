//! The part of Python's pickles that logs need: numbers, text, lists, dictionaries and NumPy arrays of numbers.
//!
//! Written is protocol 4, which Python 3.4 and later read; arrays become real `numpy.ndarray` of `float64` under NumPy 1
//! and 2. [`from_bytes`] understands the few opcodes of protocols 2 to 5 that such objects need and five named
//! constructors, none of which is ever looked up or called; everything else is an error. Memory is bounded by a multiple
//! of the size of the file, and what a file shares stays shared.
//!
//! ```
//! use babybench::formats::pickle::{self, Value};
//!
//! let record = Value::dict([("touches", Value::list([3, 7].map(Value::Int))), ("steps", Value::Int(20))]);
//! let bytes = pickle::to_bytes(&record)?;
//! let back = pickle::from_bytes(&bytes)?;
//! assert_eq!(back.get("steps"), Some(&Value::Int(20)));
//! # Ok::<(), babybench::formats::pickle::PickleError>(())
//! ```

mod construct;
mod machine;
mod memo;
mod numbers;
mod objects;
mod records;
mod stack;
#[cfg(test)]
mod tests;
mod unfold;
mod writer;

use std::sync::Arc;

pub use machine::{from_bytes, from_bytes_with};
pub(crate) use records::{PickleKind, RecordNode, visit_records};
use thiserror::Error;
pub use writer::to_bytes;
pub(crate) use writer::{DictWriter, ListWriter};

use crate::text::quoted;

/// An error in reading or writing a pickle.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PickleError {
    /// It ends too early.
    #[error("byte {at}: the pickle ends too early; it was cut off or is still being written")]
    Truncated {
        /// Where it ends.
        at: usize,
    },
    /// An opcode that logs do not use.
    #[error("byte {at}: opcode {opcode:#04x} is not supported: only what logs need is read")]
    Opcode {
        /// Where it stands.
        at: usize,
        /// The opcode.
        opcode: u8,
    },
    /// A class or function that logs do not use. It was not looked up.
    #[error("byte {at}: {} is not supported: only what logs need is read", quoted(.name))]
    Global {
        /// Where it stands.
        at: usize,
        /// Module and name.
        name: String,
    },
    /// Opcodes and operands that do not fit together.
    #[error("byte {at}: not a pickle of a log: {reason}")]
    Malformed {
        /// Where.
        at: usize,
        /// Description of the fault.
        reason: &'static str,
    },
    /// Something that is larger than allowed.
    #[error("more than {limit} {what}")]
    Limit {
        /// The kind of item that exceeds the limit.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
}

/// An array of numbers in row-major order.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Length of each dimension; none for a single number.
    pub shape: Vec<usize>,
    /// The numbers; the last dimension varies fastest.
    pub data: Vec<f64>,
}

/// A Python object. Cloning is cheap: lists, dictionaries and arrays are shared.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `None`.
    None,
    /// `True` or `False`.
    Bool(bool),
    /// An integer, also a NumPy one.
    Int(i64),
    /// A float, also a NumPy one.
    Float(f64),
    /// Text.
    Text(Arc<str>),
    /// A list; a tuple is read as a list.
    List(Arc<Vec<Value>>),
    /// A dictionary with text keys, in order of insertion.
    Dict(Arc<Vec<(Arc<str>, Value)>>),
    /// A NumPy array; written as `float64`, read from any type of real numbers.
    Array(Arc<Array>),
}

impl Value {
    /// Creates a list.
    pub fn list(items: impl IntoIterator<Item = Value>) -> Self {
        Self::List(Arc::new(items.into_iter().collect()))
    }

    /// Creates a dictionary.
    pub fn dict<'a>(items: impl IntoIterator<Item = (&'a str, Value)>) -> Self {
        Self::Dict(Arc::new(items.into_iter().map(|(k, v)| (k.into(), v)).collect()))
    }

    /// Returns the value of a key of a dictionary.
    pub fn get(&self, key: &str) -> Option<&Value> {
        match self {
            Self::Dict(items) => items.iter().rev().find(|(k, _)| &**k == key).map(|(_, v)| v),
            _ => None,
        }
    }

    /// Returns the items of a list.
    pub fn items(&self) -> Option<&[Value]> {
        match self {
            Self::List(items) => Some(items),
            _ => None,
        }
    }

    /// Returns a whole number that is not negative.
    pub fn count(&self) -> Option<u64> {
        match *self {
            Self::Int(i) => u64::try_from(i).ok(),
            _ => None,
        }
    }
}
