//! Textures: decoded or computed, with the mip levels that Mesa generates.

mod cube;
mod pattern;
mod plain;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::RenderError;
use crate::assets::AssetSource;
use crate::formats::png::{decode_png, is_opaque};
use crate::limits::Limits;
use crate::model::{Builtin, Texture as Recipe, TextureType};
pub use cube::{Cube, components};
use pattern::{Mt19937, cube_builtin, flat_builtin, truncated};
pub use plain::SETTLED;

/// Largest side of a texture, pixels: images are halved during loading until they fit, which keeps the original's textures of 2500 and 5000 pixels
/// small.
pub const MAX_TEXTURE: usize = 1024;
/// Largest side of a builtin pattern, pixels.
const MAX_PATTERN: usize = Limits::DEFAULT.picture_side as usize;

/// One mip level of an image: red, green, blue and a mark for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MipLevel {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Pixels, rows from the top. The fourth byte is 255, or less where a texel and its neighbours have one colour.
    pub pixels: Vec<[u8; 4]>,
}

/// An image with its mip levels, each half the size of the one before, down to one pixel.
pub type MipChain = Arc<Vec<MipLevel>>;

/// A texture ready for sampling.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TexturePixels {
    /// One image, repeated in both directions.
    Flat(MipChain),
    /// Images on the sides of a cube.
    Cube(Cube),
}

impl MipLevel {
    fn filled(width: usize, height: usize, rgb: [u8; 3]) -> Self {
        let pixels = vec![[rgb[0], rgb[1], rgb[2], 255]; width * height];
        Self { width, height, pixels }
    }

    fn from_fn(width: usize, height: usize, mut f: impl FnMut(usize, usize) -> [u8; 3]) -> Self {
        let at = |i: usize| f(i / width, i % width);
        let pixels = (0..width * height).map(at).map(|[r, g, b]| [r, g, b, 255]).collect();
        Self { width, height, pixels }
    }

    /// Mirrors it from left to right, and from top to bottom.
    fn flip(&mut self, [horizontally, vertically]: [bool; 2]) {
        if horizontally {
            self.pixels.chunks_exact_mut(self.width).for_each(<[_]>::reverse);
        }
        if vertically {
            let rows = self.pixels.chunks_exact(self.width).rev();
            self.pixels = rows.flatten().copied().collect();
        }
    }

    /// Copies a square of it.
    fn part(&self, row: usize, column: usize, side: usize) -> Self {
        let line = |y: usize| &self.pixels[y * self.width + column..][..side];
        Self {
            width: side,
            height: side,
            pixels: (row..row + side).flat_map(line).copied().collect(),
        }
    }

    /// Creates the next mip level: a bilinear reduction, rounded to bytes.
    fn halved(&self) -> Self {
        let (w, h) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut pixels = Vec::with_capacity(w * h);
        // Mesa averages four texels in integers where they pair up, and interpolates elsewhere; both as it rounds
        if self.width == 2 * w && self.height == 2 * h {
            for y in 0..h {
                let upper = &self.pixels[2 * y * self.width..][..self.width];
                let lower = &self.pixels[(2 * y + 1) * self.width..][..self.width];
                for (a, b) in upper.chunks_exact(2).zip(lower.chunks_exact(2)) {
                    let sum =
                        |c: usize| u16::from(a[0][c]) + u16::from(a[1][c]) + u16::from(b[0][c]) + u16::from(b[1][c]);
                    pixels.push([0, 1, 2, 3].map(|c| ((sum(c) + 2) / 4) as u8));
                }
            }
        } else {
            let place = |i: usize, from: usize, to: usize| {
                let x = ((i as f32 + 0.5) * (from as f32 / to as f32) - 0.5).max(0.0);
                let low = (x as usize).min(from - 1);
                (low, (low + 1).min(from - 1), x - low as f32)
            };
            for y in 0..h {
                let (y0, y1, ty) = place(y, self.height, h);
                for x in 0..w {
                    let (x0, x1, tx) = place(x, self.width, w);
                    let mix = |c: usize| {
                        let at = |x: usize, y: usize| f32::from(self.pixels[y * self.width + x][c]);
                        let upper = at(x0, y0) * (1.0 - tx) + at(x1, y0) * tx;
                        let lower = at(x0, y1) * (1.0 - tx) + at(x1, y1) * tx;
                        (upper * (1.0 - ty) + lower * ty + 0.5) as u8
                    };
                    pixels.push([0, 1, 2, 3].map(mix));
                }
            }
        }
        Self {
            width: w,
            height: h,
            pixels,
        }
    }

