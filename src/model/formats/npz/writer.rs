//! Archives, written.

use super::header::{self, DIMENSIONS};
use super::{Half, NpzError};
use crate::files::replace_file;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

/// 1980-01-01, the earliest date of a zip archive, which NumPy also writes.
const EPOCH: i64 = 315_532_800;

mod sealed {
    pub trait Sealed {
        const DTYPE: &'static str;
        fn extend(self, bytes: &mut Vec<u8>);
    }
}

/// A type of number that [`NpzWriter::add`] accepts: `f64`, `f32`, `i32`, `i64`, `u16`, `u8`, [`Half`].
pub trait Element: Copy + sealed::Sealed {
    /// Returns NumPy's name of the type.
    fn dtype() -> &'static str {
        Self::DTYPE
    }
}

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

element!(
    f64 = "<f8",
    f32 = "<f4",
    i32 = "<i4",
    i64 = "<i8",
    u16 = "<u2",
    u8 = "|u1"
);

impl sealed::Sealed for Half {
    const DTYPE: &'static str = "<f2";
    fn extend(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_bits().to_le_bytes());
    }
}
impl Element for Half {}

/// The storage of an array in an archive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// Deflated as much as possible.
    Small,
    /// Deflated quickly.
    Fast,
    /// Not compressed: measured numbers barely shrink.
    Stored,
}

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
        self.add_packed(name, shape, data, Packing::Small)
    }

    /// Adds an array as [`NpzWriter::add`] does, with compression chosen by the caller.
    ///
    /// # Errors
    /// As [`NpzWriter::add`].
    pub fn add_packed<T: Element>(
        &mut self,
        name: &str,
        shape: &[usize],
        data: &[T],
        packing: Packing,
    ) -> Result<(), NpzError> {
        let refused = |reason: String| NpzError::Write {
            array: name.to_string(),
            reason,
        };
        let count = shape
            .iter()
            .try_fold(1_usize, |count, length| count.checked_mul(*length));
        if count != Some(data.len()) || shape.len() > DIMENSIONS {
            return Err(refused(format!(
                "{} numbers do not have the shape {shape:?}",
                data.len()
            )));
        }
        self.name(name)?;
        self.pack(name, &header::write(T::DTYPE, shape), data, packing)
            .map_err(|error| refused(error.to_string()))
    }

    /// Adds an array of texts, shape (texts), as NumPy's `<U...`.
    ///
    /// # Errors
    /// As [`NpzWriter::add`].
    pub fn add_text(&mut self, name: &str, texts: &[String]) -> Result<(), NpzError> {
        let length = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        let mut codes = Vec::with_capacity(length * texts.len());
        for text in texts {
            let end = codes.len() + length;
            codes.extend(text.chars().map(|c| u32::from(c) as i32));
            codes.resize(end, 0);
        }
        self.name(name)?;
        let header = header::write(&format!("<U{length}"), &[texts.len()]);
        self.pack(name, &header, &codes, Packing::Small)
            .map_err(|error| NpzError::Write {
                array: name.to_string(),
                reason: error.to_string(),
            })
    }

    /// Reserves a name that was not used before.
    fn name(&mut self, name: &str) -> Result<(), NpzError> {
        let refused = |reason: &str| NpzError::Write {
            array: name.to_string(),
            reason: reason.to_string(),
        };
        if name.is_empty() || name.len() > 1000 || name.contains(|c: char| c.is_control() || "/\\".contains(c)) {
            return Err(refused(
                "a name must have 1 to 1000 bytes, without slashes or control characters",
            ));
        }
        if !self.names.insert(name.to_string()) {
            return Err(refused("this name is already used"));
        }
        Ok(())
    }

    fn pack<T: Element>(
        &mut self,
        name: &str,
        header: &[u8],
        data: &[T],
        packing: Packing,
    ) -> Result<(), rawzip::Error> {
        let path = format!("{name}.npy");
        let (method, level) = match packing {
            Packing::Small => (CompressionMethod::DEFLATE, Compression::default()),
            Packing::Fast => (CompressionMethod::DEFLATE, Compression::fast()),
            Packing::Stored => (CompressionMethod::STORE, Compression::none()),
        };
        let builder = self
            .archive
            .new_file(path.as_str())
            .compression_method(method)
            .last_modified(UtcDateTime::from_unix(EPOCH));
        let (mut entry, config) = builder.start()?;
        let descriptor = if packing == Packing::Stored {
            let mut writer = config.wrap(&mut entry);
            write_numbers(&mut writer, header, data)?;
            writer.finish()?.1
        } else {
            let mut writer = config.wrap(DeflateEncoder::new(&mut entry, level));
            write_numbers(&mut writer, header, data)?;
            let (encoder, descriptor) = writer.finish()?;
            encoder.finish()?;
            descriptor
        };
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

/// Writes the header of an array and its numbers.
fn write_numbers<T: Element>(writer: &mut impl Write, header: &[u8], data: &[T]) -> std::io::Result<()> {
    writer.write_all(header)?;
    let mut bytes = Vec::new();
    for chunk in data.chunks(4096) {
        bytes.clear();
        chunk.iter().for_each(|number| number.extend(&mut bytes));
        writer.write_all(&bytes)?;
    }
    Ok(())
}
