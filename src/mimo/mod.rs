//! MIMo and its scenes: the assets of an environment, the parts that bodies belong to, the locks of joints.

mod anatomy;
mod assets;
mod figures;
mod growth;
mod locks;
mod parts;
mod placement;
mod scene;

pub use anatomy::{BodyKind, body_kind};
pub use assets::embedded;
pub use figures::BodyFigures;
#[cfg(feature = "report")]
pub(crate) use figures::upright_extent;
pub use growth::{Growth, GrowthError};
pub use locks::{LockError, LockReport, LockTarget, held_by, lock, lock_of, unlock};
pub(crate) use parts::JOINT_PREFIX;
pub use parts::{MimoJoints, joint_part};
pub use placement::held_posture;
pub use scene::{DOCUMENT, SceneError, Version, build_model, build_scene, scene_xml};
