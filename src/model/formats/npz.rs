//! NumPy's `.npz` archives, read and written without Python.
//!
//! Reading trusts nothing: a size is checked against what the file holds before it is used, and no array may take more
//! than [`Limits::npz_array_bytes`](crate::Limits::npz_array_bytes). Writing is deterministic: the same arrays in the same order give the same bytes.
//!
//! ```
//! use mjcf_sim::formats::npz::{Npz, NpzWriter};
//!
//! let mut writer = NpzWriter::new();
//! writer.add("qpos", &[2, 3], &[0.0, 0.5, 1.0, 1.5, 2.0, 2.5])?;
//! writer.add("steps", &[2], &[1_i64, 2])?;
//! let npz = Npz::from_bytes(writer.finish()?, "log.npz")?;
//! assert_eq!(npz.get_f64("qpos")?.shape, [2, 3]);
//! assert_eq!(npz.get_i64("steps")?.data, [1, 2]);
//! # Ok::<(), mjcf_sim::formats::npz::NpzError>(())
//! ```
//!
//! Formats: `numpy.lib.format` (versions 1 to 3) inside a zip archive, stored or deflated.

mod half;
mod header;
mod reader;
mod writer;

#[cfg(test)]
mod tests;

pub use half::Half;
pub use reader::Npz;
pub use writer::{Element, NpzWriter, Packing};

use std::io;

use crate::text::quoted;

/// An error in reading or writing an archive; every message names the file and the array.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NpzError {
    /// The file cannot be read or written.
    #[error("{file}: {source}")]
    Io {
        /// The file.
        file: String,
        /// The error of the file system.
        source: io::Error,
    },
    /// The file is not an archive, or is damaged.
    #[error("{file}: not a readable npz archive: {reason}")]
    Archive {
        /// The file.
        file: String,
        /// Description of the fault.
        reason: String,
    },
    /// The archive has no such array.
    #[error("{file}: has no array `{}`", quoted(.array))]
    Missing {
        /// The file.
        file: String,
        /// The requested array.
        array: String,
    },
    /// The array is damaged, too large or of an unsupported kind.
    #[error("{file}: array `{}`: {}", quoted(.array), quoted(.reason))]
    Array {
        /// The file.
        file: String,
        /// The array.
        array: String,
        /// Description of the fault.
        reason: String,
    },
    /// The array's numbers do not fit the requested type.
    #[error("{file}: array `{}` of {} cannot be read as {wanted}", quoted(.array), quoted(.dtype))]
    Type {
        /// The file.
        file: String,
        /// The array.
        array: String,
        /// NumPy's description of its type.
        dtype: String,
        /// The requested type.
        wanted: &'static str,
    },
    /// The array cannot be added to an archive.
    #[error("cannot write array `{array}`: {reason}")]
    Write {
        /// The array.
        array: String,
        /// Description of the fault.
        reason: String,
    },
}

/// An array in row-major order, of shape `()` for a single number.
#[derive(Clone, Debug, PartialEq)]
pub struct Array<T> {
    /// The length of each dimension.
    pub shape: Vec<usize>,
    /// The numbers; the last dimension varies fastest.
    pub data: Vec<T>,
}

/// An array of an archive, described before it is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArrayInfo {
    /// Its name, without `.npy`.
    pub name: String,
    /// The length of each dimension.
    pub shape: Vec<usize>,
    /// NumPy's description of its type, such as `<f8`.
    pub dtype: String,
}
