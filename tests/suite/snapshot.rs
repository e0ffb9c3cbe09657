//! Snapshots: bit-identical continuation, bytes that keep, and bytes that are refused.

use crate::common::*;
use babybench::config::{ActuationModel, Behavior, Compat, FacialExpression, Part, Scene};
use babybench::env::{Snapshot, SnapshotError, Viewer};
use babybench::sensors::Component;
use babybench::{Config, Env, EnvError, VectorEnv, VectorOptions};

/// `n` random steps: everything that comes out of them, as text.
fn course(env: &mut Env, n: usize) -> Vec<String> {
    let mut action = Vec::new();
    let mut seen = Vec::new();
    for _ in 0..n {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        seen.push(format!("{:?} {} {:?}", step.observation, step.truncated, step.info));
    }
    seen.push(bits(env.state()));
    seen
}

fn started(config: Config) -> Env {
    let mut env = env(config);
    env.reset(Some(3)).expect("no divergence");
    random_steps(&mut env, 7);
    env
}

fn of(actuation_model: ActuationModel, behavior: Behavior, scene: Scene, compat: Compat) -> Config {
    Config {
        actuation_model,
        compat,
        max_episode_steps: 12,
        frame_skip: 2,
        ..free(behavior, scene.clone())
    }
}

#[test]
fn a_snapshot_carries_forces_on_bodies() {
    let mut env = started(free(Behavior::SelfTouch, Scene::Crib));
    let hand = env.model().body("left_hand").expect("MIMo has hands");
    let pull = |env: &mut Env| {
        let state = env.state_mut();
        let point = state.xpos[hand];
        state
            .apply_force(hand, [0.0, 1.0, 4.0], [0.01, 0.0, 0.0], point)
            .expect("finite");
    };
    pull(&mut env);
    let snapshot = env.snapshot();
    let expect = course(&mut env, 5);
    env.reset(Some(8)).expect("no divergence");
    assert!(
        env.state().xfrc_applied.iter().all(|f| *f == [0.0; 6]),
        "a reset takes forces off"
    );
    env.restore(&snapshot).expect("its own snapshot");
    assert!(course(&mut env, 5) == expect);
    env.restore(&snapshot).expect("its own snapshot");
    env.state_mut().release_forces();
    assert!(course(&mut env, 5) != expect, "the force does something");
    let state = env.state_mut();
    let untouched = state.xfrc_applied.clone();
    assert!(state.apply_force(10_000, [0.0; 3], [0.0; 3], [0.0; 3]).is_err());
    assert!(
        state
            .apply_force(hand, [f64::NAN, 0.0, 0.0], [0.0; 3], [0.0; 3])
            .is_err()
    );
    assert_eq!(state.xfrc_applied, untouched);
}

#[test]
fn a_continuation_has_the_same_bits() {
    for &kind in ActuationModel::ALL {
        for (behavior, scene, compat) in [
            (Behavior::SelfTouch, Scene::Crib, Compat::Api),
            (Behavior::HandRegard, Scene::Base, Compat::Reference),
            (Behavior::None, Scene::Cubes, Compat::Reference),
        ] {
            let mut env = started(of(kind, behavior, scene.clone(), compat));
            env.lock(Part::Arms, 0.02).expect("locks");
            random_steps(&mut env, 1);
            let snapshot = env.snapshot();
            let expect = course(&mut env, 10);

            env.unlock(Part::Arms).expect("locks");
            env.reset(Some(8)).expect("no divergence");
            env.restore(&snapshot).expect("its own snapshot");
            assert_eq!(
                env.snapshot(),
                snapshot,
                "a restored environment gives the snapshot again"
            );
            assert!(course(&mut env, 10) == expect, "{kind} {behavior} {scene}: restored");

            // kept as bytes, in another environment that was never reset
            let kept = Snapshot::from_bytes(snapshot.as_bytes().to_vec()).expect("whole");
            let mut other = env.blueprint().env().expect("available");
            other.restore(&kept).expect("the same configuration");
            assert!(
                course(&mut other, 10) == expect,
                "{kind} {behavior} {scene}: other environment"
            );

            // locks outlast resets there too
            other.reset(Some(1)).expect("no divergence");
            let on = |env: &Env| env.state().params.eq_active.iter().filter(|a| **a).count();
            let locked = on(&other);
            other.unlock(Part::Arms).expect("locks");
            assert_eq!(locked - on(&other), 8);
        }
    }
}

