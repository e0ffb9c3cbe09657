//! Points and elements of a `<flexcomp>`, as MuJoCo 3.3.0 makes and numbers them.

use std::f64::consts::PI;

use crate::compile::normalize;
use crate::flex::{FlexComp, FlexCompType};
use crate::math::{MINVAL, Vec3, cross, dot, sub};

/// Below this a coordinate counts as zero.
const EPS: f64 = 1e-14;

const EMPTY: &str = "the grid has no elements: give it more points";
const THIN: &str = "boxes, cylinders and ellipsoids need two points along each axis";
const LONE: &str = "a circle needs a count of three at least, one more than its points";

/// A shape: its points, the vertices of its elements, and texture coordinates, if any.
#[derive(Default)]
pub(super) struct FlexShape {
    pub points: Vec<Vec3>,
    pub elements: Vec<usize>,
    pub texcoord: Vec<f64>,
}

/// The grid of a shape.
struct Lattice {
    kind: FlexCompType,
    count: [usize; 3],
    spacing: Vec3,
    /// Whether points get texture coordinates.
    textured: bool,
}

impl FlexShape {
    /// Makes the shape of a `<flexcomp>` that is neither a mesh nor written point by point.
    pub fn of(comp: &FlexComp, count: [usize; 3]) -> Result<Self, &'static str> {
        let lattice = Lattice {
            kind: comp.kind,
            count,
            spacing: comp.spacing,
            textured: comp.look.texcoord.is_empty() && comp.look.material.as_ref().is_some_and(|name| !name.is_empty()),
        };
        let mut shape = Self::default();
        match comp.kind {
            FlexCompType::Box | FlexCompType::Cylinder | FlexCompType::Ellipsoid => {
                if count.contains(&1) {
                    return Err(THIN);
                }
                lattice.solid(&mut shape);
            }
            _ => match comp.look.dim {
                1 if comp.kind == FlexCompType::Circle => {
                    if count[0] < 3 {
                        return Err(LONE);
                    }
                    lattice.circle(&mut shape);
                }
                1 => lattice.line(&mut shape),
                2 => lattice.square(&mut shape),
                _ => lattice.cubes(&mut shape),
            },
        }
        if shape.elements.is_empty() {
            return Err(EMPTY);
        }
        Ok(shape)
    }

    /// Makes tetrahedra from the triangles of a mesh and a point inside.
    pub fn filled(&mut self, origin: Vec3) {
        self.points.insert(0, origin);
        let triangles = std::mem::take(&mut self.elements);
        for triangle in triangles.as_chunks::<3>().0 {
            let corners = triangle.map(|v| v + 1);
            let [a, b, c] = corners.map(|v| sub(self.points[v], origin));
            if dot(cross(a, b), c) >= MINVAL {
                self.elements.push(0);
                self.elements.extend(corners);
            }
        }
    }
}

impl Lattice {
    /// Returns a coordinate along an axis of a centred grid.
    fn along(&self, axis: usize, i: usize) -> f64 {
        self.spacing[axis] * (i as f64 - 0.5 * (self.count[axis] as f64 - 1.0))
    }

    /// Returns the largest of 1 and the number of intervals along an axis.
    fn intervals(&self, axis: usize) -> f64 {
        (self.count[axis] as f64 - 1.0).max(1.0)
    }

    /// Adds texture coordinates in single precision.
    fn paint(&self, shape: &mut FlexShape, [a, i]: [usize; 2], [b, k]: [usize; 2]) {
        if self.textured {
            let coordinate = |axis, i: usize| f64::from(i as f32 / self.intervals(axis) as f32);
            shape.texcoord.extend([coordinate(a, i), coordinate(b, k)]);
        }
    }

    fn line(&self, shape: &mut FlexShape) {
        for i in 0..self.count[0] {
            shape.points.push([self.along(0, i), 0.0, 0.0]);
            if i + 1 < self.count[0] {
                shape.elements.extend([i, i + 1]);
            }
        }
    }

    /// Makes a closed line, of one point fewer than the count.
    fn circle(&self, shape: &mut FlexShape) {
        let last = self.count[0] - 1;
        let theta = 2.0 * PI / last as f64;
        let radius = self.spacing[0] / pxfm::f_sin(theta / 2.0) / 2.0;
        for i in 0..last {
            let angle = theta * i as f64;
            shape
                .points
                .push([radius * pxfm::f_cos(angle), radius * pxfm::f_sin(angle), 0.0]);
            shape.elements.extend([i, (i + 1) % last]);
        }
    }

    fn square(&self, shape: &mut FlexShape) {
        let [nx, ny, nz] = self.count;
        let disc = self.kind == FlexCompType::Disc;
        for ix in 0..nx {
            for iy in 0..ny {
                let [x, y] = [self.along(0, ix), self.along(1, iy)];
                shape.points.push([x, y, 0.0]);
                if self.textured {
                    let (u, v) = (ix as f64 / self.intervals(0), iy as f64 / self.intervals(1));
                    shape.texcoord.extend([u, v].map(|x| f64::from(x as f32)));
                }
                if ix + 1 == nx || iy + 1 == ny {
                    continue;
                }
                // diagonals of a disc point to its centre
                let flipped = disc && ((x < -EPS && y > -EPS) || (x > -EPS && y < -EPS));
                let corner = |dx: usize, dy: usize| nz * ny * (ix + dx) + nz * (iy + dy);
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                shape.elements.extend(if flipped {
                    [a, b, d, b, c, d]
                } else {
                    [a, b, c, a, c, d]
                });
            }
        }
        if disc {
            let size = self.sizes();
            for point in &mut shape.points {
                let [x, y] = round([point[0], point[1]], size);
                *point = [x, y, 0.0];
            }
        }
    }

