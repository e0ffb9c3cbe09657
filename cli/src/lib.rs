//! The command line of BabyBench as a function, which the program `babybench` and `python -m babybench` call.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arguments;
mod commands;
mod hint;
mod interrupt;
mod print;
pub mod report;
pub mod view;

use std::ffi::OsString;
use std::io;

/// Runs a command line, whose first argument is the name of the program, and returns the exit code of the process: 0 for success, 1 for
/// an error, 2 for invalid arguments, 130 for an interrupted command. `program` is what users type to start it, if that is not the first
/// argument.
///
/// It writes to the standard output and the standard error, and may end the process when it is interrupted twice.
pub fn main_from(arguments: impl IntoIterator<Item = OsString>, program: Option<&'static str>) -> u8 {
    let command = match commands::parse(arguments, program) {
        Ok(command) => command,
        Err(e) => {
            // help and the version, too; the output may have no reader
            let _ = e.print();
            return u8::try_from(e.exit_code()).unwrap_or(2);
        }
    };
    let Err(e) = command.run() else { return 0 };
    let error = &*e;
    let closed = |e: &io::Error| e.kind() == io::ErrorKind::BrokenPipe;
    if error.downcast_ref().is_some_and(closed) {
        // the reader of the output has closed the pipe
        return 0;
    }
    if let Some(interrupted) = error.downcast_ref::<interrupt::Interrupted>() {
        print::note!("{interrupted}");
        return interrupt::EXIT_CODE;
    }
    print::note!("error: {e}");
    if let Some(hint) = hint::hint(error) {
        print::note!("hint: {hint}");
    }
    1
}
