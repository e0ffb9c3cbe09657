//! An infant who learns to touch himself out of curiosity: PPO on a [`VectorEnv`](babybench::VectorEnv).
//!
//! - [`curiosity`]: the reward, from the sense of touch alone. A touch between a hand and another part of the body is felt
//!   on both sides; the rarer it has been lately, the more it is worth. Feelings of the skin that were not predicted are
//!   worth something, too.
//! - [`senses`]: what the policy knows, one row of numbers for each environment.
//! - [`network`], [`ppo`]: the policy, and how it learns, with candle.
//! - [`mind`]: all of this together.
//! - [`training`]: many environments, the training log, and the random policies to compare with.
//! - [`evaluation`]: what was learned, as a [`Policy`](babybench::policy::Policy).
//!
//! Environments are stepped on all cores, but everything that is learned from is read in the order of environments, so the same seed
//! gives the same bits for any number of threads.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod curiosity;
pub mod evaluation;
pub mod mind;
pub mod network;
pub mod ppo;
pub mod senses;
pub mod training;

/// An error of the learner.
pub type Error = Box<dyn std::error::Error + Send + Sync>;
