//! Pictures in files.

mod read;

use std::path::{Path, PathBuf};

use ::png::{BitDepth, Compression, Encoder, EncodingError};
use thiserror::Error;

use crate::files::replace_file;

pub use ::png::ColorType;
pub use read::{Picture, check_png, decode_png, is_opaque};

/// An error in writing a picture.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The file system returned an error.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The pixels are not a picture of this size.
    #[error("{}: {source}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Description of the fault.
        source: PngError,
    },
}

/// An error in encoding a picture.
#[derive(Debug, Error)]
pub enum PngError {
    /// The pixels are not a picture of this size.
    #[error("{found} bytes are not a picture of {width} x {height} pixels, each of {channels} bytes")]
    Size {
        /// Number of bytes.
        found: usize,
        /// Requested width, pixels.
        width: usize,
        /// Requested height, pixels.
        height: usize,
        /// Bytes of a pixel.
        channels: usize,
    },
    /// The encoder fails.
    #[error(transparent)]
    Encoder(#[from] EncodingError),
}

/// Writes a PNG picture, replacing an existing file as a whole: red, green and blue of each pixel, rows from the top.
///
/// # Errors
/// Errors of the file system; bytes that are not `3 * width * height`.
pub fn write_png(path: impl AsRef<Path>, rgb: &[u8], width: usize, height: usize) -> Result<(), PictureError> {
    let file = path.as_ref();
    let path = || file.to_path_buf();
    let bytes = png(rgb, width, height, ColorType::Rgb);
    let bytes = bytes.map_err(|source| PictureError::Encode { path: path(), source })?;
    replace_file(file, &bytes).map_err(|source| PictureError::Io { path: path(), source })
}

/// Encodes a PNG picture of 8 bits a channel in memory; rows from the top.
///
/// # Errors
/// A side of 0 or of more than `u32` holds; bytes that are not width times height pixels.
pub fn png(pixels: &[u8], width: usize, height: usize, color: ColorType) -> Result<Vec<u8>, PngError> {
    let channels = color.samples();
    let misfit = || PngError::Size {
        found: pixels.len(),
        width,
        height,
        channels,
    };
    let side = |n: usize| u32::try_from(n).map_err(|_| misfit());
    let (w, h) = (side(width)?, side(height)?);
    let needed = (u64::from(w) * u64::from(h)).checked_mul(channels as u64);
    if needed != Some(pixels.len() as u64) {
        return Err(misfit());
    }
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, w, h);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_whole_or_not_there() {
        let folder = std::env::temp_dir().join(format!("babybench_picture_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("a.png");
        let rgb: Vec<u8> = (0..36).collect();
        write_png(&path, &rgb, 4, 3).expect("a picture");
        let bytes = std::fs::read(&path).expect("a file");
        let back = decode_png(&bytes, &crate::Limits::DEFAULT).expect("a picture");
        assert_eq!((back.width, back.height, &back.rgb), (4, 3, &rgb));
        for (width, height) in [(4, 4), (0, 0), (usize::MAX, 1), (1 << 31, 1 << 31)] {
            assert!(write_png(folder.join("b.png"), &rgb, width, height).is_err());
        }
        let error = write_png(folder.join("none/c.png"), &rgb, 4, 3).expect_err("no such folder");
        assert!(error.to_string().contains("c.png"), "{error}");
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
