//! Environments of a vector work in the memory of their thread; whoever looks at one finds the state that it has alone.

use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::env::{BlueprintOptions, Task, TaskScene};
use babybench::{AutoresetMode, Blueprint, Config, Env, EnvError, VectorEnv};

use super::vector;
use crate::caregiver::caregiver;
use crate::common::*;

const ENVS: usize = 3;

/// A vector and the same environments alone, after as many steps.
struct Both {
    envs: VectorEnv,
    alone: Vec<Env>,
}

impl Both {
    fn new(blueprint: &Blueprint) -> Self {
        let mut both = Self {
            envs: vector(blueprint, ENVS, 2, AutoresetMode::Disabled),
            alone: (0..ENVS).map(|_| blueprint.env().expect("available")).collect(),
        };
        both.reset(3);
        both
    }

    fn reset(&mut self, seed: u64) {
        self.envs.reset(seed).expect("no divergence");
        for (seed, env) in (seed..).zip(&mut self.alone) {
            env.reset(Some(seed)).expect("no divergence");
        }
    }

    fn step(&mut self, steps: usize) {
        let mut actions = Vec::new();
        for _ in 0..steps {
            self.envs.sample_actions(&mut actions).expect("all are here");
            self.envs.step(&actions).expect("no divergence");
            for (env, expect) in self.alone.iter_mut().zip(actions.chunks_exact(actions.len() / ENVS)) {
                let mut action = Vec::new();
                env.sample_action(&mut action);
                assert_eq!(action, expect);
                env.step(&action).expect("no divergence");
            }
        }
    }

    fn compare(&self, env: usize, what: &str) {
        let found = self.envs.env(env).expect("it is here").state();
        assert_same_bits(found, self.alone[env].state(), what);
    }
}

fn quick(config: Config) -> Config {
    Config {
        vision_active: false,
        ..config
    }
}

#[test]
fn states_are_those_of_environments_alone() {
    for behavior in Behavior::ALL.iter().copied() {
        let mut both = Both::new(&blueprint(quick(Config::of(behavior))));
        both.compare(0, &format!("{behavior} after a reset"));
        both.step(7);
        for env in 0..ENVS {
            both.compare(env, &format!("{behavior}, environment {env}"));
        }
        // those that were looked at go on with states of their own, until their next episode
        both.step(3);
        for env in 0..ENVS {
            both.compare(env, &format!("{behavior}, environment {env}, again"));
        }
        both.reset(11);
        both.step(4);
        both.compare(1, &format!("{behavior}, another episode"));
    }
}

#[test]
fn muscles_delays_and_a_hand_that_moves_by_itself_make_no_difference() {
    let muscles = Config {
        actuation_model: ActuationModel::Muscle,
        frame_skip: 3,
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    for (config, what) in [
        (muscles, "muscles"),
        (infant(), "an infant of three months"),
        (caregiver(), "a caregiver's hand"),
        #[cfg(feature = "rapier")]
        (
            Config {
                engine: babybench::config::EngineKind::Rapier,
                ..quick(Config::default())
            },
            "Rapier",
        ),
    ] {
        let mut both = Both::new(&blueprint(config));
        both.step(5);
        both.compare(1, what);
    }
}

/// Pushes the hip after each step, for the next one.
#[derive(Clone, Debug, Default)]
struct Push {
    steps: f64,
}

impl Task for Push {
    fn name(&self) -> &str {
        "push"
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        self.steps += 1.0;
        let at = scene.state.xpos[1];
        scene.state.apply_force(1, [self.steps, 0.0, 0.0], [0.0; 3], at)?;
        Ok(())
    }
}

#[test]
fn a_task_that_changes_forces_keeps_whole_states() {
    let options = BlueprintOptions::default().with_task(Push::default());
    let blueprint = Blueprint::with(quick(Config::default()), options).expect("available");
    let mut both = Both::new(&blueprint);
    both.step(4);
    both.compare(2, "pushed");
}

#[test]
fn copies_snapshots_and_changes_by_hand_start_from_the_state_alone() {
    let blueprint = blueprint(quick(Config::default()));
    let mut both = Both::new(&blueprint);
    both.step(3);
    assert_eq!(
        both.envs.snapshot(0).expect("it is here"),
        both.alone[0].snapshot(),
        "nothing computed is in a snapshot"
    );
    let copy = both.envs.env(1).expect("it is here").clone();
    assert_same_bits(copy.state(), both.alone[1].state(), "a copy");
    for envs in [
        both.envs.env_mut(2).expect("it is here"),
        both.alone.get_mut(2).expect("there are three"),
    ] {
        let hip = envs.state().xpos[1];
        let state = envs.state_mut();
        state.apply_force(1, [0.0, 0.0, 30.0], [0.0; 3], hip).expect("finite");
        state.qvel[7] = 0.5;
    }
    both.step(2);
    both.compare(2, "changed by hand");
    let (snapshot, here) = (both.alone[2].snapshot(), both.envs.snapshot(2).expect("it is here"));
    assert_eq!(snapshot, here);
    both.envs.restore(0, &snapshot).expect("of the same configuration");
    both.alone[0].restore(&snapshot).expect("of the same configuration");
    // the generators of random actions came with the snapshot
    both.step(2);
    both.compare(0, "restored");
}

#[test]
fn one_that_diverged_tells_where() {
    let blueprint = blueprint(quick(Config::default()));
    let mut envs = vector(&blueprint, 2, 1, AutoresetMode::NextStep);
    envs.reset(0).expect("no divergence");
    let mut far = envs.env(1).expect("it is here").state().qpos.clone();
    far[0] = 1e3;
    let still = vec![0.0; blueprint.model().nv];
    envs.set_state(1, &far, &still).expect("a place like any other");
    envs.env_mut(1).expect("it is here").state_mut().qvel[0] = 1e12;
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    let failures = envs.step(&actions).expect("valid actions").failures.len();
    assert_eq!(failures, 1);
    assert!(envs.env(1).expect("it is here").state().qpos[0].abs() >= 1e3);
    envs.step(&actions).expect("a new episode");
    let state = envs.env(1).expect("it is here").state();
    assert!(state.qpos[0].abs() < 10.0 && state.xpos[1][2] > 0.0);
}
