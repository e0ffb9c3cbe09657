//! Fourier transforms of columns of any length.

use super::{ColumnTransform, ComplexPicture};

/// Transforms of all columns of a picture at once.
#[derive(Clone, Debug)]
pub enum FourierColumns {
    /// Lengths that are powers of two.
    PowerOfTwo(RadixTwo),
    /// Any other length, as a convolution with a chirp (L. I. Bluestein, "A Linear Filtering Approach to the Computation
    /// of Discrete Fourier Transform", 1970).
    AnyLength(Box<ChirpTransform>),
}

impl ColumnTransform for FourierColumns {
    fn new(length: usize, width: usize) -> Self {
        if length.is_power_of_two() {
            Self::PowerOfTwo(RadixTwo::new(length, width))
        } else {
            Self::AnyLength(Box::new(ChirpTransform::new(length, width)))
        }
    }

    #[inline(always)]
    fn forward(&mut self, plane: &mut ComplexPicture) {
        match self {
            Self::PowerOfTwo(halved) => halved.transform(&mut plane.re, &mut plane.im),
            Self::AnyLength(chirped) => chirped.transform(&mut plane.re, &mut plane.im),
        }
    }

    /// Transforms with the opposite sign of the exponent: the same with real and imaginary parts exchanged.
    #[inline(always)]
    fn backward(&mut self, plane: &mut ComplexPicture) {
        match self {
            Self::PowerOfTwo(halved) => halved.transform(&mut plane.im, &mut plane.re),
            Self::AnyLength(chirped) => chirped.transform(&mut plane.im, &mut plane.re),
        }
    }
}

/// Returns cosine and sine of -2 pi k / n.
pub fn root(k: usize, n: usize) -> [f64; 2] {
    let (sin, cos) = pxfm::f_sincospi(2.0 * k as f64 / n as f64);
    [cos, -sin]
}

/// The transform by halves (J. W. Cooley and J. W. Tukey, 1965).
#[derive(Clone, Debug)]
pub struct RadixTwo {
    length: usize,
    width: usize,
    /// The first half of the roots of unity.
    roots: Vec<[f64; 2]>,
}

impl RadixTwo {
    fn new(length: usize, width: usize) -> Self {
        Self {
            length,
            width,
            roots: (0..length / 2).map(|k| root(k, length)).collect(),
        }
    }

    // on other targets `vectorize` has one version, which each of a filter's calls would inline
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
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
pub struct ChirpTransform {
    width: usize,
    halved: RadixTwo,
    /// exp(-i pi k^2 / n).
    chirp: Vec<[f64; 2]>,
    /// The spectrum of the conjugate chirp over the length of `halved`.
    spectrum: Vec<[f64; 2]>,
    room: ComplexPicture,
}

impl ChirpTransform {
    fn new(length: usize, width: usize) -> Self {
        let long = (2 * length - 1).next_power_of_two();
        // k^2 modulo 2 n: the same angle, but small enough to be exact
        let chirp: Vec<_> = (0..length).map(|k| root(k * k % (2 * length), 2 * length)).collect();
        let mut kernel = ComplexPicture::new(long);
        for (k, [cos, sin]) in chirp.iter().enumerate() {
            // the convolution needs the chirp at k and -k: it wraps around the end of the long transform
            for at in [k, (long - k) % long] {
                (kernel.re[at], kernel.im[at]) = (cos / long as f64, -sin / long as f64);
            }
        }
        RadixTwo::new(long, 1).transform(&mut kernel.re, &mut kernel.im);
        Self {
            width,
            halved: RadixTwo::new(long, width),
            chirp,
            spectrum: kernel.re.into_iter().zip(kernel.im).map(<[f64; 2]>::from).collect(),
            room: ComplexPicture::new(long * width),
        }
    }

    // on other targets `vectorize` has one version, which each of a filter's calls would inline
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn transform(&mut self, re: &mut [f64], im: &mut [f64]) {
        let w = self.width;
        let ComplexPicture {
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
