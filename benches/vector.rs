//! The cost of many environments: `cargo bench --features parallel --bench vector [FILTER]`.
//!
//! - `threads`: two threads against one, and one against a plain loop over environments, in pairs that alternate: the same
//!   environments, seeds and actions. Figures are medians of the ratios of pairs; the spread is between the quartiles.
//!   Threads are compared by the clock, which needs a machine that does nothing else, and by the time that all processors
//!   spend; loops by the latter.
//! - `crowd`: a step in a vector of many environments against the same steps in one environment alone, one thread, by processor time:
//!   what it costs that environments take turns in the caches.
//! - `rates`: an environment whose eyes see 30 pictures a second, and one whose eyes are requested in every tenth step, against one that draws in
//!   every step, by processor time.
//! - `nodes`: 64 nodes of a search, each a state that continues from the same one for a step, in a `physics::Batch` of one thread against one
//!   engine and a state that is copied, stepped and copied again, by processor time.
//! - `eyes`: one environment whose eyes two threads draw (`vision_threads: 2`) against one that draws them alone, by the clock.
//! - `memory`: how long 4,096 environments take to make, what they keep resident after some steps, and what a further one takes of
//!   the allocator; each in a process of its own, in which no memory is there from before.

#[path = "../tests/common/allocations.rs"]
mod allocations;
#[path = "vector/measure.rs"]
mod measure;

use std::hint::black_box;

use babybench::physics::{Batch, Engine, SoftEngine, SoftOptions, State};
use babybench::spaces::NumpyRng;
use babybench::{AutoresetMode, Blueprint, Config, Env, Observation, VectorEnv, VectorOptions};
use measure::{cpu_time, pair, process_time, quartiles, resident_memory, wall_time};

const EXAMPLES: [(&str, &str); 3] = [
    ("self_touch", include_str!("../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../configs/config_test_installation.yml"),
    ),
];

/// Environments of a vector.
const ENVS: usize = 64;
/// Environments whose memory is measured, and their steps before that.
const HERD: usize = 4096;
const HERD_STEPS: usize = 10;
/// Pairs of measurements, and steps of a vector in each half.
const PAIRS: usize = 25;
const STEPS: usize = 8;

fn vector(blueprint: &Blueprint, threads: usize) -> VectorEnv {
    vector_of(ENVS, blueprint, threads)
}

