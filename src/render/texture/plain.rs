//! Marks texels around which a texture has one colour, so lookups need no interpolation.

use super::MipLevel;

/// Fourth byte of a texel that may have a neighbour of another colour.
pub const MIXED: u8 = 255;
/// Fourth byte of a texel if those to the right, below and diagonally between have the same colour.
pub const PLAIN: u8 = 254;
/// Fourth byte of a plain texel if the next level is plain, in the same colour, wherever a lookup between these four texels can lead. The last texel
/// of a level is settled if the level has one colour.
pub const SETTLED: u8 = 252;

/// Bound on the rounding of texture coordinates, texels.
const ROUNDING: f32 = 0.01;

/// Sets the fourth byte of each texel of a texture, which must be [`MIXED`] before.
pub fn mark(levels: &mut [MipLevel]) {
    for level in &mut *levels {
        let one = level.pixels.iter().all(|p| *p == level.pixels[0]);
        let MipLevel { width, pixels, .. } = level;
        for at in (0..pixels.len() - *width).step_by(*width) {
            let (upper, lower) = pixels[at..at + 2 * *width].split_at_mut(*width);
            for x in 1..*width {
                let colour = upper[x - 1];
                if upper[x] == colour && lower[x - 1] == colour && lower[x] == colour {
                    upper[x - 1][3] = PLAIN;
                }
            }
        }
        if let Some(last) = pixels.last_mut()
            && one
        {
            last[3] = SETTLED;
        }
    }
    for k in 1..levels.len() {
        let (finer, coarser) = levels.split_at_mut(k);
        settle(&mut finer[k - 1], &coarser[0]);
    }
}

impl MipLevel {
    /// Returns whether all pixels have the same colour.
    #[inline(always)]
    pub(crate) fn has_one_colour(&self) -> bool {
        self.pixels.last().is_some_and(|p| p[3] == SETTLED)
    }
}

/// Finds the plain texels of a level that agree with the next level.
fn settle(level: &mut MipLevel, next: &MipLevel) {
    let columns: Vec<_> = (0..level.width).map(|x| reached(x, level.width, next.width)).collect();
    for y in 0..level.height {
        let Some([upper, lower]) = reached(y, level.height, next.height) else {
            continue;
        };
        for (pixel, columns) in level.pixels[y * level.width..].iter_mut().zip(&columns) {
            let (Some([left, right]), PLAIN) = (columns, pixel[3]) else {
                continue;
            };
            let agrees = |&[r, g, b, mark]: &[u8; 4]| [r, g, b] == pixel[..3] && mark != MIXED;
            let row = |y: usize| &next.pixels[y * next.width..][..next.width];
            if (upper..=lower).all(|y| row(y)[*left..=*right].iter().all(agrees)) {
                pixel[3] = SETTLED;
            }
        }
    }
}

/// Returns the first and the last texel of the next level, `to` texels wide, from which a lookup between a texel (of `from`) and the following one
/// starts; `None` if it may reach beyond the image.
fn reached(texel: usize, from: usize, to: usize) -> Option<[usize; 2]> {
    let place = |after: f32| (texel as f32 + 0.5 + after) * (to as f32 / from as f32) - 0.5;
    let (first, last) = ((place(0.0) - ROUNDING).floor(), (place(1.0) + ROUNDING).floor());
    (first >= 0.0 && last + 1.0 < to as f32).then_some([first as usize, last as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(width: usize, height: usize, colour: impl Fn(usize, usize) -> u8) -> MipLevel {
        let pixels = (0..width * height)
            .map(|i| [colour(i % width, i / width), 0, 0, MIXED])
            .collect();
        MipLevel { width, height, pixels }
    }

    #[test]
    fn marks_say_where_lookups_are_constant() {
        // a dark column on the left; the next level is gray beside it, and lighter on the right
        let fine = level(8, 8, |x, _| if x == 0 { 0 } else { 9 });
        let coarse = level(4, 4, |x, _| [5, 9, 9, 8][x]);
        let mut levels = [fine, coarse];
        mark(&mut levels);
        let row = |level: &MipLevel, y: usize| -> Vec<u8> {
            level.pixels[y * level.width..][..level.width]
                .iter()
                .map(|p| p[3])
                .collect()
        };
        assert_eq!(row(&levels[0], 7), [MIXED; 8]);
        assert_eq!(
            row(&levels[0], 3),
            [MIXED, PLAIN, PLAIN, SETTLED, PLAIN, PLAIN, PLAIN, MIXED]
        );
        assert_eq!(row(&levels[1], 0), [MIXED, PLAIN, MIXED, MIXED]);
        assert_eq!(row(&levels[1], 3), [MIXED; 4]);
    }

    #[test]
    fn the_last_texel_tells_of_one_colour() {
        let mut levels = [level(2, 3, |_, _| 7), level(1, 1, |_, _| 7)];
        mark(&mut levels);
        assert!(levels.iter().all(MipLevel::has_one_colour));
        assert_eq!(levels[0].pixels[1][3], MIXED);
    }
}
