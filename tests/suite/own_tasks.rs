//! The library's own rooms and tasks: a mobile that a limb moves, and toys.

use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, Limb, MobileOptions, Scene};
use babybench::env::{BlueprintOptions, Info};
use babybench::{Blueprint, Config, Env};

use crate::common::*;

fn bare(behavior: Behavior) -> Config {
    Config {
        touch_active: false,
        vision_active: false,
        ..Config::of(behavior)
    }
}

fn measure(info: &Info, name: &str) -> f64 {
    let task = info.behavior.task().expect("a task");
    task.measures
        .get(name)
        .unwrap_or_else(|| panic!("nothing is called {name}"))
}

/// Kicks with the right leg, the slower the later in an episode: all its joints, to and fro, 1.25 times a second.
fn kick(env: &Env, step: usize, action: &mut [f32]) {
    let driven = env.blueprint().actuation().actuators();
    for (value, &id) in action.iter_mut().zip(driven) {
        let leg =
            env.model().actuator_name[id].contains("right_hip") || env.model().actuator_name[id].contains("right_knee");
        *value = match leg {
            true if (step / 40).is_multiple_of(2) => -1.0,
            true => 1.0,
            false => 0.0,
        };
    }
}

#[test]
fn the_mobile_moves_with_the_limb_while_it_is_tied() {
    let mut env = env(Config {
        max_episode_steps: 1200,
        ..bare(Behavior::Mobile)
    });
    env.reset(Some(0)).expect("no divergence");
    let mut action = vec![0.0; env.action_space().len()];
    let mut phases = Vec::new();
    for step in 0..1200 {
        kick(&env, step, &mut action);
        let made = env.step(&action).expect("no divergence");
        assert_eq!(made.reward, 0.0);
        phases.push(measure(made.info, "phase"));
    }
    assert_eq!(
        [0.0, 1.0, 2.0].map(|phase| phases.iter().filter(|p| **p == phase).count()),
        [240, 720, 240]
    );
    assert!(phases.is_sorted());
    let info = env.info();
    let speed = |phase: &str, seconds: f64| measure(info, &format!("mobile_movement_{phase}")) / seconds;
    let (before, tied) = (speed("baseline", 2.4), speed("reinforcement", 7.2));
    println!("the mobile moves {before:.3} m/s before and {tied:.3} m/s while it is tied");
    assert!(tied > 4.0 * before, "{before} {tied}");
    let kicks = |limb: &str| measure(info, &format!("{limb}_movements_reinforcement"));
    println!(
        "movements: {:?}",
        ["right_foot", "left_foot", "right_hand", "left_hand"].map(kicks)
    );
    // to and fro, nine times; the limbs hit their limits, and the rest of the body moves along
    assert!((12.0..=80.0).contains(&kicks("right_foot")));
    let ratio = measure(info, "baseline_ratio");
    assert!((0.4..2.0).contains(&ratio), "about equally many movements: {ratio}");
    assert_eq!(info.behavior.task().expect("a task").outcome.is_success, ratio >= 1.5);
}

/// Who moves more while the mobile is tied has learned; what moves the mobile is the reward, if it is asked for.
#[test]
fn moving_more_is_success_and_the_mobile_a_reward() {
    let mut env = env(Config {
        max_episode_steps: 1000,
        mobile: MobileOptions {
            reward: true,
            ..MobileOptions::default()
        },
        ..bare(Behavior::Mobile)
    });
    env.reset(Some(0)).expect("no divergence");
    let mut action = vec![0.0; env.action_space().len()];
    let mut sum = 0.0;
    for step in 0..1000 {
        action.fill(0.0);
        if !(40..200).contains(&step) {
            kick(&env, step, &mut action);
        }
        sum += env.step(&action).expect("no divergence").reward;
    }
    let task = env.info().behavior.task().expect("a task").clone();
    println!("ratio {:?}, return {sum}", task.measures.get("baseline_ratio"));
    assert!(task.outcome.is_success);
    let moved: f64 = task
        .measures
        .iter()
        .filter(|m| m.0.starts_with("mobile_movement"))
        .map(|m| m.1)
        .sum();
    assert!((sum - moved).abs() < 1e-9 && sum == task.episode_return);
}

#[test]
fn the_cuff_is_at_the_limb_that_is_asked_for_at_every_age() {
    for &limb in Limb::ALL {
        for age in [None, Some(0.0), Some(6.0), Some(24.0)] {
            let mut env = env(Config {
                age,
                mobile: MobileOptions {
                    limb,
                    ..MobileOptions::default()
                },
                ..bare(Behavior::Mobile)
            });
            env.reset(Some(1)).expect("no divergence");
            let place = |name: &str| env.state().xpos[env.model().body(name).expect("a body")];
            let (cuff, end) = (place("cuff"), place(limb.name()));
            let distance = max_abs(&[cuff[0] - end[0], cuff[1] - end[1], cuff[2] - end[2]]);
            assert!(distance < 0.03, "{limb} at {age:?}: {distance} m");
            let still = env.state().qvel.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            assert!(still < 10.0, "{limb} at {age:?}: something moves at {still}");
        }
    }
}

