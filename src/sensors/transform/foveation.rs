//! Foveation: the centre of the retina has the highest resolution.

use super::{Signal, Transform};
use crate::spaces::NumpyRng;

/// Warps images so that the centre is enlarged and the edge compressed; size and corners stay.
///
/// A pixel at the distance r from the centre shows the image at R expm1((r / R) ln(1 + s)) / s, where R is the distance of
/// the corner and s the strength: at 10 the centre is enlarged 4.2 times. Colours and gray are interpolated between the
/// four nearest pixels, across the edge with the mirror image; distances and ids are those of the nearest pixel.
#[derive(Clone, Debug)]
pub struct Foveation {
    strength: f64,
    height: usize,
    width: usize,
    sources: Vec<PixelSource>,
    bytes: Vec<u8>,
    depth: Vec<f32>,
    segmentation: Vec<i32>,
}

/// The source pixels of a pixel.
#[derive(Clone, Copy, Debug)]
struct PixelSource {
    /// Upper left, upper right, lower left, lower right.
    pixels: [u32; 4],
    /// Position between them, right and down, 0 to 1.
    between: [f32; 2],
    nearest: u32,
}

impl Foveation {
    /// Creates the warp of images of `height` by `width` pixels. `strength` is at least 0, which leaves images unchanged.
    pub fn new(strength: f64, height: usize, width: usize) -> Self {
        let centre = [width as f64 / 2.0, height as f64 / 2.0];
        let radius = (centre[0] * centre[0] + centre[1] * centre[1]).sqrt();
        let log = pxfm::f_log1p(strength);
        let source = |x: usize, y: usize| {
            let off = [x as f64 - centre[0], y as f64 - centre[1]];
            let r = (off[0] * off[0] + off[1] * off[1]).sqrt();
            // limits of the formula at 0 / 0
            let shrunk = match (strength > 0.0, r > 0.0) {
                (false, _) => 1.0,
                (true, false) => log / strength,
                (true, true) => radius * pxfm::f_expm1(r / radius * log) / strength / r,
            };
            PixelSource::at(centre[0] + shrunk * off[0], centre[1] + shrunk * off[1], height, width)
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self {
            strength,
            height,
            width,
            sources: pixels.map(|(x, y)| source(x, y)).collect(),
            bytes: vec![0; 3 * height * width],
            depth: vec![0.0; height * width],
            segmentation: vec![0; height * width],
        }
    }

    /// Warps an image in place; `CHANNELS` values for each pixel.
    fn warp<const CHANNELS: usize>(&mut self, image: &mut [u8]) {
        let before = &mut self.bytes[..image.len()];
        before.copy_from_slice(image);
        let (before, _) = before.as_chunks::<CHANNELS>();
        let (pixels, _) = image.as_chunks_mut::<CHANNELS>();
        for (pixel, source) in pixels.iter_mut().zip(&self.sources) {
            let [a, b, c, d] = source.pixels.map(|p| before[p as usize]);
            let [right, down] = source.between;
            for k in 0..CHANNELS {
                let [a, b, c, d] = [a, b, c, d].map(|p| f32::from(p[k]));
                let (upper, lower) = (a + (b - a) * right, c + (d - c) * right);
                pixel[k] = (upper + (lower - upper) * down + 0.5) as u8;
            }
        }
    }
}

impl PixelSource {
    fn at(x: f64, y: f64, height: usize, width: usize) -> Self {
        let (left, top) = (x.floor(), y.floor());
        let pixel = |x: f64, y: f64| (reflected(y, height) * width + reflected(x, width)) as u32;
        Self {
            pixels: [
                pixel(left, top),
                pixel(left + 1.0, top),
                pixel(left, top + 1.0),
                pixel(left + 1.0, top + 1.0),
            ],
            between: [(x - left) as f32, (y - top) as f32],
            nearest: pixel((x + 0.5).floor(), (y + 0.5).floor()),
        }
    }
}

/// Returns the pixel at a position in a row or column, with mirror images beyond the edges.
fn reflected(place: f64, size: usize) -> usize {
    let size = size as i64;
    // mirror images repeat every two sizes
    let place = (place as i64).rem_euclid(2 * size);
    (if place < size { place } else { 2 * size - 1 - place }) as usize
}

/// Warps an image using the nearest source of each pixel.
fn pick<T: Copy>(image: &mut [T], before: &mut [T], sources: &[PixelSource]) {
    if image.is_empty() {
        return;
    }
    before.copy_from_slice(image);
    for (pixel, source) in image.iter_mut().zip(sources) {
        *pixel = before[source.nearest as usize];
    }
}

impl Transform for Foveation {
    fn describe(&self) -> String {
        format!("foveation of strength {}", self.strength)
    }

    fn apply(&mut self, signal: Signal<'_>, _: &mut NumpyRng) {
        if let Signal::Eye { images, height, width } = signal
            && [height, width] == [self.height, self.width]
        {
            self.warp::<3>(&mut images.rgb);
            self.warp::<1>(&mut images.gray);
            pick(&mut images.depth, &mut self.depth, &self.sources);
            pick(&mut images.segmentation, &mut self.segmentation, &self.sources);
        }
    }

    fn memory(&self) -> usize {
        self.sources.len() * size_of::<PixelSource>()
            + self.bytes.len()
            + 4 * (self.depth.len() + self.segmentation.len())
    }
}
