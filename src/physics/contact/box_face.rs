//! Boxes that touch across a face: the other box's lowest face, edge or corner clipped to the face rectangle.
//!
//! Everything happens in the frame of the reference box, rotated such that the face is at +z, with the origin on the face.

use super::box_frame::{BoxFace, BoxPoint, FaceFrame, RelativePose, crossings, rectangle};
use super::{PlacedGeom, Quirks, add_scaled, column};
use crate::math::{Vec3, add, mat_vec, row, scale, transpose};

/// Collects the points where two boxes meet across a face, and returns the normal. `swapped`: the reference box is the
/// second one of the pair.
#[allow(clippy::too_many_arguments)] // the pair, its relative pose and what to do with it
pub(super) fn face_points(
    reference: &PlacedGeom,
    other: &PlacedGeom,
    relative: &RelativePose,
    face: BoxFace,
    swapped: bool,
    margin: f64,
    quirks: &Quirks,
    points: &mut Vec<BoxPoint>,
) -> Vec3 {
    let frame = FaceFrame::new(face);
    let size = frame.sizes(reference.size);
    let (axes, centre) = if swapped {
        (relative.rot, relative.first_from_second)
    } else {
        (transpose(&relative.rot), relative.second_from_first)
    };
    let mut corner = frame.vector(centre);
    corner[2] -= size[2];
    let lowest = LowestFeature::new(corner, |k| frame.vector(row(&axes, k)), &other.size);

    // a point of the face frame is kept when it is below the face, and given half of its height
    let orientation = frame.orientation(reference.mat);
    lowest.meet(&size, |point: Vec3| {
        if point[2] > margin {
            return;
        }
        let half = point[2] * 0.5;
        let local = [point[0], point[1], half + size[2]];
        points.push(BoxPoint {
            dist: if quirks.half_box_face_depth { half } else { point[2] },
            pos: add(mat_vec(&orientation, local), reference.pos),
        });
    });
    scale(column(&orientation, 2), if swapped { -1.0 } else { 1.0 })
}

/// The lowest feature of the other box: its deepest corner, and up to two edges from it that are nearer to level than to
/// upright.
struct LowestFeature {
    corner: Vec3,
    edges: [Vec3; 2],
    count: usize,
}

impl LowestFeature {
    #[inline(always)]
    fn new(mut corner: Vec3, axis: impl Fn(usize) -> Vec3, size: &Vec3) -> Self {
        let mut edges = [[0.0; 3]; 2];
        let mut count = 0;
        for k in 0..3 {
            let arm = axis(k);
            // against each axis that rises, along each that falls: the deepest corner, from which all edges rise
            let down = arm[2] < 0.0;
            corner = add_scaled(corner, arm, size[k] * if down { 1.0 } else { -1.0 });
            // an edge more than 30 degrees off level leads away from the face, and has no second point near it; all
            // three are level only if the box were flat
            if arm[2].abs() < 0.5 && count < 2 {
                edges[count] = scale(arm, size[k] * if down { -2.0 } else { 2.0 });
                count += 1;
            }
        }
        Self { corner, edges, count }
    }

    /// Passes the points where the feature meets the face rectangle of half sizes `size` to `push`.
    #[inline(always)]
    fn meet(&self, size: &Vec3, mut push: impl FnMut(Vec3)) {
        let Self { corner, count, .. } = *self;
        let [e, g] = self.edges;

        // edges across the sides of the rectangle
        let mut cross_sides = |start: Vec3, dir: Vec3| {
            crossings(start, dir, size, |crossing| push(add_scaled(start, dir, crossing.t)));
        };
        if count >= 1 {
            cross_sides(corner, e);
        }
        if count == 2 {
            cross_sides(corner, g);
            cross_sides(add(corner, e), g);
            cross_sides(add(corner, g), e);
        }

        // corners of the rectangle over the other box's face
        if count == 2 {
            let inverse = 1.0 / (e[0] * g[1] - g[0] * e[1]);
            for [x, y] in rectangle(size) {
                let (dx, dy) = (x - corner[0], y - corner[1]);
                let u = (dx * g[1] - dy * g[0]) * inverse;
                let v = (dy * e[0] - dx * e[1]) * inverse;
                // on its rim the crossings of edges have found it
                if u <= 0.0 || v <= 0.0 || u >= 1.0 || v >= 1.0 {
                    continue;
                }
                push([x, y, corner[2] + u * e[2] + v * g[2]]);
            }
        }

        // the deepest corner even where it overhangs, which the clean-up is left to see; the others over the rectangle
        push(corner);
        let mut push_inside = |point: Vec3| {
            if !(point[0] <= -size[0] || point[0] >= size[0] || point[1] <= -size[1] || point[1] >= size[1]) {
                push(point);
            }
        };
        if count >= 1 {
            push_inside(add(corner, e));
        }
        if count == 2 {
            push_inside(add(corner, g));
            push_inside(add(add(corner, e), g));
        }
    }
}
