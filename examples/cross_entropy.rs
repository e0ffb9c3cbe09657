//! A tiny learner of self-touch: the cross-entropy method on slow swings of every joint, scored by how many body parts the
//! hands touch. About a minute on two cores. `cargo run --release --example cross_entropy`, and then
//! `cargo run --release -- report results/cross_entropy`

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use babybench::config::{Config, Scene};
use babybench::env::{Info, NumpyRng, PartNames};
use babybench::eval::{Evaluation, Score, TrainingLog, write_scene};
use babybench::{Blueprint, Env, EnvError};

/// Steps of an episode; generations; policies tried in each; the best of them, which make the next generation.
const STEPS: usize = 1000;
const GENERATIONS: usize = 12;
const POPULATION: usize = 24;
const ELITE: usize = 6;
/// Episodes of the comparison with the random policy.
const TRIALS: usize = 10;
/// Numbers of the policy for each actuator: offset, amplitude, logarithm of the frequency, phase.
const GENES: usize = 4;

/// What a generation is drawn from: mean and spread of every number of the policy.
struct Spread {
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl Spread {
    fn sample(&self, rng: &mut NumpyRng) -> Vec<f64> {
        // twelve uniform numbers make a nearly normal one
        let mut normal = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
        self.mean
            .iter()
            .zip(&self.deviation)
            .map(|(m, d)| m + d * normal())
            .collect()
    }

    /// Moves towards the best, and keeps some spread.
    fn learn(&mut self, best: &[Vec<f64>]) {
        for i in 0..self.mean.len() {
            let n = best.len() as f64;
            let mean = best.iter().map(|p| p[i]).sum::<f64>() / n;
            let variance = best.iter().map(|p| (p[i] - mean).powi(2)).sum::<f64>() / n;
            self.mean[i] += 0.7 * (mean - self.mean[i]);
            self.deviation[i] = (0.3 * self.deviation[i] + 0.7 * variance.sqrt()).max(0.15);
        }
    }
}

/// The information at the end of an episode with a policy; without one, with random actions.
fn episode(env: &mut Env, policy: Option<&[f64]>, seed: u64) -> Result<Info, EnvError> {
    env.reset(Some(seed))?;
    let mut action = Vec::new();
    for step in 0..STEPS {
        match policy {
            None => env.sample_action(&mut action),
            Some(genes) => act(genes, step, &mut action),
        }
        env.step(&action)?;
    }
    Ok(env.info().clone())
}

/// The action of a policy.
fn act(genes: &[f64], step: usize, action: &mut Vec<f32>) {
    let seconds = step as f64 * 0.005;
    let swing = |g: &[f64]| (std::f64::consts::TAU * 0.5 * g[2].exp() * seconds + 3.0 * g[3]).sin();
    action.clear();
    action.extend(
        genes
            .chunks_exact(GENES)
            .map(|g| (0.3 * g[0] + 0.6 * g[1] * swing(g)) as f32),
    );
}

fn parts(info: &Info) -> usize {
    info.behavior
        .touches()
        .map_or(0, |[right, left]| right.len() + left.len())
}

/// Runs an episode for each policy, on all cores.
fn run(blueprint: &Blueprint, policies: &[Option<Vec<f64>>], seed: u64) -> Result<Vec<Info>, EnvError> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(vec![Info::default(); policies.len()]));
    let work = || -> Result<(), EnvError> {
        let mut env = blueprint.env()?;
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(policy) = policies.get(k) else { return Ok(()) };
            let info = episode(&mut env, policy.as_deref(), seed + k as u64)?;
            done.lock().unwrap_or_else(|e| e.into_inner())[k] = info;
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        threads
            .into_iter()
            .try_for_each(|t| t.join().unwrap_or_else(|e| std::panic::resume_unwind(e)))
    })?;
    Ok(done.into_inner().unwrap_or_else(|e| e.into_inner()))
}

/// The score of episodes, as of a training log (whose first record never counts).
fn score(infos: Vec<Info>) -> Result<f64, Box<dyn std::error::Error>> {
    let log: Vec<Info> = infos.first().cloned().into_iter().chain(infos).collect();
    Ok(Score::new(&log)?.value)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../configs/config_selftouch.yml");
    let blueprint = Blueprint::new(Config {
        scene: Scene::Crib,
        touch_active: false, // the contacts are counted, not felt
        save_dir: "results/cross_entropy".to_string(),
        ..Config::from_yaml(text, "config_selftouch.yml")?
    })?;
    write_scene(blueprint.config(), blueprint.config().save_dir.as_ref())?;
    let mut log = TrainingLog::create(blueprint.config())?.with_names(Some(PartNames::new(blueprint.model())));
    let genes = GENES * blueprint.env()?.action_space().len();
    let mut rng = NumpyRng::seed(0);
    let mut spread = Spread {
        mean: vec![0.0; genes],
        deviation: vec![1.0; genes],
    };
    let random = score(run(&blueprint, &vec![None; TRIALS], 1000)?)?;
    println!("random policy: score {random:.3} over {TRIALS} episodes");
    for generation in 0..GENERATIONS {
        let policies: Vec<_> = (0..POPULATION).map(|_| Some(spread.sample(&mut rng))).collect();
        let infos = run(&blueprint, &policies, (generation * POPULATION) as u64)?;
        for info in &infos {
            log.end_episode(info.steps, &info.behavior)?;
        }
        log.save()?;
        let mut order: Vec<usize> = (0..POPULATION).collect();
        order.sort_by_key(|&k| std::cmp::Reverse(parts(&infos[k])));
        let best: Vec<Vec<f64>> = order[..ELITE].iter().filter_map(|&k| policies[k].clone()).collect();
        spread.learn(&best);
        let mean = infos.iter().map(parts).sum::<usize>() as f64 / POPULATION as f64;
        println!(
            "generation {generation:2}: {mean:.1} parts per episode, best {}",
            parts(&infos[order[0]])
        );
    }
    let policies: Vec<_> = (0..TRIALS).map(|_| Some(spread.sample(&mut rng))).collect();
    let learned = score(run(&blueprint, &policies, 1000)?)?;
    println!(
        "learned policy: score {learned:.3} over {TRIALS} episodes, {:.1} times the random one's",
        learned / random
    );
    evaluate(&blueprint, &spread.mean)
}

/// An evaluation episode of the learned policy. `Evaluation::new(&env).with_video(&env)?` would also make a video.
fn evaluate(blueprint: &Blueprint, genes: &[f64]) -> Result<(), Box<dyn std::error::Error>> {
    let mut env = blueprint.env()?;
    let (mut evaluation, mut action) = (Evaluation::new(&env), Vec::new());
    env.reset(Some(0))?;
    for step in 0..STEPS {
        act(genes, step, &mut action);
        env.step(&action)?;
        evaluation.eval_step(&env)?;
    }
    println!("{}", evaluation.end(0)?.display());
    Ok(())
}
