//! The layout of images: side by side in a few large textures, so that many cost one pass.

use super::GpuError;
use crate::View;

/// Largest side of a texture that holds several images: every device allows it, and with four samples and depth it
/// takes 128 MiB.
pub const SIDE: u32 = 2048;

/// The rectangle of an image, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Index of the texture.
    pub chunk: usize,
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// The rectangles of all images of a submission.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Atlas {
    /// Rectangles in the order of the images; those of a chunk are consecutive.
    pub tiles: Vec<Tile>,
    /// Width and height in use, for each texture.
    pub chunks: Vec<[u32; 2]>,
}

impl Atlas {
    /// Places images in rows or, if `apart` is set, each in the corner of its own texture. `most` is the largest side of a texture that the device
    /// allows.
    pub fn new(views: impl Iterator<Item = View>, most: u32, apart: bool) -> Result<Self, GpuError> {
        let side = if apart { 0 } else { SIDE.min(most) };
        let mut atlas = Self::default();
        let (mut x, mut y, mut row, mut used) = (0, 0, 0, [0, 0]);
        for view in views {
            let (width, height) = (view.width as u32, view.height as u32);
            if width.max(height) > most {
                return Err(GpuError::TooLarge {
                    what: "a picture's side in pixels",
                    needed: u64::from(width.max(height)),
                    limit: u64::from(most),
                });
            }
            if x > 0 && x + width > side {
                (x, y, row) = (0, y + row, 0);
            }
            // a new texture only where this one has an image: a single image may be larger than the usual side
            if y > 0 && y + height > side {
                atlas.chunks.push(used);
                (x, y, row, used) = (0, 0, 0, [0, 0]);
            }
            let chunk = atlas.chunks.len();
            atlas.tiles.push(Tile {
                chunk,
                x,
                y,
                width,
                height,
            });
            used = [used[0].max(x + width), used[1].max(y + height)];
            // texture gradients are shared by groups of 2 x 2 pixels
            x += width.next_multiple_of(2);
            row = row.max(height.next_multiple_of(2));
        }
        if !atlas.tiles.is_empty() {
            atlas.chunks.push(used);
        }
        Ok(atlas)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(sizes: &[(usize, usize)], most: u32) -> Result<Atlas, GpuError> {
        let view = |&(width, height): &(usize, usize)| View {
            camera: 0,
            width,
            height,
        };
        Atlas::new(sizes.iter().map(view), most, false)
    }

    #[test]
    fn pictures_never_overlap_and_stay_inside() {
        let sizes: Vec<_> = (0..700)
            .map(|k| (1 + (k * 7919) % 311, 1 + (k * 104_729) % 257))
            .chain([(4000, 3), (3, 4000), (4096, 4096), (64, 64)])
            .collect();
        let atlas = place(&sizes, 8192).unwrap();
        assert_eq!(atlas.tiles.len(), sizes.len());
        assert!(atlas.chunks.len() > 3);
        for (k, a) in atlas.tiles.iter().enumerate() {
            assert_eq!((a.width as usize, a.height as usize), sizes[k]);
            assert!(a.x % 2 == 0 && a.y % 2 == 0);
            let [w, h] = atlas.chunks[a.chunk];
            assert!(a.x + a.width <= w && a.y + a.height <= h, "{a:?}");
            for b in atlas.tiles[..k].iter().filter(|b| b.chunk == a.chunk) {
                let apart =
                    a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
                assert!(apart, "{a:?} {b:?}");
            }
        }
        assert!(atlas.tiles.is_sorted_by_key(|t| t.chunk));
    }

    #[test]
    fn a_thousand_eyes_fill_one_texture() {
        assert_eq!(place(&[(64, 64); 1024], 2048).unwrap().chunks, [[2048, 2048]]);
        assert_eq!(place(&[(64, 64); 1025], 2048).unwrap().chunks, [[2048, 2048], [64, 64]]);
        assert_eq!(place(&[], 2048).unwrap(), Atlas::default());
    }

    #[test]
    fn pictures_apart_have_a_texture_each() {
        let view = View {
            camera: 0,
            width: 5,
            height: 3,
        };
        let atlas = Atlas::new([view; 4].into_iter(), 2048, true).unwrap();
        assert_eq!(atlas.chunks, [[5, 3]; 4]);
        assert!(
            atlas
                .tiles
                .iter()
                .enumerate()
                .all(|(k, t)| (t.chunk, t.x, t.y) == (k, 0, 0))
        );
    }

    #[test]
    fn a_picture_larger_than_a_texture_is_an_error() {
        let error = place(&[(64, 64), (2049, 1)], 2048).unwrap_err();
        assert!(matches!(
            error,
            GpuError::TooLarge {
                needed: 2049,
                limit: 2048,
                ..
            }
        ));
    }
}
