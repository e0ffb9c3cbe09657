//! Distances between babybench and MuJoCo 3.3.0: the data, the measures and the tables.

pub mod arrays;
pub mod example_runs;
pub mod live;
pub mod measure;
pub mod motion;
pub mod mujoco;
pub mod mutation;
pub mod pictures;
pub mod recordings;
pub mod reference;
pub mod replays;
pub mod statics;

/// Says on the standard error that something is left out; not by `eprintln`, which the test harness hides.
pub fn skipped(what: &str, why: impl std::fmt::Display) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "SKIPPED {what}: {why}");
}