#[test]
fn the_observation_comes_back() {
    let mut env = started(of(
        ActuationModel::Muscle,
        Behavior::SelfTouch,
        Scene::Crib,
        Compat::Api,
    ));
    let snapshot = env.snapshot();
    let (before, info) = (env.observation().proprioception.to_vec(), env.info().clone());
    random_steps(&mut env, 3);
    assert_ne!(env.observation().proprioception, before);
    env.restore(&snapshot).expect("its own snapshot");
    assert_eq!(env.observation().proprioception, before);
    assert_eq!(*env.info(), info);
}

#[test]
fn a_restored_moment_can_be_observed_and_goes_on_with_the_same_bits() {
    for &kind in ActuationModel::ALL {
        let touching = |behavior, scene| Config {
            touch_active: true,
            touch_pooled: true,
            pain_active: true,
            vision_active: scene == Scene::Base,
            vision_resolution: 16,
            ..of(kind, behavior, scene, Compat::Api)
        };
        for config in [
            touching(Behavior::SelfTouch, Scene::Crib),
            touching(Behavior::HandRegard, Scene::Base),
        ] {
            let mut env = started(config);
            random_steps(&mut env, 5);
            let snapshot = env.snapshot();
            let mut other = env.blueprint().env().expect("available");
            other.restore(&snapshot).expect("the same configuration");
            let (seen, restored) = (env.observation(), other.observation());
            assert_eq!(restored.proprioception, seen.proprioception, "{kind}");
            assert_eq!(restored.touch_pooled, seen.touch_pooled, "{kind}");
            assert!(
                seen.touch.is_some() && seen.pain.is_some(),
                "the original knows what it feels"
            );
            assert_eq!(
                (restored.touch, restored.pain, restored.eye_left),
                (None, None, None),
                "{kind}"
            );

            let expect = course(&mut env, 5);
            env.restore(&snapshot).expect("its own snapshot");
            assert_eq!(
                env.refresh().expect("no divergence"),
                other.refresh().expect("no divergence"),
                "{kind}"
            );
            assert_eq!(
                (&env.state().xpos, &env.state().contact),
                (&other.state().xpos, &other.state().contact)
            );
            let mut here = env.blueprint().engine().new_state();
            here.copy_dynamic_from(env.state());
            env.blueprint().engine().forward(&mut here).expect("no divergence");
            assert_eq!(
                other.state().geom_xpos,
                here.geom_xpos,
                "{kind}: poses of the present positions"
            );
            assert_eq!(other.state().contact, here.contact, "{kind}");
            assert!(
                other
                    .observation()
                    .touch
                    .is_some_and(|touch| touch.iter().any(|v| *v != 0.0)),
                "{kind}"
            );
            assert!(
                course(&mut other, 5) == expect && course(&mut env, 5) == expect,
                "{kind}: the next steps"
            );
        }
    }
}

#[test]
fn a_policy_that_is_resumed_sees_what_it_saw() {
    for config in [
        Config {
            touch_active: true,
            ..of(ActuationModel::Muscle, Behavior::SelfTouch, Scene::Crib, Compat::Api)
        },
        infant(),
        Config::of(Behavior::Catch),
    ] {
        let mut env = started(config);
        random_steps(&mut env, 7);
        let snapshot = env.snapshot();
        let mut other = env.blueprint().env().expect("it is valid");
        let seen = env.observation();
        let resumed = other.by_hand().resume(&snapshot).expect("its own snapshot");
        assert_eq!(
            (
                resumed.proprioception,
                resumed.vestibular,
                resumed.achieved_goal,
                resumed.desired_goal
            ),
            (
                seen.proprioception,
                seen.vestibular,
                seen.achieved_goal,
                seen.desired_goal
            )
        );
        let mut third = env.blueprint().env().expect("it is valid");
        third.restore(&snapshot).expect("its own snapshot");
        let computed = third.refresh().expect("no divergence");
        let resumed = other.observation();
        assert_eq!((resumed.touch, resumed.pain), (computed.touch, computed.pain));
        assert_eq!(other.state().xpos, third.state().xpos);
        let expect = course(&mut env, 5);
        assert!(course(&mut other, 5) == expect, "the next steps");
    }
}

