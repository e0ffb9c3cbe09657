//! MIMo and its scenes: the assets of an environment, the parts that bodies belong to, the locks of joints.

mod anatomy;
mod assets;
mod builder;
mod figures;
mod growth;
mod locks;
mod parts;
mod placement;
mod room;
mod scene;
mod standards;

pub use anatomy::{BodyKind, body_kind};
pub use assets::embedded;
pub use builder::SceneBuilder;
pub use figures::BodyFigures;
#[cfg(feature = "report")]
pub(crate) use figures::upright_extent;
pub use growth::Growth;
pub use growth::GrowthError;
pub use locks::{LockError, LockReport, LockTarget};
pub use locks::{held_by, lock, lock_of, unlock};
pub(crate) use parts::{JOINT_PREFIX, ROOT};
pub use parts::{MimoBodies, MimoJoints, joint_part};
pub use placement::held_posture;
pub(crate) use room::OTHER_PREFIX;
#[cfg(feature = "eval")]
pub(crate) use room::open_room;
pub use room::{PARTS as ROOM_PARTS, Unused, unused_attributes};
pub use room::{RoomError, scene_assets};
pub use scene::{DOCUMENT, build_scene};
pub use scene::{EYES, SceneError, Version, build_model, scene_xml};
#[cfg(feature = "eval")]
pub(crate) use scene::{document_path, has_own_scene};
pub use standards::{GrowthStandard, Lms};
