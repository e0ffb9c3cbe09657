//! Environments that cost little.
#![allow(dead_code)]

use babybench::config::{ActuationModel, DelayUnit};
use babybench::env::{
    BlueprintOptions, EnvError, Goal, StepReward, Task, TaskDocument, TaskScene, TaskSizes, TaskView,
};
use babybench::{Blueprint, Config, Env, Model};

/// A step of MIMo costs as much as hundreds of the small scene, so only one input in this many steps him.
const RARE: usize = 64;

/// Returns an environment of MIMo without touch and eyes, after a reset.
pub fn mimo() -> Env {
    let config = Config {
        touch_active: false,
        vision_active: false,
        ..Config::default()
    };
    let mut env = Env::new(config).expect("the default scene");
    env.reset(Some(0)).expect("a reset");
    env
}

/// Returns whether an input also steps MIMo.
pub fn goes_on(data: &[u8]) -> bool {
    let sum = data
        .iter()
        .fold(0usize, |sum, &byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
    (sum ^ sum >> 7) % RARE == 0
}

/// An arm with muscles above a floor, and a ball, with everything that an environment can remember: goals, the task's memory,
/// delays, pain, noise.
#[derive(Clone, Debug, Default)]
struct Small {
    steps: [f64; 2],
}

impl Task for Small {
    fn name(&self) -> &str {
        "small"
    }

    fn document(&self, config: &Config) -> TaskDocument {
        TaskDocument {
            xml: include_str!("small.xml").to_string(),
            touch_spacing: vec![("hand".to_string(), 0.04), ("target".to_string(), 0.05)],
            ..TaskDocument::of(config)
        }
    }

    fn bind(&mut self, _config: &Config, _model: &Model) -> Result<TaskSizes, EnvError> {
        Ok(TaskSizes {
            goal: 2,
            terms: 1,
            observation: 1,
        })
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        desired.fill(scene.rng.uniform_in(0.1, 0.3));
        self.steps = [0.0; 2];
    }

    fn before_step(&mut self, _action: &mut [f32]) {
        self.steps[0] += 1.0;
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        achieved.copy_from_slice(&view.state.qpos[..2]);
        terms.fill(view.state.qvel[0]);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let distance = goal.desired[0] - goal.achieved[0];
        StepReward {
            reward: distance,
            is_success: distance <= 0.0,
            is_failure: false,
        }
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(&self.steps);
    }

    fn load(&mut self, numbers: &[f64]) {
        self.steps.copy_from_slice(numbers);
    }
}

/// Returns an environment of a small scene with a lot of memory, after a reset.
pub fn small() -> Env {
    let mut config = Config {
        vision_active: false,
        touch_pooled: true,
        pain_active: true,
        actuation_model: ActuationModel::Muscle,
        done_active: false,
        ..Config::default()
    };
    config.pain.threshold = 0.1;
    config.delays.unit = DelayUnit::Steps;
    (config.delays.sensory, config.delays.motor) = (2.0, 1.0);
    config.noise.proprioception = 0.01;
    let blueprint = Blueprint::with(config, BlueprintOptions::default().with_task(Small::default()));
    let mut env = blueprint.expect("the small scene").env().expect("an environment");
    env.reset(Some(0)).expect("a reset");
    env
}