#[test]
fn the_observation_is_of_one_moment() {
    let mut env = started(Config {
        touch_active: true,
        ..of(
            ActuationModel::SpringDamper,
            Behavior::SelfTouch,
            Scene::Crib,
            Compat::Api,
        )
    });
    let before = env.observation().proprioception.to_vec();
    let joint = env.senses().proprioception().joints().qpos[0];
    env.state_mut().qpos[joint] += 0.1;
    assert_eq!(
        env.observation().proprioception,
        before,
        "an edit is not observed in part"
    );
    let qpos = env.state().qpos.clone();
    let range = env.senses().proprioception().range(Component::Angles).expect("on");
    let now = env.refresh().expect("no divergence").proprioception[range.start];
    assert_eq!(now, qpos[joint]);
    env.state_mut().qpos[joint] = f64::NAN;
    assert!(env.refresh().is_err() && !env.ready());
}

#[test]
fn a_clone_goes_on_with_the_same_bits() {
    for config in [
        infant(),
        Config {
            vision_active: true,
            vision_resolution: 16,
            ..Config::of(Behavior::Catch)
        },
    ] {
        let mut env = started(config);
        random_steps(&mut env, 4);
        let mut twin = env.clone();
        assert_eq!((env.observation(), env.info()), (twin.observation(), twin.info()));
        assert_eq!((env.reward(), env.ready()), (twin.reward(), twin.ready()));
        let expect = course(&mut env, 6);
        assert!(course(&mut twin, 6) == expect);
        let mut third = twin.clone();
        let first = third.reset(None).expect("no divergence").proprioception.to_vec();
        assert_eq!(twin.reset(None).expect("no divergence").proprioception, first);
    }
}

#[test]
fn a_snapshot_before_the_first_reset_asks_for_a_reset() {
    let mut env = env(of(
        ActuationModel::SpringDamper,
        Behavior::None,
        Scene::Base,
        Compat::Api,
    ));
    let fresh = env.snapshot();
    env.reset(Some(0)).expect("no divergence");
    env.restore(&fresh).expect("its own snapshot");
    let action = vec![0.0; env.action_space().len()];
    assert!(matches!(env.step(&action), Err(EnvError::NotReset)));
}

#[test]
fn a_snapshot_of_the_largest_scene_is_small() {
    for &kind in ActuationModel::ALL {
        let env = env(of(kind, Behavior::HandRegard, Scene::Cubes, Compat::Api));
        let n = env.snapshot().as_bytes().len();
        println!("{kind}: {n} bytes");
        assert!(n <= 64 << 10);
    }
}

