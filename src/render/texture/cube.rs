//! Images on the sides of a cube, with the texels beyond their edges.

use std::ops::Neg;

use super::MipChain;

/// A cube map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cube {
    /// The images on the sides +x, -x, +y, -y, +z, -z: squares of the same size.
    pub faces: [MipChain; 6],
    /// The border of each side, by mip level.
    rims: Vec<[FaceBorder; 6]>,
}

/// The texels around a side in one level: those left and right of it, including corners, from the top; then those above and below.
type FaceBorder = Vec<[u8; 4]>;

impl Cube {
    /// Creates a cube of images, which must be squares of the same size.
    pub fn new(faces: [MipChain; 6]) -> Self {
        // computed once: finding a texel beyond an edge takes ten times as long as a lookup within a side
        let rims = (0..faces[0].len())
            .map(|level| [0, 1, 2, 3, 4, 5].map(|side| rim(&faces, side, level)))
            .collect();
        Self { faces, rims }
    }

    /// Returns the number of texels around sides.
    pub fn around(&self) -> usize {
        self.rims.iter().flatten().map(Vec::len).sum()
    }

    /// Returns the block of 2 x 2 texels of a side in a level whose upper left texel is in column `x` and row `y`, from -1 to the last one: rows from
    /// the top.
    #[inline(always)]
    pub fn block(&self, side: u8, level: usize, x: i32, y: i32) -> [[u8; 4]; 4] {
        let side = usize::from(side);
        let (image, rim) = (&self.faces[side][level], &self.rims[level][side]);
        let n = image.width;
        // a negative number is a large one
        if (x as usize) < n - 1 && (y as usize) < n - 1 {
            let texels = &image.pixels[y as usize * n + x as usize..];
            return [texels[0], texels[1], texels[n], texels[n + 1]];
        }
        let at = |x: i32, y: i32| {
            let (column, row) = (x as usize, y as usize);
            match (column < n, row < n) {
                (true, true) => image.pixels[row * n + column],
                (true, false) => rim[2 * (n + 2) + if y < 0 { column } else { n + column }],
                (false, _) => rim[if x < 0 { 0 } else { n + 2 } + (y + 1) as usize],
            }
        };
        [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)]
    }
}

/// Finds the texels around a side.
fn rim(faces: &[MipChain; 6], side: u8, level: usize) -> FaceBorder {
    let n = faces[0][level].width as i32;
    let texel = |[x, y]: [i32; 2]| {
        let (side, index) = place(n, side, x, y);
        faces[side][level].pixels[index]
    };
    // at a corner of the cube only three texels meet, and their mean takes the place of the fourth
    let corner = |x: i32, y: i32| {
        let (own_x, own_y) = (x.clamp(0, n - 1), y.clamp(0, n - 1));
        let others = [[own_x, own_y], [x, own_y], [own_x, y]].map(texel);
        [0, 1, 2, 3].map(|c| (others.iter().map(|t| u16::from(t[c])).sum::<u16>() / 3) as u8)
    };
    // beyond an edge lies a row or a column of one other side: its ends locate it
    let line = |[[x0, y0], [x1, y1]]: [[i32; 2]; 2]| {
        let ((side, first), (_, last)) = (place(n, side, x0, y0), place(n, side, x1, y1));
        let step = (last as isize - first as isize) / (n as isize - 1).max(1);
        let pixels = &faces[side][level].pixels;
        (0..n as isize).map(move |k| pixels[(first as isize + k * step) as usize])
    };
    let mut rim = FaceBorder::with_capacity(4 * (n as usize + 1));
    for x in [-1, n] {
        rim.push(corner(x, -1));
        rim.extend(line([[x, 0], [x, n - 1]]));
        rim.push(corner(x, n));
    }
    for y in [-1, n] {
        rim.extend(line([[0, y], [n - 1, y]]));
    }
    rim
}

/// Returns the side and index of a texel of a side of `n` texels, or beyond one of its edges, of the texel on the adjoining side.
fn place(n: i32, side: u8, x: i32, y: i32) -> (usize, usize) {
    // the centres of texels on a face that reaches from -1 to 1
    let centre = |i: i32| (2 * i + 1) as f32 / n as f32 - 1.0;
    let at = direction(side, centre(x), centre(y));
    // the direction of the texel's centre, beyond the edge, points through the adjoining face
    let side = side_of(at);
    let (right, down, out) = components(side, at);
    let n = n as usize;
    let index = |v: f32| (((v / out + 1.0) * 0.5 * n as f32) as usize).min(n - 1);
    (usize::from(side), index(down) * n + index(right))
}

