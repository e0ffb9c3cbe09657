//! The command line of BabyBench.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(babybench_cli::main_from(std::env::args_os(), None))
}
