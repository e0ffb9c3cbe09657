//! `<composite type="cable">`: a chain of bodies along a curve, as MuJoCo 3.3.0 makes it.

use std::f64::consts::PI;

use super::attribute::Sign::{Any, Positive};
use super::attribute::{Attr, AttributeKind, FLAG, Keywords, TEXT, int, real, reals, some, words};
use super::compile::{frame_to_quat, normalize};
use super::document::{Geom, Site};
use super::joint::Joint;
use super::table::{Table, table};
use super::words::{MAX_SKIN_GROUP, SOLIMP, SOLREF};
use crate::math::{Quat, Vec3, add, cross, dot, quat_mul, quat_rotate};

/// Kinds of composites. MuJoCo 3.3.0 makes only one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CompositeType {
    Cable,
    Gone,
}

const TYPES: Keywords<CompositeType> = words! {
    "particle" => CompositeType::Gone,
    "grid" => CompositeType::Gone,
    "rope" => CompositeType::Gone,
    "loop" => CompositeType::Gone,
    "cable" => CompositeType::Cable,
    "cloth" => CompositeType::Gone,
};

table! {
    /// `<composite>` in a body: a cable.
    element Composite {
        "prefix" prefix: String = String::new(), TEXT, "What the names of its bodies, joints, geoms and sites begin with.";
        "type" kind: CompositeType = CompositeType::Gone, TYPES, required, "AttributeKind: only `cable` is made, as in MuJoCo 3.3.0.";
        "count" count: [f64; 3] = [1.0; 3], some(1, 3, Positive), "Number of points along the curve; the second and the third are 1.";
        "offset" offset: Vec3 = [0.0; 3], reals(3, Any), "Where the curve begins to be drawn from in the body, m.";
        "curve" curve: String = String::new(), TEXT, "What x, y and z are along the curve: `s` for the length, `cos(s)` and `sin(s)`, `0`.";
        "initial" initial: String = "ball".to_owned(), TEXT, "Joint of the first body: `free`, `none`, or else a ball joint.";
        "size" size: Vec3 = [1.0, 0.0, 0.0], some(1, 3, Any), "Length, m, radius, m, and number of half turns of the curve.";
        "vertex" vertex: Vec<f64> = Vec::new(), AttributeKind::Data, "Points, m, three numbers each, in place of count and curve.";
    }
}

table! {
    /// Attributes of a composite's `<joint>` in addition to those of joints.
    group CompositeJoint {
        check "kind", AttributeKind::Word(&["main"]), "Which joints are meant: all of the cable.";
        check "type", AttributeKind::Word(&["free", "ball", "slide", "hinge"]), "Ignored, as in MuJoCo: joints of a cable are balls.";
        check "axis", reals(3, Any), "Ignored, as in MuJoCo: joints of a cable are balls.";
        check "limited", AttributeKind::Word(&["false", "true", "auto"]), "Ignored, as in MuJoCo 3.3.0: a range limits the joints where `autolimits` is on.";
        check "solreffix", some(1, 2, Any), "Ignored, as in MuJoCo: cables have no equalities.";
        check "solimpfix", some(1, 5, Any), "Ignored, as in MuJoCo: cables have no equalities.";
    }
}

table! {
    /// `<skin>` of a composite: a cable of boxes has one, with or without it.
    element CompositeSkin {
        "texcoord" texcoord: bool = false, FLAG, "Whether it has texture coordinates.";
        "material" material: Option<String> = None, TEXT, "Material.";
        "rgba" rgba: [f64; 4] = [1.0; 4], reals(4, Any), "Colour and opacity.";
        "group" group: i32 = 0, int(0, MAX_SKIN_GROUP), "Visual group; 0 to 2 are drawn.";
        "subgrid" subgrid: i32 = 0, int(i32::MIN as i64, i32::MAX as i64), "Vertices between one end of a box and the other, on cubics through the ends; with any, there are as many on both sides of the middle line. Below 0 counts as 0.";
        check "inflate", real(Any), "Ignored, as in MuJoCo: the skin of a cable is blown up by the thickness of its boxes.";
    }
}

