//! Distances that count as equal: bounds on rounding errors that follow from the extent of the points.

use crate::math::Vec3;

/// Bounds on rounding errors, by Qhull's formulas in three dimensions with its default options.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// The greatest extent along an axis (`MAXwidth`).
    pub(super) width: f64,
    /// The greatest absolute coordinate (`MAXabs_coord`).
    pub(super) largest: f64,
    /// Error of the distance of a point from a plane (`DISTround`).
    pub(super) dist: f64,
    /// Pivots that may be zero, by dimension (`NEARzero`).
    pub(super) near_zero: Vec3,
    /// Largest distance of a centre from the other plane at which facets count as coplanar (`premerge_centrum`).
    pub(super) centrum: f64,
    /// Largest distance by which a merge may move a plane (`ONEmerge`).
    pub(super) one_merge: f64,
    /// Height above a facet from which a point sees it (`MINvisible`), and depth below it down to which a point is coplanar
    /// (`MAXcoplanar`).
    pub(super) visible: f64,
    /// Height above a facet from which a point is outside (`MINoutside`).
    pub(super) outside: f64,
    /// Depth below a facet down to which points are kept (`NEARinside`).
    pub(super) near_inside: f64,
    /// Width from which a merged facet keeps its centre (`WIDEfacet`).
    pub(super) wide: f64,
}

/// Divisors below which a quotient by 1 overflows (`MINdenom_1`).
pub(super) const SMALLEST: f64 = f64::MIN_POSITIVE;

impl Tolerance {
    /// Computes the bounds from the points at the least and greatest coordinates, in pairs by axis.
    pub(super) fn new(extremes: &[[Vec3; 2]; 3]) -> Self {
        let (mut width, mut largest, mut sum) = (f64::MIN, 0.0, 0.0);
        let mut near_zero = [0.0; 3];
        for k in 0..3 {
            let [low, high] = [extremes[k][0][k], extremes[k][1][k]];
            let most = if high > -low { high } else { -low };
            width = larger(width, high - low);
            largest = larger(largest, most);
            sum += most;
            // the sum up to this axis: later ones count for later pivots only
            near_zero[k] = 80.0 * sum * f64::EPSILON;
        }
        let across = smaller(f64::sqrt(3.0) * largest, sum);
        let dist = f64::EPSILON * (3.0 * across * 1.01 + largest);
        let centrum = 2.0 * dist;
        let one_merge = larger(dist, 3.0 * centrum + dist);
        let visible = centrum;
        let outside = 2.0 * visible;
        Self {
            width,
            largest,
            dist,
            near_zero,
            centrum,
            one_merge,
            visible,
            outside,
            near_inside: one_merge * 5.0,
            wide: larger(outside, 6.0 * visible),
        }
    }
}

/// The larger of two numbers, the first if they are equal.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a < b { b } else { a }
}

/// The smaller of two numbers, the first if they are equal.
#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a > b { b } else { a }
}

/// Divides; `None` where the quotient overflows (`qh_divzero`).
pub(super) fn divide(numerator: f64, denominator: f64, least: f64) -> Option<f64> {
    if numerator < least && numerator > -least {
        return (numerator.abs() < denominator.abs()).then(|| numerator / denominator);
    }
    let inverse = denominator / numerator;
    (inverse > least || inverse < -least).then(|| numerator / denominator)
}
