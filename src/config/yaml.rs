//! The way from YAML text to a [`Config`], through the table of keys.
//!
//! The parser hands over one event at a time and anything but a flat mapping of scalars, and of short lists and mappings of them, ends the
//! reading at once, so neither nesting nor aliases can grow.

use super::ages;
use super::error::{self, Location};
use super::kinds::{KeyKind, KeyValue, ValueFault};
use super::table::KEYS;
use super::table::Key;
use super::{Config, ConfigError};
use crate::text::nearest;
use granit_parser::{Event, Marker, Options, Parser, ScalarStyle, ScanError};

/// Line and column, both counted from 1.
pub(super) type LineColumn = (u32, u32);

/// Overwrites `config` with the keys of the text. Returns the position of the value of each key of [`KEYS`].
pub(super) fn read(text: &str, file: &str, config: &mut Config) -> Result<Vec<Option<LineColumn>>, ConfigError> {
    let mut reader = YamlReader {
        file,
        events: parser(text),
    };
    reader.start()?;
    let mut positions = vec![None; KEYS.len()];
    while let Some((index, value, position)) = reader.entry(&mut positions)? {
        // a value that parses may still not convert, when a key's kind and the type of its field differ
        let key = &KEYS[index];
        if !key.assign(config, &value) {
            let location = reader.location(position);
            return Err(refusal(key, ValueFault::WrongType, value.to_yaml(), location));
        }
        positions[index] = Some(position);
    }
    reader.end()?;
    Ok(positions)
}

/// Creates the error for a value that does not fit its key.
pub(super) fn refusal(key: &'static Key, misfit: ValueFault, value: String, location: Location) -> ConfigError {
    let (key, expected) = (key.name, key.kind.expected());
    match misfit {
        ValueFault::Missing => ConfigError::MissingValue {
            location,
            key,
            expected,
        },
        ValueFault::WrongType => ConfigError::WrongType {
            location,
            key,
            value,
            expected,
        },
        ValueFault::OutOfRange { nearest } => ConfigError::OutOfRange {
            location,
            key,
            value,
            expected,
            nearest,
        },
    }
}

type YamlEvents<'t> = Parser<'t, granit_parser::StrInput<'t>>;

fn parser(text: &str) -> YamlEvents<'_> {
    let mut options = Options::default();
    // comments would be events between a key and its value
    options.set_emit_comments(false);
    // editors of Windows write a byte order mark
    Parser::new_from_str_with_options(text.strip_prefix('\u{feff}').unwrap_or(text), options)
}

struct YamlReader<'t> {
    file: &'t str,
    events: YamlEvents<'t>,
}

impl<'t> YamlReader<'t> {
    fn location(&self, position: LineColumn) -> Location {
        Location {
            file: self.file.to_string(),
            position: Some(position),
        }
    }

    fn unsupported<T>(&self, position: LineColumn, what: &str) -> Result<T, ConfigError> {
        Err(ConfigError::Unsupported {
            location: self.location(position),
            what: what.to_string(),
        })
    }

    fn next(&mut self) -> Result<(Event<'t>, LineColumn), ConfigError> {
        match self.events.next() {
            Some(Ok((event, span))) => Ok((event, position(&span.start))),
            Some(Err(error)) => Err(self.syntax(&error)),
            // the parser ends after StreamEnd, which callers have already seen
            None => Ok((Event::StreamEnd, (1, 1))),
        }
    }

    fn syntax(&self, error: &ScanError) -> ConfigError {
        let mark = error.marker();
        let location = self.location(position(mark));
        ConfigError::Syntax {
            location,
            message: format!("not valid YAML: {}", error::shown(&error.info())),
        }
    }

    /// Moves to the first key.
    fn start(&mut self) -> Result<(), ConfigError> {
        loop {
            return match self.next()? {
                (Event::StreamStart | Event::DocumentStart(..), _) => continue,
                (Event::MappingStart(_, anchor, tag), at) => self.bare(anchor, tag.is_some(), at),
                (Event::StreamEnd, at) => self.unsupported(at, "the file is empty"),
                (Event::SequenceStart(..), at) => self.unsupported(at, "the file is a list"),
                (_, at) => self.unsupported(at, "the file is a single value"),
            };
        }
    }

    /// Reads the next key, as an index into [`KEYS`], its value and the value's position; `None` after the last.
    fn entry(&mut self, seen: &mut [Option<LineColumn>]) -> Result<Option<(usize, KeyValue, LineColumn)>, ConfigError> {
        let (name, at) = match self.next()? {
            (Event::MappingEnd, _) => return Ok(None),
            (Event::Scalar(name, _, anchor, tag), at) => {
                self.bare(anchor, tag.is_some(), at)?;
                (name, at)
            }
            (Event::Alias(_), at) => return self.unsupported(at, "an alias"),
            (_, at) => return self.unsupported(at, "a key that is a list or mapping"),
        };
        let Some(index) = KEYS.iter().position(|key| key.name == name) else {
            let nearest = nearest(&name, KEYS.iter().map(|key| key.name));
            let location = self.location(at);
            return Err(ConfigError::UnknownKey {
                location,
                key: error::shown(&name),
                nearest,
            });
        };
        self.refuse_second(index, seen, at)?;
        // the key itself, too: a second `age` is refused even if the first one was a schedule
        seen[index] = Some(at);
        let (value, value_at) = self.value(&KEYS[index])?;
        let own = ages::of_value(index, &value);
        if own != index {
            self.refuse_second(own, seen, at)?;
        }
        Ok(Some((own, value, value_at)))
    }

