//! MuJoCo's binary format of skins.

use thiserror::Error;

use super::mesh::{floats, word};

const HEADER: usize = 16;
/// Bytes of the name of a body.
const NAME: usize = 40;

/// An error in reading a skin.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SkinError {
    /// Too short for a header.
    #[error("the file has {0} bytes, too few for a header")]
    Header(usize),
    /// Negative numbers of elements.
    #[error("the header announces {0:?} vertices, texture coordinates, faces and bones: there are none below 0")]
    Sizes([i32; 4]),
    /// The file ends before its content does.
    #[error("the file has {0} bytes, fewer than its numbers of elements ask for")]
    Cut(usize),
    /// The file is longer than its content.
    #[error("the file has {0} bytes after its last bone")]
    Rest(usize),
    /// The name of a body is not UTF-8.
    #[error("the name of the body of bone {0} is not UTF-8 text")]
    Name(usize),
}

/// A skin as stored in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinFile {
    /// Vertices, m.
    pub vert: Vec<[f32; 3]>,
    /// Texture coordinates.
    pub texcoord: Vec<[f32; 2]>,
    /// Vertices of each triangle.
    pub face: Vec<[u32; 3]>,
    /// The bodies that pull.
    pub bones: Vec<BoneFile>,
}

/// A body that pulls, as stored in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoneFile {
    /// Name of the body.
    pub body: String,
    /// Its position in the pose in which the skin is given, m.
    pub bindpos: [f32; 3],
    /// Its orientation there.
    pub bindquat: [f32; 4],
    /// Vertices that it pulls.
    pub vertid: Vec<u32>,
    /// Weight with which it pulls each of them.
    pub vertweight: Vec<f32>,
}

/// A reader over the bytes of a file.
struct ByteReader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl ByteReader<'_> {
    /// Reads `count` rows of numbers. A count that the file cannot hold is an error before memory is allocated for it.
    fn rows<const N: usize>(&mut self, count: usize) -> Result<Vec<[f32; N]>, SkinError> {
        self.each(count, N, floats)
    }

    fn each<T>(
        &mut self,
        count: usize,
        words: usize,
        read: impl Fn(&[u8], usize) -> Option<T>,
    ) -> Result<Vec<T>, SkinError> {
        let cut = SkinError::Cut(self.bytes.len());
        let left = (self.bytes.len() - self.at) / (4 * words);
        if count > left {
            return Err(cut);
        }
        let first = self.at;
        self.at += 4 * words * count;
        let values = (0..count).map(|k| read(self.bytes, first + 4 * words * k));
        values.collect::<Option<_>>().ok_or(cut)
    }

    fn number(&mut self) -> Result<usize, SkinError> {
        let number = self.each(1, 1, word)?;
        number
            .first()
            .and_then(|&n| usize::try_from(n.cast_signed()).ok())
            .ok_or(SkinError::Cut(self.bytes.len()))
    }

    fn bone(&mut self, index: usize) -> Result<BoneFile, SkinError> {
        let name = self.bytes.get(self.at..self.at + NAME);
        let name = name.ok_or(SkinError::Cut(self.bytes.len()))?;
        self.at += NAME;
        let name = name.split(|&byte| byte == 0).next().unwrap_or_default();
        // of a name that fills the field MuJoCo drops the last character
        let name = name.get(..NAME - 1).unwrap_or(name);
        let body = str::from_utf8(name).map_err(|_| SkinError::Name(index))?.to_owned();
        let [x, y, z, quat @ ..] = self.rows::<7>(1)?.first().copied().unwrap_or_default();
        let count = self.number()?;
        Ok(BoneFile {
            body,
            bindpos: [x, y, z],
            bindquat: quat,
            vertid: self.each(count, 1, word)?,
            vertweight: self.rows::<1>(count)?.into_flattened(),
        })
    }
}

impl SkinFile {
    /// Returns the number of vertices, texture coordinates, faces and weights.
    pub fn elements(&self) -> usize {
        let weights: usize = self.bones.iter().map(|bone| bone.vertid.len()).sum();
        self.vert.len() + self.texcoord.len() + self.face.len() + weights
    }

    /// Reads a file. It takes memory in proportion to the file.
    ///
    /// # Errors
    /// Fails if the file is shorter or longer than the numbers in it say.
    pub fn read(bytes: &[u8]) -> Result<Self, SkinError> {
        let sizes = floats::<4>(bytes, 0).ok_or(SkinError::Header(bytes.len()))?;
        let sizes = sizes.map(|size| size.to_bits().cast_signed());
        if sizes.iter().any(|&size| size < 0) {
            return Err(SkinError::Sizes(sizes));
        }
        let [vertices, texcoords, faces, bones] = sizes.map(|size| size.unsigned_abs() as usize);
        let mut rest = ByteReader { bytes, at: HEADER };
        let (vert, texcoord) = (rest.rows(vertices)?, rest.rows(texcoords)?);
        let face = rest.each(faces, 3, |bytes, at| {
            Some([word(bytes, at)?, word(bytes, at + 4)?, word(bytes, at + 8)?])
        })?;
        let bones = (0..bones).map(|index| rest.bone(index)).collect::<Result<_, _>>()?;
        match bytes.len() - rest.at {
            0 => Ok(Self {
                vert,
                texcoord,
                face,
                bones,
            }),
            more => Err(SkinError::Rest(more)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two vertices, a face, a bone that pulls both.
    fn file() -> Vec<u8> {
        let mut bytes = Vec::new();
        let integers =
            |bytes: &mut Vec<u8>, numbers: &[i32]| bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
        let reals = |bytes: &mut Vec<u8>, numbers: &[f32]| bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
        integers(&mut bytes, &[2, 0, 1, 1]);
        reals(&mut bytes, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        integers(&mut bytes, &[0, 1, 1]);
        bytes.extend(b"arm");
        bytes.extend([0; NAME - 3]);
        reals(&mut bytes, &[7.0, 8.0, 9.0, 1.0, 0.0, 0.0, 0.0]);
        integers(&mut bytes, &[2, 0, 1]);
        reals(&mut bytes, &[0.5, 2.0]);
        bytes
    }

    #[test]
    fn a_file_is_read() {
        let skin = SkinFile::read(&file()).unwrap();
        assert_eq!(skin.vert, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(skin.face, [[0, 1, 1]]);
        let [bone] = &skin.bones[..] else { panic!("{skin:?}") };
        assert_eq!((bone.body.as_str(), bone.bindpos), ("arm", [7.0, 8.0, 9.0]));
        assert_eq!((&bone.vertid[..], &bone.vertweight[..]), (&[0, 1][..], &[0.5, 2.0][..]));
    }

    #[test]
    fn files_of_a_wrong_length_are_refused() {
        let whole = file();
        for length in 0..whole.len() {
            assert!(SkinFile::read(&whole[..length]).is_err(), "{length}");
        }
        let longer = [&whole[..], &[0]].concat();
        assert_eq!(SkinFile::read(&longer), Err(SkinError::Rest(1)));
    }

    #[test]
    fn announced_sizes_take_no_memory() {
        let mut bytes = file();
        for at in [0, 4, 8, 12] {
            bytes[at..at + 4].copy_from_slice(&i32::MAX.to_le_bytes());
            assert!(matches!(SkinFile::read(&bytes), Err(SkinError::Cut(_))));
            bytes[at..at + 4].copy_from_slice(&(-1_i32).to_le_bytes());
            assert!(matches!(SkinFile::read(&bytes), Err(SkinError::Sizes(_))));
            bytes = file();
        }
    }
}
