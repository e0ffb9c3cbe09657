//! Long runs with random actions: nothing diverges.
//!
//! An unoptimised build makes a fifth of the steps, and less where that would take minutes, unless `BABYBENCH_LONG=1`.

mod common;

use std::time::Instant;

use babybench::config::{Behavior, Scene};
use common::*;

/// Steps that an action is held for in the last third of a run.
const HELD: usize = 20;

/// Steps of an optimised build.
const STEPS: usize = 100_000;

fn endure(behavior: Behavior, scene: Scene, unoptimised_steps: usize) {
    let long = std::env::var_os("BABYBENCH_LONG").is_some_and(|v| v == "1");
    let steps = if long || !cfg!(debug_assertions) {
        STEPS
    } else {
        unoptimised_steps
    };
    let mut env = env(free(behavior, scene.clone()));
    env.reset(Some(0)).expect("no divergence");
    let limit = env.config().max_episode_steps as usize;
    let mut action = Vec::new();
    let (mut fastest, mut contacts, mut truncated) = ((0.0_f64, 0), 0, 0);
    let start = Instant::now();
    for k in 0..steps {
        if k < steps - steps / 3 || k % HELD == 0 {
            env.sample_action(&mut action);
        }
        let step = env
            .step(&action)
            .unwrap_or_else(|e| panic!("{behavior}/{scene}, step {k}: {e}"));
        truncated += usize::from(step.truncated);
        let o = step.observation;
        assert!(
            o.proprioception
                .iter()
                .chain(o.vestibular.unwrap_or_default())
                .all(|v| v.is_finite()),
            "step {k}"
        );
        let speeds = env.state().qvel.iter().map(|v| v.abs()).enumerate();
        fastest = speeds.fold(fastest, |m, (d, v)| if v > m.0 { (v, d) } else { m });
        contacts = contacts.max(env.state().contact.len());
    }
    let rate = steps as f64 / start.elapsed().as_secs_f64();
    let (speed, dof) = fastest;
    let joint = env.model().dof_jntid[dof];
    println!(
        "{behavior}/{scene}: {steps} steps{}, {rate:.0} steps/s, max |qvel| {speed:.1} at dof {dof} (joint {joint} {:?}), at \
         most {contacts} contacts",
        if steps == STEPS {
            ""
        } else {
            " (BABYBENCH_LONG=1 for 100000)"
        },
        env.model().jnt_name[joint],
    );
    assert_eq!(truncated, (steps + 1).saturating_sub(limit));
}

#[test]
fn random_actions_do_not_diverge_on_the_floor() {
    endure(Behavior::None, Scene::Base, 20_000);
}

#[test]
fn random_actions_do_not_diverge_in_the_crib() {
    endure(Behavior::None, Scene::Crib, 20_000);
}

#[test]
fn random_actions_do_not_diverge_among_the_cubes() {
    endure(Behavior::HandRegard, Scene::Cubes, 5_000);
}
