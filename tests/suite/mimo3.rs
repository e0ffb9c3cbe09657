//! MIMo 3, whose chest has two joints.

use babybench::assets::MemoryAssets;
use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::env::BlueprintOptions;
use babybench::mimo::{MimoJoints, lock_of};
#[cfg(feature = "eval")]
use babybench::runs::{complete_scene, read_scene, write_scene};
use babybench::{Blueprint, Config, Env};

use crate::common::*;

/// A floor on which two of them lie side by side.
const ROOM: &str = "<mujoco model=\"two\"><worldbody>
  <body name=\"mimo_location\" pos=\"0 -0.4 0.1\" euler=\"0 -90 0\"><freejoint name=\"mimo_location\"/><include file=\"mimo.xml\"/></body>
  <body name=\"other_location\" pos=\"0 0.4 0.1\" euler=\"0 -90 0\"><freejoint name=\"other_location\"/><include file=\"other_mimo.xml\"/></body>
</worldbody>
<include file=\"base.xml\"/><include file=\"mimo_settings.xml\"/><include file=\"mimo_actuators.xml\"/>
<include file=\"other_mimo_settings.xml\"/><include file=\"other_mimo_actuators.xml\"/></mujoco>";

fn third(behavior: Behavior) -> Config {
    Config {
        mimo_version: 3,
        ..free(behavior, Scene::Base)
    }
}

fn env(config: Config) -> Env {
    let name = format!("{} at {:?}", config.behavior, config.age);
    let made = Blueprint::new(config).and_then(|blueprint| blueprint.env());
    made.unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn every_behavior_has_the_chest_at_every_age() {
    for &behavior in Behavior::ALL {
        for age in [None, Some(0.0), Some(9.5), Some(24.0)] {
            let own = Config::of(behavior);
            let config = Config {
                mimo_version: 3,
                vision_active: false,
                age,
                ..own
            };
            let mut env = env(config);
            let second = MimoJoints::new(env.model()).len() > 50;
            assert_eq!(
                MimoJoints::new(env.model()).len(),
                if second { 93 } else { 49 },
                "{behavior}"
            );
            for name in ["robot:chest_lean", "robot:chest_rot"] {
                assert!(env.model().joint(name).is_some(), "{behavior}: {name}");
            }
            env.reset(Some(0)).expect("no divergence");
            let action = vec![0.1; env.action_space().len()];
            for _ in 0..3 {
                env.step(&action).expect("no divergence");
            }
            // a snapshot continues with the same bits
            let snapshot = env.snapshot();
            repeat(&mut env, &action, 2);
            let later = env.state().qpos.clone();
            env.restore(&snapshot).expect("its own");
            repeat(&mut env, &action, 2);
            assert_eq!(env.state().qpos, later, "{behavior}");
        }
    }
}

#[test]
fn the_chest_moves_and_can_be_locked() {
    for actuation_model in [
        ActuationModel::SpringDamper,
        ActuationModel::Positional,
        ActuationModel::Muscle,
    ] {
        let config = Config {
            actuation_model,
            ..third(Behavior::None)
        };
        let turned = |config: Config| {
            let mut env = env(config);
            env.reset(Some(0)).expect("no divergence");
            let model = env.model().clone();
            let twist = model.actuator("act:chest_twist").expect("a motor");
            let place = env.blueprint().actuation().actuators().iter().position(|&i| i == twist);
            let mut action = vec![0.0; env.action_space().len()];
            action[place.expect("it is MIMo's")] = 0.3;
            repeat(&mut env, &action, 100);
            let joint = model.joint("robot:chest_rot").expect("a joint");
            assert!(lock_of(&model, joint).is_some());
            env.state().qpos[model.jnt_qposadr[joint]].abs()
        };
        let free = turned(config.clone());
        let mut locked = config;
        locked.lock.body = true;
        let held = turned(locked);
        assert!(free > 0.02 && held < free / 5.0, "{actuation_model}: {free} {held}");
    }
}

#[test]
fn rooms_and_second_infants_have_the_chest() {
    let mut files = MemoryAssets::new();
    files.insert("rooms/two.xml", ROOM).expect("a path");
    for behavior in [Behavior::None, Behavior::HandRegard] {
        for (age, other_age) in [(None, None), (Some(3.0), Some(20.0))] {
            let config = Config {
                scene: Scene::File("rooms/two.xml".to_string()),
                age,
                other_age,
                ..third(behavior)
            };
            let options = BlueprintOptions::default().with_assets(files.clone());
            let blueprint = Blueprint::with(config, options).unwrap_or_else(|e| panic!("{e}"));
            let model = blueprint.model();
            for prefix in ["", "other:"] {
                let chest = model.body(&format!("{prefix}chest")).expect("a chest");
                let hand = model.body(&format!("{prefix}left_hand")).expect("a hand");
                assert!(model.in_subtree(hand, chest));
                assert!(model.joint(&format!("{prefix}robot:chest_rot")).is_some());
                assert!(model.geom(&format!("{prefix}geom:left_hand2")).is_some());
            }
        }
    }
}

#[cfg(feature = "eval")]
#[test]
fn the_scene_of_a_run_has_the_chest() {
    for behavior in [
        Behavior::None,
        Behavior::HandRegard,
        Behavior::Catch,
        Behavior::RollOver,
    ] {
        let folder = Folder::new("mimo3");
        let config = third(behavior);
        assert!(complete_scene(&config).expect("a scene").xml.contains("chest_twist") || behavior == Behavior::Catch);
        write_scene(&config, folder.path()).expect("a scene");
        let read = read_scene(folder.path()).expect("it loads");
        let blueprint = Blueprint::new(config).expect("a scene");
        assert_eq!(read.geom_name, blueprint.model().geom_name);
        assert_eq!(read.body_pos, blueprint.model().body_pos);
    }
}
