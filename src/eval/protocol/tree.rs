//! The tree of a YAML document, with line numbers, and readers of its mappings.

use granit_parser::{Event, Options, Parser};

use crate::text::{nearest, quoted};

/// Greatest number of values in a document, and of levels.
const MAX_VALUES: usize = 10_000;
const MAX_LEVELS: usize = 8;

/// A fault of a document: its line, from 1, and what is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub line: u32,
    pub reason: String,
}

/// Returns a fault.
pub(super) fn fault(line: u32, reason: impl Into<String>) -> Fault {
    let reason = reason.into();
    Fault { line, reason }
}

/// A value with the line on which it begins.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub line: u32,
    pub node: Node,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    Text(String),
    List(Vec<Entry>),
    Map(Vec<(String, Entry)>),
}

/// A list or a mapping that is being read.
enum Open {
    List(u32, Vec<Entry>),
    Map(u32, Vec<(String, Entry)>, Option<String>),
}

/// Reads a document whose root is a mapping.
pub(super) fn read(text: &str) -> Result<Entry, Fault> {
    let mut options = Options::default();
    options.set_emit_comments(false);
    let (mut open, mut root, mut values) = (Vec::<Open>::new(), None, 0_usize);
    for event in Parser::new_from_str_with_options(text, options) {
        let (event, span) = event.map_err(|error| {
            let line = u32::try_from(error.marker().line()).unwrap_or(u32::MAX);
            fault(line, format!("not valid YAML: {}", quoted(&error.info())))
        })?;
        let line = u32::try_from(span.start.line()).unwrap_or(u32::MAX);
        values += 1;
        if values > MAX_VALUES || open.len() > MAX_LEVELS {
            let reason = format!("a protocol has at most {MAX_VALUES} values in {MAX_LEVELS} levels");
            return Err(fault(line, reason));
        }
        let done = match event {
            Event::MappingStart(..) => {
                open.push(Open::Map(line, Vec::new(), None));
                continue;
            }
            Event::SequenceStart(..) => {
                open.push(Open::List(line, Vec::new()));
                continue;
            }
            Event::MappingEnd | Event::SequenceEnd => open.pop().map(closed),
            Event::Scalar(value, ..) => {
                let node = Node::Text(value.into_owned());
                Some(Entry { line, node })
            }
            Event::Alias(_) => return Err(fault(line, "a protocol has no aliases; write the value out")),
            _ => None,
        };
        if let Some(entry) = done {
            place(&mut open, &mut root, entry)?;
        }
    }
    match root {
        Some(entry) if matches!(entry.node, Node::Map(_)) => Ok(entry),
        _ => Err(fault(
            1,
            "a protocol is a mapping: keys with values, beginning with `title`",
        )),
    }
}

fn closed(open: Open) -> Entry {
    match open {
        Open::List(line, list) => Entry {
            line,
            node: Node::List(list),
        },
        Open::Map(line, map, _) => Entry {
            line,
            node: Node::Map(map),
        },
    }
}

/// Puts a value into the list or mapping that is being read.
fn place(open: &mut [Open], root: &mut Option<Entry>, entry: Entry) -> Result<(), Fault> {
    match open.last_mut() {
        None => *root = Some(entry),
        Some(Open::List(_, list)) => list.push(entry),
        Some(Open::Map(_, map, key)) => match (key.take(), entry) {
            (Some(key), entry) => map.push((key, entry)),
            (None, entry) => {
                let Node::Text(text) = entry.node else {
                    return Err(fault(entry.line, "a key is a list or a mapping; keys are words"));
                };
                if map.iter().any(|(known, _)| *known == text) {
                    return Err(fault(entry.line, format!("the key `{}` appears twice", quoted(&text))));
                }
                *key = Some(text);
            }
        },
    }
    Ok(())
}

impl Entry {
    /// Returns the text of a single value.
    pub fn text(&self, key: &str) -> Result<&str, Fault> {
        match &self.node {
            Node::Text(text) => Ok(text),
            _ => Err(fault(self.line, format!("`{key}` has a single value"))),
        }
    }

