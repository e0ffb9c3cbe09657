//! Runs in folders: training with its log, the scene that belongs to the logs, recordings and their replay.
//!
//! The API page's Python, line by line:
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
//! let joints: Vec<&str> = env.senses().proprioception().joint_names(model).collect();
//! let sensors: Vec<&str> = env.senses().proprioception().sensor_names(model).collect();
//! assert_eq!((joints.len(), sensors.len()), (47, 21));
//! assert!(joints.contains(&"robot:right_elbow"));
//!
//! // [env.model.actuator(i).name for i in range(env.model.nu) if ...startswith("act:")]
//! let actuators: Vec<&String> = model.actuator_name.iter().filter(|name| name.starts_with("act:")).collect();
//! assert_eq!(actuators.len(), env.action_space().len());
//!
//! // env.touch.sensor_positions[body_id], in the frame of the body
//! let touch = env.senses().touch().expect("touch is active");
//! for body in touch.layout().bodies() {
//!     let (name, positions) = (&model.body_name[body.body], body.positions());
//!     assert!(!positions.is_empty(), "{name}");
//! }
//! let hand = model.body("right_hand").expect("MIMo");
//! assert_eq!(touch.layout().sensor_positions(hand).map(<[_]>::len), Some(172));
//! # std::fs::remove_dir_all(&env.config().save_dir)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod logs;
mod many;
#[cfg(feature = "npz")]
mod motion;
#[cfg(feature = "npz")]
mod record;
#[cfg(feature = "npz")]
mod replay;
mod scene_file;
mod training;

pub use crate::files::Owner;
pub use logs::{EvaluationLog, TrainingTotals};
pub use logs::{LogError, TrainingLog, read_training};
pub use many::RunVector;
#[cfg(feature = "npz")]
pub use motion::{Motion, MotionError, MotionMode, MotionResult, play_motion};
#[cfg(feature = "npz")]
pub use record::{
    ArrayDescription, EpisodeDescription, GeomDescription, InfantDescription, JointDescription, Manifest,
};
#[cfg(feature = "npz")]
pub use record::{Record, RecordError, RecordOptions, Recorder, RepeatResult, VectorRecorder};
#[cfg(feature = "npz")]
pub use replay::{EpisodeStart, Recording, Replay, ReplayError, TaskRows, TouchRows, replay, replay_with_images};
pub use scene_file::{
    SceneFile, SceneFileStatus, complete_scene, complete_scene_from, keep_scene, scene_compat, scene_config,
    write_scene_from,
};
pub use scene_file::{SceneFileError, write_scene};
pub use scene_file::{read_config, read_scene};
pub use training::{RunEnv, RunError, for_evaluation, make_env, start_training};
