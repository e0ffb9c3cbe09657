//! Support functions of convex geoms as MuJoCo passes them to libccd, and the contact that MPR finds between two of them.

use std::cell::Cell;

use super::fix_normal::fixed;
use super::mesh::climb_from;
use super::mpr::{MprLimits, mpr};
use super::support::Support;
use super::{BareContact, ContactOptions, PlacedGeom};
use crate::math::{Vec3, add, mat_t_vec, mat_vec, scale, unit};
use crate::model::GeomType;

/// A convex geom of any kind, grown by half the margin (MuJoCo's `mjccd_support`).
pub(super) struct CcdSupport<'a> {
    geom: &'a PlacedGeom<'a>,
    margin: f64,
    /// The last corner found on a mesh's hull, from which the next search starts.
    corner: Cell<usize>,
}

impl<'a> CcdSupport<'a> {
    /// Creates the shape of a geom; `corner` is of its hull.
    pub(super) fn new(geom: &'a PlacedGeom<'a>, margin: f64, corner: usize) -> Self {
        let corner = Cell::new(corner);
        CcdSupport { geom, margin, corner }
    }

    /// Returns the last corner found on its hull.
    pub(super) fn corner(&self) -> usize {
        self.corner.get()
    }

    /// Returns the farthest point of a mesh, of the vertices of its hull.
    fn of_mesh(&self, dir: Vec3) -> Vec3 {
        let Some(mesh) = self.geom.mesh else { return [0.0; 3] };
        let (corner, vertex) = climb_from(mesh, self.corner.get(), dir);
        self.corner.set(corner.unwrap_or_default());
        mesh.vert[vertex].map(f64::from)
    }
}

/// Returns the sign of a number, zero for either zero: across an axis, the middle of a side is the farthest point.
fn sign(x: f64) -> f64 {
    match x {
        x if x > 0.0 => 1.0,
        x if x < 0.0 => -1.0,
        _ => 0.0,
    }
}

impl Support for CcdSupport<'_> {
    fn support(&self, dir: Vec3) -> Vec3 {
        let PlacedGeom { kind, size, mat, .. } = *self.geom;
        let local = mat_t_vec(mat, dir);
        let by_size = |v: Vec3| [v[0] * size[0], v[1] * size[1], v[2] * size[2]];
        let point = match kind {
            GeomType::Sphere => scale(local, size[0]),
            GeomType::Capsule => {
                let [x, y, z] = scale(local, size[0]);
                [x, y, z + sign(local[2]) * size[1]]
            }
            GeomType::Ellipsoid => by_size(unit(by_size(local)).0),
            GeomType::Cylinder => {
                let radial = (local[0] * local[0] + local[1] * local[1]).sqrt();
                let z = sign(local[2]) * size[1];
                if radial > crate::math::MINVAL {
                    [local[0] / radial * size[0], local[1] / radial * size[0], z]
                } else {
                    [0.0, 0.0, z]
                }
            }
            GeomType::Box => by_size(local.map(sign)),
            GeomType::Mesh => self.of_mesh(local),
            GeomType::Plane | GeomType::HField => [0.0; 3],
        };
        let grown = local.map(|x| x * self.margin / 2.0);
        add(mat_vec(mat, add(point, grown)), self.geom.pos)
    }
}

/// Finds the contact of two convex geoms by MPR. The searches for farthest points start at `corners` of the two hulls and store the last ones found
/// there.
pub(super) fn convex(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    corners: &mut [usize; 2],
) -> Option<BareContact> {
    if [a, b]
        .iter()
        .any(|geom| geom.kind == GeomType::Mesh && geom.mesh.is_none())
    {
        return None;
    }
    let (first, second) = (
        CcdSupport::new(a, margin, corners[0]),
        CcdSupport::new(b, margin, corners[1]),
    );
    let limits = MprLimits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
    };
    let found = mpr((&first, a.pos), (&second, b.pos), &limits);
    *corners = [first.corner(), second.corner()];
    let found = found?;
    Some(BareContact {
        dist: margin - found.depth,
        pos: found.pos,
        normal: fixed(a, b, found.pos, found.dir),
    })
}
