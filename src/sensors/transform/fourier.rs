//! Fourier transforms of pictures, with the same bits on every target.
//!
//! The libraries `rustfft` and `realfft` choose their algorithm by the processor's instructions and take sines from the
//! platform, so that the last bits differ between machines.

mod columns;
mod cosines;

use crate::physics::vectorize;
use columns::FourierColumns;
use cosines::CosineColumns;

/// A picture of complex numbers, row by row, with separate real and imaginary parts.
#[derive(Clone, Debug)]
pub(super) struct ComplexPicture {
    pub re: Vec<f64>,
    pub im: Vec<f64>,
}

impl ComplexPicture {
    pub fn new(len: usize) -> Self {
        Self {
            re: vec![0.0; len],
            im: vec![0.0; len],
        }
    }
}

/// Unnormalised transforms of all columns of a picture at once, and their inverses.
pub(super) trait ColumnTransform {
    /// Makes the transform of columns of a length; rows have `width` values.
    fn new(length: usize, width: usize) -> Self;

    /// Transforms all columns.
    fn forward(&mut self, plane: &mut ComplexPicture);

    /// Transforms them back, `length` times as large.
    fn backward(&mut self, plane: &mut ComplexPicture);
}

/// Filters of pictures that repeat beyond their borders.
pub(super) type PeriodicFilter = Filter<FourierColumns>;

/// Filters of pictures that continue beyond their borders as mirror images. Number k of a column of the spectrum is the frequency of k
/// half waves over the height.
pub(super) type MirrorFilter = Filter<CosineColumns>;

/// Filters of pictures of `height` by `width` by one kind of transform.
#[derive(Clone, Debug)]
pub(super) struct Filter<T> {
    height: usize,
    width: usize,
    down: T,
    across: T,
    /// A buffer for the picture with rows and columns exchanged.
    turned: ComplexPicture,
}

impl<T: ColumnTransform> Filter<T> {
    pub fn new(height: usize, width: usize) -> Self {
        Self {
            height,
            width,
            down: T::new(height, width),
            across: T::new(width, height),
            turned: ComplexPicture::new(height * width),
        }
    }

    /// Multiplies the spectrum of a picture by `transfer`, stored column by column, and transforms it back.
    pub fn filter(&mut self, picture: &mut ComplexPicture, transfer: &[f64]) {
        let (height, width) = (self.height, self.width);
        let turned = &mut self.turned;
        vectorize(
            #[inline(always)]
            || {
                self.down.forward(picture);
                // a transform works on all columns side by side, which suits vector instructions; transposed, the rows
                // are columns
                turn(picture, turned, height, width);
                self.across.forward(turned);
                for ((re, im), t) in turned.re.iter_mut().zip(&mut turned.im).zip(transfer) {
                    (*re, *im) = (*re * t, *im * t);
                }
                self.across.backward(turned);
                turn(turned, picture, width, height);
                self.down.backward(picture);
                // neither direction divides: one product for each number makes up for both transforms at once
                let share = 1.0 / (height * width) as f64;
                for v in picture.re.iter_mut().chain(&mut picture.im) {
                    *v *= share;
                }
            },
        );
    }
}

/// Transposes an image of `rows` rows and `columns` columns.
#[inline(always)]
fn turn(from: &ComplexPicture, to: &mut ComplexPicture, rows: usize, columns: usize) {
    for (from, to) in [(&from.re, &mut to.re), (&from.im, &mut to.im)] {
        for (row, values) in from.chunks_exact(columns).enumerate() {
            for (column, v) in values.iter().enumerate() {
                to[column * rows + row] = *v;
            }
        }
    }
}

#[cfg(test)]
mod tests;
