//! Contact detection: sweep and prune along x, then the exact routines.

use crate::math::{Mat3, Vec3};
use crate::model::{GeomType, Model};
use crate::physics::contact::{ContactPoint, Options, Placed, Scratch, bounding_test, collide};
use crate::physics::state::{RESERVED_CONTACTS, State};
use crate::physics::world::PairTable;

/// Boxes are enlarged by this, m: more than rounding, so that the exact routines decide.
const SLACK: f64 = 1e-7;

/// Finds contacts. Holds the sorted order of the last step, which is nearly that of the next, and all working memory.
#[derive(Clone, Debug)]
pub struct Sweep {
    options: Options,
    scratch: Scratch,
    /// Geoms that are part of a pair, by lower x of the last step.
    order: Vec<usize>,
    /// Lower and upper corner per geom.
    aabb: Vec<[Vec3; 2]>,
    candidates: Vec<u32>,
    points: Vec<ContactPoint>,
}

impl Sweep {
    /// For the geoms of `model` and the pairs of `table`.
    pub fn new(model: &Model, table: &PairTable, options: Options) -> Self {
        let in_pair = |g: usize| table.pairs().iter().any(|p| p.geom.contains(&g));
        Self {
            options,
            scratch: Scratch::new(),
            order: (0..model.ngeom()).filter(|&g| in_pair(g)).collect(),
            aabb: vec![[[0.0; 3]; 2]; model.ngeom()],
            candidates: Vec::with_capacity(2 * RESERVED_CONTACTS),
            points: Vec::with_capacity(64),
        }
    }

    /// Fills `s.contacts` from geom poses, in MuJoCo's order. The result depends on nothing but the poses.
    pub fn contacts(&mut self, model: &Model, table: &PairTable, s: &mut State) {
        self.broad_phase(model, table, s);
        s.contacts.clear();
        for &k in &self.candidates {
            let pair = &table.pairs()[k as usize];
            let placed = |g: usize| Placed {
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
            for p in &self.points {
                let mut contact = pair.template;
                (contact.dist, contact.pos, contact.frame) = (p.dist, p.pos, p.frame);
                s.contacts.push(contact);
            }
        }
    }

    /// Fills `candidates` with the pairs whose boxes overlap, ascending.
    fn broad_phase(&mut self, model: &Model, table: &PairTable, s: &State) {
        for &g in &self.order {
            let slack = SLACK + model.geom_margin[g];
            self.aabb[g] = aabb(
                model.geom_type[g],
                model.geom_size[g],
                s.geom_xpos[g],
                &s.geom_xmat[g],
                slack,
            );
        }
        // insertion sort: the order changes little from step to step
        for i in 1..self.order.len() {
            let g = self.order[i];
            let key = self.aabb[g][0][0];
            let mut k = i;
            while k > 0 && self.aabb[self.order[k - 1]][0][0] > key {
                self.order[k] = self.order[k - 1];
                k -= 1;
            }
            self.order[k] = g;
        }
        self.candidates.clear();
        for (i, &a) in self.order.iter().enumerate() {
            let [low, high] = self.aabb[a];
            for &b in &self.order[i + 1..] {
                let [other_low, other_high] = self.aabb[b];
                if other_low[0] > high[0] {
                    break;
                }
                let overlap = low[1] <= other_high[1]
                    && other_low[1] <= high[1]
                    && low[2] <= other_high[2]
                    && other_low[2] <= high[2];
                if overlap && let Some(k) = table.find(a, b) {
                    self.candidates.push(k as u32);
                }
            }
        }
        self.candidates.sort_unstable();
    }
}

/// World box of a geom, enlarged by `slack`. A plane fills the half space behind it.
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
