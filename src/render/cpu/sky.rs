//! The background: a cube map around the scene, looked up by the direction of each pixel.

use wide::f32x4;

use super::camera::ViewCamera;
use super::lanes::three;
use super::light::Vec3x4;
use super::texels::Coordinates;
use crate::scenery::Scenery;

/// The directions in which the pixels of an image look: the parts that blocks of a column share, and blocks of a row.
#[derive(Debug, Default)]
pub struct Rays {
    /// For each column of blocks of 2 x 2 pixels.
    columns: Vec<[f32x4; 3]>,
    /// For each row of blocks, the lowest first.
    rows: Vec<[f32x4; 3]>,
}

impl Rays {
    /// Finds the directions of an image of `width` and `height` pixels.
    pub fn aim(&mut self, eye: &ViewCamera, [width, height]: [usize; 2]) {
        let places = |first: usize, pixels: usize, tan: f32, of: fn(f32) -> [f32; 4]| {
            let at = f32x4::new(of(first as f32 + 0.5));
            (at * (2.0 / pixels as f32) - 1.0) * tan
        };
        self.columns.clear();
        self.columns.extend((0..width).step_by(2).map(|x| {
            let across = places(x, width, eye.tan[0], |x| [x, x + 1.0, x, x + 1.0]);
            three(|k| eye.forward[k] + eye.right[k] * across)
        }));
        self.rows.clear();
        self.rows.extend((0..height).step_by(2).map(|y| {
            let upward = places(y, height, eye.tan[1], |y| [y, y, y + 1.0, y + 1.0]);
            three(|k| eye.up[k] * upward)
        }));
    }

    /// Returns the colours of the background in a block, red, green and blue; 0..1. `x` and `y` are those of its first
    /// pixel.
    #[inline(always)]
    pub fn colours(&self, scenery: &Scenery, [x, y]: [usize; 2], wanted: [bool; 4]) -> Vec3x4 {
        let Some(sky) = scenery.sky else {
            return [f32x4::ZERO; 3];
        };
        // all four pixels even where one is wanted: their differences choose the mip level
        let (column, row) = (&self.columns[x / 2], &self.rows[y / 2]);
        // MuJoCo's cube has its top along +y, the world along +z
        let at: Coordinates = [column[0] + row[0], column[2] + row[2], -(column[1] + row[1])];
        scenery.textures[sky].sample(&at, wanted)
    }
}
