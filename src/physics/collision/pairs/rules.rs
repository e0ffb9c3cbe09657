//! Rules that decide which geoms may touch, and the order of their contacts. Memory is linear in the size of the model.

use super::PairOrder;
use crate::math::order;
use crate::model::{GeomType, Model};

/// The properties of a geom that decide which others it may touch.
#[derive(Clone, Copy, Debug)]
struct Geom {
    kind: GeomType,
    contype: u32,
    conaffinity: u32,
    body: u32,
    /// The first of the bodies to which its body is rigidly joined, and the same for the parent of that body.
    weld: u32,
    weld_parent: u32,
}

/// The rules of a model that decide which geoms may touch; see [`super::PairTable`].
#[derive(Clone, Debug)]
pub struct ContactRules {
    /// Whether geoms of a body pass through those of its parent.
    filterparent: bool,
    /// Whether contacts of two bodies are listed by the types of the geoms.
    midphase: bool,
    geoms: Vec<Geom>,
    /// Body pairs that are excluded, the lower first, sorted.
    excludes: Vec<[u32; 2]>,
    /// Geoms of explicit pairs, the lower first, each with its number; sorted.
    explicit: Vec<([u32; 2], u32)>,
}

/// Returns two ids, the lower first.
fn sorted(a: usize, b: usize) -> [u32; 2] {
    [a.min(b) as u32, a.max(b) as u32]
}

impl ContactRules {
    /// Derives the rules of `model`.
    pub fn new(model: &Model) -> Self {
        let weld = |body: usize| model.body_weldid[body];
        let geom = |g: usize| {
            let body = model.geom_bodyid[g];
            Geom {
                kind: model.geom_type[g],
                contype: model.geom_contype[g],
                conaffinity: model.geom_conaffinity[g],
                body: body as u32,
                weld: weld(body) as u32,
                weld_parent: weld(model.body_parentid[weld(body)]) as u32,
            }
        };
        let mut excludes: Vec<[u32; 2]> = model.exclude.iter().map(|&[a, b]| sorted(a, b)).collect();
        excludes.sort_unstable();
        let numbered = model.pair_geom.iter().enumerate();
        let mut explicit: Vec<_> = numbered.map(|(p, &[a, b])| (sorted(a, b), p as u32)).collect();
        order::sort(&mut explicit);
        Self {
            filterparent: model.opt.flags.filterparent,
            midphase: model.opt.flags.midphase,
            geoms: (0..model.ngeom()).map(geom).collect(),
            excludes,
            explicit,
        }
    }

    #[inline]
    pub(super) fn ngeom(&self) -> usize {
        self.geoms.len()
    }

    /// Returns whether a geom may touch any other, according to its own properties.
    pub(super) fn takes_part(&self, g: usize) -> bool {
        let geom = &self.geoms[g];
        geom.contype | geom.conaffinity != 0 || self.explicit.iter().any(|(geoms, _)| geoms.contains(&(g as u32)))
    }

    /// Returns the numbers of the explicit pairs of two geoms, ascending: a pair may be written more than once.
    fn explicit(&self, a: usize, b: usize) -> impl Iterator<Item = u32> {
        let geoms = sorted(a, b);
        let start = self.explicit.partition_point(|e| e.0 < geoms);
        let same = self.explicit[start..].iter().take_while(move |e| e.0 == geoms);
        same.map(|e| e.1)
    }

    /// Returns whether two geoms are an explicit pair.
    pub(super) fn is_explicit(&self, a: usize, b: usize) -> bool {
        self.explicit(a, b).next().is_some()
    }

    /// Returns whether two geoms may touch.
    pub fn allow(&self, a: usize, b: usize) -> bool {
        self.is_explicit(a, b) || self.collide(a, b)
    }

    /// Orders two geoms by type, then by body.
    pub(super) fn ordered(&self, a: usize, b: usize) -> [usize; 2] {
        // the routines of contacts take the lower type first
        let key = |g: usize| (self.geoms[g].kind, self.geoms[g].body, g);
        if key(a) <= key(b) { [a, b] } else { [b, a] }
    }

    /// Returns the places of the pairs of two geoms in contact order; none if they may not touch. An explicit pair replaces
    /// their own properties.
    pub(super) fn orders(&self, a: usize, b: usize) -> impl Iterator<Item = PairOrder> {
        let mut explicit = self.explicit(a, b).peekable();
        let dynamic = if explicit.peek().is_none() {
            self.dynamic_order(a, b)
        } else {
            None
        };
        explicit
            .map(move |p| self.explicit_order(p as usize, a, b))
            .chain(dynamic)
    }

    /// Returns the place in contact order of two geoms that are not an explicit pair, if they may touch.
    pub(super) fn dynamic_order(&self, a: usize, b: usize) -> Option<PairOrder> {
        self.collide(a, b).then(|| {
            let [lo, hi] = self.bodies(a, b);
            let [x, y] = if self.midphase {
                self.ordered(a, b)
            } else if self.geoms[a].body == lo {
                [a, b]
            } else {
                [b, a]
            };
            (lo, hi, true, x as u32, y as u32)
        })
    }

    /// Returns the place of an explicit pair in contact order.
    pub(super) fn explicit_order(&self, p: usize, a: usize, b: usize) -> PairOrder {
        let [lo, hi] = self.bodies(a, b);
        (lo, hi, false, p as u32, 0)
    }

    fn bodies(&self, a: usize, b: usize) -> [u32; 2] {
        sorted(self.geoms[a].body as usize, self.geoms[b].body as usize)
    }

    /// Returns whether two geoms that are not an explicit pair may touch.
    fn collide(&self, a: usize, b: usize) -> bool {
        let (x, y) = (&self.geoms[a], &self.geoms[b]);
        let flat = |kind: GeomType| matches!(kind, GeomType::Plane | GeomType::HField);
        // MuJoCo has no routine for two of these
        if flat(x.kind) && flat(y.kind) {
            return false;
        }
        if x.contype & y.conaffinity == 0 && y.contype & x.conaffinity == 0 {
            return false;
        }
        // bodies that never move against each other, as all do that are fixed to the world
        if x.weld == y.weld {
            return false;
        }
        // neighbours overlap at their joint. Children of the world are no neighbours of it, or nothing could stand on a floor.
        if self.filterparent && x.weld != 0 && y.weld != 0 && (x.weld == y.weld_parent || y.weld == x.weld_parent) {
            return false;
        }
        self.excludes.binary_search(&self.bodies(a, b)).is_err()
    }
}
