//! MIMo and the scenes: which assets make up an environment, which bodies belong to which part, which joints are locked.

mod assets;
mod parts;
mod scene;

pub use assets::embedded;
pub use parts::{MimoJoints, joint_part, lock_group};
pub use scene::{DOCUMENT, Version, build_model, scene_xml};
