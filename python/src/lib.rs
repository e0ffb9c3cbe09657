//! The native part of the Python package `babybench`: environments, vectors of environments, and the numbers in them.
//!
//! Python's view of this module is documented in `babybench_core/_native.pyi`.
#![deny(missing_docs, unsafe_code)]

mod arrays;
mod blocks;
mod blueprint;
mod command_line;
mod config;
mod env;
mod errors;
mod given_files;
mod guarded;
mod info;
mod mjcf_document;
mod model;
mod model_change;
mod noise;
mod observation;
mod parts;
mod physics_columns;
mod physics_data;
mod physics_fields;
mod physics_markers;
mod physics_model;
mod physics_options;
mod physics_shapes;
mod pictures;
mod protocol;
mod record;
mod recycled;
mod rows;
mod scene;
mod slab;
mod state;
mod task;
mod touch;
mod touch_spread;
mod vector;
mod video;
mod view;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::blocks::Blocks;
    #[pymodule_export]
    use super::blueprint::Blueprint;
    #[pymodule_export]
    use super::command_line::command_line;
    #[pymodule_export]
    use super::config::{config_examples, config_from_mapping, config_from_yaml, config_keys};
    #[pymodule_export]
    use super::env::Env;
    #[pymodule_export]
    use super::mjcf_document::MjcfDocument;
    #[pymodule_export]
    use super::model_change::{Watch, model_columns, paint, set_equalities};
    #[pymodule_export]
    use super::noise::ActionNoise;
    #[pymodule_export]
    use super::parts::Parts;
    #[pymodule_export]
    use super::physics_data::{PhysicsData, PhysicsRenderer};
    #[pymodule_export]
    use super::physics_model::PhysicsModel;
    #[pymodule_export]
    use super::protocol::{protocol_description, protocol_names, run_protocol};
    #[pymodule_export]
    use super::record::{Folder, Recorder, measure_record, movement_of_record, play_senses, replay_record};
    #[pymodule_export]
    use super::scene::{embedded_files, model_extras, scene_file};
    #[pymodule_export]
    use super::touch_spread::spread_linear;
    #[pymodule_export]
    use super::vector::VectorEnv;
    #[pymodule_export]
    use super::video::write_video;
    #[pymodule_export]
    use super::view::View;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("CHANGEABLE", babybench::env::CHANGEABLE.to_vec())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
