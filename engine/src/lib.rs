#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod batch;
mod simulation;

pub use batch::rollout_on;
#[doc(inline)]
pub use mjcf_sim_loader as mjcf_loader;
pub use mjcf_sim_model::{Limits, Model, assets, files, formats, limits, math, model, pool, text, threads};
#[doc(inline)]
pub use mjcf_sim_physics as physics;
#[cfg(feature = "rapier")]
#[doc(inline)]
pub use mjcf_sim_rapier as rapier;
#[doc(inline)]
pub use mjcf_sim_render as render;
pub use simulation::{Simulation, SimulationError};
