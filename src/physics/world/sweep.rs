//! Contact detection: sweep and prune along x, then the exact routines.

use crate::math::{Mat3, Vec3};
use crate::model::{GeomType, Model};
use crate::physics::contact::{ContactOptions, ContactPoint, PlacedGeom, Scratch, bounding_test, collide};
use crate::physics::state::{Contact, RESERVED_CONTACTS, State};
use crate::physics::world::PairTable;

/// Enlargement of boxes, m: more than rounding, so that the exact routines decide.
const SLACK: f64 = 1e-7;

/// The world box of a geom.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    geom: usize,
    low: Vec3,
    high: Vec3,
}

/// Contact detection, with the sorted order of the last step, which is nearly that of the next, and all working memory.
#[derive(Clone, Debug)]
pub struct Sweep {
    options: ContactOptions,
    scratch: Scratch,
    /// Geoms that are part of a pair, with their boxes, by lower x of the last step.
    boxes: Vec<Bounds>,
    candidates: Vec<u32>,
    points: Vec<ContactPoint>,
}

impl Sweep {
    /// Prepares the sweep over the geoms of `model` and the pairs of `table`.
    pub fn new(model: &Model, table: &PairTable, options: ContactOptions) -> Self {
        let in_pair = |g: usize| table.pairs().iter().any(|p| p.geom.contains(&g));
        Self {
            options,
            scratch: Scratch::new(),
            boxes: (0..model.ngeom())
                .filter(|&g| in_pair(g))
                .map(|geom| Bounds {
                    geom,
                    low: [0.0; 3],
                    high: [0.0; 3],
                })
                .collect(),
            candidates: Vec::with_capacity(2 * RESERVED_CONTACTS),
            points: Vec::with_capacity(64),
        }
    }

    /// Fills `s.contact` from geom poses, in MuJoCo's order. The result depends on nothing but the poses.
    pub fn contacts(&mut self, model: &Model, table: &PairTable, s: &mut State) {
        self.broad_phase(model, table, s);
        s.contact.clear();
        for &k in &self.candidates {
            let pair = &table.pairs()[k as usize];
            let placed = |g: usize| PlacedGeom {
                kind: model.geom_type[g],
                size: model.geom_size[g],
                pos: s.geom_xpos[g],
                mat: &s.geom_xmat[g],
            };
            let [a, b] = pair.geom;
            let (first, second) = (placed(a), placed(b));
            if !bounding_test(&first, model.geom_rbound[a], &second, model.geom_rbound[b], pair.margin) {
                continue;
            }
            self.points.clear();
            collide(
                &first,
                &second,
                pair.margin,
                &self.options,
                &mut self.scratch,
                &mut self.points,
            );
            s.contact.extend(self.points.iter().map(|p| Contact {
                dist: p.dist,
                pos: p.pos,
                frame: p.frame,
                ..pair.template
            }));
        }
    }

    /// Fills `candidates` with the pairs whose boxes overlap, ascending.
    fn broad_phase(&mut self, model: &Model, table: &PairTable, s: &State) {
        for b in &mut self.boxes {
            let g = b.geom;
            let slack = SLACK + model.geom_margin[g];
            [b.low, b.high] = aabb(
                model.geom_type[g],
                model.geom_size[g],
                s.geom_xpos[g],
                &s.geom_xmat[g],
                slack,
            );
        }
        // insertion sort: the order changes little from step to step
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
        self.candidates.clear();
        let mut rest = &self.boxes[..];
        while let [a, others @ ..] = rest {
            rest = others;
            let (low, high) = (a.low, a.high);
            for b in others {
                if b.low[0] > high[0] {
                    break;
                }
                // no branches between the comparisons: they are hard to predict
                let overlap =
                    (low[1] <= b.high[1]) & (b.low[1] <= high[1]) & (low[2] <= b.high[2]) & (b.low[2] <= high[2]);
                if overlap && let Some(k) = table.find(a.geom, b.geom) {
                    self.candidates.push(k as u32);
                }
            }
        }
        self.candidates.sort_unstable();
    }
}

/// Returns the world box of a geom, enlarged by `slack` (m). A plane fills the half space behind it.
fn aabb(kind: GeomType, size: Vec3, pos: Vec3, mat: &Mat3, slack: f64) -> [Vec3; 2] {
    let half: Vec3 = match kind {
        GeomType::Plane => {
            let mut high = [f64::INFINITY; 3];
            if mat[2] == 0.0 && mat[5] == 0.0 && mat[8] > 0.0 {
                high[2] = pos[2] + slack;
            }
            return [[f64::NEG_INFINITY; 3], high];
        }
        GeomType::Sphere => [size[0]; 3],
        GeomType::Capsule => std::array::from_fn(|k| size[0] + mat[3 * k + 2].abs() * size[1]),
        GeomType::Cylinder => std::array::from_fn(|k| {
            let a = mat[3 * k + 2];
            a.abs() * size[1] + size[0] * (1.0 - a * a).max(0.0).sqrt()
        }),
        GeomType::Box | GeomType::Ellipsoid => std::array::from_fn(|k| {
            mat[3 * k].abs() * size[0] + mat[3 * k + 1].abs() * size[1] + mat[3 * k + 2].abs() * size[2]
        }),
    };
    [
        std::array::from_fn(|k| pos[k] - half[k] - slack),
        std::array::from_fn(|k| pos[k] + half[k] + slack),
    ]
}
