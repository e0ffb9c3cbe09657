//! MIMo and its scenes: the assets of an environment, the parts that bodies belong to, the locks of joints.

mod anatomy;
mod assets;
mod builder;
mod constants;
mod custom_scene;
mod document;
mod error;
mod figures;
mod growth;
mod individual;
mod locks;
mod parts;
mod placement;
mod preterm;
pub(crate) mod reflexes;
mod scene;
mod scores;
mod sources;
mod standards;
mod third;
mod version;

pub use anatomy::{BodyKind, body_kind};
pub use assets::embedded;
pub use builder::SceneBuilder;
#[cfg(feature = "eval")]
pub(crate) use custom_scene::open_custom_scene;
pub use custom_scene::{CustomSceneError, scene_assets};
pub use custom_scene::{FILES as CUSTOM_SCENE_FILES, UnusedAttribute, unused_attributes};
pub use document::{DOCUMENT, scene_xml};
#[cfg(feature = "eval")]
pub(crate) use document::{document_path, has_own_scene};
pub use error::SceneError;
pub use figures::{BodyFigures, upright_extent};
pub use growth::Growth;
pub use growth::{GrowthError, StrengthRow};
pub use individual::Individual;
pub use locks::{LockError, LockReport, LockTarget};
pub use locks::{held_by, lock, lock_of, unlock};
pub(crate) use parts::ROOT;
pub use parts::{JOINT_PREFIX, MimoBodies, MimoJoints, joint_part};
pub use placement::held_posture;
pub use scene::{build_model, build_scene, strength_table};
pub use scores::BodyScores;
pub use sources::{Mark, SourcedConstant};
pub use standards::{GrowthStandard, Lms};
pub(crate) use third::CHEST;
#[cfg(feature = "eval")]
pub(crate) use third::VersionAssets;
pub use version::{EYES, Version};
