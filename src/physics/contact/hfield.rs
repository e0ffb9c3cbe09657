//! Height fields: each half of a grid square is a prism, which touches like a convex shape.

use super::ccd_support::CcdSupport;
use super::epa::epa;
use super::fix_normal::fixed;
use super::flex_part::FlexPart;
use super::gjk::{GjkLimits, Simplex, gjk};
use super::mesh::MeshShape;
use super::polytope::Polytope;
use super::support::{Ball, Capsule, Cuboid, Cylinder, Ellipsoid, MinkowskiDifference, Point, Segment, Support};
use super::{BareContact, ContactOptions, ContactPoint, MAXVAL, PlacedGeom, add_scaled, dot, frame, mpr, sub};
use crate::math::{Mat3, Vec3, add, mat_mul, mat_t_vec, mat_vec, scale, transpose, unit};
use crate::model::{GeomType, HField};

/// Maximum number of contacts of a height field and another geom (MuJoCo's `mjMAXCONPAIR`).
const MOST: usize = 50;

/// A prism between the base of a height field and a triangle of its surface: three lower corners, then the three above them.
struct Prism {
    corners: [Vec3; 6],
}

impl Support for Prism {
    fn support(&self, dir: Vec3) -> Vec3 {
        let first = if dir[2] < 0.0 { 0 } else { 3 };
        let (mut best, mut highest) = (first, dot(self.corners[first], dir));
        for k in first + 1..first + 3 {
            let height = dot(self.corners[k], dir);
            if height > highest {
                (best, highest) = (k, height);
            }
        }
        self.corners[best]
    }
}

impl Prism {
    /// Advances to the next corner of a row of triangles.
    fn push(&mut self, x: f64, y: f64, z: f64) {
        let base = self.corners[2][2];
        self.corners.copy_within(1..3, 0);
        self.corners.copy_within(4..6, 3);
        self.corners[2] = [x, y, base];
        self.corners[5] = [x, y, z];
    }

    fn centre(&self) -> Vec3 {
        let sum = self.corners.iter().fold([0.0; 3], |sum, corner| add(sum, *corner));
        scale(sum, 1.0 / 6.0)
    }

    fn is_below(&self, z: f64) -> bool {
        self.corners[3..].iter().all(|corner| corner[2] < z)
    }
}

/// The other geom, in the frame of the height field.
struct LocalGeom<'a> {
    pos: Vec3,
    /// The point or segment inside a sphere or capsule, and the distance of the surface from it.
    core: Option<(&'a dyn Support, f64)>,
    whole: &'a dyn Support,
}

/// Appends the contacts of a height field and another geom.
pub(super) fn hfield(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    polytope: &mut Polytope,
    out: &mut Vec<ContactPoint>,
) {
    let Some(field) = a.hfield else { return };
    let mat: Mat3 = mat_mul(&transpose(a.mat), b.mat);
    let local = PlacedGeom {
        pos: mat_t_vec(a.mat, sub(b.pos, a.pos)),
        mat: &mat,
        ..*b
    };
    if local.kind == GeomType::Mesh && local.mesh.is_none() {
        return;
    }
    let bare = CcdSupport::new(&local, 0.0, 0);
    let Some(cells) = cells(field, &bare, margin) else {
        return;
    };
    let found = |BareContact { dist, pos, normal }: BareContact| {
        let normal = mat_vec(a.mat, normal);
        let pos = add(mat_vec(a.mat, pos), a.pos);
        let frame = frame::from_normal(fixed(a, b, pos, normal));
        out.push(ContactPoint { dist, pos, frame });
    };
    if options.nativeccd {
        with_shape(&local, margin, |other| {
            let touch = |prism: &Prism| overlap(prism, other, options, polytope);
            touch_cells(field, &cells, margin, touch, found);
        });
    } else {
        let other = CcdSupport::new(&local, margin, bare.corner());
        let limits = mpr::MprLimits {
            tolerance: options.ccd_tolerance,
            iterations: options.ccd_iterations,
        };
        let touch = |prism: &Prism| penetration(prism, (&other, local.pos), &limits);
        touch_cells(field, &cells, margin, touch, found);
    }
}

