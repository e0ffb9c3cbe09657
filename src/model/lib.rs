//! Compiled models of the engine [mjcf-sim](https://docs.rs/mjcf-sim) under MuJoCo's names, and their foundations: mathematics on plain arrays,
//! sources of documents and textures, file formats, limits on untrusted input.
//!
//! Programs use it through `mjcf-sim`, whose page has examples. Versions below 1.0 may change any item.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod assets;
pub mod files;
pub mod formats;
pub mod limits;
pub mod math;
#[path = "mod.rs"]
pub mod model;
pub mod pool;
pub mod text;
pub mod threads;

pub use limits::Limits;
pub use model::Model;
