//! Compares CortenForge, another engine in pure Rust that reads MJCF, and babybench with MuJoCo 3.3.0: the documents that each loads, and the errors
//! of their accelerations.
//!
//! Usage: `conformance-peer FOLDER...`. Prints a table in Markdown. Of a document that both engines and MuJoCo load, eight states are compared, of a run of
//! MuJoCo under random controls: `qacc` of a forward computation, relative to the largest.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;

use babybench::assets::FileSystem;
use babybench::mjcf_loader::load;
use babybench::physics::{Engine, State, compile};
use conformance::differential::compare::Sides;
use conformance::live::speed::copy_motion;
use conformance::measure::relative;
use conformance::mujoco::{Mujoco, Simulation, reference};
use conformance::processes::{self, Ran};
use conformance::worlds::{Document, find};
use fastrand::Rng;
use serde::{Deserialize, Serialize};

/// States of a document, and steps of MuJoCo between two of them.
const STATES: usize = 8;
const BETWEEN: usize = 12;

/// Steps that a document must survive to count as loaded.
const STEPS: usize = 100;

/// Error of accelerations up to which an engine agrees.
const AGREES: f64 = 1e-6;

/// A document compared with MuJoCo.
#[derive(Deserialize, Serialize)]
struct Compared {
    /// Whether MuJoCo accepts it.
    counts: bool,
    peer: Engines,
    ours: Engines,
}

/// The result of running an engine on a document.
#[derive(Clone, Copy, Default, Deserialize, Serialize)]
struct Engines {
    /// It loads and takes its steps without an error and with finite numbers.
    loads: bool,
    /// Its accelerations are MuJoCo's.
    agrees: bool,
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[String]) -> Result<(), String> {
    let api = reference()?;
    // a process that this one has started gets the numbers of its documents first
    if let [flag, from, to, folders @ ..] = args
        && flag == "--part"
    {
        let number = |text: &String| text.parse::<u64>().map_err(|e| format!("{text}: {e}"));
        let documents = documents(folders)?;
        return processes::in_child(number(from)?..number(to)?, |k| compared(api, &documents[k as usize]));
    }
    if args.is_empty() {
        return Err("usage: conformance-peer FOLDER...".into());
    }
    let documents = documents(args)?;
    let program = std::env::current_exe().map_err(|e| format!("this program: {e}"))?;
    let ran = processes::run(documents.len() as u64, 4, |range| {
        let mut command = Command::new(&program);
        command
            .args(["--part", &range.start.to_string(), &range.end.to_string()])
            .args(args);
        command
    })?;
    print(&documents, &ran);
    Ok(())
}

fn documents(folders: &[String]) -> Result<Vec<Document>, String> {
    find(&folders.iter().map(PathBuf::from).collect::<Vec<_>>())
}

fn print(documents: &[Document], ran: &[Ran<Compared>]) {
    let mut folders: BTreeMap<String, [usize; 5]> = BTreeMap::new();
    for (document, ran) in documents.iter().zip(ran) {
        let Ran::Done(Compared {
            counts: true,
            peer,
            ours,
        }) = ran
        else {
            continue;
        };
        let name = document
            .folder
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        for key in [name, "~all".into()] {
            let counts = folders.entry(key).or_default();
            let more = [true, peer.loads, peer.agrees, ours.loads, ours.agrees];
            counts
                .iter_mut()
                .zip(more)
                .for_each(|(n, more)| *n += usize::from(more));
        }
    }
    println!("| folder | MuJoCo takes | CortenForge loads | agrees | babybench loads | agrees |");
    println!("|---|--:|--:|--:|--:|--:|");
    for (name, counts) in &folders {
        let counts = counts.map(|n| n.to_string()).join(" | ");
        println!("| {} | {counts} |", name.trim_start_matches('~'));
    }
}

