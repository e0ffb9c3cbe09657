//! Pictures in files.

mod read;

use std::path::{Path, PathBuf};

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder as _, ImageError};
use thiserror::Error;

use crate::files::replace_file;

pub(crate) use read::{decode_png, is_opaque};

/// An error in writing a picture.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The file system refuses.
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
        source: ImageError,
    },
}

/// Writes a PNG picture, as a whole: red, green and blue of each pixel, rows from the top.
///
/// # Errors
/// Errors of the file system; bytes that are not `3 * width * height`.
pub fn write_png(path: impl AsRef<Path>, rgb: &[u8], width: usize, height: usize) -> Result<(), PictureError> {
    let file = path.as_ref();
    let path = || file.to_path_buf();
    let bytes = png(rgb, width, height, ExtendedColorType::Rgb8);
    let bytes = bytes.map_err(|source| PictureError::Encode { path: path(), source })?;
    replace_file(file, &bytes).map_err(|source| PictureError::Io { path: path(), source })
}

/// Encodes a PNG picture in memory.
pub(crate) fn png(pixels: &[u8], width: usize, height: usize, color: ExtendedColorType) -> Result<Vec<u8>, ImageError> {
    use image::error::{ParameterError, ParameterErrorKind};
    let misfit = || ImageError::Parameter(ParameterError::from_kind(ParameterErrorKind::DimensionMismatch));
    let side = |n: usize| u32::try_from(n).map_err(|_| misfit());
    let (width, height) = (side(width)?, side(height)?);
    // the encoder panics where the length does not fit
    let needed = (u64::from(width) * u64::from(height)).checked_mul(u64::from(color.bits_per_pixel() / 8));
    if needed != Some(pixels.len() as u64) {
        return Err(misfit());
    }
    let mut out = Vec::new();
    PngEncoder::new(&mut out).write_image(pixels, width, height, color)?;
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
        let back = image::open(&path).expect("a picture").to_rgb8();
        assert_eq!((back.dimensions(), back.as_raw()), ((4, 3), &rgb));
        for (width, height) in [(4, 4), (0, 0), (usize::MAX, 1), (1 << 31, 1 << 31)] {
            assert!(write_png(folder.join("b.png"), &rgb, width, height).is_err());
        }
        let error = write_png(folder.join("none/c.png"), &rgb, 4, 3).expect_err("no such folder");
        assert!(error.to_string().contains("c.png"), "{error}");
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);
        std::fs::remove_dir_all(&folder).expect("the folder was made");
    }
}
