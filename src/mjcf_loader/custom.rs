//! Tables of custom data for programs, and of keyframes.

use super::attribute::Sign::Any;
use super::attribute::{AttributeKind, Keywords, TEXT, int, real, some, words};
use super::schema::Element;
use super::table::{Table, table};

/// The greatest number of values in one `<numeric>`.
const MAX_NUMERIC: usize = 500;

table! {
    /// `<custom><numeric>`.
    element Numeric {
        "name" name: String = String::new(), TEXT, required, "Name.";
        "size" size: Option<usize> = None, int(1, MAX_NUMERIC as i64), "Number of values; else as many as are given.";
        "data" data: Vec<f64> = Vec::new(), some(0, MAX_NUMERIC, Any), "Values; the rest are 0.";
    }
}

table! {
    /// `<custom><text>`.
    element Text {
        "name" name: String = String::new(), TEXT, required, "Name.";
        "data" data: String = String::new(), AttributeKind::LongText, required, "Text.";
    }
}

/// The kinds of elements that a tuple may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TupleObject {
    Body,
    Joint,
    Geom,
    Site,
    Camera,
    Mesh,
    HField,
    Texture,
    Material,
    Tendon,
    Actuator,
    /// Kinds whose names are not looked up.
    Other,
}

const NAMED: Keywords<TupleObject> = words! {
    "body" => TupleObject::Body,
    "xbody" => TupleObject::Body,
    "joint" => TupleObject::Joint,
    "geom" => TupleObject::Geom,
    "site" => TupleObject::Site,
    "camera" => TupleObject::Camera,
    "mesh" => TupleObject::Mesh,
    "hfield" => TupleObject::HField,
    "texture" => TupleObject::Texture,
    "material" => TupleObject::Material,
    "tendon" => TupleObject::Tendon,
    "actuator" => TupleObject::Actuator,
    "light" => TupleObject::Other,
    "skin" => TupleObject::Other,
    "pair" => TupleObject::Other,
    "exclude" => TupleObject::Other,
    "equality" => TupleObject::Other,
    "sensor" => TupleObject::Other,
    "numeric" => TupleObject::Other,
    "text" => TupleObject::Other,
    "tuple" => TupleObject::Other,
    "key" => TupleObject::Other,
};

table! {
    /// An `<element>` of a tuple.
    element TupleElement {
        "objtype" objtype: Option<TupleObject> = None, NAMED, required, "AttributeKind of what is named.";
        "objname" objname: String = String::new(), TEXT, required, "Its name.";
        check "prm", real(Any), "A number for programs. Not kept.";
    }
}

table! {
    /// `<custom><tuple>`: a list of elements for programs, which is checked but not stored.
    element Tuple {
        also elements: Vec<TupleElement> = Vec::new();
        "name" name: String = String::new(), TEXT, required, "Name.";
    }
}

impl Tuple {
    /// Reads the element and its list.
    pub fn hold(e: &Element) -> Self {
        let elements = e.children.iter().map(TupleElement::read).collect();
        Self {
            elements,
            ..Self::read(e)
        }
    }
}

table! {
    /// `<keyframe><key>`.
    element Key {
        "name" name: String = String::new(), TEXT, own, "Name.";
        "time" time: f64 = 0.0, real(Any), "Time, s.";
        "qpos" qpos: Vec<f64> = Vec::new(), AttributeKind::State, "Positions (nq); else `qpos0`.";
        "qvel" qvel: Vec<f64> = Vec::new(), AttributeKind::State, "Velocities (nv); else 0.";
        "act" act: Vec<f64> = Vec::new(), AttributeKind::State, "Activations (na); else 0.";
        "ctrl" ctrl: Vec<f64> = Vec::new(), AttributeKind::State, "Controls (nu); else 0.";
        "mpos" mpos: Vec<f64> = Vec::new(), AttributeKind::Poses, "Positions of mocap bodies (3 nmocap), m; else those in the document.";
        "mquat" mquat: Vec<f64> = Vec::new(), AttributeKind::Poses, "Orientations of mocap bodies (4 nmocap); else those in the document.";
    }
}
