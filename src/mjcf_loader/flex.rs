//! The tables of flexes: deformable bodies, and the shapes that `<flexcomp>` makes of them.

use super::attribute::Sign::{Any, NonNegative};
use super::attribute::{AttributeKind, FLAG, Keywords, TEXT, int, real, reals, some, words};
use super::joint::Joint;
use super::table::table;
use super::words::{Frame, GREY, MAX_BITS, MAX_GROUP, MIN_BITS, MIN_GROUP, SOLIMP, SOLREF};
use crate::math::Vec3;
use crate::model::FlexSelfCollide;

const SELF_COLLIDE: Keywords<FlexSelfCollide> = words! {
    "none" => FlexSelfCollide::None,
    "narrow" => FlexSelfCollide::Narrow,
    "bvh" => FlexSelfCollide::Bvh,
    "sap" => FlexSelfCollide::Sap,
    "auto" => FlexSelfCollide::Auto,
};

table! {
    /// `<contact>` of a flex.
    group FlexContact {
        "contype" contype: u32 = 1, int(MIN_BITS, MAX_BITS), "Bits that meet `conaffinity` of others.";
        "conaffinity" conaffinity: u32 = 1, int(MIN_BITS, MAX_BITS), "Bits that meet `contype` of others.";
        "condim" condim: usize = 3, int(1, 6), "Dimension of its contacts: 1, 3, 4 or 6.";
        "priority" priority: i32 = 0, int(i32::MIN as i64, i32::MAX as i64), "Priority where contact parameters are mixed.";
        "friction" friction: [f64; 3] = [1.0, 0.005, 0.0001], some(1, 3, NonNegative), "Sliding, torsional and rolling friction.";
        "solmix" solmix: f64 = 1.0, real(NonNegative), "Weight where contact parameters are mixed.";
        "solref" solref: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of contacts.";
        "solimp" solimp: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of contacts.";
        "margin" margin: f64 = 0.0, real(NonNegative), "Distance at which contacts are found, m.";
        "gap" gap: f64 = 0.0, real(NonNegative), "Part of the margin in which contacts exert no force, m.";
        "internal" internal: bool = true, FLAG, "Whether vertices and elements that belong together may touch.";
        "selfcollide" selfcollide: FlexSelfCollide = FlexSelfCollide::Auto, SELF_COLLIDE, "How its elements look for contacts with each other.";
        "activelayers" activelayers: i32 = 1, int(i32::MIN as i64, i32::MAX as i64), "Number of layers of tetrahedra that touch, from the surface on.";
    }
}

table! {
    /// `<edge>` of a flex.
    group FlexEdge {
        "stiffness" stiffness: f64 = 0.0, real(NonNegative), "Stiffness of the edges of a flex of lines, N/m.";
        "damping" damping: f64 = 0.0, real(NonNegative), "Damping of the edges, N s/m.";
    }
}

table! {
    /// `<elasticity>` of a flex.
    group Elasticity {
        "young" young: f64 = 0.0, real(NonNegative), "Young's modulus, Pa; 0 for none.";
        "poisson" poisson: f64 = 0.0, real(Any), "Poisson's ratio, from 0 to below 0.5.";
        "thickness" thickness: f64 = -1.0, real(Any), "Thickness of triangles, m, which must be positive.";
        "damping" damping: f64 = 0.0, real(NonNegative), "Rayleigh damping, s.";
    }
}

table! {
    /// Attributes of a flex that `<flexcomp>` also has.
    group FlexLook {
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group; up to 2 are drawn.";
        "dim" dim: usize = 2, int(1, 3), "1 for lines, 2 for triangles, 3 for tetrahedra.";
        "radius" radius: f64 = 0.005, real(NonNegative), "Radius of the rounded elements, m.";
        "material" material: Option<String> = None, TEXT, "Material.";
        "rgba" rgba: [f64; 4] = GREY, reals(4, Any), "Colour and opacity.";
        "flatskin" flatskin: bool = false, FLAG, "Whether the faces of the surface are shaded flat.";
        "texcoord" texcoord: Vec<f64> = Vec::new(), AttributeKind::Data, "Texture coordinates of the vertices, two numbers each.";
    }
}

table! {
    /// `<flex>`.
    element Flex {
        also contact: FlexContact = FlexContact::default();
        also edge: FlexEdge = FlexEdge::default();
        also elasticity: Elasticity = Elasticity::default();
        also bodies: Vec<String> = Vec::new();
        "name" name: String = String::new(), TEXT, "Name.";
        "body" body: String = String::new(), AttributeKind::LongText, required, "Names of the bodies of the vertices: one for each, or one for all.";
        "vertex" vertex: Vec<f64> = Vec::new(), AttributeKind::Data, "Positions of the vertices in their bodies, m, three numbers each; else the origins of the bodies.";
        "element" element: Vec<f64> = Vec::new(), AttributeKind::Indices, required, "Vertices of each element, from 0, `dim` + 1 numbers each.";
        check "node", AttributeKind::LongText, "Bodies between which vertices are interpolated, which is not done here: an error where it is given.";
        with look: FlexLook;
    }
}

