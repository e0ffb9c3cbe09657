//! The part of MuJoCo's sweep over bodies in which rounding matters: it sorts in single precision.

use crate::math::{Mat3, Vec3, dot, principal_axes, quat_normalize, quat_to_mat, scale, sub};
use crate::model::{GeomType, Model};
use crate::state::State;

/// Overlap of spheres, relative to their coordinates, that survives rounding to single precision.
const SURE: f64 = 4e-7;

/// Returns whether MuJoCo 3.3.0 drops a pair of geoms that touch: the spheres around them overlap by less than single precision resolves, so
/// its sweep misses their bodies.
#[inline(always)]
pub(super) fn drops(model: &Model, s: &State, [a, b]: [usize; 2]) -> bool {
    let (first, second) = (s.geom_xpos[a], s.geom_xpos[b]);
    let reach = s.params.geom_rbound[a] + s.params.geom_rbound[b] + model.geom_margin[a] + model.geom_margin[b];
    let between = sub(second, first);
    let size = reach + first.iter().chain(&second).map(|x| x.abs()).sum::<f64>();
    let sure = reach - SURE * size;
    if sure > 0.0 && dot(between, between) <= sure * sure {
        return false;
    }
    decides(model, s, [a, b])
}

/// Like [`drops`], for spheres that barely overlap. Not inlined, because most steps have none.
#[inline(never)]
fn decides(model: &Model, s: &State, geoms: [usize; 2]) -> bool {
    let mut bodies = geoms.map(|g| model.geom_bodyid[g]);
    bodies.sort_unstable();
    if bodies.iter().any(|&body| is_endless(model, body)) || is_explicit(model, geoms) {
        return false;
    }
    let axes = frame(model, s);
    let [first, second] = bodies.map(|body| span(model, s, &axes, body));
    // along the first axis ends are sorted by value, then by body
    let apart = second[0][0] as f32 >= first[1][0] as f32 || first[0][0] as f32 > second[1][0] as f32;
    let aside = |k: usize| first[0][k] > second[1][k] || second[0][k] > first[1][k];
    apart || aside(1) || aside(2)
}

/// Returns whether a body is paired with all others: the world, and bodies that never move and have a plane.
fn is_endless(model: &Model, body: usize) -> bool {
    let mut geoms = (0..model.ngeom()).filter(|&g| model.geom_bodyid[g] == body);
    body == 0 || model.body_weldid[body] == 0 && geoms.any(|g| model.geom_type[g] == GeomType::Plane)
}

/// Returns whether a pair is explicit in the document. Such pairs are not swept.
fn is_explicit(model: &Model, [a, b]: [usize; 2]) -> bool {
    model.pair_geom.iter().any(|pair| *pair == [a, b] || *pair == [b, a])
}

/// Returns the axes along which bodies are swept: the principal axes of the distribution of all geoms that are not in the world itself.
fn frame(model: &Model, s: &State) -> Mat3 {
    let swept = || {
        (0..model.ngeom())
            .filter(|&g| model.geom_bodyid[g] > 0)
            .map(|g| s.geom_xpos[g])
    };
    let count = swept().count().max(1) as f64;
    let mut centre = [0.0; 3];
    for pos in swept() {
        centre = std::array::from_fn(|k| centre[k] + pos[k]);
    }
    let centre = scale(centre, 1.0 / count);
    let mut spread = [0.0; 6];
    for pos in swept() {
        let [x, y, z] = sub(pos, centre);
        for (sum, product) in spread.iter_mut().zip([x * x, y * y, z * z, x * y, x * z, y * z]) {
            *sum += product;
        }
    }
    let spread = spread.map(|sum| sum * (1.0 / count));
    quat_to_mat(principal_axes(&spread, quat_normalize).0)
}

/// Returns the lowest and the highest coordinates, along axes, of the spheres around a body's geoms with their margins.
fn span(model: &Model, s: &State, axes: &Mat3, body: usize) -> [Vec3; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for g in (0..model.ngeom()).filter(|&g| model.geom_bodyid[g] == body) {
        let (radius, margin) = (s.params.geom_rbound[g], model.geom_margin[g]);
        for k in 0..3 {
            // MuJoCo takes rows of the matrix whose columns are the axes
            let centre = dot(s.geom_xpos[g], [axes[3 * k], axes[3 * k + 1], axes[3 * k + 2]]);
            low[k] = low[k].min(centre - radius - margin);
            high[k] = high[k].max(centre + radius + margin);
        }
    }
    [low, high]
}
