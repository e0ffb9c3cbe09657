//! Snapshots: bit-identical continuation, bytes that keep, and bytes that are refused.

mod refused;

use crate::common::*;
use babybench::config::{ActuationModel, Behavior, Compat, FacialExpression, Part, Scene};
use babybench::env::{Snapshot, SnapshotError, Viewer};
use babybench::sensors::ProprioceptionComponent;
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
            env.mimo_mut().lock(Part::Arms, 0.02).expect("locks");
            random_steps(&mut env, 1);
            let snapshot = env.snapshot();
            let expect = course(&mut env, 10);

            env.mimo_mut().unlock(Part::Arms).expect("locks");
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
            other.mimo_mut().unlock(Part::Arms).expect("locks");
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
                env.by_hand().refresh().expect("no divergence"),
                other.by_hand().refresh().expect("no divergence"),
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
        let computed = third.by_hand().refresh().expect("no divergence");
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
    let range = env
        .senses()
        .proprioception()
        .range(ProprioceptionComponent::Angles)
        .expect("on");
    let now = env.by_hand().refresh().expect("no divergence").proprioception[range.start];
    assert_eq!(now, qpos[joint]);
    env.state_mut().qpos[joint] = f64::NAN;
    assert!(env.by_hand().refresh().is_err() && !env.by_hand().ready());
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
        assert_eq!(
            (env.last_step().reward, env.by_hand().ready()),
            (twin.last_step().reward, twin.by_hand().ready())
        );
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

/// Faces are looks: MIMo's picture changes, and nothing else.
#[test]
fn faces_change_pictures_alone() {
    let config = Config {
        touch_active: true,
        touch_pooled: true,
        pain_active: true,
        ..body_only("self_touch")
    };
    let blueprint = blueprint(config);
    let (mut plain, mut env) = (
        blueprint.env().expect("an environment"),
        blueprint.env().expect("an environment"),
    );
    // before the first reset, too
    env.mimo_mut()
        .swap_facial_expression(FacialExpression::Sad)
        .expect("a face");
    let picture = |env: &Env| {
        let mut viewer = Viewer::new(env.blueprint()).expect("a viewer");
        viewer.draw(env, "closeup", 96, 96).expect("a picture").to_vec()
    };
    plain.reset(Some(3)).expect("no divergence");
    env.reset(Some(3)).expect("no divergence");
    let mut seen = Vec::new();
    for (k, face) in FacialExpression::ALL.iter().enumerate().skip(1) {
        env.mimo_mut().swap_facial_expression(*face).expect("a face");
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
