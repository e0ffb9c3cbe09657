//! XML text -> one tree, with includes spliced in. Knows nothing of MJCF but `include`.

use std::collections::BTreeSet;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::assets::{AssetSource, directory, resolve};
use super::error::{ErrorKind, LoadError, Place};
use super::{MAX_ATTRIBUTES, MAX_DEPTH, MAX_DOCUMENT_BYTES, MAX_ELEMENTS, MAX_INCLUDE_DEPTH};

/// An element. Children may come from other files, the parent is the one in its own file.
pub(super) struct Node {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<usize>,
    depth: usize,
    file: usize,
    line: usize,
    column: usize,
    parent: Option<usize>,
}

/// All elements of a document and its includes, by index.
#[derive(Default)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    files: Vec<String>,
}

impl Tree {
    /// Reads the main document and everything it includes. Returns the tree and its root.
    pub fn read(text: &str, path: &str, source: &dyn AssetSource) -> Result<(Tree, usize), LoadError> {
        let mut reading = Reading {
            tree: Tree::default(),
            source,
            // MuJoCo resolves every reference against the main document, also those in included files.
            dir: directory(path).to_owned(),
            included: BTreeSet::from([path.to_owned()]),
            bytes: 0,
        };
        let root = reading.file(text, path, 0, 0)?;
        Ok((reading.tree, root))
    }

    /// An error at an element.
    pub fn error(&self, at: usize, kind: impl Into<ErrorKind>) -> LoadError {
        LoadError {
            place: Box::new(self.place(at)),
            kind: kind.into(),
        }
    }

    fn place(&self, at: usize) -> Place {
        let Some(node) = self.nodes.get(at) else {
            return Place::default();
        };
        let mut names = vec![node.name.as_str()];
        let mut up = node.parent;
        while let Some(parent) = up.and_then(|index| self.nodes.get(index)) {
            names.push(&parent.name);
            up = parent.parent;
        }
        names.reverse();
        Place {
            file: self.files[node.file].clone(),
            line: node.line,
            column: node.column,
            element: names.join("/"),
        }
    }
}

struct Reading<'s> {
    tree: Tree,
    source: &'s dyn AssetSource,
    dir: String,
    included: BTreeSet<String>,
    bytes: usize,
}

impl Reading<'_> {
    /// Parses one file and splices its includes. `depth` is the nesting depth of the element it stands for.
    fn file(&mut self, text: &str, path: &str, depth: usize, level: usize) -> Result<usize, LoadError> {
        self.bytes = self.bytes.saturating_add(text.len());
        if self.bytes > MAX_DOCUMENT_BYTES {
            let kind = ErrorKind::TooMuch {
                what: "bytes of XML in all",
                limit: MAX_DOCUMENT_BYTES,
            };
            return Err(LoadError::in_file(path, kind));
        }
        let first = self.tree.nodes.len();
        self.tree.files.push(path.to_owned());
        let root = parse(&mut self.tree, text, depth)?;
        let last = self.tree.nodes.len();
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

    /// Replaces the includes among the children of an element by the children of the roots they name.
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
            return Err(self.tree.error(child, ErrorKind::UnknownElement(name)));
        }
        if let Some((name, _)) = node.attributes.iter().find(|(name, _)| name != "file") {
            return fail(ErrorKind::UnknownAttribute(name.clone()));
        }
        let Some((_, file)) = node.attributes.first() else {
            return fail(ErrorKind::MissingAttribute("file"));
        };
        if level > MAX_INCLUDE_DEPTH {
            return fail(ErrorKind::TooMuch {
                what: "nested includes",
                limit: MAX_INCLUDE_DEPTH,
            });
        }
        let path = resolve(&self.dir, file).map_err(|e| self.tree.error(at, e))?;
        if self.included.contains(&path) {
            return fail(ErrorKind::RepeatedInclude(path));
        }
        let bytes = self.source.read(&path).map_err(|e| self.tree.error(at, e))?;
        let text = std::str::from_utf8(&bytes).map_err(|_| LoadError::in_file(&path, ErrorKind::NotUtf8))?;
        self.included.insert(path.clone());
        let root = self.file(text, &path, depth, level)?;
        // The root of an included file only holds its children; what else it says would be lost.
        match self.tree.nodes[root]
            .attributes
            .iter()
            .find(|(name, _)| name != "model")
        {
            Some((name, _)) => Err(self.tree.error(root, ErrorKind::UnknownAttribute(name.clone()))),
            None => Ok(root),
        }
    }
}

/// Turns byte offsets, which only grow, into lines and columns.
struct Cursor<'t> {
    text: &'t str,
    offset: usize,
    line: usize,
    column: usize,
}

