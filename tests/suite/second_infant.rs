//! Two infants in one scene.

use babybench::assets::MemoryAssets;
use babybench::config::{ActuationModel, Behavior, Learner, Scene};
use babybench::env::BlueprintOptions;
use babybench::{Blueprint, Config, Env};

use crate::common::*;

/// A floor on which two lie side by side.
const ROOM: &str = "<mujoco model=\"two\"><worldbody>
  <body name=\"mimo_location\" pos=\"0 -0.4 0.1\" euler=\"0 -90 0\"><freejoint name=\"mimo_location\"/><include file=\"mimo.xml\"/></body>
  <body name=\"other_location\" pos=\"0 0.4 0.1\" euler=\"0 -90 0\"><freejoint name=\"other_location\"/><include file=\"other_mimo.xml\"/></body>
</worldbody>
<include file=\"base.xml\"/><include file=\"mimo_settings.xml\"/><include file=\"mimo_actuators.xml\"/>
<include file=\"other_mimo_settings.xml\"/><include file=\"other_mimo_actuators.xml\"/></mujoco>";

fn try_two(config: &Config, room: &str) -> Result<Env, String> {
    let mut files = MemoryAssets::new();
    files.insert("rooms/two.xml", room).expect("a path");
    let config = Config {
        scene: Scene::File("rooms/two.xml".to_string()),
        ..config.clone()
    };
    let blueprint = Blueprint::with(config, BlueprintOptions::default().with_assets(files));
    blueprint
        .and_then(|blueprint| blueprint.env())
        .map_err(|e| e.to_string())
}

fn two(config: &Config) -> Env {
    try_two(config, ROOM).expect("a room for two")
}

fn plain(behavior: Behavior) -> Config {
    free(behavior, Scene::Base)
}

#[test]
fn a_second_policy_moves_the_second_infant() {
    for behavior in [Behavior::SelfTouch, Behavior::HandRegard] {
        let mut env = two(&plain(behavior));
        let alone = env_alone(behavior);
        assert_eq!(env.action_space(), alone.action_space());
        let other = env.blueprint().second_infant().expect("another one");
        assert_eq!(other.action_space().len(), alone.action_space().len());
        assert_eq!(other.joints().len(), alone.senses().proprioception().joints().len());
        env.reset(Some(0)).expect("no divergence");
        let before = env.snapshot();
        let (still, mut seen) = (vec![0.0; env.action_space().len()], Vec::new());
        let elbow = |env: &Env, name: &str| {
            env.state().qpos[env.model().jnt_qposadr[env.model().joint(name).expect("a joint")]]
        };
        repeat(&mut env, &still, 30);
        let rest = [elbow(&env, "robot:right_elbow"), elbow(&env, "other:robot:right_elbow")];
        env.restore(&before).expect("its own");
        for step in 0..30 {
            let bent = vec![-0.5 - 0.01 * step as f32; other.action_space().len()];
            other.act(&mut env, &bent).expect("an action");
            env.step(&still).expect("no divergence");
        }
        let moved = [elbow(&env, "robot:right_elbow"), elbow(&env, "other:robot:right_elbow")];
        assert!(
            (moved[0] - rest[0]).abs() < 1e-6,
            "the learner rests: {rest:?} {moved:?}"
        );
        assert!(moved[1] < rest[1] - 0.2, "the other bends his arm: {rest:?} {moved:?}");
        other.observe(env.state(), &mut seen).expect("its own scene");
        assert_eq!(seen.len(), other.observation_len());
        assert!(seen.contains(&moved[1]));
        // the learner's controls are his own
        let touched = other
            .actuators()
            .iter()
            .filter(|&&i| env.state().ctrl[i] != 0.0)
            .count();
        assert_eq!(touched, other.actuators().len());
        assert!(
            env.blueprint()
                .actuation()
                .actuators()
                .iter()
                .all(|&i| env.state().ctrl[i] == 0.0)
        );
        env.reset(None).expect("no divergence");
        assert!(
            other.actuators().iter().all(|&i| env.state().ctrl[i] == 0.0),
            "a reset lets him rest"
        );
        assert!(other.act(&mut env, &[0.0]).is_err() && other.act(&mut env, &vec![f32::NAN; still.len()]).is_err());
    }
}

fn env_alone(behavior: Behavior) -> Env {
    env(plain(behavior))
}

