//! Geom pairs that may touch: the order of their contacts, and their parameters.

mod rules;

use super::trees::BodyTrees;
use crate::contact::needs_convex;
use crate::detected::Contact;
use crate::math::{MINVAL, order};
use crate::model::{Flex, GeomType, Model};
pub use rules::ContactRules;

/// Scenes of up to this many geoms have a table of all their pairs; in larger scenes, pairs are created when geoms come near each other.
const TABULATED: usize = 256;

/// Least friction coefficient (MuJoCo's `mjMINMU`).
const MIN_FRICTION: f64 = 1e-5;

/// Two geoms that may touch, with the parameters of their contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct GeomPair {
    /// The geoms, the lower [`GeomType`](crate::model::GeomType) first; of equal types the one of the lower body, or the first of an explicit
    /// pair.
    pub geom: [usize; 2],
    /// Distance up to which contacts are detected, m.
    pub margin: f64,
    /// Whether MuJoCo compares the boxes of both geoms before it looks for contacts, by a routine that may find some beyond the margin.
    pub midphase: bool,
    /// Distance up to which any geom of both bodies has contacts, m.
    pub body_margin: f64,
    /// A contact with everything but its geometry filled in.
    pub template: Contact,
}

/// The pairs that may touch, in the order in which MuJoCo lists contacts.
///
/// Two geoms may touch when their bits match (`contype` of one and `conaffinity` of the other), their bodies are
/// neither rigidly joined nor parent and child (unless the parent is part of the world) nor excluded; explicit pairs
/// always may, with their own parameters. Contacts are ordered by body pair; within it explicit pairs come first, then
/// geom pairs.
///
/// Memory is linear in the number of geoms: where there are many, no list of pairs is kept.
#[derive(Clone, Debug)]
pub struct PairTable {
    rules: ContactRules,
    table: Option<IndexedPairs>,
    trees: BodyTrees,
}

/// All pairs, with an index by their two geoms.
#[derive(Clone, Debug)]
struct IndexedPairs {
    /// The first pair of two geoms, row by row.
    index: Vec<u32>,
    /// The next pair of the same geoms, for each pair: an explicit pair may be written more than once, and counts as
    /// often.
    next: Vec<u32>,
    pairs: Vec<GeomPair>,
}

const NONE: u32 = u32::MAX;

/// Lower body, higher body, whether the pair is not explicit, order among those.
pub(super) type PairOrder = (u32, u32, bool, u32, u32);

impl PairTable {
    /// Derives the table of `model`.
    pub fn new(model: &Model) -> Self {
        let (rules, ngeom) = (ContactRules::new(model), model.ngeom());
        let table = (ngeom <= TABULATED).then(|| {
            let pairs = list(model, &rules);
            let mut index = vec![NONE; ngeom * ngeom];
            let mut next = vec![NONE; pairs.len()];
            for (k, p) in pairs.iter().enumerate().rev() {
                let [a, b] = p.geom;
                next[k] = index[a * ngeom + b];
                index[a * ngeom + b] = k as u32;
                index[b * ngeom + a] = k as u32;
            }
            IndexedPairs { index, next, pairs }
        });
        let trees = BodyTrees::new(model);
        Self { rules, table, trees }
    }

    /// Returns all pairs, in contact order; `None` for a scene of more than 256 geoms, whose pairs are not listed.
    #[inline]
    pub fn pairs(&self) -> Option<&[GeomPair]> {
        self.table.as_ref().map(|table| table.pairs.as_slice())
    }

    /// Returns the trees of boxes around the geoms of each body.
    #[inline]
    pub(super) fn trees(&self) -> &BodyTrees {
        &self.trees
    }

    /// Returns whether two geoms may touch.
    pub fn may_touch(&self, a: usize, b: usize) -> bool {
        match &self.table {
            Some(_) => self.tabulated(a, b).next().is_some(),
            None => self.rules.allow(a, b),
        }
    }

    /// Returns whether a geom may touch any other, according to its own properties.
    pub(super) fn takes_part(&self, geom: usize) -> bool {
        match &self.table {
            Some(table) => table.pairs.iter().any(|p| p.geom.contains(&geom)),
            None => self.rules.takes_part(geom),
        }
    }

    /// Returns the indices of the pairs of two geoms in the list; none if they may not touch.
    #[inline]
    pub(super) fn tabulated(&self, a: usize, b: usize) -> impl Iterator<Item = usize> {
        let table = self.table.as_ref();
        let mut at = table.map_or(NONE, |table| table.index[a * self.rules.ngeom() + b]);
        std::iter::from_fn(move || {
            let k = (at != NONE).then_some(at as usize)?;
            at = table.map_or(NONE, |table| table.next[k]);
            Some(k)
        })
    }

    /// Returns the places of the pairs of two geoms in contact order; none if they may not touch.
    #[inline]
    pub(super) fn orders(&self, a: usize, b: usize) -> impl Iterator<Item = PairOrder> {
        self.rules.orders(a, b)
    }

    /// Makes the pair at a place in contact order of two geoms that may touch.
    pub(super) fn pair(&self, model: &Model, order: PairOrder, a: usize, b: usize) -> GeomPair {
        match order {
            (_, _, false, p, _) => explicit(model, p as usize),
            _ => dynamic(model, self.rules.ordered(a, b)),
        }
    }
}

