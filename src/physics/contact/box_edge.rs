//! Boxes that touch across two edges.
//!
//! The reference is the face of the first box that is nearest to level on the normal and holds its edge; everything
//! happens in the frame of the first box, rotated such that this face is at +z, with the origin on the face. A face of
//! the second box, spanned by its edge and the flatter one of the other axes, is projected along the normal onto the
//! reference face.

use super::box_frame::{BoxFace, BoxPoint, EdgePair, FaceFrame, RelativePose, crossings, rectangle};
use super::{PlacedGeom, Quirks, add_scaled, dot, sub};
use crate::math::{MINVAL, Vec3, add, mat_vec, row, scale};

/// The two axes besides each axis, in the order in which they are compared.
const OTHERS: [(usize, usize); 3] = [(1, 2), (0, 2), (1, 0)];

/// A collector of contact points in the face frame.
struct Collector<'a> {
    /// Largest square of a positive distance.
    margin2: f64,
    points: &'a mut Vec<BoxPoint>,
}

impl Collector<'_> {
    /// Notes a point of the face frame; it is transformed to the world frame at the end.
    #[inline(always)]
    fn push(&mut self, pos: Vec3, dist: f64) {
        self.points.push(BoxPoint { dist, pos });
    }

    /// Returns whether a distance above the face is beyond the margin.
    #[inline(always)]
    fn too_far(&self, height: f64, distance2: f64) -> bool {
        // a square has lost the sign: what is under the face touches, however deep
        height > 0.0 && distance2 > self.margin2
    }
}

#[inline(always)]
fn signed_root(distance2: f64, height: f64) -> f64 {
    distance2.sqrt() * if height < 0.0 { -1.0 } else { 1.0 }
}

/// Returns the axes of the faces that hold the edges: of the second box the flatter and the steeper one along the normal,
/// of the first the one of the reference face.
#[inline(always)]
fn face_axes(relative: &RelativePose, edges: &EdgePair) -> (usize, usize, usize) {
    let (first, second) = (edges.first, edges.second);
    // The normal is across both edges. Of two axes across the second edge, the one more along the first edge is
    // therefore less along the normal, and likewise with the boxes exchanged.
    let (mut flat, mut steep) = OTHERS[second];
    if relative.abs[3 * first + flat] < relative.abs[3 * first + steep] {
        (flat, steep) = (steep, flat);
    }
    let (y1, y2) = OTHERS[first];
    let upright = if relative.abs[3 * y1 + second] < relative.abs[3 * y2 + second] {
        y1
    } else {
        y2
    };
    (flat, steep, upright)
}

/// Returns the corners of the second box's face, which its edge and its flatter axis span, in the face frame.
#[inline(always)]
fn face_corners(
    b: &PlacedGeom,
    relative: &RelativePose,
    edges: &EdgePair,
    frame: &FaceFrame,
    centre: Vec3,
    [flat, steep]: [usize; 2],
) -> [Vec3; 4] {
    let second = edges.second;
    let axis_of_second = |k: usize| frame.vector(row(&relative.rot_t, k));
    let (flat_axis, steep_axis, edge_axis) = (axis_of_second(flat), axis_of_second(steep), axis_of_second(second));
    let sign = |k: usize| if edges.second_sides >> k & 1 == 1 { 1.0 } else { -1.0 };
    [0, 1, 2, 3].map(|k| {
        let far = if k < 2 { sign(flat) } else { -sign(flat) };
        let side = add_scaled(centre, flat_axis, b.size[flat] * far);
        let side = add_scaled(side, steep_axis, b.size[steep] * sign(steep));
        add_scaled(
            side,
            edge_axis,
            if k % 2 == 0 { b.size[second] } else { -b.size[second] },
        )
    })
}

/// Collects the points where two boxes meet across two edges, and returns the normal.
pub(super) fn edge_points(
    a: &PlacedGeom,
    b: &PlacedGeom,
    relative: &RelativePose,
    edges: &EdgePair,
    margin: f64,
    quirks: &Quirks,
    points: &mut Vec<BoxPoint>,
) -> Vec3 {
    let (flat, steep, upright) = face_axes(relative, edges);
    let frame = FaceFrame::new(BoxFace {
        axis: upright,
        negative: edges.first_sides >> upright & 1 == 0,
    });
    let normal = frame.vector(edges.normal);
    let size = frame.sizes(a.size);
    let orientation = frame.orientation(a.mat);
    let world_normal = scale(mat_vec(&orientation, normal), if edges.reversed { -1.0 } else { 1.0 });
    // a normal in the face projects nothing onto it
    if normal[2].abs() < MINVAL {
        return world_normal;
    }

    // projected along the normal, not straight down: the boxes are pushed apart along the normal, so what lies on one
    // line along it will touch
    let mut centre = frame.vector(relative.second_from_first);
    // heights count from the face, so that the sign of z tells over from under
    centre[2] -= size[2];
    let raw = face_corners(b, relative, edges, &frame, centre, [flat, steep]);
    let per_height = 1.0 / normal[2];
    let projected = raw.map(|corner| add_scaled(corner, normal, -corner[2] * per_height));

    let patch = FacePatch {
        raw,
        projected,
        size,
        // a step along the normal rises by normal.z; the sign makes what is under the face negative, whichever box the
        // normal starts from
        depth_per_height: per_height * if edges.reversed { -1.0 } else { 1.0 },
    };
    let mut collector = Collector {
        margin2: margin * margin,
        points,
    };
    patch.edges_across_sides(margin, &mut collector);
    // Crossings mean that the outlines overlap: then only corners inside the other outline touch. Without any, one
    // outline may hold the other or miss it by a little; corners that are beside the other outline along one coordinate
    // only are then taken at its nearest point, so that boxes that do touch are not left without a contact.
    let crossed = !collector.points.is_empty();
    patch.rectangle_corners(crossed, quirks, &mut collector);
    patch.patch_corners(crossed, &mut collector);

    for point in points.iter_mut() {
        let [x, y, z] = point.pos;
        // back from the face to the centre of the first box
        point.pos = add(mat_vec(&orientation, [x, y, z + size[2]]), a.pos);
    }
    world_normal
}

