//! Parses the text of one file into elements of the tree.

use std::borrow::Cow;

use quick_xml::XmlVersion;
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::{Node, Tree};
use crate::error::{ErrorKind, LoadError, Location};

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

/// Parses the text of the last file of the tree. Keeps its own stack, so nesting does not use the call stack.
pub(super) struct Parser<'t> {
    tree: &'t mut Tree,
    file: usize,
    /// Nesting depth of the element that the file replaces.
    base_depth: usize,
    cursor: Cursor<'t>,
    open: Vec<usize>,
    root: Option<usize>,
}

impl<'t> Parser<'t> {
    pub fn new(tree: &'t mut Tree, text: &'t str, base_depth: usize) -> Self {
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
        let mut place = self
            .open
            .last()
            .map_or_else(Location::default, |&at| self.tree.place(at));
        place.file.clone_from(&self.tree.files[self.file]);
        (place.line, place.column) = (self.cursor.line, self.cursor.column);
        LoadError {
            place: Box::new(place),
            kind,
        }
    }

    /// Returns the root of the file.
    pub fn run(mut self) -> Result<usize, LoadError> {
        let mut reader = Reader::from_str(self.cursor.text);
        // as in MuJoCo, a bare ampersand is not an error
        reader.config_mut().allow_dangling_amp = true;
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
                Ok(Event::Decl(_)) => {}
                Ok(Event::Text(content)) if content.trim().is_empty() => {}
                // as in MuJoCo, text within elements is ignored, and ends at a null character
                Ok(Event::Text(content)) if !self.open.is_empty() && !content.contains('\0') => self.fill(),
                Ok(Event::CData(content)) if !self.open.is_empty() && !content.contains('\0') => self.fill(),
                Ok(Event::Comment(content)) if !content.contains('\0') => self.fill(),
                Ok(Event::GeneralRef(_)) if !self.open.is_empty() => self.fill(),
                // of style sheets and other programs, before the root
                Ok(Event::PI(_)) if self.root.is_none() && self.open.is_empty() => {}
                Ok(Event::DocType(content)) if self.open.is_empty() && !content.contains('[') => {}
                Ok(Event::Comment(_)) => return Err(self.fail(ErrorKind::Forbidden("a null character"))),
                Ok(Event::Text(_) | Event::GeneralRef(_)) => return Err(self.fail(ErrorKind::Forbidden("text"))),
                Ok(Event::CData(_)) => return Err(self.fail(ErrorKind::Forbidden("a CDATA section"))),
                Ok(Event::PI(_)) => return Err(self.fail(ErrorKind::Forbidden("a processing instruction"))),
                Ok(Event::DocType(_)) => return Err(self.fail(ErrorKind::Forbidden("a document type with entities"))),
                Err(error) => {
                    self.cursor.advance(reader.error_position());
                    return Err(self.fail(ErrorKind::Xml(error.to_string())));
                }
            }
        }
    }

    /// Notes that the open element contains more than elements.
    fn fill(&mut self) {
        if let Some(&at) = self.open.last() {
            self.tree.nodes[at].filled = true;
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
            filled: false,
        });
        // only now, because the error gets its place from the node
        self.tree.nodes[at].attributes = found.map_err(|kind| self.tree.error(at, kind))?;
        match self.open.last() {
            Some(&parent) => self.tree.nodes[parent].children.push(at),
            None => self.root = Some(at),
        }
        Ok(at)
    }
}

/// Escapes the ampersands that begin neither one of XML's own entities nor a character reference.
fn escape_ampersands(text: Cow<'_, str>) -> Cow<'_, str> {
    let reference = |behind: &str| {
        let number = |digits: &str, is_digit: fn(&char) -> bool| {
            let end = digits.find(|c| !is_digit(&c)).filter(|&end| end > 0);
            end.is_some_and(|end| digits[end..].starts_with(';'))
        };
        ["amp;", "lt;", "gt;", "quot;", "apos;"]
            .iter()
            .any(|entity| behind.starts_with(entity))
            || behind
                .strip_prefix("#x")
                .is_some_and(|digits| number(digits, char::is_ascii_hexdigit))
            || behind
                .strip_prefix('#')
                .is_some_and(|digits| number(digits, char::is_ascii_digit))
    };
    let mut parts = text.split('&');
    let mut escaped = parts.next().unwrap_or_default().to_owned();
    let mut bare = false;
    for behind in parts {
        let known = reference(behind);
        bare |= !known;
        escaped.push_str(if known { "&" } else { "&amp;" });
        escaped.push_str(behind);
    }
    if bare { escaped.into() } else { text }
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
        // as in MuJoCo, an ampersand that begins no entity of XML is itself
        let attribute = Attribute {
            value: escape_ampersands(attribute.value),
            ..attribute
        };
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(|e| ErrorKind::Xml(e.to_string()))?;
        found.push((name.to_owned(), value.into_owned()));
    }
    Ok(found)
}
