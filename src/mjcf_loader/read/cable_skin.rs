//! The skin of a cable of boxes: a band along its middle, expanded to their thickness.

use crate::composite::CompositeSkin;
use crate::skin::{Bone, Skin};
use crate::table::Table;

/// Coefficients of 1, x, x^2 and x^3 by the values at 0 and 1 and the slopes there: a cubic between two points.
const CUBIC: [[f64; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [-3.0, 3.0, -2.0, -1.0],
    [2.0, -2.0, 1.0, 1.0],
];

/// The division of the skin, which decides the number of vertices of each of its two faces.
#[derive(Clone, Copy)]
pub(super) struct SkinGrid {
    /// Points that bones hold: along the cable and across, where a divided band also has one in the middle.
    held: [usize; 2],
    /// Pieces from one of them to the next.
    pieces: usize,
    /// Vertices of a face, along and across.
    vertices: [usize; 2],
}

impl SkinGrid {
    pub fn new(bodies: usize, subgrid: i32) -> Self {
        let subgrid = usize::try_from(subgrid).unwrap_or(0); // as in MuJoCo, less than nothing is nothing
        let held = [bodies + 1, if subgrid > 0 { 3 } else { 2 }];
        let pieces = subgrid.saturating_add(1);
        let vertices = held.map(|count| (count - 1).saturating_mul(pieces).saturating_add(1));
        Self { held, pieces, vertices }
    }

    /// Returns the number of vertices, texture coordinates and triangles.
    pub fn elements(&self, textured: bool) -> usize {
        let [along, across] = self.vertices;
        let vertices = along.saturating_mul(across).saturating_mul(2);
        // a closed surface has four fewer triangles than twice its vertices
        vertices.saturating_mul(if textured { 4 } else { 3 })
    }

    /// Returns the id of a vertex, on the first face or on the second.
    fn vertex(&self, along: usize, across: usize, face: usize) -> usize {
        (self.vertices[0] * face + along) * self.vertices[1] + across
    }

    /// Returns the triangles: the two faces, the long sides, the ends.
    fn triangles(&self) -> Vec<f64> {
        let [rows, columns] = self.vertices.map(|count| count - 1);
        let mut triangles = Vec::with_capacity(3 * self.elements(false));
        let mut quad = |[a, b, c, d]: [usize; 4], outer_first: bool| {
            let (outer, inner) = ([a, b, c], [a, c, d]);
            let both = if outer_first { [outer, inner] } else { [inner, outer] };
            triangles.extend(both.as_flattened().iter().map(|&v| v as f64));
        };
        let v = |along, across, face| self.vertex(along, across, face);
        for (k, j) in (0..rows).flat_map(|k| (0..columns).map(move |j| (k, j))) {
            quad([v(k, j, 0), v(k + 1, j, 0), v(k + 1, j + 1, 0), v(k, j + 1, 0)], true);
        }
        for (k, j) in (0..rows).flat_map(|k| (0..columns).map(move |j| (k, j))) {
            quad([v(k, j, 1), v(k, j + 1, 1), v(k + 1, j + 1, 1), v(k + 1, j, 1)], false);
        }
        for k in 0..rows {
            quad([v(k, 0, 0), v(k, 0, 1), v(k + 1, 0, 1), v(k + 1, 0, 0)], false);
        }
        let j = columns;
        for k in 0..rows {
            quad([v(k, j, 0), v(k + 1, j, 0), v(k + 1, j, 1), v(k, j, 1)], true);
        }
        for j in 0..columns {
            quad([v(0, j, 0), v(0, j + 1, 0), v(0, j + 1, 1), v(0, j, 1)], true);
        }
        let k = rows;
        for j in 0..columns {
            quad([v(k, j, 0), v(k, j, 1), v(k, j + 1, 1), v(k, j + 1, 0)], false);
        }
        triangles
    }

    /// Returns the texture coordinates: along the cable, and across.
    fn texcoords(&self) -> Vec<f64> {
        let [rows, columns] = self.vertices;
        let part = |index: usize, count: usize| index as f64 / (count - 1) as f64;
        let face = (0..rows).flat_map(|k| (0..columns).map(move |j| [part(k, rows), part(j, columns)]));
        face.clone().chain(face).flatten().collect()
    }

    /// Binds the vertices to the bones, row by row of points that bones hold. Between four such points the vertices lie on a surface of
    /// cubics whose slopes at a point follow from its neighbours. The weights of a vertex can be negative; their sum is 1.
    fn hang(&self, bones: &mut [Bone]) {
        let [rows, columns] = self.held.map(|count| count - 1);
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let slopes = [corners(i == 0, i + 1 == rows), corners(j == 0, j + 1 == columns)];
            // the last vertices are those of no other patch
            let steps = |last: bool| 0..self.pieces + usize::from(last);
            for (s, t) in steps(i + 1 == rows).flat_map(|s| steps(j + 1 == columns).map(move |t| (s, t))) {
                let pulls = weights(self.powers(s), self.powers(t), &slopes);
                let place = (i * self.pieces + s, j * self.pieces + t);
                let vertices = [0, 1].map(|face| self.vertex(place.0, place.1, face) as f64);
                for (p, q) in (0..4).flat_map(|p| (0..4).map(move |q| (p, q))) {
                    if pulls[p][q] == 0.0 {
                        continue; // among them all of points beyond the edges
                    }
                    let bone = &mut bones[(i + p - 1) * self.held[1] + j + q - 1];
                    bone.vertid.extend(vertices);
                    bone.vertweight.extend([pulls[p][q]; 2]);
                }
            }
        }
    }

    /// Returns 1, x, x^2 and x^3 at a vertex between two points.
    fn powers(&self, step: usize) -> [f64; 4] {
        let x = step as f64 * (1.0 / self.pieces as f64);
        [1.0, x, x * x, x * x * x]
    }
}