/// The shape of a `<flexcomp>`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlexCompType {
    Grid,
    Box,
    Cylinder,
    Ellipsoid,
    Square,
    Disc,
    Circle,
    Mesh,
    Gmsh,
    Direct,
}

const TYPES: Keywords<FlexCompType> = words! {
    "grid" => FlexCompType::Grid,
    "box" => FlexCompType::Box,
    "cylinder" => FlexCompType::Cylinder,
    "ellipsoid" => FlexCompType::Ellipsoid,
    "square" => FlexCompType::Square,
    "disc" => FlexCompType::Disc,
    "circle" => FlexCompType::Circle,
    "mesh" => FlexCompType::Mesh,
    "gmsh" => FlexCompType::Gmsh,
    "direct" => FlexCompType::Direct,
};

/// The joints of a `<flexcomp>`'s vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlexDofs {
    Full,
    Radial,
    Trilinear,
}

const DOFS: Keywords<FlexDofs> = words! {
    "full" => FlexDofs::Full,
    "radial" => FlexDofs::Radial,
    "trilinear" => FlexDofs::Trilinear,
};

table! {
    /// Attributes of `<edge>` that a `<flexcomp>` has in addition to those of a flex.
    group FlexCompEdge {
        "equality" equality: bool = false, FLAG, "Whether an equality holds the lengths of the edges.";
        "solref" solref: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of that equality.";
        "solimp" solimp: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of that equality.";
    }
}

table! {
    /// `<pin>` of a `<flexcomp>`: vertices that are fixed to the parent body.
    element Pin {
        "id" id: Vec<f64> = Vec::new(), AttributeKind::Indices, "Points.";
        "range" range: Vec<f64> = Vec::new(), AttributeKind::Indices, "First and last point of ranges.";
        "grid" grid: Vec<f64> = Vec::new(), AttributeKind::Indices, "Points of a grid by their coordinates, `dim` numbers each.";
        "gridrange" gridrange: Vec<f64> = Vec::new(), AttributeKind::Indices, "First and last coordinates of ranges in a grid, twice `dim` numbers each.";
    }
}

table! {
    /// `<flexcomp>` in a body: a flex of a given shape, with a body for each vertex.
    element FlexComp {
        also body: usize = 0;
        also place: usize = 0;
        also joint: Joint = Joint::default();
        also contact: FlexContact = FlexContact::default();
        also edge: FlexEdge = FlexEdge::default();
        also equality: FlexCompEdge = FlexCompEdge::default();
        also elasticity: Elasticity = Elasticity::default();
        also elastic: bool = false;
        also origin_given: bool = false;
        also pins: Vec<Pin> = Vec::new();
        "name" name: String = String::new(), TEXT, required, "Name of the flex; those of the bodies are the name, an underscore and the number of the point.";
        "type" kind: FlexCompType = FlexCompType::Grid, TYPES, "Shape: `gmsh` is not read.";
        "dof" dofs: FlexDofs = FlexDofs::Full, DOFS, "Joints of each vertex: three slides, or one that points away from the parent's origin; `trilinear` is an error.";
        "count" count: Vec3 = [10.0; 3], reals(3, Any), "Number of points along each axis.";
        "spacing" spacing: Vec3 = [0.02; 3], reals(3, Any), "Distance of points along each axis, m.";
        "scale" scale: Vec3 = [1.0; 3], reals(3, Any), "Factors on the points of types `mesh` and `direct`.";
        "mass" mass: f64 = 1.0, real(Any), "Mass of all points together, kg.";
        "inertiabox" inertiabox: f64 = 0.005, real(Any), "Half length of a cube that has the moments of inertia of each vertex, m.";
        "rigid" rigid: bool = false, FLAG, "Whether all points are fixed to the parent body.";
        "file" file: Option<String> = None, TEXT, "Mesh of type `mesh`.";
        "point" point: Vec<f64> = Vec::new(), AttributeKind::Data, "Points of type `direct`, m, three numbers each.";
        "element" element: Vec<f64> = Vec::new(), AttributeKind::Indices, "Points of each element of type `direct`, from 0.";
        "origin" origin: Vec3 = [0.0; 3], reals(3, Any), "Point that makes tetrahedra of the triangles of a mesh, m.";
        with look: FlexLook;
        with frame: Frame;
    }
}