/// Appends the contacts of a height field and an element of a flex.
pub(super) fn hfield_flex(
    a: &PlacedGeom,
    element: &FlexPart,
    margin: f64,
    options: &ContactOptions,
    polytope: &mut Polytope,
    out: &mut Vec<ContactPoint>,
) {
    let Some(field) = a.hfield else { return };
    let local = element.within(a);
    let Some(cells) = cells(field, &local.bare(), margin) else {
        return;
    };
    let found = |BareContact { dist, pos, normal }: BareContact| {
        let pos = add(mat_vec(a.mat, pos), a.pos);
        let frame = frame::from_normal(mat_vec(a.mat, normal));
        out.push(ContactPoint { dist, pos, frame });
    };
    let (pos, whole) = (local.centre, local.grown(0.5 * margin));
    if options.nativeccd {
        let other = LocalGeom {
            pos,
            core: None,
            whole: &whole,
        };
        let touch = |prism: &Prism| overlap(prism, &other, options, polytope);
        touch_cells(field, &cells, margin, touch, found);
    } else {
        let limits = mpr::MprLimits {
            tolerance: options.ccd_tolerance,
            iterations: options.ccd_iterations,
        };
        let touch = |prism: &Prism| penetration(prism, (&whole, pos), &limits);
        touch_cells(field, &cells, margin, touch, found);
    }
}

/// Calls `run` with a geom grown by half the margin.
fn with_shape(geom: &PlacedGeom, margin: f64, run: impl FnOnce(&LocalGeom)) {
    let (pos, radius) = (geom.pos, geom.size[0] + 0.5 * margin);
    match geom.kind {
        GeomType::Sphere => run(&LocalGeom {
            pos,
            core: Some((&Point::new(geom), radius)),
            whole: &Ball::new(geom, margin),
        }),
        GeomType::Capsule => run(&LocalGeom {
            pos,
            core: Some((&Segment::new(geom), radius)),
            whole: &Capsule::new(geom, margin),
        }),
        GeomType::Ellipsoid => run(&LocalGeom {
            pos,
            core: None,
            whole: &Ellipsoid::new(geom, margin),
        }),
        GeomType::Cylinder => run(&LocalGeom {
            pos,
            core: None,
            whole: &Cylinder::new(geom, margin),
        }),
        GeomType::Box => run(&LocalGeom {
            pos,
            core: None,
            whole: &Cuboid::new(geom, margin),
        }),
        GeomType::Mesh => {
            if let Some(mesh) = geom.mesh {
                run(&LocalGeom {
                    pos,
                    core: None,
                    whole: &MeshShape::new(geom, mesh, margin),
                });
            }
        }
        GeomType::Plane | GeomType::HField => {}
    }
}

/// The grid cells that a geom may touch, and the geom's lowest point.
struct GridCells {
    rows: std::ops::Range<usize>,
    columns: std::ops::RangeInclusive<usize>,
    lowest: f64,
}

/// Finds the squares under a geom; `None` if it is not over, in or under the height field.
fn cells(field: &HField, whole: &dyn Support, margin: f64) -> Option<GridCells> {
    let [x, y, top, base] = field.size;
    let reach = |k: usize, sign: f64| {
        let mut dir = [0.0; 3];
        dir[k] = sign;
        whole.support(dir)[k]
    };
    let (high, low) = ([0, 1, 2].map(|k| reach(k, 1.0)), [0, 1, 2].map(|k| reach(k, -1.0)));
    let apart = |low: f64, high: f64, least: f64, most: f64| low - margin > most || high + margin < least;
    let outside = apart(low[0], high[0], -x, x) || apart(low[1], high[1], -y, y) || apart(low[2], high[2], -base, top);
    // NaN is nowhere
    if outside || !(low.iter().chain(&high).all(|v| v.is_finite())) {
        return None;
    }
    let place = |at: f64, half: f64, count: usize| (at + half) / (2.0 * half) * (count - 1) as f64;
    let range = |low: f64, high: f64, half: f64, count: usize| {
        let last = (count - 1) as f64;
        let first = place(low, half, count).floor().clamp(0.0, last) as usize;
        first..place(high, half, count).ceil().clamp(0.0, last) as usize
    };
    let columns = range(low[0], high[0], x, field.ncol);
    Some(GridCells {
        rows: range(low[1], high[1], y, field.nrow),
        columns: columns.start..=columns.end,
        lowest: low[2],
    })
}