/// Far from each other, the learner moves as he does alone.
#[test]
fn the_learner_is_as_he_is_alone() {
    let (mut alone, mut pair) = (env(plain(Behavior::SelfTouch)), two(&plain(Behavior::SelfTouch)));
    let mut seen = [Vec::new(), Vec::new()];
    for (env, seen) in [&mut alone, &mut pair].into_iter().zip(&mut seen) {
        env.reset(Some(1)).expect("no divergence");
        held_steps(env, 40, 10);
        seen.extend_from_slice(env.observation().proprioception);
    }
    assert_eq!(seen[0].len(), seen[1].len());
    let apart = seen[0]
        .iter()
        .zip(&seen[1])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    println!("proprioception differs by {apart:.1e}");
    assert!(apart < 1e-3, "{apart}");
}

#[test]
fn either_of_them_learns_at_an_age_of_his_own() {
    let config = |learner| Config {
        age: Some(3.0),
        other_age: Some(20.0),
        learner,
        ..plain(Behavior::SelfTouch)
    };
    let (first, second) = (two(&config(Learner::Mimo)), two(&config(Learner::Other)));
    let place = |env: &Env, name: &str| env.model().body_pos[env.model().body(name).expect("a body")];
    for (env, learner, other) in [
        (&first, "mimo_location", "other_location"),
        (&second, "other_location", "mimo_location"),
    ] {
        let model = env.model();
        let body = |name: &str| model.body(name).expect("a body");
        assert!(model.in_subtree(body("hip"), body(learner)) && model.in_subtree(body("other:hip"), body(other)));
        let mass = |name: &str| model.body_subtreemass[body(name)];
        let grown = |age| {
            blueprint(Config {
                age: Some(age),
                ..plain(Behavior::SelfTouch)
            })
        };
        for (name, age) in [("hip", 3.0), ("other:hip", 20.0)] {
            let alone = grown(age);
            let expected = alone.model().body_subtreemass[alone.model().body("hip").expect("a body")];
            assert!(
                (mass(name) - expected).abs() < 1e-9,
                "{name} at {age}: {} {expected}",
                mass(name)
            );
        }
        let gear = |name: &str| model.actuator_gear[model.actuator(name).expect("a motor")];
        assert!(gear("act:right_elbow") < gear("other:act:right_elbow"));
    }
    assert_eq!(place(&first, "mimo_location")[1], place(&second, "mimo_location")[1]);
}

#[test]
fn what_cannot_be_is_said() {
    let original = two(&plain(Behavior::SelfTouch));
    assert!(original.blueprint().second_infant().is_some());
    assert!(env_alone(Behavior::SelfTouch).blueprint().second_infant().is_none());
    let muscles = Config {
        actuation_model: ActuationModel::Muscle,
        ..plain(Behavior::SelfTouch)
    };
    assert!(two(&muscles).blueprint().second_infant().is_none());
    let servos = Config {
        actuation_model: ActuationModel::Positional,
        ..plain(Behavior::SelfTouch)
    };
    let env = two(&servos);
    let second = env.blueprint().second_infant().expect("another one");
    assert_eq!(second.action_space().low(), env.action_space().low());
    // an environment with another scene is refused, and stays as it is
    let mut alone = env_alone(Behavior::SelfTouch);
    let controls = alone.state().ctrl.clone();
    let action = vec![0.0; second.action_space().len()];
    assert!(second.act(&mut alone, &action).is_err());
    assert!(second.observe(alone.state(), &mut Vec::new()).is_err());
    assert_eq!(alone.state().ctrl, controls);
    for text in ["scene: crib\nlearner: other", "scene: crib\nother_age: 3"] {
        let error = Config::from_yaml(text, "c.yml").expect_err("refused").to_string();
        assert!(error.contains("c.yml:2:") && error.contains("second infant"), "{error}");
    }
    // an age of somebody who is not there
    let room = "<mujoco><worldbody><body name=\"mimo_location\" pos=\"0 0 0.1\"><freejoint name=\"mimo_location\"/><include file=\"mimo.xml\"/></body></worldbody>\
                <include file=\"base.xml\"/><include file=\"mimo_settings.xml\"/><include file=\"mimo_actuators.xml\"/></mujoco>";
    let config = Config {
        other_age: Some(3.0),
        ..plain(Behavior::SelfTouch)
    };
    let error = try_two(&config, room).expect_err("nobody is there");
    assert!(
        error.contains("rooms/two.xml") && error.contains("other_mimo.xml"),
        "{error}"
    );
    let learner = Config {
        learner: Learner::Other,
        ..plain(Behavior::SelfTouch)
    };
    assert!(try_two(&learner, room).is_err());
}
