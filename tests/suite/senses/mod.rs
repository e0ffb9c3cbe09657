//! Senses that mature: what lies between a sense and the observation.

mod delays;
mod eyes;
mod infants;
mod lazy;
mod rates;
#[cfg(feature = "npz")]
mod readers;
mod sizes;
mod skin;
mod transforms;

use babybench::config::{Behavior, PainOptions, Scene};
use babybench::{Config, Env};

/// All senses that there are, in a scene with contacts.
fn everything() -> Config {
    Config {
        behavior: Behavior::None,
        scene: Scene::Crib,
        touch_scale: 2.0,
        touch_pooled: true,
        pain_active: true,
        pain: PainOptions {
            threshold: 0.2,
            slope: 1.0,
            ..PainOptions::default()
        },
        vision_resolution: 12,
        ..Config::default()
    }
}

/// Each sense of a moment, as text.
fn seen(env: &Env) -> Vec<String> {
    let o = env.observation();
    vec![
        format!("{:?}", o.proprioception),
        format!("{:?}", o.touch),
        format!("{:?}", o.touch_pooled),
        format!("{:?}", o.pain),
        format!("{:?}", o.vestibular),
        format!("{:?} {:?}", o.eye_left, o.eye_right),
    ]
}

/// `n` random steps: everything that comes out of them, as text.
fn course(env: &mut Env, n: usize) -> Vec<String> {
    let mut action = Vec::new();
    let mut step = || {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        format!("{:?} {:?}", step.observation, step.info)
    };
    (0..n).map(|_| step()).collect()
}