    fn face(mut self) -> MipChain {
        while self.width.max(self.height) > MAX_TEXTURE {
            self = self.halved();
        }
        let mut levels = vec![self];
        while let Some(last) = levels.last().filter(|l| l.width.max(l.height) > 1) {
            levels.push(last.halved());
        }
        plain::mark(&mut levels);
        Arc::new(levels)
    }
}

/// A loader of textures that decodes an image used by several only once.
pub struct TextureLoader<'a> {
    assets: &'a dyn AssetSource,
    /// Images by path and mirroring.
    faces: BTreeMap<(String, [bool; 2]), MipChain>,
    /// Number of pixels that may still be created.
    left: usize,
}

impl<'a> TextureLoader<'a> {
    /// Creates a loader that reads images from `assets`.
    pub fn new(assets: &'a dyn AssetSource) -> Self {
        Self {
            assets,
            faces: BTreeMap::new(),
            left: Limits::DEFAULT.texture_pixels,
        }
    }

    /// Creates a texture.
    ///
    /// # Errors
    /// Fails if an image is missing, broken, too large or of a shape that does not fit, or if all textures together are too large.
    pub fn texture(&mut self, recipe: &Recipe) -> Result<TexturePixels, RenderError> {
        let wrong = |message: String| RenderError::Texture {
            name: recipe.name.clone(),
            message,
        };
        let size = |n: usize| {
            if (1..=MAX_PATTERN).contains(&n) {
                Ok(n)
            } else {
                Err(wrong(format!("its size is {n} pixels; a side has 1 to {MAX_PATTERN}")))
            }
        };
        let flat = recipe.kind == TextureType::Flat2d;
        if recipe.builtin != Builtin::None {
            let width = size(recipe.width)?;
            let height = if flat { size(recipe.height)? } else { 6 * width };
            self.take(width * height).map_err(wrong)?;
            return Ok(if flat {
                TexturePixels::Flat(flat_builtin(recipe, width, height).face())
            } else {
                let mut dice = Mt19937::new(MARK_SEED);
                let faces = [0, 1, 2, 3, 4, 5].map(|side| cube_builtin(recipe, width, side, &mut dice).face());
                TexturePixels::Cube(Cube::new(faces))
            });
        }
        if let Some(path) = &recipe.file {
            if flat {
                return Ok(TexturePixels::Flat(self.image(path, recipe.flip)?));
            }
            return self.cube_of_one(recipe, path);
        }
        if flat {
            return Err(wrong("it has neither an image file nor a builtin pattern".to_string()));
        }
        let mut faces: [Option<MipChain>; 6] = Default::default();
        let mut side = None;
        for (face, path) in faces.iter_mut().zip(&recipe.cube_files) {
            let Some(path) = path else { continue };
            let image = self.image(path, recipe.flip)?;
            let (w, h) = (image[0].width, image[0].height);
            if w != h || side.is_some_and(|s| s != w) {
                return Err(wrong(format!(
                    "\"{path}\" has {w} x {h} pixels (after reduction); the faces of a cube are squares of the same size"
                )));
            }
            side = Some(w);
            *face = Some(image);
        }
        let Some(side) = side else {
            return Err(wrong("it has neither an image file nor a builtin pattern".to_string()));
        };
        let plain = MipLevel::filled(side, side, truncated(recipe.rgb1)).face();
        let faces = faces.map(|f| f.unwrap_or_else(|| plain.clone()));
        Ok(TexturePixels::Cube(Cube::new(faces)))
    }

