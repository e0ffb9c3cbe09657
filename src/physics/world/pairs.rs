//! Geom pairs that may touch: the order of their contacts, and their parameters.

use crate::math::MINVAL;
use crate::model::{GeomType, Model};
use crate::physics::state::Contact;

/// Least friction coefficient (MuJoCo's `mjMINMU`).
const MIN_FRICTION: f64 = 1e-5;

/// Two geoms that may touch, with the parameters of their contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The geoms, the lower [`GeomType`] first; of equal types the one of the lower body, or the first of an explicit
    /// pair.
    pub geom: [usize; 2],
    /// Distance up to which contacts are detected, m.
    pub margin: f64,
    /// A contact with everything but its geometry filled in.
    pub template: Contact,
}

/// Lists all pairs that may touch, in the order in which MuJoCo lists contacts.
///
/// Two geoms may touch when their bits match (`contype` of one and `conaffinity` of the other), their bodies are
/// neither rigidly joined nor parent and child (unless the parent is part of the world) nor excluded; explicit pairs
/// always may, with their own parameters. Contacts are ordered by body pair; within it explicit pairs come first, then
/// geom pairs.
#[derive(Clone, Debug)]
pub struct PairTable {
    ngeom: usize,
    index: Vec<u32>,
    pairs: Vec<Pair>,
}

const NONE: u32 = u32::MAX;

/// Lower body, higher body, whether the pair is not explicit, order among those.
type Order = (usize, usize, bool, usize, usize);

impl PairTable {
    /// Derives the table of `model`.
    pub fn new(model: &Model) -> Self {
        let ngeom = model.ngeom();
        let mut found: Vec<(Order, Pair)> = Vec::new();
        let bodies = |a: usize, b: usize| {
            let (x, y) = (model.geom_bodyid[a], model.geom_bodyid[b]);
            (x.min(y), x.max(y))
        };
        for p in 0..model.npair() {
            let [a, b] = model.pair_geom[p];
            let (lo, hi) = bodies(a, b);
            found.push(((lo, hi, false, p, 0), explicit(model, p)));
        }
        let explicit_pair = |a: usize, b: usize| model.pair_geom.iter().any(|g| *g == [a, b] || *g == [b, a]);
        for a in 0..ngeom {
            for b in a + 1..ngeom {
                if may_touch(model, a, b) && !explicit_pair(a, b) {
                    let geom = ordered(model, a, b);
                    let (lo, hi) = bodies(a, b);
                    found.push(((lo, hi, true, geom[0], geom[1]), dynamic(model, geom)));
                }
            }
        }
        found.sort_by_key(|f| f.0);
        let pairs: Vec<Pair> = found.into_iter().map(|f| f.1).collect();
        let mut index = vec![NONE; ngeom * ngeom];
        for (k, p) in pairs.iter().enumerate() {
            let [a, b] = p.geom;
            index[a * ngeom + b] = k as u32;
            index[b * ngeom + a] = k as u32;
        }
        Self { ngeom, index, pairs }
    }

    /// Returns all pairs, in contact order.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Returns the index in [`Self::pairs`] of the pair of two geoms, if they may touch.
    #[inline]
    pub fn find(&self, a: usize, b: usize) -> Option<usize> {
        match self.index[a * self.ngeom + b] {
            NONE => None,
            k => Some(k as usize),
        }
    }
}

/// Orders two geoms by type, then by body.
fn ordered(model: &Model, a: usize, b: usize) -> [usize; 2] {
    let key = |g: usize| (model.geom_type[g], model.geom_bodyid[g], g);
    if key(a) <= key(b) { [a, b] } else { [b, a] }
}

