//! Commands that shut down cleanly when they are interrupted.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that was interrupted, as shells have it: 128 and the number of SIGINT.
pub const EXIT_CODE: u8 = 130;

/// A request by the user to stop.
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Handles Ctrl-C and the signal to terminate as a request to stop, which the command must heed; a second one ends
    /// the program at once. Signals that are ignored, as under `nohup`, stay ignored.
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

    /// Returns whether the user has asked to stop.
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
