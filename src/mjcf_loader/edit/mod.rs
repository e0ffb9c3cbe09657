//! Documents that a program edits before they are compiled: elements are found, added, changed, removed, and attached from other documents.
//!
//! A [`Document`] is the tree of elements as MJCF has it. Names of elements and attributes, and the values allowed, are those of the tables
//! that documents are read with, so every attribute of the loader is there. A document compiles to the same bits as the text that it
//! writes.
//!
//! ```
//! use mjcf_sim::assets::MemoryAssets;
//! use mjcf_sim::mjcf_loader::edit::{Document, Kind};
//! use mjcf_sim::physics;
//!
//! let assets = MemoryAssets::new();
//! let mut room = Document::new();
//! let toy = room.add(room.world(), "body")?;
//! room.set(toy, "name", "toy")?;
//! room.set(toy, "pos", "0 0 .5")?;
//! room.add(toy, "freejoint")?;
//! let cube = room.add(toy, "geom")?;
//! room.set(cube, "type", "box")?;
//! room.set(cube, "size", ".03 .03 .03")?;
//! assert!(room.set(cube, "frction", "1").unwrap_err().to_string().contains("did you mean \"friction\"?"));
//!
//! // the toy of one room in another
//! let mut other = Document::new();
//! other.attach(other.world(), &room, toy, "second_", "")?;
//! assert!(other.find(Kind::Body, "second_toy").is_some());
//! let model = physics::compile(other.compile(&assets)?)?;
//! assert_eq!((model.nbody(), model.nq), (2, 7));
//! # Ok::<(), mjcf_sim::mjcf_loader::edit::EditError>(())
//! ```

mod attach;
mod classes;
mod document;
mod element_id;
mod error;
mod general;
mod kinds;
mod paths;
mod removal;
mod settings;
#[cfg(test)]
mod tests;
mod text;
mod units;
mod values;

pub use document::Document;
pub use element_id::ElementId;
pub use error::{EditError, SettingsConflict};
pub use kinds::Kind;
