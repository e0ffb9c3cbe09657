//! Arguments of commands that run one or many environments with random actions.

use std::error::Error;

use babybench::policy::{NoisePolicy, Policy, RandomPolicy};
use babybench::spaces::{ActionNoise, Noise};
use babybench::vector::VectorError;
use babybench::{AutoresetMode, VectorEnv, VectorOptions};
use clap::Args;

use crate::arguments::count;
use crate::print::note;

/// The number of environments and of threads.
#[derive(Args)]
pub struct Many {
    /// Number of environments to run at once; environment i gets the seed plus i
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    envs: Option<usize>,
    /// Number of threads that step them; one for each core by default. Results do not depend on it
    #[arg(long, value_name = "T", requires = "envs", allow_negative_numbers = true, value_parser = count::<usize>)]
    threads: Option<usize>,
}

impl Many {
    /// Returns the number of environments, if it is given.
    pub fn envs(&self) -> Option<usize> {
        self.envs
    }

    /// Returns the options of the vector.
    pub fn options(&self, autoreset: AutoresetMode) -> VectorOptions {
        VectorOptions {
            autoreset,
            threads: self.threads.unwrap_or(0),
            ..VectorOptions::default()
        }
    }
}

/// Prints a note if there are fewer threads than requested.
pub fn say_threads(envs: &VectorEnv) {
    if let Some(clipped) = envs.clipped_threads() {
        note!("note: {clipped}");
    }
}

/// The kind of random actions.
#[derive(Args)]
pub struct Babbling {
    /// Random actions: white (new at every step), held (for 0.5 s; held:0.1 for 0.1 s), ou (Ornstein-Uhlenbeck; ou:0.2 with a
    /// correlation of 0.2 s), pink, color:0.69 (power falls with that power of the frequency), color_by_age (that of infants of
    /// MIMo's age; color_by_age:3 of 3 months), or oscillators (coupled, of 1 Hz on average; oscillators:2 of 2 Hz)
    #[arg(long, value_name = "NOISE", default_value = "white")]
    noise: Noise,
}

impl Babbling {
    /// Returns the policy of one environment.
    pub fn policy(&self) -> Box<dyn Policy> {
        match self.noise {
            Noise::White => Box::new(RandomPolicy),
            noise => Box::new(NoisePolicy::new(noise)),
        }
    }

    /// Returns the name of the random actions.
    pub fn name(&self) -> String {
        self.noise.to_string()
    }

    /// Returns the random actions of many environments.
    pub fn many(&self, envs: &VectorEnv) -> Result<ManyBabbling, Box<dyn Error>> {
        let (space, blueprint) = (envs.single_action_space(), envs.env(0)?.blueprint());
        let (dt, age) = (blueprint.dt(), blueprint.config().age);
        let noises = match self.noise.at_age(age)? {
            Noise::White => Vec::new(),
            noise => vec![ActionNoise::new(noise, space, dt, 0); envs.len()],
        };
        Ok(ManyBabbling {
            noises,
            action: Vec::new(),
        })
    }
}

/// Random actions of many environments, each with the same actions as alone.
pub struct ManyBabbling {
    /// `None` for white noise.
    noises: Vec<ActionNoise>,
    action: Vec<f32>,
}

impl ManyBabbling {
    /// Restarts in the environments that started an episode: all, or where `mask` is true.
    pub fn begin(&mut self, envs: &mut VectorEnv, mask: Option<&[bool]>) -> Result<(), VectorError> {
        envs.start_noises(&mut self.noises, mask)
    }

    /// Fills `actions`, (N, len).
    pub fn sample(&mut self, envs: &mut VectorEnv, actions: &mut Vec<f32>) -> Result<(), VectorError> {
        if self.noises.is_empty() {
            return envs.sample_actions(actions);
        }
        actions.clear();
        for noise in &mut self.noises {
            noise.sample(&mut self.action);
            actions.extend_from_slice(&self.action);
        }
        Ok(())
    }
}
