//! Reads MJCF text into a [`Spec`], which `compile` of mjcf-sim-physics turns into a `Model`.
//!
//! Three stages, each its own type: a tree of XML elements with includes spliced in, a typed document with default
//! classes applied and references by name, and the [`Spec`] with MuJoCo 3.3.0's ids and units. Nothing here knows
//! physics: quantities that need dynamics (`*_invweight0`, statistics, poses of welds at `qpos0`) come with the last step.
//!
//! The loader understands MuJoCo 3.3.0's language except for plugins and a few elements; [`elements`]
//! lists all elements and attributes. Everything else is an error that names the place. Ignored are only the
//! memory reservations in `size`, the matrix format `jacobian`, and the colours and sizes in `visual` of decorations in MuJoCo's viewer:
//! none changes a compiled array of physics. User data (`user`, `nuser_*`) are kept for programs.
//!
//! Text may come from anywhere: loading ends with a [`Spec`] or a [`LoadError`]; [`Limits`] bound stack
//! and memory.
//!
//! ```
//! use mjcf_sim::assets::MemoryAssets;
//! use mjcf_sim::{mjcf_loader, physics};
//!
//! let text = r#"<mujoco><worldbody><body name="ball"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"#;
//! let spec = mjcf_loader::load_str(text, "ball.xml", &MemoryAssets::new())?;
//! assert_eq!((spec.nq(), spec.nv(), spec.nbody()), (7, 6, 2));
//! let model = physics::compile(spec)?;
//! assert_eq!(model.body("ball").map(|ball| model.body_mass[ball] > 4.0), Some(true));
//! # Ok::<(), mjcf_sim::mjcf_loader::LoadError>(())
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod actuator;
mod attached;
mod attachment;
mod attribute;
mod compile;
mod composite;
mod custom;
mod document;
mod draft;
pub mod edit;
mod elements;
mod error;
mod flex;
mod joint;
mod later;
#[cfg(test)]
mod limit_tests;
mod listing;
mod mesh;
mod read;
mod relation;
mod schema;
mod sensor;
mod settings;
mod skin;
mod spec;
mod surface;
mod table;
#[cfg(test)]
mod tests;
mod words;
mod xml;

pub use compile::bounding_radius;
use compile::volume as geom_volume;
pub use draft::{Draft, DraftActuator, DraftGeom, DraftJoint};
pub use error::{ErrorKind, LoadError, Location};
pub use listing::{AttributeInfo, ElementInfo, elements};
pub use settings::{LengthRange, LengthRangeMode};
pub use spec::Locations;
pub use spec::Spec;
pub use xml::{Node, Tree};

use mjcf_sim_model::assets::AssetSource;
use mjcf_sim_model::limits::Limits;
// Paths of other files of this crate begin with `crate` for these, too.
use mjcf_sim_model::{assets, formats, limits, math, model, text};

/// Loads the document at `path` in `source`.
///
/// # Errors
/// A file that is missing, text that is not understood; see [`ErrorKind`].
#[doc(alias("mj_loadXML", "mj_parseXML"))]
pub fn load(source: &dyn AssetSource, path: &str) -> Result<Spec, LoadError> {
    load_with(source, path, &Limits::default())
}

/// Loads the document at `path` in `source` within the given limits.
///
/// # Errors
/// As [`load`].
pub fn load_with(source: &dyn AssetSource, path: &str, limits: &Limits) -> Result<Spec, LoadError> {
    let path = source.resolve("", path).map_err(|e| LoadError::in_file(path, e))?;
    let bytes = source.read(&path).map_err(|e| LoadError::in_file(&path, e))?;
    let text = xml::text_of(&bytes).map_err(|kind| LoadError::in_file(&path, kind))?;
    load_str_with(&text, &path, source, limits)
}

/// Loads a document given as text, as if it were the file `virtual_path` of `source`.
///
/// Its includes and textures are looked up relative to the directory of that path.
///
/// # Errors
/// As [`load`].
#[doc(alias = "mj_parseXMLString")]
pub fn load_str(xml: &str, virtual_path: &str, source: &dyn AssetSource) -> Result<Spec, LoadError> {
    load_str_with(xml, virtual_path, source, &Limits::default())
}

/// Loads a document given as text, as [`load_str`] does, within the given limits.
///
/// # Errors
/// As [`load`].
pub fn load_str_with(
    xml: &str,
    virtual_path: &str,
    source: &dyn AssetSource,
    limits: &Limits,
) -> Result<Spec, LoadError> {
    Draft::read_str_with(xml, virtual_path, source, limits)?.compile(source)
}
