//! Long runs, and starts that make no sense: what the simulation withstands. Prints tables of Markdown.
//!
//! ```sh
//! cargo run --release --example endurance -- steps 10000000   # over scenes, bodies, actuation models and engines
//! cargo run --release --example endurance -- starts 50000     # interpenetration, 10^6 rad/s and more
//! ```
//!
//! A step is an error of its type or leaves finite numbers; a twin that is restored from a snapshot goes on with the same bits; memory
//! does not grow. Whatever is not so ends the program.

use std::error::Error;
use std::time::{Duration, Instant};

use babybench::config::{ActuationModel, Behavior, BodyParts, EngineKind, Scene};
use babybench::env::Snapshot;
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Config, Env};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Steps between two snapshots.
const TWIN_EVERY: u64 = 1000;
/// Steps for which the kind of action stays.
const KIND_FOR: u64 = 250;
/// The engine that is slow gets one step of so many.
const RAPIER_SHARE: u64 = 20;

/// A number from 0 to `n` - 1.
fn below(rng: &mut NumpyRng, n: usize) -> usize {
    (rng.uniform() * n as f64) as usize
}

/// Everything moves; without touch and eyes.
fn configurations() -> Vec<Config> {
    let mut out = Vec::new();
    for &scene in Scene::ALL {
        for behavior in [Behavior::SelfTouch, Behavior::HandRegard] {
            for &actuation_model in ActuationModel::ALL {
                for &engine in EngineKind::ALL {
                    out.push(Config {
                        scene,
                        behavior,
                        actuation_model,
                        engine,
                        vision_active: false,
                        touch_active: false,
                        act: BodyParts::all(true),
                        lock: BodyParts::all(false),
                        ..Config::default()
                    });
                }
            }
        }
    }
    out
}

fn name(config: &Config) -> String {
    let body = match config.behavior {
        Behavior::HandRegard => "v2",
        _ => "v1",
    };
    format!(
        "{} | {body} | {} | {}",
        config.scene, config.actuation_model, config.engine
    )
}

/// Chooses an action: bang-bang, random, held, alternating or resting.
fn act(rng: &mut NumpyRng, kind: usize, step: u64, space: [&[f32]; 2], action: &mut [f32]) {
    let [low, high] = space;
    for (i, a) in action.iter_mut().enumerate() {
        *a = match kind {
            0 if rng.uniform() < 0.5 => low[i],
            0 => high[i],
            1 => low[i] + (high[i] - low[i]) * rng.uniform() as f32,
            2 if !step.is_multiple_of(KIND_FOR) => *a,
            2 => low[i] + (high[i] - low[i]) * rng.uniform() as f32,
            3 if step.is_multiple_of(2) => low[i],
            3 => high[i],
            _ => 0.0_f32.clamp(low[i], high[i]),
        };
    }
}

/// Checks that the senses are finite.
fn check(env: &Env) -> Result<()> {
    let seen = env.observation();
    let mut numbers = seen.proprioception.iter().chain(seen.vestibular.unwrap_or_default());
    match numbers.all(|v| v.is_finite()) {
        true => Ok(()),
        false => Err(format!("{}: an observation is not finite", name(env.config())).into()),
    }
}

/// Memory of the process, kB; 0 off Linux.
fn memory() -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|rest| rest.split_whitespace().next()?.parse().ok())
        .unwrap_or(0)
}

/// Restores the twin from a snapshot in bytes and lets both make a step.
fn compare(env: &mut Env, twin: &mut Env, action: &[f32]) -> Result<()> {
    let bytes = env.snapshot().as_bytes().to_vec();
    twin.restore(&Snapshot::from_bytes(bytes)?)?;
    let bits = |env: &mut Env| match env.step(action) {
        Ok(step) => Ok(step
            .observation
            .proprioception
            .iter()
            .map(|v| v.to_bits())
            .collect::<Vec<u64>>()),
        Err(e) => Err(e.to_string()),
    };
    match bits(env) == bits(twin) {
        true => Ok(()),
        false => Err(format!("{}: the twin differs", name(env.config())).into()),
    }
}

