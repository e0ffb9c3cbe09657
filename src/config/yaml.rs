//! The way from YAML text to a [`Config`], through the table of keys.
//!
//! The parser hands over one event at a time and anything but a flat mapping of scalars ends the reading at once, so
//! neither nesting nor aliases can grow.

use super::error::{self, Location};
use super::keys::{KEYS, Key, Misfit};
use super::{Config, ConfigError};
use granit_parser::{Event, Marker, Options, Parser, ScalarStyle, ScanError};

/// Line and column, both counted from 1.
pub(super) type Position = (u32, u32);

/// Overwrites `config` with the keys of the text; returns where the value of each key of [`KEYS`] stands.
pub(super) fn read(text: &str, file: &str, config: &mut Config) -> Result<Vec<Option<Position>>, ConfigError> {
    let mut reader = Reader {
        file,
        events: parser(text),
    };
    reader.start()?;
    let mut positions = vec![None; KEYS.len()];
    while let Some((index, value)) = reader.entry(&positions)? {
        let key = &KEYS[index];
        let parsed = key.kind.parse(&value.text, value.plain);
        let misfit = match parsed {
            Ok(new) if key.assign(config, &new) => None,
            Ok(_) => Some(Misfit::WrongType),
            Err(misfit) => Some(misfit),
        };
        if let Some(misfit) = misfit {
            let written = error::shown(&value.text);
            let written = if value.plain {
                written
            } else {
                format!("'{written}' in quotes")
            };
            return Err(refusal(key, misfit, written, reader.location(value.position)));
        }
        positions[index] = Some(value.position);
    }
    reader.end()?;
    Ok(positions)
}

/// Creates the error for a value that does not fit its key.
pub(super) fn refusal(key: &'static Key, misfit: Misfit, value: String, location: Location) -> ConfigError {
    let (key, expected) = (key.name, key.kind.expected());
    match misfit {
        Misfit::Missing => ConfigError::MissingValue {
            location,
            key,
            expected,
        },
        Misfit::WrongType => ConfigError::WrongType {
            location,
            key,
            value,
            expected,
        },
        Misfit::OutOfRange { nearest } => ConfigError::OutOfRange {
            location,
            key,
            value,
            expected,
            nearest,
        },
    }
}

struct Scalar {
    text: String,
    plain: bool,
    position: Position,
}

type Events<'t> = Parser<'t, granit_parser::StrInput<'t>>;

fn parser(text: &str) -> Events<'_> {
    let mut options = Options::default();
    options.set_emit_comments(false);
    Parser::new_from_str_with_options(text.strip_prefix('\u{feff}').unwrap_or(text), options)
}

struct Reader<'t> {
    file: &'t str,
    events: Events<'t>,
}

impl<'t> Reader<'t> {
    fn location(&self, position: Position) -> Location {
        Location {
            file: self.file.to_string(),
            position: Some(position),
        }
    }

    fn unsupported<T>(&self, position: Position, what: &str) -> Result<T, ConfigError> {
        Err(ConfigError::Unsupported {
            location: self.location(position),
            what: what.to_string(),
        })
    }

    fn next(&mut self) -> Result<(Event<'t>, Position), ConfigError> {
        match self.events.next() {
            Some(Ok((event, span))) => Ok((event, position(&span.start))),
            Some(Err(error)) => Err(self.syntax(&error)),
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

    /// Goes to the first key.
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

    /// Reads the next key, as an index into [`KEYS`], and its value; `None` after the last.
    fn entry(&mut self, seen: &[Option<Position>]) -> Result<Option<(usize, Scalar)>, ConfigError> {
        let name = match self.next()? {
            (Event::MappingEnd, _) => return Ok(None),
            (Event::Scalar(name, _, anchor, tag), at) => {
                self.bare(anchor, tag.is_some(), at)?;
                Scalar {
                    text: name.into_owned(),
                    plain: true,
                    position: at,
                }
            }
            (Event::Alias(_), at) => return self.unsupported(at, "an alias"),
            (_, at) => return self.unsupported(at, "a key that is itself a list or mapping"),
        };
        let Some(index) = KEYS.iter().position(|key| key.name == name.text) else {
            let nearest = error::nearest(&name.text, KEYS.iter().map(|key| key.name));
            let location = self.location(name.position);
            return Err(ConfigError::UnknownKey {
                location,
                key: error::shown(&name.text),
                nearest,
            });
        };
        if let Some((first_line, _)) = seen[index] {
            let location = self.location(name.position);
            return Err(ConfigError::DuplicateKey {
                location,
                key: KEYS[index].name,
                first_line,
            });
        }
        let nested = match self.next()? {
            (Event::Scalar(text, style, anchor, tag), at) => {
                self.bare(anchor, tag.is_some(), at)?;
                let plain = style == ScalarStyle::Plain;
                return Ok(Some((
                    index,
                    Scalar {
                        text: text.into_owned(),
                        plain,
                        position: at,
                    },
                )));
            }
            (Event::Alias(_), at) => return self.unsupported(at, "an alias"),
            (Event::SequenceStart(..), at) => ("a list", at),
            (_, at) => ("a mapping", at),
        };
        Err(refusal(
            &KEYS[index],
            Misfit::WrongType,
            nested.0.to_string(),
            self.location(nested.1),
        ))
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
    fn bare(&self, anchor: usize, tagged: bool, at: Position) -> Result<(), ConfigError> {
        match (anchor, tagged) {
            (0, false) => Ok(()),
            (0, true) => self.unsupported(at, "a tag (`!`)"),
            _ => self.unsupported(at, "an anchor (`&`)"),
        }
    }
}

fn position(mark: &Marker) -> Position {
    let narrow = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    (narrow(mark.line()), narrow(mark.col() + 1))
}