    fn cubes(&self, shape: &mut FlexShape) {
        const TETRAHEDRA: [[usize; 4]; 6] = [
            [0, 3, 1, 7],
            [0, 1, 4, 7],
            [1, 3, 2, 7],
            [1, 2, 6, 7],
            [1, 5, 4, 7],
            [1, 6, 5, 7],
        ];
        let [nx, ny, nz] = self.count;
        for (ix, iy, iz) in (0..nx).flat_map(|x| (0..ny).flat_map(move |y| (0..nz).map(move |z| (x, y, z)))) {
            shape
                .points
                .push([self.along(0, ix), self.along(1, iy), self.along(2, iz)]);
            self.paint(shape, [0, ix], [1, iy]);
            if ix + 1 == nx || iy + 1 == ny || iz + 1 == nz {
                continue;
            }
            let corner = |dx: usize, dy: usize, dz: usize| nz * ny * (ix + dx) + nz * (iy + dy) + iz + dz;
            let square = |dz| [corner(0, 0, dz), corner(1, 0, dz), corner(1, 1, dz), corner(0, 1, dz)];
            let corners = [square(0), square(1)];
            let corner = |k: usize| corners[k / 4][k % 4];
            shape.elements.extend(TETRAHEDRA.iter().flatten().map(|&k| corner(k)));
        }
    }

    /// Makes tetrahedra between the centre, which is point 0, and the squares on the sides.
    fn solid(&self, shape: &mut FlexShape) {
        shape.points.push([0.0; 3]);
        self.paint(shape, [0, 0], [0, 0]);
        // axes across and along each pair of sides; points on an edge belong to the first side that they are on
        for (across, [a, b]) in [(2, [0, 1]), (1, [0, 2]), (0, [1, 2])] {
            let inner = |axis: usize, i: usize| i > 0 && i + 1 < self.count[axis];
            for side in [0, self.count[across] - 1] {
                for (i, k) in (0..self.count[a]).flat_map(|i| (0..self.count[b]).map(move |k| (i, k))) {
                    let at = |i: usize, k: usize| {
                        let mut place = [side; 3];
                        (place[a], place[b]) = (i, k);
                        place
                    };
                    let own = match across {
                        2 => true,
                        1 => inner(2, k),
                        _ => inner(1, i) && inner(2, k),
                    };
                    if own {
                        shape.points.push(self.project(at(i, k)));
                        self.paint(shape, [a, i], [b, k]);
                    }
                    if i + 1 < self.count[a] && k + 1 < self.count[b] {
                        let [p, q, r, s] =
                            [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)].map(|p| self.number(p));
                        shape.elements.extend([0, p, q, r, 0, p, s, r]);
                    }
                }
            }
        }
    }

    /// Returns the number of a point on the sides.
    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        let [nx, ny, nz] = self.count;
        let (tops, inner) = (2 * nx * ny, nz - 2);
        1 + if z == 0 {
            x * ny + y
        } else if z + 1 == nz {
            nx * ny + x * ny + y
        } else if y == 0 {
            tops + x * inner + z - 1
        } else if y + 1 == ny {
            tops + nx * inner + x * inner + z - 1
        } else {
            let before = if x == 0 { 0 } else { (ny - 2) * inner };
            tops + 2 * nx * inner + before + (y - 1) * inner + z - 1
        }
    }

    /// Returns half the lengths of the grid.
    fn sizes(&self) -> Vec3 {
        std::array::from_fn(|k| 0.5 * self.spacing[k] * (self.count[k] as f64 - 1.0))
    }

    /// Returns the position of a point on the sides of the box, moved onto the shape.
    fn project(&self, place: [usize; 3]) -> Vec3 {
        let size = self.sizes();
        let mut pos: Vec3 = std::array::from_fn(|k| 2.0 * place[k] as f64 / (self.count[k] as f64 - 1.0) - 1.0);
        match self.kind {
            FlexCompType::Cylinder => {
                let [x, y] = round([pos[0], pos[1]], size);
                return [x, y, pos[2] * size[2]];
            }
            FlexCompType::Ellipsoid => {
                normalize(&mut pos);
            }
            _ => {}
        }
        std::array::from_fn(|k| pos[k] * size[k])
    }
}

/// Moves a point of a square of half length 1 onto an ellipse.
fn round([x, y]: [f64; 2], size: Vec3) -> [f64; 2] {
    let far = x.abs().max(y.abs());
    let mut direction = [x, y];
    normalize(&mut direction);
    [direction[0] * (size[0] * far), direction[1] * (size[1] * far)]
}
