//! BabyBench in pure Rust: the infant model MIMo, its scenes, its senses and its actuation, behind Gymnasium's reset and
//! step, on Rapier.
//!
//! ```
//! use babybench::{Config, Env};
//!
//! let config = Config::from_yaml("behavior: self_touch\nscene: crib\ntouch_active: False\nvision_active: False", "my.yml")?;
//! let mut env = Env::new(config)?;
//! env.reset(Some(0))?;
//! let action = vec![0.1; env.action_space().len()];
//! let step = env.step(&action)?;
//! println!("{} values, {:?}", step.observation.observation.len(), step.info);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The way of the data: [`config`] -> [`mimo`] chooses assets -> [`mjcf_loader`] compiles them -> [`Model`]. An action
//! goes through [`actuation`] to the [`physics`] engine, which advances a [`physics::State`]; [`sensors`] read it; [`mod@env`]
//! holds it all together. Each part works alone, without the environment.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod actuation;
pub mod config;
pub mod env;
pub mod eval;
mod files;
pub mod math;
pub mod mimo;
pub mod mjcf_loader;
pub mod model;
#[cfg(feature = "npz")]
pub mod npz;
pub mod physics;
pub mod render;
pub mod sensors;

pub use config::Config;
pub use env::{Blueprint, Env, EnvError, Info, Observation, Step};
pub use eval::make_env;
pub use model::Model;
