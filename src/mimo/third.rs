//! MIMo 3, whose chest is a separate body with two joints.
//!
//! The folder `mimo3` of the assets has the documents in which MIMo 3 differs from MIMo 2. They replace documents of the same
//! name, so that scenes, rooms and tasks include the same files for both. Everything else is MIMo 2's.

use std::borrow::Cow;

use quick_xml::Writer;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::embedded;
use crate::assets::{AssetError, AssetSource, resolve};
use crate::config::{Compat, Config};

/// The version of MIMo that has a chest.
pub(crate) const CHEST: u32 = 3;
/// Folder of the documents that MIMo 3 replaces.
const FOLDER: &str = "babybench/";
/// Folders of MIMo 3's documents, in the order in which they are searched: under `compat: reference` also the first, which has the
/// original's contact rules and no locks of the chest.
const FOLDERS: [&str; 2] = ["mimo3/reference/", "mimo3/"];
/// Documents with MIMo's body, whose geoms all have names in MIMo 3.
const BODY: [&str; 6] = [
    "mimo_v1",
    "mimo_v2",
    "head_v2",
    "right_arm_v2",
    "left_arm_v2",
    "legs_v2",
];

/// The assets of a configuration's version of MIMo.
#[derive(Clone, Debug)]
pub(crate) struct VersionAssets<A> {
    given: A,
    /// Folders whose documents replace others; none for MIMo 2.
    folders: &'static [&'static str],
}

impl<A: AssetSource> VersionAssets<A> {
    /// Wraps the assets of a configuration. Documents of MIMo 3 that they lack are the library's.
    pub fn new(config: &Config, given: A) -> Self {
        let folders: &'static [&'static str] = match (config.mimo_version, config.compat) {
            (CHEST, Compat::Reference) => &FOLDERS,
            (CHEST, Compat::Api) => &FOLDERS[1..],
            _ => &[],
        };
        Self { given, folders }
    }

    /// Reads MIMo 3's document of a name; `None` if it is MIMo 2's.
    fn replaced(&self, name: &str) -> Option<Result<Cow<'_, [u8]>, AssetError>> {
        self.folders.iter().find_map(|folder| {
            let path = format!("{folder}{name}");
            match self.given.read(&path) {
                Err(AssetError::NotFound(_)) => {
                    let library = embedded();
                    let own = library.read(&path).ok()?.into_owned();
                    Some(Ok(Cow::Owned(own)))
                }
                answer => Some(answer),
            }
        })
    }
}

impl<A: AssetSource> AssetSource for VersionAssets<A> {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let inside = if self.folders.is_empty() {
            None
        } else {
            resolve("", path).ok()
        };
        let Some(name) = inside.as_deref().and_then(|path| path.strip_prefix(FOLDER)) else {
            return self.given.read(path);
        };
        let document = self.replaced(name).unwrap_or_else(|| self.given.read(path))?;
        let is_body = name.strip_suffix(".xml").is_some_and(|name| BODY.contains(&name));
        // the loader refuses a document that is not XML
        let named = if is_body { with_geom_names(&document) } else { None };
        Ok(named.map_or(document, Cow::Owned))
    }

    fn contains(&self, path: &str) -> bool {
        // every document of MIMo 3 replaces one
        self.given.contains(path)
    }

    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        self.given.resolve(dir, file)
    }
}

/// Names unnamed geoms after their body and their number in it, from 1: `geom:left_hand2`. `None` if the document is not XML.
fn with_geom_names(document: &[u8]) -> Option<Vec<u8>> {
    let text = std::str::from_utf8(document).ok()?;
    let mut reader = Reader::from_str(text);
    let mut writer = Writer::new(Vec::with_capacity(document.len() + document.len() / 4));
    // names of the bodies around the current place, and how many geoms each has so far
    let mut bodies: Vec<(String, usize)> = Vec::new();
    loop {
        let event = match reader.read_event().ok()? {
            Event::Eof => return Some(writer.into_inner()),
            Event::Start(start) if start.name().as_ref() == "body" => {
                bodies.push((name_of(&start)?.unwrap_or_default(), 0));
                Event::Start(start)
            }
            Event::End(end) if end.name().as_ref() == "body" => {
                bodies.pop();
                Event::End(end)
            }
            Event::Empty(start) if start.name().as_ref() == "geom" => Event::Empty(named_geom(start, &mut bodies)?),
            Event::Start(start) if start.name().as_ref() == "geom" => Event::Start(named_geom(start, &mut bodies)?),
            other => other,
        };
        writer.write_event(event).ok()?;
    }
}

/// Counts a geom, and names it if it has no name.
fn named_geom<'a>(mut start: BytesStart<'a>, bodies: &mut [(String, usize)]) -> Option<BytesStart<'a>> {
    if let Some((body, count)) = bodies.last_mut() {
        *count += 1;
        if name_of(&start)?.is_none() && !body.is_empty() {
            start.push_attribute(("name", format!("geom:{body}{count}").as_str()));
        }
    }
    Some(start)
}

/// Returns the name of an element, which may have none. The outer `None` is for attributes that are not XML.
fn name_of(start: &BytesStart<'_>) -> Option<Option<String>> {
    for attribute in start.attributes() {
        let attribute = attribute.ok()?;
        if attribute.key.as_ref() == "name" {
            return Some(Some(attribute.value.to_string()));
        }
    }
    Some(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn geoms_are_named_after_their_bodies() {
        let text = "<mujocoinclude><geom/><body name=\"a\"><geom size=\"1\"/><body name=\"b\"><geom/></body><geom name=\"own\"/>\
                    <geom/></body></mujocoinclude>";
        let named = with_geom_names(text.as_bytes()).expect("it is XML");
        assert_eq!(
            String::from_utf8(named).expect("text"),
            "<mujocoinclude><geom/><body name=\"a\"><geom size=\"1\" name=\"geom:a1\"/><body name=\"b\"><geom name=\"geom:b1\"/></body>\
             <geom name=\"own\"/><geom name=\"geom:a3\"/></body></mujocoinclude>"
        );
    }

    #[test]
    fn documents_of_mimo_3_replace_those_of_the_same_name() {
        let read = |config: &Config, name: &str| {
            let assets = VersionAssets::new(config, embedded());
            assets
                .read(&format!("{FOLDER}{name}"))
                .expect("a document")
                .into_owned()
        };
        let two = Config::default();
        let three = Config {
            mimo_version: CHEST,
            ..Config::default()
        };
        let has_chest = |document: Vec<u8>| String::from_utf8(document).expect("text").contains("chest");
        for name in [
            "mimo_v1.xml",
            "mimo_v2.xml",
            "motor_body.xml",
            "position_body.xml",
            "senses_trunk.xml",
        ] {
            assert!(!has_chest(read(&two, name)) && has_chest(read(&three, name)), "{name}");
        }
        assert_eq!(read(&two, "looks.xml"), read(&three, "looks.xml"));
        let reference = Config {
            compat: Compat::Reference,
            ..three.clone()
        };
        assert_ne!(read(&reference, "senses_trunk.xml"), read(&three, "senses_trunk.xml"));
    }
}
