//! Heights on a grid in files: PNG pictures, and MuJoCo's binary format.

use super::png::decode_png;
use crate::limits::Limits;

/// The format of a file with heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeightFormat {
    /// A picture, of which the red channel is used.
    Png,
    /// Numbers of rows and columns, then numbers in single precision.
    Custom,
}

impl HeightFormat {
    /// Returns the format for the extension of a file's name.
    pub fn of_path(path: &str) -> Self {
        let png = path
            .rsplit_once('.')
            .is_some_and(|(_, ending)| ending.eq_ignore_ascii_case("png"));
        if png { Self::Png } else { Self::Custom }
    }

    /// Returns the format of a content type.
    pub fn of_content(content_type: &str) -> Option<Self> {
        match content_type {
            "image/png" => Some(Self::Png),
            "image/vnd.mujoco.hfield" => Some(Self::Custom),
            _ => None,
        }
    }
}

/// Heights on a grid, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Number of rows.
    pub nrow: usize,
    /// Number of columns.
    pub ncol: usize,
    /// Heights, from the last row of a picture to its first.
    pub data: Vec<f32>,
}

/// Bytes of the header of MuJoCo's format.
const HEADER: usize = 8;

impl Heights {
    /// Reads a file.
    ///
    /// # Errors
    /// Bytes that are not such a file, numbers that are not finite, more numbers than [`Limits::mesh_elements`]; what is wrong, without
    /// the name of the file.
    pub fn read(bytes: &[u8], format: HeightFormat, limits: &Limits) -> Result<Self, String> {
        match format {
            HeightFormat::Png => picture(bytes, limits),
            HeightFormat::Custom => custom(bytes, limits),
        }
    }

    /// Checks a number of heights before memory is allocated for them.
    pub fn check_count(count: usize, limits: &Limits) -> Result<(), String> {
        let most = limits.mesh_elements;
        if count > most {
            return Err(format!("more than {most} heights"));
        }
        Ok(())
    }
}

fn picture(bytes: &[u8], limits: &Limits) -> Result<Heights, String> {
    // the depth of a picture follows its name and size
    if bytes.get(24) == Some(&16) {
        return Err("pictures of 16 bits lose half of them in MuJoCo; give 8 bits, or MuJoCo's own format".to_owned());
    }
    let picture = decode_png(bytes, limits)?;
    let (ncol, nrow) = (picture.width, picture.height);
    Heights::check_count(nrow.saturating_mul(ncol), limits)?;
    let rows = picture.rgb.chunks_exact(3 * ncol).rev();
    let data = rows
        .flat_map(|row| row.chunks_exact(3).map(|pixel| f32::from(pixel[0])))
        .collect();
    Ok(Heights { nrow, ncol, data })
}

fn custom(bytes: &[u8], limits: &Limits) -> Result<Heights, String> {
    let (words, _) = bytes.as_chunks::<4>();
    let [rows, columns, heights @ ..] = words else {
        return Err(format!("the file has {} bytes, too few for a header", bytes.len()));
    };
    let (rows, columns) = (i32::from_le_bytes(*rows), i32::from_le_bytes(*columns));
    if rows < 1 || columns < 1 {
        return Err(format!("the header announces {rows} rows and {columns} columns"));
    }
    let count = u64::from(rows.unsigned_abs()) * u64::from(columns.unsigned_abs());
    let expected = HEADER as u64 + 4 * count;
    if expected != bytes.len() as u64 {
        let found = bytes.len();
        return Err(format!(
            "the file has {found} bytes where its header asks for {expected}"
        ));
    }
    // as many as there are words in the file
    Heights::check_count(heights.len(), limits)?;
    let data: Vec<f32> = heights.iter().map(|word| f32::from_le_bytes(*word)).collect();
    match data.iter().position(|v| !v.is_finite()) {
        Some(place) => Err(format!("height {place} is not a finite number")),
        None => Ok(Heights {
            nrow: rows as usize,
            ncol: columns as usize,
            data,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::png::{ColorType, png};

    fn read(bytes: &[u8], format: HeightFormat) -> Result<Heights, String> {
        Heights::read(bytes, format, &Limits::DEFAULT)
    }

    #[test]
    fn pictures_begin_at_their_last_row() {
        let bytes = png(&[0, 10, 20, 30, 40, 100], 3, 2, ColorType::Grayscale).expect("a picture");
        let heights = read(&bytes, HeightFormat::Png).expect("valid");
        assert_eq!((heights.nrow, heights.ncol), (2, 3));
        assert_eq!(heights.data, [30.0, 40.0, 100.0, 0.0, 10.0, 20.0]);
        assert!(read(&bytes[..20], HeightFormat::Png).is_err());
        let mut deep = bytes;
        deep[24] = 16; // the depth of its samples
        assert!(read(&deep, HeightFormat::Png).expect_err("16 bits").contains("16 bits"));
    }

    #[test]
    fn the_custom_format_has_what_its_header_says() {
        let file = |rows: i32, columns: i32, heights: &[f32]| {
            let header = [rows, columns].into_iter().flat_map(i32::to_le_bytes);
            header
                .chain(heights.iter().flat_map(|v| v.to_le_bytes()))
                .collect::<Vec<u8>>()
        };
        let good = file(2, 2, &[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(
            read(&good, HeightFormat::Custom).expect("valid").data,
            [1.0, 2.0, 3.0, 4.0]
        );
        for cut in 0..good.len() {
            assert!(read(&good[..cut], HeightFormat::Custom).is_err(), "{cut}");
        }
        for (bytes, part) in [
            (file(-2, 2, &[]), "-2 rows"),
            (file(i32::MAX, i32::MAX, &[]), "asks for"),
            (file(1, 1, &[f32::NAN]), "not a finite number"),
        ] {
            let error = read(&bytes, HeightFormat::Custom).expect_err(part);
            assert!(error.contains(part), "{error}");
        }
    }
}
