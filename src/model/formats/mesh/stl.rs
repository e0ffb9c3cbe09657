//! Binary STL: a header of 80 bytes, the number of triangles, 50 bytes for each.

use super::{MeshError, Triangles, floats, word};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;
/// Maximum number of triangles that MuJoCo accepts.
const MOST: u32 = 200_000;
/// The largest coordinate that MuJoCo accepts, 2^30.
const LARGEST: f32 = 1_073_741_824.0;

/// Returns the number of triangles, their size with the header in bytes, and the size of the file, which must be equal.
fn sizes(bytes: &[u8]) -> Result<(usize, u64, u64), MeshError> {
    let count = word(bytes, HEADER - 4).ok_or(MeshError::Header(bytes.len()))?;
    if count == 0 || count > MOST {
        return Err(MeshError::Triangles(count));
    }
    let expected = HEADER as u64 + TRIANGLE as u64 * u64::from(count);
    let found = bytes.len() as u64;
    if expected != found {
        return Err(MeshError::Length { expected, found });
    }
    Ok((count as usize, expected, found))
}

/// Reads a file; vertices at the same place become one, the first of them.
pub(super) fn read(bytes: &[u8], lefthanded: bool, most: usize) -> Result<Triangles, MeshError> {
    // headers of binary files may begin so, too, but then all else fits
    let (count, expected, found) = sizes(bytes).map_err(|error| {
        let text = bytes.starts_with(b"solid");
        if text { MeshError::TextStl } else { error }
    })?;
    if 4 * count > most {
        return Err(MeshError::TooMuch(most));
    }
    let mut vert = Vec::with_capacity(3 * count);
    let mut face = Vec::with_capacity(count);
    for triangle in 0..count {
        // the first three numbers are a normal, which MuJoCo ignores
        for corner in 1..4 {
            let at = HEADER + TRIANGLE * triangle + 12 * corner;
            let v: [f32; 3] = floats(bytes, at).ok_or(MeshError::Length { expected, found })?;
            if !v.iter().all(|x| x.abs() <= LARGEST) {
                return Err(MeshError::Coordinate(vert.len()));
            }
            vert.push(v);
        }
        let first = 3 * triangle as u32;
        face.push(if lefthanded {
            [first, first + 2, first + 1]
        } else {
            [first, first + 1, first + 2]
        });
    }
    let triangles = Triangles {
        vert,
        face,
        ..Triangles::default()
    };
    Ok(triangles.united())
}
