//! Contact detection: sweep and prune along x, then the exact routines.

use super::pairs::PairOrder;
use super::{GeomPair, PairTable, boxes, broad};
use crate::contact::{ContactOptions, ContactPoint, PlacedGeom, Scratch, bounding_test, collide};
use crate::detected::Contact;
use crate::error::{EngineError, within};
use crate::limits::Limits;
use crate::math::Vec3;
use crate::model::{GeomType, Model};
use crate::state::{RESERVED_CONTACTS, State};

/// Enlargement of boxes, m: more than rounding, so that the exact routines decide. The tolerance of the convex routines is added, because they
/// may find a contact across a gap of that size.
const SLACK: f64 = 1e-7;

/// The world box of a geom.
#[derive(Clone, Copy, Debug)]
struct WorldBox {
    geom: usize,
    /// Distance up to which any of the geom's pairs has contacts, m.
    margin: f64,
    /// Whether it can touch geoms that never move.
    moves: bool,
    low: Vec3,
    high: Vec3,
}

/// Contact detection. It keeps all working memory and the sorted order of the last step, which is nearly that of the next one.
#[derive(Clone, Debug)]
pub struct Sweep {
    options: ContactOptions,
    scratch: Scratch,
    /// Geoms that are part of a pair, with their boxes, by lower x of the last step.
    boxes: Vec<WorldBox>,
    /// Whether the boxes of geoms that never move are known.
    fixed_known: bool,
    /// The boxes that move or are near something that moves, in the same order.
    near: Vec<WorldBox>,
    /// Pairs whose boxes overlap, by their index in the table or, without a table, by their order.
    candidates: Vec<u32>,
    untabulated: Vec<(PairOrder, [u32; 2])>,
    points: Vec<ContactPoint>,
}

impl Sweep {
    /// Prepares the sweep over the geoms of `model` and the pairs of `table`.
    pub fn new(model: &Model, table: &PairTable, options: ContactOptions) -> Self {
        // an explicit pair may be of two geoms that never move
        let moves =
            |g: usize| model.moves(model.geom_bodyid[g]) || model.pair_geom.iter().any(|pair| pair.contains(&g));
        // the boxes of two geoms reach as far as their pair's margin together if either reaches as far alone
        let mut margin = model.geom_margin.clone();
        for (pair, &own) in model.pair_geom.iter().zip(&model.pair_margin) {
            for &g in pair {
                margin[g] = margin[g].max(own);
            }
        }
        let boxes: Vec<WorldBox> = (0..model.ngeom())
            .filter(|&g| table.takes_part(g))
            .map(|geom| WorldBox {
                geom,
                margin: margin[geom],
                moves: moves(geom),
                low: [0.0; 3],
                high: [0.0; 3],
            })
            .collect();
        Self {
            options,
            scratch: Scratch::new(),
            fixed_known: false,
            near: Vec::with_capacity(boxes.len()),
            boxes,
            candidates: Vec::with_capacity(2 * RESERVED_CONTACTS),
            untabulated: Vec::new(),
            points: Vec::with_capacity(64),
        }
    }

    /// Fills `s.contact` from geom poses, in MuJoCo's order. The result depends on nothing but the poses.
    ///
    /// # Errors
    /// More geoms near each other, or more contacts, than [`Limits`] allow by default.
    #[doc(alias("mj_collision", "mj_broadphase"))]
    #[inline(always)]
    pub fn contacts(&mut self, model: &Model, table: &PairTable, s: &mut State) -> Result<(), EngineError> {
        self.place(model, s);
        s.contact.clear();
        match table.pairs() {
            Some(pairs) => {
                self.sort_boxes();
                self.select_near();
                self.broad_phase(table);
                let candidates = std::mem::take(&mut self.candidates);
                for &k in &candidates {
                    self.narrow_phase(model, table, &pairs[k as usize], s);
                }
                self.candidates = candidates;
            }
            None => {
                self.boxes.sort_unstable_by(|a, b| a.low[0].total_cmp(&b.low[0]));
                self.select_near();
                self.broad_phase_untabulated(table, s.step)?;
                let candidates = std::mem::take(&mut self.untabulated);
                for &(order, [a, b]) in &candidates {
                    self.narrow_phase(model, table, &table.pair(model, order, a as usize, b as usize), s);
                    within(Limits::DEFAULT.contacts, s.contact.len(), "contacts", s.step)?;
                }
                self.untabulated = candidates;
            }
        }
        within(Limits::DEFAULT.contacts, s.contact.len(), "contacts", s.step)
    }

    /// Returns the options and the working memory of the routines, for contacts of flexes.
    pub fn tools(&mut self) -> (&ContactOptions, &mut Scratch) {
        (&self.options, &mut self.scratch)
    }

