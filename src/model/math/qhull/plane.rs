//! Planes of facets, distances from them, and their centres.

use super::Builder;
use super::parts::{HullFailure, HullResult, Id};
use super::tolerance::{SMALLEST, divide};
use crate::math::Vec3;

/// Divides a normal by its length, and by -1 where the vertices wind the other way (`qh_normalize2`).
fn normalize(normal: &mut Vec3, top: bool, largest: f64) {
    let mut length = (normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]).sqrt();
    if length == 0.0 {
        *normal = [f64::sqrt(1.0 / 3.0); 3];
        return;
    }
    let ordinary = length > SMALLEST * largest;
    if !top {
        length = -length;
    }
    if ordinary {
        *normal = normal.map(|x| x / length);
        return;
    }
    for k in 0..3 {
        match divide(normal[k], length, SMALLEST) {
            Some(quotient) => normal[k] = quotient,
            // the largest component alone is left where a quotient overflows
            None => {
                let mut most = 0;
                for k in 1..3 {
                    if normal[k].abs() > normal[most].abs() {
                        most = k;
                    }
                }
                let sign = if normal[most] * length >= 0.0 { 1.0 } else { -1.0 };
                *normal = [0.0; 3];
                normal[most] = sign;
                return;
            }
        }
    }
}

/// The normal of a plane by Gauss' elimination with pivots, from the differences of two corners to the first. The second value is whether a pivot was
/// too small to be distinguished from 0.
fn eliminate(rows: [Vec3; 2], top: bool, near_zero: Vec3, largest: f64) -> (Vec3, bool) {
    let [mut a, mut b] = rows;
    let (mut sign, mut small) = (top, false);
    if b[0].abs() > a[0].abs() {
        (a, b) = (b, a);
        sign = !sign;
    }
    small |= a[0].abs() <= near_zero[0];
    if a[0] != 0.0 {
        let n = b[0] / a[0];
        b[1] -= n * a[1];
        b[2] -= n * a[2];
    }
    small |= b[1].abs() <= near_zero[1];
    sign ^= b[1] < 0.0;
    sign ^= a[0] < 0.0;
    let unit = if sign { -1.0 } else { 1.0 };
    let least = (SMALLEST * 3.0).sqrt();
    let mut normal = [0.0, 0.0, unit];
    let quotient = |numerator: f64, diagonal: f64| {
        if diagonal.abs() > least * largest {
            Some(numerator / diagonal)
        } else {
            divide(numerator, diagonal, least)
        }
    };
    match quotient(0.0 - b[2] * normal[2], b[1]) {
        Some(y) => normal[1] = y,
        None => (normal, small) = ([0.0, unit, 0.0], true),
    }
    match quotient(0.0 - a[1] * normal[1] - a[2] * normal[2], a[0]) {
        Some(x) => normal[0] = x,
        None => (normal, small) = ([unit, 0.0, 0.0], true),
    }
    normalize(&mut normal, true, largest);
    (normal, small)
}

/// The square of the distance of two points.
pub(super) fn square_distance(a: Vec3, b: Vec3) -> f64 {
    let mut sum = 0.0;
    for k in 0..3 {
        let difference = a[k] - b[k];
        sum += difference * difference;
    }
    sum
}

