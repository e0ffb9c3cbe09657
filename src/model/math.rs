//! Small fixed-size linear algebra on plain arrays.
//!
//! Vectors are `[f64; 3]`, quaternions `[w, x, y, z]`, matrices row-major `[f64; 9]` whose columns are the local axes in
//! the parent frame. Every sum is written out left to right and no fused multiply-add is used, so results are the same
//! bits on every target. Trigonometry comes from `pxfm`, which rounds
//! correctly, for the same reason; small angles of joints have a shorter way to the same bits (`sincos`).

mod axes;
pub mod hull;
mod operations;
pub mod order;
pub mod qhull;
mod sincos;

pub use axes::*;
pub use operations::*;

/// A 3-vector.
pub type Vec3 = [f64; 3];
/// A quaternion, `[w, x, y, z]`.
pub type Quat = [f64; 4];
/// A row-major 3x3 matrix.
pub type Mat3 = [f64; 9];