/// Returns the values and slopes at 0 and 1 of a cubic between the middle two of four successive points, by point. The first and the last
/// point may be missing.
fn corners(first: bool, last: bool) -> [[f64; 4]; 4] {
    let edge = [0.0, -1.0, 1.0, 0.0];
    [
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        if first { edge } else { [-0.5, 0.0, 0.5, 0.0] },
        if last { edge } else { [0.0, -0.5, 0.0, 0.5] },
    ]
}

/// Returns the weights of four by four points for a vertex between the middle four. The order of the sums reproduces MuJoCo's rounding, because
/// MuJoCo keeps every nonzero weight.
fn weights(x: [f64; 4], y: [f64; 4], corners: &[[[f64; 4]; 4]; 2]) -> [[f64; 4]; 4] {
    let square = |of: &dyn Fn(usize, usize) -> f64| -> [[f64; 4]; 4] {
        std::array::from_fn(|p| std::array::from_fn(|q| of(p, q)))
    };
    let sum = |of: &dyn Fn(usize, usize) -> f64| {
        let places = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
        places.fold(0.0, |sum, (i, j)| sum + of(i, j))
    };
    let by_corner = square(&|p, q| sum(&|i, j| x[i] * y[j] * (CUBIC[i][p] * CUBIC[j][q])));
    square(&|p, q| sum(&|i, j| by_corner[i][j] * (corners[0][i][p] * corners[1][j][q])))
}

/// Makes the skin of a cable with these bodies, whose boxes have half lengths `size`.
pub(super) fn skin(like: &CompositeSkin, band: SkinGrid, prefix: &str, bodies: &[String], size: [f64; 3]) -> Skin {
    let [rows, columns] = band.held;
    let places = (0..rows).flat_map(|k| (0..columns).map(move |j| (k, j)));
    let bones = places.map(|(k, j)| {
        // the last point hangs at the last body, MuJoCo's way: at twice the length that the document gives the box
        let x = if k == bodies.len() { -2.0 * size[0] } else { 0.0 };
        let y = -size[1] + 2.0 * size[1] * j as f64 / (columns - 1) as f64;
        Bone {
            at: like.at,
            body: bodies[k.min(bodies.len() - 1)].clone(),
            bindpos: [x, y, 0.0],
            ..Bone::initial()
        }
    });
    let mut bones: Vec<_> = bones.collect();
    band.hang(&mut bones);
    Skin {
        at: like.at,
        name: format!("{prefix}Skin"),
        material: like.material.clone(),
        // as in MuJoCo, bones alone say where vertices are
        vertex: vec![0.0; 6 * band.vertices[0] * band.vertices[1]],
        face: band.triangles(),
        texcoord: if like.texcoord { band.texcoords() } else { Vec::new() },
        rgba: like.rgba,
        inflate: 2.0 * size[2],
        group: like.group,
        bones,
        ..Skin::initial()
    }
}
