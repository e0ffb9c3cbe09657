//! Checksums of what environments do: the same bits on every target.

use babybench::env::{Checksum, Snapshot, ViewFrom, Viewer};
use babybench::render::ImageBuffers;
use babybench::{Env, VectorEnv, VectorOptions};

use crate::cases::{Case, blueprint};

/// A checksum, or the reason for its absence.
pub type Sum = Result<u64, Box<dyn std::error::Error>>;

/// Runs a case for some random steps from seed 0, with a new episode where one ends, and returns a checksum of the rewards and of the
/// ends of episodes.
fn walk(env: &mut Env, steps: usize) -> Sum {
    let (mut action, mut hash) = (Vec::new(), Checksum::default());
    for _ in 0..steps {
        env.sample_action(&mut action);
        let step = env.step(&action)?;
        let (over, reward) = (step.terminated || step.truncated, step.reward);
        hash.add(reward.to_bits() ^ u64::from(step.terminated));
        if over {
            env.reset(None)?;
        }
    }
    Ok(hash.0)
}

/// Makes an environment whose eyes are drawn by one or two threads.
fn seeing(case: Case, threads: usize) -> Result<Env, Box<dyn std::error::Error>> {
    let mut env = blueprint(case, |config| config)?.env()?;
    env.senses_mut().set_vision_threads(threads);
    Ok(env)
}

/// Returns positions, velocities and all senses after random steps from seed 0.
pub fn episode(case: Case, steps: usize, threads: usize) -> Sum {
    let mut env = seeing(case, threads)?;
    let mut action = Vec::new();
    env.reset(Some(0))?;
    for _ in 0..steps {
        env.sample_action(&mut action);
        env.step(&action)?;
    }
    Ok(Checksum::of(&env).0)
}

/// Returns rewards, ends of episodes and the last senses of random steps from seed 0.
pub fn variant(case: Case, steps: usize, threads: usize) -> Sum {
    let mut env = seeing(case, threads)?;
    env.reset(Some(0))?;
    let mut hash = Checksum(walk(&mut env, steps)?);
    hash.add(Checksum::of(&env).0);
    Ok(hash.0)
}

/// Environments of a vector.
const ENVS: usize = 5;

/// Returns everything that a vector returns in random steps from seed 0, every other one in two halves, environment after
/// environment.
pub fn vector(case: Case, steps: usize, threads: usize) -> Sum {
    let blueprint = blueprint(case, |config| babybench::Config {
        max_episode_steps: 7,
        ..config
    })?;
    let options = VectorOptions {
        threads,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint, ENVS, options)?;
    let mut hashes: [Checksum; ENVS] = std::array::from_fn(|_| Checksum::default());
    let mut actions = Vec::new();
    envs.reset(0)?;
    for step in 0..steps {
        envs.sample_actions(&mut actions)?;
        let sizes: &[usize] = match step % 2 {
            0 => &[ENVS],
            _ => {
                envs.send(&actions, &std::array::from_fn::<_, ENVS, _>(|env| env))?;
                &[2, ENVS - 2]
            }
        };
        for &size in sizes {
            let batch = match size {
                ENVS => envs.step(&actions)?,
                _ => envs.recv(size)?,
            };
            for (row, &env) in batch.ids.iter().enumerate() {
                hashes[env].add_observation(&batch.row(row).ok_or("the batch is too short")?);
                hashes[env].add(u64::from(batch.truncated[row]) + batch.infos.steps[row]);
            }
        }
    }
    let mut all = Checksum::default();
    hashes.iter().for_each(|hash| all.add(hash.0));
    Ok(all.0)
}

/// Steps before a snapshot, and after it.
const SNAPSHOT_STEPS: [usize; 2] = [20, 10];

/// Returns the bytes of a snapshot after random steps from seed 0.
pub fn snapshot(case: Case) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut env = blueprint(case, |config| config)?.env()?;
    env.reset(Some(0))?;
    walk(&mut env, SNAPSHOT_STEPS[0])?;
    Ok(env.snapshot().as_bytes().to_vec())
}

/// Restores the bytes of a snapshot in a new environment and continues. Returns the bytes and what follows.
pub fn restored(case: Case, bytes: Vec<u8>) -> Sum {
    let mut env = blueprint(case, |config| config)?.env()?;
    let mut hash = Checksum::default();
    hash.add_bytes(&bytes);
    env.restore(&Snapshot::from_bytes(bytes)?)?;
    hash.add(walk(&mut env, SNAPSHOT_STEPS[1])?);
    hash.add(Checksum::of(&env).0);
    Ok(hash.0)
}

/// Returns pictures of the room, and everything that both eyes can see, after a few random steps from seed 0.
pub fn pictures(case: Case) -> Sum {
    let blueprint = blueprint(case, |config| config)?;
    let mut env = blueprint.env()?;
    env.reset(Some(0))?;
    let mut hash = Checksum(walk(&mut env, 5)?);
    let mut viewer = Viewer::new(&blueprint)?;
    for camera in ["corner", "closeup", "top"] {
        hash.add_bytes(viewer.draw(&env, ViewFrom::room(&env, camera), 160, 120)?);
    }
    if env.config().vision_active {
        let pixels = (env.config().vision_resolution as usize).pow(2);
        let mut rgb: [Vec<u8>; 2] = std::array::from_fn(|_| vec![0; 3 * pixels]);
        let mut gray: [Vec<u8>; 2] = std::array::from_fn(|_| vec![0; pixels]);
        let mut depth: [Vec<f32>; 2] = std::array::from_fn(|_| vec![0.0; pixels]);
        let mut geoms: [Vec<i32>; 2] = std::array::from_fn(|_| vec![0; pixels]);
        let mut buffers = rgb.iter_mut().zip(&mut gray).zip(depth.iter_mut().zip(&mut geoms));
        let mut eye = || {
            let ((rgb, gray), (depth, segmentation)) = buffers.next().ok_or("there are two eyes")?;
            Ok::<_, &str>(ImageBuffers {
                rgb: Some(rgb),
                gray: Some(gray),
                depth: Some(depth),
                segmentation: Some(segmentation),
            })
        };
        env.senses_mut().eye_buffers([eye()?, eye()?])?;
        rgb.iter().chain(&gray).for_each(|image| hash.add_bytes(image));
        depth.iter().for_each(|image| hash.add_values(image.as_slice().into()));
        geoms.iter().for_each(|image| hash.add_values(image.as_slice().into()));
    }
    Ok(hash.0)
}
