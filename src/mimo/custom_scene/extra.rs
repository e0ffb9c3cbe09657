//! Additions to a scene of the library, as text.

use quick_xml::events::Event;
use quick_xml::reader::Reader;

use super::CustomSceneError;
use crate::mjcf_loader::Location;

/// Name of the text in errors.
pub(super) const SHOWN: &str = "scene_extra";
/// Elements of the world.
const WORLD: [&str; 6] = ["body", "geom", "site", "camera", "light", "frame"];
/// Elements of which a whole document consists.
const ROOTS: [&str; 2] = ["mujoco", "mujocoinclude"];

/// A text of elements, converted to a document that can be included.
pub(super) struct ExtraElements {
    pub document: String,
    inserted: Vec<InsertedText>,
}

/// Characters that were added to the text.
struct InsertedText {
    /// Line and column of the text that follows them.
    line: usize,
    column: usize,
    length: usize,
}

impl ExtraElements {
    /// Makes a document from a text: elements of the world go into the world, and sections remain sections.
    ///
    /// The loader reports faults of the text, so nothing is an error here.
    pub fn new(text: &str) -> Self {
        let mut extra = Self {
            document: String::with_capacity(text.len() + 64),
            inserted: Vec::new(),
        };
        let tops = top_elements(text);
        if tops.first().is_some_and(|(_, name)| ROOTS.contains(&name.as_str())) {
            extra.document.push_str(text);
            return extra;
        }
        let (mut done, mut open) = (0, false);
        extra.insert(text, 0, "<mujocoinclude>");
        for (at, name) in tops {
            let world = WORLD.contains(&name.as_str());
            if world != open {
                extra.document.push_str(&text[done..at]);
                done = at;
                extra.insert(text, at, if world { "<worldbody>" } else { "</worldbody>" });
                open = world;
            }
        }
        extra.document.push_str(&text[done..]);
        extra.document.push_str(if open {
            "</worldbody></mujocoinclude>"
        } else {
            "</mujocoinclude>"
        });
        extra
    }

    fn insert(&mut self, text: &str, at: usize, what: &str) {
        let before = &text[..at];
        let last = before.rsplit('\n').next().unwrap_or_default();
        self.inserted.push(InsertedText {
            line: before.matches('\n').count() + 1,
            column: last.chars().count() + 1,
            length: what.len(),
        });
        self.document.push_str(what);
    }

    /// Maps a position in the document to one in the text.
    pub fn locate(&self, place: &mut Location) {
        place.file = SHOWN.to_string();
        for inserted in self.inserted.iter().filter(|i| i.line == place.line) {
            if place.column >= inserted.column + inserted.length {
                place.column -= inserted.length;
            }
        }
    }
}

/// Refuses text outside elements, which would add nothing.
pub(super) fn check(text: &str) -> Result<(), CustomSceneError> {
    let mut reader = Reader::from_str(text);
    let mut depth = 0_usize;
    loop {
        let at = reader.buffer_position() as usize;
        match reader.read_event() {
            Ok(Event::Start(_)) => depth += 1,
            Ok(Event::End(_)) => depth = depth.saturating_sub(1),
            Ok(Event::Text(found)) if depth == 0 => {
                let found: &str = &found;
                let stray = found.trim();
                if stray.is_empty() {
                    continue;
                }
                let before = text.get(..at).unwrap_or_default();
                let lead = &found[..found.len() - found.trim_start().len()];
                let before = format!("{before}{lead}");
                return Err(CustomSceneError::Stray {
                    line: before.matches('\n').count() + 1,
                    column: before.rsplit('\n').next().unwrap_or_default().chars().count() + 1,
                    text: stray.to_string(),
                });
            }
            // text that is not XML is left to the loader
            Ok(Event::Eof) | Err(_) => return Ok(()),
            Ok(_) => {}
        }
    }
}

/// Lists the top-level elements by position and name, up to the first text that is not XML.
fn top_elements(text: &str) -> Vec<(usize, String)> {
    let mut reader = Reader::from_str(text);
    let (mut depth, mut found) = (0_usize, Vec::new());
    loop {
        let at = reader.buffer_position() as usize;
        match reader.read_event() {
            Ok(Event::Start(start)) => {
                if depth == 0 {
                    found.push((at, start.name().as_ref().to_string()));
                }
                depth += 1;
            }
            Ok(Event::Empty(start)) if depth == 0 => found.push((at, start.name().as_ref().to_string())),
            Ok(Event::End(_)) => depth = depth.saturating_sub(1),
            Ok(Event::Eof) | Err(_) => break,
            Ok(_) => {}
        }
    }
    found.retain(|(at, _)| text.is_char_boundary(*at));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_the_world_are_put_into_it_and_places_stay() {
        let text = "<body name='a'/> <geom/>\n<!-- more -->\n<asset/> <light/>";
        let extra = ExtraElements::new(text);
        assert_eq!(
            extra.document,
            "<mujocoinclude><worldbody><body name='a'/> <geom/>\n<!-- more -->\n</worldbody><asset/> \
             <worldbody><light/></worldbody></mujocoinclude>"
        );
        let lines: Vec<&str> = extra.document.lines().collect();
        for (what, line, column) in [
            ("<body", 1, 1),
            ("<geom/>", 1, 18),
            ("<asset/>", 3, 1),
            ("<light/>", 3, 10),
        ] {
            let found = lines[line - 1].find(what).expect("it is there") + 1;
            let mut place = Location {
                line,
                column: found,
                ..Location::default()
            };
            extra.locate(&mut place);
            assert_eq!((place.column, place.file.as_str()), (column, "scene_extra"), "{what}");
        }
        assert_eq!(
            ExtraElements::new("<mujocoinclude><asset/></mujocoinclude>")
                .inserted
                .len(),
            0
        );
        assert_eq!(ExtraElements::new("").document, "<mujocoinclude></mujocoinclude>");
        for text in [
            "",
            " \n",
            "<!-- none -->",
            "<geom/> <site/>",
            "<body> text </body>",
            "<body",
        ] {
            assert_eq!(check(text).map_err(|e| e.to_string()), Ok(()), "{text}");
        }
        for (text, line, column, stray) in [
            ("ball.xml", 1, 1, "ball.xml"),
            ("<geom/>\n  ball.xml <geom/>", 2, 3, "ball.xml"),
        ] {
            let wanted = (line, column, stray.to_string());
            assert!(
                matches!(check(text), Err(CustomSceneError::Stray { line, column, text }) if (line, column, &text) == (wanted.0, wanted.1, &wanted.2)),
                "{text}"
            );
        }
        // errors are left to the loader
        for broken in ["<body", "</body>", "&<geom/>", "\u{e4}<geom/>\u{0}", "<geom></body>"] {
            ExtraElements::new(broken);
        }
    }
}