    /// Refuses a repeated key: PyYAML silently keeps the last one, which hides mistakes.
    fn refuse_second(&self, index: usize, seen: &[Option<LineColumn>], at: LineColumn) -> Result<(), ConfigError> {
        let Some((first_line, _)) = seen[index] else {
            return Ok(());
        };
        Err(ConfigError::DuplicateKey {
            location: self.location(at),
            key: KEYS[index].name,
            first_line,
        })
    }

    /// Reads the value of a key, and its position.
    fn value(&mut self, key: &'static Key) -> Result<(KeyValue, LineColumn), ConfigError> {
        let (event, at) = self.next()?;
        let nested = match event {
            Event::Scalar(text, style, anchor, tag) => {
                self.bare(anchor, tag.is_some(), at)?;
                let plain = style == ScalarStyle::Plain;
                let parsed = key.kind.parse(&text, plain);
                return match parsed {
                    Ok(value) => Ok((value, at)),
                    Err(misfit) => Err(refusal(key, misfit, written(&text, plain), self.location(at))),
                };
            }
            Event::SequenceStart(_, anchor, tag) if matches!(key.kind, KeyKind::List(_) | KeyKind::NoneOrList(_)) => {
                self.bare(anchor, tag.is_some(), at)?;
                return Ok((self.list(key, at)?, at));
            }
            Event::MappingStart(_, anchor, tag) if ages::takes_ages(key) => {
                self.bare(anchor, tag.is_some(), at)?;
                return Ok((self.ages(key, at)?, at));
            }
            Event::Alias(_) => return self.unsupported(at, "an alias"),
            Event::SequenceStart(..) => "a list",
            _ => "a mapping",
        };
        Err(refusal(
            key,
            ValueFault::WrongType,
            nested.to_string(),
            self.location(at),
        ))
    }

    /// Reads the names of a list that starts at `start`.
    fn list(&mut self, key: &'static Key, start: LineColumn) -> Result<KeyValue, ConfigError> {
        let mut names = Vec::new();
        loop {
            let (event, at) = self.next()?;
            let nested = match event {
                Event::Scalar(text, style, anchor, tag) => {
                    self.bare(anchor, tag.is_some(), at)?;
                    if let Err(misfit) = key.kind.parse_item(&text, &mut names) {
                        let written = written(&text, style == ScalarStyle::Plain);
                        return Err(refusal(key, misfit, written, self.location(at)));
                    }
                    continue;
                }
                Event::SequenceEnd => break,
                Event::Alias(_) => return self.unsupported(at, "an alias"),
                Event::SequenceStart(..) => "a list in a list",
                _ => "a mapping in a list",
            };
            return Err(refusal(
                key,
                ValueFault::WrongType,
                nested.to_string(),
                self.location(at),
            ));
        }
        let value = KeyValue::List(names);
        match key.kind.check(&value) {
            Ok(()) => Ok(value),
            Err(misfit) => Err(refusal(key, misfit, value.to_yaml(), self.location(start))),
        }
    }

    /// Reads the ages over steps of a mapping that starts at `start`.
    fn ages(&mut self, key: &'static Key, start: LineColumn) -> Result<KeyValue, ConfigError> {
        let mut text = String::new();
        // a step and an age, in turns
        for separator in [':', ','].into_iter().cycle() {
            let (event, at) = self.next()?;
            let fits = match event {
                Event::Scalar(scalar, _, anchor, tag) => {
                    self.bare(anchor, tag.is_some(), at)?;
                    text.push_str(&scalar);
                    text.push(separator);
                    // the text separates steps and ages by these characters
                    text.len() <= ages::MAX_TEXT && !scalar.contains([':', ','])
                }
                Event::MappingEnd => break,
                Event::Alias(_) => return self.unsupported(at, "an alias"),
                _ => false,
            };
            if !fits {
                let nested = "a mapping of more than numbers".to_string();
                return Err(refusal(key, ValueFault::WrongType, nested, self.location(at)));
            }
        }
        let (text, key) = (text.trim_end_matches(','), ages::schedule());
        let written = error::shown(&format!("{{{text}}}"));
        let parsed = key.kind.parse(text, false);
        parsed.map_err(|_| {
            refusal(
                key,
                ValueFault::OutOfRange { nearest: None },
                written,
                self.location(start),
            )
        })
    }

    /// Makes sure that nothing follows the mapping.
    fn end(&mut self) -> Result<(), ConfigError> {
        loop {
            return match self.next()? {
                (Event::DocumentEnd, _) => continue,
                (Event::StreamEnd, _) => Ok(()),
                (_, at) => self.unsupported(at, "a second document"),
            };
        }
    }

    /// Refuses anchors and tags.
    fn bare(&self, anchor: usize, tagged: bool, at: LineColumn) -> Result<(), ConfigError> {
        match (anchor, tagged) {
            (0, false) => Ok(()),
            (0, true) => self.unsupported(at, "a tag (`!`)"),
            _ => self.unsupported(at, "an anchor (`&`)"),
        }
    }
}

/// Returns a value in the form that errors show.
fn written(text: &str, plain: bool) -> String {
    let text = error::shown(text);
    if plain { text } else { format!("'{text}' in quotes") }
}

fn position(mark: &Marker) -> LineColumn {
    let narrow = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    (narrow(mark.line()), narrow(mark.col() + 1))
}
