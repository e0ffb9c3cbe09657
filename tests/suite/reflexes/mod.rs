//! Reflexes of infants by stimulus and response.

mod eyes;
mod limbs;
mod machinery;
mod touched;

use babybench::config::{ActuationModel, Reflex, ReflexGains, ReflexSet};
use babybench::{Config, Env};

/// An infant with reflexes, who senses his body alone.
fn infant(reflexes: &[Reflex]) -> Config {
    let mut config = Config {
        vision_active: false,
        touch_active: false,
        ..Config::default()
    };
    config.reflexes.set = ReflexSet::new(reflexes.iter().copied());
    config
}

fn started(config: Config) -> Env {
    let mut env = Env::new(config).expect("an environment");
    env.reset(Some(0)).expect("a start");
    env
}

/// Steps with the action that commands nothing.
fn rest(env: &mut Env) {
    let action = vec![0.0; env.action_space().len()];
    env.step(&action).expect("a step");
}

/// Returns the angle of a joint, rad.
fn angle(env: &Env, joint: &str) -> f64 {
    let model = env.model();
    env.state().qpos[model.jnt_qposadr[model.joint(joint).expect("the joint")]]
}

/// Returns the velocity of a joint, rad/s.
fn velocity(env: &Env, joint: &str) -> f64 {
    let model = env.model();
    env.state().qvel[model.jnt_dofadr[model.joint(joint).expect("the joint")]]
}

const MODELS: [ActuationModel; 3] = [
    ActuationModel::SpringDamper,
    ActuationModel::Muscle,
    ActuationModel::Positional,
];
