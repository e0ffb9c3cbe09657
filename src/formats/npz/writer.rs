//! Archives, written.

use super::NpzError;
use super::header::{self, DIMENSIONS};
use crate::files::replace_file;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

/// 1980-01-01, the first day a zip archive can name, as NumPy writes it.
const EPOCH: i64 = 315_532_800;

mod sealed {
    pub trait Sealed {
        const DTYPE: &'static str;
        fn extend(self, bytes: &mut Vec<u8>);
    }
}

/// Marks a type of number that [`NpzWriter::add`] takes: `f64`, `f32`, `i32`, `i64`, `u8`.
pub trait Element: Copy + sealed::Sealed {}

macro_rules! element {
    ($($type:ty = $dtype:literal),*) => {$(
        impl sealed::Sealed for $type {
            const DTYPE: &'static str = $dtype;
            fn extend(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
        impl Element for $type {}
    )*};
}

element!(f64 = "<f8", f32 = "<f4", i32 = "<i4", i64 = "<i8", u8 = "|u1");

/// Collects arrays into an archive, deflated and without time stamps.
#[derive(Debug)]
pub struct NpzWriter {
    archive: ZipArchiveWriter<Vec<u8>>,
    names: BTreeSet<String>,
}

impl Default for NpzWriter {
    fn default() -> Self {
        Self::new()
    }
}

impl NpzWriter {
    /// Creates an archive without arrays.
    pub fn new() -> Self {
        Self {
            archive: ZipArchiveWriter::new(Vec::new()),
            names: BTreeSet::new(),
        }
    }

    /// Adds an array in row-major order; shape `&[]` is a single number.
    ///
    /// # Errors
    /// When the shape does not match the data, or the name was used before or is not a plain name.
    pub fn add<T: Element>(&mut self, name: &str, shape: &[usize], data: &[T]) -> Result<(), NpzError> {
        let refused = |reason: String| NpzError::Write {
            array: name.to_string(),
            reason,
        };
        if name.is_empty() || name.len() > 1000 || name.contains(|c: char| c.is_control() || "/\\".contains(c)) {
            return Err(refused(
                "a name must have 1 to 1000 bytes, without slashes or control characters".to_string(),
            ));
        }
        let count = shape
            .iter()
            .try_fold(1_usize, |count, length| count.checked_mul(*length));
        if count != Some(data.len()) || shape.len() > DIMENSIONS {
            return Err(refused(format!(
                "{} numbers do not have the shape {shape:?}",
                data.len()
            )));
        }
        if !self.names.insert(name.to_string()) {
            return Err(refused("this name is already used".to_string()));
        }
        self.deflate(name, &header::write(T::DTYPE, shape), data)
            .map_err(|error| refused(error.to_string()))
    }

    fn deflate<T: Element>(&mut self, name: &str, header: &[u8], data: &[T]) -> Result<(), rawzip::Error> {
        let path = format!("{name}.npy");
        let builder = self
            .archive
            .new_file(path.as_str())
            .compression_method(CompressionMethod::DEFLATE)
            .last_modified(UtcDateTime::from_unix(EPOCH));
        let (mut entry, config) = builder.start()?;
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        writer.write_all(header)?;
        let mut bytes = Vec::new();
        for chunk in data.chunks(4096) {
            bytes.clear();
            chunk.iter().for_each(|number| number.extend(&mut bytes));
            writer.write_all(&bytes)?;
        }
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)?;
        Ok(())
    }

    /// Returns the archive's bytes.
    ///
    /// # Errors
    /// When the archive is larger than its format allows.
    pub fn finish(self) -> Result<Vec<u8>, NpzError> {
        self.archive.finish().map_err(|error| NpzError::Write {
            array: String::new(),
            reason: error.to_string(),
        })
    }

    /// Writes the archive to `path`, which holds either its old content or the whole archive, never a part.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(self, path: impl AsRef<Path>) -> Result<(), NpzError> {
        let path = path.as_ref();
        let bytes = self.finish()?;
        replace_file(path, &bytes).map_err(|source| NpzError::Io {
            file: path.display().to_string(),
            source,
        })
    }
}
