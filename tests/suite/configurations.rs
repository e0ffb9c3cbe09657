//! Every switch of the configuration: a grid of combinations, and each key alone.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use babybench::config::{ActuationModel, Behavior, BodyParts, Compat, ConfigReader, Part, Scene};
use babybench::spaces::Dtype;
use babybench::{Config, Env};
use testkit::Rng;

use crate::common::*;

/// Parts of the body, each on but for one in `odds`.
fn parts(rng: &mut Rng, odds: u32) -> BodyParts<bool> {
    let mut parts = BodyParts::all(false);
    for part in Part::ALL {
        *parts.get_mut(part) = rng.u32(..odds) != 0;
    }
    parts
}

/// Combination `k`: behavior, scene, actuation model and compat in turn, everything else by chance.
fn combination(k: usize) -> Config {
    let mut rng = Rng::with_seed(k as u64);
    let mut lock = parts(&mut rng, 2);
    if rng.bool() {
        lock = BodyParts::all(false);
    }
    Config {
        behavior: Behavior::ALL[k % 3],
        scene: Scene::BABYBENCH[k / 3 % 3].clone(),
        actuation_model: ActuationModel::ALL[k / 9 % 3],
        compat: Compat::ALL[k / 27 % 2],
        act: parts(&mut rng, 4),
        lock,
        frame_skip: rng.u32(1..4),
        max_episode_steps: rng.u64(15..25),
        seed: rng.u64(..),
        proprio_velocity: rng.bool(),
        proprio_torque: rng.bool(),
        proprio_limits: rng.bool(),
        proprio_actuation: rng.bool(),
        vestibular_active: rng.bool(),
        vision_active: false,
        touch_active: false,
        ..Config::default()
    }
}

/// Actuators of a part, in MIMo v1 and v2.
fn actuators(part: Part) -> [usize; 2] {
    match part {
        Part::Body | Part::Head => [3, 3],
        Part::Eyes | Part::Hands => [6, 6],
        Part::Arms | Part::Legs => [8, 8],
        Part::Fingers => [2, 44],
        Part::Feet => [8, 10],
    }
}

/// The spaces of the observation.
fn spaces(env: &Env, config: &Config, length: usize) -> Result<(), String> {
    let spaces = env.observation_space();
    let keys: Vec<&str> = spaces.iter().map(|s| s.key).collect();
    let expected: &[&str] = if config.vestibular_active {
        &["observation", "vestibular"]
    } else {
        &["observation"]
    };
    if keys != expected
        || spaces
            .iter()
            .any(|s| s.dtype != Dtype::F64 || s.low != f64::NEG_INFINITY)
    {
        return Err(format!("spaces {spaces:?}"));
    }
    expect("space of the observation", spaces[0].shape[0], length)?;
    expect(
        "entries",
        env.senses()
            .proprioception()
            .entries(env.model(), env.blueprint().actuation())
            .iter()
            .map(|e| e.range.len())
            .sum(),
        length,
    )
}

/// Numbers of actions and of entries of the observation.
fn lengths(config: &Config) -> [usize; 2] {
    let v2 = usize::from(config.behavior == Behavior::HandRegard);
    let (joints, torques) = [(47, 21), (91, 53)][v2];
    let n: usize = config.act.iter().filter(|a| *a.1).map(|a| actuators(a.0)[v2]).sum();
    let (actions, of_actuators) = match config.actuation_model {
        ActuationModel::SpringDamper => (n, 2 * n),
        ActuationModel::Muscle => (2 * n, 4 * n),
        ActuationModel::Positional => (n, n),
    };
    let all = config.compat == Compat::Reference;
    let part = |on: bool, len: usize| if on || all { len } else { 0 };
    let length = joints
        + part(config.proprio_velocity, joints)
        + part(config.proprio_limits, joints)
        + part(config.proprio_torque, 3 * torques)
        + part(config.proprio_actuation, of_actuators);
    [actions, length]
}

fn expect(what: &str, found: usize, expected: usize) -> Result<(), String> {
    if found == expected {
        Ok(())
    } else {
        Err(format!("{what}: {found}, not {expected}"))
    }
}

