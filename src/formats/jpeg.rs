//! JPEG pictures.

use std::io::{self, Write};

use jpeg_encoder::{Encoder, EncodingError, ImageBuffer, JpegColorType, SamplingFactor, rgb_to_ycbcr};

/// A picture: red, green and blue of each pixel, rows from the top. The encoder's own entry for raw bytes would compile a copy of it for each of nine colour types.
struct Rgb<'a> {
    bytes: &'a [u8],
    width: u16,
    height: u16,
}

impl ImageBuffer for Rgb<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        JpegColorType::Ycbcr
    }

    fn width(&self) -> u16 {
        self.width
    }

    fn height(&self) -> u16 {
        self.height
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        let row = 3 * usize::from(self.width);
        let line = self.bytes.chunks_exact(row).nth(usize::from(y)).unwrap_or_default();
        for pixel in line.chunks_exact(3) {
            let (luma, blue, red) = rgb_to_ycbcr(pixel[0], pixel[1], pixel[2]);
            buffers[0].push(luma);
            buffers[1].push(blue);
            buffers[2].push(red);
        }
    }
}

/// The resolution of colours in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorResolution {
    /// That of brightness (4:4:4).
    Full,
    /// One sample for two by two pixels below quality 90 (4:2:0), full resolution from 90.
    ByQuality,
}

/// Appends a JPEG picture to `out`: red, green and blue of each pixel, rows from the top (height, width, 3); `quality` is from 1 to 100.
///
/// # Errors
/// A side of 0, or `rgb` of another size.
pub fn write_jpeg(
    out: &mut Vec<u8>,
    rgb: &[u8],
    [width, height]: [u16; 2],
    quality: u8,
    colors: ColorResolution,
) -> io::Result<()> {
    let expected = 3 * usize::from(width) * usize::from(height);
    if rgb.len() != expected {
        let found = rgb.len();
        let message = format!("the picture has {found} bytes but {width} x {height} pixels have {expected}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    // a trait object, so that no caller compiles the encoder again
    let mut encoder = Encoder::new(out as &mut dyn Write, quality.clamp(1, 100));
    if colors == ColorResolution::Full {
        encoder.set_sampling_factor(SamplingFactor::R_4_4_4);
    }
    let image = Rgb {
        bytes: rgb,
        width,
        height,
    };
    encoder.encode_image(image).map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use jpeg_encoder::ColorType;

    use super::*;

    #[test]
    fn bytes_are_those_of_the_encoder() -> Result<(), EncodingError> {
        let rgb: Vec<u8> = (0..3 * 21 * 13).map(|k: u32| (k * k / 7) as u8).collect();
        for quality in [88, 92] {
            let mut expected = Vec::new();
            Encoder::new(&mut expected, quality).encode(&rgb, 21, 13, ColorType::Rgb)?;
            let mut found = Vec::new();
            write_jpeg(&mut found, &rgb, [21, 13], quality, ColorResolution::ByQuality)?;
            assert_eq!(found, expected);
        }
        Ok(())
    }

    #[test]
    fn pictures_of_another_size_are_refused() {
        for size in [[2, 2], [0, 1], [1, 0]] {
            let found = write_jpeg(&mut Vec::new(), &[0; 3], size, 90, ColorResolution::Full);
            assert!(found.is_err(), "{size:?}");
        }
        let empty = write_jpeg(&mut Vec::new(), &[], [0, 1], 90, ColorResolution::Full);
        assert!(empty.is_err());
    }
}
