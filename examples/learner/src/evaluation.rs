//! Evaluation of the trained policy, in separate episodes.

use std::ops::ControlFlow;
use std::sync::Arc;

use babybench::eval::{DEFAULT_FPS, Plan, run_episodes};
use babybench::policy::{Policy, PolicyError, RandomPolicy};
use babybench::{Blueprint, Env, Info};

use crate::Error;
use crate::mind::{HOLD, Mind};
use crate::network::Noise;
use crate::training::Kind;

/// A trained mind as a policy that no longer learns.
pub struct Learned {
    mind: Arc<Mind>,
    /// The parts touched in this episode.
    touched: Vec<bool>,
    noise: Noise,
}

impl Learned {
    /// Makes a policy.
    pub fn new(mind: Arc<Mind>) -> Self {
        let touched = vec![false; mind.touch().len()];
        let noise = Noise::new(0);
        Self { mind, touched, noise }
    }
}

impl Policy for Learned {
    fn begin(&mut self, env: &mut Env, _episode: u64) -> Result<(), PolicyError> {
        self.touched.fill(false);
        // the noise follows from the seed of the episode, on any thread
        let mut action = Vec::new();
        env.sample_action(&mut action);
        let bits = action.iter().map(|v| u64::from(v.to_bits()));
        self.noise = Noise::new(bits.fold(0, |seed: u64, bits| seed.wrapping_mul(31).wrapping_add(bits)));
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        self.mind.touch().feel(env, &mut self.touched);
        if env.info().steps.is_multiple_of(HOLD) {
            self.mind
                .act(env, &self.touched, &mut self.noise, action)
                .map_err(PolicyError::Other)?;
        }
        Ok(())
    }
}

/// Random actions, held as long as those of the trained policy.
pub struct Held;

impl Policy for Held {
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if env.info().steps.is_multiple_of(HOLD) {
            env.sample_action(action);
        }
        Ok(())
    }
}

/// Runs evaluation episodes into the configuration's `save_dir` and returns the last information of each.
///
/// # Errors
/// As [`run_episodes`].
pub fn evaluate(
    blueprint: &Blueprint,
    kind: Kind,
    mind: Mind,
    episodes: u64,
    render: bool,
) -> Result<Vec<Info>, Error> {
    let plan = Plan {
        episodes,
        duration: blueprint.config().max_episode_steps,
        render,
        fps: DEFAULT_FPS,
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
    };
    let mind = Arc::new(mind);
    let policy = || -> Result<Box<dyn Policy>, PolicyError> {
        Ok(match kind {
            Kind::Random => Box::new(RandomPolicy),
            Kind::Held => Box::new(Held),
            Kind::Curious => Box::new(Learned::new(mind.clone())),
        })
    };
    Ok(run_episodes(blueprint, &plan, &policy, &|| ControlFlow::Continue(()))?)
}
