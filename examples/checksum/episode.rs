//! Checksums of episodes: the same bits on every target.

use babybench::{Config, Env};

/// The example configurations.
pub const CONFIGURATIONS: [(&str, &str); 3] = [
    ("self_touch", include_str!("../../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../../configs/config_test_installation.yml"),
    ),
];

/// Lengths of the episodes.
#[allow(dead_code)] // the caller of the WebAssembly module chooses
pub const STEPS: [usize; 4] = [0, 10, 100, 1000];

/// Runs configuration `index` for `steps` random steps from seed 0 and folds the bits of positions, velocities and
/// all senses into a number (FNV-1a on 64-bit words). 0 when something fails.
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
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut fold = |word: u64| hash = (hash ^ word).wrapping_mul(0x0100_0000_01b3);
    let (state, seen) = (env.state(), env.observation());
    for values in [
        &state.qpos[..],
        &state.qvel[..],
        seen.proprioception,
        seen.vestibular.unwrap_or_default(),
    ] {
        values.iter().for_each(|v| fold(v.to_bits()));
    }
    seen.touch
        .unwrap_or_default()
        .iter()
        .for_each(|v| fold(u64::from(v.to_bits())));
    for image in [seen.eye_left, seen.eye_right] {
        image.unwrap_or_default().iter().for_each(|&v| fold(u64::from(v)));
    }
    Some(hash)
}
