//! File formats that other programs share: NumPy archives, pickles, Motion-JPEG videos, PNG pictures.

#[cfg(feature = "eval")]
pub mod avi;
#[cfg(feature = "npz")]
pub mod npz;
#[cfg(feature = "eval")]
pub mod pickle;
pub mod png;
