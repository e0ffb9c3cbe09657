//! Copies bodies of other documents with everything that belongs to them.

use std::collections::BTreeSet;

use super::document::{Document, ElementNode};
use super::element_id::ElementId;
use super::error::EditError;
use super::kinds::{Kind, references, referred};
use crate::compile::stem;
use crate::schema::DEFAULT;

const ABSENT: &str = "something there refers to the body and to an element that is not attached, by a name that this document has as well, which \
     MuJoCo 3.3.0 may take for it: rename that, or attach the body that is meant";

/// The prefix and the suffix of names.
#[derive(Clone, Copy)]
pub(super) struct Naming<'a> {
    prefix: &'a str,
    suffix: &'a str,
}

impl Naming<'_> {
    pub fn apply(self, name: &str) -> String {
        format!("{}{name}{}", self.prefix, self.suffix)
    }

    fn is_none(self) -> bool {
        self.prefix.is_empty() && self.suffix.is_empty()
    }
}

/// Kinds that `<attach>` copies if everything that they refer to is copied, in the order in which they may refer to each other, with their
/// section.
const REFERRING: [(Kind, &str); 6] = [
    (Kind::Pair, "contact"),
    (Kind::Exclude, "contact"),
    (Kind::Tendon, "tendon"),
    (Kind::Equality, "equality"),
    (Kind::Actuator, "actuator"),
    (Kind::Sensor, "sensor"),
];
/// Kinds that are copied as they are, with their section.
const COPIED: [(Kind, &str); 6] = [
    (Kind::Texture, "asset"),
    (Kind::Material, "asset"),
    (Kind::Mesh, "asset"),
    (Kind::HField, "asset"),
    (Kind::Numeric, "custom"),
    (Kind::Text, "custom"),
];

impl Document {
    /// Copies a body of another document, with its contents, into a body, a frame or the world of this one, as MuJoCo's `<attach>` does. The source
    /// may also be a frame, or the world, whose contents come as a new frame. Returns the copy.
    ///
    /// With the body come its default classes, all assets, and the contact pairs, excludes, tendons, equality constraints, actuators and
    /// sensors that refer to nothing else. All names get `prefix` before and `suffix` behind them. If the angles of one document are in
    /// degrees and those of the other in radians, this document is in radians afterwards. Options and statistics are not copied.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::Unattachable`]: keyframes with values, or elements that make others (`composite`, `attach`);
    /// [`EditError::DuplicateName`]; [`EditError::Settings`]: `compiler` gives numbers another meaning; [`EditError::Inherited`].
    pub fn attach(
        &mut self,
        parent: ElementId,
        other: &Document,
        body: ElementId,
        prefix: &str,
        suffix: &str,
    ) -> Result<ElementId, EditError> {
        let naming = Naming { prefix, suffix };
        let holds = |node: &ElementNode| !node.in_class && node.rule.children.iter().any(|rule| rule.name == "body");
        let above = self.node(parent)?;
        if !holds(above) {
            return Err(EditError::Unattachable(
                "bodies are attached to bodies, frames and the world",
            ));
        }
        other.node(body)?;
        let kind = other.kind_at(body.0);
        if body != other.world() && !matches!(kind, Some(Kind::Body | Kind::Frame)) {
            return Err(EditError::Unattachable(
                "only bodies, frames and the world of another document can be attached",
            ));
        }
        self.check_settings(other)?;
        self.check_keys()?;
        other.check_keys()?;
        // an error leaves the document as it was
        let mut whole = self.clone();
        let mut from = std::borrow::Cow::Borrowed(other);
        if whole.in_degrees() != from.in_degrees() {
            whole.to_radians()?;
            from.to_mut().to_radians()?;
        }
        let new = whole.take(parent.0, &from, body.0, naming)?;
        *self = whole;
        Ok(ElementId(new))
    }

    fn check_keys(&self) -> Result<(), EditError> {
        let states = ["qpos", "qvel", "act", "ctrl", "mpos", "mquat"];
        let mut keys = self.all(Kind::Key).into_iter();
        if keys.any(|id| states.iter().any(|state| self.nodes[id.0].attribute(state).is_some())) {
            return Err(EditError::Unattachable(
                "a document has keyframes, whose states have as many numbers as it has joints: remove them first, and add them again",
            ));
        }
        Ok(())
    }

