//! Fourier transforms of pictures, with the same bits on every target.
//!
//! Of the libraries, `rustfft` and `realfft` choose their algorithm by the processor's instructions and take sines from the
//! platform, so that the last bits differ between machines.

use crate::physics::vectorize;

/// A picture of complex numbers, row by row, real and imaginary parts apart.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub re: Vec<f64>,
    pub im: Vec<f64>,
}

impl Plane {
    pub fn new(len: usize) -> Self {
        Self {
            re: vec![0.0; len],
            im: vec![0.0; len],
        }
    }
}

/// Unnormalised transforms of pictures of `height` by `width`.
#[derive(Clone, Debug)]
pub(super) struct Fourier {
    height: usize,
    width: usize,
    down: Columns,
    across: Columns,
    /// Room for the picture with rows and columns exchanged.
    turned: Plane,
}

impl Fourier {
    pub fn new(height: usize, width: usize) -> Self {
        Self {
            height,
            width,
            down: Columns::new(height, width),
            across: Columns::new(width, height),
            turned: Plane::new(height * width),
        }
    }

    /// Multiplies the spectrum of a picture by `transfer`, which stands column by column, and transforms it back.
    pub fn filter(&mut self, picture: &mut Plane, transfer: &[f64]) {
        let (height, width) = (self.height, self.width);
        let turned = &mut self.turned;
        vectorize(
            #[inline(always)]
            || {
                self.down.forward(picture);
                // a transform works on all columns side by side, as vector instructions like it; transposed, the rows
                // are columns
                turn(picture, turned, height, width);
                self.across.forward(turned);
                for ((re, im), t) in turned.re.iter_mut().zip(&mut turned.im).zip(transfer) {
                    (*re, *im) = (*re * t, *im * t);
                }
                self.across.backward(turned);
                turn(turned, picture, width, height);
                self.down.backward(picture);
                let share = 1.0 / (height * width) as f64;
                for v in picture.re.iter_mut().chain(&mut picture.im) {
                    *v *= share;
                }
            },
        );
    }
}

/// Filters of pictures that go on beyond their borders as in a mirror: cosine transforms, each by a Fourier transform of the same
/// length (J. Makhoul, "A Fast Cosine Transform in One and Two Dimensions", 1980).
#[derive(Clone, Debug)]
pub(super) struct Mirrored {
    height: usize,
    width: usize,
    down: Cosines,
    across: Cosines,
    /// Room for the picture with rows and columns exchanged.
    turned: Plane,
}

impl Mirrored {
    pub fn new(height: usize, width: usize) -> Self {
        Self {
            height,
            width,
            down: Cosines::new(height, width),
            across: Cosines::new(width, height),
            turned: Plane::new(height * width),
        }
    }

    /// Multiplies the spectrum of a picture by `transfer`, which stands column by column, and transforms it back. Number k of a
    /// column is the frequency of k half waves over the height.
    pub fn filter(&mut self, picture: &mut Plane, transfer: &[f64]) {
        let (height, width) = (self.height, self.width);
        let turned = &mut self.turned;
        vectorize(
            #[inline(always)]
            || {
                self.down.forward(picture);
                turn(picture, turned, height, width);
                self.across.forward(turned);
                for ((re, im), t) in turned.re.iter_mut().zip(&mut turned.im).zip(transfer) {
                    (*re, *im) = (*re * t, *im * t);
                }
                self.across.backward(turned);
                turn(turned, picture, width, height);
                self.down.backward(picture);
                let share = 1.0 / (height * width) as f64;
                for v in picture.re.iter_mut().chain(&mut picture.im) {
                    *v *= share;
                }
            },
        );
    }
}

/// Cosine transforms of all columns of a picture at once.
#[derive(Clone, Debug)]
struct Cosines {
    length: usize,
    width: usize,
    columns: Columns,
    /// Cosine and sine of pi k / 2 n.
    quarter: Vec<[f64; 2]>,
    /// Room for the picture in another order of its rows.
    room: Plane,
}

