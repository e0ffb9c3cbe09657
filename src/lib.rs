//! An infant to simulate and to train: BabyBench (IEEE ICDL 2025) in pure Rust.
//!
//! MIMo, a multimodal infant model, has a body at any age from birth to two years, a skin of thousands of touch sensors, two
//! eyes, a sense of balance, and muscles or motors. He learns to touch himself, to look at his hands, to reach, to stand up,
//! behind Gymnasium's `reset` and `step`. The physics is MuJoCo's soft-constraint formulation, reproduced to the solver's
//! tolerance, with the same bits on every processor, in any number of threads and in WebAssembly. There is no C compiler, no
//! system library and no MuJoCo in it.
//!
//! # Quick start
//!
//! ```
//! use babybench::{Config, Env};
//!
//! let config = Config::from_yaml("behavior: self_touch\nscene: crib\ntouch_active: False\nvision_active: False", "my.yml")?;
//! let mut env = Env::new(config)?;
//! let mut action = Vec::new();
//! env.reset(Some(0))?;
//! for _ in 0..10 {
//!     env.sample_action(&mut action);
//!     let step = env.step(&action)?;
//!     println!("{} values, {:?}", step.observation.proprioception.len(), step.info);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The [guide] says what MIMo is made of: body, scenes, tasks, senses, actuation, growth, and [every key of the
//! configuration][keys], with units and sources. Configurations of the BabyBench starter kit load unchanged; scripts in its
//! manner start with [`make_env`], which logs as the kit logs, and end with an
//! [`Evaluation`](eval::Evaluation).
//!
//! # Many at once
//!
//! A [`Blueprint`] compiles a scene once and settles it; environments made from one share them. A [`VectorEnv`] steps many of
//! them on all cores (feature `parallel`), and returns arrays over environments, with the same bits as if each were alone:
//!
//! ```
//! use babybench::{Blueprint, Config, VectorEnv, VectorOptions};
//!
//! let config = Config { vision_active: false, touch_active: false, ..Config::default() };
//! let mut envs = VectorEnv::new(&Blueprint::new(config)?, 4, VectorOptions::default())?;
//! envs.reset(0)?; // environment i is seeded with i
//! let batch = envs.step(&[0.1; 4 * 44])?;
//! assert_eq!(batch.observation.vestibular.map(<[f64]>::len), Some(4 * 6));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Your own tasks and senses
//!
//! - A task is a value that implements [`Task`](env::Task): a scene, a start, a goal, a reward. Vectors, snapshots and logs take
//!   it like the built-in ones.
//! - A [`Transform`](sensors::transform::Transform) changes the values of one sense before they are observed: noise, delays,
//!   occlusion.
//! - A sense of your own is a function of [`Model`] and [`State`](physics::State), called after each step: `env.model()`,
//!   `env.state()`.
//! - An [`AssetSource`](assets::AssetSource) puts MJCF files of your own over the embedded ones.
//!
//! # Without the environment
//!
//! The engine is a crate of its own, [mjcf-sim](https://docs.rs/mjcf-sim), which knows no infant: it loads any MJCF model, steps it and
//! draws it. This crate re-exports it: [`mjcf_loader`], [`model`], [`physics`], [`render`], [`math`], [`assets`].
//!
//! Data flow one way: [`config`] -> [`mimo`] writes a document -> [`mjcf_loader`] reads MJCF into a
//! [`Spec`](mjcf_loader::Spec) -> [`physics::compile`] turns it into a [`Model`] -> an [`Engine`](physics::Engine) steps a
//! [`State`](physics::State), whose fields are those of MuJoCo's `mjData` -> [`sensors`] read it, [`render`] draws it. Each part
//! works alone. In a game loop, step the engine at its own time step and draw in between.
//!
//! Names are the field's, and the search of this page knows MuJoCo's: try `mj_step`, `mjData` or `mj_applyFT`.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `eval` (default) | [`runs`], [`policy`], [`eval`]: logs, policies, scores, evaluation; serde for configurations and results |
//! | `rapier` | MIMo in worlds of [Rapier](https://rapier.rs) ([`env::Infant`]); ray casts and shape queries; an engine on its pipeline |
//! | `parallel` | threads in vectors of environments, and for the second eye |
//! | `npz` | NumPy archives, for recordings and replays |
//! | `onnx` | policies that are ONNX models, run in pure Rust |
//! | `wgpu` | images on a GPU: `renderer: wgpu`, [`env::draw_eyes`] |
//!
//! `default-features = false` leaves the environments alone. Versions below 1.0 may change any item. In the dev profile a step takes
//! thirty times as long; games want `[profile.dev.package."*"] opt-level = 3`.
//!
//! # Platforms
//!
//! The minimum supported Rust version is 1.95. It compiles for Linux, macOS, Windows, Android, iOS, and for
//! `wasm32-unknown-unknown` with the default features: the core uses no file system, threads or clock. There is a
//! Python package and an npm package of the same name.
//!
//! # How far from MuJoCo
//!
//! Contacts are MuJoCo 3.3.0's in number, order and bits of their geometry; accelerations agree to the solver's tolerance; the
//! eyes' images differ from MuJoCo's by 2 of 255 at most. The guide has the tables and how they are measured. `compat: reference`
//! follows the starter kit's Python code, bug for bug, where it disagrees with its documentation.
//!
//! # Errors and limits
//!
//! Nothing panics on input: actions, files and configurations from outside give typed errors that say what was wrong, where, and
//! what to do, within [`Limits`]. A step allocates nothing after the first few. The library forbids `unsafe`.
//!
//! [guide]: https://docs.rs/crate/babybench/latest/source/docs/guide/README.md
//! [keys]: https://docs.rs/crate/babybench/latest/source/docs/guide/configuration.md
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod actuation;
pub mod config;
pub mod env;
#[cfg(feature = "eval")]
pub mod eval;
#[cfg(feature = "eval")]
pub mod formats;
#[cfg(feature = "eval")]
mod json;
pub mod mimo;
#[cfg(feature = "eval")]
pub mod policy;
#[cfg(feature = "eval")]
pub mod runs;
pub mod sensors;
pub mod spaces;
pub mod vector;

/// The engine, which is the crate [mjcf-sim](https://docs.rs/mjcf-sim) and knows nothing of infants.
#[cfg(not(feature = "eval"))]
pub use mjcf_sim::formats;
#[cfg(feature = "rapier")]
pub use mjcf_sim::rapier;
pub use mjcf_sim::{Limits, Model, assets, files, math, mjcf_loader, model, physics, render, text};
use mjcf_sim::{limits, pool, threads};

pub use config::table::Config;
pub use env::error::EnvError;
pub use env::info::Info;
pub use env::observation::{Observation, Step};
pub use env::{Blueprint, Env};
#[cfg(feature = "eval")]
pub use runs::make_env;
pub use vector::VectorEnv;
pub use vector::options::{AutoresetMode, VectorOptions};

/// The programs in the README are compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// So are those in the guide.
#[cfg(all(doctest, feature = "rapier"))]
#[doc = include_str!("../docs/guide/rust.md")]
struct Guide;
#[cfg(all(doctest, feature = "rapier"))]
#[doc = include_str!("../docs/guide/own-world.md")]
struct OwnWorld;

/// And those in the tutorials.
#[cfg(doctest)]
mod tutorials {
    #[doc = include_str!("../docs/tutorials/own-task.md")]
    struct OwnTask;
    #[doc = include_str!("../docs/tutorials/engine.md")]
    struct Engine;
    #[doc = include_str!("../docs/guide/known-faults.md")]
    struct KnownFaults;
}
