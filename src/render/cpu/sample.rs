//! Texture lookups as in Mesa's llvmpipe: bilinear in two mip levels, with one level of detail per 2 x 2 pixels.

use super::lanes::three;
use super::light::Vec3x4;
use super::texels::Coordinates;
use super::{cube, flat};
use crate::texture::TexturePixels;

impl TexturePixels {
    /// Returns the colours (red, green, blue; 0..1) at those pixels of a block that are `wanted`. Flat textures have one
    /// level of detail for the whole block, cube maps one for each pixel.
    pub(super) fn sample(&self, at: &Coordinates, wanted: [bool; 4]) -> Vec3x4 {
        let colours = match self {
            TexturePixels::Flat(face) => flat::colours(face, at),
            TexturePixels::Cube(map) => cube::colours(map, at, wanted),
        };
        three(|k| colours[k] * (1.0 / 255.0))
    }
}
