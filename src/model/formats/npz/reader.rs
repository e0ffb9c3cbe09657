//! Archives, read.

use super::header::{self, Number};
use super::{Array, ArrayInfo, NpzError};
use crate::files;
use crate::limits::Limits;
use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

/// An archive in memory. Arrays are inflated when they are read.
#[derive(Debug)]
pub struct Npz {
    file: String,
    archive: ZipSliceArchive<Vec<u8>>,
    entries: Vec<Entry>,
    /// Bytes of an array in memory.
    array_bytes: usize,
}

#[derive(Debug)]
struct Entry {
    info: ArrayInfo,
    fortran_order: bool,
    header_bytes: usize,
    deflated: bool,
    place: ZipArchiveEntryWayfinder,
}

impl Npz {
    /// Reads the archive at `path`.
    ///
    /// # Errors
    /// When the file cannot be read, or as [`Npz::from_bytes`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, NpzError> {
        Self::open_with(path, &Limits::DEFAULT)
    }

    /// Reads the archive at `path` within the given limits.
    ///
    /// # Errors
    /// As [`Npz::open`].
    pub fn open_with(path: impl AsRef<Path>, limits: &Limits) -> Result<Self, NpzError> {
        let file = path.as_ref().display().to_string();
        match files::read(path.as_ref(), limits.npz_bytes) {
            Ok(bytes) => Self::from_bytes_with(bytes, &file, limits),
            Err(e) if e.kind() == std::io::ErrorKind::FileTooLarge => Err(NpzError::Archive {
                file,
                reason: format!("more than {} bytes", limits.npz_bytes),
            }),
            Err(source) => Err(NpzError::Io { file, source }),
        }
    }

    /// Reads an archive from memory; `file_name` only names it in errors.
    ///
    /// # Errors
    /// When the bytes are not an archive, or the header of an array is damaged.
    pub fn from_bytes(bytes: Vec<u8>, file_name: &str) -> Result<Self, NpzError> {
        Self::from_bytes_with(bytes, file_name, &Limits::DEFAULT)
    }

    /// Reads an archive from memory, as [`Npz::from_bytes`] does, within the given limits.
    ///
    /// # Errors
    /// As [`Npz::from_bytes`].
    pub fn from_bytes_with(bytes: Vec<u8>, file_name: &str, limits: &Limits) -> Result<Self, NpzError> {
        let broken = |reason: String| NpzError::Archive {
            file: file_name.to_string(),
            reason,
        };
        let archive = ZipArchive::from_slice(bytes)
            .map_err(|error| broken(format!("{error} (it is truncated or of another format)")))?;
        let mut entries: Vec<Entry> = Vec::new();
        let mut names = BTreeSet::new();
        let mut records = archive.entries();
        while let Some(record) = records.next_entry().map_err(|error| broken(error.to_string()))? {
            let path = String::from_utf8_lossy(record.file_path().as_bytes()).into_owned();
            // NumPy keeps arrays under `NAME.npy`; anything else in the archive is not one.
            let Some(name) = path.strip_suffix(".npy") else {
                continue;
            };
            let damaged = |reason: &str| NpzError::Array {
                file: file_name.to_string(),
                array: name.chars().take(100).collect(),
                reason: reason.to_string(),
            };
            let deflated = match record.compression_method() {
                _ if record.flags().is_encrypted() => return Err(damaged("encrypted")),
                CompressionMethod::STORE => false,
                CompressionMethod::DEFLATE => true,
                _ => return Err(damaged("compressed with a method other than deflate")),
            };
            if !names.insert(name.to_string()) {
                return Err(damaged("stored twice"));
            }
            if entries.len() >= limits.npz_arrays {
                return Err(broken(format!("more than {} arrays", limits.npz_arrays)));
            }
            let place = record.wayfinder();
            let data = archive.get_entry(place).map_err(|error| damaged(&error.to_string()))?;
            let header = header::read(inflate(data.data(), deflated), limits.npz_header_bytes)
                .map_err(|reason| damaged(&reason))?;
            let width = header::decoder(&header.dtype).map_or(1, |(width, _)| width);
            check_shape(&header.shape, width, limits.npz_array_bytes).map_err(|reason| damaged(&reason))?;
            let info = ArrayInfo {
                name: name.to_string(),
                shape: header.shape,
                dtype: header.dtype,
            };
            let (fortran_order, header_bytes) = (header.fortran_order, header.bytes);
            entries.push(Entry {
                info,
                fortran_order,
                header_bytes,
                deflated,
                place,
            });
        }
        Ok(Self {
            file: file_name.to_string(),
            archive,
            entries,
            array_bytes: limits.npz_array_bytes,
        })
    }

    /// Lists every array, in the order of the archive.
    pub fn arrays(&self) -> impl Iterator<Item = &ArrayInfo> {
        self.entries.iter().map(|entry| &entry.info)
    }

    /// Reads an array's numbers as `f64`: any float or integer type, provided that every number is represented exactly.
    ///
    /// # Errors
    /// When there is no such array, its data are damaged, or a number does not fit.
    pub fn get_f64(&self, name: &str) -> Result<Array<f64>, NpzError> {
        self.get(name, "f64", |number| match number {
            Number::Float(value) => Some(value),
            Number::Int(value) => (value as f64 as i128 == value).then_some(value as f64),
        })
    }

    /// Reads an array's numbers as `i64`: any integer type or boolean.
    ///
    /// # Errors
    /// As [`Npz::get_f64`].
    pub fn get_i64(&self, name: &str) -> Result<Array<i64>, NpzError> {
        self.get(name, "i64", |number| match number {
            Number::Int(value) => i64::try_from(value).ok(),
            Number::Float(_) => None,
        })
    }

    /// Reads an array's numbers as `u8`: any integer type or boolean whose numbers are from 0 to 255.
    ///
    /// # Errors
    /// As [`Npz::get_f64`].
    pub fn get_u8(&self, name: &str) -> Result<Array<u8>, NpzError> {
        self.get(name, "u8", |number| match number {
            Number::Int(value) => u8::try_from(value).ok(),
            Number::Float(_) => None,
        })
    }

    /// Reads an array's texts: those of NumPy's types `<U...` and `|S...`.
    ///
    /// # Errors
    /// As [`Npz::get_f64`]; an array of another type, texts that are not Unicode.
    pub fn get_text(&self, name: &str) -> Result<Array<String>, NpzError> {
        let file = || self.file.clone();
        let Some(entry) = self.entries.iter().find(|entry| entry.info.name == name) else {
            return Err(NpzError::Missing {
                file: file(),
                array: name.to_string(),
            });
        };
        let ArrayInfo { shape, dtype, .. } = &entry.info;
        let wanted = || NpzError::Type {
            file: file(),
            array: name.to_string(),
            dtype: dtype.clone(),
            wanted: "text",
        };
        let (width, of) = header::text(dtype).ok_or_else(wanted)?;
        // a text of no characters takes room, too
        let bytes = self.bytes(entry, width, width + size_of::<String>());
        let bytes = bytes.map_err(|reason| NpzError::Array {
            file: file(),
            array: name.to_string(),
            reason,
        })?;
        let count = shape.iter().product::<usize>();
        let texts = (0..count).map(|k| text(&bytes[k * width..(k + 1) * width], of));
        let data: Option<Vec<String>> = texts.collect();
        let data = data.ok_or_else(wanted)?;
        Ok(Array {
            data: if entry.fortran_order {
                row_major(&data, shape)
            } else {
                data
            },
            shape: shape.clone(),
        })
    }

    fn get<T: Copy>(
        &self,
        name: &str,
        wanted: &'static str,
        convert: impl Fn(Number) -> Option<T>,
    ) -> Result<Array<T>, NpzError> {
        let file = || self.file.clone();
        let Some(entry) = self.entries.iter().find(|entry| entry.info.name == name) else {
            return Err(NpzError::Missing {
                file: file(),
                array: name.to_string(),
            });
        };
        let damaged = |reason: String| NpzError::Array {
            file: file(),
            array: name.to_string(),
            reason,
        };
        let ArrayInfo { shape, dtype, .. } = &entry.info;
        let Some((width, number)) = header::decoder(dtype) else {
            return Err(damaged(format!("numbers of type {dtype} are not supported")));
        };
        let bytes = self.bytes(entry, width, width.max(size_of::<T>())).map_err(damaged)?;
        let data: Option<Vec<T>> = bytes.chunks_exact(width).map(|chunk| convert(number(chunk))).collect();
        let Some(data) = data else {
            return Err(NpzError::Type {
                file: file(),
                array: name.to_string(),
                dtype: dtype.clone(),
                wanted,
            });
        };
        let data = if entry.fortran_order {
            row_major(&data, shape)
        } else {
            data
        };
        Ok(Array {
            shape: shape.clone(),
            data,
        })
    }

    /// Returns the bytes of an array after its header: `width` per number, which become at most `widest` in memory.
    fn bytes(&self, entry: &Entry, width: usize, widest: usize) -> Result<Vec<u8>, String> {
        let shape = &entry.info.shape;
        check_shape(shape, widest, self.array_bytes)?;
        let size = width * shape.iter().product::<usize>();
        let data = self.archive.get_entry(entry.place).map_err(|error| error.to_string())?;
        // One byte more than expected, so that surplus shows and the checksum is reached; memory grows with the data.
        let expected = entry.header_bytes + size;
        let mut bytes = Vec::new();
        let reader = data.verifying_reader(inflate(data.data(), entry.deflated));
        reader
            .take(expected as u64 + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| error.to_string())?;
        if bytes.len() != expected {
            let relation = if bytes.len() < expected { "fewer" } else { "more" };
            return Err(format!("holds {relation} than the {size} bytes of its shape {shape:?}"));
        }
        bytes.drain(..entry.header_bytes);
        Ok(bytes)
    }
}

