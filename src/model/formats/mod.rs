//! File formats that other programs share: NumPy archives, PNG pictures, triangle meshes, skins, heights on a grid.

pub mod heights;
pub mod mesh;
#[cfg(feature = "npz")]
pub mod npz;
pub mod png;
pub mod skn;
