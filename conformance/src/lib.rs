//! Distances between babybench and MuJoCo 3.3.0: the data, the measures and the tables.

pub mod arrays;
pub mod data;
pub mod differential;
pub mod example_runs;
pub mod live;
pub mod loading;
pub mod measure;
pub mod motion;
pub mod mujoco;
pub mod pictures;
pub mod processes;
pub mod recordings;
pub mod reference;
pub mod replays;
pub mod statics;
pub mod worlds;
