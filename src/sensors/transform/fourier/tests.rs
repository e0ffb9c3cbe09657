use super::columns::root;
use super::*;
use crate::spaces::NumpyRng;

/// The transform by its definition.
fn slow(picture: &ComplexPicture, height: usize, width: usize) -> ComplexPicture {
    let mut out = ComplexPicture::new(height * width);
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

/// Height and width: powers of two and others, odd ones, and single rows and columns.
const SIZES: [(usize, usize); 9] = [
    (1, 1),
    (1, 7),
    (2, 3),
    (4, 4),
    (5, 8),
    (6, 6),
    (9, 5),
    (16, 12),
    (17, 1),
];

/// Returns a picture and a transfer function at random.
fn random(rng: &mut NumpyRng, len: usize) -> (ComplexPicture, Vec<f64>) {
    let mut picture = ComplexPicture::new(len);
    for v in picture.re.iter_mut().chain(&mut picture.im) {
        *v = rng.uniform() - 0.5;
    }
    let transfer: Vec<f64> = (0..len).map(|_| rng.uniform()).collect();
    (picture, transfer)
}

#[test]
fn transforms_of_all_sizes_are_those_of_the_definition() {
    let mut rng = NumpyRng::seed(0);
    for (height, width) in SIZES {
        let (mut picture, transfer) = random(&mut rng, height * width);
        // the definition, multiplied and transformed back by conjugation
        let mut spectrum = slow(&picture, height, width);
        for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
            let (at, t) = (v * width + u, transfer[u * height + v] / (height * width) as f64);
            (spectrum.re[at], spectrum.im[at]) = (spectrum.re[at] * t, -spectrum.im[at] * t);
        }
        let expect = slow(&spectrum, height, width);
        PeriodicFilter::new(height, width).filter(&mut picture, &transfer);
        for k in 0..height * width {
            let off = (picture.re[k] - expect.re[k]).hypot(picture.im[k] + expect.im[k]);
            assert!(off < 1e-13, "{height} x {width}: {off:e} off at {k}");
        }
    }
}

#[test]
fn mirrored_filters_are_those_of_pictures_with_their_mirror_images() {
    let mut rng = NumpyRng::seed(1);
    for (height, width) in SIZES {
        let (mut picture, transfer) = random(&mut rng, height * width);
        let mirror = |i: usize, n: usize| if i < n { i } else { 2 * n - 1 - i };
        let mut whole = ComplexPicture::new(4 * height * width);
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
        PeriodicFilter::new(2 * height, 2 * width).filter(&mut whole, &twice);
        MirrorFilter::new(height, width).filter(&mut picture, &transfer);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let (k, at) = (y * width + x, y * 2 * width + x);
            let off = (picture.re[k] - whole.re[at]).hypot(picture.im[k] - whole.im[at]);
            assert!(off < 1e-13, "{height} x {width}: {off:e} off at {y}, {x}");
        }
    }
}