/// Builds, resets, steps 20 times; says what is wrong.
fn check(config: Config) -> Result<(), String> {
    let [actions, length] = lengths(&config);
    let text = |e: &dyn std::fmt::Display| e.to_string();
    let mut env = Env::new(config.clone()).map_err(|e| text(&e))?;
    expect("actions", env.action_space().len(), actions)?;
    bounds(&env, &config)?;
    spaces(&env, &config, length)?;
    env.reset(None).map_err(|e| text(&e))?;
    let start = if config.behavior == Behavior::None { 0 } else { 10 };
    let mut action = Vec::new();
    for k in 1..=20_u64 {
        env.sample_action(&mut action);
        let step = env.step(&action).map_err(|e| format!("step {k}: {e}"))?;
        expect("observation", step.observation.proprioception.len(), length)?;
        if !step.observation.proprioception.iter().all(|v| v.is_finite()) {
            return Err(format!("step {k}: not finite"));
        }
        expect(
            "vestibular",
            step.observation.vestibular.map_or(0, <[f64]>::len),
            6 * usize::from(config.vestibular_active),
        )?;
        if step.truncated != (k >= config.max_episode_steps) || step.terminated || step.reward != 0.0 {
            return Err(format!("step {k}: truncated {}", step.truncated));
        }
    }
    expect(
        "physics steps",
        env.state().step as usize,
        start + 20 * config.frame_skip as usize,
    )
}

fn bounds(env: &Env, config: &Config) -> Result<(), String> {
    let (model, space) = (env.model(), env.action_space());
    for i in 0..space.len() {
        let a = i % model.nu();
        let expected = match (config.actuation_model, config.compat) {
            (ActuationModel::Muscle, _) => [0.0, 1.0],
            (ActuationModel::Positional, _) => model.jnt_range[model.actuator_trnid[a]],
            (ActuationModel::SpringDamper, Compat::Api) => [-1.0, 1.0],
            (ActuationModel::SpringDamper, Compat::Reference) => model.actuator_forcerange[a],
        };
        let found = [space.low()[i], space.high()[i]];
        if found != expected.map(|v| v as f32) {
            return Err(format!("bounds of action {i}: {found:?}, not {expected:?}"));
        }
    }
    Ok(())
}

/// Figures when written are in the output; without optimisation only some combinations run.
#[test]
fn combinations_build_and_run() {
    let count = if cfg!(debug_assertions) { 54 } else { 540 };
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(8);
    let worker = || {
        let mut bad = Vec::new();
        loop {
            let k = next.fetch_add(1, Relaxed);
            if k >= count {
                return bad;
            }
            let config = combination(k);
            if let Err(e) = check(config.clone()) {
                bad.push(format!("{k}: {e}\n{config:?}"));
            }
        }
    };
    let bad: Vec<String> = std::thread::scope(|s| {
        let workers: Vec<_> = (0..threads).map(|_| s.spawn(worker)).collect();
        workers.into_iter().flat_map(|w| w.join().expect("a worker")).collect()
    });
    println!("{count} combinations on {threads} threads");
    assert!(
        bad.is_empty(),
        "{} combinations are wrong:\n{}",
        bad.len(),
        bad.join("\n")
    );
}

/// Everything an episode shows, as numbers.
fn trace(config: Config) -> u64 {
    let mut env = env(config);
    let mut hash = Fnv::default();
    let add = |hash: &mut Fnv, text: String| hash.add(&text.bytes().map(f64::from).collect::<Vec<_>>());
    add(
        &mut hash,
        format!("{:?} {:?}", env.action_space(), env.observation_space()),
    );
    hash.add(env.reset(None).expect("no divergence").proprioception);
    let mut action = Vec::new();
    for _ in 0..20 {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        hash.add(step.observation.proprioception);
        hash.add(step.observation.vestibular.unwrap_or(&[]));
        add(&mut hash, format!("{} {:?}", step.truncated, step.info));
    }
    hash.0
}

/// Keys whose effect is elsewhere: logs and videos, the other engine, the other renderer, MIMo v2's fingers, and senses with
/// tests of their own.
const ELSEWHERE: [&str; 11] = [
    "learner",
    "other_age",
    "act_others",
    "facial_expression",
    "save_dir",
    "save_logs_every",
    "render_size",
    "engine",
    "renderer",
    "middle_finger_diameter",
    "thumb_diameter",
];

/// Prefixes of keys of senses that have tests of their own.
const SENSES: [&str; 7] = [
    "touch_",
    "vision_",
    "pain_",
    "noise_touch",
    "noise_vision",
    "delay_touch",
    "delay_vision",
];