/// Calls `found` with each contact; `touch` finds that with a prism.
fn touch_cells(
    field: &HField,
    cells: &GridCells,
    margin: f64,
    mut touch: impl FnMut(&Prism) -> Option<BareContact>,
    mut found: impl FnMut(BareContact),
) {
    let [x, y, top, base] = field.size;
    let (dx, dy) = (2.0 * x / (field.ncol - 1) as f64, 2.0 * y / (field.nrow - 1) as f64);
    let mut prism = Prism {
        corners: [[0.0, 0.0, -base]; 6],
    };
    let mut count = 0;
    for r in cells.rows.clone() {
        let mut corners = 0;
        for c in cells.columns.clone() {
            for row in [r + 1, r] {
                let height = field.data.get(row * field.ncol + c).copied().unwrap_or_default();
                prism.push(dx * c as f64 - x, dy * row as f64 - y, f64::from(height) * top + margin);
                corners += 1;
                if corners < 3 || prism.is_below(cells.lowest) {
                    continue;
                }
                if let Some(contact) = touch(&prism) {
                    found(contact);
                    count += 1;
                    if count == MOST {
                        return;
                    }
                }
            }
        }
    }
}

/// Finds the contact of a prism and a geom that overlap, by MPR.
fn penetration(prism: &Prism, other: (&dyn Support, Vec3), limits: &mpr::MprLimits) -> Option<BareContact> {
    let found = mpr::mpr((prism, prism.centre()), other, limits)?;
    Some(BareContact {
        dist: -found.depth,
        pos: found.pos,
        normal: found.dir,
    })
}

/// Finds the contact of a prism and a geom that overlap, by GJK and EPA.
fn overlap(prism: &Prism, other: &LocalGeom, options: &ContactOptions, polytope: &mut Polytope) -> Option<BareContact> {
    let (dist, first, second) = deepest(prism, other, options, polytope)?;
    Some(BareContact {
        dist,
        pos: scale(add(first, second), 0.5),
        normal: unit(sub(first, second)).0,
    })
}

/// Returns the distance of a prism and a geom that overlap, and the deepest point of either.
fn deepest(
    prism: &Prism,
    other: &LocalGeom,
    options: &ContactOptions,
    polytope: &mut Polytope,
) -> Option<(f64, Vec3, Vec3)> {
    let limits = |cutoff: f64| GjkLimits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
        cutoff,
        stop_at_same_centre: options.quirks.same_centre_is_no_contact,
    };
    let (first, centre): (&dyn Support, Vec3) = (prism, prism.centre());
    if let Some((core, radius)) = other.core {
        let shape = MinkowskiDifference { a: first, b: core };
        let closest = gjk(&shape, centre, other.pos, &limits(radius), &mut Simplex::default());
        if closest.distance > options.ccd_tolerance {
            let dist = closest.distance - radius;
            if closest.distance >= MAXVAL || dist >= 0.0 {
                return None;
            }
            let towards = unit(sub(closest.b, closest.a)).0;
            return Some((dist, closest.a, add_scaled(closest.b, towards, -radius)));
        }
    }
    let shape = MinkowskiDifference {
        a: first,
        b: other.whole,
    };
    let mut simplex = Simplex::default();
    let limits = limits(0.0);
    let closest = gjk(&shape, centre, other.pos, &limits, &mut simplex);
    if closest.distance > limits.tolerance || simplex.len < 2 {
        return None;
    }
    let overlap = epa(&shape, &simplex, limits.tolerance, limits.iterations, polytope)?;
    (overlap.depth > 0.0).then_some((-overlap.depth, overlap.a, overlap.b))
}
