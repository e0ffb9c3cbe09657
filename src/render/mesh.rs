//! The tessellations of MuJoCo's classic renderer: 28 slices, 16 stacks, 4 quads per box edge. Silhouettes and shading
//! depend on them. Vertices lie on unit shapes; each [`MeshPart`] has its own transform. A mesh is cut into bands, so that bands out of view need not
//! be drawn.

use std::f64::consts::PI;

use super::patch::Patch;
use super::strip::{LANES, STRIP_LANES, Strip};

const SLICES: usize = 28;
const STACKS: usize = 16;
const QUADS: usize = 4;
/// Number of stacks of a cylinder in a band.
const BAND_STACKS: usize = 4;

/// A part of a mesh with its own transform: the caps of a capsule stay at the ends of the scaled cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshPart {
    /// Vertices scaled by the size.
    Body,
    /// The upper cap of a capsule, z from 1 to 2.
    Top,
    /// The lower cap of a capsule, z from -1 to -2.
    Bottom,
}

/// Maximum number of vertices of a mesh: triangles count them in 16 bits, and a mesh is padded to whole groups.
pub(super) const MOST: usize = (1 << 16) - LANES;

/// A part of a mesh, or a slice of one, that has its own vertices.
#[derive(Clone, Debug)]
pub struct Band {
    /// The part to which it belongs.
    pub part: MeshPart,
    /// Vertices.
    pub vertices: std::ops::Range<usize>,
    /// Triangles.
    pub triangles: std::ops::Range<usize>,
    /// Number of its triangles that belong to no strip; they come first.
    pub loose: usize,
    /// Strips of the other triangles, in order.
    pub strips: Vec<Strip>,
    /// Patches of these.
    pub patches: std::ops::Range<usize>,
    /// Least coordinates of its vertices.
    pub low: [f32; 3],
    /// Greatest coordinates of its vertices.
    pub high: [f32; 3],
    /// Greatest differences between coordinates of two corners of a triangle.
    pub edge: [f32; 3],
}

/// A triangle mesh of a unit shape, counterclockwise from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Coordinates x of the vertices. Vertices that only pad a band belong to no triangle.
    pub x: Vec<f32>,
    /// Coordinates y of the vertices.
    pub y: Vec<f32>,
    /// Coordinates z of the vertices.
    pub z: Vec<f32>,
    /// Unit normals of the vertices.
    pub normal: Vec<[f32; 3]>,
    /// Texture coordinates of the vertices; empty if they follow from positions.
    pub texcoord: Vec<[f32; 2]>,
    /// The part to which each vertex belongs.
    part: Vec<MeshPart>,
    /// Bands, in the order of their vertices and triangles.
    pub bands: Vec<Band>,
    /// Indices of the vertices of each triangle.
    pub triangles: Vec<[u16; 3]>,
    /// Patches of the strips, in order.
    pub patches: Vec<Patch>,
}

/// Corners of the first of a row of quadrilaterals: along the lower row and back along the upper one.
const ALONG: [(usize, u16); 4] = [(0, 0), (0, 1), (1, 1), (1, 0)];
/// The same, from the lower row to the upper one and back.
const ACROSS: [(usize, u16); 4] = [(0, 0), (1, 0), (1, 1), (0, 1)];

pub(super) type MeshPoint = ([f32; 3], [f32; 3]);

impl Mesh {
    /// Returns the part that a vertex belongs to.
    pub fn part_of(&self, vertex: usize) -> MeshPart {
        self.part[vertex]
    }

    /// Returns the index of a vertex of the current band, after adding it if it is new.
    fn vertex(&mut self, (p, n): MeshPoint) -> u16 {
        let first = self.bands.last().map_or(0, |band| band.vertices.start);
        let known = (first..self.x.len()).rev().find(|&i| {
            // vertices are shared only if light and place are the same to the bit, so that sharing is never visible
            let same = |a: f32, b: f32| a.to_bits() == b.to_bits();
            same(self.x[i], p[0])
                && same(self.y[i], p[1])
                && same(self.z[i], p[2])
                && (0..3).all(|k| same(self.normal[i][k], n[k]))
        });
        known.unwrap_or_else(|| {
            self.push((p, n));
            self.x.len() - 1
        }) as u16
    }