    fn take(&mut self, parent: usize, from: &Document, body: usize, naming: Naming) -> Result<usize, EditError> {
        let mut names = from.names_below(body, naming)?;
        let taken = |(kind, name): &(Kind, String)| self.find(*kind, &naming.apply(name)).is_some();
        if let Some((kind, name)) = names.iter().find(|name| taken(name)) {
            let (kind, name) = (kind.name(), naming.apply(name));
            return Err(EditError::DuplicateName { kind, name });
        }
        let classes = self.adopt_classes(from, naming)?;
        let new = if from.nodes[body].parent == Some(0) {
            let frame = self.add(ElementId(parent), "frame")?;
            // the world of a document may be in several sections
            let worlds = from.nodes[0].children.iter().map(|&at| &from.nodes[at]);
            let worlds = worlds.filter(|node| node.rule.name == "worldbody");
            for &child in worlds.flat_map(|world| &world.children) {
                self.copy(from, child, frame.0, naming, classes);
            }
            frame.0
        } else {
            self.copy(from, body, parent, naming, classes)
        };
        if classes {
            let class = from.childclass_around(Some(body)).unwrap_or(super::values::MAIN);
            self.nodes[new].put("childclass", naming.apply(class));
        }
        self.take_assets(from, naming, classes, &names)?;
        // `check_absent` must not take what this loop copies for elements of this document
        let before = self.clone();
        for (kind, section) in REFERRING {
            for id in from.all(kind) {
                if !from.refers_within(id.0, kind, naming, &names) {
                    before.check_absent(from, id.0, kind, naming, &names)?;
                    continue;
                }
                if let Some(name) = from.nodes[id.0].attribute("name").filter(|name| !name.is_empty()) {
                    names.insert((kind, name.to_owned()));
                }
                let section = self.section(section)?;
                self.copy(from, id.0, section.0, naming, classes);
            }
        }
        Ok(new)
    }

