//! The same skin on a body with other proportions.

use super::grid::Grid;
use super::layout::{SkinBody, SkinLayout};
use crate::math::{Vec3, add, mat_t_vec, mat_vec, quat_normalize, quat_to_mat, sub};
use crate::model::{GeomType, Model};

impl SkinLayout {
    /// Returns the same sensors, in the same order, on a model whose geoms have different sizes and places. Each keeps its place on its geom.
    /// The models have the same bodies and geoms.
    ///
    /// The distance between the sensors of a body is scaled by the largest ratio of its geoms' bounding radii.
    pub fn scaled(&self, from: &Model, to: &Model) -> Self {
        let mut scaled = self.clone();
        for body in &mut scaled.bodies {
            scale(body, from, to);
        }
        scaled
    }
}

fn scale(body: &mut SkinBody, from: &Model, to: &Model) {
    let mut largest: f64 = 0.0;
    for geom in &mut body.geoms {
        let g = geom.geom;
        let mat = quat_to_mat(quat_normalize(to.geom_quat[g]));
        for pos in &mut body.positions[geom.sensors.clone()] {
            let local = mat_t_vec(&geom.mat, sub(*pos, from.geom_pos[g]));
            let moved = stretch(from.geom_type[g], from.geom_size[g], to.geom_size[g], local);
            *pos = add(mat_vec(&mat, moved), to.geom_pos[g]);
        }
        geom.mat = mat;
        largest = largest.max(to.geom_rbound[g] / from.geom_rbound[g]);
    }
    body.spacing *= largest;
    body.grid = Grid::new(&body.positions, 2.0 * body.spacing);
}

/// Moves a point on or in a geom, in its frame, to its position after the size changes from `a` to `b`.
fn stretch(kind: GeomType, a: Vec3, b: Vec3, [x, y, z]: Vec3) -> Vec3 {
    let [r, l] = [b[0] / a[0], b[1] / a[1]];
    match kind {
        GeomType::Plane | GeomType::HField => [x, y, z],
        GeomType::Sphere => [x * r, y * r, z * r],
        GeomType::Box | GeomType::Ellipsoid | GeomType::Mesh => [x * r, y * l, z * (b[2] / a[2])],
        GeomType::Cylinder => [x * r, y * r, z * l],
        GeomType::Capsule => {
            // the wall stretches with the length, the caps with the radius
            let wall = z.clamp(-a[1], a[1]);
            [x * r, y * r, wall * l + (z - wall) * r]
        }
    }
}
