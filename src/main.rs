//! The command line of BabyBench.
#![forbid(unsafe_code)]

mod cli;

use std::io;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Err(e) = cli::main() else {
        return ExitCode::SUCCESS;
    };
    let error = &*e;
    let closed = |e: &io::Error| e.kind() == io::ErrorKind::BrokenPipe;
    if error.downcast_ref().is_some_and(closed) {
        // whoever read the output has had enough
        return ExitCode::SUCCESS;
    }
    if let Some(interrupted) = error.downcast_ref::<cli::Interrupted>() {
        cli::note!("{interrupted}");
        return ExitCode::from(cli::INTERRUPTED);
    }
    cli::note!("error: {e}");
    if let Some(hint) = cli::hint(error) {
        cli::note!("hint: {hint}");
    }
    ExitCode::FAILURE
}