fn endure(config: Config, steps: u64, seed: u64) -> Result<()> {
    let (title, blueprint) = (name(&config), Blueprint::new(config)?);
    let (mut env, mut twin) = (blueprint.env()?, blueprint.env()?);
    let (low, high) = (env.action_space().low().to_vec(), env.action_space().high().to_vec());
    let mut rng = NumpyRng::seed(seed);
    let mut action = vec![0.0; low.len()];
    let (mut errors, mut twins, mut fastest, mut kind, mut early) = (0, 0, 0.0_f64, 0, 0);
    env.reset(Some(seed))?;
    twin.reset(Some(seed + 1))?;
    for step in 0..steps {
        if step == steps / 10 {
            early = memory();
        }
        if step % KIND_FOR == 0 {
            kind = below(&mut rng, 5);
        }
        act(&mut rng, kind, step, [&low, &high], &mut action);
        let result = match step % TWIN_EVERY {
            0 => {
                twins += 1;
                compare(&mut env, &mut twin, &action)?;
                env.ready()
            }
            _ => env.step(&action).is_ok(),
        };
        if !result {
            errors += 1;
            env.reset(None)?;
            continue;
        }
        check(&env)?;
        fastest = env.state().qvel.iter().fold(fastest, |m, v| m.max(v.abs()));
    }
    let grown = memory().saturating_sub(early);
    println!("| {title} | {steps} | {errors} | {twins} | {fastest:.0} | {grown} |");
    Ok(())
}

fn steps(all: u64) -> Result<()> {
    println!(
        "| scene | body | actuation | engine | steps | errors | twins | largest speed, rad/s or m/s | memory grown, kB |"
    );
    println!("|---|---|---|---|--:|--:|--:|--:|--:|");
    let configurations = configurations();
    let soft = configurations.iter().filter(|c| c.engine == EngineKind::Soft).count() as u64;
    for (config, seed) in configurations.into_iter().zip(0..) {
        let share = match config.engine {
            EngineKind::Soft => all.div_ceil(soft),
            _ => all.div_ceil(soft * RAPIER_SHARE),
        };
        endure(config, share, seed)?;
    }
    Ok(())
}

/// Positions and velocities that make no sense.
fn absurd(rng: &mut NumpyRng, qpos: &mut [f64], qvel: &mut [f64]) {
    const FAR: [f64; 10] = [0.0, 1e-3, 0.1, 1.0, 3.0, 10.0, 1e3, 1e6, 1e11, 1e300];
    const FAST: [f64; 10] = [0.0, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e9, 1e150, 1e300];
    const ODD: [f64; 7] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, 5e-324, -0.0];
    let (far, fast, kind) = (FAR[below(rng, 10)], FAST[below(rng, 10)], below(rng, 8));
    for v in qpos.iter_mut() {
        if kind != 1 || rng.uniform() < 0.1 {
            *v += far * (2.0 * rng.uniform() - 1.0);
        }
    }
    for v in qvel.iter_mut() {
        if kind != 2 || rng.uniform() < 0.1 {
            *v = fast * (2.0 * rng.uniform() - 1.0);
        }
    }
    let one = below(rng, qpos.len());
    match kind {
        3 => qpos.fill(0.0), // everything in one place, quaternions of no length
        4 => qpos[one] = ODD[below(rng, 7)],
        5 => qvel[one % qvel.len()] = ODD[below(rng, 7)],
        _ => {}
    }
}

fn starts(all: usize) -> Result<()> {
    println!("| scene | body | actuation | engine | starts | errors | slowest, ms | most contacts |");
    println!("|---|---|---|---|--:|--:|--:|--:|");
    let configurations = configurations();
    let each = all.div_ceil(configurations.len());
    for (config, seed) in configurations.into_iter().zip(0..) {
        let (title, mut env, mut rng) = (name(&config), Env::new(config)?, NumpyRng::seed(seed));
        env.reset(Some(seed))?;
        let (start, speed) = (env.state().qpos.clone(), env.state().qvel.clone());
        let ends = vec![1e9; env.action_space().len()];
        let (mut errors, mut slowest, mut contacts) = (0, Duration::ZERO, 0);
        for _ in 0..each {
            let (mut qpos, mut qvel) = (start.clone(), speed.clone());
            absurd(&mut rng, &mut qpos, &mut qvel);
            let begun = Instant::now();
            let mut sound = env.reset_to(&qpos, &qvel).is_ok();
            for _ in 0..5 {
                sound = sound && env.step(&ends).is_ok();
                if sound {
                    check(&env)?;
                }
            }
            errors += usize::from(!sound);
            slowest = slowest.max(begun.elapsed());
            contacts = contacts.max(env.state().contact.len());
        }
        println!("| {title} | {each} | {errors} | {} | {contacts} |", slowest.as_millis());
    }
    Ok(())
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["steps", n] => steps(n.parse()?),
        ["starts", n] => starts(n.parse()?),
        _ => Err("give `steps N` or `starts N`".into()),
    }
}
