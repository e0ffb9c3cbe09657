//! Cost of whole steps compared with the Python kit.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use babybench::config::{Behavior, Compat};
use babybench::{Config, Env, EnvError};
use conformance::live::example_configs;
use conformance::live::speed::{cpu_time, quartiles};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::python;

/// Turns of each side.
const TURNS: usize = 20;

/// Steps of a turn: untimed ones, after which caches are as warm as in a run, and timed ones.
const WARM_UP: usize = 5;
const STEPS: usize = 40;

/// The seed of the actions, which are the same on both sides.
const SEED: u64 = 0;

/// A whole environment that both sides have.
struct Task {
    name: &'static str,
    /// Settings that `kit_speed.py` builds the kit's environment from.
    theirs: Value,
    /// Configuration of our environment.
    ours: Config,
}

impl Task {
    /// Returns the example configurations. Ours follows the Python code wherever it departs from the API page, so that both do the same work.
    fn examples() -> impl Iterator<Item = Self> {
        example_configs().into_iter().map(|(name, config)| Self {
            name,
            theirs: json!({ "config": config.to_yaml(), "seed": SEED }),
            ours: Config {
                compat: Compat::Reference,
                ..config
            },
        })
    }

    /// Returns MIMo's tasks with goals that the kit has, under their names in Gymnasium.
    fn with_goals() -> impl Iterator<Item = Self> {
        let tasks = [
            (Behavior::Reach, "MIMoReach-v0"),
            (Behavior::Standup, "MIMoStandup-v0"),
            (Behavior::SelfBody, "MIMoSelfBody-v0"),
            (Behavior::Catch, "MIMoCatch-v0"),
        ];
        tasks.into_iter().map(|(behavior, id)| Self {
            name: behavior.name(),
            theirs: json!({ "id": id, "seed": SEED }),
            ours: Config {
                compat: Compat::Reference,
                ..Config::of(behavior)
            },
        })
    }
}

/// Prints the CPU time of whole steps of the kit and of ours for the tasks whose name contains `filter`.
///
/// # Errors
/// The folder is not the kit; its Python is missing or fails; our environment fails.
pub fn print(kit: &Path, python: &Path, filter: &str) -> Result<(), String> {
    let all = Task::examples().chain(Task::with_goals());
    let mut tasks = all.filter(|t| t.name.contains(filter)).peekable();
    if tasks.peek().is_none() {
        return Ok(());
    }
    println!(
        "CPU time of whole steps, ms: the Python kit's and ours, all senses of the configuration on, the same random actions, \
         each in one thread. By turns, {TURNS} times {STEPS} steps.\n"
    );
    println!("| configuration | Python kit | ours | times faster, least | p50 |");
    println!("|---|--:|--:|--:|--:|");
    for task in tasks {
        let [theirs, ours] = measure(kit, python, &task).map_err(|e| format!("{}: {e}", task.name))?;
        let ratios: Vec<f64> = theirs.iter().zip(&ours).map(|(t, o)| t / o).collect();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let [theirs, ours, ratio] = [theirs, ours, ratios].map(|v| quartiles(v)[1]);
        println!("| {} | {theirs:.2} | {ours:.3} | {least:.1} | {ratio:.1} |", task.name);
    }
    Ok(())
}

/// Measures the CPU time of a step, ms, for each turn: the kit's and ours. The first side alternates.
fn measure(kit: &Path, python: &Path, task: &Task) -> Result<[Vec<f64>; 2], String> {
    let mut theirs = KitEnv::start(kit, python, &task.theirs)?;
    let ours = Env::new(task.ours.clone()).and_then(|mut env| env.reset(Some(SEED)).map(drop).map(|()| env));
    let mut ours = ours.map_err(|e| e.to_string())?;
    let mut spent = [Vec::new(), Vec::new()];
    for turn in 0..TURNS {
        for side in [turn % 2, 1 - turn % 2] {
            let time = match side {
                0 => theirs.turn()?,
                _ => our_turn(&mut ours).map_err(|e| e.to_string())?,
            };
            spent[side].push(1e3 * time / STEPS as f64);
        }
    }
    Ok(spent)
}

/// Takes our steps of a turn; returns the CPU time of those that are timed, s.
fn our_turn(env: &mut Env) -> Result<f64, EnvError> {
    let mut action = Vec::new();
    let mut spent = 0.0;
    for k in 0..WARM_UP + STEPS {
        env.sample_action(&mut action);
        let start = cpu_time();
        let step = env.step(&action)?;
        let time = cpu_time() - start;
        let over = step.terminated || step.truncated;
        if k >= WARM_UP {
            spent += time;
        }
        if over {
            env.reset(None)?;
        }
    }
    Ok(spent)
}

/// An environment of the kit in a process of its own, whose working folder is temporary.
struct KitEnv {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
    folder: TempDir,
}

impl KitEnv {
    /// Starts the process and waits until the environment is ready.
    fn start(kit: &Path, python: &Path, task: &Value) -> Result<Self, String> {
        let script = python::script("kit_speed.py");
        let cannot = |e: &dyn Display| format!("cannot run {} {}: {e}", python.display(), script.display());
        let folder = tempfile::tempdir().map_err(|e| format!("no temporary folder: {e}"))?;
        let said = File::create(folder.path().join(SAID)).map_err(|e| cannot(&e))?;
        let mut child = python::command(python)
            .args([script.as_path(), kit])
            .current_dir(folder.path())
            // no compiled files in the checkout, no settings at home
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("MPLCONFIGDIR", folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(said)
            .spawn()
            .map_err(|e| cannot(&e))?;
        let (Some(requests), Some(answers)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(cannot(&"it has no input or output"));
        };
        let mut kit = Self {
            child,
            requests,
            answers: BufReader::new(answers),
            folder,
        };
        kit.ask(task)?;
        Ok(kit)
    }

    /// Takes the steps of a turn; returns the CPU time of those that are timed, s.
    fn turn(&mut self) -> Result<f64, String> {
        let answer = self.ask(&json!({ "warm_up": WARM_UP, "steps": STEPS }))?;
        answer.as_f64().ok_or_else(|| format!("not a time: {answer}"))
    }

    /// Sends a line and reads the answer.
    fn ask(&mut self, request: &Value) -> Result<Value, String> {
        let mut line = String::new();
        let asked = writeln!(self.requests, "{request}").and_then(|()| self.requests.flush());
        match asked.and_then(|()| self.answers.read_line(&mut line)) {
            Ok(n) if n > 0 => serde_json::from_str(&line).map_err(|e| format!("unexpected answer {line:?}: {e}")),
            _ => Err(self.complaint()),
        }
    }

    /// Returns what the process wrote before it ended.
    fn complaint(&mut self) -> String {
        let ended = self.child.wait();
        let ended = ended.map_or_else(|e| e.to_string(), |status| status.to_string());
        let said = std::fs::read(self.folder.path().join(SAID)).unwrap_or_default();
        format!(
            "the Python kit ended ({ended}); it needs {}:\n{}",
            python::NEEDS,
            String::from_utf8_lossy(&said).trim_end()
        )
    }
}

/// The file in the temporary folder that receives the output of the process.
const SAID: &str = "stderr.txt";

impl Drop for KitEnv {
    fn drop(&mut self) {
        // it may have ended
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
