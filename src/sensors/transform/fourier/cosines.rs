//! Cosine transforms of columns, each by a Fourier transform of the same length (J. Makhoul, "A Fast Cosine Transform in One and Two
//! Dimensions", 1980).

use super::columns::FourierColumns;
use super::{ColumnTransform, ComplexPicture};

/// Cosine transforms of all columns of a picture at once.
#[derive(Clone, Debug)]
pub struct CosineColumns {
    length: usize,
    width: usize,
    columns: FourierColumns,
    /// Cosine and sine of pi k / 2 n.
    quarter: Vec<[f64; 2]>,
    /// A buffer for the picture with its rows in another order.
    room: ComplexPicture,
}

impl ColumnTransform for CosineColumns {
    fn new(length: usize, width: usize) -> Self {
        let quarter = |k: usize| {
            let (sin, cos) = pxfm::f_sincospi(k as f64 / (2 * length) as f64);
            [cos, sin]
        };
        Self {
            length,
            width,
            columns: FourierColumns::new(length, width),
            quarter: (0..length).map(quarter).collect(),
            room: ComplexPicture::new(length * width),
        }
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn forward(&mut self, plane: &mut ComplexPicture) {
        let (n, w) = (self.length, self.width);
        for place in 0..n {
            let (from, to) = (self.row_at(place) * w, place * w);
            self.room.re[to..to + w].copy_from_slice(&plane.re[from..from + w]);
            self.room.im[to..to + w].copy_from_slice(&plane.im[from..from + w]);
        }
        std::mem::swap(plane, &mut self.room);
        self.columns.forward(plane);
        self.pairs(
            plane,
            #[inline(always)]
            |[c, s], [a_re, a_im], [b_re, b_im]| {
                let (sum_re, sum_im, less_re, less_im) = (a_re + b_re, a_im + b_im, a_re - b_re, a_im - b_im);
                let first = [0.5 * (c * sum_re + s * less_im), 0.5 * (c * sum_im - s * less_re)];
                let second = [0.5 * (s * sum_re - c * less_im), 0.5 * (s * sum_im + c * less_re)];
                [first, second]
            },
        );
    }

    /// The inverse, n times as large.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn backward(&mut self, plane: &mut ComplexPicture) {
        let (n, w) = (self.length, self.width);
        self.pairs(
            plane,
            #[inline(always)]
            |[c, s], [a_re, a_im], [b_re, b_im]| {
                let (p_re, p_im, q_re, q_im) = (a_re + b_im, a_im - b_re, b_re + a_im, b_im - a_re);
                [
                    [c * p_re - s * p_im, c * p_im + s * p_re],
                    [s * q_re - c * q_im, s * q_im + c * q_re],
                ]
            },
        );
        self.columns.backward(plane);
        for place in 0..n {
            let (from, to) = (place * w, self.row_at(place) * w);
            self.room.re[to..to + w].copy_from_slice(&plane.re[from..from + w]);
            self.room.im[to..to + w].copy_from_slice(&plane.im[from..from + w]);
        }
        std::mem::swap(plane, &mut self.room);
    }
}

impl CosineColumns {
    /// Returns the row of the picture at an index of the Fourier transform: the even rows, then the odd ones backwards.
    #[inline(always)]
    fn row_at(&self, place: usize) -> usize {
        let n = self.length;
        if 2 * place < n {
            2 * place
        } else {
            2 * (n - 1 - place) + 1
        }
    }

    /// Replaces the numbers in rows k and n - k by the result of `exchange`, which gets them, the cosine and the sine; row 0 stays.
    #[inline(always)]
    fn pairs(&self, plane: &mut ComplexPicture, exchange: impl Fn([f64; 2], [f64; 2], [f64; 2]) -> [[f64; 2]; 2]) {
        let (n, w) = (self.length, self.width);
        for k in 1..=n / 2 {
            let (low, high, turn) = (k * w, (n - k) * w, self.quarter[k]);
            for i in 0..w {
                let (a, b) = (low + i, high + i);
                let [first, second] = exchange(turn, [plane.re[a], plane.im[a]], [plane.re[b], plane.im[b]]);
                // in the middle both are the same row
                ([plane.re[b], plane.im[b]], [plane.re[a], plane.im[a]]) = (second, first);
            }
        }
    }
}
