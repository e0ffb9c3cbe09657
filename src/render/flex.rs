//! Flexes: edges as cylinders, or a surface offset from the vertices by a radius.

use super::drawable::Drawable;
use super::skin::{SkinPart, parts};
use super::tendon::along;
use super::view::Poses;
use crate::math::{Mat3, Vec3, add, add_scaled, cross, scale, sub, unit};
use crate::model;

/// The source of a corner's normal.
#[derive(Clone, Copy, Debug)]
enum CornerNormal {
    /// That of the surface at its vertex, by the sign of its side.
    Smooth,
    /// That of a triangle of vertices, by the sign of its side.
    Flat([usize; 3]),
    /// That of a strip between both sides of a sheet: across its edge and the normal at a vertex.
    Strip([usize; 2], usize),
}

/// A corner of the surface.
#[derive(Clone, Copy, Debug)]
struct FlexCorner {
    vertex: usize,
    /// 1 above the vertex, -1 below it.
    side: f64,
    normal: CornerNormal,
}

/// The parts of a flex of triangles or tetrahedra that do not change with poses.
#[derive(Clone, Debug)]
pub struct FlexLook {
    first: usize,
    count: usize,
    radius: f64,
    /// Triangles that contribute to the normals of their vertices.
    smoothed: Vec<[usize; 3]>,
    corners: Vec<FlexCorner>,
    pub parts: Vec<SkinPart>,
}

/// Corners and faces of a surface under construction.
struct Surface {
    corners: Vec<FlexCorner>,
    faces: Vec<[u32; 3]>,
    flat: bool,
    count: usize,
}

impl Surface {
    /// Adds a triangle on one side of the vertices.
    fn face(&mut self, vertices: [usize; 3], side: f64) {
        if self.flat {
            // times the sign of the side: as in MuJoCo, both sides of a sheet have the normal of its upper side
            let normal = CornerNormal::Flat(vertices);
            self.loose(vertices.map(|vertex| FlexCorner { vertex, side, normal }));
        } else {
            let shift = if side < 0.0 { self.count } else { 0 };
            self.faces.push(vertices.map(|v| (shift + v) as u32));
        }
    }

    /// Adds a triangle with its own corners.
    fn loose(&mut self, corners: [FlexCorner; 3]) {
        let first = self.corners.len() as u32;
        self.corners.extend(corners);
        self.faces.push([first, first + 1, first + 2]);
    }

    /// Adds a triangle of the strip at the border of a sheet.
    fn strip(&mut self, [a, b]: [usize; 2], side: f64) {
        let edge = if side > 0.0 { [a, b] } else { [b, a] };
        let normal = CornerNormal::Strip(edge, b);
        let corner = |vertex, side| FlexCorner { vertex, side, normal };
        self.loose([corner(a, side), corner(b, -side), corner(b, side)]);
    }
}

impl FlexLook {
    /// Makes the surface as MuJoCo draws it: both sides of a sheet and the strips around it, or the outer sides of a solid.
    pub fn new(flex: &model::Flex) -> Self {
        let count = flex.vert.len();
        let sheet = flex.dim == 2;
        let triangles: Vec<[usize; 3]> = if sheet { &flex.elem } else { &flex.shell }.as_chunks().0.to_vec();
        let mut surface = Surface {
            corners: Vec::new(),
            faces: Vec::new(),
            flat: flex.flatskin,
            count,
        };
        if !flex.flatskin {
            for side in if sheet { &[1.0, -1.0][..] } else { &[1.0] } {
                surface.corners.extend((0..count).map(|vertex| FlexCorner {
                    vertex,
                    side: *side,
                    normal: CornerNormal::Smooth,
                }));
            }
        }
        for &[a, b, c] in &triangles {
            surface.face([a, b, c], 1.0);
            if sheet {
                surface.face([a, c, b], -1.0);
            }
        }
        if sheet {
            for &[a, b] in flex.shell.as_chunks().0 {
                surface.strip([a, b], 1.0);
                surface.strip([b, a], -1.0);
            }
        }
        let Surface { corners, faces, .. } = surface;
        let at = |vertex: usize| flex.vert[vertex].map(|x| x as f32);
        let places: Vec<[f32; 3]> = corners.iter().map(|corner| at(corner.vertex)).collect();
        let coordinates = corners.iter().filter_map(|corner| flex.texcoord.get(corner.vertex));
        let coordinates: Vec<[f32; 2]> = coordinates.copied().collect();
        Self {
            first: flex.vertadr,
            count,
            radius: flex.radius,
            smoothed: triangles,
            parts: parts(&places, &faces, &coordinates),
            corners,
        }
    }

    /// Computes positions and normals of all corners. `smooth` is working memory.
    pub fn place(
        &self,
        poses: &Poses,
        smooth: &mut Vec<Vec3>,
        (place, normal): (&mut Vec<[f32; 3]>, &mut Vec<[f32; 3]>),
    ) {
        let at = &poses.flexvert_xpos[self.first..self.first + self.count];
        let facing = |[a, b, c]: [usize; 3]| unit(cross(sub(at[b], at[a]), sub(at[c], at[a]))).0;
        smooth.clear();
        smooth.resize(self.count, [0.0; 3]);
        for &triangle in &self.smoothed {
            let facing = facing(triangle);
            for v in triangle {
                smooth[v] = add(smooth[v], facing);
            }
        }
        for normal in smooth.iter_mut() {
            *normal = unit(*normal).0;
        }
        place.clear();
        normal.clear();
        for corner in &self.corners {
            let (vertex, side) = (corner.vertex, corner.side);
            place.push(add_scaled(at[vertex], smooth[vertex], side * self.radius).map(|x| x as f32));
            // as in MuJoCo, the normals of a surface without thickness are those of its lower side
            let sign = if self.radius > 0.0 { side } else { -1.0 };
            let facing = match corner.normal {
                CornerNormal::Smooth => scale(smooth[vertex], sign),
                CornerNormal::Flat(triangle) => scale(facing(triangle), sign),
                CornerNormal::Strip([a, b], across) => unit(cross(sub(at[b], at[a]), smooth[across])).0,
            };
            normal.push(facing.map(|x| x as f32));
        }
    }
}

impl Drawable {
    /// Returns an edge of a flex in these poses.
    pub(super) fn stretched(&self, poses: &Poses) -> Option<(Self, Vec3, Mat3)> {
        let [from, to] = self.ends.map(|v| poses.flexvert_xpos.get(v).copied());
        let (from, to) = (from?, to?);
        let (direction, length) = unit(sub(to, from));
        let [radius, ..] = self.measured();
        let drawable = self.resized([radius, 0.5 * length, 0.0]);
        Some((drawable, scale(add(from, to), 0.5), along(direction)))
    }
}