#[test]
fn no_key_is_without_effect() {
    let base = free(Behavior::None, Scene::Base);
    let infant = Config {
        age: Some(12.0),
        ..base.clone()
    };
    let (original, grown) = (trace(base.clone()), trace(infant.clone()));
    assert_eq!(trace(base.clone()), original, "the trace repeats");
    let mut checked = 0;
    for key in Config::keys() {
        let name = key.name;
        // tests of their own: `tasks::keys_of_tasks_have_an_effect`, `senses`
        let elsewhere = ELSEWHERE.contains(&name) || SENSES.iter().any(|prefix| name.starts_with(prefix));
        if elsewhere || key.section == "Tasks" {
            continue;
        }
        let values: &[&str] = match name {
            "behavior" => &["self_touch", "hand_regard"],
            "scene" => &["crib", "cubes"],
            "scene_extra" => &["<body pos='0 0 1'><freejoint/><geom size='0.1'/></body>"],
            "mimo_version" => &["3"],
            "actuation_model" => &["muscle", "positional"],
            "compat" => &["reference"],
            "max_episode_steps" => &["7"],
            "frame_skip" => &["2", "5"],
            "seed" => &["1", "18446744073709551615"],
            "age" => &["0", "24"],
            "age_schedule" => &["{0: 3}"],
            "age_grid" => continue, // with a schedule, in the tests of the configuration
            "strength_age" => &["3"],
            "strength" => &["infant"],
            _ if name.starts_with("strength_") => continue, // with `strength: infant`, in `milestones`
            "springs" => &["weight"],
            "proportions" => &["measured"],
            "sex" => &["boy", "girl"],
            "body_random" => &["1"],
            "length_z" | "weight_z" | "head_z" | "gestation" => continue, // with `sex`, in `differences`
            "body_seed" | "body_number" => continue,                      // with `body_random`, in `populations`
            "thigh_circumference" | "knee_sole_length" | "rump_knee_length" => &["20"],
            "head_circumference" => &["40"],
            "elbow_hand_length" | "forearm_circumference" | "upper_arm_circumference" => &["17"],
            "ankle_circumference" | "calf_circumference" | "hip_breadth" | "shoulder_elbow_length" => &["14.5"],
            _ if name.ends_with("_breadth") || name.ends_with("_length") => &["6"],
            "mocap_motion" => continue, // with a body to move, in the tests of a caregiver's hand
            _ if key.section == "Reflexes" => continue, // in the tests of reflexes
            "delay_unit" => continue,   // with delays, in the tests of senses
            "delay_by_age" => &["True"],
            _ if name.starts_with("delay_") => &["2"],
            "noise_motor_color" => continue, // with `noise_motor`, in the tests of actuation
            _ if name.starts_with("noise_") => &["0.1"],
            _ if name.starts_with("lock_") => &["True"],
            _ => &["False"],
        };
        let of_age = key.section == "Growth" && name != "age" || name == "delay_by_age";
        let (base, before) = if of_age { (&infant, grown) } else { (&base, original) };
        for value in values {
            let config = ConfigReader::over(base.clone())
                .read_text(&format!("{name}: {value}\n"), "test")
                .expect("allowed");
            assert_ne!(config, *base, "{name}: {value} is another configuration");
            assert_ne!(trace(config), before, "{name}: {value} changes nothing");
            checked += 1;
        }
    }
    println!("{checked} values checked");
}

/// Bodies that cannot be name the keys that are to blame.
#[test]
fn measurements_of_nobody_name_their_keys() {
    let refused = |text: &str, parts: &[&str]| {
        let config = free(Behavior::SelfTouch, Scene::Crib);
        let config = ConfigReader::over(config)
            .read_text(&format!("age: 6\n{text}"), "test")
            .expect("each by itself is allowed");
        let error = Env::new(config).expect_err(text).to_string();
        println!("{error}");
        for part in parts {
            assert!(error.contains(part), "{text}: no {part:?} in {error}");
        }
    };
    refused(
        "head_circumference: 0.1",
        &["`head_circumference` is 0.1", "at 6 months"],
    );
    refused(
        "hand_length: 30\nfoot_length: 10",
        &["`hand_length` is 30.0: at 6 months", "left_lower_arm", "would vanish"],
    );
    refused("hip_breadth: 5", &["`hip_breadth` is 5.0", "mm in each other at rest"]);
    refused(
        "thigh_circumference: 70\nhead_circumference: 40",
        &["`thigh_circumference` is 70.0", "left_upper_leg"],
    );
}