#[test]
fn snapshots_of_other_environments_are_refused() {
    let base = of(ActuationModel::SpringDamper, Behavior::None, Scene::Base, Compat::Api);
    let snapshot = started(base.clone()).snapshot();
    let mut others = vec![
        Config {
            actuation_model: ActuationModel::Muscle,
            ..base.clone()
        },
        Config {
            scene: Scene::Crib,
            ..base.clone()
        },
        Config {
            behavior: Behavior::SelfTouch,
            ..base.clone()
        },
        Config {
            compat: Compat::Reference,
            ..base.clone()
        },
    ];
    let mut act = base.clone();
    act.act.eyes = false;
    others.push(act);
    for config in others {
        let mut other = started(config);
        let before = other.snapshot();
        let refused = other.restore(&snapshot);
        assert!(
            matches!(refused, Err(SnapshotError::OtherConfiguration { .. })),
            "{refused:?}"
        );
        assert_eq!(other.snapshot(), before);
    }
    // other senses: the same scene, another length
    let refused = |change: &dyn Fn(&mut Config)| {
        let mut config = base.clone();
        change(&mut config);
        let mut other = started(config);
        let (before, refused) = (
            other.snapshot(),
            other.restore(&snapshot).expect_err("another configuration"),
        );
        assert_eq!(other.snapshot(), before);
        refused.to_string()
    };
    for (said, change) in [
        (
            "proprio_torque was true, but here it is false",
            &(|config: &mut Config| config.proprio_torque = false) as &dyn Fn(&mut Config),
        ),
        ("vestibular_active was true, but here it is false", &|config| {
            config.vestibular_active = !config.vestibular_active;
        }),
        (
            "delay_sensory was 0.0, but here it is 2.0; proprio_limits was true, but here it is false",
            &|config| {
                config.proprio_limits = false;
                config.delays.sensory = 2.0;
            },
        ),
    ] {
        let text = refused(change);
        assert_eq!(
            text,
            format!("the snapshot was taken with another configuration: {said}")
        );
    }
    // the layout before this one does not tell
    let mut old = snapshot.as_bytes().to_vec();
    let length = old.len() - 4;
    let keys = u32::from_le_bytes(old[length..].try_into().expect("four bytes")) as usize;
    old.truncate(length - keys);
    old[8] = 4;
    let sum = checksum(&old[32..]).to_le_bytes();
    old[24..32].copy_from_slice(&sum);
    let old = Snapshot::from_bytes(old).expect("a layout that is read");
    let mut env = started(base.clone());
    env.restore(&old).expect("of this configuration");
    assert_eq!(env.snapshot(), snapshot);
    let mut other = started(Config {
        proprio_torque: false,
        ..base
    });
    assert!(matches!(other.restore(&old), Err(SnapshotError::Damaged { .. })));
}

#[test]
fn damaged_bytes_are_refused() {
    let mut env = started(of(
        ActuationModel::Muscle,
        Behavior::SelfTouch,
        Scene::Base,
        Compat::Api,
    ));
    let good = env.snapshot().as_bytes().to_vec();
    assert_eq!(Snapshot::from_bytes(Vec::new()), Err(SnapshotError::NotASnapshot));
    assert_eq!(Snapshot::from_bytes(vec![7; 4096]), Err(SnapshotError::NotASnapshot));
    for n in (0..good.len()).step_by(97).chain(good.len() - 9..good.len()) {
        assert!(Snapshot::from_bytes(good[..n].to_vec()).is_err(), "cut at {n}");
    }
    for k in (0..good.len()).step_by(11).chain(0..40) {
        let mut bytes = good.clone();
        bytes[k] ^= 0x41;
        // a changed fingerprint is noticed by the environment
        match Snapshot::from_bytes(bytes) {
            Ok(s) => assert_eq!(env.restore(&s), Err(SnapshotError::OtherEnvironment), "byte {k}"),
            Err(e) => assert!(!e.to_string().is_empty()),
        }
    }
    let mut newer = good.clone();
    newer[8] = 9;
    assert_eq!(Snapshot::from_bytes(newer), Err(SnapshotError::Version { found: 9 }));
    let mut longer = good.clone();
    longer.push(0);
    assert!(Snapshot::from_bytes(longer).is_err());
    assert_eq!(env.snapshot().as_bytes(), good);
}

