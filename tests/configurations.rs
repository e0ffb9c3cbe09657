//! Every switch of the configuration: a grid of combinations, and each key alone.

mod common;

use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use babybench::config::{ActuationModel, Behavior, BodyParts, Compat, Part, Scene};
use babybench::env::Dtype;
use babybench::{Config, Env};
use common::*;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn flag(&mut self) -> bool {
        self.next() & 1 == 1
    }

    fn parts(&mut self, odds: u64) -> BodyParts<bool> {
        let mut parts = BodyParts::all(false);
        for part in Part::ALL {
            *parts.get_mut(part) = !self.next().is_multiple_of(odds);
        }
        parts
    }
}

/// Combination `k`: behavior, scene, actuation model and compat in turn, everything else by chance.
fn combination(k: usize) -> Config {
    let mut r = Random(k as u64);
    let mut lock = r.parts(2);
    if r.flag() {
        lock = BodyParts::all(false);
    }
    Config {
        behavior: Behavior::ALL[k % 3],
        scene: Scene::ALL[k / 3 % 3],
        actuation_model: ActuationModel::ALL[k / 9 % 3],
        compat: Compat::ALL[k / 27 % 2],
        act: r.parts(4),
        lock,
        frame_skip: 1 + (r.next() % 3) as u32,
        max_episode_steps: 15 + r.next() % 10,
        seed: r.next(),
        proprio_velocity: r.flag(),
        proprio_torque: r.flag(),
        proprio_limits: r.flag(),
        proprio_actuation: r.flag(),
        vestibular_active: r.flag(),
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

/// Builds, resets, steps 20 times; says what is wrong.
fn check(config: Config) -> Result<(), String> {
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

    let text = |e: &dyn std::fmt::Display| e.to_string();
    let mut env = Env::new(config.clone()).map_err(|e| text(&e))?;
    let expect = |what: &str, found: usize, expected: usize| {
        if found == expected {
            Ok(())
        } else {
            Err(format!("{what}: {found}, not {expected}"))
        }
    };
    expect("actions", env.action_space().len(), actions)?;
    bounds(&env, &config)?;
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
        env.proprioception()
            .entries(env.model(), env.actuation())
            .iter()
            .map(|e| e.range.len())
            .sum(),
        length,
    )?;

    env.reset(None).map_err(|e| text(&e))?;
    let start = if config.behavior == Behavior::None { 0 } else { 10 };
    let mut action = Vec::new();
    for k in 1..=20_u64 {
        env.sample_action(&mut action);
        let step = env.step(&action).map_err(|e| format!("step {k}: {e}"))?;
        expect("observation", step.observation.observation.len(), length)?;
        if !step.observation.observation.iter().all(|v| v.is_finite()) {
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
    hash.add(env.reset(None).expect("no divergence").observation);
    let mut action = Vec::new();
    for _ in 0..20 {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        hash.add(step.observation.observation);
        hash.add(step.observation.vestibular.unwrap_or(&[]));
        add(&mut hash, format!("{} {:?}", step.truncated, step.info));
    }
    hash.0
}

/// Keys whose effect is elsewhere: logs and videos, the other engine, the other renderer, and senses with tests of their own.
const ELSEWHERE: [&str; 5] = ["save_dir", "save_logs_every", "render_size", "engine", "renderer"];

#[test]
fn no_key_is_without_effect() {
    let base = free(Behavior::None, Scene::Base);
    let before = trace(base.clone());
    assert_eq!(trace(base.clone()), before, "the trace repeats");
    let mut checked = 0;
    for key in Config::keys() {
        let name = key.name;
        if ELSEWHERE.contains(&name) || name.starts_with("touch_") || name.starts_with("vision_") {
            continue;
        }
        let values: &[&str] = match name {
            "behavior" => &["self_touch", "hand_regard"],
            "scene" => &["crib", "cubes"],
            "actuation_model" => &["muscle", "positional"],
            "compat" => &["reference"],
            "max_episode_steps" => &["7"],
            "frame_skip" => &["2", "5"],
            "seed" => &["1", "18446744073709551615"],
            _ if name.starts_with("lock_") => &["True"],
            _ => &["False"],
        };
        for value in values {
            let config = base
                .clone()
                .overlay_yaml(&format!("{name}: {value}\n"), "test")
                .expect("allowed");
            assert_ne!(config, base, "{name}: {value} is another configuration");
            assert_ne!(trace(config), before, "{name}: {value} changes nothing");
            checked += 1;
        }
    }
    println!("{checked} values checked");
}

/// A renderer that is not in this build is an error before anything is built.
#[cfg(not(feature = "wgpu"))]
#[test]
fn without_the_feature_the_error_says_how_to_build() {
    let config = Config {
        renderer: babybench::config::RendererKind::Wgpu,
        ..free(Behavior::None, Scene::Base)
    };
    let error = Env::new(config).expect_err("not in this build").to_string();
    assert!(
        error.contains("--features wgpu") && error.contains("renderer: cpu"),
        "{error}"
    );
}

fn cli(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_babybench"))
        .args(arguments)
        .output()
        .expect("the binary runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{arguments:?}: {text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    text
}

#[test]
fn all_behaviors_and_actuation_models_run_from_the_command_line() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    for &behavior in Behavior::ALL {
        for &kind in ActuationModel::ALL {
            let config = Config {
                actuation_model: kind,
                ..free(behavior, Scene::Base)
            };
            let path = dir.join(format!("configurations_{behavior}_{kind}.yml"));
            std::fs::write(&path, config.to_yaml()).expect("a temporary file");
            let file = path.to_str().expect("a path of ours");
            let ran = cli(&["run", "--quiet", "--steps", "5", "--config", file]);
            assert!(ran.contains("\"steps\": 5"), "{ran}");
            let inspected = cli(&["inspect", "--config", file]);
            let env = env(config);
            for name in env.actuation().action_names(env.model()) {
                assert!(inspected.contains(&name), "{name} is not explained");
            }
            for entry in env.proprioception().entries(env.model(), env.actuation()) {
                let line = format!(
                    "{:4}..{:4} {:10} {}",
                    entry.range.start,
                    entry.range.end,
                    entry.component.name(),
                    entry.name
                );
                assert!(inspected.contains(&line), "{line:?} is not in the output");
            }
        }
    }
}
