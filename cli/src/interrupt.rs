//! Commands that shut down cleanly when they are interrupted.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Exit code of an interrupted program, by the convention of shells: 128 plus the number of SIGINT.
pub const EXIT_CODE: u8 = 130;

/// The signals that ask a program to stop; hangups come from terminals that close.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, SIGHUP];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// A request by the user to stop.
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Handles Ctrl-C, hangups and the termination signal as a request to stop, which the command must check; a second one ends
    /// the program at once. Signals that are ignored, as hangups are under `nohup`, stay ignored.
    pub fn watch() -> Self {
        let wish = Arc::new(AtomicBool::new(false));
        for signal in SIGNALS {
            if !ignored(signal) {
                // in this order: the first signal must not find its own mark; fails for signals that a system does not have
                let _ = flag::register_conditional_shutdown(signal, i32::from(EXIT_CODE), wish.clone());
                let _ = flag::register(signal, wish.clone());
            }
        }
        Self(wish)
    }

    /// Returns whether the user has asked to stop.
    pub fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Returns whether a signal was ignored when the program started, if the system reports it.
fn ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// The error of an interrupted command, with the files that it left behind.
#[derive(Debug)]
pub struct Interrupted(pub String);

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "interrupted: {}", self.0)
    }
}

impl std::error::Error for Interrupted {}
