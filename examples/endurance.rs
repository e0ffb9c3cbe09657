//! Long runs and absurd starts, to show what the simulation withstands. Prints Markdown tables.
//!
//! ```sh
//! cargo run --release --features rapier --example endurance -- steps 10000000   # over scenes, bodies, actuation models and engines
//! cargo run --release --features rapier --example endurance -- starts 50000     # interpenetration, 10^6 rad/s and more
//! cargo run --release --features rapier --example endurance -- steps 10000000 'crib | v2'   # the rows that begin with this
//! ```
//!
//! A step leaves finite numbers or returns an error of its type; a twin that is restored from a snapshot continues with the same bits;
//! memory does not grow; no start takes long, and after each the environment starts as before. Anything else ends the program. One step in
//! a hundred has touch and eyes. One step in two hundred, and one start in ten, uses the Rapier engine, which is slow.
//! Times are CPU time on Linux.

use std::error::Error;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use babybench::config::{ActuationModel, Behavior, BodyParts, EngineKind, Scene};
use babybench::env::Snapshot;
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Config, Env, Observation};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Steps between two snapshots.
const TWIN_EVERY: u64 = 1000;
/// Steps that a twin takes.
const TWIN_FOR: u64 = 10;
/// Steps for which the kind of action is kept.
const KIND_FOR: u64 = 250;
/// Steps from one with touch and eyes to the next.
const SENSES_SHARE: u64 = 100;
/// Steps, or starts, from one of the Rapier engine to the next.
const RAPIER_STEPS: u64 = 200;
const RAPIER_STARTS: u64 = 10;
/// Absurd starts between two sensible ones.
const SENSE_EVERY: u64 = 100;
/// Greatest growth of memory in one row, kB.
const GROWTH: u64 = 8192;
/// Longest time that a start with its steps may take.
const PATIENCE: Duration = Duration::from_secs(2);

/// A number from 0 to `n` - 1.
fn below(rng: &mut NumpyRng, n: usize) -> usize {
    (rng.uniform() * n as f64) as usize
}

