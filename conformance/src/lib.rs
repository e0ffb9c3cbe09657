//! Distances between babybench and MuJoCo 3.3.0: the data, the measures and the tables.

pub mod example_runs;
pub mod measure;
pub mod motion;
pub mod recordings;
pub mod reference;
pub mod replays;
pub mod statics;
