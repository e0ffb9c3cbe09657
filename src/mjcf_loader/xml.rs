//! Reads XML text into one tree, with includes spliced in, and into the trees of the models that it names. Knows nothing of MJCF except `include` and
//! `<asset><model>`.

mod parser;

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::error::{ErrorKind, LoadError, Location};
use crate::assets::{AssetError, AssetSource, directory, is_absolute};
use crate::limits::Limits;
use crate::math::order;
use parser::Parser;

/// An element. Children may come from other files; the parent is in the same file.
#[derive(Clone, Debug)]
pub struct Node {
    /// Name of the element.
    pub name: String,
    /// Names and values of its attributes, in the order of the file.
    pub attributes: Vec<(String, String)>,
    /// Its children, by their index in [`Tree::nodes`].
    pub children: Vec<usize>,
    depth: usize,
    file: usize,
    line: usize,
    column: usize,
    parent: Option<usize>,
    /// Whether there are comments or text in it.
    filled: bool,
}

impl Node {
    /// Returns the text of an attribute, if it is given.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(other, _)| other == name);
        found.map(|(_, text)| text.as_str())
    }
}

/// All elements of a document and its includes, by index.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The elements; the root of the document is the first.
    pub nodes: Vec<Node>,
    /// Maximum number of elements in this document.
    pub limits: Limits,
    files: Vec<String>,
    /// The document and the models that it names; the elements of each follow those of the previous one.
    models: Vec<ModelFile>,
}

/// The document, or a model that an `<asset><model>` names.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// The element that names it; its own root for the document.
    pub of: usize,
    /// Its root element.
    pub root: usize,
    /// The folder of its file.
    pub dir: String,
    /// Index of the model that names it.
    pub within: Option<usize>,
    first: usize,
    path: String,
}

impl Tree {
    /// Reads the main document and everything it includes. Returns the tree and its root.
    pub fn read(text: &str, path: &str, source: &dyn AssetSource, limits: &Limits) -> Result<(Tree, usize), LoadError> {
        let mut reading = FileReader {
            tree: Tree {
                nodes: Vec::new(),
                limits: limits.clone(),
                files: Vec::new(),
                models: Vec::new(),
            },
            source,
            dir: String::new(),
            included: BTreeSet::new(),
            bytes: 0,
        };
        let root = reading.model(text, path, None)?;
        let mut model = 0;
        // models may name further models, which are appended to this list
        while model < reading.tree.models.len() {
            reading.models_of(model)?;
            model += 1;
        }
        Ok((reading.tree, root))
    }

    /// Returns the document and the models that it names.
    pub fn models(&self) -> &[ModelFile] {
        &self.models
    }

    /// Returns the index of the model that an element belongs to; 0 for the document.
    pub fn model_of(&self, at: usize) -> usize {
        // each model is read at once, so its elements are consecutive
        self.models.partition_point(|model| model.first <= at).saturating_sub(1)
    }

    /// Builds an error at an element.
    pub fn error(&self, at: usize, kind: impl Into<ErrorKind>) -> LoadError {
        LoadError {
            place: Box::new(self.place(at)),
            kind: kind.into(),
        }
    }

    /// Returns the paths of the files that were read, the main document first.
    pub fn files(&self) -> &[String] {
        &self.files
    }

    /// Returns the path of a file that an element names, in a folder of its model.
    ///
    /// As in MuJoCo 3.3.0, an element of an included file finds it beside that file, unless it is where MuJoCo looks for it at first:
    /// in the folder `probed`, if there is one.
    ///
    /// # Errors
    /// A path that the source cannot have.
    pub fn named_file(
        &self,
        at: usize,
        file: &str,
        folder: &str,
        probed: Option<&str>,
        source: &dyn AssetSource,
    ) -> Result<String, AssetError> {
        let model = &self.models[self.model_of(at)];
        let within = |folder: &str| match folder.trim_end_matches('/') {
            folder if folder.is_empty() || is_absolute(file) => source.resolve(&model.dir, file),
            folder => source.resolve(&model.dir, &format!("{folder}/{file}")),
        };
        let there = |path: &Result<String, AssetError>| path.as_ref().is_ok_and(|path| source.contains(path));
        if self.file(at) != model.path && probed.is_some_and(|probed| !there(&within(probed))) {
            let beside = source.resolve(directory(self.file(at)), file);
            if there(&beside) {
                return beside;
            }
        }
        within(folder)
    }

    /// Returns the file of an element.
    pub fn file(&self, at: usize) -> &str {
        &self.files[self.nodes[at].file]
    }

    /// Returns the place of an element.
    pub fn place(&self, at: usize) -> Location {
        let Some(node) = self.nodes.get(at) else {
            return Location::default();
        };
        let mut names = vec![node.name.as_str()];
        let mut up = node.parent;
        while let Some(parent) = up.and_then(|index| self.nodes.get(index)) {
            names.push(&parent.name);
            up = parent.parent;
        }
        names.reverse();
        Location {
            file: self.files[node.file].clone(),
            line: node.line,
            column: node.column,
            element: names.join("/"),
        }
    }