/// The face of the second box over the rectangle of the reference face.
struct FacePatch {
    raw: [Vec3; 4],
    projected: [Vec3; 4],
    /// Half sizes of the rectangle.
    size: Vec3,
    /// Signed distance along the normal for a height over the face.
    depth_per_height: f64,
}

impl FacePatch {
    /// Collects the points where edges of the patch cross sides of the rectangle: halfway between edge and side.
    fn edges_across_sides(&self, margin: f64, collector: &mut Collector) {
        let [p, r] = [&self.projected, &self.raw];
        let (e, g) = (sub(p[1], p[0]), sub(p[2], p[0]));
        let (raw_e, raw_g) = (sub(r[1], r[0]), sub(r[2], r[0]));
        let edges = [
            (p[0], e, r[0], raw_e),
            (p[0], g, r[0], raw_g),
            (add(p[0], e), g, add(r[0], raw_e), raw_g),
            (add(p[0], g), e, add(r[0], raw_g), raw_e),
        ];
        for (start, dir, raw_start, raw_dir) in edges {
            crossings(start, dir, &self.size, |crossing| {
                if (raw_start[2] + raw_dir[2] * crossing.t) * self.depth_per_height > margin {
                    return;
                }
                // half of the edge's point and half of the side's, the latter at height 0: z is half the height, the
                // distance twice that
                let mut point = add_scaled(scale(raw_start, 0.5), raw_dir, 0.5 * crossing.t);
                point[crossing.axis] += 0.5 * crossing.side;
                point[1 - crossing.axis] += 0.5 * crossing.other;
                collector.push(point, point[2] * self.depth_per_height * 2.0);
            });
        }
    }

    /// Collects the corners of the rectangle under the patch: halfway to the patch.
    fn rectangle_corners(&self, crossed: bool, quirks: &Quirks, collector: &mut Collector) {
        let [p, r] = [&self.projected, &self.raw];
        let (e, g) = (sub(p[1], p[0]), sub(p[2], p[0]));
        let mut determinant = e[0] * g[1] - g[0] * e[1];
        for [x, y] in rectangle(&self.size) {
            let (dx, dy) = (x - p[0][0], y - p[0][1]);
            let inverse = 1.0 / determinant;
            let u = (dx * g[1] - dy * g[0]) * inverse;
            let v = (dy * e[0] - dx * e[1]) * inverse;
            let (u_outside, v_outside) = (off_unit(u), off_unit(v));
            let skip = if crossed {
                u_outside || v_outside
            } else {
                u_outside && v_outside
            };
            if skip {
                continue;
            }
            // only a corner taken without crossings is moved
            let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
            let target = add_scaled(add_scaled(scale(r[0], 1.0 - u - v), r[1], u), r[2], v);
            let corner = [x, y, 0.0];
            let away = sub(corner, target);
            let distance2 = dot(away, away);
            if quirks.box_edge_determinant_reuse {
                // MuJoCo 3.3.0 has one variable for both
                determinant = distance2;
            }
            if collector.too_far(target[2], distance2) {
                continue;
            }
            collector.push(scale(add(corner, target), 0.5), signed_root(distance2, target[2]));
        }
    }

    /// Collects the corners of the patch over the rectangle: halfway to the rectangle.
    fn patch_corners(&self, crossed: bool, collector: &mut Collector) {
        let any = !collector.points.is_empty();
        for (raw, projected) in self.raw.iter().zip(&self.projected) {
            let (x, y) = (projected[0], projected[1]);
            let (x_outside, y_outside) = (x.abs() > self.size[0], y.abs() > self.size[1]);
            let skip = if crossed {
                x_outside || y_outside
            } else {
                any && x_outside && y_outside
            };
            if skip {
                continue;
            }
            // half of the rectangle's point nearest to the corner; the other half is added below
            let mut target = [x * 0.5, y * 0.5, 0.0];
            let mut distance2 = 0.0;
            for k in 0..2 {
                let (z, s) = (projected[k], self.size[k]);
                if z < -s {
                    distance2 += (z + s) * (z + s);
                    target[k] = -s * 0.5;
                } else if z > s {
                    distance2 += (z - s) * (z - s);
                    target[k] = s * 0.5;
                }
            }
            distance2 += raw[2] * self.depth_per_height * raw[2] * self.depth_per_height;
            if collector.too_far(raw[2], distance2) {
                continue;
            }
            collector.push(add_scaled(target, *raw, 0.5), signed_root(distance2, raw[2]));
        }
    }
}

/// Returns whether a number is outside 0..1. NaN, which a reused determinant can give, is not.
#[inline(always)]
#[allow(clippy::manual_range_contains)]
fn off_unit(x: f64) -> bool {
    // written out, as `contains` would call NaN outside
    x < 0.0 || x > 1.0
}