/// Returns the attributes of a table with the given names.
const fn pick<const N: usize>(table: &'static [Attr], names: [&str; N]) -> [Attr; N] {
    let mut picked = [table[0]; N];
    let mut index = 0;
    while index < N {
        let mut at = 0;
        while !same(table[at].name, names[index]) {
            at += 1;
        }
        picked[index] = table[at];
        index += 1;
    }
    picked
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// The attributes of geoms, sites and joints that those of a composite also have.
pub(super) static GEOM: [Attr; 17] = pick(
    Geom::ATTRIBUTES[0],
    [
        "type",
        "size",
        "contype",
        "conaffinity",
        "condim",
        "priority",
        "group",
        "friction",
        "solmix",
        "solref",
        "solimp",
        "margin",
        "gap",
        "mass",
        "density",
        "rgba",
        "material",
    ],
);
pub(super) static SITE: [Attr; 4] = pick(Site::ATTRIBUTES[0], ["size", "group", "rgba", "material"]);
pub(super) static JOINT: [Attr; 11] = pick(
    Joint::ATTRIBUTES[0],
    [
        "group",
        "range",
        "margin",
        "stiffness",
        "damping",
        "armature",
        "frictionloss",
        "solreflimit",
        "solimplimit",
        "solreffriction",
        "solimpfriction",
    ],
);

/// Maximum number of bodies of a cable; the memory of its chain grows with the square of its length.
pub(super) const MAX_BODIES: usize = 1000;

/// How x, y or z varies along a curve.
#[derive(Clone, Copy)]
enum Shape {
    Line,
    Cos,
    Sin,
    Zero,
}

/// A body of a cable: its pose in the body before, and its length along x.
pub(super) struct Link {
    pub pos: Vec3,
    pub quat: Quat,
    pub length: f64,
}

impl Composite {
    /// Returns the points of the curve, or a description of a fault.
    fn points(&self) -> Result<Vec<Vec3>, &'static str> {
        if self.count.iter().any(|count| count.fract() != 0.0) {
            return Err("count must be whole numbers");
        }
        if dot(self.size, self.size) < 1e-15 && self.vertex.is_empty() {
            return Err("a composite needs a length, or its vertices");
        }
        if self.count[1] != 1.0 || self.count[2] != 1.0 {
            return Err("a cable has one dimension: the second and the third number of count are 1");
        }
        let [count, ..] = self.count;
        if !self.vertex.is_empty() {
            if count > 1.0 {
                return Err("a composite has a count or vertices, not both");
            }
            let (points, _) = self.vertex.as_chunks::<3>();
            return Ok(points.iter().map(|point| point.map(single)).collect());
        }
        if count > MAX_BODIES as f64 + 1.0 {
            return Err("a cable can have at most 1001 points");
        }
        let shapes = self.shapes()?;
        let [length, radius, turns] = self.size;
        let point = |index: usize| {
            let index = index as f64;
            shapes.map(|shape| match shape {
                Shape::Line => index * length / (count - 1.0),
                Shape::Cos => radius * pxfm::f_cos(PI * index * turns / (count - 1.0)),
                Shape::Sin => radius * pxfm::f_sin(PI * index * turns / (count - 1.0)),
                Shape::Zero => 0.0,
            })
        };
        Ok((0..count as usize).map(|index| point(index).map(single)).collect())
    }

    fn shapes(&self) -> Result<[Shape; 3], &'static str> {
        let mut shapes = [Shape::Zero; 3];
        for (index, word) in self.curve.split_ascii_whitespace().enumerate() {
            let Some(shape) = shapes.get_mut(index) else {
                return Err("a curve has at most three parts");
            };
            *shape = match word {
                "s" => Shape::Line,
                "cos(s)" => Shape::Cos,
                "sin(s)" => Shape::Sin,
                "0" => Shape::Zero,
                _ => return Err("the parts of a curve are s, cos(s), sin(s) and 0"),
            };
        }
        Ok(shapes)
    }

    /// Returns the bodies, or a description of a fault of the points.
    pub fn links(&self) -> Result<Vec<Link>, &'static str> {
        let points = self.points()?;
        if points.len() < 2 {
            return Err("a cable needs two points at least");
        }
        if points.len() == 3 {
            return Err("MuJoCo 3.3.0 cannot make a cable of two bodies: give it another number of points");
        }
        if points.len() > MAX_BODIES + 1 {
            return Err("a cable can have at most 1001 points");
        }
        let mut normal = [0.0, 1.0, 0.0];
        let mut before: Option<(Quat, f64)> = None;
        let mut links = Vec::with_capacity(points.len() - 1);
        for (index, ends) in points.windows(2).enumerate() {
            let edge = between(&ends[0], &ends[1]);
            let tangent = |from: Option<&Vec3>, to: Option<&Vec3>| {
                let mut tangent = from.zip(to).map_or([0.0; 3], |(from, to)| between(from, to));
                let length = normalize(&mut tangent);
                (tangent, length)
            };
            let (previous, length) = tangent(index.checked_sub(1).and_then(|k| points.get(k)), Some(&ends[0]));
            let (next, _) = tangent(Some(&ends[1]), points.get(index + 2));
            let quat = turned(&mut normal, edge, previous, next, index == 0);
            links.push(match before {
                None => Link {
                    pos: add(self.offset, ends[0]),
                    quat,
                    length: dot(edge, edge).sqrt(),
                },
                Some((last, _)) => Link {
                    pos: [length, 0.0, 0.0],
                    quat: quat_mul([last[0], -last[1], -last[2], -last[3]], quat),
                    length: dot(edge, edge).sqrt(),
                },
            });
            before = Some((quat, length));
        }
        Ok(links)
    }
}

