//! Errors of vectors of environments.

use thiserror::Error;

use crate::env::EnvError;

/// An error of a vector of environments. Environments are counted from 0.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VectorError {
    /// The vector has no environments.
    #[error("a vector needs at least one environment")]
    NoEnvironments,
    /// The environments do not fit into memory; see [`VectorOptions::max_memory`](super::VectorOptions::max_memory).
    #[error(
        "{envs} environments would take {} of memory ({} each), but {} may be used: {}",
        human(*bytes), human(*each), human(*limit), advice(*fit)
    )]
    Memory {
        /// Number of environments.
        envs: usize,
        /// Estimated size of each, bytes.
        each: u64,
        /// Estimated size of all, bytes.
        bytes: u64,
        /// The limit, bytes.
        limit: u64,
        /// Number of environments that fit.
        fit: usize,
    },
    /// The environments cannot share arrays.
    #[error(
        "environment {env} differs from environment 0 in {what}: {found} instead of {expected}{}",
        skin_advice(what)
    )]
    Spaces {
        /// The environment that differs.
        env: usize,
        /// The space that differs.
        what: String,
        /// The space of environment 0.
        expected: String,
        /// The space of the environment.
        found: String,
    },
    /// An environment at another age cannot share arrays with the others.
    #[error(
        "environment {env} cannot change its age: {what} would be {found} instead of {expected}; set touch_grows to True"
    )]
    Grown {
        /// The environment.
        env: usize,
        /// The space that differs.
        what: String,
        /// The space of all environments.
        expected: String,
        /// The space of the environment at that age.
        found: String,
    },
    /// An array has the wrong length.
    #[error("{what}: expected {expected:?} ({} values), found {}", expected[0] * expected[1], shape(*found, *expected))]
    Shape {
        /// Name of the array.
        what: &'static str,
        /// Expected shape: environments, values per environment.
        expected: [usize; 2],
        /// Number of values found.
        found: usize,
    },
    /// An array belongs to a sense that the environments do not have.
    #[error("{what}: the environments have no such observation")]
    NoSense {
        /// Name of the array.
        what: &'static str,
    },
    /// The environment does not exist.
    #[error("environment {env} does not exist: the vector has {envs}, numbered from 0")]
    Unknown {
        /// The requested number.
        env: usize,
        /// Number of environments.
        envs: usize,
    },
    /// The environment was sent and has not been received.
    #[error("environment {env} is in flight: receive it first (recv)")]
    InFlight {
        /// The environment.
        env: usize,
    },
    /// A call waits for more environments than were sent.
    #[error(
        "recv({wanted}) waits for at least one environment and for no more than are in flight, which are {in_flight}: call send first"
    )]
    NotSent {
        /// Number of environments waited for.
        wanted: usize,
        /// Number of environments in flight.
        in_flight: usize,
    },
    /// The environment cannot be stepped before it is reset.
    #[error("environment {env} needs a reset before it can be stepped")]
    NotReset {
        /// The environment.
        env: usize,
    },
    /// An environment fails.
    #[error("environment {env}: {source}")]
    Env {
        /// The environment.
        env: usize,
        /// The cause.
        source: Box<EnvError>,
    },
    /// An environment panicked. The others are unharmed, and the next reset rebuilds it.
    #[error("environment {env} panicked: {message}; reset it to rebuild it")]
    Panicked {
        /// The environment.
        env: usize,
        /// The message of the panic.
        message: String,
    },
    /// The system cannot start another thread.
    #[error("cannot start a thread: {0}")]
    Thread(#[from] std::io::Error),
}

/// Returns what makes the skins of different bodies equal, if it is they that differ.
fn skin_advice(what: &str) -> &'static str {
    if what.contains("touch") || what.contains("pain") {
        "; bodies of other sizes have as many touch sensors with touch_grows set to True"
    } else {
        ""
    }
}

/// Describes the number of environments that fit.
fn advice(fit: usize) -> String {
    match fit {
        0 => "not even one fits".to_string(),
        n => format!("use at most {n}"),
    }
}

/// Describes a number of values, as a shape if it is one.
fn shape(found: usize, [n, len]: [usize; 2]) -> String {
    match (len > 0 && found.is_multiple_of(len), n > 0 && found.is_multiple_of(n)) {
        (true, _) => format!("[{}, {len}] ({found} values)", found / len),
        (_, true) => format!("[{n}, {}] ({found} values)", found / n),
        _ => format!("{found} values"),
    }
}

/// Formats a number of bytes for display.
fn human(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["KiB", "MiB", "GiB", "TiB", "PiB"];
    let mut value = bytes as f64 / 1024.0;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    format!("{value:.1} {}", UNITS[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_say_shapes_and_sizes() {
        let wrong = |found| VectorError::Shape {
            what: "actions",
            expected: [4, 44],
            found,
        };
        assert_eq!(
            wrong(132).to_string(),
            "actions: expected [4, 44] (176 values), found [3, 44] (132 values)"
        );
        assert_eq!(
            wrong(4 * 43).to_string(),
            "actions: expected [4, 44] (176 values), found [4, 43] (172 values)"
        );
        assert_eq!(
            wrong(7).to_string(),
            "actions: expected [4, 44] (176 values), found 7 values"
        );
        assert_eq!(human(3 << 39), "1.5 TiB");
        assert_eq!(human(512), "0.5 KiB");
    }
}
