//! A second infant in a custom scene: the library's documents with other names.

use quick_xml::Writer;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use crate::config::{Config, Learner};
use crate::mimo::document::{actuators, include};
use crate::mimo::version::{MIMO, SECOND_PREFIX, Version};

/// Prefix of the names of his files.
const FILE: &str = "other_";
/// The body that places the second infant in the world.
const LOCATION: &str = "other_location";
/// Attributes that name, or refer to, something of the infant himself; both infants share classes and materials.
const NAMES: [&str; 12] = [
    "name", "joint", "joint1", "joint2", "body1", "body2", "site", "body", "geom1", "geom2", "tendon1", "tendon2",
];
/// Files that both infants share.
const SHARED: [&str; 5] = ["looks", "classes_common", "classes_v1", "classes_v2", "settings"];

/// Returns the body that places the learner in the world.
pub(crate) fn location(learner: Learner) -> &'static str {
    match learner {
        Learner::Mimo => MIMO,
        Learner::Other => LOCATION,
    }
}

/// Writes the bodies of both infants, and the second one's settings and actuators. The learner is the one without a prefix.
pub(super) fn written(config: &Config) -> [(&'static str, String); 4] {
    let body = format!("mimo_{}", Version::of(config.behavior).name());
    let other = format!("{FILE}{body}");
    let (first, second) = match config.learner {
        Learner::Mimo => (&body, &other),
        Learner::Other => (&other, &body),
    };
    let meta = format!("{FILE}meta_{}", Version::of(config.behavior).name());
    let driven = actuators(config).replace("file=\"", &format!("file=\"{FILE}"));
    [
        ("mimo.xml", include(first)),
        ("other_mimo.xml", include(second)),
        ("other_mimo_settings.xml", include(&meta)),
        ("other_mimo_actuators.xml", driven),
    ]
}

/// Returns the library's file from which a file of the second infant is made.
pub(super) fn original(name: &str) -> Option<&str> {
    name.strip_prefix(FILE)
}

/// Renames everything in a document of the library. `None` if it is not XML; the library's documents always are.
pub(super) fn renamed(document: &[u8]) -> Option<Vec<u8>> {
    let text = std::str::from_utf8(document).ok()?;
    let mut reader = Reader::from_str(text);
    let mut writer = Writer::new(Vec::with_capacity(document.len() + document.len() / 8));
    loop {
        let event = match reader.read_event().ok()? {
            Event::Eof => return Some(writer.into_inner()),
            Event::Start(start) => Event::Start(element(&start)?),
            Event::Empty(start) if start.name().as_ref() == "include" => match included(&start)? {
                Some(start) => Event::Empty(start),
                None => continue,
            },
            Event::Empty(start) => Event::Empty(element(&start)?),
            other => other,
        };
        writer.write_event(event).ok()?;
    }
}

/// Renames an element and its references.
fn element(start: &BytesStart<'_>) -> Option<BytesStart<'static>> {
    let mut out = BytesStart::new(start.name().as_ref().to_string());
    for attribute in start.attributes() {
        let mut attribute = attribute.ok()?;
        if NAMES.contains(&attribute.key.as_ref()) {
            attribute.value = format!("{SECOND_PREFIX}{}", attribute.value).into();
        }
        out.push_attribute(attribute);
    }
    Some(out)
}

/// Makes an include refer to the second infant's file. Returns `None` if it is malformed, `Some(None)` for files both infants share.
fn included(start: &BytesStart<'_>) -> Option<Option<BytesStart<'static>>> {
    let attribute = start.attributes().next()?.ok()?;
    let file = &*attribute.value;
    if SHARED.iter().any(|shared| file.strip_suffix(".xml") == Some(shared)) {
        return Some(None);
    }
    let mut out = BytesStart::new("include");
    out.push_attribute(("file", format!("{FILE}{file}").as_str()));
    Some(Some(out))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_references_are_renamed_and_classes_are_not() {
        let text = "<mujocoinclude><include file=\"looks.xml\"/><include file=\"senses_v1.xml\"/><body name=\"hip\" childclass=\"mimo\">\
                    <geom class=\"toe\" material=\"skin\"/></body><motor joint=\"robot:a\"/></mujocoinclude>";
        let renamed = renamed(text.as_bytes()).expect("it is XML");
        assert_eq!(
            String::from_utf8(renamed).expect("text"),
            "<mujocoinclude><include file=\"other_senses_v1.xml\"/><body name=\"other:hip\" childclass=\"mimo\">\
             <geom class=\"toe\" material=\"skin\"/></body><motor joint=\"other:robot:a\"/></mujocoinclude>"
        );
        assert!(super::renamed(b"<body").is_none() || super::renamed(b"\xff").is_none());
    }
}
