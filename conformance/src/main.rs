//! Prints how far babybench is from MuJoCo 3.3.0.

mod picture_speed;
mod plot;
mod report;
mod speed;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: conformance report [--out FILE] [--plots FOLDER] [--states N]
       conformance speed [--filter TEXT] [--batches N] [--pictures yes]";

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
            let [filter, batches, pictures] = values(options, ["--filter", "--batches", "--pictures"])?;
            match pictures.as_deref() {
                None | Some("no") => {
                    speed::print(filter.as_deref().unwrap_or(""), number("--batches", batches, 60)?)?;
                }
                Some("yes") => picture_speed::print()?,
                Some(other) => return Err(format!("--pictures {other}: yes or no")),
            }
        }
        "-h" | "--help" => println!("{USAGE}"),
        _ => return Err(USAGE.to_string()),
    }
    Ok(())
}

/// Parses a number; when it is left out, returns the default.
fn number(name: &str, text: Option<String>, default: usize) -> Result<usize, String> {
    text.map_or(Ok(default), |n| {
        n.parse().map_err(|_| format!("{name} {n}: not a number"))
    })
}

/// Returns the values of options, each of which may be left out.
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