    /// Checks the texture of a drawable that is blended.
    ///
    /// # Errors
    /// Fails if its image is read with opacities, by which MuJoCo multiplies there, and has some.
    pub fn blended(&self, recipe: &Recipe) -> Result<(), RenderError> {
        let (4, Some(path)) = (recipe.channels, &recipe.file) else {
            return Ok(());
        };
        let opaque = is_opaque(&self.assets.read(path)?, &Limits::DEFAULT).map_err(|message| RenderError::Image {
            path: path.clone(),
            message,
        })?;
        if opaque {
            return Ok(());
        }
        Err(RenderError::Texture {
            name: recipe.name.clone(),
            message: format!(
                "\"{path}\" has opacities, by which MuJoCo multiplies on planes seen from below and on what is transparent, and this \
                 renderer does not: leave nchannel=\"4\" out, or show it on an opaque geom that is not a plane"
            ),
        })
    }

    /// Creates a cube from a single image: a square for all faces, or a grid of squares.
    fn cube_of_one(&mut self, recipe: &Recipe, path: &str) -> Result<TexturePixels, RenderError> {
        let [rows, columns] = recipe.gridsize;
        if recipe.gridsize == [1, 1] {
            let face = self.image(path, recipe.flip)?;
            // MuJoCo repeats a square image on all six sides
            if face[0].width == face[0].height {
                return Ok(TexturePixels::Cube(Cube::new([0; 6].map(|_| face.clone()))));
            }
            return Err(RenderError::Texture {
                name: recipe.name.clone(),
                message: format!(
                    "\"{path}\" has {} x {} pixels (after reduction); a cube needs a square image",
                    face[0].width, face[0].height
                ),
            });
        }
        // squares are cut out before anything is reduced
        let image = self.level(path, recipe.flip)?;
        let side = image.width / columns;
        if side == 0 || side * columns != image.width || side * rows != image.height {
            return Err(RenderError::Texture {
                name: recipe.name.clone(),
                message: format!(
                    "\"{path}\" has {} x {} pixels, which are not {rows} rows of {columns} squares, as gridsize says",
                    image.width, image.height
                ),
            });
        }
        let plain = MipLevel::filled(side, side, truncated(recipe.rgb1)).face();
        let mut faces = [0; 6].map(|_| plain.clone());
        for (square, face) in recipe.gridlayout.iter().enumerate() {
            if let Some(face) = face {
                faces[*face] = image
                    .part(square / columns * side, square % columns * side, side)
                    .face();
            }
        }
        Ok(TexturePixels::Cube(Cube::new(faces)))
    }

    /// Counts the pixels of a texture before they are created. Fails if there are too many.
    fn take(&mut self, pixels: usize) -> Result<(), String> {
        let Some(left) = self.left.checked_sub(pixels) else {
            let most = Limits::DEFAULT.texture_pixels;
            return Err(format!(
                "with it the textures have more than {most} pixels; make them smaller, or fewer"
            ));
        };
        self.left = left;
        Ok(())
    }

    /// Decodes an image with its mip levels.
    fn image(&mut self, path: &str, flip: [bool; 2]) -> Result<MipChain, RenderError> {
        let key = (path.to_string(), flip);
        if let Some(face) = self.faces.get(&key) {
            return Ok(face.clone());
        }
        let face = self.level(path, flip)?.face();
        self.faces.insert(key, face.clone());
        Ok(face)
    }

    /// Decodes an image without mip levels, mirrored as requested.
    fn level(&mut self, path: &str, flip: [bool; 2]) -> Result<MipLevel, RenderError> {
        let bytes = self.assets.read(path)?;
        let mut level = decode(path, &bytes)?;
        self.take(level.pixels.len()).map_err(|message| RenderError::Image {
            path: path.to_string(),
            message,
        })?;
        level.flip(flip);
        Ok(level)
    }
}

fn decode(path: &str, bytes: &[u8]) -> Result<MipLevel, RenderError> {
    let picture = decode_png(bytes, &Limits::DEFAULT).map_err(|message| RenderError::Image {
        path: path.to_string(),
        message,
    })?;
    let (pixels, _) = picture.rgb.as_chunks::<3>();
    Ok(MipLevel {
        width: picture.width,
        height: picture.height,
        pixels: pixels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect(),
    })
}

/// Seed of random marks.
const MARK_SEED: u64 = 42;

#[cfg(test)]
mod tests;
