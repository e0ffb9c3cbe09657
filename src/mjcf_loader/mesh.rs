//! The tables of meshes and height fields.

use crate::math::Vec3;

use super::attribute::Sign::Any;
use super::attribute::{AttributeKind, FLAG, Keywords, TEXT, int, reals, words};
use super::table::table;
use super::words::MAX_COUNT;

/// The way in which mass and inertia follow from a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeshInertia {
    /// Those of the convex hull.
    Convex,
    /// Those of the enclosed volume; the surface must be closed.
    Exact,
    /// Those of all pyramids over triangles, counted as positive regardless of orientation.
    Legacy,
    /// Those of the surface.
    Shell,
}

const INERTIAS: Keywords<MeshInertia> = words! {
    "convex" => MeshInertia::Convex,
    "legacy" => MeshInertia::Legacy,
    "exact" => MeshInertia::Exact,
    "shell" => MeshInertia::Shell,
};

table! {
    /// `<mesh>`.
    element Mesh {
        "name" name: String = String::new(), TEXT, own, "Name; else that of the file.";
        "file" file: Option<String> = None, TEXT, own, "File: OBJ, STL (binary) or MSH, by its ending.";
        "content_type" content_type: Option<String> = None, TEXT, own, "Format of the file, whatever its ending: `model/obj`, `model/stl` or `model/vnd.mujoco.msh`.";
        "vertex" vertex: Vec<f64> = Vec::new(), AttributeKind::Data, own, "Vertices, m, three numbers each.";
        "normal" normal: Vec<f64> = Vec::new(), AttributeKind::Data, own, "Normals of the vertices, three numbers each; else they follow from the faces.";
        "texcoord" texcoord: Vec<f64> = Vec::new(), AttributeKind::Data, own, "Texture coordinates of the vertices, two numbers each, from the top of the image.";
        "face" face: Vec<f64> = Vec::new(), AttributeKind::Indices, own, "Vertices of each triangle, from 0, counterclockwise from outside; else the triangles of the convex hull.";
        "refpos" refpos: Vec3 = [0.0; 3], reals(3, Any), own, "Point that becomes the origin of the mesh, m.";
        "refquat" refquat: [f64; 4] = [1.0, 0.0, 0.0, 0.0], AttributeKind::Quat, own, "Orientation that becomes the axes of the mesh.";
        "scale" scale: Vec3 = [1.0; 3], reals(3, Any), "Factors on the coordinates, after `refpos` and `refquat`.";
        "smoothnormal" smoothnormal: bool = false, FLAG, own, "Whether normals are means over all faces of a vertex; else those that turn away from the mean by more than 37 degrees are left out.";
        "maxhullvert" maxhullvert: i32 = -1, int(4, MAX_COUNT), "Most corners of the convex hull; any number without it. Where the hull has more, it is of those that are found first.";
        "inertia" inertia: MeshInertia = MeshInertia::Legacy, INERTIAS, "Solid of which mass and inertia are: `convex`, the convex hull; `exact`, what the surface encloses; `legacy`, the same with all parts counted positive; `shell`, the surface.";
    }
}

/// Greatest number of rows or columns.
const MAX_SIDE: i64 = 1 << 16;

table! {
    /// `<hfield>`.
    element HField {
        "name" name: String = String::new(), TEXT, "Name; else that of the file.";
        "file" file: Option<String> = None, TEXT, "File: a PNG picture, of which the red colour counts, or MuJoCo's binary format. Its numbers stand for those of the document.";
        "content_type" content_type: Option<String> = None, TEXT, "Format of the file, whatever its ending: `image/png` or `image/vnd.mujoco.hfield`.";
        "nrow" nrow: usize = 0, int(0, MAX_SIDE), "Number of rows, along y, where there is no file.";
        "ncol" ncol: usize = 0, int(0, MAX_SIDE), "Number of columns, along x, where there is no file.";
        "size" size: [f64; 4] = [0.0; 4], reals(4, Any), required, "Half lengths along x and y, greatest height over 0, depth of the base below 0, m.";
        "elevation" elevation: Vec<f64> = Vec::new(), AttributeKind::Data, "Heights, row by row from the greatest y; scaled so that they are from 0 to 1. Without any the field is flat.";
    }
}