impl Builder<'_> {
    /// Returns the point of a vertex.
    #[inline(always)]
    pub(super) fn place(&self, vertex: Id) -> Vec3 {
        self.point(self.vertices[vertex].point)
    }

    /// Returns a point.
    #[inline(always)]
    pub(super) fn point(&self, point: u32) -> Vec3 {
        self.points.get(point as usize).copied().unwrap_or([0.0; 3])
    }

    /// Returns the height of a point above a facet (`qh_distplane`); the order of the sum determines the last bits.
    #[inline(always)]
    pub(super) fn distance(&self, p: Vec3, facet: Id) -> f64 {
        let facet = &self.facets[facet];
        let normal = facet.normal.unwrap_or([0.0; 3]);
        facet.offset + p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]
    }

    /// Computes the plane of a triangle (`qh_setfacetplane`): by its cross product, and by elimination where a corner is off the
    /// plane by more than the rounding error.
    pub(super) fn set_plane(&mut self, facet: Id) -> HullResult {
        let &[v0, v1, v2] = self.facets[facet].vertices.as_slice() else {
            return Err(HullFailure);
        };
        let [p0, p1, p2] = [v0, v1, v2].map(|v| self.place(v));
        let top = self.facets[facet].top;
        let [a, b]: [Vec3; 2] = [p1, p2].map(|p| std::array::from_fn(|k| p[k] - p0[k]));
        let mut normal = [
            b[1] * a[2] - b[2] * a[1],
            a[0] * b[2] - a[2] * b[0],
            b[0] * a[1] - b[1] * a[0],
        ];
        normalize(&mut normal, top, self.tolerance.largest);
        let mut offset = -(p0[0] * normal[0] + p0[1] * normal[1] + p0[2] * normal[2]);
        let off = [v2, v1].into_iter().any(|v| {
            let p = self.place(v);
            let dist = offset + (p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]);
            self.vertices[v].point != self.vertices[v0].point
                && (dist > self.tolerance.dist || dist < -self.tolerance.dist)
        });
        let mut small = false;
        if off {
            (normal, small) = eliminate([a, b], top, self.tolerance.near_zero, self.tolerance.largest);
            offset = -(p0[0] * normal[0]);
            offset -= p0[1] * normal[1];
            offset -= p0[2] * normal[2];
        }
        self.facets[facet].normal = Some(normal);
        self.facets[facet].offset = offset;
        if small {
            // the sign of a number that is nearly zero is meaningless; the interior point decides
            self.orient_outside(facet);
        }
        self.check_flipped(facet);
        Ok(())
    }

    /// Turns a plane so that the point inside is below.
    pub(super) fn orient_outside(&mut self, facet: Id) {
        if self.distance(self.interior, facet) > 0.0 {
            let facet = &mut self.facets[facet];
            facet.normal = facet.normal.map(|normal| normal.map(|x| -x));
            facet.offset = -facet.offset;
        }
    }

    /// Marks a facet that the point inside is not clearly below; returns whether it is not marked.
    pub(super) fn check_flipped(&mut self, facet: Id) -> bool {
        if !self.facets[facet].flipped && self.distance(self.interior, facet) >= -self.tolerance.dist {
            self.facets[facet].flipped = true;
        }
        !self.facets[facet].flipped
    }

    /// Returns the mean of vertices.
    pub(super) fn mean(&self, vertices: &[Id]) -> Vec3 {
        std::array::from_fn(|k| {
            let mut sum = 0.0;
            for &vertex in vertices {
                sum += self.place(vertex)[k];
            }
            sum / vertices.len() as f64
        })
    }

    /// Returns the centre of a facet, computing it if necessary (`qh_getcentrum`).
    pub(super) fn center(&mut self, facet: Id) -> Vec3 {
        if let Some(center) = self.facets[facet].center {
            return center;
        }
        let mean = self.mean(&self.facets[facet].vertices);
        let dist = self.distance(mean, facet);
        let normal = self.facets[facet].normal.unwrap_or([0.0; 3]);
        let center = std::array::from_fn(|k| mean[k] - dist * normal[k]);
        self.facets[facet].center = Some(center);
        center
    }

    /// Returns the distances from another facet's plane of the vertices that a facet does not share with it: the largest on either side, the least,
    /// the greatest (`qh_getdistance`).
    pub(super) fn spread(&mut self, facet: Id, other: Id) -> [f64; 3] {
        for (of, seen) in [(facet, false), (other, true)] {
            for i in 0..self.facets[of].vertices.len() {
                let vertex = self.facets[of].vertices[i];
                self.vertices[vertex].seen = seen;
            }
        }
        let (mut low, mut high) = (0.0, 0.0);
        for i in 0..self.facets[facet].vertices.len() {
            let vertex = self.facets[facet].vertices[i];
            if !self.vertices[vertex].seen {
                let dist = self.distance(self.place(vertex), other);
                if dist < low {
                    low = dist;
                } else if dist > high {
                    high = dist;
                }
            }
        }
        [if high > -low { high } else { -low }, low, high]
    }

    /// Returns the cosine of the angle between the normals of two facets.
    pub(super) fn cosine(&self, a: Id, b: Id) -> f64 {
        let [a, b] = [a, b].map(|facet| self.facets[facet].normal.unwrap_or([0.0; 3]));
        let mut sum = 0.0;
        for k in 0..3 {
            sum += a[k] * b[k];
        }
        sum
    }

    /// Returns the two vertices that are nearest to each other, and their distance (`qh_vertex_bestdist2`).
    pub(super) fn nearest_pair(&self, vertices: &[Id]) -> (Id, Id, f64) {
        let mut best = (super::parts::NONE, super::parts::NONE, f64::MAX);
        for (i, &a) in vertices.iter().enumerate() {
            for &b in &vertices[i + 1..] {
                let square = square_distance(self.place(a), self.place(b));
                if square < best.2 {
                    best = (a, b, square);
                }
            }
        }
        (best.0, best.1, best.2.sqrt())
    }
}