/// Compares a document.
fn compared(api: &'static Mujoco, Document { folder, path }: &Document) -> Compared {
    let folder = &std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
    let file = folder.join(path);
    let mut out = Compared {
        counts: false,
        peer: Engines::default(),
        ours: Engines::default(),
    };
    let Ok(simulation) = Simulation::new(api, &file.to_string_lossy(), &[]) else {
        return out;
    };
    out.counts = true;
    let mut peer = quietly(|| Peer::load(&file)).flatten();
    out.peer.loads = peer.as_ref().is_some_and(|peer| quietly(|| peer.steps()) == Some(true));
    let Ok(model) = load(&FileSystem::new(folder), path).and_then(compile) else {
        return out;
    };
    let mut sides = Sides::new(Arc::new(model), simulation);
    let mut state = sides.new_state();
    out.ours.loads = (0..STEPS).all(|_| sides.engine().step(&mut state).is_ok());
    let (mut errors, mut compared) = ([0.0_f64; 2], 0);
    for state in states(&mut sides) {
        let Some(theirs) = forward(&mut sides, &state) else {
            continue;
        };
        compared += 1;
        let mut own = sides.new_state();
        own.copy_dynamic_from(&state);
        let done = sides.engine().forward(&mut own).is_ok();
        errors[0] = errors[0].max(if done {
            relative(&own.qacc, &theirs)
        } else {
            f64::INFINITY
        });
        let qacc = peer
            .as_mut()
            .and_then(|peer| quietly(|| peer.forward(&state)).flatten());
        let error = qacc.filter(|qacc| qacc.len() == theirs.len());
        errors[1] = errors[1].max(error.map_or(f64::INFINITY, |qacc| relative(&qacc, &theirs)));
    }
    // a document whose states MuJoCo has no accelerations for shows nothing of either
    let shows = compared > 0 || sides.model.nv == 0;
    let [ours, peer] = errors.map(|error| shows && error <= AGREES);
    out.ours.agrees = out.ours.loads && ours;
    out.peer.agrees = out.peer.loads && peer;
    out
}

/// Lists states that MuJoCo visits under random controls.
fn states(sides: &mut Sides) -> Vec<State> {
    let model = sides.model.clone();
    let mut rng = Rng::with_seed(0);
    let mut state = sides.new_state();
    state.qvel.iter_mut().for_each(|v| *v = 2.0 * rng.f64() - 1.0);
    let mut all = Vec::new();
    for k in 0..STATES * BETWEEN {
        if k % BETWEEN == 0 {
            for (ctrl, [low, high]) in state.ctrl.iter_mut().zip(&model.actuator_ctrlrange) {
                let [low, high] = if low < high { [*low, *high] } else { [-1.0, 1.0] };
                *ctrl = low + (high - low) * rng.f64();
            }
            let mut copy = sides.new_state();
            copy.copy_dynamic_from(&state);
            all.push(copy);
        }
        if !sides.step_mujoco(&state) {
            break;
        }
        copy_motion(sides.simulation(), &mut state);
    }
    all
}

/// Returns MuJoCo's acceleration in a state; `None` where it has none.
fn forward(sides: &mut Sides, state: &State) -> Option<Vec<f64>> {
    let model = sides.model.clone();
    let simulation = sides.simulation();
    simulation.reset();
    simulation.set_state(&model, state);
    simulation.try_forward().ok()?;
    let qacc = simulation.qacc().to_vec();
    qacc.iter().all(|v| v.is_finite()).then_some(qacc)
}

/// Runs a function that may panic; `None` if it does.
fn quietly<T>(work: impl FnOnce() -> T) -> Option<T> {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let done = catch_unwind(AssertUnwindSafe(work)).ok();
    std::panic::set_hook(hook);
    done
}

/// A document in the other engine.
struct Peer {
    model: sim_core::Model,
    data: sim_core::Data,
}

impl Peer {
    fn load(file: &Path) -> Option<Self> {
        let model = sim_mjcf::load_model_from_file(file).ok()?;
        let data = model.make_data();
        Some(Self { model, data })
    }

    /// Returns whether it can take its steps.
    fn steps(&self) -> bool {
        let mut data = self.model.make_data();
        (0..STEPS).all(|_| data.step(&self.model).is_ok()) && data.qpos.iter().all(|v| v.is_finite())
    }

    /// Returns its acceleration in a state.
    fn forward(&mut self, state: &State) -> Option<Vec<f64>> {
        self.data = self.model.make_data();
        let Self { model, data } = self;
        let parts = [
            (data.qpos.as_mut_slice(), &state.qpos),
            (data.qvel.as_mut_slice(), &state.qvel),
            (data.ctrl.as_mut_slice(), &state.ctrl),
            (data.act.as_mut_slice(), &state.act),
            (data.qacc_warmstart.as_mut_slice(), &state.qacc_warmstart),
        ];
        for (to, from) in parts {
            if to.len() != from.len() {
                return None;
            }
            to.copy_from_slice(from);
        }
        data.forward(model).ok()?;
        Some(data.qacc.as_slice().to_vec())
    }
}