/// Rounds to single precision, in which MuJoCo keeps the points of a curve, and computes from one to the next.
fn single(v: f64) -> f64 {
    f64::from(v as f32)
}

/// Returns the vector from one point to another.
fn between(from: &Vec3, to: &Vec3) -> Vec3 {
    std::array::from_fn(|k| f64::from(to[k] as f32 - from[k] as f32))
}

/// Carries the normal of a curve on to the next edge, and returns the orientation of that edge.
fn turned(normal: &mut Vec3, edge: Vec3, previous: Vec3, next: Vec3, first: bool) -> Quat {
    let mut tangent = edge;
    normalize(&mut tangent);
    let mut binormal;
    if first {
        binormal = cross(tangent, next);
        normalize(&mut binormal);
        *normal = cross(binormal, tangent);
        normalize(normal);
    } else {
        binormal = cross(previous, tangent);
        let sine = normalize(&mut binormal);
        let half = pxfm::f_atan2(sine, dot(previous, tangent)) * 0.5;
        let s = pxfm::f_sin(half);
        let turn = [pxfm::f_cos(half), binormal[0] * s, binormal[1] * s, binormal[2] * s];
        *normal = quat_rotate(turn, *normal);
        normalize(normal);
        binormal = cross(tangent, *normal);
        normalize(&mut binormal);
    }
    frame_to_quat(tangent, *normal, binormal)
}

/// Geoms, sites and joints of a composite, before its own attributes are applied.
pub(super) struct Prototypes {
    pub geom: Geom,
    pub site: Site,
    pub joint: Joint,
}

impl Prototypes {
    /// MuJoCo's own values, which default classes do not change.
    pub fn initial() -> Self {
        Self {
            geom: Geom::initial(),
            site: Site {
                group: 3,
                ..Site::initial()
            },
            joint: Joint {
                group: 3,
                solref_limit: SOLREF,
                solimp_limit: SOLIMP,
                ..Joint::initial()
            },
        }
    }
}