    /// Returns the kinds and names of a body and its contents.
    fn names_below(&self, body: usize, naming: Naming) -> Result<BTreeSet<(Kind, String)>, EditError> {
        let mut names = BTreeSet::new();
        let mut open = match self.nodes[body].parent {
            Some(0) => self.nodes[0].children.clone(),
            _ => vec![body],
        };
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if node.parent == Some(0) && node.rule.name != "worldbody" {
                continue;
            }
            match node.rule.name {
                "composite" | "attach" => {
                    return Err(EditError::Unattachable(
                        "the body has a <composite> or an <attach> in it, whose elements exist only when the document is compiled",
                    ));
                }
                "replicate" if !naming.suffix.is_empty() => {
                    return Err(EditError::Unattachable(
                        "the body has a <replicate> in it, whose copies are numbered at the end of their names: use a prefix alone",
                    ));
                }
                _ => {}
            }
            open.extend(&node.children);
            if let (Some(kind), Some(name)) = (self.kind_at(at), node.attribute("name").filter(|name| !name.is_empty()))
            {
                names.insert((kind, name.to_owned()));
            }
        }
        Ok(names)
    }

    /// Returns the references of an element and its parts.
    fn all_references(&self, at: usize) -> Vec<(Kind, &str)> {
        let node = &self.nodes[at];
        let parts = std::iter::once(node).chain(node.children.iter().map(|&at| &self.nodes[at]));
        parts
            .flat_map(references)
            .filter(|(kind, ..)| !matches!(kind, Kind::Class | Kind::Material))
            .map(|(kind, _, name)| (kind, name))
            .collect()
    }

    /// Checks an element of another document that is not copied. MuJoCo 3.3.0 looks for the missing reference under its new name, and also as written
    /// if another reference of the element is copied. It must not find anything in this document by chance.
    fn check_absent(
        &self,
        from: &Document,
        at: usize,
        kind: Kind,
        naming: Naming,
        names: &BTreeSet<(Kind, String)>,
    ) -> Result<(), EditError> {
        let named = from.all_references(at);
        let has = |(kind, name): &(Kind, &str)| names.contains(&(*kind, (*name).to_owned()));
        let loose = !matches!(kind, Kind::Equality | Kind::Actuator);
        let some = loose && named.iter().any(has);
        for (kind, name) in named.iter().filter(|one| !has(one)) {
            let found = |name: &str| self.find(*kind, name).is_some();
            if found(&naming.apply(name)) || some && found(name) {
                return Err(EditError::Unattachable(ABSENT));
            }
        }
        Ok(())
    }

    /// Returns whether everything that an element, or a part of it, refers to is copied.
    fn refers_within(&self, at: usize, kind: Kind, naming: Naming, names: &BTreeSet<(Kind, String)>) -> bool {
        let node = &self.nodes[at];
        let named = self.all_references(at);
        // without a side site, MuJoCo 3.3.0 does not find the renamed geom that a tendon wraps around
        let bare = |at: &usize| self.nodes[*at].rule.name == "geom" && self.nodes[*at].attribute("sidesite").is_none();
        if kind == Kind::Tendon && !naming.is_none() && node.children.iter().any(bare) {
            return false;
        }
        let has = |(kind, name): &(Kind, &str)| names.contains(&(*kind, (*name).to_owned()));
        let loose = !matches!(kind, Kind::Equality | Kind::Actuator);
        let world = naming.is_none() || loose && named.iter().any(has);
        named
            .iter()
            .all(|one| has(one) || world && *one == (Kind::Body, "world"))
    }

    fn take_assets(
        &mut self,
        from: &Document,
        naming: Naming,
        classes: bool,
        names: &BTreeSet<(Kind, String)>,
    ) -> Result<(), EditError> {
        for (kind, section) in COPIED {
            for id in from.all(kind) {
                let node = &from.nodes[id.0];
                let name = stem(node.attribute("name").unwrap_or_default(), node.attribute("file"));
                let name = if name.is_empty() {
                    String::new()
                } else {
                    naming.apply(name)
                };
                let before = self.find(kind, &name);
                let section = self.section(section)?;
                let new = self.copy(from, id.0, section.0, naming, classes);
                if !name.is_empty() {
                    self.nodes[new].put("name", name.clone());
                }
                match before {
                    Some(old) if self.written(old.0) == self.written(new) => self.remove_alone(ElementId(new))?,
                    Some(_) => {
                        return Err(EditError::DuplicateName {
                            kind: kind.name(),
                            name,
                        });
                    }
                    None => {}
                }
            }
        }
        for id in from.all(Kind::Skin) {
            let node = &from.nodes[id.0];
            let bone = |at: &usize| from.nodes[*at].attribute("body").unwrap_or_default().to_owned();
            if node
                .children
                .iter()
                .map(bone)
                .all(|name| names.contains(&(Kind::Body, name)))
            {
                let section = self.section("asset")?;
                let new = self.copy(from, id.0, section.0, naming, classes);
                // MuJoCo 3.3.0 gives the name of a skin no prefix
                if let Some(name) = node.attribute("name") {
                    self.nodes[new].put("name", name.to_owned());
                }
            }
        }
        Ok(())
    }

    /// Copies an element of another document with its contents, under its names here.
    pub(super) fn copy(&mut self, from: &Document, at: usize, parent: usize, naming: Naming, classes: bool) -> usize {
        let first = self.push(parent, from.nodes[at].rule, usize::MAX);
        let mut open = vec![(at, first)];
        while let Some((at, new)) = open.pop() {
            let node = &from.nodes[at];
            let copied = &mut self.nodes[new];
            copied.in_class = node.in_class;
            for (name, text) in &node.attributes {
                let class_name = node.rule.name == DEFAULT && *name == "class";
                let named = *name == "name" && !node.in_class || class_name;
                let renamed = match referred(node, name) {
                    _ if text.is_empty() => None,
                    // the world has the same name in every document
                    Some(Kind::Body) if text == "world" => None,
                    Some(_) => Some(naming.apply(text)),
                    None => named.then(|| naming.apply(text)),
                };
                copied.put(name, renamed.unwrap_or_else(|| text.clone()));
            }
            // what takes its defaults from the main class of its document, and stands in no body
            let in_body = from.kind_at(at).is_some_and(Kind::in_bodies);
            let takes = classes && !in_body && node.attr("class").is_some() && node.rule.name != DEFAULT;
            if takes && node.attribute("class").is_none() {
                copied.put("class", naming.apply(super::values::MAIN));
            }
            for (name, file) in self.renamed_files(from, node) {
                self.nodes[new].put(name, file);
            }
            for &child in &node.children {
                let rule = from.nodes[child].rule;
                let copy = self.push(new, rule, usize::MAX);
                open.push((child, copy));
            }
        }
        first
    }

    /// Returns an element with its contents as text.
    pub(super) fn written(&self, at: usize) -> String {
        let node = &self.nodes[at];
        let mut attributes: Vec<String> = node
            .attributes
            .iter()
            .map(|(name, text)| format!("{name}={text:?}"))
            .collect();
        attributes.sort();
        let children: String = node.children.iter().map(|&at| self.written(at)).collect();
        format!("{} {} [{children}]", node.rule.name, attributes.join(" "))
    }
}