/// Returns the side through which a direction points that is not on an edge.
fn side_of(at: [f32; 3]) -> u8 {
    let longest = at.map(f32::abs).into_iter().fold(0.0, f32::max);
    let axis = at.iter().position(|v| v.abs() == longest).unwrap_or(0);
    2 * axis as u8 + u8::from(at[axis] < 0.0)
}

/// Returns the components of directions on a side of the cube: right, down, outward.
#[inline(always)]
pub fn components<T: Neg<Output = T>>(side: u8, [x, y, z]: [T; 3]) -> (T, T, T) {
    // the table of cube map faces in OpenGL's specification
    match side {
        0 => (-z, -y, x),
        1 => (z, -y, -x),
        2 => (x, z, y),
        3 => (x, -z, -y),
        4 => (x, -y, z),
        _ => (-x, -y, -z),
    }
}

/// Returns the direction with the given components on a side of the cube.
fn direction(side: u8, right: f32, down: f32) -> [f32; 3] {
    match side {
        0 => [1.0, -down, -right],
        1 => [-1.0, -down, right],
        2 => [right, 1.0, down],
        3 => [right, -1.0, -down],
        4 => [right, -down, 1.0],
        _ => [-right, -down, -1.0],
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::texture::MipLevel;

    /// A cube whose texels encode their side, row and column.
    fn atlas(n: usize) -> Cube {
        let face = |side: u8| MipLevel::from_fn(n, n, |row, column| [side, row as u8, column as u8]);
        Cube::new([0, 1, 2, 3, 4, 5].map(|side| Arc::new(vec![face(side)])))
    }

    #[test]
    fn sides_and_directions_are_inverse() {
        for side in 0..6 {
            let at = direction(side, 0.3, -0.7);
            assert_eq!(side_of(at), side);
            assert_eq!(components(side, at), (0.3, -0.7, 1.0));
        }
    }

    #[test]
    fn beyond_an_edge_is_the_adjoining_side() {
        let cube = atlas(3);
        let at = |x: i32, y: i32| cube.block(4, 0, x, y).map(|[side, row, column, _]| [side, row, column]);
        assert_eq!(at(0, 0), [[4, 0, 0], [4, 0, 1], [4, 1, 0], [4, 1, 1]]);
        // right of +z is +x, left -x, above +y, below -y: as seen from the inside
        assert_eq!(at(2, 1), [[4, 1, 2], [0, 1, 0], [4, 2, 2], [0, 2, 0]]);
        assert_eq!(at(-1, 0), [[1, 0, 2], [4, 0, 0], [1, 1, 2], [4, 1, 0]]);
        assert_eq!(at(0, -1), [[2, 2, 0], [2, 2, 1], [4, 0, 0], [4, 0, 1]]);
        assert_eq!(at(1, 2), [[4, 2, 1], [4, 2, 2], [3, 0, 1], [3, 0, 2]]);
        // at a corner the mean of the three that meet
        let corner = [[1, 0, 2], [2, 2, 0], [4, 0, 0]];
        let mean = [0, 1, 2].map(|c| corner.iter().map(|t| t[c]).sum::<u8>() / 3);
        assert_eq!(at(-1, -1), [mean, corner[1], corner[0], corner[2]]);
    }
    #[test]
    fn around_each_side_are_the_nearest_texels_of_the_others() {
        for n in [1, 2, 5] {
            let cube = atlas(n as usize);
            for (side, k) in (0..6).flat_map(|side| (0..n).map(move |k| (side, k))) {
                for [x, y] in [[-1, k], [n, k], [k, -1], [k, n]] {
                    let (other, index) = place(n, side, x, y);
                    let (left, top) = (x.min(n - 1), y.min(n - 1));
                    let found = cube.block(side, 0, left, top)[(x - left + 2 * (y - top)) as usize];
                    assert_ne!(other, usize::from(side));
                    assert_eq!(found, cube.faces[other][0].pixels[index], "{side}: {x} {y} of {n}");
                }
            }
        }
    }
}