/// Bytes whose checksum fits but whose content is nonsense: never a panic, and the environment stays as it was or runs on.
#[test]
fn forged_bytes_never_panic() {
    let mut env = started(of(
        ActuationModel::Muscle,
        Behavior::SelfTouch,
        Scene::Base,
        Compat::Api,
    ));
    let good = env.snapshot();
    let mut x = 1_u64;
    let mut random = || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        x
    };
    let (mut refused, mut taken) = (0, 0);
    for k in 0..3000 {
        let mut bytes = good.as_bytes().to_vec();
        match k % 3 {
            0 => {
                let at = 32 + (random() as usize) % (bytes.len() - 40);
                bytes[at..at + 8].copy_from_slice(&random().to_le_bytes());
            }
            1 => bytes.truncate(32 + (random() as usize) % (bytes.len() - 32)),
            // counts and lists
            _ => {
                let at = 32 + 8 * ((random() as usize) % 10);
                let value = [u64::MAX, 1 << 40, 3, 100][(random() % 4) as usize];
                bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
            }
        }
        let sum = checksum(&bytes[32..]);
        bytes[24..32].copy_from_slice(&sum.to_le_bytes());
        // the checksum fits, but too little may be left
        let Ok(forged) = Snapshot::from_bytes(bytes) else {
            refused += 1;
            continue;
        };
        match env.restore(&forged) {
            Err(_) => {
                refused += 1;
                assert_eq!(env.snapshot(), good);
            }
            Ok(()) => {
                taken += 1;
                let action = vec![0.5; env.action_space().len()];
                let _ = env.step(&action);
                env.restore(&good).expect("its own snapshot");
            }
        }
    }
    println!("{refused} refused, {taken} taken");
    assert!(refused > 0 && taken > 0);
}

/// The checksum as the documentation of the layout has it.
fn checksum(bytes: &[u8]) -> u64 {
    let mix = |h: u64, w: u64| (h ^ w).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let words = bytes.chunks_exact(8);
    let rest = words.remainder();
    let h = words.fold(bytes.len() as u64, |h, w| {
        mix(h, u64::from_le_bytes(w.try_into().expect("eight")))
    });
    rest.iter().fold(h, |h, b| mix(h, u64::from(*b)))
}

/// Faces are looks: MIMo's picture changes, and nothing else.
#[test]
fn faces_change_pictures_alone() {
    let config = Config {
        touch_active: false,
        ..body_only("self_touch")
    };
    let blueprint = blueprint(config);
    let (mut plain, mut env) = (
        blueprint.env().expect("an environment"),
        blueprint.env().expect("an environment"),
    );
    // before the first reset, too
    env.swap_facial_expression(FacialExpression::Sad).expect("a face");
    let picture = |env: &Env| {
        let mut viewer = Viewer::new(env.blueprint()).expect("a viewer");
        viewer.draw(env, "closeup", 96, 96).expect("a picture").to_vec()
    };
    plain.reset(Some(3)).expect("no divergence");
    env.reset(Some(3)).expect("no divergence");
    let mut seen = Vec::new();
    for (k, face) in FacialExpression::ALL.iter().enumerate().skip(1) {
        env.swap_facial_expression(*face).expect("a face");
        assert_eq!(env.observation(), plain.observation(), "{face}");
        let (face_of_his, usual) = (picture(&env), picture(&plain));
        assert!(face_of_his != usual, "{face}");
        seen.push(*face);
        let action = vec![0.1 * k as f32; env.action_space().len()];
        let felt = env
            .step(&action)
            .expect("no divergence")
            .observation
            .proprioception
            .to_vec();
        assert_eq!(
            felt,
            plain.step(&action).expect("no divergence").observation.proprioception,
            "{face}"
        );
    }
    assert_eq!(seen.len(), 6, "six faces beside the usual one");
    // a snapshot of one is one of the other
    plain.restore(&env.snapshot()).expect("the same scene but for looks");
    let config = Config {
        facial_expression: FacialExpression::Scared,
        ..blueprint.config().clone()
    };
    let mut vector = VectorEnv::new(
        &babybench::Blueprint::new(config).expect("a face"),
        2,
        VectorOptions::default(),
    )
    .expect("a vector");
    vector.reset(0).expect("no divergence");
    vector
        .swap_facial_expression(1, FacialExpression::Happy)
        .expect("a face");
    let faces = [0, 1].map(|env| vector.env(env).expect("an environment").config().facial_expression);
    assert_eq!(faces, [FacialExpression::Scared, FacialExpression::Happy]);
}
