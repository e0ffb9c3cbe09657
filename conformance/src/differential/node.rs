//! A small tree of XML elements, in which documents are generated and reduced.

use std::fmt;

use serde::{Deserialize, Serialize};

/// An element with its attributes and the elements in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Node {
    /// Its name.
    pub name: String,
    /// Its attributes, in the order of the text.
    pub attributes: Vec<(String, String)>,
    /// The elements in it.
    pub children: Vec<Node>,
}

impl Node {
    /// Creates an element without attributes.
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            attributes: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Returns the element with one more attribute.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<String>) -> Self {
        self.set(name, value);
        self
    }

    /// Sets an attribute.
    pub fn set(&mut self, name: &str, value: impl Into<String>) {
        let value = value.into();
        match self.attributes.iter_mut().find(|(other, _)| other == name) {
            Some((_, old)) => *old = value,
            None => self.attributes.push((name.to_owned(), value)),
        }
    }

    /// Returns an attribute.
    pub fn get(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(other, _)| other == name);
        found.map(|(_, value)| value.as_str())
    }

    /// Removes an attribute.
    pub fn unset(&mut self, name: &str) {
        self.attributes.retain(|(other, _)| other != name);
    }

    /// Adds an element at the end, unless it is an empty section.
    pub fn push_section(&mut self, section: Node) {
        if !section.children.is_empty() {
            self.children.push(section);
        }
    }

    /// Returns the number of elements, this one included.
    pub fn count(&self) -> usize {
        1 + self.children.iter().map(Node::count).sum::<usize>()
    }

    /// Returns element `k` in the order of the text; this one is 0.
    pub fn nth_mut(&mut self, k: usize) -> Option<&mut Node> {
        let mut k = k;
        self.find_nth(&mut k)
    }

    fn find_nth(&mut self, k: &mut usize) -> Option<&mut Node> {
        if *k == 0 {
            return Some(self);
        }
        *k -= 1;
        self.children.iter_mut().find_map(|child| child.find_nth(k))
    }

    /// Removes element `k` in the order of the text, with its contents; this one, 0, stays.
    pub fn remove_nth(&mut self, k: usize) {
        let mut k = k;
        self.remove_below(&mut k);
    }

    fn remove_below(&mut self, k: &mut usize) -> bool {
        let mut at = 0;
        while at < self.children.len() {
            *k -= 1;
            if *k == 0 {
                self.children.remove(at);
                return true;
            }
            if self.children[at].remove_below(k) {
                return true;
            }
            at += 1;
        }
        false
    }

    /// Visits all elements with the names of those above them and their own, outermost first.
    pub fn visit<'a>(&'a self, above: &mut Vec<&'a str>, see: &mut impl FnMut(&[&str], &'a Node)) {
        above.push(&self.name);
        see(above, self);
        for child in &self.children {
            child.visit(above, see);
        }
        above.pop();
    }

    /// Reads a document of elements and attributes, as this module writes them: comments are skipped, text between the
    /// elements too.
    ///
    /// # Errors
    /// The text is not such a document. The message quotes the unexpected part.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut open: Vec<Node> = Vec::new();
        let mut rest = text;
        while let Some(start) = rest.find('<') {
            rest = &rest[start..];
            if let Some(comment) = rest.strip_prefix("<!--") {
                rest = comment.split_once("-->").map_or("", |(_, after)| after);
                continue;
            }
            let end = rest.find('>').ok_or("a tag without an end")?;
            let (tag, after) = (&rest[1..end], &rest[end + 1..]);
            rest = after;
            if tag.starts_with(['?', '!']) {
                continue;
            }
            let closed = tag.ends_with('/') || tag.starts_with('/');
            if !tag.starts_with('/') {
                open.push(Self::parse_tag(tag.trim_end_matches('/'))?);
            }
            if closed && let Some(done) = open.pop() {
                match open.last_mut() {
                    Some(parent) => parent.children.push(done),
                    None => return Ok(done),
                }
            }
        }
        Err("the document ends too early".to_owned())
    }

    fn parse_tag(tag: &str) -> Result<Self, String> {
        let (name, mut rest) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
        let mut node = Self::new(name);
        while let Some((name, after)) = rest.split_once('=') {
            let after = after.trim_start();
            let quote = after.chars().next().filter(|c| "\"'".contains(*c));
            let quote = quote.ok_or_else(|| format!("no quotes after {}", name.trim()))?;
            let (value, after) = after[1..].split_once(quote).ok_or("quotes without an end")?;
            node.attributes.push((name.trim().to_owned(), value.to_owned()));
            rest = after;
        }
        Ok(node)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>, depth: usize) -> fmt::Result {
        write!(f, "{:indent$}<{}", "", self.name, indent = 2 * depth)?;
        for (name, value) in &self.attributes {
            write!(f, " {name}=\"{value}\"")?;
        }
        if self.children.is_empty() {
            return writeln!(f, "/>");
        }
        writeln!(f, ">")?;
        for child in &self.children {
            child.write(f, depth + 1)?;
        }
        writeln!(f, "{:indent$}</{}>", "", self.name, indent = 2 * depth)
    }
}

impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, 0)
    }
}