    pub(super) fn push(&mut self, ([x, y, z], normal): MeshPoint) {
        self.x.push(x);
        self.y.push(y);
        self.z.push(z);
        self.normal.push(normal);
        if let Some(band) = self.bands.last_mut() {
            band.vertices.end = self.x.len();
            self.part.push(band.part);
            for (k, v) in [x, y, z].into_iter().enumerate() {
                band.low[k] = band.low[k].min(v);
                band.high[k] = band.high[k].max(v);
            }
        }
    }

    /// Begins a band.
    pub(super) fn band(&mut self, part: MeshPart) {
        self.fill();
        let (vertices, triangles) = (self.x.len(), self.triangles.len());
        self.bands.push(Band {
            part,
            vertices: vertices..vertices,
            triangles: triangles..triangles,
            loose: 0,
            strips: Vec::new(),
            patches: self.patches.len()..self.patches.len(),
            low: [f32::INFINITY; 3],
            high: [f32::NEG_INFINITY; 3],
            edge: [0.0; 3],
        });
    }

    /// Adds a strip of vertices of the current band, with its triangles.
    fn add(&mut self, mut strip: Strip) {
        for j in 0..strip.count {
            let [a, b, c, d] = strip.corners(j);
            self.triangles.push([a, b, d]);
            if !strip.fan {
                self.triangles.push([b, c, d]);
            }
        }
        if let Some(band) = self.bands.last_mut() {
            for t in &self.triangles[band.triangles.end..] {
                for (edge, v) in band.edge.iter_mut().zip([&self.x, &self.y, &self.z]) {
                    let [a, b, c] = t.map(|i| v[usize::from(i)]);
                    *edge = edge.max((a - b).abs()).max((b - c).abs()).max((c - a).abs());
                }
            }
            band.triangles.end = self.triangles.len();
            // the faces of a box have rows of four, disks and spheres of 28; a plane's single quadrilateral goes by
            // itself
            if strip.count.is_multiple_of(STRIP_LANES) {
                strip.patch = self.patches.len();
                let at = |i: u16| [self.x[usize::from(i)], self.y[usize::from(i)], self.z[usize::from(i)]];
                self.patches.extend(
                    (0..strip.count)
                        .step_by(STRIP_LANES)
                        .map(|first| Patch::new(&strip, first, at)),
                );
                band.patches.end = self.patches.len();
                band.strips.push(strip);
            } else {
                band.loose = band.triangles.len();
            }
        }
    }

    /// Adds the vertices of a row that are new; returns the first. They are consecutive.
    fn row(&mut self, count: usize, at: impl Fn(usize) -> MeshPoint) -> u16 {
        let first = self.vertex(at(0));
        for j in 1..=count {
            self.vertex(at(j));
        }
        first
    }

    /// Adds quadrilaterals between two rows of vertices, `at(column, row)`, split along the diagonal that Mesa chooses.
    /// `corners` are the rows and columns of those of the first; they are in the opposite order if it does not face
    /// outward.
    fn strip(
        &mut self,
        count: usize,
        outward: bool,
        corners: [(usize, u16); 4],
        at: impl Fn(usize, usize) -> MeshPoint,
    ) {
        let rows = [0, 1].map(|k| self.row(count, |j| at(j, k)));
        let mut first = corners.map(|(row, column)| rows[row] + column);
        if !outward {
            first.reverse();
        }
        self.add(Strip {
            first,
            step: [1; 4],
            count,
            fan: false,
            patch: 0,
        });
    }

    /// Adds triangles between a row of vertices and a point.
    fn fan(&mut self, count: usize, outward: bool, at: impl Fn(usize) -> MeshPoint, point: MeshPoint) {
        let row = self.row(count, at);
        let point = self.vertex(point);
        let (first, step) = if outward {
            ([row, row + 1, point, point], [1, 1, 0, 0])
        } else {
            ([point, row + 1, row, row], [0, 1, 1, 1])
        };
        self.add(Strip {
            first,
            step,
            count,
            fan: true,
            patch: 0,
        });
    }

