//! A report that compares the policies of a folder with policies that do not learn: tables and learning curves.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use babybench::config::Behavior;
use babybench::eval::ConfidenceInterval;
use babybench::policy::{NoisePolicy, OnnxPolicy, Policy, RandomPolicy, ZeroPolicy};
use babybench::spaces::Noise;
use babybench::{Blueprint, Config, Env};

use crate::Error;
use crate::plans::TASKS;

/// Number of episodes of each policy; their seeds are 0, 1, ..., which training does not use.
const EPISODES: u64 = 20;
/// Size of a panel, and of the margins of its curve: left, top, right, bottom.
const PANEL: [f64; 2] = [300.0, 190.0];
const MARGIN: [f64; 4] = [48.0, 28.0, 14.0, 34.0];
/// Panels side by side.
const COLUMNS: usize = 3;
const STYLE: &str = "text{font:12px Helvetica,Arial,sans-serif;fill:#5c6675}.title{fill:#1d2430;font-size:13px}\
    .grid{stroke:#e2e3e6}.all{fill:none;stroke:#5c6675;stroke-opacity:.5;stroke-width:1.2}.mean{fill:none;stroke:#2e86de;stroke-width:2}\
    .random{stroke:#e4572e;stroke-dasharray:5 4;stroke-width:1.4}";

/// A policy of the folder: its task, the age at which it was trained, its file name without the ending.
struct Entry {
    behavior: Behavior,
    age: Option<f64>,
    name: String,
}

/// Writes `README.md` and `curves.svg` next to the policies of a folder.
pub fn write(folder: &Path) -> Result<(), Error> {
    let (mut returns, mut successes, mut panels) = (String::new(), String::new(), String::new());
    let entries = entries(folder)?;
    for (k, entry) in entries.iter().enumerate() {
        let row = row(folder, entry)?;
        print!("{}{}", row.returns, row.successes);
        returns.push_str(&row.returns);
        successes.push_str(&row.successes);
        let at = [PANEL[0] * (k % COLUMNS) as f64, PANEL[1] * (k / COLUMNS) as f64];
        panels.push_str(&panel(folder, entry, row.random, at)?);
    }
    let rows = entries.len().div_ceil(COLUMNS) as f64;
    let [width, height] = [PANEL[0] * COLUMNS as f64, PANEL[1] * rows];
    let chart = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\">\n\
         <style>{STYLE}</style><rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n{panels}</svg>\n"
    );
    std::fs::write(folder.join("curves.svg"), chart)?;
    std::fs::write(folder.join("README.md"), page(&returns, &successes))?;
    Ok(())
}

fn page(returns: &str, successes: &str) -> String {
    format!(
        "# Policies of the tasks\n\n\
         A trained policy for each of MIMo's tasks, as an ONNX model. Its action is a linear function of the angles and velocities of his joints, of the goal,\n\
         and in `roll_over` of how he lies. `babybench evaluate` takes them with `--policy`, and the page lists them.\n\n\
         ```sh\n\
         cargo run --release --features onnx -- evaluate --config configs/config_reach.yml --policy policies/reach.onnx\n\
         ```\n\n\
         The tables are of {EPISODES} episodes with seeds 0 to {}, which training has not seen, in the configuration of the task. `held` holds a random action for\n\
         half a second.\n\n\
         The mean return, and in brackets the interval that holds 95 % of the means of samples drawn from the episodes with replacement:\n\n\
         | policy | steps trained | its return | random | zero | held |\n\
         |---|--:|--:|--:|--:|--:|\n{returns}\n\
         The share of successes, and the mean time that the policy took for one:\n\n\
         | policy | its successes | random | zero | held | seconds |\n\
         |---|--:|--:|--:|--:|--:|\n{successes}\n\
         ![Return over steps of training](curves.svg)\n\n\
         Return over steps of training: the policy (blue), the mean of the candidates that are tried (grey), a random policy (dashed). `roll_over_N` is learned\n\
         in the body of N months, with its strength. `selfbody` learns one part of the body after another, and its curve has a piece for each. Training is\n\
         separable CMA-ES ([`examples/tasks`](../examples/tasks)). The same seed gives the same bits in any number of threads:\n\n\
         ```sh\n\
         cargo run --release --features onnx,npz --example tasks -- reach --seed 0    # or selfbody, standup, roll_over, catch; --age 3\n\
         cargo run --release --features onnx,npz --example tasks -- report            # this page\n\
         ```\n",
        EPISODES - 1
    )
}

