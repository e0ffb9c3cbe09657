//! Invariant 3: the same model, seed and actions give the same bits.

use babybench::actuation;
use babybench::config::{ActuationModel, Behavior, Compat, EngineKind, Scene};
use babybench::physics::State;
use babybench::{Blueprint, Config, Env};

use crate::common::*;

/// An episode with seed `seed` and `steps` random actions.
fn episode(env: &mut Env, seed: u64, steps: usize) {
    env.reset(Some(seed)).expect("no divergence");
    random_steps(env, steps);
}

/// Positions, velocities, warm start and observation.
fn checksum(env: &Env) -> u64 {
    let (s, o) = (env.state(), env.observation());
    let mut hash = Fnv::default();
    for values in [&s.qpos, &s.qvel, &s.qacc_warmstart] {
        hash.add(values);
    }
    hash.add(o.proprioception);
    hash.add(o.vestibular.unwrap_or_default());
    hash.0
}

#[test]
fn invariant_3_environments_threads_and_blueprints_give_the_same_bits() {
    for (name, _) in EXAMPLES {
        let shared = blueprint(body_only(name));
        let mut first = shared.env().expect("available");
        episode(&mut first, 5, 40);
        // another environment of the same blueprint, with a past
        let mut second = shared.env().expect("available");
        episode(&mut second, 99, 30);
        episode(&mut second, 5, 40);
        assert_same_bits(first.state(), second.state(), &format!("{name}: second environment"));
        assert_eq!(first.observation(), second.observation());
        assert_eq!(first.info(), second.info());
        // a fresh blueprint in another thread
        let third = std::thread::spawn(move || {
            let mut env = env(body_only(name));
            episode(&mut env, 5, 40);
            env.state().clone()
        });
        assert_same_bits(
            first.state(),
            &third.join().expect("no panic"),
            &format!("{name}: thread"),
        );
    }
}

/// Steps after which the checksums are taken.
const CHECKPOINTS: [usize; 3] = [0, 10, 60];

/// The same for every optimisation level and target, wasm32 included. They change when the arithmetic of a step does: check the
/// distances to the reference first, then take the new values from the output of this test.
const CHECKSUMS: [(&str, [u64; 3]); 3] = [
    (
        "self_touch",
        [0x9a73989c2b17bd24, 0xe20fe4b43fa8aa94, 0xa06e07e93ecfdbfa],
    ),
    (
        "hand_regard",
        [0x42baa26cf46998db, 0xc51c94f878348535, 0x0a5e58bde3ea7109],
    ),
    (
        "test_installation",
        [0x753ad430cbdbac3c, 0x2ff0e7af29e8bb07, 0xd85c8323d9116580],
    ),
];

#[test]
fn invariant_3_checksums_are_those_of_all_targets() {
    let mut wrong = Vec::new();
    for (name, expect) in CHECKSUMS {
        let mut env = env(body_only(name));
        env.reset(Some(0)).expect("no divergence");
        let mut done = 0;
        let found = CHECKPOINTS.map(|steps| {
            random_steps(&mut env, steps - done);
            done = steps;
            checksum(&env)
        });
        let [a, b, c] = found;
        println!("    (\"{name}\", [{a:#018x}, {b:#018x}, {c:#018x}]),");
        if found != expect {
            wrong.push(name);
        }
    }
    assert!(
        wrong.is_empty(),
        "checksums after {CHECKPOINTS:?} steps differ: {wrong:?}"
    );
}

#[test]
fn a_copied_state_continues_with_the_same_bits() {
    for (name, _) in EXAMPLES {
        let mut env = env(body_only(name));
        episode(&mut env, 3, 25);
        let mut engine = env.blueprint().engine();
        let mut copy = engine.new_state();
        copy.copy_dynamic_from(env.state());
        let mut action = Vec::new();
        for k in 0..25 {
            env.sample_action(&mut action);
            env.step(&action).expect("no divergence");
            copy.ctrl.copy_from_slice(&env.state().ctrl);
            engine.step(&mut copy).expect("no divergence");
            assert_same_bits(env.state(), &copy, &format!("{name}: step {k} after the copy"));
        }
    }
}

