//! What a step, a reset and a construction cost: `cargo bench --bench step [FILTER]`.
//!
//! Every measurement alternates with a fixed piece of work, the product of two dense 64 x 64 matrices, so that the ratio
//! to it can be compared between machines and on busy ones. Figures are medians; the spread is between the quartiles.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use babybench::config::{Behavior, BodyParts, Scene};
use babybench::physics::constraint::{Newton, RowBuilder};
use babybench::physics::contact::Options;
use babybench::physics::dynamics::*;
use babybench::physics::world::{PairTable, Scene as World, Sweep};
use babybench::physics::{State, Topology};
use babybench::{Blueprint, Config, Env, Model};

const EXAMPLES: [(&str, &str); 3] = [
    ("self_touch", include_str!("../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../configs/config_test_installation.yml"),
    ),
];

/// The fixed piece of work.
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

    /// Nanoseconds of one product.
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

/// First quartile, median, third quartile.
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

/// Runs the measurements whose name contains the filter.
struct Bench {
    filter: Option<String>,
    baseline: Baseline,
}

impl Bench {
    fn wants(&self, name: &str) -> bool {
        self.filter.as_ref().is_none_or(|f| name.contains(f.as_str()))
    }

    /// `samples` times `repeat` calls of `work`, alternating with the baseline.
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

/// The parts of a physics step, in their order.
const PARTS: [&str; 10] = [
    "kinematics",
    "inertias",
    "scene in Rapier",
    "contacts",
    "constraint rows",
    "velocities and bias",
    "actuation",
    "Newton solver",
    "internal forces",
    "integration",
];

/// A step of [`SoftEngine`], taken apart.
struct Anatomy {
    model: Arc<Model>,
    topology: Topology,
    pairs: PairTable,
    sweep: Sweep,
    world: World,
    rows: RowBuilder,
    newton: Newton,
    integrator: Integrator,
    bias: BiasScratch,
    bodies: Articulated,
    ns: [f64; PARTS.len()],
}

impl Anatomy {
    fn new(model: Arc<Model>) -> Self {
        let options = Options {
            ccd_tolerance: model.opt.ccd_tolerance,
            ccd_iterations: model.opt.ccd_iterations,
            ..Options::default()
        };
        let pairs = PairTable::new(&model);
        let topology = Topology::new(&model);
        Self {
            sweep: Sweep::new(&model, &pairs, options),
            world: World::new(&model, &pairs, options),
            rows: RowBuilder::new(&model, &topology),
            newton: Newton::default(),
            integrator: Integrator::default(),
            bias: BiasScratch::default(),
            bodies: Articulated::default(),
            ns: [0.0; PARTS.len()],
            pairs,
            topology,
            model,
        }
    }

    fn step(&mut self, s: &mut State) {
        let (m, t) = (&*self.model, &self.topology);
        let mut last = Instant::now();
        let mut part = 0;
        let mut lap = || {
            let now = Instant::now();
            self.ns[part] += (now - last).as_nanos() as f64;
            (part, last) = (part + 1, now);
        };
        kinematics(m, s);
        cameras(m, s);
        com_pos(m, s);
        lap();
        crb(m, t, s);
        self.bodies.update(m, s);
        lap();
        self.world.sync(s);
        lap();
        self.sweep.contacts(m, &self.pairs, s);
        lap();
        self.rows.build(m, t, s);
        lap();
        fwd_velocity(m, s, &mut self.bias);
        lap();
        fwd_actuation(m, &mut self.bodies, s);
        lap();
        self.newton.solve(m, t, s);
        lap();
        rne_post_constraint(m, s, false);
        lap();
        self.integrator.advance(m, &mut self.bodies, s);
        lap();
    }
}

/// Where the time of a physics step goes, over a run with random actions held for ten steps.
fn anatomy(bench: &mut Bench, name: &str, config: &Config) {
    const BATCH: usize = 25;
    const BATCHES: usize = 40;
    if !bench.wants(&format!("parts/{name}")) {
        return;
    }
    let mut env = Env::new(config.clone()).expect("available");
    env.reset(Some(0)).expect("no divergence");
    let (mut whole, mut s) = (env.blueprint().engine(), env.state().clone());
    let mut parts = Anatomy::new(env.model().clone());
    let mut reference = s.clone();
    let mut action = Vec::new();
    let mut samples: Vec<[f64; PARTS.len()]> = Vec::new();
    let (mut base, mut engine, mut size) = (Vec::new(), Vec::new(), [0.0; 3]);
    for batch in 0..BATCHES {
        let mut took = 0.0;
        let before = bench.baseline.time();
        parts.ns.fill(0.0);
        for k in 0..BATCH {
            if k % 10 == 0 {
                env.sample_action(&mut action);
                s.ctrl.iter_mut().zip(&action).for_each(|(c, &a)| *c = f64::from(a));
                reference.ctrl.copy_from_slice(&s.ctrl);
            }
            parts.step(&mut s);
            let start = Instant::now();
            whole.step(&mut reference).expect("no divergence");
            took += start.elapsed().as_nanos() as f64;
            for (sum, n) in size
                .iter_mut()
                .zip([s.contacts.len(), s.efc.nefc(), s.solver_iterations])
            {
                *sum += n as f64;
            }
        }
        assert_eq!(s.qpos, reference.qpos, "the parts make the step");
        if batch > 0 {
            samples.push(parts.ns.map(|ns| ns / BATCH as f64));
            base.push(0.5 * (before + bench.baseline.time()));
            engine.push(took / BATCH as f64);
        }
    }
    let [contacts, rows, iterations] = size.map(|v| v / (BATCHES * BATCH) as f64);
    report(
        &format!("parts/{name}/all, as the engine does it"),
        engine,
        base.clone(),
    );
    for (i, part) in PARTS.iter().enumerate() {
        report(
            &format!("parts/{name}/{part}"),
            samples.iter().map(|s| s[i]).collect(),
            base.clone(),
        );
    }
    println!("parts/{name}: on average {contacts:.1} contacts, {rows:.1} rows, {iterations:.1} Newton iterations");
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