    /// Pads the current band with copies of its last vertex, so that vertices are projected in whole groups.
    pub(super) fn fill(&mut self) {
        while let Some(last) = self.x.len().checked_sub(1)
            && !self.x.len().is_multiple_of(LANES)
        {
            self.push(([self.x[last], self.y[last], self.z[last]], self.normal[last]));
            if let Some(&coordinates) = self.texcoord.last() {
                self.texcoord.push(coordinates);
            }
        }
    }

    /// Completes a mesh of one band whose triangles are in no strip.
    pub(super) fn end_loose(&mut self) {
        self.fill();
        if let Some(band) = self.bands.last_mut() {
            band.triangles = 0..self.triangles.len();
            band.loose = self.triangles.len();
        }
    }

    /// Adds one half of a sphere, shifted along z by `shift`.
    fn half_sphere(&mut self, sign: f64, shift: f64) {
        let stacks = STACKS / 2;
        let up = sign > 0.0;
        // MuJoCo keeps angles in single precision, and takes sines of them in double
        let elevation = |i: usize| f64::from((0.5 * PI * sign * i as f64 / stacks as f64) as f32);
        let at = |j: usize, i: usize| {
            let (sin, cos) = pxfm::f_sincos(elevation(i));
            let (s, c) = azimuth(j);
            let n = [c * cos, s * cos, sin];
            ([n[0] as f32, n[1] as f32, (n[2] + shift) as f32], n.map(|v| v as f32))
        };
        let pole = ([0.0, 0.0, (sign + shift) as f32], [0.0, 0.0, sign as f32]);
        self.fan(SLICES, up, |j| at(j, stacks - 1), pole);
        for i in 0..stacks - 1 {
            self.strip(SLICES, up, ALONG, |j, k| at(j, i + k));
        }
    }

    fn open_cylinder(&mut self) {
        let at = |j: usize, i: usize| {
            let (s, c) = azimuth(j);
            let (c, s) = (c as f32, s as f32);
            ([c, s, (2.0 * i as f64 / STACKS as f64 - 1.0) as f32], [c, s, 0.0])
        };
        for i in 0..STACKS {
            if i.is_multiple_of(BAND_STACKS) {
                self.band(MeshPart::Body);
            }
            self.strip(SLICES, true, ALONG, |j, k| at(j, i + k));
        }
    }

    /// Creates a cylinder without ends.
    pub(super) fn pipe() -> Self {
        let mut m = Self::default();
        m.open_cylinder();
        m.fill();
        m
    }

    fn disk(&mut self, sign: f32) {
        let rings = STACKS / 2;
        let up = sign > 0.0;
        let at = |j: usize, k: usize| {
            let (s, c) = azimuth(j);
            let r = f64::from(k as f32 / rings as f32);
            ([(c * r) as f32, (s * r) as f32, sign], [0.0, 0.0, sign])
        };
        let centre = ([0.0, 0.0, sign], [0.0, 0.0, sign]);
        self.fan(SLICES, up, |j| at(j, 1), centre);
        for k in 1..rings {
            self.strip(SLICES, up, ALONG, |j, inner| at(j, k + 1 - inner));
        }
    }

    fn face(&mut self, axis: usize, sign: f32) {
        // the two other axes, such that u x v points outward
        let (u, v) = match (axis, sign > 0.0) {
            (0, _) => (1, 2),
            (1, _) => (0, 2),
            _ => (0, 1),
        };
        let outward = (sign > 0.0) != (axis == 1);
        let step = 2.0 / QUADS as f32;
        let mut n = [0.0; 3];
        n[axis] = sign;
        for i in 0..QUADS {
            let at = |b: usize, a: usize| {
                let mut p = [sign; 3];
                p[u] = step * (i + a) as f32 - 1.0;
                p[v] = step * b as f32 - 1.0;
                (p, n)
            };
            self.strip(QUADS, outward, ACROSS, at);
        }
    }

    /// Creates a unit sphere, which scaling turns into an ellipsoid.
    pub fn sphere() -> Self {
        let mut m = Self::default();
        m.band(MeshPart::Body);
        m.half_sphere(-1.0, 0.0);
        m.band(MeshPart::Body);
        m.half_sphere(1.0, 0.0);
        m.fill();
        m
    }

