//! Documents as text: reading, writing, compiling.

use super::document::{Document, ROOT};
use super::error::EditError;
use super::paths;
use crate::assets::AssetSource;
use crate::elements::MUJOCO;
use crate::error::{ErrorKind, LoadError};
use crate::later::{self, LaterAttribute};
use crate::limits::Limits;
use crate::schema;
use crate::spec::Spec;
use crate::xml::{Tree, text_of};

impl Document {
    /// Reads the document at `path` in `source`, with its includes.
    ///
    /// # Errors
    /// Those of [`crate::load`], except for faults that only compiling finds.
    pub fn read(source: &dyn AssetSource, path: &str) -> Result<Self, EditError> {
        let path = source.resolve("", path).map_err(|e| LoadError::in_file(path, e))?;
        let bytes = source.read(&path).map_err(|e| LoadError::in_file(&path, e))?;
        let text = text_of(&bytes).map_err(|kind| LoadError::in_file(&path, kind))?;
        Self::read_str(&text, &path, source)
    }

    /// Reads a document given as text, as if it were the file `virtual_path` of `source`.
    ///
    /// # Errors
    /// As [`Document::read`].
    pub fn read_str(xml: &str, virtual_path: &str, source: &dyn AssetSource) -> Result<Self, EditError> {
        let limits = Limits::default();
        let path = source
            .resolve("", virtual_path)
            .map_err(|e| LoadError::in_file(virtual_path, e))?;
        let (tree, root) = Tree::read(xml, &path, source, &limits)?;
        let name = &tree.nodes[root].name;
        if name != MUJOCO.name {
            return Err(tree.error(root, ErrorKind::WrongRoot(name.clone())).into());
        }
        let checked = schema::check(&tree, root, &MUJOCO)?;
        let mut document = Self::empty(path, limits);
        // without the world of an empty document, because the text may have one or several
        document.nodes.truncate(1);
        document.nodes[ROOT].children.clear();
        // elements still to be read, with their place in the document
        let mut open = vec![(&checked, ROOT)];
        while let Some((element, at)) = open.pop() {
            document.nodes[at].attributes = element
                .values()
                .filter_map(|(name, _)| Some((name, element_text(&tree, element.at, name)?)))
                .collect();
            let node = &tree.nodes[element.at];
            paths::rebase(&mut document.nodes[at], &tree, element.at, source);
            debug_assert_eq!(node.children.len(), element.children.len());
            for child in &element.children {
                let rule = document.nodes[at]
                    .rule
                    .children
                    .iter()
                    .find(|rule| rule.name == child.name);
                if let Some(rule) = rule {
                    let new = document.push(at, rule, usize::MAX);
                    open.push((child, new));
                }
            }
        }
        document.world_or_new();
        Ok(document)
    }

    /// Writes the document as MJCF, which loads to the same bits.
    pub fn write(&self) -> String {
        let mut text = String::new();
        // elements that are open, with their next child; depth costs no stack
        let mut open: Vec<(usize, usize)> = Vec::new();
        let mut next = Some(ROOT);
        while let Some(at) = next {
            let node = &self.nodes[at];
            text.extend(std::iter::repeat_n("  ", open.len()));
            text.push_str(&format!("<{}", node.rule.name));
            for (name, value) in &node.attributes {
                text.push_str(&format!(" {name}=\"{}\"", quick_xml::escape::escape(value.as_str())));
            }
            text.push_str(if node.children.is_empty() { "/>\n" } else { ">\n" });
            if !node.children.is_empty() {
                open.push((at, 0));
            }
            next = None;
            while let (None, Some((parent, child))) = (next, open.last_mut()) {
                let node = &self.nodes[*parent];
                next = node.children.get(*child).copied();
                *child += 1;
                if next.is_none() {
                    open.pop();
                    text.extend(std::iter::repeat_n("  ", open.len()));
                    text.push_str(&format!("</{}>\n", node.rule.name));
                }
            }
        }
        text
    }

    /// Compiles what [`Document::write`] writes. Files that it names are looked up in `source`.
    ///
    /// # Errors
    /// As [`crate::load`]; lines are those of the written text.
    pub fn compile(&self, source: &dyn AssetSource) -> Result<Spec, EditError> {
        Ok(crate::load_str(&self.write(), &self.path, source)?)
    }
}

/// Returns the text of an attribute in a file, under its current name.
fn element_text(tree: &Tree, at: usize, name: &'static str) -> Option<String> {
    let node = &tree.nodes[at];
    match node.attribute(name) {
        Some(text) => Some(text.to_owned()),
        None => node.attributes.iter().find_map(|(given, text)| {
            match later::attribute(&node.name, |_| false, given, text) {
                Some(LaterAttribute::As(other, text)) if other == name => Some(text.to_owned()),
                _ => None,
            }
        }),
    }
}
