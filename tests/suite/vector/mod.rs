//! Vectors of environments.

mod bits;
mod borrowed;
mod one_by_one;
mod trouble;

use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::env::Observation;
use babybench::vector::VectorStep;
use babybench::{AutoresetMode, Blueprint, Config, VectorEnv, VectorOptions};

use crate::common::*;

const MODES: [AutoresetMode; 3] = [
    AutoresetMode::NextStep,
    AutoresetMode::SameStep,
    AutoresetMode::Disabled,
];
const THREADS: [usize; 4] = [1, 2, 3, 7];
const ENVS: usize = 7;

fn short(actuation_model: ActuationModel) -> Config {
    Config {
        actuation_model,
        max_episode_steps: 4,
        ..free(Behavior::SelfTouch, Scene::Crib)
    }
}

fn vector(blueprint: &Blueprint, n: usize, threads: usize, autoreset: AutoresetMode) -> VectorEnv {
    let options = VectorOptions {
        autoreset,
        threads,
        ..VectorOptions::default()
    };
    VectorEnv::new(blueprint, n, options).expect("memory and threads")
}

/// The observation in a row.
fn observed<'a>(batch: &VectorStep<'a>, row: usize) -> Observation<'a> {
    batch.row(row).expect("there is such a row")
}
