//! XML text -> one tree, with includes spliced in. Knows nothing of MJCF but `include`.

use std::collections::BTreeSet;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::error::{ErrorKind, LoadError, Place};
use crate::assets::{AssetSource, directory, resolve};
use crate::limits::Limits;

/// An element. Children may come from other files, the parent is the one in its own file.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<usize>,
    depth: usize,
    file: usize,
    line: usize,
    column: usize,
    parent: Option<usize>,
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
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    /// Elements that this document may contain.
    pub limits: Limits,
    files: Vec<String>,
}

impl Tree {
    /// Reads the main document and everything it includes. Returns the tree and its root.
    pub fn read(text: &str, path: &str, source: &dyn AssetSource, limits: &Limits) -> Result<(Tree, usize), LoadError> {
        let mut reading = Reading {
            tree: Tree {
                nodes: Vec::new(),
                limits: limits.clone(),
                files: Vec::new(),
            },
            source,
            // MuJoCo resolves every reference against the main document, also those in included files.
            dir: directory(path).to_owned(),
            included: BTreeSet::from([path.to_owned()]),
            bytes: 0,
        };
        let root = reading.file(text, path, 0, 0)?;
        Ok((reading.tree, root))
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

    /// Returns the file of an element.
    pub fn file(&self, at: usize) -> &str {
        &self.files[self.nodes[at].file]
    }

    /// Returns the place of an element.
    pub fn place(&self, at: usize) -> Place {
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

    #[cfg(feature = "eval")]
    /// Appends the element `root` and all below it to `out`, one tag a line. `replace` may give an attribute of an element
    /// another value.
    pub fn write<E>(
        &self,
        root: usize,
        out: &mut String,
        mut replace: impl FnMut(&str, &str, &str) -> Result<Option<String>, E>,
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

    #[cfg(feature = "eval")]
    fn write_start<E>(
        &self,
        at: usize,
        out: &mut String,
        replace: &mut impl FnMut(&str, &str, &str) -> Result<Option<String>, E>,
    ) -> Result<(), E> {
        let node = &self.nodes[at];
        out.push_str(&format!("<{}", node.name));
        for (name, value) in &node.attributes {
            let other = replace(&node.name, name, value)?;
            let value = quick_xml::escape::escape(other.as_deref().unwrap_or(value));
            out.push_str(&format!(" {name}=\"{value}\""));
        }
        out.push_str(if node.children.is_empty() { "/>\n" } else { ">\n" });
        Ok(())
    }
}

#[cfg(feature = "eval")]
fn indent(out: &mut String, depth: usize) {
    out.extend(std::iter::repeat_n("  ", depth));
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
        if level > self.tree.limits.include_depth {
            return fail(ErrorKind::TooMuch {
                what: "nested includes",
                limit: self.tree.limits.include_depth,
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
struct Parser<'t> {
    tree: &'t mut Tree,
    file: usize,
    /// Nesting depth of the element that the file stands for.
    base_depth: usize,
    cursor: Cursor<'t>,
    open: Vec<usize>,
    root: Option<usize>,
}

impl<'t> Parser<'t> {
    fn new(tree: &'t mut Tree, text: &'t str, base_depth: usize) -> Self {
        let cursor = Cursor {
            text: text.strip_prefix('\u{feff}').unwrap_or(text),
            offset: 0,
            line: 1,
            column: 1,
        };
        Parser {
            file: tree.files.len() - 1,
            tree,
            base_depth,
            cursor,
            open: Vec::new(),
            root: None,
        }
    }

    /// Builds an error at the cursor.
    fn fail(&self, kind: ErrorKind) -> LoadError {
        let mut place = self.open.last().map_or_else(Place::default, |&at| self.tree.place(at));
        place.file.clone_from(&self.tree.files[self.file]);
        (place.line, place.column) = (self.cursor.line, self.cursor.column);
        LoadError {
            place: Box::new(place),
            kind,
        }
    }

    /// Returns the root of the file.
    fn run(mut self) -> Result<usize, LoadError> {
        let mut reader = Reader::from_str(self.cursor.text);
        loop {
            self.cursor.advance(reader.buffer_position());
            match reader.read_event() {
                Ok(Event::Start(start)) => {
                    let at = self.element(&start)?;
                    self.open.push(at);
                }
                Ok(Event::Empty(start)) => {
                    self.element(&start)?;
                }
                Ok(Event::End(_)) => {
                    self.open.pop();
                }
                Ok(Event::Eof) => return self.end(),
                Ok(Event::Comment(_) | Event::Decl(_)) => {}
                Ok(Event::Text(content)) if content.trim().is_empty() => {}
                // as in MuJoCo, text within elements says nothing
                Ok(Event::Text(content)) if !self.open.is_empty() && !content.contains('\0') => {}
                Ok(Event::GeneralRef(_)) if !self.open.is_empty() => {}
                Ok(Event::Text(_) | Event::GeneralRef(_)) => return Err(self.fail(ErrorKind::Forbidden("text"))),
                Ok(Event::CData(_)) => return Err(self.fail(ErrorKind::Forbidden("a CDATA section"))),
                Ok(Event::PI(_)) => return Err(self.fail(ErrorKind::Forbidden("a processing instruction"))),
                Ok(Event::DocType(_)) => return Err(self.fail(ErrorKind::Forbidden("a document type"))),
                Err(error) => {
                    self.cursor.advance(reader.error_position());
                    return Err(self.fail(ErrorKind::Xml(error.to_string())));
                }
            }
        }
    }

    fn end(&self) -> Result<usize, LoadError> {
        let broken = |message: &str| self.fail(ErrorKind::Xml(message.to_owned()));
        if !self.open.is_empty() {
            return Err(broken("the file ends inside an element"));
        }
        self.root.ok_or_else(|| broken("there is no root element"))
    }

    /// Adds an element to the tree.
    fn element(&mut self, start: &BytesStart) -> Result<usize, LoadError> {
        let limits = &self.tree.limits;
        let depth = self.base_depth + self.open.len() + 1;
        let too_much = |what, limit| Err(self.fail(ErrorKind::TooMuch { what, limit }));
        if depth > limits.depth {
            return too_much("nested elements", limits.depth);
        }
        if self.tree.nodes.len() >= limits.elements {
            return too_much("elements", limits.elements);
        }
        if self.open.is_empty() && self.root.is_some() {
            return Err(self.fail(ErrorKind::Xml("there is a second root element".into())));
        }
        let at = self.tree.nodes.len();
        let found = attributes(start, limits.attributes);
        self.tree.nodes.push(Node {
            name: start.name().as_ref().to_owned(),
            attributes: Vec::new(),
            children: Vec::new(),
            depth,
            file: self.file,
            line: self.cursor.line,
            column: self.cursor.column,
            parent: self.open.last().copied(),
        });
        self.tree.nodes[at].attributes = found.map_err(|kind| self.tree.error(at, kind))?;
        match self.open.last() {
            Some(&parent) => self.tree.nodes[parent].children.push(at),
            None => self.root = Some(at),
        }
        Ok(at)
    }
}

fn attributes(start: &BytesStart, limit: usize) -> Result<Vec<(String, String)>, ErrorKind> {
    let mut found: Vec<(String, String)> = Vec::new();
    // The check for duplicates is ours: with the limit it cannot become quadratic in the size of the file.
    for attribute in start.attributes().with_checks(false) {
        let attribute = attribute.map_err(|e| ErrorKind::Xml(e.to_string()))?;
        let name: &str = attribute.key.as_ref();
        if found.len() >= limit {
            return Err(ErrorKind::TooMuch {
                what: "attributes of an element",
                limit,
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