/// Lists all pairs of a model in contact order.
fn list(model: &Model, rules: &ContactRules) -> Vec<GeomPair> {
    let mut found: Vec<(PairOrder, GeomPair)> = Vec::new();
    for (p, &[a, b]) in model.pair_geom.iter().enumerate() {
        found.push((rules.explicit_order(p, a, b), explicit(model, p)));
    }
    for a in 0..model.ngeom() {
        for b in a + 1..model.ngeom() {
            if !rules.is_explicit(a, b)
                && let Some(order) = rules.dynamic_order(a, b)
            {
                found.push((order, dynamic(model, rules.ordered(a, b))));
            }
        }
    }
    order::sort_by(&mut found, |a, b| a.0.cmp(&b.0));
    found.into_iter().map(|f| f.1).collect()
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

fn explicit(model: &Model, p: usize) -> GeomPair {
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
    GeomPair {
        geom: t.geom,
        margin: model.pair_margin[p],
        midphase: false,
        body_margin: model.pair_margin[p],
        template: t,
    }
}

/// The properties of a geom or a flex from which the parameters of contacts are mixed.
pub(super) struct ContactMaterial {
    priority: i32,
    dim: usize,
    friction: [f64; 3],
    solmix: f64,
    solref: [f64; 2],
    solimp: [f64; 5],
    margin: f64,
    gap: f64,
}

impl ContactMaterial {
    /// Returns the properties of a geom.
    pub(super) fn of_geom(model: &Model, g: usize) -> Self {
        Self {
            priority: model.geom_priority[g],
            dim: model.geom_condim[g],
            friction: model.geom_friction[g],
            solmix: model.geom_solmix[g],
            solref: model.geom_solref[g],
            solimp: model.geom_solimp[g],
            margin: model.geom_margin[g],
            gap: model.geom_gap[g],
        }
    }

    /// Returns the properties of a flex.
    pub(super) fn of_flex(flex: &Flex) -> Self {
        Self {
            priority: flex.priority,
            dim: flex.condim,
            friction: flex.friction,
            solmix: flex.solmix,
            solref: flex.solref,
            solimp: flex.solimp,
            margin: flex.margin,
            gap: flex.gap,
        }
    }
}

/// Mixes the parameters of contacts, whose geometry and geoms are not filled in: those of the higher priority; at equal priority the greater
/// dimension, the greater friction and averages weighted by `solmix`.
#[doc(alias = "mj_contactParam")]
pub(super) fn mixed(a: &ContactMaterial, b: &ContactMaterial) -> Contact {
    let (dim, slip, solref, solimp);
    if a.priority != b.priority {
        let higher = if a.priority > b.priority { a } else { b };
        (dim, slip) = (higher.dim, higher.friction);
        (solref, solimp) = (higher.solref, higher.solimp);
    } else {
        dim = a.dim.max(b.dim);
        slip = std::array::from_fn(|k| a.friction[k].max(b.friction[k]));
        let mix = match (a.solmix >= MINVAL, b.solmix >= MINVAL) {
            (true, true) => a.solmix / (a.solmix + b.solmix),
            (false, false) => 0.5,
            (first, _) => f64::from(first),
        };
        let blend = |x: f64, y: f64| mix * x + (1.0 - mix) * y;
        solref = if a.solref[0] > 0.0 && b.solref[0] > 0.0 {
            [blend(a.solref[0], b.solref[0]), blend(a.solref[1], b.solref[1])]
        } else {
            [a.solref[0].min(b.solref[0]), a.solref[1].min(b.solref[1])]
        };
        solimp = std::array::from_fn(|k| blend(a.solimp[k], b.solimp[k]));
    }
    let friction = [slip[0], slip[0], slip[1], slip[2], slip[2]];
    Contact {
        includemargin: a.margin.max(b.margin) - a.gap.max(b.gap),
        ..template([usize::MAX; 2], dim, friction, solref, solimp)
    }
}

/// Returns a pair of two geoms with mixed parameters.
fn dynamic(model: &Model, geom: [usize; 2]) -> GeomPair {
    let [a, b] = geom.map(|g| ContactMaterial::of_geom(model, g));
    GeomPair {
        geom,
        margin: a.margin.max(b.margin),
        midphase: midphase(model, geom),
        body_margin: geom
            .into_iter()
            .fold(0.0, |margin, g| body_margin(model, g).max(margin)),
        template: Contact { geom, ..mixed(&a, &b) },
    }
}

/// Returns whether MuJoCo reaches a pair that is not explicit through trees of boxes, as it does if one of the bodies has several geoms, and then
/// calls a routine that may accept geoms farther apart than the margin: the convex one, or the one for two boxes.
fn midphase(model: &Model, [a, b]: [usize; 2]) -> bool {
    let geoms = |g: usize| model.body_geomnum[model.geom_bodyid[g]];
    let kinds = [model.geom_type[a], model.geom_type[b]];
    let inexact = kinds == [GeomType::Box; 2] || needs_convex(kinds[0], kinds[1]);
    model.opt.flags.midphase && geoms(a) * geoms(b) > 1 && inexact
}

/// Returns the largest margin among the geoms of a geom's body.
fn body_margin(model: &Model, g: usize) -> f64 {
    let body = model.geom_bodyid[g];
    let first = model.body_geomadr[body];
    let margins = &model.geom_margin[first..first + model.body_geomnum[body]];
    margins.iter().fold(0.0, |most, &margin| margin.max(most))
}