/// Everything that moves: without touch and eyes on each engine, and with them on the soft one.
fn configurations() -> Vec<Config> {
    let mut out = Vec::new();
    for (engine, senses) in [
        (EngineKind::Soft, false),
        (EngineKind::Soft, true),
        (EngineKind::Rapier, false),
    ] {
        for scene in Scene::BABYBENCH {
            for behavior in [Behavior::SelfTouch, Behavior::HandRegard] {
                for &actuation_model in ActuationModel::ALL {
                    out.push(Config {
                        scene: scene.clone(),
                        behavior,
                        actuation_model,
                        engine,
                        vision_active: senses,
                        touch_active: senses,
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
    let senses = if config.touch_active {
        "all senses"
    } else {
        "joints, balance"
    };
    format!(
        "{} | {body} | {} | {} | {senses}",
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

/// Checks that state and senses are finite.
fn check(env: &Env) -> Result<()> {
    let (seen, state) = (env.observation(), env.state());
    let balance = seen.vestibular.unwrap_or_default();
    let mut numbers = [seen.proprioception, balance, &state.qpos, &state.qvel]
        .into_iter()
        .flatten();
    let mut felt = seen.touch.unwrap_or_default().iter();
    if numbers.all(|v| v.is_finite()) && felt.all(|v| v.is_finite()) {
        Ok(())
    } else {
        Err(format!("{}: a number is not finite", name(env.config())).into())
    }
}

/// The bits of all senses.
fn bits(seen: &Observation) -> Vec<u64> {
    let numbers = seen.proprioception.iter().chain(seen.vestibular.unwrap_or_default());
    let touch = seen.touch.unwrap_or_default().iter();
    let eyes = [seen.eye_left, seen.eye_right].into_iter().flatten().flatten();
    let mut out: Vec<u64> = numbers.map(|v| v.to_bits()).collect();
    out.extend(touch.map(|v| u64::from(v.to_bits())));
    out.extend(eyes.map(|&v| u64::from(v)));
    out
}

/// Memory of the process, kB; 0 off Linux.
fn memory() -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|rest| rest.split_whitespace().next()?.parse().ok())
        .unwrap_or(0)
}

/// CPU time of this thread; off Linux the time since the first call.
fn time() -> Duration {
    static FIRST: LazyLock<Instant> = LazyLock::new(Instant::now);
    let first = *FIRST;
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let on_cpu = text.split_whitespace().next().and_then(|ns| ns.parse().ok());
    on_cpu.map_or_else(|| first.elapsed(), Duration::from_nanos)
}

/// Repeats the environment's step with its twin.
fn compare(env: &Env, made: &std::result::Result<Vec<u64>, String>, twin: &mut Env, action: &[f32]) -> Result<()> {
    if step(twin, action) == *made {
        Ok(())
    } else {
        Err(format!("{}: the twin differs", name(env.config())).into())
    }
}

/// The bits that a step leaves, or its error.
fn step(env: &mut Env, action: &[f32]) -> std::result::Result<Vec<u64>, String> {
    match env.step(action) {
        Ok(step) => Ok(bits(&step.observation)),
        Err(e) => Err(e.to_string()),
    }
}

/// Returns the number of errors.
fn endure(config: Config, steps: u64, seed: u64) -> Result<u64> {
    let (title, blueprint) = (name(&config), Blueprint::new(config)?);
    let (mut env, mut twin) = (blueprint.env()?, blueprint.env()?);
    let (low, high) = (env.action_space().low().to_vec(), env.action_space().high().to_vec());
    let mut rng = NumpyRng::seed(seed);
    let mut action = vec![0.0; low.len()];
    let (mut errors, mut twins, mut fastest, mut kind, mut early) = (0, 0, 0.0_f64, 0, 0);
    let mut beside = false; // the twin runs beside it
    env.reset(Some(seed))?;
    twin.reset(Some(seed + 1))?;
    for k in 0..steps {
        if k == steps / 10 {
            early = memory();
        }
        if k % KIND_FOR == 0 {
            kind = below(&mut rng, 5);
        }
        act(&mut rng, kind, k, [&low, &high], &mut action);
        if k % TWIN_EVERY == 0 {
            twin.restore(&Snapshot::from_bytes(env.snapshot().as_bytes().to_vec())?)?;
            (twins, beside) = (twins + 1, true);
        }
        beside = beside && k % TWIN_EVERY < TWIN_FOR;
        let good = if beside {
            let made = step(&mut env, &action);
            compare(&env, &made, &mut twin, &action)?;
            made.is_ok()
        } else {
            env.step(&action).is_ok()
        };
        if !good {
            (errors, beside) = (errors + 1, false);
            env.reset(None)?;
        }
        check(&env)?;
        fastest = env.state().qvel.iter().fold(fastest, |m, v| m.max(v.abs()));
    }
    let late = memory();
    println!("| {title} | {steps} | {errors} | {twins} | {fastest:.0} | {early} | {late} |");
    if late.saturating_sub(early) > GROWTH {
        Err(format!("{title}: memory grew from {early} to {late} kB").into())
    } else {
        Ok(errors)
    }
}

fn steps(all: u64, only: &str) -> Result<()> {
    println!(
        "| scene | body | actuation | engine | senses | steps | errors | twins | largest speed, rad/s or m/s | memory after a tenth, kB | at the end, kB |"
    );
    println!("|---|---|---|---|---|--:|--:|--:|--:|--:|--:|");
    let configurations = configurations();
    let kinds = configurations.len() as u64 / 3;
    let (rapier, senses) = (all / RAPIER_STEPS, all / SENSES_SHARE);
    let (mut made, mut errors, mut first) = (0, 0, 0);
    for (config, seed) in configurations.into_iter().zip(0..) {
        if !name(&config).starts_with(only) {
            continue;
        }
        let share = match (config.engine, config.touch_active) {
            (EngineKind::Soft, false) => all.saturating_sub(rapier + senses),
            (EngineKind::Soft, true) => senses,
            _ => rapier,
        };
        let share = share.div_ceil(kinds);
        errors += endure(config, share, seed)?;
        made += share;
        if first == 0 {
            first = memory();
        }
    }
    let (last, minutes) = (memory(), time().as_secs() / 60);
    println!(
        "\n{made} steps, {errors} errors; {first} kB of memory after the first row, {last} kB after the last; {minutes} minutes"
    );
    Ok(())
}

/// Absurd positions and velocities.
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
        3 => qpos.fill(0.0), // everything in one place, quaternions of zero length
        4 => qpos[one] = ODD[below(rng, 7)],
        5 => qvel[one % qvel.len()] = ODD[below(rng, 7)],
        _ => {}
    }
}

/// The outcomes of a series of starts.
#[derive(Default)]
struct Starts {
    number: u64,
    errors: u64,
    slowest: Duration,
    contacts: usize,
}

fn start(config: Config, number: u64, seed: u64) -> Result<Starts> {
    let (title, mut env, mut rng) = (name(&config), Env::new(config)?, NumpyRng::seed(seed));
    let sensible = bits(&env.reset(Some(seed))?);
    let (position, velocity) = (env.state().qpos.clone(), env.state().qvel.clone());
    let ends = vec![1e9; env.action_space().len()];
    let mut found = Starts {
        number,
        ..Starts::default()
    };
    let early = memory();
    for k in 0..number {
        let (mut qpos, mut qvel) = (position.clone(), velocity.clone());
        absurd(&mut rng, &mut qpos, &mut qvel);
        let begun = time();
        let mut sound = env.by_hand().reset_to(&qpos, &qvel).is_ok();
        for _ in 0..5 {
            sound = sound && env.step(&ends).is_ok();
            if sound {
                check(&env)?;
            }
        }
        let took = time().saturating_sub(begun);
        if took > PATIENCE {
            return Err(format!("{title}: start {k} takes {} ms", took.as_millis()).into());
        }
        found.errors += u64::from(!sound);
        found.slowest = found.slowest.max(took);
        found.contacts = found.contacts.max(env.state().contact.len());
        if k % SENSE_EVERY == 0 && bits(&env.reset(Some(seed))?) != sensible {
            return Err(format!("{title}: after start {k} a reset differs").into());
        }
    }
    let (errors, slowest, contacts, late) = (found.errors, found.slowest.as_millis(), found.contacts, memory());
    println!("| {title} | {number} | {errors} | {slowest} | {contacts} | {early} | {late} |");
    Ok(found)
}

fn starts(all: u64, only: &str) -> Result<()> {
    println!(
        "| scene | body | actuation | engine | senses | starts | errors | slowest, ms | most contacts | memory at the start, kB | at the end, kB |"
    );
    println!("|---|---|---|---|---|--:|--:|--:|--:|--:|--:|");
    let configurations: Vec<Config> = configurations().into_iter().filter(|c| !c.touch_active).collect();
    let kinds = configurations.len() as u64 / 2;
    let rapier = all / RAPIER_STARTS;
    let mut sum = [Starts::default(), Starts::default()];
    for (config, seed) in configurations.into_iter().zip(0..) {
        if !name(&config).starts_with(only) {
            continue;
        }
        let is_rapier = config.engine == EngineKind::Rapier;
        let share = if is_rapier { rapier } else { all - rapier };
        let found = start(config, share.div_ceil(kinds), seed)?;
        let sum = &mut sum[usize::from(is_rapier)];
        sum.number += found.number;
        sum.errors += found.errors;
        sum.slowest = sum.slowest.max(found.slowest);
    }
    println!();
    for (engine, found) in EngineKind::ALL.iter().zip(&sum) {
        let (number, errors, slowest) = (found.number, found.errors, found.slowest.as_millis());
        println!("{engine}: {number} starts, {errors} errors, the slowest {slowest} ms");
    }
    println!("{} minutes", time().as_secs() / 60);
    Ok(())
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["steps", n] => steps(n.parse()?, ""),
        ["steps", n, only] => steps(n.parse()?, only),
        ["starts", n] => starts(n.parse()?, ""),
        ["starts", n, only] => starts(n.parse()?, only),
        _ => Err("give `steps N [ROWS]` or `starts N [ROWS]`".into()),
    }
}