fn may_touch(model: &Model, a: usize, b: usize) -> bool {
    let collides = |g: usize| model.geom_type[g] != GeomType::Ellipsoid;
    if !collides(a) || !collides(b) || (model.geom_type[a] == GeomType::Plane && model.geom_type[b] == GeomType::Plane)
    {
        return false;
    }
    let matches = |x: usize, y: usize| model.geom_contype[x] & model.geom_conaffinity[y] != 0;
    if !matches(a, b) && !matches(b, a) {
        return false;
    }
    let (body_a, body_b) = (model.geom_bodyid[a], model.geom_bodyid[b]);
    let (weld_a, weld_b) = (model.body_weldid[body_a], model.body_weldid[body_b]);
    if weld_a == weld_b {
        return false;
    }
    let weld_parent = |w: usize| model.body_weldid[model.body_parentid[w]];
    if weld_a != 0 && weld_b != 0 && (weld_a == weld_parent(weld_b) || weld_b == weld_parent(weld_a)) {
        return false;
    }
    !model.exclude.contains(&[body_a.min(body_b), body_a.max(body_b)])
}

fn template(geom: [usize; 2], dim: usize, friction: [f64; 5], solref: [f64; 2], solimp: [f64; 5]) -> Contact {
    Contact {
        geom,
        dist: 0.0,
        pos: [0.0; 3],
        frame: [0.0; 9],
        dim,
        friction: friction.map(|f| f.max(MIN_FRICTION)),
        solref,
        solreffriction: [0.0; 2],
        solimp,
        includemargin: 0.0,
        efc_address: None,
        force: [0.0; 6],
    }
}

fn explicit(model: &Model, p: usize) -> Pair {
    let [a, b] = model.pair_geom[p];
    let geom = if model.geom_type[a] <= model.geom_type[b] {
        [a, b]
    } else {
        [b, a]
    };
    let mut t = template(
        geom,
        model.pair_dim[p],
        model.pair_friction[p],
        model.pair_solref[p],
        model.pair_solimp[p],
    );
    t.solreffriction = model.pair_solreffriction[p];
    t.includemargin = model.pair_margin[p] - model.pair_gap[p];
    Pair {
        geom: t.geom,
        margin: model.pair_margin[p],
        template: t,
    }
}

/// Mixes the parameters of two geoms: those of the geom of higher priority; at equal priority the greater dimension,
/// the greater friction and averages weighted by `solmix`.
fn dynamic(model: &Model, geom: [usize; 2]) -> Pair {
    let [a, b] = geom;
    let (pa, pb) = (model.geom_priority[a], model.geom_priority[b]);
    let (dim, slip, solref, solimp);
    if pa != pb {
        let g = if pa > pb { a } else { b };
        dim = model.geom_condim[g];
        slip = model.geom_friction[g];
        solref = model.geom_solref[g];
        solimp = model.geom_solimp[g];
    } else {
        dim = model.geom_condim[a].max(model.geom_condim[b]);
        slip = std::array::from_fn(|k| model.geom_friction[a][k].max(model.geom_friction[b][k]));
        let (wa, wb) = (model.geom_solmix[a], model.geom_solmix[b]);
        let mix = match (wa >= MINVAL, wb >= MINVAL) {
            (true, true) => wa / (wa + wb),
            (false, false) => 0.5,
            (first, _) => f64::from(first),
        };
        let blend = |x: f64, y: f64| mix * x + (1.0 - mix) * y;
        let (ra, rb) = (model.geom_solref[a], model.geom_solref[b]);
        solref = if ra[0] > 0.0 && rb[0] > 0.0 {
            [blend(ra[0], rb[0]), blend(ra[1], rb[1])]
        } else {
            [ra[0].min(rb[0]), ra[1].min(rb[1])]
        };
        solimp = std::array::from_fn(|k| blend(model.geom_solimp[a][k], model.geom_solimp[b][k]));
    }
    let margin = model.geom_margin[a].max(model.geom_margin[b]);
    let gap = model.geom_gap[a].max(model.geom_gap[b]);
    let mut t = template(geom, dim, [slip[0], slip[0], slip[1], slip[2], slip[2]], solref, solimp);
    t.includemargin = margin - gap;
    Pair {
        geom,
        margin,
        template: t,
    }
}