/// Puts a toy somewhere, at rest.
fn put(env: &mut Env, toy: &str, place: [f64; 3]) {
    let (mut qpos, qvel) = (env.state().qpos.clone(), vec![0.0; env.model().nv]);
    let joint = env.model().joint(toy).expect("a toy");
    let at = env.model().jnt_qposadr[joint];
    qpos[at..at + 3].copy_from_slice(&place);
    env.by_hand().set_state(&qpos, &qvel).expect("no divergence");
}

#[test]
fn toys_count_as_they_are_touched_and_moved() {
    let mut config = bare(Behavior::Play);
    config.play.reward = true;
    let mut env = env(config);
    env.reset(Some(0)).expect("no divergence");
    assert_eq!(measure(env.info(), "toys"), 9.0);
    let still = vec![0.0; env.action_space().len()];
    let before = measure(env.step(&still).expect("no divergence").info, "toys_touched");
    // over his thigh, from where it rolls down
    let place = |name: &str| env.state().xpos[env.model().body(name).expect("MIMo")];
    let (top, knee) = (place("left_upper_leg"), place("left_lower_leg"));
    let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (top[k] + knee[k]));
    put(&mut env, "ball", [middle[0], middle[1], middle[2] + 0.1]);
    let mut earned = 0.0;
    for _ in 0..150 {
        earned += env.step(&still).expect("no divergence").reward;
    }
    let info = env.info();
    assert_eq!(measure(info, "toys_touched"), before + 1.0);
    assert_eq!(earned, 1.0);
    assert!(measure(info, "toys_moved") >= 1.0 && measure(info, "toys_path") > 0.05);
}

#[test]
fn a_toy_is_held_while_only_he_touches_it() {
    let mut env = env(bare(Behavior::Play));
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    // the block stays in front of the palm, whatever gravity says
    env.state_mut().params.gravity = [0.0; 3];
    let hand = model.body("right_hand").expect("a hand");
    let (place, axes) = (env.state().xpos[hand], env.state().xmat[hand]);
    let still = vec![0.0; env.action_space().len()];
    let mut held: f64 = 0.0;
    for side in [0.03, -0.03, 0.02, -0.02] {
        let beside: [f64; 3] = std::array::from_fn(|k| place[k] + side * axes[3 * k + 1] + 0.03 * axes[3 * k + 2]);
        put(&mut env, "violet_block", beside);
        for _ in 0..10 {
            env.step(&still).expect("no divergence");
        }
        held = held.max(measure(env.info(), "holding_time"));
    }
    assert!(held > 0.0 && measure(env.info(), "toys_held") >= 1.0);
}

#[test]
fn play_takes_toys_in_any_scene_and_says_if_there_are_none() {
    let mut env = env(Config {
        scene: Scene::Cubes,
        ..bare(Behavior::Play)
    });
    env.reset(Some(0)).expect("no divergence");
    assert_eq!(measure(env.info(), "toys"), 16.0);
    let bare = Config {
        scene: Scene::Base,
        ..bare(Behavior::Play)
    };
    let error = Blueprint::new(bare).expect_err("no toys").to_string();
    assert!(
        error.contains("body with a free joint") && error.contains("behavior play"),
        "{error}"
    );
    let mobile = Config {
        scene: Scene::Crib,
        ..Config::of(Behavior::Mobile)
    };
    let error = Blueprint::new(mobile).expect_err("no mobile").to_string();
    assert!(error.contains("tether_right_foot"), "{error}");
}

/// Both rooms are for all behaviors, and documents of one's own can include them.
#[test]
fn other_behaviors_live_in_the_rooms_too() {
    for (scene, behavior) in [
        (Scene::Mobile, Behavior::HandRegard),
        (Scene::Playroom, Behavior::SelfTouch),
    ] {
        let mut env = env(free(behavior, scene));
        env.reset(Some(0)).expect("no divergence");
        random_steps(&mut env, 50);
    }
    let text = "<mujoco><worldbody><body name='mimo_location' pos='0 0 0.3' euler='0 -90 0'><freejoint name='mimo_location'/>\
                <include file='mimo.xml'/></body></worldbody><include file='base.xml'/><include file='mimo_settings.xml'/>\
                <include file='mimo_actuators.xml'/><include file='crib.xml'/><include file='mobile.xml'/></mujoco>";
    let mut files = MemoryAssets::new();
    files.insert("rooms/mine.xml", text).expect("a path");
    let config = Config {
        scene: Scene::File("rooms/mine.xml".to_string()),
        ..bare(Behavior::Mobile)
    };
    let room = Blueprint::with(config, BlueprintOptions::default().with_assets(files)).expect("a room");
    let library = blueprint(bare(Behavior::Mobile));
    assert_eq!(room.init_qpos(), library.init_qpos());
}