    /// Appends the element `root` and everything below it to `out`, one tag per line. `replace` gets an element, an attribute and its value, and may
    /// return another value.
    pub fn write<E>(
        &self,
        root: usize,
        out: &mut String,
        mut replace: impl FnMut(usize, &str, &str) -> Result<Option<String>, E>,
    ) -> Result<(), E> {
        // elements that are open, with their next child; depth costs no stack
        let mut open: Vec<(usize, usize)> = Vec::new();
        let mut next = Some(root);
        while let Some(at) = next {
            indent(out, open.len());
            self.write_start(at, out, &mut replace)?;
            if !self.nodes[at].children.is_empty() {
                open.push((at, 0));
            }
            next = None;
            while let (None, Some((parent, child))) = (next, open.last_mut()) {
                let node = &self.nodes[*parent];
                next = node.children.get(*child).copied();
                *child += 1;
                if next.is_none() {
                    open.pop();
                    indent(out, open.len());
                    out.push_str(&format!("</{}>\n", node.name));
                }
            }
        }
        Ok(())
    }

    fn write_start<E>(
        &self,
        at: usize,
        out: &mut String,
        replace: &mut impl FnMut(usize, &str, &str) -> Result<Option<String>, E>,
    ) -> Result<(), E> {
        let node = &self.nodes[at];
        out.push_str(&format!("<{}", node.name));
        for (name, value) in &node.attributes {
            let other = replace(at, name, value)?;
            let value = quick_xml::escape::escape(other.as_deref().unwrap_or(value));
            out.push_str(&format!(" {name}=\"{value}\""));
        }
        out.push_str(if node.children.is_empty() { "/>\n" } else { ">\n" });
        Ok(())
    }
}

fn indent(out: &mut String, depth: usize) {
    out.extend(std::iter::repeat_n("  ", depth));
}

/// Returns the text of a file: UTF-8, or Latin-1 if its XML declaration says so.
pub(super) fn text_of(bytes: &[u8]) -> Result<Cow<'_, str>, ErrorKind> {
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Ok(text.into());
    }
    // the declaration alone, which is ASCII in either encoding: the text may well contain these words
    let declaration: Vec<u8> = bytes
        .iter()
        .take(100)
        .take_while(|byte| **byte != b'>')
        .copied()
        .collect();
    let declaration = String::from_utf8_lossy(&declaration).to_ascii_lowercase();
    let latin = ["iso-8859-1", "latin1", "latin-1"]
        .iter()
        .any(|name| declaration.contains(name));
    if declaration.starts_with("<?xml") && latin {
        Ok(bytes.iter().copied().map(char::from).collect())
    } else {
        Err(ErrorKind::NotUtf8)
    }
}

struct FileReader<'s> {
    tree: Tree,
    source: &'s dyn AssetSource,
    dir: String,
    included: BTreeSet<String>,
    bytes: usize,
}

