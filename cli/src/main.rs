//! The command line of BabyBench.
#![forbid(unsafe_code)]

mod arguments;
mod commands;
mod hint;
mod interrupt;
mod print;

use std::io;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Err(e) = commands::main() else {
        return ExitCode::SUCCESS;
    };
    let error = &*e;
    let closed = |e: &io::Error| e.kind() == io::ErrorKind::BrokenPipe;
    if error.downcast_ref().is_some_and(closed) {
        // the reader of the output has closed the pipe
        return ExitCode::SUCCESS;
    }
    if let Some(interrupted) = error.downcast_ref::<interrupt::Interrupted>() {
        print::note!("{interrupted}");
        return ExitCode::from(interrupt::EXIT_CODE);
    }
    print::note!("error: {e}");
    if let Some(hint) = hint::hint(error) {
        print::note!("hint: {hint}");
    }
    ExitCode::FAILURE
}
