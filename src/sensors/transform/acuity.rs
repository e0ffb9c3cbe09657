//! Acuity: the blurred vision of infants.

use super::fourier::{Fourier, Plane};
use super::{Signal, Transform};
use crate::spaces::NumpyRng;

/// Age in months, and the highest spatial frequency that an eye of that age resolves, cycles per degree (D. L. Mayer et
/// al., "Monocular Acuity Norms for the Teller Acuity Cards between Ages One Month and Four Years", 1995).
const CUTOFFS: [[f64; 2]; 24] = [
    [1.0, 0.852],
    [1.169, 1.0005],
    [1.366, 1.1745],
    [1.596, 1.3795],
    [1.865, 1.621],
    [2.179, 1.9065],
    [2.547, 2.2445],
    [2.976, 2.645],
    [3.478, 3.121],
    [4.064, 3.6885],
    [4.75, 4.367],
    [5.55, 5.179],
    [6.486, 6.1425],
    [7.58, 7.1985],
    [8.858, 8.218],
    [10.351, 9.008],
    [12.096, 9.405],
    [14.135, 9.544],
    [16.519, 9.6775],
    [19.304, 10.079],
    [22.558, 11.013],
    [26.362, 12.54],
    [30.806, 14.6785],
    [36.0, 17.4195],
];

/// Returns the highest spatial frequency that an eye resolves at an age in months, cycles per degree: linear between the
/// rows of the table, constant outside, 1 to 36 months.
pub fn acuity_cutoff(age: f64) -> f64 {
    let above = CUTOFFS.partition_point(|[a, _]| *a <= age);
    match (above.checked_sub(1).map(|k| CUTOFFS[k]), CUTOFFS.get(above)) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * ((age - a) / (b - a)),
        (Some([_, last]), None) => last,
        (None, _) => CUTOFFS[0][1],
    }
}

/// The parameters of an eye's acuity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcuityOptions {
    /// Age, months.
    pub age: f64,
    /// Height of the field of view, degrees; pixels are square.
    pub fovy: f64,
    /// Whether to follow the authors' Python code, which truncates instead of rounding, is half a
    /// frequency off in images of odd size, and takes the field of view to be that of the longer side.
    pub reference: bool,
}

/// Blurs colours and gray as an eye of some age sees them. The spectrum of the image is multiplied by a transfer function
/// that is 1 up to 0.1 cycles per degree and falls to 0.01 at the cut-off of the age, in a straight line over the
/// logarithms of both; distances and ids stay.
#[derive(Clone, Debug)]
pub struct Acuity {
    options: AcuityOptions,
    height: usize,
    width: usize,
    /// Column by column.
    transfer: Vec<f64>,
    /// Whether the transfer function is the same for a frequency and its negative, so that real pictures stay real.
    symmetric: bool,
    fourier: Fourier,
    plane: Plane,
}

impl Acuity {
    /// Creates the blur of images of `height` by `width` pixels.
    pub fn new(options: AcuityOptions, height: usize, width: usize) -> Self {
        let odd = height % 2 == 1 || width % 2 == 1;
        Self {
            transfer: transfer(options, height, width),
            symmetric: !(options.reference && odd),
            fourier: Fourier::new(height, width),
            plane: Plane::new(height * width),
            options,
            height,
            width,
        }
    }

    /// Returns the transfer function at the frequency of `v` waves over the height and `u` over the width, each from half
    /// the pixels below zero on.
    pub fn transfer(&self, v: isize, u: isize) -> f64 {
        let (v, u) = (v.rem_euclid(self.height as isize), u.rem_euclid(self.width as isize));
        self.transfer[u as usize * self.height + v as usize]
    }

    /// Blurs an image in place; `channels` values for each pixel.
    fn blur(&mut self, image: &mut [u8], channels: usize) {
        // a symmetric transfer function keeps real images real: two channels go through as real and imaginary part of
        // one
        let together = if self.symmetric { 2 } else { 1 };
        let rounding = if self.options.reference { EXACT } else { 0.5 };
        for first in (0..channels).step_by(together) {
            let second = Some(first + 1).filter(|&s| together == 2 && s < channels);
            for (k, pixel) in image.chunks_exact(channels).enumerate() {
                self.plane.re[k] = f64::from(pixel[first]);
                self.plane.im[k] = second.map_or(0.0, |s| f64::from(pixel[s]));
            }
            self.fourier.filter(&mut self.plane, &self.transfer);
            for (k, pixel) in image.chunks_exact_mut(channels).enumerate() {
                let (re, im) = (self.plane.re[k], self.plane.im[k]);
                let magnitude = if self.symmetric {
                    re.abs()
                } else {
                    (re * re + im * im).sqrt()
                };
                // conversion cuts off and clips
                pixel[first] = (magnitude + rounding) as u8;
                if let Some(second) = second {
                    pixel[second] = (im.abs() + rounding) as u8;
                }
            }
        }
    }
}

/// Added before the fraction is cut off, for whole numbers that rounding has made a little smaller.
const EXACT: f64 = 1e-9;

/// Returns the transfer function of all frequencies, column by column, in the order of a Fourier transform.
fn transfer(options: AcuityOptions, height: usize, width: usize) -> Vec<f64> {
    let (h, w) = (height as f64, width as f64);
    // from 1 at 0.1 cycles per degree to 0.01 at the cut-off: two decades down over log10(cutoff) + 1 decades across
    let slope = -2.0 / (1.0 + pxfm::f_log10(acuity_cutoff(options.age)));
    let per_degree = if options.reference { h.max(w) } else { h } / options.fovy;
    let frequency = |index: usize, size: usize| {
        // the order of a Fourier transform, which starts at frequency 0, to that of frequencies
        let centred = (index + size / 2) % size;
        let middle = if options.reference {
            size as f64 / 2.0
        } else {
            (size / 2) as f64
        };
        (centred as f64 - middle) / size as f64
    };
    let mut out = Vec::with_capacity(height * width);
    for u in 0..width {
        let across = frequency(u, width);
        out.extend((0..height).map(|v| {
            let down = frequency(v, height);
            let x = (across * across + down * down).sqrt() * per_degree;
            if x < 0.1 {
                1.0
            } else {
                pxfm::f_pow(10.0 * x, slope).clamp(0.01, 0.99)
            }
        }));
    }
    out
}

impl Transform for Acuity {
    fn describe(&self) -> String {
        let age = self.options.age;
        format!("acuity of {age} months ({:.3} cycles/degree)", acuity_cutoff(age))
    }

    fn apply(&mut self, signal: Signal<'_>, _: &mut NumpyRng) {
        if let Signal::Eye { images, height, width } = signal
            && [height, width] == [self.height, self.width]
        {
            self.blur(&mut images.rgb, 3);
            self.blur(&mut images.gray, 1);
        }
    }

    fn memory(&self) -> usize {
        8 * (self.transfer.len() + 8 * self.plane.re.len())
    }
}
