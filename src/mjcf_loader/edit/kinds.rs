//! Kinds of elements, and the kind that each attribute refers to.

use super::document::{Document, ElementNode};
use super::element_id::ElementId;
use crate::schema::DEFAULT;

/// Defines the kinds, with their names in MJCF.
macro_rules! kinds {
    ($($kind:ident $name:literal $what:literal,)*) => {
        /// A kind of element. Elements of a kind have different names.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Kind {$(
            #[doc = $what]
            $kind,
        )*}

        impl Kind {
            /// All kinds.
            pub const ALL: &'static [Kind] = &[$(Kind::$kind),*];

            /// Returns the name of the kind, for instance `body`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {$(
                    Kind::$kind => $name,
                )*}
            }
        }
    };
}
kinds! {
    Body "body" "Bodies, the world not included.",
    Frame "frame" "Frames.",
    Joint "joint" "Joints, free ones included.",
    Geom "geom" "Geoms.",
    Site "site" "Sites.",
    Camera "camera" "Cameras.",
    Light "light" "Lights.",
    Class "default" "Default classes.",
    Texture "texture" "Textures.",
    Material "material" "Materials.",
    Mesh "mesh" "Meshes.",
    HField "hfield" "Height fields.",
    Skin "skin" "Skins.",
    Pair "pair" "Contact pairs.",
    Exclude "exclude" "Pairs of bodies without contacts.",
    Equality "equality" "Equality constraints.",
    Tendon "tendon" "Tendons.",
    Actuator "actuator" "Actuators.",
    Sensor "sensor" "Sensors.",
    Numeric "numeric" "Numbers for programs.",
    Text "text" "Texts for programs.",
    Tuple "tuple" "Lists of elements for programs.",
    Key "key" "Keyframes.",
}

impl Kind {
    /// Returns the kind with a name, as [`Kind::name`] gives it.
    #[must_use]
    pub fn of(name: &str) -> Option<Kind> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }

    /// Returns whether elements of the kind are in bodies, or are bodies.
    pub(super) fn in_bodies(self) -> bool {
        self <= Kind::Light
    }
}

/// Returns the kind of element for the kind of object in a reference.
fn object(kind: &str) -> Option<Kind> {
    match kind {
        "xbody" => Some(Kind::Body),
        other => Kind::of(other),
    }
}

/// Returns the kind of element that an attribute names; `None` for an attribute that names no element.
pub(super) fn referred(node: &ElementNode, attribute: &str) -> Option<Kind> {
    let kind = match attribute {
        "body" | "body1" | "body2" if node.rule.name != "attach" => Kind::Body,
        "target" => Kind::Body,
        "joint" | "joint1" | "joint2" | "jointinparent" => Kind::Joint,
        "geom" | "geom1" | "geom2" => Kind::Geom,
        "site" | "site1" | "site2" | "cranksite" | "slidersite" | "refsite" | "sidesite" => Kind::Site,
        "tendon" | "tendon1" | "tendon2" => Kind::Tendon,
        "actuator" => Kind::Actuator,
        "camera" => Kind::Camera,
        "material" => Kind::Material,
        "mesh" => Kind::Mesh,
        "hfield" => Kind::HField,
        "texture" => Kind::Texture,
        "objname" => return object(node.attribute("objtype")?),
        "refname" => return object(node.attribute("reftype").unwrap_or("body")),
        "childclass" => Kind::Class,
        "class" if node.rule.name != DEFAULT => Kind::Class,
        _ => return None,
    };
    Some(kind)
}

/// Returns what an element names: the kind, the attribute and the name.
pub(super) fn references(node: &ElementNode) -> impl Iterator<Item = (Kind, &'static str, &str)> {
    let named = node.attributes.iter().filter(|(_, text)| !text.is_empty());
    named.filter_map(|(attribute, text)| Some((referred(node, attribute)?, *attribute, text.as_str())))
}

/// Returns whether an element is meaningless without the element that it names: a constraint, a tendon, an actuator, a sensor or a part
/// of one, but not a geom without its material.
pub(super) fn loses_meaning(document: &Document, at: usize) -> bool {
    let mut up = document.nodes[at].parent;
    while let Some(parent) = up {
        let node = &document.nodes[parent];
        let sections = ["contact", "equality", "tendon", "actuator", "sensor", "custom"];
        let section = node.parent == Some(0) && sections.contains(&node.rule.name);
        if section || node.rule.name == "skin" {
            return true;
        }
        up = node.parent;
    }
    false
}

impl Document {
    /// Returns the kind of an element; `None` for a section or a part of another element.
    pub(super) fn kind_at(&self, at: usize) -> Option<Kind> {
        let node = &self.nodes[at];
        let parent = &self.nodes[node.parent?];
        if node.rule.name == DEFAULT {
            return Some(Kind::Class);
        }
        if node.in_class {
            return None;
        }
        match (parent.rule.name, node.rule.name) {
            ("worldbody" | "body" | "frame" | "replicate", "freejoint") => Some(Kind::Joint),
            ("worldbody" | "body" | "frame" | "replicate", name) => Kind::of(name).filter(|kind| kind.in_bodies()),
            ("equality", _) => Some(Kind::Equality),
            ("tendon", _) => Some(Kind::Tendon),
            ("actuator", _) => Some(Kind::Actuator),
            ("sensor", _) => Some(Kind::Sensor),
            ("asset" | "deformable" | "contact" | "custom" | "keyframe", name) => Kind::of(name),
            _ => None,
        }
    }

    /// Returns the kind of an element; `None` for a section or a part of another element.
    ///
    /// # Errors
    /// [`EditError::NoElement`](super::EditError::NoElement)
    pub fn kind(&self, id: ElementId) -> Result<Option<Kind>, super::EditError> {
        self.node(id).map(|_| self.kind_at(id.0))
    }

    /// Returns all elements of a kind in the order of the compiled model: elements of bodies by their bodies, depth first.
    pub fn all(&self, kind: Kind) -> Vec<ElementId> {
        let mut found = Vec::new();
        let is_body = |at: usize| self.kind_at(at) == Some(Kind::Body);
        // elements to look into; with `kind` in bodies, those of a body come before those of bodies in it
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if self.kind_at(at) == Some(kind) && (kind == Kind::Body || !kind.in_bodies()) {
                found.push(ElementId(at));
            }
            let mut bodies: Vec<usize> = node.children.clone();
            if kind.in_bodies() && (is_body(at) || node.rule.name == "worldbody") {
                bodies.clear();
                let mut inner: Vec<usize> = node.children.iter().rev().copied().collect();
                while let Some(at) = inner.pop() {
                    if is_body(at) {
                        bodies.push(at);
                        continue;
                    }
                    if self.kind_at(at) == Some(kind) {
                        found.push(ElementId(at));
                    }
                    inner.extend(self.nodes[at].children.iter().rev());
                }
            }
            open.extend(bodies.into_iter().rev());
        }
        found
    }

    /// Returns the element of a kind with a name.
    pub fn find(&self, kind: Kind, name: &str) -> Option<ElementId> {
        let named = |id: &ElementId| {
            let node = &self.nodes[id.0];
            let attribute = if kind == Kind::Class { "class" } else { "name" };
            let own = node.attribute(attribute);
            // the class at the top is called main, whether it says so or not
            let main = kind == Kind::Class && node.parent == Some(0) && name == "main";
            own == Some(name) || main
        };
        if name.is_empty() {
            return None;
        }
        self.all(kind).into_iter().find(named)
    }
}