/// In the middle of an action, so that all that an actuation model needs must come along.
#[test]
fn a_copied_state_continues_with_every_actuation_model_and_engine() {
    let engines = EngineKind::ALL
        .iter()
        .filter(|e| **e == EngineKind::Soft || cfg!(feature = "rapier"));
    for &engine in engines {
        for &actuation_model in ActuationModel::ALL {
            for compat in [Compat::Api, Compat::Reference] {
                let mut env = env(Config {
                    engine,
                    actuation_model,
                    compat,
                    frame_skip: 2,
                    ..free(Behavior::SelfTouch, Scene::Crib)
                });
                env.reset(Some(5)).expect("no divergence");
                random_steps(&mut env, 4);
                let mut first = Vec::new();
                let mut second = Vec::new();
                env.sample_action(&mut first);
                env.sample_action(&mut second);
                let model = env.model().clone();
                let mut start = env.state().clone();
                let mut original = env.blueprint().engine();
                env.blueprint().actuation().set_action(&model, &mut start, &first);
                original.step(&mut start).expect("no divergence");
                let run = |mut s: State| {
                    let actuation = actuation::build(&model, env.config()).expect("the actuators fit");
                    let mut engine = env.blueprint().engine();
                    actuation.substep(&model, &mut s);
                    engine.step(&mut s).expect("no divergence");
                    actuation.set_action(&model, &mut s, &second);
                    engine.step(&mut s).expect("no divergence");
                    let mut seen = vec![0.0; actuation.observation_len()];
                    actuation.observe(&model, &s, &mut seen);
                    let cost = actuation.cost(&model, &s);
                    (s, seen, cost)
                };
                let mut part = env.blueprint().engine().new_state();
                part.copy_dynamic_from(&start);
                let (whole, part) = (run(start.clone()), run(part));
                // the original, by the engine that began
                let actuation = env.blueprint().actuation();
                actuation.substep(&model, &mut start);
                original.step(&mut start).expect("no divergence");
                env.blueprint().actuation().set_action(&model, &mut start, &second);
                original.step(&mut start).expect("no divergence");
                let what = format!("{engine:?} {actuation_model} {compat}");
                assert_same_bits(&start, &whole.0, &what);
                assert_same_bits(&start, &part.0, &what);
                assert_eq!((whole.1, whole.2), (part.1, part.2), "{what}");
            }
        }
    }
}

#[test]
fn a_restored_state_repeats_the_past() {
    let mut env = env(body_only("hand_regard"));
    episode(&mut env, 11, 10);
    let saved = env.state().clone();
    let actions: Vec<Vec<f32>> = (0..20)
        .map(|_| {
            let mut a = Vec::new();
            env.sample_action(&mut a);
            a
        })
        .collect();
    let mut run = |restore: bool| {
        if restore {
            env.state_mut().copy_dynamic_from(&saved);
        }
        actions.iter().for_each(|a| repeat(&mut env, a, 1));
        (env.state().clone(), env.observation().proprioception.to_vec())
    };
    let (first, second) = (run(false), run(true));
    assert_same_bits(&first.0, &second.0, "after restoring");
    assert_eq!(first.1, second.1);
}

#[test]
fn a_step_with_frame_skip_equals_that_many_steps() {
    for (behavior, scene) in [(Behavior::None, Scene::Base), (Behavior::SelfTouch, Scene::Crib)] {
        let config = free(behavior, scene.clone());
        let mut single = env(config.clone());
        let mut skipping = env(Config {
            frame_skip: 4,
            ..config
        });
        single.reset(Some(2)).expect("no divergence");
        skipping.reset(Some(2)).expect("no divergence");
        let mut action = Vec::new();
        for k in 0..10 {
            single.sample_action(&mut action);
            repeat(&mut single, &action, 4);
            skipping.step(&action).expect("no divergence");
            assert_same_bits(
                single.state(),
                skipping.state(),
                &format!("{behavior} {scene}: step {k}"),
            );
            assert_eq!(single.observation(), skipping.observation());
        }
    }
}

#[test]
fn a_reset_forgets_everything_but_the_generator() {
    let shared: Blueprint = blueprint(body_only("self_touch"));
    let mut used = shared.env().expect("available");
    episode(&mut used, 8, 20);
    used.state_mut().qfrc_applied.fill(1.0);
    used.state_mut().params.jnt_stiffness.fill(3.0);
    used.state_mut().params.eq_active.fill(true);
    let mut action = Vec::new();
    used.sample_action(&mut action);
    used.step(&action).expect("no divergence");
    let mut fresh = shared.env().expect("available");
    used.reset(Some(4)).expect("no divergence");
    fresh.reset(Some(4)).expect("no divergence");
    assert_same_bits(used.state(), fresh.state(), "reset after a change of parameters");
    // without a seed the generator runs on
    used.reset(None).expect("no divergence");
    assert_ne!(used.state().qpos, fresh.state().qpos);
}
