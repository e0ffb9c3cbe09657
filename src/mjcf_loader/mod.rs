//! MJCF text -> compiled [`Model`].
//!
//! Three stages, each its own type: a tree of XML elements with includes spliced in, a typed document with default
//! classes applied and references by name, and the [`Model`] with MuJoCo 3.3.0's ids and units. Nothing here knows
//! physics: constants that follow from the dynamics (`*_invweight0` and the statistics a document does not give) stay 0
//! until [`crate::physics`] fills them.
//!
//! What is understood is what the models of this project and the original BabyBench files use; the elements and
//! attributes stand in one table (`tables.rs`). Everything else is an error that names the place. Ignored are only the
//! memory reservations in `size` and the matrix format `jacobian`, which change no result; and contact cones are elliptic
//! also where a document leaves `cone` out, where MuJoCo's would be pyramidal.
//!
//! Text may come from anywhere. Whatever it says, loading ends with a model or a [`LoadError`]; the limits below bound
//! stack and memory.
//!
//! ```
//! use babybench::mjcf_loader::{MemoryAssets, load_str};
//! let text = r#"<mujoco><worldbody><body name="ball"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"#;
//! let model = load_str(text, "ball.xml", &MemoryAssets::new())?;
//! assert_eq!((model.nq, model.nv, model.nbody()), (7, 6, 2));
//! # Ok::<(), babybench::mjcf_loader::LoadError>(())
//! ```

mod assets;
mod body;
mod compile;
mod document;
mod error;
mod geometry;
#[cfg(test)]
mod mutations;
mod read;
mod relation;
mod schema;
mod surface;
mod tables;
#[cfg(test)]
mod tests;
mod xml;

pub use assets::DirAssets;
pub use assets::{AssetError, AssetSource, EmbeddedAssets, MAX_ASSET_BYTES, MemoryAssets, Overlay, resolve};
pub use error::{ErrorKind, LoadError, Place};

use crate::model::Model;

/// Most bytes of XML in a document and its includes.
pub const MAX_DOCUMENT_BYTES: usize = 4 << 20;
/// Most elements in a document and its includes.
pub const MAX_ELEMENTS: usize = 100_000;
/// Most attributes of an element.
pub const MAX_ATTRIBUTES: usize = 64;
/// Deepest nesting of elements, across includes.
pub const MAX_DEPTH: usize = 100;
/// Deepest nesting of includes.
pub const MAX_INCLUDE_DEPTH: usize = 16;
/// Most bytes of a name or any other attribute that is text. Default classes copy them, so they must be short.
pub const MAX_TEXT_BYTES: usize = 256;
/// Most default classes.
pub const MAX_CLASSES: usize = 1000;
/// Largest magnitude of a number. Products of a few numbers stay finite, so everything compiled is finite.
pub const MAX_REAL: f64 = 1e30;
/// Most user values of an actuator.
pub const MAX_USER: usize = 64;

/// Loads the document at `path` in `source`.
///
/// # Errors
/// When a file is missing or anything in it is not understood; see [`ErrorKind`].
pub fn load(source: &dyn AssetSource, path: &str) -> Result<Model, LoadError> {
    let path = resolve("", path).map_err(|e| LoadError::in_file(path, e))?;
    let bytes = source.read(&path).map_err(|e| LoadError::in_file(&path, e))?;
    let text = std::str::from_utf8(&bytes).map_err(|_| LoadError::in_file(&path, ErrorKind::NotUtf8))?;
    load_str(text, &path, source)
}

/// Loads a document given as text, as if it were the file `virtual_path` of `source`: what it includes and the textures
/// it names are looked up relative to the directory of that path.
///
/// # Errors
/// When a file is missing or anything in it is not understood; see [`ErrorKind`].
pub fn load_str(xml: &str, virtual_path: &str, source: &dyn AssetSource) -> Result<Model, LoadError> {
    let path = resolve("", virtual_path).map_err(|e| LoadError::in_file(virtual_path, e))?;
    let (tree, root) = xml::Tree::read(xml, &path, source)?;
    let name = &tree.nodes[root].name;
    if name != "mujoco" {
        return Err(tree.error(root, ErrorKind::WrongRoot(name.clone())));
    }
    let checked = schema::check(&tree, root, &tables::MUJOCO)?;
    let document = read::read(&tree, &checked)?;
    compile::compile(&tree, document, source, assets::directory(&path))
}
