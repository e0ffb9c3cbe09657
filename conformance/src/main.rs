//! Prints how far babybench is from MuJoCo 3.3.0.

mod differences;
#[cfg(feature = "wgpu")]
mod gpu_speed;
mod kit_speed;
mod picture_speed;
mod plot;
mod python;
mod report;
mod speed;

use std::ops::Range;
use std::path::Path;
use std::process::ExitCode;

use testkit::yardsticks::check_kit;

const USAGE: &str = "usage: conformance report [--out FILE] [--plots FOLDER] [--states N]
       conformance speed [--filter TEXT] [--batches N]
       conformance speed --pictures yes
       conformance speed --kit FOLDER [--pictures no] [--filter TEXT] [--batches N]
       conformance differential [--count N] [--seed N] [--keep FOLDER]
       conformance worlds FOLDER... [--json FILE]
       conformance gpu [--environments N,N...]
With --kit everything is measured: physics steps, pictures, and whole steps beside the Python kit in FOLDER; with a filter
only the physics steps and whole steps whose name has that text.
`differential` puts N random documents beside MuJoCo; the smallest documents that differ go into FOLDER. Exits with 1 where some do.
`worlds` puts every document under the folders beside MuJoCo. Exits with 1 where the sides mean something else by one.
`gpu` (feature wgpu) times the eyes of many environments on a GPU beside MuJoCo's renderer, and beside MuJoCo Warp's where the
variable MJWARP_PYTHON names a Python that has it.";

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
    let Some((command, options)) = args.split_first() else {
        return Err(USAGE.to_string());
    };
    match command.as_str() {
        "report" => {
            let [out, plots, states] = values(options, ["--out", "--plots", "--states"])?;
            let states = number("--states", states, 10_000)?;
            let table = report::table(states, plots.as_ref().map(Path::new))?;
            match out {
                None => print!("{table}"),
                Some(file) => std::fs::write(&file, table).map_err(|e| format!("cannot write {file}: {e}"))?,
            }
        }
        "speed" => {
            let [filter, batches, pictures, kit] = values(options, ["--filter", "--batches", "--pictures", "--kit"])?;
            let batches = number("--batches", batches, 60)?;
            let pictures = match pictures.as_deref() {
                None => None,
                Some("yes") => Some(true),
                Some("no") => Some(false),
                Some(other) => return Err(format!("--pictures {other}: yes or no")),
            };
            speeds(
                &filter.unwrap_or_default(),
                batches,
                pictures,
                kit.as_ref().map(Path::new),
            )?;
        }
        "differential" => {
            let [count, seed, keep, from, to] = values(options, ["--count", "--seed", "--keep", "--from", "--to"])?;
            let (count, seed) = (
                number("--count", count, 1000)? as u64,
                number("--seed", seed, 1)? as u64,
            );
            match part(from, to)? {
                None => differences::print(count, seed, keep.as_ref().map(Path::new))?,
                Some(range) => differences::print_part(seed, range)?,
            }
        }
        "worlds" => {
            let at = options
                .iter()
                .position(|option| option.starts_with("--"))
                .unwrap_or(options.len());
            let (folders, options) = options.split_at(at);
            let [json, from, to] = values(options, ["--json", "--from", "--to"])?;
            match part(from, to)? {
                None => differences::print_worlds(folders, json.as_ref().map(Path::new))?,
                Some(range) => differences::print_worlds_part(folders, range)?,
            }
        }
        "gpu" => {
            let [environments] = values(options, ["--environments"])?;
            let environments = environments.unwrap_or_else(|| "1,64,1024".into());
            let environments = environments
                .split(',')
                .map(|n| number("--environments", Some(n.into()), 1));
            let environments = environments.collect::<Result<Vec<_>, _>>()?;
            if environments.contains(&0) {
                return Err("--environments: each number is at least 1".into());
            }
            eyes_on_gpu(&environments)?;
        }
        "-h" | "--help" => println!("{USAGE}"),
        _ => return Err(USAGE.to_string()),
    }
    Ok(())
}

#[cfg(feature = "wgpu")]
fn eyes_on_gpu(environments: &[usize]) -> Result<(), String> {
    gpu_speed::print(environments)
}

#[cfg(not(feature = "wgpu"))]
fn eyes_on_gpu(_: &[usize]) -> Result<(), String> {
    Err(
        "this program was built without the feature wgpu: cargo run --release -p conformance --features wgpu -- gpu"
            .into(),
    )
}

/// Prints the tables of speeds: without a kit the physics or the pictures, with a kit all of them.
fn speeds(filter: &str, batches: usize, pictures: Option<bool>, kit: Option<&Path>) -> Result<(), String> {
    let Some(kit) = kit else {
        return match pictures {
            Some(true) => picture_speed::print(&python::find()?),
            _ => speed::print(filter, batches),
        };
    };
    check_kit(kit).map_err(|e| format!("--kit: {e}"))?;
    let python = python::find()?;
    speed::print(filter, batches)?;
    if pictures.unwrap_or(filter.is_empty()) {
        picture_speed::print(&python)?;
        println!();
    }
    let kit = kit
        .canonicalize()
        .map_err(|e| format!("--kit {}: {e}", kit.display()))?;
    kit_speed::print(&kit, &python, filter)
}

/// Returns the documents assigned to a worker process. This program starts its own workers, so the options are not in its help.
fn part(from: Option<String>, to: Option<String>) -> Result<Option<Range<u64>>, String> {
    if from.is_none() && to.is_none() {
        return Ok(None);
    }
    let (from, to) = (number("--from", from, 0)?, number("--to", to, 0)?);
    Ok(Some(from as u64..to as u64))
}

/// Parses a number; when it is left out, returns the default.
fn number(name: &str, text: Option<String>, default: usize) -> Result<usize, String> {
    text.map_or(Ok(default), |n| {
        n.parse().map_err(|_| format!("{name} {n}: not a number"))
    })
}

/// Returns the values of options. Each is optional.
fn values<const N: usize>(options: &[String], names: [&str; N]) -> Result<[Option<String>; N], String> {
    let mut out = [const { None }; N];
    for pair in options.chunks(2) {
        let [name, value] = pair else {
            return Err(USAGE.to_string());
        };
        let k = names.iter().position(|n| n == name).ok_or(USAGE)?;
        out[k] = Some(value.clone());
    }
    Ok(out)
}
