//! Wavefront's text: lines of vertices (`v`), normals (`vn`), texture coordinates (`vt`) and polygons (`f`). All vertices count, and
//! the polygons of the first object or group that has any. Everything else is ignored, as in MuJoCo.

use super::polygon::cut;
use super::{MeshError, NONE, Triangles};

/// Maximum number of characters of a word that an error quotes.
const SHOWN: usize = 60;

/// Minimum number of corners of a polygon.
const CORNERS: usize = 3;
/// Maximum number of corners of a polygon: MuJoCo 3.3.0 leaves out polygons with more.
const MOST_CORNERS: usize = 100;
/// Limit on the sum of the cubes of the numbers of corners: a thousand polygons of a hundred corners are far below it.
const WORK: u64 = 1 << 32;

/// A corner of a polygon: vertex, texture coordinates, normal.
type Corner = [u32; 3];

/// A file being read.
#[derive(Default)]
struct Reader {
    mesh: Triangles,
    /// Corners of the triangles.
    corners: Vec<[Corner; 3]>,
    /// Polygons, by first corner and number of corners. Their triangles are known only once all vertices are read.
    polygons: Vec<Corner>,
    lengths: Vec<usize>,
    /// Upper bound of the time to cut the polygons.
    work: u64,
    /// Whether an object or group began after the first polygon.
    complete: bool,
}

/// Reads a file.
pub(super) fn read(bytes: &[u8], lefthanded: bool, most: usize) -> Result<Triangles, MeshError> {
    let mut reader = Reader::default();
    for (number, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = std::str::from_utf8(line).map_err(|_| MeshError::Text(number + 1))?;
        reader.line(line, number + 1, most)?;
        if reader.mesh.elements() + reader.polygons.len() / CORNERS > most {
            return Err(MeshError::TooMuch(most));
        }
    }
    reader.triangulate();
    Ok(reader.finish(lefthanded))
}

impl Reader {
    fn line(&mut self, line: &str, number: usize, most: usize) -> Result<(), MeshError> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => self.mesh.vert.push(numbers(words, number)?),
            Some("vn") => self.mesh.normal.push(numbers(words, number)?),
            Some("vt") => {
                let [u, v] = numbers(words, number)?;
                // images begin at their top
                self.mesh.texcoord.push([u, 1.0 - v]);
            }
            Some("f") if !self.complete => {
                let first = self.polygons.len();
                for word in words {
                    let corner = self.corner(word).ok_or_else(|| MeshError::Index {
                        line: number,
                        word: word.chars().take(SHOWN).collect(),
                    })?;
                    self.polygons.push(corner);
                    if self.polygons.len() > CORNERS * most {
                        return Err(MeshError::TooMuch(most));
                    }
                }
                let length = self.polygons.len() - first;
                // points and lines that call themselves polygons
                if !(CORNERS..=MOST_CORNERS).contains(&length) {
                    self.polygons.truncate(first);
                } else {
                    self.lengths.push(length);
                    // the time that cutting it may take, so that no file takes minutes
                    self.work = self.work.saturating_add((length as u64).saturating_pow(3));
                    if length > 3 && self.work > WORK {
                        return Err(MeshError::Polygons(number));
                    }
                }
            }
            Some("o" | "g") => self.complete |= !self.lengths.is_empty(),
            _ => {}
        }
        Ok(())
    }

    /// Reads a corner: `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`.
    fn corner(&self, word: &str) -> Option<Corner> {
        let counts = [self.mesh.vert.len(), self.mesh.texcoord.len(), self.mesh.normal.len()];
        let mut corner = [NONE; 3];
        for (k, part) in word.split('/').enumerate() {
            match part {
                "" if k == 1 => {}
                _ => *corner.get_mut(k)? = index(part, *counts.get(k)?)?,
            }
        }
        Some(corner)
    }

    /// Cuts the polygons into triangles.
    fn triangulate(&mut self) {
        let (mut first, mut vertices, mut pieces) = (0, Vec::new(), Vec::new());
        for &length in &self.lengths {
            let corners = &self.polygons[first..first + length];
            first += length;
            if let [a, b, c] = corners[..] {
                self.corners.push([a, b, c]);
                continue;
            }
            vertices.clear();
            vertices.extend(corners.iter().map(|corner| corner[0]));
            pieces.clear();
            cut(&self.mesh.vert, &vertices, &mut pieces);
            self.corners
                .extend(pieces.iter().map(|piece| piece.map(|k| corners[k])));
        }
    }

    fn finish(self, lefthanded: bool) -> Triangles {
        let Self { mut mesh, corners, .. } = self;
        let order = if lefthanded { [0, 2, 1] } else { [0, 1, 2] };
        let pick = |k: usize| corners.iter().map(move |t| order.map(|c| t[c][k])).collect();
        mesh.face = pick(0);
        if !mesh.texcoord.is_empty() {
            mesh.facetexcoord = pick(1);
        }
        if !mesh.normal.is_empty() {
            mesh.facenormal = pick(2);
        }
        mesh
    }
}

/// Reads an index: from 1, or back from the last.
fn index(text: &str, count: usize) -> Option<u32> {
    let value: i64 = text.parse().ok()?;
    let place = match value {
        1.. => value - 1,
        0 => return None,
        _ => (count as i64).checked_add(value)?,
    };
    u32::try_from(place).ok().filter(|&place| place != NONE)
}

/// Reads the numbers at the beginning of a line.
fn numbers<'w, const N: usize>(mut words: impl Iterator<Item = &'w str>, line: usize) -> Result<[f32; N], MeshError> {
    let mut out = [0.0; N];
    for value in &mut out {
        let word = words.next().ok_or(MeshError::Few(line))?;
        *value = real(word).ok_or_else(|| MeshError::Number {
            line,
            word: word.chars().take(SHOWN).collect(),
        })?;
    }
    Ok(out)
}

/// Reads a number digit by digit, with the rounding of the reader that MuJoCo uses.
fn real(word: &str) -> Option<f32> {
    // whether it is a number at all is not for us to invent
    word.parse::<f64>().ok().filter(|value| value.is_finite())?;
    let (text, exponent) = word.split_once(['e', 'E']).unwrap_or((word, "0"));
    let (negative, text) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let (whole, part) = text.split_once('.').unwrap_or((text, ""));
    let mut mantissa = 0.0_f64;
    for digit in whole.bytes() {
        mantissa = mantissa * 10.0 + f64::from(digit.wrapping_sub(b'0'));
    }
    for (k, digit) in part.bytes().enumerate() {
        mantissa += f64::from(digit.wrapping_sub(b'0')) * power_of_ten(k + 1);
    }
    let exponent: i32 = exponent.parse().ok()?;
    let value = if exponent == 0 {
        mantissa
    } else {
        // five to the exponent, times two to the exponent, which is exact
        let mut scaled = mantissa * pxfm::f_pow(5.0, f64::from(exponent.clamp(-400, 400)));
        for _ in 0..exponent.unsigned_abs().min(1100) {
            scaled *= if exponent > 0 { 2.0 } else { 0.5 };
        }
        scaled
    };
    let value = if negative { -value } else { value } as f32;
    value.is_finite().then_some(value)
}

/// Returns ten to the power of `-k`, rounded once.
fn power_of_ten(k: usize) -> f64 {
    const POWERS: [f64; 20] = [
        1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16,
        1e-17, 1e-18, 1e-19,
    ];
    // further digits are far below what single precision keeps
    POWERS.get(k).copied().unwrap_or(0.0)
}
