//! Measures the cost of a step, a reset and a construction: `cargo bench --bench step [FILTER]`.
//!
//! Every measurement alternates with a fixed piece of work, the product of two dense 64 x 64 matrices, so that the ratio
//! to it can be compared between machines and on busy ones. Figures are medians; the spread is between the quartiles.

use std::hint::black_box;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use babybench::config::{ActuationModel, AgeSchedule, Behavior, BodyParts, Reflex, ReflexSet, Scene};
use babybench::physics::Stage;
use babybench::{Blueprint, Config, Env};

const EXAMPLES: [(&str, &str); 3] = [
    ("self_touch", include_str!("../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../configs/config_test_installation.yml"),
    ),
];

/// A fixed piece of work, to compare with.
struct Baseline {
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
}

impl Baseline {
    const N: usize = 64;

    fn new() -> Self {
        let matrix = |seed: usize| (0..Self::N * Self::N).map(|i| ((i * seed) % 17) as f64 - 8.0).collect();
        Self {
            a: matrix(3),
            b: matrix(7),
            c: vec![0.0; Self::N * Self::N],
        }
    }

    /// Measures one product, ns.
    fn time(&mut self) -> f64 {
        const REPEAT: usize = 8;
        let start = Instant::now();
        for _ in 0..REPEAT {
            self.c.fill(0.0);
            for (row, a) in self.c.chunks_exact_mut(Self::N).zip(self.a.chunks_exact(Self::N)) {
                for (x, b) in a.iter().zip(self.b.chunks_exact(Self::N)) {
                    row.iter_mut().zip(b).for_each(|(c, b)| *c += x * b);
                }
            }
            black_box(&mut self.c);
        }
        start.elapsed().as_nanos() as f64 / REPEAT as f64
    }
}

/// Returns the first quartile, the median and the third quartile.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|q| values[(values.len() - 1) * q / 4])
}

fn human(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{ns:.0} ns"),
        ns if ns < 1e6 => format!("{:.1} us", ns / 1e3),
        ns => format!("{:.2} ms", ns / 1e6),
    }
}

fn report(name: &str, ns: Vec<f64>, baseline: Vec<f64>) {
    let ratio = quartiles(ns.iter().zip(&baseline).map(|(a, b)| a / b).collect());
    let ns = quartiles(ns);
    println!(
        "{name:52} {:>9}  ({} .. {})   {:8.2} products ({:.2} .. {:.2})",
        human(ns[1]),
        human(ns[0]),
        human(ns[2]),
        ratio[1],
        ratio[0],
        ratio[2]
    );
}

/// The measurements whose name contains the filter.
struct Bench {
    filter: Option<String>,
    baseline: Baseline,
}

impl Bench {
    fn wants(&self, name: &str) -> bool {
        self.filter.as_ref().is_none_or(|f| name.contains(f.as_str()))
    }

    /// Measures `samples` times `repeat` calls of `work`, alternating with the baseline.
    fn run(&mut self, name: &str, samples: usize, repeat: usize, mut work: impl FnMut()) {
        work();
        let (mut ns, mut base) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
        for _ in 0..samples {
            let before = self.baseline.time();
            let start = Instant::now();
            (0..repeat).for_each(|_| work());
            ns.push(start.elapsed().as_nanos() as f64 / repeat as f64);
            base.push(0.5 * (before + self.baseline.time()));
        }
        report(name, ns, base);
    }
}

fn example(text: &str) -> Config {
    Config::from_yaml(text, "example").expect("the examples are valid")
}