impl FileReader<'_> {
    /// Reads the document, or a model with the element that names it.
    fn model(&mut self, text: &str, path: &str, of: Option<usize>) -> Result<usize, LoadError> {
        let first = self.tree.nodes.len();
        directory(path).clone_into(&mut self.dir);
        // a model may include what the document includes, too
        self.included = order::set([path.to_owned()]);
        let root = self.file(text, path, 0, 0)?;
        self.tree.models.push(ModelFile {
            of: of.unwrap_or(root),
            root,
            dir: self.dir.clone(),
            within: of.map(|of| self.tree.model_of(of)),
            first,
            path: path.to_owned(),
        });
        Ok(root)
    }

    /// Reads the models that a model, or the document, names.
    fn models_of(&mut self, model: usize) -> Result<(), LoadError> {
        let nodes = &self.tree.nodes;
        let root = &nodes[self.tree.models[model].root];
        let assets = root.children.iter().filter(|&&at| nodes[at].name == "asset");
        let named: Vec<usize> = assets
            .flat_map(|&at| &nodes[at].children)
            .copied()
            .filter(|&at| nodes[at].name == "model")
            .collect();
        named.into_iter().try_for_each(|at| self.model_at(at, model))
    }

    fn model_at(&mut self, at: usize, within: usize) -> Result<(), LoadError> {
        let node = &self.tree.nodes[at];
        let Some(file) = node.attribute("file") else {
            return Err(self.tree.error(at, ErrorKind::MissingAttribute("file")));
        };
        let format = node.attribute("content_type");
        let xml = match format {
            Some(format) => format == "text/xml",
            None => file.ends_with(".xml"),
        };
        if !xml {
            let what = "a model is an MJCF document: its file ends with .xml, or content_type is text/xml";
            return Err(self.tree.error(at, ErrorKind::Invalid(what)));
        }
        // MuJoCo looks for models of an included file beside that file only, unlike for other files
        let path = self
            .source
            .resolve(directory(self.tree.file(at)), file)
            .map_err(|e| self.tree.error(at, e))?;
        // a model that names itself, over others or not, would be read without end
        let (mut around, mut depth) = (Some(within), 1);
        while let Some(model) = around {
            if self.tree.models[model].path == path {
                return Err(self.tree.error(at, ErrorKind::ModelInItself(path)));
            }
            (around, depth) = (self.tree.models[model].within, depth + 1);
        }
        let limit = self.tree.limits.include_depth;
        if depth > limit + 1 {
            let what = "models within models";
            return Err(self.tree.error(at, ErrorKind::TooMuch { what, limit }));
        }
        let bytes = self.source.read(&path).map_err(|e| self.tree.error(at, e))?;
        let text = text_of(&bytes).map_err(|kind| LoadError::in_file(&path, kind))?;
        self.model(&text, &path, Some(at)).map(|_| ())
    }

    /// Parses a file and the files that it includes. `depth` is the nesting depth of the element that it replaces.
    fn file(&mut self, text: &str, path: &str, depth: usize, level: usize) -> Result<usize, LoadError> {
        // in total: files within files multiply
        self.bytes = self.bytes.saturating_add(text.len());
        if self.bytes > self.tree.limits.document_bytes {
            let kind = ErrorKind::TooMuch {
                what: "bytes of XML in total",
                limit: self.tree.limits.document_bytes,
            };
            return Err(LoadError::in_file(path, kind));
        }
        let first = self.tree.nodes.len();
        self.tree.files.push(path.to_owned());
        let root = Parser::new(&mut self.tree, text, depth).run()?;
        let last = self.tree.nodes.len();
        // includes in included files were replaced when those files were read
        for at in first..last {
            if self.tree.nodes[at]
                .children
                .iter()
                .any(|&child| self.tree.nodes[child].name == "include")
            {
                self.splice(at, level)?;
            }
        }
        Ok(root)
    }

    /// Replaces the includes among the children of an element by the children of the included roots.
    fn splice(&mut self, at: usize, level: usize) -> Result<(), LoadError> {
        let mut children = Vec::new();
        for child in std::mem::take(&mut self.tree.nodes[at].children) {
            if self.tree.nodes[child].name == "include" {
                let root = self.include(child, level + 1)?;
                children.append(&mut self.tree.nodes[root].children);
            } else {
                children.push(child);
            }
        }
        self.tree.nodes[at].children = children;
        Ok(())
    }

    fn include(&mut self, at: usize, level: usize) -> Result<usize, LoadError> {
        let node = &self.tree.nodes[at];
        let depth = node.depth.saturating_sub(1);
        let fail = |kind: ErrorKind| Err(self.tree.error(at, kind));
        if let Some(&child) = node.children.first() {
            let name = self.tree.nodes[child].name.clone();
            return Err(self
                .tree
                .error(child, ErrorKind::UnknownElement { name, nearest: None }));
        }
        if node.filled {
            let what = "an include is empty: put comments before it";
            return fail(ErrorKind::Invalid(what));
        }
        // MuJoCo looks at no other attribute
        let Some(file) = node.attribute("file") else {
            return fail(ErrorKind::MissingAttribute("file"));
        };
        if level > self.tree.limits.include_depth {
            return fail(ErrorKind::TooMuch {
                what: "nested includes",
                limit: self.tree.limits.include_depth,
            });
        }
        let path = self.included_path(at, file).map_err(|e| self.tree.error(at, e))?;
        if self.included.contains(&path) {
            return fail(ErrorKind::RepeatedInclude(path));
        }
        let bytes = self.source.read(&path).map_err(|e| self.tree.error(at, e))?;
        let text = text_of(&bytes).map_err(|kind| LoadError::in_file(&path, kind))?;
        self.included.insert(path.clone());
        let root = self.file(&text, &path, depth, level)?;
        // only the children of the root are included; MuJoCo looks at none of its attributes
        if self.tree.nodes[root].children.is_empty() {
            let what = "the file has no elements: give it some, or remove what includes it";
            return Err(self.tree.error(root, ErrorKind::Invalid(what)));
        }
        Ok(root)
    }

    /// Returns the path of a file to include: next to the document, or else next to the file that includes it.
    fn included_path(&self, at: usize, file: &str) -> Result<String, AssetError> {
        let within = self.source.resolve(&self.dir, file);
        if within.as_ref().is_ok_and(|path| self.source.contains(path)) {
            return within;
        }
        match self.source.resolve(directory(self.tree.file(at)), file) {
            Ok(beside) if self.source.contains(&beside) => Ok(beside),
            _ => within,
        }
    }
}