/// Lists the policies of a folder in the order of the tasks, then of ages.
fn entries(folder: &Path) -> Result<Vec<Entry>, Error> {
    let files = std::fs::read_dir(folder)?.flatten().map(|file| file.path());
    let models = files.filter(|path: &PathBuf| path.extension().is_some_and(|end| end == "onnx"));
    let mut found = Vec::new();
    for path in models {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let whole = |behavior: &&Behavior| name == behavior.name() || name.starts_with(&format!("{behavior}_"));
        let Some(&behavior) = TASKS.iter().find(whole) else {
            continue;
        };
        let age = name.strip_prefix(&format!("{behavior}_")).map(str::parse).transpose()?;
        found.push(Entry { behavior, age, name });
    }
    let order = |entry: &Entry| TASKS.iter().position(|task| *task == entry.behavior);
    found.sort_by(|a, b| {
        (order(a), a.age.unwrap_or(99.0))
            .partial_cmp(&(order(b), b.age.unwrap_or(99.0)))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    Ok(found)
}

struct Row {
    /// Line of the table of returns.
    returns: String,
    /// Line of the table of successes.
    successes: String,
    /// Mean return of a random policy.
    random: f64,
}

fn row(folder: &Path, entry: &Entry) -> Result<Row, Error> {
    let config = Config {
        age: entry.age,
        ..Config::of(entry.behavior)
    };
    let mut env = Blueprint::new(config)?.env()?;
    let policies: [Box<dyn Policy>; 4] = [
        Box::new(OnnxPolicy::open(folder.join(format!("{}.onnx", entry.name)))?),
        Box::new(RandomPolicy),
        Box::new(ZeroPolicy),
        Box::new(NoisePolicy::new(Noise::Held { seconds: 0.5 })),
    ];
    let steps = curve(folder, entry)?.last().map_or(0.0, |point| point[1]);
    let (mut returns, mut successes, mut times, mut random) = (String::new(), String::new(), Vec::new(), 0.0);
    for (k, mut policy) in policies.into_iter().enumerate() {
        let (mut all, mut reached) = (Vec::new(), Vec::new());
        for seed in 0..EPISODES {
            let (reward, success) = episode(&mut env, policy.as_mut(), seed)?;
            all.push(reward);
            reached.extend(success);
        }
        let ConfidenceInterval { mean, low, high, .. } = ConfidenceInterval::of(&all).ok_or("no episodes")?;
        if k == 1 {
            random = mean;
        }
        write!(returns, " {mean:.1} ({low:.1} to {high:.1}) |")?;
        write!(successes, " {:.2} |", reached.len() as f64 / EPISODES as f64)?;
        if k == 0 {
            times = reached;
        }
    }
    let seconds = times.iter().sum::<f64>() / times.len() as f64;
    let seconds = if times.is_empty() {
        String::new()
    } else {
        format!("{seconds:.1}")
    };
    Ok(Row {
        returns: format!("| `{}.onnx` | {:.1} M |{returns}\n", entry.name, steps / 1e6),
        successes: format!("| `{}.onnx` |{successes} {seconds} |\n", entry.name),
        random,
    })
}

/// Returns the return of an episode, and the time until the first success, s.
fn episode(env: &mut Env, policy: &mut dyn Policy, seed: u64) -> Result<(f64, Option<f64>), Error> {
    env.reset(Some(seed))?;
    policy.begin(env, seed)?;
    let (mut action, mut reward) = (Vec::new(), 0.0);
    let (dt, mut success) = (env.blueprint().dt(), None);
    while !env.last_step().over() {
        policy.act(env, &mut action)?;
        let step = env.step(&action)?;
        reward += step.reward;
        if success.is_none() && step.info.behavior.task().is_some_and(|task| task.outcome.is_success) {
            success = Some(dt * step.info.steps as f64);
        }
    }
    Ok((reward, success))
}

/// Reads the curve of a policy: stage, steps, return of the candidates, return of the policy.
fn curve(folder: &Path, entry: &Entry) -> Result<Vec<[f64; 4]>, Error> {
    let text = std::fs::read_to_string(folder.join(format!("{}.csv", entry.name)))?;
    let mut points = Vec::new();
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
        points.push(numbers.try_into().map_err(|_| format!("{line} has not four numbers"))?);
    }
    Ok(points)
}

/// Draws the curve of a policy.
fn panel(folder: &Path, entry: &Entry, random: f64, at: [f64; 2]) -> Result<String, Error> {
    let points = curve(folder, entry)?;
    let values = points.iter().flat_map(|point| [point[2], point[3]]).chain([random]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let room = 0.06 * (high - low).max(1.0);
    let (low, high) = (low - room, high + room);
    let most = points.last().map_or(1.0, |point| point[1]);
    let [left, top, right, bottom] = MARGIN;
    let inner = [PANEL[0] - left - right, PANEL[1] - top - bottom];
    let x = |steps: f64| at[0] + left + inner[0] * steps / most;
    let y = |value: f64| at[1] + top + inner[1] * (1.0 - (value - low) / (high - low));
    let mut out = String::new();
    let months = |age| if age == 1.0 { "month" } else { "months" };
    let age = entry
        .age
        .map_or_else(String::new, |age| format!(", {age} {}", months(age)));
    writeln!(
        out,
        "<text class=\"title\" x=\"{:.0}\" y=\"{:.0}\">{}{age}</text>",
        at[0] + left,
        at[1] + 18.0,
        entry.behavior
    )?;
    for value in [low + room, 0.5 * (low + high), high - room] {
        let (from, to, height) = (x(0.0), x(most), y(value));
        writeln!(
            out,
            "<line class=\"grid\" x1=\"{from:.1}\" x2=\"{to:.1}\" y1=\"{height:.1}\" y2=\"{height:.1}\"/>"
        )?;
        writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{value:.0}</text>",
            from - 5.0,
            height + 4.0
        )?;
    }
    let below = at[1] + PANEL[1] - bottom + 16.0;
    writeln!(out, "<text x=\"{:.1}\" y=\"{below:.1}\">0</text>", x(0.0))?;
    writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{below:.1}\" text-anchor=\"end\">{:.1} M steps</text>",
        x(most),
        most / 1e6
    )?;
    writeln!(
        out,
        "<line class=\"random\" x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{2:.1}\" y2=\"{2:.1}\"/>",
        x(0.0),
        x(most),
        y(random)
    )?;
    for (class, column) in [("all", 2), ("mean", 3)] {
        for stage in points.chunk_by(|a, b| a[0] == b[0]) {
            let line = stage
                .iter()
                .map(|point| format!("{:.1},{:.1}", x(point[1]), y(point[column])));
            writeln!(
                out,
                "<polyline class=\"{class}\" points=\"{}\"/>",
                line.collect::<Vec<_>>().join(" ")
            )?;
        }
    }
    Ok(out)
}