fn environment(bench: &mut Bench, name: &str, config: &Config) {
    if bench.wants(&format!("blueprint/{name}")) {
        bench.run(&format!("blueprint/{name}"), 10, 1, || {
            drop(black_box(Blueprint::new(config.clone())))
        });
    }
    let blueprint = Blueprint::new(config.clone()).expect("available");
    if bench.wants(&format!("env/{name}")) {
        bench.run(&format!("env/{name}"), 20, 2, || drop(black_box(blueprint.env())));
    }
    let mut env = blueprint.env().expect("available");
    if bench.wants(&format!("reset/{name}")) {
        bench.run(&format!("reset/{name}"), 20, 2, || {
            black_box(env.reset(Some(1)).expect("no divergence"));
        });
    }
    if bench.wants(&format!("step/{name}")) {
        let mut action = Vec::new();
        env.reset(Some(0)).expect("no divergence");
        bench.run(&format!("step/{name}"), 40, 25, || {
            env.sample_action(&mut action);
            black_box(env.step(&action).expect("no divergence"));
        });
    }
}

/// The time spent in each stage of the physics steps so far, ns.
#[derive(Default)]
struct Stages {
    ns: [f64; Stage::ALL.len()],
    since: Option<(Stage, Instant)>,
}

impl Stages {
    fn enter(&mut self, stage: Option<Stage>) {
        let now = Instant::now();
        if let Some((last, since)) = self.since {
            self.ns[last as usize] += (now - since).as_nanos() as f64;
        }
        self.since = stage.map(|s| (s, now));
    }
}

fn lock(stages: &Mutex<Stages>) -> MutexGuard<'_, Stages> {
    stages.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Prints where the time of a physics step goes, over a run with random actions held for ten steps.
fn anatomy(bench: &mut Bench, name: &str, config: &Config) {
    const BATCH: usize = 25;
    const BATCHES: usize = 40;
    if !bench.wants(&format!("parts/{name}")) {
        return;
    }
    let mut env = Env::new(config.clone()).expect("available");
    env.reset(Some(0)).expect("no divergence");
    let [mut engine, mut probed] = [0, 1].map(|_| env.blueprint().engine());
    let mut s = env.state().clone();
    let mut reference = s.clone();
    let stages = Arc::new(Mutex::new(Stages::default()));
    let probe = stages.clone();
    probed.set_probe(Some(Box::new(move |stage| lock(&probe).enter(stage))));
    let mut action = Vec::new();
    let mut samples: Vec<[f64; Stage::ALL.len()]> = Vec::new();
    let (mut base, mut whole, mut size) = (Vec::new(), Vec::new(), [0.0; 3]);
    for batch in 0..BATCHES {
        let mut took = 0.0;
        let before = bench.baseline.time();
        *lock(&stages) = Stages::default();
        for k in 0..BATCH {
            if k % 10 == 0 {
                env.sample_action(&mut action);
                s.ctrl.iter_mut().zip(&action).for_each(|(c, &a)| *c = f64::from(a));
                reference.ctrl.copy_from_slice(&s.ctrl);
            }
            probed.step(&mut s).expect("no divergence");
            let start = Instant::now();
            engine.step(&mut reference).expect("no divergence");
            took += start.elapsed().as_nanos() as f64;
            for (sum, n) in size.iter_mut().zip([s.contact.len(), s.nefc(), s.solver_iterations]) {
                *sum += n as f64;
            }
        }
        assert_eq!(s.qpos, reference.qpos, "a probe changes nothing");
        if batch > 0 {
            samples.push(lock(&stages).ns.map(|ns| ns / BATCH as f64));
            base.push(0.5 * (before + bench.baseline.time()));
            whole.push(took / BATCH as f64);
        }
    }
    let [contacts, rows, iterations] = size.map(|v| v / (BATCHES * BATCH) as f64);
    report(&format!("parts/{name}/all, without a probe"), whole, base.clone());
    for (i, stage) in Stage::ALL.iter().enumerate() {
        report(
            &format!("parts/{name}/{}", stage.name()),
            samples.iter().map(|s| s[i]).collect(),
            base.clone(),
        );
    }
    println!("parts/{name}: on average {contacts:.1} contacts, {rows:.1} rows, {iterations:.1} Newton iterations");
}

