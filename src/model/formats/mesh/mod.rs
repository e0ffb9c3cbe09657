//! Triangle meshes in files: OBJ, STL and MSH, as MuJoCo 3.3.0 reads them.
//!
//! The readers take untrusted bytes: for any input, a reader ends with [`Triangles`] or a [`MeshError`], and takes memory
//! in proportion to the file and within [`Limits::mesh_elements`]. Materials (`mtllib`) have no meaning, as in MuJoCo.

mod msh;
mod obj;
mod polygon;
mod stl;

use thiserror::Error;

use crate::limits::Limits;
use crate::text::quoted;

/// Index for a corner of a triangle without a normal or without texture coordinates.
pub const NONE: u32 = u32::MAX;

/// The format of a file with a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront's text.
    Obj,
    /// Stereolithography, binary.
    Stl,
    /// MuJoCo's binary format.
    Msh,
}

impl MeshFormat {
    /// Returns the format for the extension of a file's name.
    pub fn of_path(path: &str) -> Option<Self> {
        let (_, ending) = path.rsplit_once('.')?;
        match ending.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "msh" => Some(Self::Msh),
            _ => None,
        }
    }

    /// Returns the format of a content type.
    pub fn of_content(content_type: &str) -> Option<Self> {
        match content_type {
            "model/obj" => Some(Self::Obj),
            "model/stl" => Some(Self::Stl),
            "model/vnd.mujoco.msh" => Some(Self::Msh),
            _ => None,
        }
    }
}

/// An error in reading a mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file is shorter or longer than its content.
    #[error("the file has {found} bytes where its header asks for {expected}")]
    Length {
        /// Number of bytes according to the header.
        expected: u64,
        /// Bytes of the file.
        found: u64,
    },
    /// Too short for a header.
    #[error("the file has {0} bytes, too few for a header")]
    Header(usize),
    /// Numbers of elements that do not fit together.
    #[error(
        "the header announces {vertices} vertices, {normals} normals, {texcoords} texture coordinates and {faces} faces: there must be 4 vertices at least, and as many of the others, or none"
    )]
    Sizes {
        /// Vertices announced.
        vertices: i32,
        /// Normals announced.
        normals: i32,
        /// Texture coordinates announced.
        texcoords: i32,
        /// Faces announced.
        faces: i32,
    },
    /// A number of triangles that MuJoCo does not accept.
    #[error("the header announces {0} triangles; MuJoCo takes from 1 to 200000")]
    Triangles(u32),
    /// STL as text, which MuJoCo does not read.
    #[error("the file is STL as text; MuJoCo reads only binary files: convert it")]
    TextStl,
    /// A coordinate is not finite or too large.
    #[error("vertex {0} has a coordinate that is not finite or above 2^30")]
    Coordinate(usize),
    /// The text is not UTF-8.
    #[error("line {0} is not UTF-8 text")]
    Text(usize),
    /// A word that should be a number.
    #[error("line {line}: \"{}\" is not a number", quoted(.word))]
    Number {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// Too few numbers.
    #[error("line {0} has too few numbers")]
    Few(usize),
    /// Polygons have so many corners that cutting them into triangles takes too long.
    #[error("the polygons up to line {0} have too many corners; cut them into triangles")]
    Polygons(usize),
    /// An index that names nothing.
    #[error("line {line}: \"{}\" is not an index of what stands above", quoted(.word))]
    Index {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// A corner that names a normal or texture coordinates that do not exist.
    #[error("face {face} names {what} {index}, of which there are {count}")]
    Corner {
        /// Face, from 0.
        face: usize,
        /// The kind of item that is named.
        what: &'static str,
        /// The index, from 0.
        index: u32,
        /// Their number.
        count: usize,
    },
    /// More than the limit allows.
    #[error("more than {0} vertices, normals, texture coordinates and faces in all meshes")]
    TooMuch(usize),
}

/// A mesh as stored in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Vertices, m.
    pub vert: Vec<[f32; 3]>,
    /// Normals; empty where the file has none.
    pub normal: Vec<[f32; 3]>,
    /// Texture coordinates, from the top of the image; empty where the file has none.
    pub texcoord: Vec<[f32; 2]>,
    /// Vertices of each triangle, counterclockwise from outside; empty where the file has none.
    pub face: Vec<[u32; 3]>,
    /// Normals at the corners of each triangle, or [`NONE`]; empty where they are those of the vertices.
    pub facenormal: Vec<[u32; 3]>,
    /// Texture coordinates at the corners of each triangle, or [`NONE`]; empty where they are those of the vertices.
    pub facetexcoord: Vec<[u32; 3]>,
}

