//! MIMo and the scenes: which assets make up an environment, which bodies belong to which part, which joints are locked.

mod assets;
mod locks;
mod parts;
mod scene;

pub use assets::embedded;
pub use locks::{LockError, LockReport, LockTarget, held_by, lock, lock_of, unlock};
pub use parts::{MimoJoints, joint_part};
pub use scene::{DOCUMENT, Version, build_model, scene_xml};