/// Measures resets at which MIMo grows: first to ages that must be compiled, then to the same ages again.
fn growth(bench: &mut Bench, name: &str, config: &Config) {
    if !bench.wants(&format!("growth/{name}")) {
        return;
    }
    // an episode of one step for each age
    let ages: Vec<(u64, f64)> = (0..60).map(|k| (k, 1.0 + 0.25 * (k % 20) as f64)).collect();
    let mut env = Env::new(Config {
        age_schedule: AgeSchedule::new(ages).expect("rising steps"),
        touch_grows: true,
        max_episode_steps: 1,
        ..config.clone()
    })
    .expect("available");
    let action = vec![0.0; env.action_space().len()];
    let (mut took, mut base) = ([Vec::new(), Vec::new()], Vec::new());
    for k in 0..60 {
        let start = Instant::now();
        env.reset(Some(k)).expect("no divergence");
        let ns = start.elapsed().as_nanos() as f64;
        let same = Instant::now();
        env.reset(Some(k)).expect("no divergence");
        // the reset itself is not growth
        took[usize::from(k >= 20)].push(ns - same.elapsed().as_nanos() as f64);
        base.push(bench.baseline.time());
        env.step(&action).expect("no divergence");
    }
    let [first, again] = took;
    report(&format!("growth/{name}/first"), first, base.clone());
    report(&format!("growth/{name}/again"), again, base);
}

/// Measures what all reflexes add to a step. Their gain is so small that both environments move in the same way.
fn reflexes(bench: &mut Bench, model: ActuationModel) {
    const STEPS: usize = 20;
    let name = format!("reflexes/{model}");
    if !bench.wants(&name) {
        return;
    }
    let mut config = Config {
        behavior: Behavior::SelfTouch,
        age: Some(1.0),
        actuation_model: model,
        vision_active: false,
        touch_active: false,
        ..Config::default()
    };
    let without = Env::new(config.clone()).expect("available");
    config.reflexes.set = ReflexSet::new(Reflex::ALL.iter().copied());
    config.reflexes.gain = 1e-9;
    let mut envs = [without, Env::new(config).expect("available")];
    let (mut action, mut added, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for sample in 0..300 {
        if sample % 10 == 0 {
            for env in &mut envs {
                env.reset(Some(sample)).expect("no divergence");
            }
        }
        envs[0].sample_action(&mut action);
        let mut took = [0.0; 2];
        // in turn, so that neither is always the first
        for which in [sample as usize % 2, 1 - sample as usize % 2] {
            let start = Instant::now();
            for _ in 0..STEPS {
                black_box(envs[which].step(&action).expect("no divergence"));
            }
            took[which] = start.elapsed().as_nanos() as f64 / STEPS as f64;
        }
        added.push(took[1] - took[0]);
        ratios.push(took[1] / took[0]);
    }
    let ([low, mid, high], ratio) = (quartiles(added).map(human), quartiles(ratios));
    println!(
        "{name:52} {mid:>9}  ({low} .. {high})   {:8.3} steps without ({:.3} .. {:.3})",
        ratio[1], ratio[0], ratio[2]
    );
}

fn main() {
    // cargo passes --bench
    let filter = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let mut bench = Bench {
        filter,
        baseline: Baseline::new(),
    };
    let product = quartiles((0..200).map(|_| bench.baseline.time()).collect());
    println!(
        "one product takes {} ({} .. {})\n",
        human(product[1]),
        human(product[0]),
        human(product[2])
    );
    for (name, text) in EXAMPLES {
        let config = example(text);
        environment(&mut bench, name, &config);
        anatomy(&mut bench, name, &config);
        growth(&mut bench, name, &config);
    }
    for &model in ActuationModel::ALL {
        reflexes(&mut bench, model);
    }
    // everything moves: the most expensive scene
    let config = Config {
        behavior: Behavior::HandRegard,
        scene: Scene::Cubes,
        act: BodyParts::all(true),
        lock: BodyParts::all(false),
        vision_active: false,
        touch_active: false,
        ..Config::default()
    };
    anatomy(&mut bench, "cubes, all free", &config);
}