impl Cursor<'_> {
    fn advance(&mut self, offset: u64) {
        let offset = usize::try_from(offset).unwrap_or(usize::MAX).min(self.text.len());
        for byte in self.text.as_bytes().get(self.offset..offset).unwrap_or_default() {
            if *byte == b'\n' {
                self.line += 1;
                self.column = 1;
            } else if byte & 0xC0 != 0x80 {
                // Continuation bytes belong to the character before.
                self.column += 1;
            }
        }
        self.offset = offset.max(self.offset);
    }
}

/// Parses the text of the last file of the tree. Keeps its own stack, so depth costs no stack.
fn parse(tree: &mut Tree, text: &str, base_depth: usize) -> Result<usize, LoadError> {
    let file = tree.files.len() - 1;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = Reader::from_str(text);
    let mut cursor = Cursor {
        text,
        offset: 0,
        line: 1,
        column: 1,
    };
    let mut open: Vec<usize> = Vec::new();
    let mut root = None;
    loop {
        cursor.advance(reader.buffer_position());
        let event = reader.read_event();
        let fail = |tree: &Tree, cursor: &Cursor, kind: ErrorKind| {
            let mut place = open.last().map_or_else(Place::default, |&at| tree.place(at));
            place.file.clone_from(&tree.files[file]);
            (place.line, place.column) = (cursor.line, cursor.column);
            Err(LoadError {
                place: Box::new(place),
                kind,
            })
        };
        let (start, closed) = match event {
            Ok(Event::Start(start)) => (start, false),
            Ok(Event::Empty(start)) => (start, true),
            Ok(Event::End(_)) => {
                open.pop();
                continue;
            }
            Ok(Event::Eof) => {
                if !open.is_empty() {
                    return fail(tree, &cursor, ErrorKind::Xml("the file ends inside an element".into()));
                }
                return match root {
                    Some(root) => Ok(root),
                    None => fail(tree, &cursor, ErrorKind::Xml("there is no root element".into())),
                };
            }
            Ok(Event::Comment(_) | Event::Decl(_)) => continue,
            Ok(Event::Text(content)) if content.trim().is_empty() => continue,
            Ok(Event::Text(_) | Event::GeneralRef(_)) => return fail(tree, &cursor, ErrorKind::Forbidden("text")),
            Ok(Event::CData(_)) => return fail(tree, &cursor, ErrorKind::Forbidden("a CDATA section")),
            Ok(Event::PI(_)) => return fail(tree, &cursor, ErrorKind::Forbidden("a processing instruction")),
            Ok(Event::DocType(_)) => return fail(tree, &cursor, ErrorKind::Forbidden("a document type")),
            Err(error) => {
                cursor.advance(reader.error_position());
                return fail(tree, &cursor, ErrorKind::Xml(error.to_string()));
            }
        };
        let depth = base_depth + open.len() + 1;
        if depth > MAX_DEPTH {
            return fail(
                tree,
                &cursor,
                ErrorKind::TooMuch {
                    what: "nested elements",
                    limit: MAX_DEPTH,
                },
            );
        }
        if tree.nodes.len() >= MAX_ELEMENTS {
            return fail(
                tree,
                &cursor,
                ErrorKind::TooMuch {
                    what: "elements",
                    limit: MAX_ELEMENTS,
                },
            );
        }
        if open.is_empty() && root.is_some() {
            return fail(tree, &cursor, ErrorKind::Xml("there is a second root element".into()));
        }
        let at = tree.nodes.len();
        tree.nodes.push(Node {
            name: start.name().as_ref().to_owned(),
            attributes: Vec::new(),
            children: Vec::new(),
            depth,
            file,
            line: cursor.line,
            column: cursor.column,
            parent: open.last().copied(),
        });
        match attributes(&start) {
            Ok(found) => tree.nodes[at].attributes = found,
            Err(kind) => return Err(tree.error(at, kind)),
        }
        match open.last() {
            Some(&parent) => tree.nodes[parent].children.push(at),
            None => root = Some(at),
        }
        if !closed {
            open.push(at);
        }
    }
}

fn attributes(start: &BytesStart) -> Result<Vec<(String, String)>, ErrorKind> {
    let mut found: Vec<(String, String)> = Vec::new();
    // The check for duplicates is ours: with the limit it cannot become quadratic in the size of the file.
    for attribute in start.attributes().with_checks(false) {
        let attribute = attribute.map_err(|e| ErrorKind::Xml(e.to_string()))?;
        let name: &str = attribute.key.as_ref();
        if found.len() >= MAX_ATTRIBUTES {
            return Err(ErrorKind::TooMuch {
                what: "attributes of an element",
                limit: MAX_ATTRIBUTES,
            });
        }
        if found.iter().any(|(other, _)| other == name) {
            return Err(ErrorKind::DuplicateAttribute(name.to_owned()));
        }
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(|e| ErrorKind::Xml(e.to_string()))?;
        found.push((name.to_owned(), value.into_owned()));
    }
    Ok(found)
}