impl Cosines {
    fn new(length: usize, width: usize) -> Self {
        let quarter = |k: usize| {
            let (sin, cos) = pxfm::f_sincospi(k as f64 / (2 * length) as f64);
            [cos, sin]
        };
        Self {
            length,
            width,
            columns: Columns::new(length, width),
            quarter: (0..length).map(quarter).collect(),
            room: Plane::new(length * width),
        }
    }

    /// Returns which row of the picture stands at a place in the Fourier transform: those of even number, then the odd ones backwards.
    #[inline(always)]
    fn row_at(&self, place: usize) -> usize {
        let n = self.length;
        if 2 * place < n {
            2 * place
        } else {
            2 * (n - 1 - place) + 1
        }
    }

    #[inline(always)]
    fn forward(&mut self, plane: &mut Plane) {
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
    #[inline(always)]
    fn backward(&mut self, plane: &mut Plane) {
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

    /// Replaces the numbers in rows k and n - k by what `exchange` makes of them and of cosine and sine; row 0 stays.
    #[inline(always)]
    fn pairs(&self, plane: &mut Plane, exchange: impl Fn([f64; 2], [f64; 2], [f64; 2]) -> [[f64; 2]; 2]) {
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

/// Transposes an image of `rows` rows and `columns` columns.
#[inline(always)]
fn turn(from: &Plane, to: &mut Plane, rows: usize, columns: usize) {
    for (from, to) in [(&from.re, &mut to.re), (&from.im, &mut to.im)] {
        for (row, values) in from.chunks_exact(columns).enumerate() {
            for (column, v) in values.iter().enumerate() {
                to[column * rows + row] = *v;
            }
        }
    }
}

/// Transforms of all columns of a picture at once.
#[derive(Clone, Debug)]
enum Columns {
    /// Lengths that are powers of two.
    Halved(Halved),
    /// Any other length, as a convolution with a chirp (L. I. Bluestein, "A Linear Filtering Approach to the Computation
    /// of Discrete Fourier Transform", 1970).
    Chirped(Box<Chirped>),
}

impl Columns {
    /// Makes the transform of columns of a length; rows have `width` values.
    fn new(length: usize, width: usize) -> Self {
        if length.is_power_of_two() {
            Self::Halved(Halved::new(length, width))
        } else {
            Self::Chirped(Box::new(Chirped::new(length, width)))
        }
    }

    #[inline(always)]
    fn forward(&mut self, plane: &mut Plane) {
        match self {
            Self::Halved(halved) => halved.transform(&mut plane.re, &mut plane.im),
            Self::Chirped(chirped) => chirped.transform(&mut plane.re, &mut plane.im),
        }
    }

    /// Transforms with the opposite sign of the exponent: the same with real and imaginary parts exchanged.
    #[inline(always)]
    fn backward(&mut self, plane: &mut Plane) {
        match self {
            Self::Halved(halved) => halved.transform(&mut plane.im, &mut plane.re),
            Self::Chirped(chirped) => chirped.transform(&mut plane.im, &mut plane.re),
        }
    }
}

/// Returns cosine and sine of -2 pi k / n.
fn root(k: usize, n: usize) -> [f64; 2] {
    let (sin, cos) = pxfm::f_sincospi(2.0 * k as f64 / n as f64);
    [cos, -sin]
}

/// The transform by halves (J. W. Cooley and J. W. Tukey, 1965).
#[derive(Clone, Debug)]
struct Halved {
    length: usize,
    width: usize,
    /// The first half of the roots of unity.
    roots: Vec<[f64; 2]>,
}

impl Halved {
    fn new(length: usize, width: usize) -> Self {
        Self {
            length,
            width,
            roots: (0..length / 2).map(|k| root(k, length)).collect(),
        }
    }

    #[inline(always)]
    fn transform(&self, re: &mut [f64], im: &mut [f64]) {
        let (n, w) = (self.length, self.width);
        let bits = n.trailing_zeros();
        for row in 1..n {
            // the decimation in time takes its input in bit-reversed order
            let other = row.reverse_bits() >> (usize::BITS - bits);
            if row < other {
                for v in [&mut *re, &mut *im] {
                    let (low, high) = v.split_at_mut(other * w);
                    low[row * w..(row + 1) * w].swap_with_slice(&mut high[..w]);
                }
            }
        }
        let mut half = 1;
        while half < n {
            let blocks = re.chunks_exact_mut(2 * half * w).zip(im.chunks_exact_mut(2 * half * w));
            for (re, im) in blocks {
                let (re_low, re_high) = re.split_at_mut(half * w);
                let (im_low, im_high) = im.split_at_mut(half * w);
                for k in 0..half {
                    let row = k * w..(k + 1) * w;
                    butterfly(
                        self.roots[k * (n / 2 / half)],
                        [&mut re_low[row.clone()], &mut im_low[row.clone()]],
                        [&mut re_high[row.clone()], &mut im_high[row]],
                    );
                }
            }
            half *= 2;
        }
    }
}

/// Replaces two rows by a + r b and a - r b.
#[inline(always)]
fn butterfly([cos, sin]: [f64; 2], [a_re, a_im]: [&mut [f64]; 2], [b_re, b_im]: [&mut [f64]; 2]) {
    let a = a_re.iter_mut().zip(a_im);
    for ((a_re, a_im), (b_re, b_im)) in a.zip(b_re.iter_mut().zip(b_im)) {
        let (re, im) = (cos * *b_re - sin * *b_im, cos * *b_im + sin * *b_re);
        (*b_re, *b_im) = (*a_re - re, *a_im - im);
        (*a_re, *a_im) = (*a_re + re, *a_im + im);
    }
}

/// The transform of any length by those of a power of two.
#[derive(Clone, Debug)]
struct Chirped {
    width: usize,
    halved: Halved,
    /// exp(-i pi k^2 / n).
    chirp: Vec<[f64; 2]>,
    /// The spectrum of the conjugate chirp over the length of `halved`.
    spectrum: Vec<[f64; 2]>,
    room: Plane,
}

impl Chirped {
    fn new(length: usize, width: usize) -> Self {
        let long = (2 * length - 1).next_power_of_two();
        // k^2 modulo 2 n: the same angle, but small enough to be exact
        let chirp: Vec<_> = (0..length).map(|k| root(k * k % (2 * length), 2 * length)).collect();
        let mut kernel = Plane::new(long);
        for (k, [cos, sin]) in chirp.iter().enumerate() {
            // the convolution needs the chirp at k and -k: it wraps around the end of the long transform
            for at in [k, (long - k) % long] {
                (kernel.re[at], kernel.im[at]) = (cos / long as f64, -sin / long as f64);
            }
        }
        Halved::new(long, 1).transform(&mut kernel.re, &mut kernel.im);
        Self {
            width,
            halved: Halved::new(long, width),
            chirp,
            spectrum: kernel.re.into_iter().zip(kernel.im).map(<[f64; 2]>::from).collect(),
            room: Plane::new(long * width),
        }
    }

    #[inline(always)]
    fn transform(&mut self, re: &mut [f64], im: &mut [f64]) {
        let w = self.width;
        let Plane {
            re: long_re,
            im: long_im,
        } = &mut self.room;
        long_re[re.len()..].fill(0.0);
        long_im[im.len()..].fill(0.0);
        long_re[..re.len()].copy_from_slice(re);
        long_im[..im.len()].copy_from_slice(im);
        multiply(&self.chirp, w, long_re, long_im);
        self.halved.transform(long_re, long_im);
        multiply(&self.spectrum, w, long_re, long_im);
        // real and imaginary parts exchanged: the inverse, whose 1 / n is in the kernel
        self.halved.transform(long_im, long_re);
        multiply(&self.chirp, w, long_re, long_im);
        re.copy_from_slice(&long_re[..re.len()]);
        im.copy_from_slice(&long_im[..im.len()]);
    }
}

/// Multiplies each row by a number.
#[inline(always)]
fn multiply(factors: &[[f64; 2]], width: usize, re: &mut [f64], im: &mut [f64]) {
    let rows = re.chunks_exact_mut(width).zip(im.chunks_exact_mut(width));
    for ([cos, sin], (re, im)) in factors.iter().zip(rows) {
        for (re, im) in re.iter_mut().zip(im) {
            (*re, *im) = (cos * *re - sin * *im, cos * *im + sin * *re);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spaces::NumpyRng;

    /// The transform by its definition.
    fn slow(picture: &Plane, height: usize, width: usize) -> Plane {
        let mut out = Plane::new(height * width);
        for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let [c, s] = root(v * y % height, height);
                let [d, t] = root(u * x % width, width);
                let (cos, sin) = (c * d - s * t, c * t + s * d);
                let (re, im) = (picture.re[y * width + x], picture.im[y * width + x]);
                out.re[v * width + u] += cos * re - sin * im;
                out.im[v * width + u] += cos * im + sin * re;
            }
        }
        out
    }

    #[test]
    fn transforms_of_all_sizes_are_those_of_the_definition() {
        let mut rng = NumpyRng::seed(0);
        for (height, width) in [
            (1, 1),
            (1, 7),
            (2, 3),
            (4, 4),
            (5, 8),
            (6, 6),
            (9, 5),
            (16, 12),
            (17, 1),
        ] {
            let mut picture = Plane::new(height * width);
            for v in picture.re.iter_mut().chain(&mut picture.im) {
                *v = rng.uniform() - 0.5;
            }
            let transfer: Vec<f64> = (0..height * width).map(|_| rng.uniform()).collect();
            // the definition, multiplied and transformed back by conjugation
            let mut spectrum = slow(&picture, height, width);
            for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
                let (at, t) = (v * width + u, transfer[u * height + v] / (height * width) as f64);
                (spectrum.re[at], spectrum.im[at]) = (spectrum.re[at] * t, -spectrum.im[at] * t);
            }
            let expect = slow(&spectrum, height, width);
            Fourier::new(height, width).filter(&mut picture, &transfer);
            for k in 0..height * width {
                let off = (picture.re[k] - expect.re[k]).hypot(picture.im[k] + expect.im[k]);
                assert!(off < 1e-13, "{height} x {width}: {off:e} off at {k}");
            }
        }
    }

    #[test]
    fn mirrored_filters_are_those_of_pictures_with_their_mirror_images() {
        let mut rng = NumpyRng::seed(1);
        for (height, width) in [
            (1, 1),
            (1, 7),
            (2, 3),
            (4, 4),
            (5, 8),
            (6, 6),
            (9, 5),
            (16, 12),
            (17, 1),
        ] {
            let mut picture = Plane::new(height * width);
            for v in picture.re.iter_mut().chain(&mut picture.im) {
                *v = rng.uniform() - 0.5;
            }
            let transfer: Vec<f64> = (0..height * width).map(|_| rng.uniform()).collect();
            let mirror = |i: usize, n: usize| if i < n { i } else { 2 * n - 1 - i };
            let mut whole = Plane::new(4 * height * width);
            let mut twice = vec![0.0; 4 * height * width];
            for (y, x) in (0..2 * height).flat_map(|y| (0..2 * width).map(move |x| (y, x))) {
                let from = mirror(y, height) * width + mirror(x, width);
                let at = y * 2 * width + x;
                (whole.re[at], whole.im[at]) = (picture.re[from], picture.im[from]);
                // a frequency and its negative; that of the whole length has no share in what is mirrored
                let [v, u] = [(y, height), (x, width)].map(|(k, n)| if k <= n { k } else { 2 * n - k });
                if v < height && u < width {
                    twice[x * 2 * height + y] = transfer[u * height + v];
                }
            }
            Fourier::new(2 * height, 2 * width).filter(&mut whole, &twice);
            Mirrored::new(height, width).filter(&mut picture, &transfer);
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let (k, at) = (y * width + x, y * 2 * width + x);
                let off = (picture.re[k] - whole.re[at]).hypot(picture.im[k] - whole.im[at]);
                assert!(off < 1e-13, "{height} x {width}: {off:e} off at {y}, {x}");
            }
        }
    }
}
