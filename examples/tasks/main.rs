//! Learns MIMo's tasks with goals by evolution: policies whose actions are linear in what he senses, written as ONNX models.
//!
//! ```sh
//! cargo run --release --features onnx,npz --example tasks -- reach --seed 0    # policies/reach.onnx and its curve
//! cargo run --release --features onnx,npz --example tasks -- report            # policies/README.md, with returns and curves
//! ```

mod episodes;
mod evolution;
mod linear;
mod model;
mod plans;
mod report;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use babybench::Blueprint;
use babybench::config::Behavior;
use babybench::spaces::NumpyRng;
use episodes::{Arena, Episode};
use evolution::Evolution;
use plans::{Plan, Stage};

type Error = Box<dyn std::error::Error>;

struct Arguments {
    /// The task to be learned; none for the report.
    behavior: Option<Behavior>,
    seed: u64,
    threads: usize,
    age: Option<f64>,
    out: PathBuf,
}

impl Arguments {
    fn read() -> Result<Self, Error> {
        let mut words = std::env::args().skip(1);
        let what = words
            .next()
            .ok_or("name a task: reach, selfbody, standup, roll_over or catch; or report")?;
        let behavior = Behavior::from_name(&what);
        if behavior.is_none() && what != "report" {
            return Err(format!("{what} is neither a task nor report").into());
        }
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
        let mut found = Self {
            behavior,
            seed: 0,
            threads: cores,
            age: None,
            out: PathBuf::from("policies"),
        };
        while let Some(word) = words.next() {
            let value = words.next().ok_or_else(|| format!("{word} needs a value"))?;
            match word.as_str() {
                "--seed" => found.seed = value.parse()?,
                "--threads" => found.threads = value.parse()?,
                "--age" => found.age = Some(value.parse()?),
                "--out" => found.out = value.into(),
                _ => return Err(format!("{word} is not one of --seed, --threads, --age, --out").into()),
            }
        }
        Ok(found)
    }
}

/// The result of a generation.
struct Record {
    stage: usize,
    steps: u64,
    /// Mean return of the candidates, and that of the mean of the distribution.
    candidates: f64,
    policy: f64,
    success: bool,
}

fn main() -> Result<(), Error> {
    let arguments = Arguments::read()?;
    let Some(behavior) = arguments.behavior else {
        return report::write(&arguments.out);
    };
    let blueprint = Blueprint::new(plans::config(behavior, arguments.age))?;
    let mut arena = Arena::new(&blueprint, arguments.threads)?;
    let plan = Plan::of(behavior, arena.env())?;
    let (mut weights, mut records) = (plan.start.clone(), Vec::new());
    let mut rng = NumpyRng::seed(arguments.seed);
    for number in 0..plan.stages.len() {
        train(&mut arena, &plan, number, &mut weights, &mut rng, &mut records)?;
    }
    save(
        &arguments.out,
        &name(&arguments, behavior),
        &mut arena,
        &plan,
        &weights,
        &records,
    )
}

/// Trains a stage, and stores the learned weights in `weights`.
fn train(
    arena: &mut Arena,
    plan: &Plan,
    number: usize,
    weights: &mut [f64],
    rng: &mut NumpyRng,
    records: &mut Vec<Record>,
) -> Result<(), Error> {
    let stage: &Stage = &plan.stages[number];
    let start: Vec<f64> = stage.free.iter().map(|&k| weights[k]).collect();
    let mut evolution = Evolution::new(start, stage.spread, stage.size);
    let mut steps = records.last().map_or(0, |record| record.steps);
    for generation in 0..stage.generations {
        let candidates = evolution.draw(rng);
        let whole = |free: &Vec<f64>| {
            let mut all = weights.to_vec();
            stage.free.iter().zip(free).for_each(|(&k, &v)| all[k] = v);
            all
        };
        let mut all: Vec<Vec<f64>> = candidates.iter().map(whole).collect();
        all.push(whole(&evolution.mean));
        // all candidates of a generation are tried in the same episodes
        let seeds: Vec<u64> = (0..stage.trials).map(|_| 10_000 + rng.below(1 << 30) as u64).collect();
        let episodes: Vec<Episode<'_>> = all
            .iter()
            .flat_map(|weights| seeds.iter().map(move |&seed| (weights, seed)))
            .map(|(weights, seed)| Episode {
                weights,
                seed,
                goal: stage.goal,
            })
            .collect();
        let outcomes = arena.run(plan, &episodes)?;
        let mean = |of: &[episodes::Outcome], value: fn(&episodes::Outcome) -> f64| -> f64 {
            of.iter().map(value).sum::<f64>() / of.len().max(1) as f64
        };
        let trials: Vec<_> = outcomes.chunks(stage.trials).collect();
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        order.sort_by(|&a, &b| mean(trials[b], |o| o.worth).total_cmp(&mean(trials[a], |o| o.worth)));
        evolution.learn(&order.iter().map(|&k| &candidates[k]).collect::<Vec<_>>());
        steps += outcomes.iter().map(|o| o.steps).sum::<u64>();
        let policy = trials[candidates.len()];
        records.push(Record {
            stage: number,
            steps,
            candidates: mean(&outcomes[..candidates.len() * stage.trials], |o| o.reward),
            policy: mean(policy, |o| o.reward),
            success: policy.iter().all(|o| o.success),
        });
        let record = &records[records.len() - 1];
        println!(
            "stage {number} generation {generation:3} steps {steps:9}: candidates {:9.2}, policy {:9.2}{}",
            record.candidates,
            record.policy,
            if record.success { ", success" } else { "" }
        );
    }
    for (&k, &v) in stage.free.iter().zip(&evolution.mean) {
        weights[k] = v;
    }
    Ok(())
}

/// Returns the name of a policy's files.
fn name(arguments: &Arguments, behavior: Behavior) -> String {
    let age = arguments.age.map_or_else(String::new, |age| format!("_{age}"));
    format!("{behavior}{age}")
}

fn save(
    folder: &Path,
    name: &str,
    arena: &mut Arena,
    plan: &Plan,
    weights: &[f64],
    records: &[Record],
) -> Result<(), Error> {
    std::fs::create_dir_all(folder)?;
    let env = arena.env();
    env.reset(Some(0))?;
    let bytes = plan
        .design
        .to_onnx(weights, &env.observation(), env.action_space().len());
    let path = folder.join(format!("{name}.onnx"));
    std::fs::write(&path, &bytes)?;
    println!("{}: {} bytes", path.display(), bytes.len());
    let mut table = String::from("stage,steps,candidates,policy\n");
    for r in records {
        writeln!(table, "{},{},{:.3},{:.3}", r.stage, r.steps, r.candidates, r.policy)?;
    }
    std::fs::write(folder.join(format!("{name}.csv")), table)?;
    Ok(())
}
