//! Checksums of episodes: the same bits on every target.

use babybench::env::Snapshot;
use babybench::{Blueprint, Config, Env, VectorEnv, VectorOptions};
use fold::Hash;

#[path = "fold.rs"]
mod fold;

/// The example configurations.
pub const CONFIGURATIONS: [(&str, &str); 4] = [
    ("self_touch", include_str!("../../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../../configs/config_test_installation.yml"),
    ),
    ("infant", include_str!("../../configs/config_infant.yml")),
];

/// Lengths of the episodes.
#[allow(dead_code)] // the caller of the WebAssembly module chooses
pub const STEPS: [usize; 4] = [0, 10, 100, 1000];

/// Steps of a vector.
#[allow(dead_code)] // as above
pub const VECTOR_STEPS: usize = 20;

/// Runs configuration `index` for `steps` random steps from seed 0 and folds the bits of positions, velocities and
/// all senses into a number. 0 when something fails.
pub fn checksum(index: usize, steps: usize) -> u64 {
    run(index, steps).unwrap_or(0)
}

fn run(index: usize, steps: usize) -> Option<u64> {
    let (name, text) = CONFIGURATIONS.get(index)?;
    let mut env = Env::new(Config::from_yaml(text, name).ok()?).ok()?;
    let mut action = Vec::new();
    env.reset(Some(0)).ok()?;
    for _ in 0..steps {
        env.sample_action(&mut action);
        env.step(&action).ok()?;
    }
    Some(fold::bits(&env))
}

/// Environments of a vector.
const ENVS: usize = 5;

/// Runs a vector with configuration `index` for `steps` random steps from seed 0, every other one in two halves, and folds
/// all that it returns into a number, environment after environment. 0 when something fails.
pub fn vector_checksum(index: usize, steps: usize, threads: usize) -> u64 {
    run_vector(index, steps, threads).unwrap_or(0)
}

fn run_vector(index: usize, steps: usize, threads: usize) -> Option<u64> {
    let (name, text) = CONFIGURATIONS.get(index)?;
    let config = Config {
        max_episode_steps: 7,
        ..Config::from_yaml(text, name).ok()?
    };
    let options = VectorOptions {
        threads,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&Blueprint::new(config).ok()?, ENVS, options).ok()?;
    let mut hashes: [Hash; ENVS] = std::array::from_fn(|_| Hash::new());
    let mut actions = Vec::new();
    envs.reset(0).ok()?;
    for step in 0..steps {
        envs.sample_actions(&mut actions).ok()?;
        let sizes: &[usize] = match step % 2 {
            0 => &[ENVS],
            _ => {
                envs.send(&actions, &std::array::from_fn::<_, ENVS, _>(|env| env))
                    .ok()?;
                &[2, ENVS - 2]
            }
        };
        for &size in sizes {
            let batch = match size {
                ENVS => envs.step(&actions).ok()?,
                _ => envs.recv(size).ok()?,
            };
            for (row, &env) in batch.ids.iter().enumerate() {
                hashes[env].observation(&batch.row(row)?);
                hashes[env].fold(u64::from(batch.truncated[row]) + batch.infos.steps[row]);
            }
        }
    }
    let mut all = Hash::new();
    hashes.iter().for_each(|hash| all.fold(hash.0));
    Some(all.0)
}

/// Steps before a snapshot, and after it.
const SNAPSHOT_STEPS: [usize; 2] = [30, 10];

/// Takes a snapshot of configuration `index`, restores its bytes in another environment and goes on; folds the bytes and what
/// follows into a number. Equal bytes on two machines are a snapshot that each restores from the other. 0 when something fails.
pub fn snapshot_checksum(index: usize) -> u64 {
    run_snapshot(index).unwrap_or(0)
}

fn run_snapshot(index: usize) -> Option<u64> {
    let (name, text) = CONFIGURATIONS.get(index)?;
    let blueprint = Blueprint::new(Config::from_yaml(text, name).ok()?).ok()?;
    let (mut env, mut other) = (blueprint.env().ok()?, blueprint.env().ok()?);
    let mut action = Vec::new();
    env.reset(Some(0)).ok()?;
    for _ in 0..SNAPSHOT_STEPS[0] {
        env.sample_action(&mut action);
        env.step(&action).ok()?;
    }
    let bytes = env.snapshot().as_bytes().to_vec();
    let mut hash = Hash::new();
    bytes.iter().for_each(|&byte| hash.fold(u64::from(byte)));
    other.restore(&Snapshot::from_bytes(bytes).ok()?).ok()?;
    for _ in 0..SNAPSHOT_STEPS[1] {
        other.sample_action(&mut action);
        other.step(&action).ok()?;
    }
    hash.fold(fold::bits(&other));
    Some(hash.0)
}
