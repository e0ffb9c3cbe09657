//! File formats that other programs share: NumPy archives, pickles, Motion-JPEG videos, PNG pictures, triangle meshes, skins, heights on a grid.

#[cfg(feature = "eval")]
pub mod avi;
pub mod heights;
pub mod mesh;
#[cfg(feature = "npz")]
pub mod npz;
#[cfg(feature = "eval")]
pub mod pickle;
pub mod png;
pub mod skn;
