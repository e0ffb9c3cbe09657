//! Prints how far babybench is from MuJoCo 3.3.0.

mod report;

use std::process::ExitCode;

const USAGE: &str = "usage: conformance report [--out FILE]";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let out = match args[..] {
        ["report"] => None,
        ["report", "--out", file] => Some(file),
        ["-h" | "--help"] => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    let table = report::table();
    match out {
        None => print!("{table}"),
        Some(file) => {
            if let Err(e) = std::fs::write(file, table) {
                eprintln!("cannot write {file}: {e}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}