    /// Adds the contacts of a pair.
    #[doc(alias = "mj_collideGeoms")]
    #[inline(always)]
    fn narrow_phase(&mut self, model: &Model, table: &PairTable, pair: &GeomPair, s: &mut State) {
        let [a, b] = pair.geom;
        let (first, second) = (placed(model, s, a), placed(model, s, b));
        if !bounding_test(
            &first,
            s.params.geom_rbound[a],
            &second,
            s.params.geom_rbound[b],
            pair.margin,
        ) {
            return;
        }
        let (scratch, points) = (&mut self.scratch, &mut self.points);
        points.clear();
        collide(&first, &second, pair.margin, &self.options, scratch, points);
        if !points.is_empty() && broad::drops(model, s, pair.geom) {
            return;
        }
        let margins = [pair.margin, pair.body_margin];
        if pair.midphase && !points.is_empty() && table.trees().apart(&first, &second, model, pair.geom, margins, s) {
            return;
        }
        s.contact.extend(points.iter().map(|p| Contact {
            dist: p.dist,
            pos: p.pos,
            frame: p.frame,
            ..pair.template
        }));
    }

    /// Computes the boxes of geoms that move, and in the first call also those of the others.
    #[inline(always)]
    fn place(&mut self, model: &Model, s: &State) {
        for b in &mut self.boxes {
            if self.fixed_known && !b.moves {
                continue;
            }
            let g = b.geom;
            let slack = SLACK + self.options.ccd_tolerance + b.margin;
            [b.low, b.high] = boxes::world(
                model.geom_type[g],
                (s.params.geom_size[g], &model.geom_aabb[g]),
                s.geom_xpos[g],
                &s.geom_xmat[g],
                slack,
            );
        }
        self.fixed_known = true;
    }

    /// Fills `near`: geoms that never move are included if they overlap the box around all moving ones.
    #[inline(always)]
    fn select_near(&mut self) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for b in self.boxes.iter().filter(|b| b.moves) {
            for k in 0..3 {
                low[k] = if b.low[k] < low[k] { b.low[k] } else { low[k] };
                high[k] = if b.high[k] > high[k] { b.high[k] } else { high[k] };
            }
        }
        let near =
            |b: &&WorldBox| b.moves | (0..3).fold(true, |all, k| all & (low[k] <= b.high[k]) & (b.low[k] <= high[k]));
        self.near.clear();
        self.near.extend(self.boxes.iter().filter(near));
    }

    /// Sorts the boxes by insertion: their order changes little from step to step.
    #[inline(always)]
    fn sort_boxes(&mut self) {
        for i in 1..self.boxes.len() {
            let b = self.boxes[i];
            let mut k = i;
            while k > 0 && self.boxes[k - 1].low[0] > b.low[0] {
                self.boxes[k] = self.boxes[k - 1];
                k -= 1;
            }
            if k < i {
                self.boxes[k] = b;
            }
        }
    }

    /// Fills `candidates` with the pairs whose boxes overlap, ascending.
    #[inline(always)]
    fn broad_phase(&mut self, table: &PairTable) {
        self.candidates.clear();
        let candidates = &mut self.candidates;
        overlaps(&self.near, |a, b| {
            candidates.extend(table.tabulated(a, b).map(|k| k as u32));
            true
        });
        self.candidates.sort_unstable();
    }

    /// Fills `untabulated` with the pairs whose boxes overlap, in contact order.
    fn broad_phase_untabulated(&mut self, table: &PairTable, step: u64) -> Result<(), EngineError> {
        let (limit, mut near) = (Limits::DEFAULT.near_pairs, 0);
        let candidates = &mut self.untabulated;
        candidates.clear();
        overlaps(&self.near, |a, b| {
            candidates.extend(table.orders(a, b).map(|order| (order, [a as u32, b as u32])));
            near += 1;
            near <= limit
        });
        within(limit, near, "pairs of geoms near each other", step)?;
        candidates.sort_unstable();
        Ok(())
    }
}

/// Calls `found` with the geoms of boxes that overlap, which are sorted by lower x, until it returns false.
#[inline(always)]
fn overlaps(boxes: &[WorldBox], mut found: impl FnMut(usize, usize) -> bool) {
    let mut rest = boxes;
    while let [a, others @ ..] = rest {
        rest = others;
        let (low, high) = (a.low, a.high);
        for b in others {
            if b.low[0] > high[0] {
                break;
            }
            // no branches between the comparisons: they are hard to predict
            let overlap = (low[1] <= b.high[1]) & (b.low[1] <= high[1]) & (low[2] <= b.high[2]) & (b.low[2] <= high[2]);
            if overlap && !found(a.geom, b.geom) {
                return;
            }
        }
    }
}

/// Returns a geom with its pose.
#[inline(always)]
pub fn placed<'a>(model: &'a Model, s: &'a State, g: usize) -> PlacedGeom<'a> {
    PlacedGeom {
        kind: model.geom_type[g],
        size: s.params.geom_size[g],
        pos: s.geom_xpos[g],
        mat: &s.geom_xmat[g],
        mesh: match model.geom_type[g] {
            GeomType::Mesh | GeomType::Ellipsoid => model.geom_dataid[g].and_then(|mesh| model.meshes.get(mesh)),
            _ => None,
        },
        hfield: match model.geom_type[g] {
            GeomType::HField => model.geom_dataid[g].and_then(|hfield| model.hfields.get(hfield)),
            _ => None,
        },
    }
}