    /// Creates a capsule: a cylinder with two half spheres.
    pub fn capsule() -> Self {
        let mut m = Self::default();
        m.open_cylinder();
        m.band(MeshPart::Top);
        m.half_sphere(1.0, 1.0);
        m.band(MeshPart::Bottom);
        m.half_sphere(-1.0, -1.0);
        m.fill();
        m
    }

    /// Creates a closed cylinder.
    pub fn cylinder() -> Self {
        let mut m = Self::default();
        m.band(MeshPart::Body);
        m.disk(-1.0);
        m.open_cylinder();
        m.band(MeshPart::Body);
        m.disk(1.0);
        m.fill();
        m
    }

    /// Creates a box.
    pub fn cube() -> Self {
        let mut m = Self::default();
        m.band(MeshPart::Body);
        for axis in 0..3 {
            m.face(axis, 1.0);
            m.face(axis, -1.0);
        }
        m.fill();
        m
    }

    /// Creates a rectangle at z = 0. MuJoCo draws a fine grid, which looks the same under parallel light without
    /// highlights. Under other light the renderers light the corners of its grid.
    pub fn plane() -> Self {
        let mut m = Self::default();
        m.band(MeshPart::Body);
        let at = |x, y| ([x, y, 0.0], [0.0, 0.0, 1.0]);
        m.strip(1, true, ALONG, |j, k| at(2.0 * j as f32 - 1.0, 2.0 * k as f32 - 1.0));
        m.fill();
        m
    }
}

/// Returns the sine and cosine of the angle of a slice; the angle is rounded to single precision, as in MuJoCo.
fn azimuth(j: usize) -> (f64, f64) {
    pxfm::f_sincos(f64::from((2.0 * PI * j as f64 / SLICES as f64) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(mesh: &Mesh, triangles: usize) {
        assert_eq!(mesh.triangles.len(), triangles);
        let (mut vertices, mut faces) = (0, 0);
        for band in &mesh.bands {
            assert_eq!((band.vertices.start, band.triangles.start), (vertices, faces));
            (vertices, faces) = (band.vertices.end, band.triangles.end);
            assert!(vertices.is_multiple_of(LANES));
            let mut of_strips = mesh.triangles[band.triangles.clone()][band.loose..].iter();
            for strip in &band.strips {
                assert!(strip.count.is_multiple_of(STRIP_LANES));
                for [a, b, c, d] in (0..strip.count).map(|j| strip.corners(j)) {
                    assert_eq!(of_strips.next(), Some(&[a, b, d]));
                    assert!(strip.fan || of_strips.next() == Some(&[b, c, d]));
                }
            }
            assert!(of_strips.next().is_none());
            for t in mesh.triangles[band.triangles.clone()].as_flattened() {
                let i = usize::from(*t);
                assert!(band.vertices.contains(&i));
                for (k, v) in [mesh.x[i], mesh.y[i], mesh.z[i]].into_iter().enumerate() {
                    assert!(band.low[k] <= v && v <= band.high[k]);
                }
            }
        }
        assert_eq!((vertices, faces), (mesh.x.len(), triangles));
        for t in &mesh.triangles {
            let p = t.map(|i| [mesh.x[i as usize], mesh.y[i as usize], mesh.z[i as usize]]);
            let (a, b): (Vec<_>, Vec<_>) = (0..3).map(|k| (p[1][k] - p[0][k], p[2][k] - p[0][k])).unzip();
            let n = [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ];
            let outward: f32 = t
                .iter()
                .map(|&i| (0..3).map(|k| n[k] * mesh.normal[i as usize][k]).sum::<f32>())
                .sum();
            assert!(outward > 0.0, "{t:?} faces inward");
        }
    }

    #[test]
    fn shapes_have_the_triangles_of_the_reference_all_facing_outward() {
        check(&Mesh::sphere(), 840);
        check(&Mesh::capsule(), 1736);
        check(&Mesh::cylinder(), 1736);
        check(&Mesh::cube(), 192);
        check(&Mesh::pipe(), 896);
        check(&Mesh::plane(), 2);
        check(&crate::lattice::Lattice::new([1.0, 2.0, 0.25], 100.0, None).mesh(), 64);
    }
}
