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
//! println!("{} values, {:?}", step.observation.proprioception.len(), step.info);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What the API page shows in Python
//!
//! ```
//! use babybench::{Config, make_env};
//! # let save_dir = std::env::temp_dir().join("babybench_page_example").display().to_string();
//! # let text = "behavior: self_touch\nscene: crib\nvision_active: False\ntouch_fingers: False\nmax_episode_steps: 5";
//!
//! // env = bb_utils.make_env(config, training=True)
//! let config = Config { save_dir, ..Config::from_yaml(text, "my.yml")? }; // or Config::from_file("my.yml")
//! let mut env = make_env(config, true)?;
//!
//! // obs, info = env.reset(); obs, reward, terminated, truncated, info = env.step(action)
//! env.reset(None)?;
//! let mut action = Vec::new();
//! env.sample_action(&mut action); // action = env.action_space.sample()
//! let step = env.step(&action)?;
//! let (obs, info) = (step.observation, step.info);
//! assert_eq!((step.reward, step.terminated, step.truncated, info.steps), (0.0, false, false, 1));
//! assert!(obs.touch.is_some() && obs.vestibular.is_some() && obs.eye_left.is_none());
//!
//! // env.proprioception.joint_names, env.proprioception.sensors
//! let model = env.model();
//! let joints: Vec<&str> = env.proprioception().joint_names(model).collect();
//! let sensors: Vec<&str> = env.proprioception().sensor_names(model).collect();
//! assert_eq!((joints.len(), sensors.len()), (47, 21));
//! assert!(joints.contains(&"robot:right_elbow"));
//!
//! // [env.model.actuator(i).name for i in range(env.model.nu) if ...startswith("act:")]
//! let actuators: Vec<&String> = model.actuator_name.iter().filter(|name| name.starts_with("act:")).collect();
//! assert_eq!(actuators.len(), env.action_space().len());
//!
//! // env.touch.sensor_positions[body_id], in the frame of the body
//! let touch = env.touch().expect("touch is active");
//! for body in touch.layout().bodies() {
//!     let (name, positions) = (&model.body_name[body.body], body.positions());
//!     assert!(!positions.is_empty(), "{name}");
//! }
//! let hand = model.body("right_hand").expect("MIMo");
//! assert_eq!(touch.layout().sensor_positions(hand).map(<[_]>::len), Some(172));
//! # std::fs::remove_dir_all(&env.config().save_dir)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! And its evaluation:
//!
//! ```
//! use babybench::eval::{Evaluation, Touchables};
//! use babybench::{Config, make_env};
//! # let save_dir = std::env::temp_dir().join("babybench_page_evaluation").display().to_string();
//! # let text = "behavior: self_touch\nscene: crib\nvision_active: False\ntouch_active: False\nmax_episode_steps: 5";
//! # let config = Config { save_dir, ..Config::from_yaml(text, "my.yml")? };
//! # let mut training = make_env(config.clone(), true)?;
//! # for _ in 0..2 {
//! #     training.reset(None)?;
//! #     training.step(&[0.0; 44])?;
//! # }
//! # training.finish_training()?;
//!
//! // evaluation = bb_eval.EVALS[config['behavior']](env=env, render=True, save_dir=config['save_dir'])
//! let mut env = make_env(config, false)?;
//! let mut evaluation = Evaluation::new(&env).with_video(&env)?;
//!
//! // evaluation.eval_logs()
//! let score = evaluation.eval_logs()?;
//! println!("{score}"); // Preliminary training score: 0.0
//! print!("{}", score.to_text(Touchables::new(env.model()).as_ref()));
//!
//! // obs, _, _, _, info = env.step(action); evaluation.eval_step(info)
//! env.reset(None)?;
//! evaluation.reset();
//! for _ in 0..2 {
//!     env.step(&[0.0; 44])?;
//!     evaluation.eval_step(&env)?;
//! }
//!
//! // evaluation.end(episode=0)
//! evaluation.end(0)?;
//! # std::fs::remove_dir_all(&env.config().save_dir)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How it is put together
//!
//! The way of the data: [`config`] -> [`mimo`] chooses assets -> [`mjcf_loader`] reads them -> [`physics::compile`] makes a
//! [`Model`]. An action
//! goes through [`actuation`] to the [`physics`] engine, which advances a [`physics::State`]; [`sensors`] read it; [`mod@env`]
//! holds it all together. Each part works alone, without the environment.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod actuation;
pub mod assets;
pub mod config;
pub mod env;
#[cfg(feature = "eval")]
pub mod eval;
mod files;
pub mod formats;
#[cfg(feature = "eval")]
mod json;
mod limits;
pub mod math;
pub mod mimo;
pub mod mjcf_loader;
pub mod model;
pub mod physics;
#[cfg(feature = "eval")]
pub mod policy;
pub mod render;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "eval")]
pub mod runs;
pub mod sensors;
pub mod spaces;
mod text;
mod threads;
pub mod vector;

pub use config::Config;
pub use env::{Blueprint, Env, EnvError, Info, Observation, Step};
pub use limits::Limits;
pub use model::Model;
#[cfg(feature = "eval")]
pub use runs::make_env;
pub use vector::{AutoresetMode, VectorEnv, VectorOptions};

/// The programs in the README are compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
