//! The points at which the light on planes is computed: MuJoCo draws a plane as a grid of rectangles and lights their corners.
//!
//! The rules follow from pictures of MuJoCo 3.3.0. Lines lie at multiples of a step, counted from the middle of the plane, and along its
//! edges. The step is twice the third number of `size`, or the 198th part of the plane where that is more. A direction without an end has
//! 200 rectangles up to somewhat beyond the far plane, and the plane moves with the camera, by whole repetitions of its texture.

use crate::math::Vec3;
#[cfg(any(test, feature = "wgpu"))]
use crate::mesh::{Mesh, MeshPart};

/// The largest number of rectangles along a finite side.
const CELLS: f32 = 198.0;

/// The number of rectangles along an infinite side.
const ENDLESS_CELLS: f32 = 200.0;

/// The lines of a plane's grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Half of each side, m.
    half: [f32; 2],
    /// Distance between lines in each direction, m.
    step: [f32; 2],
    /// Distance by whole multiples of which the plane moves with the camera, m; 0 for a finite side.
    stride: [f32; 2],
}

/// Returns half the length of an infinite side of a plane, and the distance by multiples of which it moves, m. `repeat` is the number of
/// repetitions of its material's texture.
fn endless(far: f32, repeat: Option<f64>) -> (f32, f32) {
    let half_stride = match repeat {
        Some(repeat) if repeat > 0.0 => (2.0 / repeat) as f32,
        _ => 2.1 * far / CELLS,
    };
    (1.05 * far + half_stride, 2.0 * half_stride)
}

impl Lattice {
    /// Returns the lines of a plane of a size. `far` is the distance of the far plane, m, and `repeat` is the number of repetitions of its material's
    /// texture, if it has one, in each direction.
    pub fn new(size: Vec3, far: f32, repeat: Option<[f64; 2]>) -> Self {
        let spacing = 2.0 * size[2] as f32;
        let along = |direction: usize| match size[direction] as f32 {
            half if half > 0.0 => [half, spacing.max(2.0 * half / CELLS), 0.0],
            _ => {
                let (half, stride) = endless(far, repeat.map(|repeat| repeat[direction]));
                [half, 2.0 * half / ENDLESS_CELLS, stride]
            }
        };
        let [x, y] = [along(0), along(1)];
        Self {
            half: [x[0], y[0]],
            step: [x[1], y[1]],
            stride: [x[2], y[2]],
        }
    }

    /// Returns the lines of the plane with another size. `far` is half of each infinite side, m.
    pub fn resized(&self, size: Vec3, far: [f32; 2]) -> Self {
        let mut other = Self::new(size, 0.0, None);
        for direction in 0..2 {
            if size[direction] as f32 <= 0.0 {
                other.half[direction] = far[direction];
                other.step[direction] = 2.0 * far[direction] / ENDLESS_CELLS;
                other.stride[direction] = self.stride[direction];
            }
        }
        other
    }

    /// Returns half of each side, m.
    pub fn half(&self) -> [f32; 2] {
        self.half
    }

    /// Returns the distance by which the plane moves in a direction if the camera is `away` from its middle, m.
    pub fn shift(&self, direction: usize, away: f64) -> f64 {
        match f64::from(self.stride[direction]) {
            stride if stride > 0.0 => stride * (away / stride).round(),
            _ => 0.0,
        }
    }

    /// Returns the lines on both sides of a position along a direction.
    #[inline(always)]
    pub fn around(&self, direction: usize, at: f32) -> [f32; 2] {
        let (half, step) = (self.half[direction], self.step[direction]);
        // a place on the edge, or beyond it by rounding, belongs to the last rectangle
        let inside = at.max(-half).min(half * 0.999_999);
        let low = (inside / step).floor() * step;
        [low.max(-half), (low + step).min(half)]
    }

    /// Returns all lines in a direction, as fractions of half the side.
    #[cfg(any(test, feature = "wgpu"))]
    pub fn lines(&self, direction: usize) -> Vec<f32> {
        let (half, step) = (self.half[direction], self.step[direction]);
        // a line that rounding puts beside the edge would appear twice
        let count = (half / step * 0.999_999) as i32;
        let inner = (-count..=count).map(|k| k as f32 * step / half);
        std::iter::once(-1.0).chain(inner).chain([1.0]).collect()
    }

    /// Creates a unit rectangle at z = 0 with all lines.
    #[cfg(any(test, feature = "wgpu"))]
    pub fn mesh(&self) -> Mesh {
        let (columns, rows) = (self.lines(0), self.lines(1));
        let mut mesh = Mesh::default();
        mesh.band(MeshPart::Body);
        for &y in &rows {
            for &x in &columns {
                mesh.push(([x, y, 0.0], [0.0, 0.0, 1.0]));
            }
        }
        let width = columns.len();
        for row in 1..rows.len() {
            for column in 1..width {
                let [below, above] = [row - 1, row].map(|row| row * width + column - 1);
                let [a, b, c, d] = [below, below + 1, above + 1, above].map(|i| i as u16);
                mesh.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
        mesh.end_loose();
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_lie_at_multiples_of_twice_the_spacing() {
        let lattice = Lattice::new([1.75, 1.0, 0.5], 100.0, None);
        assert_eq!(lattice.lines(0), [-1.0, -1.0 / 1.75, 0.0, 1.0 / 1.75, 1.0]);
        assert_eq!(lattice.lines(1), [-1.0, 0.0, 1.0]);
        assert_eq!(lattice.around(0, 0.2), [0.0, 1.0]);
        assert_eq!(lattice.around(0, 1.2), [1.0, 1.75]);
        assert_eq!(lattice.around(0, -1.7), [-1.75, -1.0]);
        for at in [-1.0, 1.0, -1.1, 1.1] {
            let [low, high] = lattice.around(1, at);
            assert!(low < high && low >= -1.0 && high <= 1.0, "{low} {high}");
        }
    }

    #[test]
    fn there_are_at_most_198_rectangles_along_a_side() {
        let lattice = Lattice::new([2.0, 0.0, 0.001], 200.0, Some([3.0, 1.0]));
        assert_eq!(lattice.lines(0).len(), 199);
        assert_eq!(lattice.lines(1).len(), 201);
        let [ended, endless] = lattice.half();
        assert_eq!(ended, 2.0);
        assert!((endless - 212.0).abs() < 1e-4, "{endless}");
        assert_eq!(
            [lattice.shift(0, 30.0), lattice.shift(1, 30.0), lattice.shift(1, 1.9)],
            [0.0, 32.0, 0.0]
        );
        assert!((lattice.around(0, 0.01)[1] - 4.0 / 198.0).abs() < 1e-6);
        assert!((lattice.around(1, 0.01)[1] - 2.12).abs() < 1e-6);
    }
}