    /// Reads a finite number.
    pub fn number(&self, key: &str) -> Result<f64, Fault> {
        let text = self.text(key)?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| fault(self.line, format!("`{key}` is {:?}; expected a number", quoted(text))))
    }

    /// Returns the values of a list.
    pub fn list(&self, key: &str) -> Result<&[Self], Fault> {
        match &self.node {
            Node::List(list) => Ok(list),
            _ => Err(fault(self.line, format!("`{key}` is a list: {key}: [...]"))),
        }
    }

    /// Reads a list of numbers.
    pub fn numbers(&self, key: &str) -> Result<Vec<f64>, Fault> {
        self.list(key)?.iter().map(|entry| entry.number(key)).collect()
    }

    /// Reads a list of names.
    pub fn names(&self, key: &str) -> Result<Vec<String>, Fault> {
        let names = self.list(key)?.iter();
        names.map(|entry| entry.text(key).map(str::to_string)).collect()
    }

    /// Returns the mapping, to be read key by key.
    pub fn fields(&self, what: &'static str) -> Result<Fields<'_>, Fault> {
        match &self.node {
            Node::Map(entries) => Ok(Fields {
                what,
                line: self.line,
                entries,
                known: Vec::new(),
            }),
            _ => Err(fault(self.line, format!("{what} is a mapping: keys with values"))),
        }
    }
}

/// A mapping that is read key by key.
pub(super) struct Fields<'e> {
    what: &'static str,
    line: u32,
    entries: &'e [(String, Entry)],
    known: Vec<&'static str>,
}

impl<'e> Fields<'e> {
    /// Returns the line on which the mapping begins.
    pub fn line(&self) -> u32 {
        self.line
    }

    /// Returns the value of a key, if the mapping has it.
    pub fn get(&mut self, key: &'static str) -> Option<&'e Entry> {
        self.known.push(key);
        let found = self.entries.iter().find(|(name, _)| name == key);
        found.map(|(_, entry)| entry)
    }

    /// Returns the value of a key that must be there.
    pub fn need(&mut self, key: &'static str) -> Result<&'e Entry, Fault> {
        let (line, what) = (self.line, self.what);
        self.get(key)
            .ok_or_else(|| fault(line, format!("{what} has no `{key}`")))
    }

    /// Returns the text of a key; empty without it.
    pub fn words(&mut self, key: &'static str) -> Result<String, Fault> {
        let entry = self.get(key);
        Ok(entry.map_or(Ok(""), |entry| entry.text(key))?.to_string())
    }

    /// Reads the number of a key.
    pub fn number(&mut self, key: &'static str) -> Result<Option<f64>, Fault> {
        self.get(key).map(|entry| entry.number(key)).transpose()
    }

    /// Reads a whole number from 1 to `most`; 1 without the key.
    pub fn count(&mut self, key: &'static str, most: u32) -> Result<u32, Fault> {
        let Some(entry) = self.get(key) else {
            return Ok(1);
        };
        let number = entry.text(key)?.parse().ok().filter(|n| (1..=most).contains(n));
        number.ok_or_else(|| fault(entry.line, format!("`{key}` is a whole number from 1 to {most}")))
    }

    /// Ends reading.
    ///
    /// # Errors
    /// A key that is not known.
    pub fn end(self) -> Result<(), Fault> {
        let Some((key, entry)) = self
            .entries
            .iter()
            .find(|(name, _)| !self.known.contains(&name.as_str()))
        else {
            return Ok(());
        };
        let hint = nearest(key, self.known.iter().copied());
        let hint = hint.map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
        let reason = format!("{} has no key `{}`{hint}", self.what, quoted(key));
        Err(fault(entry.line, reason))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_know_their_lines() {
        let root = read("a: 1\nb:\n  - {c: x, d: [1, 2]}\n").expect("a tree");
        let mut fields = root.fields("a test").expect("a mapping");
        assert_eq!(fields.number("a"), Ok(Some(1.0)));
        let list = fields.need("b").expect("b").list("b").expect("a list");
        let mut inner = list[0].fields("an entry").expect("a mapping");
        assert_eq!((inner.line(), inner.words("c").as_deref()), (3, Ok("x")));
        assert_eq!(inner.need("d").expect("d").numbers("d"), Ok(vec![1.0, 2.0]));
        assert!(inner.end().is_ok() && fields.end().is_ok());
    }

    #[test]
    fn faults_say_where() {
        for (text, line, part) in [
            ("", 1, "a mapping"),
            ("- a", 1, "a mapping"),
            ("a: 1\na: 2", 2, "twice"),
            ("a: [", 1, "not valid YAML"),
            ("a: &x 1\nb: *x", 2, "aliases"),
            ("[a]: 1", 1, "keys are words"),
            ("a: [[[[[[[[[[1]]]]]]]]]]", 1, "levels"),
        ] {
            let found = read(text).expect_err(text);
            assert!(found.line >= line && found.reason.contains(part), "{text}: {found:?}");
        }
        let root = read("tittle: x").expect("a tree");
        let mut fields = root.fields("a protocol").expect("a mapping");
        assert!(fields.get("title").is_none());
        let found = fields.end().expect_err("an unknown key");
        assert!(found.reason.contains("did you mean `title`"), "{found:?}");
    }
}