impl Triangles {
    /// Reads a mesh from a file. `lefthanded` is whether it will be mirrored, which reverses the triangles' orientation.
    ///
    /// # Errors
    /// Bytes that are not a mesh, numbers that are not finite, indices of nothing, more elements than
    /// [`Limits::mesh_elements`].
    pub fn read(bytes: &[u8], format: MeshFormat, lefthanded: bool, limits: &Limits) -> Result<Self, MeshError> {
        let mesh = match format {
            MeshFormat::Obj => obj::read(bytes, lefthanded, limits.mesh_elements)?,
            MeshFormat::Stl => stl::read(bytes, lefthanded, limits.mesh_elements)?,
            MeshFormat::Msh => msh::read(bytes, lefthanded, limits.mesh_elements)?,
        };
        mesh.check()?;
        Ok(mesh)
    }

    /// Returns only the triangles. Vertices at the same place are merged into the first of them; their order is kept.
    #[must_use]
    pub fn united(self) -> Self {
        let Self { vert, mut face, .. } = self;
        // both zeros are one number to MuJoCo
        let key = |i: u32| vert[i as usize].map(|x| x + 0.0);
        let mut order: Vec<u32> = (0..vert.len() as u32).collect();
        let compare = |a: &u32, b: &u32| {
            let (p, q) = (key(*a), key(*b));
            (0..3).fold(std::cmp::Ordering::Equal, |order, k| order.then(p[k].total_cmp(&q[k])))
        };
        order.sort_by(compare);
        let mut first: Vec<u32> = (0..vert.len() as u32).collect();
        for pair in order.windows(2) {
            if key(pair[0]) == key(pair[1]) {
                first[pair[1] as usize] = first[pair[0] as usize];
            }
        }
        let mut place = vec![0; vert.len()];
        let mut kept = Vec::new();
        for (i, v) in vert.iter().enumerate() {
            if first[i] as usize == i {
                place[i] = kept.len() as u32;
                kept.push(*v);
            }
        }
        for corner in face.as_flattened_mut() {
            *corner = place[first[*corner as usize] as usize];
        }
        Self {
            vert: kept,
            face,
            ..Self::default()
        }
    }

    /// Returns the number of elements that count towards [`Limits::mesh_elements`].
    pub fn elements(&self) -> usize {
        self.vert.len() + self.normal.len() + self.texcoord.len() + self.face.len()
    }

    /// Checks that numbers are finite and indices are in range. MuJoCo checks vertices only.
    pub fn check(&self) -> Result<(), MeshError> {
        let bad = |v: &[f32; 3]| !v.iter().all(|x| x.is_finite());
        if let Some(vertex) = self.vert.iter().position(bad) {
            return Err(MeshError::Coordinate(vertex));
        }
        for (what, corners, count) in [
            ("vertex", &self.face, self.vert.len()),
            ("normal", &self.facenormal, self.normal.len()),
            ("texture coordinates", &self.facetexcoord, self.texcoord.len()),
        ] {
            for (face, corner) in corners.iter().enumerate() {
                let may_lack = what != "vertex";
                if let Some(&index) = corner
                    .iter()
                    .find(|&&i| i as usize >= count && !(may_lack && i == NONE))
                {
                    return Err(MeshError::Corner {
                        face,
                        what,
                        index,
                        count,
                    });
                }
            }
        }
        Ok(())
    }
}

/// Returns four bytes at a place as an unsigned number; `None` beyond the end.
pub(super) fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
}

/// Returns numbers in single precision that follow one another; `None` beyond the end.
pub(super) fn floats<const N: usize>(bytes: &[u8], at: usize) -> Option<[f32; N]> {
    let mut out = [0.0; N];
    for (k, value) in out.iter_mut().enumerate() {
        *value = f32::from_bits(word(bytes, at + 4 * k)?);
    }
    Some(out)
}

#[cfg(test)]
mod tests;
