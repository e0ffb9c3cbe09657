//! Commands that end in order when they are interrupted.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that was interrupted, as shells have it: 128 and the number of SIGINT.
pub const EXIT_CODE: u8 = 130;

/// Whether the user wants no more.
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on Ctrl-C, or the signal to terminate, is a wish that the command has to grant; a second one ends the program
    /// at once. Signals that are ignored, as `nohup` has it, stay so.
    pub fn watch() -> Self {
        let wish = Arc::new(AtomicBool::new(false));
        let seen = wish.clone();
        // fails where signals are ignored
        let _ = ctrlc::try_set_handler(move || {
            if seen.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(EXIT_CODE));
            }
        });
        Self(wish)
    }

    /// Whether Ctrl-C was pressed.
    pub fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The error of a command that was interrupted: what it leaves behind.
#[derive(Debug)]
pub struct Interrupted(pub String);

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "interrupted: {}", self.0)
    }
}

impl std::error::Error for Interrupted {}