/// Decodes a NumPy text, which ends where only zeros follow.
fn text(bytes: &[u8], of: usize) -> Option<String> {
    if of == 1 {
        let end = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
        return String::from_utf8(bytes[..end].to_vec()).ok();
    }
    let (codes, _) = bytes.as_chunks::<4>();
    let decoded: Option<String> = codes
        .iter()
        .map(|code| char::from_u32(u32::from_le_bytes(*code)))
        .collect();
    decoded.map(|text| text.trim_end_matches('\0').to_string())
}

/// Checks that an array of this shape and number of bytes per value is within a limit; each dimension counts, even if another is 0.
fn check_shape(shape: &[usize], width: usize, limit: usize) -> Result<(), String> {
    let mut lengths = shape.iter().map(|length| (*length).max(1));
    let bytes = lengths.try_fold(width, |bytes: usize, length| bytes.checked_mul(length));
    if bytes.is_some_and(|bytes| bytes <= limit) {
        Ok(())
    } else {
        Err(format!("shape {shape:?} needs more than {limit} bytes"))
    }
}

fn inflate(data: &[u8], deflated: bool) -> Box<dyn Read + '_> {
    if deflated {
        Box::new(DeflateDecoder::new(data))
    } else {
        Box::new(data)
    }
}

/// Converts column-major data to row-major order.
fn row_major<T: Clone>(data: &[T], shape: &[usize]) -> Vec<T> {
    let mut strides = vec![1; shape.len()];
    for i in 1..shape.len() {
        strides[i] = strides[i - 1] * shape[i - 1];
    }
    let mut index = vec![0; shape.len()];
    let mut out = Vec::with_capacity(data.len());
    for _ in 0..data.len() {
        out.push(data[index.iter().zip(&strides).map(|(i, stride)| i * stride).sum::<usize>()].clone());
        for (i, length) in index.iter_mut().zip(shape).rev() {
            *i += 1;
            if *i < *length {
                break;
            }
            *i = 0;
        }
    }
    out
}