fn vector_of(n: usize, blueprint: &Blueprint, threads: usize) -> VectorEnv {
    let options = VectorOptions {
        threads,
        autoreset: AutoresetMode::NextStep,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(blueprint, n, options).expect("available");
    envs.reset(0).expect("no divergence");
    envs
}

/// A plain loop over environments, as programs would write it.
fn plain(blueprint: &Blueprint) -> Vec<Env> {
    let make = |seed: usize| {
        let mut env = blueprint.env().expect("available");
        env.reset(Some(seed as u64)).expect("no divergence");
        env
    };
    (0..ENVS).map(make).collect()
}

/// Arrays in which a plain loop collects the observations of environments.
#[derive(Default)]
struct Arrays {
    proprioception: Vec<f64>,
    touch: Vec<f32>,
    eyes: [Vec<u8>; 2],
    vestibular: Vec<f64>,
}

impl Arrays {
    fn collect(&mut self, row: usize, o: &Observation<'_>) {
        fn put<T: Copy + Default>(all: &mut Vec<T>, row: usize, values: Option<&[T]>) {
            let values = values.unwrap_or_default();
            all.resize(ENVS * values.len(), T::default());
            all[row * values.len()..(row + 1) * values.len()].copy_from_slice(values);
        }
        put(&mut self.proprioception, row, Some(o.proprioception));
        put(&mut self.touch, row, o.touch);
        put(&mut self.eyes[0], row, o.eye_left);
        put(&mut self.eyes[1], row, o.eye_right);
        put(&mut self.vestibular, row, o.vestibular);
    }
}

fn step_plain(envs: &mut [Env], actions: &[f32], over: &mut [bool], mut arrays: Option<&mut Arrays>) {
    let len = actions.len() / ENVS;
    for (k, (env, action)) in envs.iter_mut().zip(actions.chunks_exact(len)).enumerate() {
        if over[k] {
            black_box(env.reset(None).expect("no divergence"));
            over[k] = false;
        } else {
            over[k] = black_box(env.step(action).expect("no divergence")).truncated;
        }
        if let Some(arrays) = &mut arrays {
            arrays.collect(k, &env.observation());
        }
    }
}

fn threads(name: &str, blueprint: &Blueprint) {
    let [mut one, mut two, mut alone] = [1, 2, 1].map(|threads| vector(blueprint, threads));
    let actions: Vec<Vec<f32>> = (0..PAIRS * STEPS)
        .map(|_| {
            let mut actions = Vec::new();
            one.sample_actions(&mut actions).expect("all are here");
            actions
        })
        .collect();
    let mut two_again = vector(blueprint, 2);
    let (mut envs, mut over) = (plain(blueprint), vec![false; ENVS]);
    let run = |envs: &mut VectorEnv, actions: &[f32]| {
        black_box(envs.step(actions).expect("valid actions"));
    };
    pair(
        &format!("threads/{name}/{} threads over 1", two.threads()),
        [STEPS, ENVS],
        wall_time,
        &actions,
        |a| run(&mut one, a),
        |a| run(&mut two, a),
    );
    pair(
        &format!("threads/{name}/processor time, {} threads over 1", two.threads()),
        [STEPS, ENVS],
        process_time,
        &actions,
        |a| run(&mut one, a),
        |a| run(&mut two, a),
    );
    let mut arrays = Arrays::default();
    pair(
        &format!("threads/{name}/1 thread over a loop that collects"),
        [STEPS, ENVS],
        cpu_time,
        &actions,
        |a| step_plain(&mut envs, a, &mut over, Some(&mut arrays)),
        |a| run(&mut alone, a),
    );
    pair(
        &format!("threads/{name}/1 thread over a loop that does not collect"),
        [STEPS, ENVS],
        cpu_time,
        &actions,
        |a| step_plain(&mut envs, a, &mut over, None),
        |a| run(&mut alone, a),
    );
    // send and recv, half of the environments at a time
    let (ids, len) = ((0..ENVS).collect::<Vec<_>>(), two_again.single_action_space().len());
    let mut one_again = vector(blueprint, 1);
    let first = &actions[0];
    two_again.send(first, &ids).expect("all are here");
    one_again.send(first, &ids).expect("all are here");
    let mut halves = halves_of(len);
    let mut halves_too = halves_of(len);
    pair(
        &format!("threads/{name}/send and recv: {} threads over 1", two_again.threads()),
        [STEPS, ENVS],
        wall_time,
        &actions,
        |a| halves(&mut one_again, a),
        |a| halves_too(&mut two_again, a),
    );
}

/// Numbers of environments in the vectors whose steps are compared with those of a single environment.
const CROWDS: [usize; 3] = [8, 64, 512];
/// Runs of each, in turn, and steps of a run.
const COURSES: usize = 7;
const COURSE: usize = 25;

/// Both do the same work: the single environment takes the steps of all environments of the vector, one after the other.
fn crowd(name: &str, blueprint: &Blueprint) {
    for n in CROWDS {
        let mut many = vector_of(n, blueprint, 1);
        let mut one = blueprint.env().expect("available");
        let len = one.action_space().len();
        let courses = COURSES * 64 / n.min(64);
        let (mut ratios, mut us) = (Vec::new(), [Vec::new(), Vec::new()]);
        for course in 0..courses as u64 {
            many.reset(course).expect("no divergence");
            let actions = |_| {
                let mut actions = Vec::new();
                many.sample_actions(&mut actions).expect("all are here");
                actions
            };
            let actions: Vec<Vec<f32>> = (0..COURSE).map(actions).collect();
            many.reset(course).expect("no divergence");
            let start = cpu_time();
            for actions in &actions {
                black_box(many.step(actions).expect("valid actions"));
            }
            let together = cpu_time() - start;
            let mut alone = 0.0;
            for env in 0..n {
                one.reset(Some(course + env as u64)).expect("no divergence");
                let start = cpu_time();
                for actions in &actions {
                    black_box(one.step(&actions[env * len..(env + 1) * len]).expect("no divergence"));
                }
                alone += cpu_time() - start;
            }
            ratios.push(together / alone);
            us.iter_mut()
                .zip([together, alone])
                .for_each(|(us, t)| us.push(t * 1e6 / (COURSE * n) as f64));
        }
        let [low, median, high] = quartiles(ratios);
        let [together, alone] = us.map(|us| quartiles(us)[1]);
        let what = format!("crowd/{name}, {n} environments over one");
        println!("{what:60} {median:.3} times ({low:.3} .. {high:.3}); {together:8.1} and {alone:8.1} us per step");
    }
}

/// Steps of one environment in each half of a pair.
const EYE_STEPS: usize = 64;

fn eyes(name: &str, blueprint: &Blueprint) {
    let [mut one, mut two] = [1, 2].map(|threads| {
        let mut env = blueprint.env().expect("available");
        env.senses_mut().set_vision_threads(threads);
        env.reset(Some(0)).expect("no divergence");
        env
    });
    let actions = |_| {
        let mut actions = Vec::new();
        one.sample_action(&mut actions);
        actions
    };
    let actions: Vec<Vec<f32>> = (0..PAIRS * EYE_STEPS).map(actions).collect();
    let run = |env: &mut Env, action: &[f32]| {
        if black_box(env.step(action).expect("no divergence")).truncated {
            env.reset(None).expect("no divergence");
        }
    };
    pair(
        &format!("eyes/{name}, {} threads over 1", two.senses().vision_threads()),
        [EYE_STEPS, 1],
        wall_time,
        &actions,
        |a| run(&mut one, a),
        |a| run(&mut two, a),
    );
}

/// The controls of both are the same.
fn nodes(name: &str, blueprint: &Blueprint) {
    let mut env = blueprint.env().expect("available");
    env.reset(Some(0)).expect("no divergence");
    let (model, from) = (blueprint.model().clone(), env.state().clone());
    let mut batch = Batch::new(model.clone(), SoftOptions::default(), ENVS);
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut kept: Vec<_> = (0..ENVS).map(|_| engine.new_state()).collect();
    let mut state = engine.new_state();
    let mut random = NumpyRng::seed(0);
    let controls = |_| (0..model.nu() * ENVS).map(|_| random.uniform() as f32 - 0.5).collect();
    let controls: Vec<Vec<f32>> = (0..PAIRS * STEPS).map(controls).collect();
    let nu = model.nu();
    let set = |ctrl: &mut [f64], of: &[f32]| ctrl.iter_mut().zip(of).for_each(|(c, &v)| *c = f64::from(v));
    pair(
        &format!("nodes/{name}, a batch of {ENVS} over one by one"),
        [STEPS, ENVS],
        cpu_time,
        &controls,
        |controls| {
            for (kept, controls) in kept.iter_mut().zip(controls.chunks_exact(nu)) {
                state.copy_dynamic_from(&from);
                set(&mut state.ctrl, controls);
                engine.step(&mut state).expect("no divergence");
                kept.copy_dynamic_from(&state);
            }
        },
        |controls| {
            batch.fork(&from);
            let control = |k: usize, _, state: &mut State| set(&mut state.ctrl, &controls[k * nu..][..nu]);
            batch.rollout(1, control).expect("no divergence");
        },
    );
}

/// Eyes with a lower rate, or drawn on request in every tenth step, compared with eyes drawn in each step.
fn rates(name: &str, config: &Config) {
    let rated = Config {
        vision_rate: Some(30.0),
        ..config.clone()
    };
    let lazy = Config {
        vision_lazy: true,
        ..config.clone()
    };
    less(&format!("rates/{name}, 30 Hz over every step"), config, rated);
    less(
        &format!("rates/{name}, one of ten asked for over every step"),
        config,
        lazy,
    );
}

/// Both take the same steps; the actions do not depend on the pictures.
fn less(what: &str, config: &Config, other: Config) {
    let [mut every, mut some] = [config.clone(), other].map(|config| {
        let mut env = Env::new(config).expect("available");
        env.reset(Some(0)).expect("no divergence");
        env
    });
    let actions = |_| {
        let mut actions = Vec::new();
        every.sample_action(&mut actions);
        actions
    };
    let actions: Vec<Vec<f32>> = (0..PAIRS * EYE_STEPS).map(actions).collect();
    let run = |env: &mut Env, action: &[f32]| {
        let step = env.step(action).expect("no divergence");
        let (truncated, looks) = (step.truncated, step.info.steps.is_multiple_of(10));
        if looks {
            // draws where that waits, and nothing otherwise
            black_box(env.senses_mut().look().expect("a renderer"));
        }
        if truncated {
            env.reset(Some(0)).expect("no divergence");
        }
    };
    pair(
        what,
        [EYE_STEPS, 1],
        cpu_time,
        &actions,
        |a| run(&mut every, a),
        |a| run(&mut some, a),
    );
}

/// Receives and sends half of the environments, twice.
fn halves_of(len: usize) -> impl FnMut(&mut VectorEnv, &[f32]) {
    let (mut next, mut turn) = (Vec::with_capacity(ENVS), Vec::with_capacity(ENVS * len));
    move |envs, actions| {
        for _ in 0..2 {
            next.clear();
            next.extend_from_slice(envs.recv(ENVS / 2).expect("enough are in flight").ids);
            turn.clear();
            for &env in &next {
                turn.extend_from_slice(&actions[env * len..(env + 1) * len]);
            }
            envs.send(&turn, &next).expect("they are here");
        }
    }
}

fn memory(name: &str, blueprint: &Blueprint) {
    let options = VectorOptions {
        threads: 1,
        ..VectorOptions::default()
    };
    let (live, resident, start) = (allocations::live(), resident_memory(), wall_time());
    let mut envs = VectorEnv::new(blueprint, HERD, options).expect("available");
    let made = wall_time() - start;
    envs.reset(0).expect("no divergence");
    let mut actions = Vec::new();
    for _ in 0..HERD_STEPS {
        envs.sample_actions(&mut actions).expect("all are here");
        envs.step(&actions).expect("valid actions");
    }
    let resident = resident_memory() - resident;
    let live = (allocations::live() - live) as f64 / 1e6;
    println!(
        "{:60} made in {made:.2} s, {resident:.0} MB resident: {:.3} MB each, of {:.3} MB that it has room for",
        format!("memory/{name}, {HERD} environments"),
        resident / HERD as f64,
        live / HERD as f64
    );
}

/// Measures memory in a separate process.
fn memory_apart(filter: &str) {
    let program = std::env::current_exe().expect("this program has a path");
    let status = std::process::Command::new(program).arg(filter).status();
    assert!(status.expect("this program runs").success(), "{filter} failed");
}

fn main() {
    // cargo passes --bench
    let filter = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let wants = |name: &str| filter.as_ref().is_none_or(|f| name.contains(f.as_str()));
    for (name, text) in EXAMPLES {
        let config = Config::from_yaml(text, "example").expect("the examples are valid");
        let eyes = if config.vision_active {
            "with eyes"
        } else {
            "without eyes"
        };
        if wants(&format!("rates/{name}")) && config.vision_active {
            rates(name, &config);
        }
        let herd = format!("memory/{name}");
        if wants(&herd) && filter.as_ref() != Some(&herd) {
            memory_apart(&herd);
        }
        let blueprint = Blueprint::new(config).expect("available");
        if wants(&format!("eyes/{name}")) && blueprint.config().vision_active {
            self::eyes(name, &blueprint);
        }
        if wants(&format!("nodes/{name}")) {
            nodes(name, &blueprint);
        }
        if wants(&format!("crowd/{name}")) {
            crowd(&format!("{name}, {eyes}"), &blueprint);
        }
        if filter.as_ref() == Some(&herd) {
            memory(&format!("{name}, {eyes}"), &blueprint);
        }
        if wants(&format!("threads/{name}")) {
            threads(&format!("{name}, {eyes}"), &blueprint);
        }
    }
}
