//! The pixels of an image to compute: all of them, or those of an image of half the size.

/// The pixels of an image to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixels {
    /// Every pixel.
    All,
    /// Every second pixel of every second row, from the upper left.
    Second,
}

impl Pixels {
    /// Writes the colours of a block of 2 x 2 pixels, the lower two first, where they are wanted.
    #[inline(always)]
    pub fn write(self, out: &mut [u8], [w, h]: [usize; 2], [x, y]: [usize; 2], colours: &[[u8; 4]; 4]) {
        if self == Self::All && x + 1 < w && y + 1 < h {
            // nearly every block: two pixels at once, without a check for each
            for (up, pair) in colours.as_chunks().0.iter().enumerate() {
                let [left, right] = pair.map(|c| u64::from(u32::from_le_bytes(c)));
                let at = 3 * ((h - 1 - y - up) * w + x);
                out[at..at + 6].copy_from_slice(&(left | right << 24).to_le_bytes()[..6]);
            }
            return;
        }
        for (k, colour) in colours.iter().enumerate() {
            let (x, y) = (x + k % 2, y + k / 2);
            if x < w
                && y < h
                && let Some(at) = self.place(x, h - 1 - y, w)
            {
                out[3 * at..3 * at + 3].copy_from_slice(&colour[..3]);
            }
        }
    }

    /// Returns where a pixel goes, counted in pixels; `None` if it is not wanted. `y` is counted from the top.
    #[inline(always)]
    pub fn place(self, x: usize, y: usize, width: usize) -> Option<usize> {
        match self {
            Self::All => Some(y * width + x),
            Self::Second => (x.is_multiple_of(2) && y.is_multiple_of(2)).then(|| y / 2 * width.div_ceil(2) + x / 2),
        }
    }

    /// Returns which samples of a block of 2 x 2 pixels are wanted: four bits for each pixel, the lower two pixels
    /// first.
    pub fn of_block(self, height: usize) -> u32 {
        match self {
            Self::All => 0xffff,
            Self::Second if height.is_multiple_of(2) => 0x0f00,
            Self::Second => 0x000f,
        }
    }
}
