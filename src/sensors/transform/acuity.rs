//! Acuity: the blurred vision of infants.

use super::fourier::{ComplexPicture, MirrorFilter, PeriodicFilter};
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
    /// Whether to follow the authors' Python code. It blurs across the borders, as if images continued with their opposite side, truncates instead of
    /// rounding, is off by half a frequency for images of odd size, and assigns the field of view to the longer side.
    pub reference: bool,
}

/// Blurs colours and gray as an eye of a given age sees them. The spectrum of the image is multiplied by a transfer function that is 1 up
/// to 0.1 cycles per degree and falls to 0.01 at the cut-off of the age, linearly over the logarithms of both. Depth and segmentation do
/// not change. Beyond its border an image continues as its mirror image.
#[derive(Clone, Debug)]
pub struct Acuity {
    options: AcuityOptions,
    height: usize,
    width: usize,
    /// Column by column.
    transfer: Vec<f64>,
    filter: BorderFilter,
    plane: ComplexPicture,
}

/// The continuation of images beyond their border.
#[derive(Clone, Debug)]
enum BorderFilter {
    /// As their mirror image.
    Mirrored(Box<MirrorFilter>),
    /// With their opposite side, as in the authors' code.
    Wrapped {
        fourier: Box<PeriodicFilter>,
        /// Whether the transfer function is the same for a frequency and its negative, so that real pictures stay real.
        symmetric: bool,
    },
}

impl Acuity {
    /// Creates the blur of images of `height` by `width` pixels.
    pub fn new(options: AcuityOptions, height: usize, width: usize) -> Self {
        let (transfer, filter) = if options.reference {
            let filter = BorderFilter::Wrapped {
                fourier: Box::new(PeriodicFilter::new(height, width)),
                symmetric: height.is_multiple_of(2) && width.is_multiple_of(2),
            };
            (transfer_of_waves(options, height, width), filter)
        } else {
            let filter = BorderFilter::Mirrored(Box::new(MirrorFilter::new(height, width)));
            (transfer_of_half_waves(options, height, width), filter)
        };
        Self {
            transfer,
            filter,
            plane: ComplexPicture::new(height * width),
            options,
            height,
            width,
        }
    }

    /// Returns the transfer function at the frequency of `v` waves over the height and `u` over the width, each starting half the pixels below zero.
    pub fn transfer(&self, v: isize, u: isize) -> f64 {
        if self.options.reference {
            let (v, u) = (v.rem_euclid(self.height as isize), u.rem_euclid(self.width as isize));
            return self.transfer[u as usize * self.height + v as usize];
        }
        let (down, across) = (v as f64 / self.height as f64, u as f64 / self.width as f64);
        let per_degree = self.height as f64 / self.options.fovy;
        gain(
            (across * across + down * down).sqrt() * per_degree,
            slope(self.options.age),
        )
    }

    /// Returns the highest spatial frequency that images of this size can hold, cycles per degree: half a wave per pixel.
    pub fn resolution(&self) -> f64 {
        0.5 * self.height as f64 / self.options.fovy
    }

    /// Filters both parts of the plane. Returns whether real pictures have stayed real.
    fn filter(&mut self) -> bool {
        match &mut self.filter {
            BorderFilter::Mirrored(mirrored) => {
                mirrored.filter(&mut self.plane, &self.transfer);
                true
            }
            BorderFilter::Wrapped { fourier, symmetric } => {
                fourier.filter(&mut self.plane, &self.transfer);
                *symmetric
            }
        }
    }

    /// Blurs an image in place; `channels` values for each pixel.
    fn blur(&mut self, image: &mut [u8], channels: usize) {
        // a symmetric transfer function keeps real images real: two channels go through as real and imaginary part of
        // one
        let (mirrored, symmetric) = match self.filter {
            BorderFilter::Mirrored(_) => (true, true),
            BorderFilter::Wrapped { symmetric, .. } => (false, symmetric),
        };
        let together = if symmetric { 2 } else { 1 };
        let rounding = if mirrored { 0.5 } else { EXACT };
        for first in (0..channels).step_by(together) {
            let second = Some(first + 1).filter(|&s| together == 2 && s < channels);
            for (k, pixel) in image.chunks_exact(channels).enumerate() {
                self.plane.re[k] = f64::from(pixel[first]);
                self.plane.im[k] = second.map_or(0.0, |s| f64::from(pixel[s]));
            }
            let real = self.filter();
            for (k, pixel) in image.chunks_exact_mut(channels).enumerate() {
                let (re, im) = (self.plane.re[k], self.plane.im[k]);
                let (value, other) = match (mirrored, real) {
                    (true, _) => (re, im),
                    // the authors' code takes the magnitude of what should be real
                    (false, true) => (re.abs(), im.abs()),
                    (false, false) => ((re * re + im * im).sqrt(), 0.0),
                };
                // conversion cuts off and clips
                pixel[first] = (value + rounding) as u8;
                if let Some(second) = second {
                    pixel[second] = (other + rounding) as u8;
                }
            }
        }
    }
}

/// Offset before truncation, for whole numbers that rounding has made slightly smaller.
const EXACT: f64 = 1e-9;

/// Returns the exponent of the transfer function: from 1 at 0.1 cycles per degree to 0.01 at the cut-off, two decades down over
/// log10(cutoff) + 1 decades across.
fn slope(age: f64) -> f64 {
    -2.0 / (1.0 + pxfm::f_log10(acuity_cutoff(age)))
}

/// Returns the transfer function at a frequency, cycles per degree.
fn gain(frequency: f64, slope: f64) -> f64 {
    if frequency < 0.1 {
        1.0
    } else {
        pxfm::f_pow(10.0 * frequency, slope).clamp(0.01, 0.99)
    }
}

/// Returns the transfer function of all frequencies, column by column; `frequency` returns the frequency of an index for a number of pixels, cycles
/// per pixel.
fn table(age: f64, per_degree: f64, [height, width]: [usize; 2], frequency: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let slope = slope(age);
    let mut out = Vec::with_capacity(height * width);
    for u in 0..width {
        let across = frequency(u, width);
        out.extend((0..height).map(|v| {
            let down = frequency(v, height);
            gain((across * across + down * down).sqrt() * per_degree, slope)
        }));
    }
    out
}

/// Returns the authors' transfer function, in the order of a Fourier transform.
fn transfer_of_waves(options: AcuityOptions, height: usize, width: usize) -> Vec<f64> {
    let per_degree = (height as f64).max(width as f64) / options.fovy;
    table(options.age, per_degree, [height, width], |index, size| {
        // the order of a Fourier transform, which starts at frequency 0, to that of frequencies
        let centred = (index + size / 2) % size;
        (centred as f64 - size as f64 / 2.0) / size as f64
    })
}

/// Returns the transfer function in the order of a cosine transform, whose frequencies are half waves.
fn transfer_of_half_waves(options: AcuityOptions, height: usize, width: usize) -> Vec<f64> {
    let per_degree = height as f64 / options.fovy;
    table(options.age, per_degree, [height, width], |index, size| {
        index as f64 / (2 * size) as f64
    })
}

impl Transform for Acuity {
    fn describe(&self) -> String {
        let age = self.options.age;
        let (cutoff, resolution) = (acuity_cutoff(age), self.resolution());
        let pixels = self.height;
        if resolution < cutoff {
            format!("acuity of {age} months ({cutoff:.3} cycles/degree; {pixels} pixels hold {resolution:.3})")
        } else {
            format!("acuity of {age} months ({cutoff:.3} cycles/degree)")
        }
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
