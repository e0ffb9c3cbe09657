//! MuJoCo's procedural textures.

use super::{MARK_SEED, MipLevel};
use crate::model::{Builtin, Mark, Texture as Recipe};

/// Converts a colour to bytes, rounding down as MuJoCo does.
pub fn truncated(rgb: [f64; 3]) -> [u8; 3] {
    rgb.map(|v| (255.0 * v) as u8)
}

/// Interpolates from `b` to `a` along MuJoCo's soft step.
fn interpolate(a: [f64; 3], b: [f64; 3], pos: f64) -> [u8; 3] {
    let alpha = (0.5 * (1.0 + pos / (1.0 + pos * pos).sqrt() * std::f64::consts::SQRT_2)).clamp(0.0, 1.0);
    [0, 1, 2].map(|k| (255.0 * (alpha * a[k] + (1.0 - alpha) * b[k])) as u8)
}

/// The 64-bit Mersenne Twister (Matsumoto and Nishimura), with which MuJoCo places random marks.
pub struct Mt19937 {
    words: [u64; 312],
    next: usize,
}

impl Mt19937 {
    pub fn new(seed: u64) -> Self {
        let mut words = [seed; 312];
        for i in 1..312 {
            let last = words[i - 1];
            words[i] = (last ^ last >> 62)
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(i as u64);
        }
        Self { words, next: 312 }
    }

    fn next(&mut self) -> u64 {
        // the constants of MT19937-64
        const UPPER: u64 = !0 << 31;
        if self.next == 312 {
            for i in 0..312 {
                let x = self.words[i] & UPPER | self.words[(i + 1) % 312] & !UPPER;
                let odd = if x & 1 == 1 { 0xb502_6f5a_a966_19e9 } else { 0 };
                self.words[i] = self.words[(i + 156) % 312] ^ x >> 1 ^ odd;
            }
            self.next = 0;
        }
        let mut x = self.words[self.next];
        self.next += 1;
        x ^= x >> 29 & 0x5555_5555_5555_5555;
        x ^= x << 17 & 0x71d6_7fff_eda6_0000;
        x ^= x << 37 & 0xfff7_eee0_0000_0000;
        x ^ x >> 43
    }

    /// Draws a number in 0..1.
    fn uniform(&mut self) -> f64 {
        self.next() as f64 / 18_446_744_073_709_551_616.0
    }
}

/// Draws marks.
pub fn marked(recipe: &Recipe, mut level: MipLevel, dice: &mut Mt19937) -> MipLevel {
    let (w, h) = (level.width, level.height);
    let [r, g, b] = truncated(recipe.markrgb);
    let colour = [r, g, b, 255];
    for (i, pixel) in level.pixels.iter_mut().enumerate() {
        let (row, column) = (i / w, i % w);
        let on = match recipe.mark {
            Mark::Edge => row == 0 || column == 0 || row == h - 1 || column == w - 1,
            Mark::Cross => row == h / 2 || column == w / 2,
            Mark::Random => dice.uniform() < recipe.random,
            Mark::None => false,
        };
        if on {
            *pixel = colour;
        }
    }
    level
}

/// Maps a pixel to -1..1 along an edge.
fn across(i: usize, n: usize) -> f64 {
    2.0 * i as f64 / (n as f64 - 1.0).max(1.0) - 1.0
}

fn checker(w: usize, h: usize, row: usize, column: usize) -> bool {
    (row < h / 2) == (column < w / 2)
}

pub fn flat_builtin(recipe: &Recipe, w: usize, h: usize) -> MipLevel {
    let (one, two) = (truncated(recipe.rgb1), truncated(recipe.rgb2));
    let level = MipLevel::from_fn(w, h, |row, column| match recipe.builtin {
        Builtin::Gradient => {
            let (x, y) = (across(column, w), -across(row, h));
            interpolate(recipe.rgb2, recipe.rgb1, 2.0 * (x * x + y * y).sqrt() - 1.0)
        }
        Builtin::Checker if !checker(w, h, row, column) => two,
        _ => one,
    });
    marked(recipe, level, &mut Mt19937::new(MARK_SEED))
}

pub fn cube_builtin(recipe: &Recipe, w: usize, side: usize, dice: &mut Mt19937) -> MipLevel {
    use std::f64::consts::FRAC_PI_2;
    let (one, two) = (truncated(recipe.rgb1), truncated(recipe.rgb2));
    let level = match recipe.builtin {
        Builtin::Gradient => MipLevel::from_fn(w, w, |row, column| {
            let (x, y) = (across(column, w), -across(row, w));
            let steep = || 1.0 - pxfm::f_acos(1.0 / (1.0 + x * x + y * y).sqrt()) / FRAC_PI_2;
            let elevation = match side {
                2 => steep(),
                3 => -steep(),
                _ => pxfm::f_asin(y / (1.0 + x * x + y * y).sqrt()) / FRAC_PI_2,
            };
            interpolate(recipe.rgb1, recipe.rgb2, elevation)
        }),
        Builtin::Checker => MipLevel::from_fn(w, w, |row, column| {
            if checker(w, w, row, column) == (side < 4) {
                one
            } else {
                two
            }
        }),
        _ => MipLevel::filled(w, w, if side == 3 { two } else { one }),
    };
    marked(recipe, level, dice)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_twister_is_the_standard_one() {
        // the C++ standard gives the 10,000th word of the default seed
        let mut twister = Mt19937::new(5489);
        let last = (0..10_000).map(|_| twister.next()).last();
        assert_eq!(last, Some(9_981_545_732_273_789_042));
    }
}
