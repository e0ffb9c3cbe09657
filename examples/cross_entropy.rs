//! Learns self-touch with the cross-entropy method: every joint swings slowly, and the swings that touch the most body parts
//! survive. Takes about a minute on two cores.
//!
//! ```sh
//! cargo run --release --example cross_entropy
//! cargo run --release -- report results/cross_entropy   # shows the training as a page
//! ```

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use babybench::config::{Compat, Scene};
use babybench::env::PartNames;
use babybench::eval::{Evaluation, Score};
use babybench::runs::{TrainingLog, write_scene};
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Config, Env, EnvError, Info};

/// Steps of an episode.
const STEPS: usize = 1000;
/// Number of generations.
const GENERATIONS: usize = 12;
/// Number of policies tried in each generation.
const POPULATION: usize = 24;
/// Number of the best of them, from which the next generation is drawn.
const ELITE: usize = 6;
/// Episodes of the comparison with the random policy.
const TRIALS: usize = 10;
/// Number of parameters of the policy for each actuator: offset, amplitude, logarithm of the frequency, phase.
const GENES: usize = 4;

/// The distribution that a generation is drawn from: mean and standard deviation of every parameter.
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

    /// Moves towards the best policies, and keeps some spread.
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

/// Runs an episode with a policy, or with random actions without one, and returns the information at its end.
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

/// Computes the action of a policy.
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

/// Scores episodes as a training log is scored (its first record never counts).
fn score(infos: Vec<Info>) -> Result<f64, Box<dyn std::error::Error>> {
    let log: Vec<Info> = infos.first().cloned().into_iter().chain(infos).collect();
    Ok(Score::new(&log, Compat::Api)?.value)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../configs/config_selftouch.yml");
    let blueprint = Blueprint::new(Config {
        scene: Scene::Crib,
        touch_active: false, // contacts are counted from the physics; the skin is not needed
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

/// Runs an evaluation episode of the learned policy. `Evaluation::new(&env).with_video(&env)?` would also make a video.
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
