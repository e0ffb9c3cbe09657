//! MuJoCo's binary format: four numbers of elements, then vertices, normals, texture coordinates, faces.

use super::{MeshError, Triangles, floats, word};

const HEADER: usize = 16;

/// Reads a file.
pub(super) fn read(bytes: &[u8], lefthanded: bool, most: usize) -> Result<Triangles, MeshError> {
    let number = |k: usize| word(bytes, 4 * k).map(u32::cast_signed);
    let (Some(vertices), Some(normals), Some(texcoords), Some(faces)) = (number(0), number(1), number(2), number(3))
    else {
        return Err(MeshError::Header(bytes.len()));
    };
    let fits = |n: i32| n == 0 || n == vertices;
    if vertices < 4 || faces < 0 || !fits(normals) || !fits(texcoords) {
        return Err(MeshError::Sizes {
            vertices,
            normals,
            texcoords,
            faces,
        });
    }
    let count = |n: i32| u64::from(n.unsigned_abs());
    let expected = HEADER as u64 + 12 * (count(vertices) + count(normals) + count(faces)) + 8 * count(texcoords);
    let found = bytes.len() as u64;
    // before any memory is taken: the header may announce anything
    if expected != found {
        return Err(MeshError::Length { expected, found });
    }
    let [vertices, normals, texcoords, faces] =
        [vertices, normals, texcoords, faces].map(|n| n.unsigned_abs() as usize);
    if vertices + normals + texcoords + faces > most {
        return Err(MeshError::TooMuch(most));
    }
    let cut = MeshError::Length { expected, found };
    let mut at = HEADER;
    let vert = rows::<3>(bytes, &mut at, vertices).ok_or_else(|| cut.clone())?;
    let normal = rows::<3>(bytes, &mut at, normals).ok_or_else(|| cut.clone())?;
    let texcoord = rows::<2>(bytes, &mut at, texcoords).ok_or_else(|| cut.clone())?;
    let written: Option<Vec<[u32; 3]>> = (0..faces).map(|k| triangle(bytes, at + 12 * k)).collect();
    let written = written.ok_or(cut)?;
    let mut face = written.clone();
    if lefthanded {
        // MuJoCo leaves normals and texture coordinates in the sense of the file
        face.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    Ok(Triangles {
        facenormal: if normal.is_empty() { Vec::new() } else { written.clone() },
        facetexcoord: if texcoord.is_empty() { Vec::new() } else { written },
        vert,
        normal,
        texcoord,
        face,
    })
}

fn rows<const N: usize>(bytes: &[u8], at: &mut usize, count: usize) -> Option<Vec<[f32; N]>> {
    let first = *at;
    *at += 4 * N * count;
    (0..count).map(|k| floats(bytes, first + 4 * N * k)).collect()
}

fn triangle(bytes: &[u8], at: usize) -> Option<[u32; 3]> {
    Some([word(bytes, at)?, word(bytes, at + 4)?, word(bytes, at + 8)?])
}
