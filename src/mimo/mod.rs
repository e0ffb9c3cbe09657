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

internals!(use anatomy::{BodyKind, body_kind});
pub use assets::embedded;
pub use builder::SceneBuilder;
internals!(use figures::BodyFigures);
#[cfg(feature = "report")]
pub(crate) use figures::upright_extent;
internals!(use growth::Growth);
pub use growth::GrowthError;
pub use locks::{LockError, LockReport, LockTarget};
internals!(use locks::{held_by, lock, lock_of, unlock});
pub(crate) use parts::{JOINT_PREFIX, ROOT};
internals!(use parts::{MimoBodies, MimoJoints, joint_part});
internals!(use placement::held_posture);
pub(crate) use room::OTHER_PREFIX;
#[cfg(feature = "eval")]
pub(crate) use room::open_room;
internals!(use room::{PARTS as ROOM_PARTS, Unused, unused_attributes});
pub use room::{RoomError, scene_assets};
#[cfg(feature = "eval")]
pub(crate) use scene::{document_path, has_own_scene};
internals!(use scene::{DOCUMENT, build_scene});
pub use scene::{EYES, SceneError, Version, build_model, scene_xml};
internals!(use standards::{GrowthStandard, Lms});
