//! Solving `M x = b` by articulated bodies: linear in the number of degrees of freedom (Featherstone 2008, chapter 7).

mod four;

use std::ops::Range;

use super::CompositeInertia;
use crate::model::{Arrays, JointType};
use crate::spatial::{Inertia, Spatial, axpy6, dot6};
use crate::state::State;

pub use four::Four;

/// One value for the inertia and one for the inertia with implicit damping, side by side so that one vector instruction computes both.
type DampingPair = [f64; 2];

/// The matrix to solve with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// `M`
    Without,
    /// `M + h D`, of the integrator.
    Implicit,
}

/// The articulated inertias of all bodies, without damping and with that of the integrator; both are computed at
/// once.
#[derive(Clone, Debug)]
pub struct Articulated {
    /// The links, ascending by body.
    links: Vec<Link>,
    /// Bodies that neither have nor carry joints, which are rigid parts of links: the last ones first.
    loads: Vec<FixedBody>,
    /// The inertia of each link: lower triangle of the symmetric 6 by 6 matrix, row by row.
    inertia: Vec<[DampingPair; 21]>,
    /// One for each degree of freedom.
    released: Vec<ArticulatedDof>,
    /// Working memory of a solution: links, links, degrees of freedom.
    force: Vec<Spatial>,
    acc: Vec<Spatial>,
    rest: Vec<f64>,
    /// Working memory of four right sides: links.
    forces: Vec<four::Four6>,
}

/// A body that joints move, with its own joints or those of a descendant.
#[derive(Clone, Debug)]
struct Link {
    body: usize,
    /// Its own degrees of freedom.
    dofs: Range<usize>,
    /// The next link towards the world, if there is one.
    parent: Option<usize>,
    /// Whether its first three degrees of freedom move it along the axes of the world, as those of a free joint do.
    free: bool,
    /// All except these three if it is free in the world, because products with their axes, zeros and a one, are written out; otherwise all.
    turning: Range<usize>,
}

/// A body that is fixed to a link, with its descendants.
#[derive(Clone, Copy, Debug)]
struct FixedBody {
    body: usize,
    link: usize,
}

/// A degree of freedom of an articulated body.
#[derive(Clone, Copy, Debug, Default)]
struct ArticulatedDof {
    /// Force of a unit acceleration of only this degree of freedom.
    unit_force: [DampingPair; 6],
    /// Inverse of the inertia that it feels.
    inverse: DampingPair,
}

/// Returns the index of row `i`, column `j <= i` in a packed lower triangle.
const fn at(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

/// Converts the inertia of a rigid body to a matrix, as a packed lower triangle.
#[inline(always)]
fn matrix(i: &Inertia) -> [f64; 21] {
    let [xx, yy, zz, xy, xz, yz, x, y, z, m] = *i;
    [
        // below the rotational part stands the matrix that crosses with the mass times the offset of its centre
        xx, xy, yy, xz, yz, zz, // rotation
        0.0, z, -y, m, // x
        -z, 0.0, x, 0.0, m, // y
        y, -x, 0.0, 0.0, 0.0, m, // z
    ]
}

impl Articulated {
    /// Reserves memory for the bodies of `model`.
    pub fn new(model: &Arrays) -> Self {
        let nb = model.nbody();
        let mut bears: Vec<bool> = model.body_dofnum.iter().map(|&n| n > 0).collect();
        for b in (1..nb).rev() {
            bears[model.body_parentid[b]] |= bears[b];
        }
        // bodies that are fixed to the world take no part
        let (mut links, mut loads) = (Vec::new(), Vec::new());
        let mut link_of = vec![None; nb];
        for b in 1..nb {
            let parent = link_of[model.body_parentid[b]];
            if bears[b] && (parent.is_some() || model.body_dofnum[b] > 0) {
                link_of[b] = Some(links.len());
                let dofs = model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b];
                let free = model.body_jntnum[b] > 0 && model.jnt_type[model.body_jntadr[b]] == JointType::Free;
                let moving = if free && parent.is_none() { 3 } else { 0 };
                links.push(Link {
                    body: b,
                    turning: dofs.start + moving..dofs.end,
                    dofs,
                    parent,
                    free,
                });
            } else if let Some(link) = parent {
                loads.push(FixedBody { body: b, link });
            }
        }
        loads.reverse();
        Self {
            inertia: vec![[[0.0; 2]; 21]; links.len()],
            released: vec![ArticulatedDof::default(); model.nv],
            force: vec![[0.0; 6]; links.len()],
            acc: vec![[0.0; 6]; links.len()],
            rest: vec![0.0; model.nv],
            forces: Vec::new(),
            links,
            loads,
        }
    }

    /// Computes the inertias from `cinert`, the composite inertias, `cdof`, armature and damping.
    #[doc(alias = "mj_factorM")]
    #[inline(always)]
    pub fn update(&mut self, model: &Arrays, s: &State, composite: &CompositeInertia) {
        for (link, inertia) in self.links.iter().zip(&mut self.inertia) {
            *inertia = matrix(&s.cinert[link.body]).map(|v| [v; 2]);
        }
        let h = model.opt.timestep;
        let mut loads = self.loads.iter().peekable();
        // children have higher ids than their parents, so each link is complete when its turn comes
        for (k, link) in self.links.iter().enumerate().rev() {
            while let Some(load) = loads.next_if(|load| load.body > link.body) {
                for (a, v) in self.inertia[load.link]
                    .iter_mut()
                    .zip(matrix(&composite.crb[load.body]))
                {
                    *a = [a[0] + v, a[1] + v];
                }
            }
            let (head, tail) = self.inertia.split_at_mut(k);
            let inertia = &mut tail[0];
            for d in link.dofs.clone().rev() {
                // armature is inertia of the motor's rotor, felt along the joint alone; h D is what implicit damping
                // adds to the diagonal
                let extra = [
                    model.dof_armature[d],
                    model.dof_armature[d] + h * s.params.dof_damping[d],
                ];
                // from the joint next to the body to the one next to its parent: each moves all behind it
                let (k, inwards) = (d - link.dofs.start, link.parent.is_some());
                let (force, felt) = match k {
                    0..3 if link.free => unit_force_along(inertia, 3 + k, extra),
                    _ => unit_force(inertia, &s.cdof[d], extra),
                };
                self.released[d] = match k {
                    // the remaining inertia is felt by the remaining degrees of freedom alone
                    0..3 if link.free && !inwards => release(inertia, force, felt, 3..3 + k),
                    // the world cannot be accelerated, so its inertia is not needed
                    0 if !inwards => release(inertia, force, felt, 0..0),
                    _ => release(inertia, force, felt, 0..6),
                };
            }
            if let Some(p) = link.parent {
                for (a, c) in head[p].iter_mut().zip(inertia) {
                    for k in 0..2 {
                        a[k] += c[k];
                    }
                }
            }
        }
    }

    /// Solves `M x = b` (nv), or with damping `(M + h D) x = b`.
    #[doc(alias = "mj_solveM")]
    #[inline(always)]
    pub fn solve(&mut self, s: &State, damping: Damping, b: &[f64], x: &mut [f64]) {
        let links = 0..self.links.len();
        match damping {
            Damping::Without => self.solve_lane::<0>(s, links, b, x),
            Damping::Implicit => self.solve_lane::<1>(s, links, b, x),
        }
    }

    /// Solves `M x = b` for the degrees of freedom of some bodies that form whole trees; the rest of `x` stays as it is.
    pub(super) fn solve_trees(&mut self, s: &State, bodies: Range<usize>, b: &[f64], x: &mut [f64]) {
        self.solve_lane::<0>(s, self.links_of(bodies), b, x);
    }

    /// Returns the links of a range of bodies, by their places.
    fn links_of(&self, bodies: Range<usize>) -> Range<usize> {
        let place = |body: usize| self.links.partition_point(|link| link.body < body);
        place(bodies.start)..place(bodies.end)
    }

    #[inline(always)]
    fn solve_lane<const LANE: usize>(&mut self, s: &State, links: Range<usize>, b: &[f64], x: &mut [f64]) {
        let (force, acc) = (&mut self.force[..links.end], &mut self.acc[..links.end]);
        force[links.clone()].fill([0.0; 6]);
        // The second and third pass of the articulated-body algorithm (Featherstone 2008, table 7.1), without its
        // velocity terms: those are in `b`. Inwards, each joint keeps what its own inertia takes of the force and
        // passes on the rest.
        for k in links.clone().rev() {
            let Link {
                dofs, parent, turning, ..
            } = &self.links[k];
            let mut f = force[k];
            let values = s.cdof[turning.clone()].iter().zip(&self.released[turning.clone()]);
            let lanes = self.rest[turning.clone()].iter_mut().zip(&b[turning.clone()]);
            for ((axis, d), (rest, b)) in values.zip(lanes).rev() {
                *rest = b - dot6(axis, &f);
                axpy6(&mut f, *rest * d.inverse[LANE], &d.unit_force.map(|v| v[LANE]));
            }
            if turning.start > dofs.start {
                for k in (0..3).rev() {
                    let d = dofs.start + k;
                    self.rest[d] = b[d] - (0.0 + f[3 + k]);
                    let (released, f) = (&self.released[d], &mut f[3..3 + k]);
                    let share = self.rest[d] * released.inverse[LANE];
                    for (f, unit) in f.iter_mut().zip(&released.unit_force[3..]) {
                        *f += share * unit[LANE];
                    }
                }
            }
            if let Some(p) = *parent {
                axpy6(&mut force[p], 1.0, &f);
            }
        }
        // outwards, each joint answers to the acceleration of its parent, which is known by then
        for k in links {
            let Link {
                dofs, parent, turning, ..
            } = &self.links[k];
            let mut a = parent.map_or([0.0; 6], |p| acc[p]);
            if turning.start > dofs.start {
                for k in 0..3 {
                    let released = &self.released[dofs.start + k];
                    let others = released.unit_force[3..3 + k].iter().zip(&a[3..]);
                    let along = others.fold(0.0, |sum, (unit, a)| sum + unit[LANE] * a);
                    let x = &mut x[dofs.start + k];
                    *x = (self.rest[dofs.start + k] - along) * released.inverse[LANE];
                    a[3 + k] += *x;
                }
            }
            let values = s.cdof[turning.clone()].iter().zip(&self.released[turning.clone()]);
            let lanes = self.rest[turning.clone()].iter().zip(&mut x[turning.clone()]);
            for ((axis, d), (rest, x)) in values.zip(lanes) {
                *x = (rest - dot6(&d.unit_force.map(|v| v[LANE]), &a)) * d.inverse[LANE];
                axpy6(&mut a, *x, axis);
            }
            acc[k] = a;
        }
    }
}

/// Returns the force of a unit acceleration of an articulated body along `axis`, and the inertia that is felt along it; `extra` adds to that.
#[inline(always)]
fn unit_force(inertia: &[DampingPair; 21], axis: &Spatial, extra: DampingPair) -> ([DampingPair; 6], DampingPair) {
    let (mut force, mut felt) = ([[0.0; 2]; 6], extra);
    for i in 0..6 {
        for j in 0..6 {
            // only the lower triangle is kept, as the inertia stays symmetric
            let place = if j <= i { at(i, j) } else { at(j, i) };
            for k in 0..2 {
                force[i][k] += inertia[place][k] * axis[j];
            }
        }
        for k in 0..2 {
            felt[k] += force[i][k] * axis[i];
        }
    }
    (force, felt)
}

/// The same along a unit vector that is 1 in row `row` only, so it picks a column. Products with zero are left out: they affect only the sign of a
/// zero, and so does adding to zero.
#[inline(always)]
fn unit_force_along(inertia: &[DampingPair; 21], row: usize, extra: DampingPair) -> ([DampingPair; 6], DampingPair) {
    let force = std::array::from_fn(|i| {
        let [a, b] = inertia[at(i.max(row), i.min(row))];
        [0.0 + a, 0.0 + b]
    });
    let [a, b]: DampingPair = force[row];
    (force, [extra[0] + a, extra[1] + b])
}

/// Frees an articulated body to move along an axis with the given force and inertia: removes the inertia that this motion feels, in the rows and
/// columns `left` that are still needed.
#[inline(always)]
fn release(
    inertia: &mut [DampingPair; 21],
    force: [DampingPair; 6],
    felt: DampingPair,
    left: Range<usize>,
) -> ArticulatedDof {
    let inverse = [1.0 / felt[0], 1.0 / felt[1]];
    for i in left.clone() {
        // I - U D^-1 U': inertia that moves freely with the joint is not felt beyond it
        let scaled = [force[i][0] * inverse[0], force[i][1] * inverse[1]];
        for j in left.start..=i {
            for k in 0..2 {
                inertia[at(i, j)][k] -= scaled[k] * force[j][k];
            }
        }
    }
    ArticulatedDof {
        unit_force: force,
        inverse,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::MemoryAssets;
    use crate::dynamics::mul_m;
    use crate::mjcf_loader::load_str;
    use crate::{Engine, SoftEngine, SoftOptions, Topology, compile};

    /// A free trunk with branching limbs, joints with and without damping, and rigid parts; beside it other bodies, one of them on a fixed base.
    const BRANCHES: &str = r#"<mujoco><option gravity="0 0 -9.81"/><default><joint armature=".01"/></default><worldbody>
        <body name="trunk" pos="0 0 1"><freejoint/><geom type="capsule" size=".1 .2"/>
          <body pos=".2 0 .1"><joint axis="0 1 0" damping=".3"/><joint axis="1 0 0"/><geom type="capsule" size=".04 .1"/>
            <body pos=".2 0 0"><joint axis="0 0 1" damping="2"/><geom size=".05" pos=".1 0 0"/>
              <body pos=".2 0 0"><joint axis="0 1 0"/><geom type="box" size=".05 .02 .01" pos=".05 0 0"/></body>
              <body pos=".2 .1 0"><joint axis="1 1 0" damping=".1"/><geom type="box" size=".05 .02 .01"/></body>
              <body pos="0 .1 0"><geom size=".03"/><body pos="0 .1 .1"><geom size=".02"/></body></body>
            </body>
            <body pos=".1 .1 0"><geom size=".03"/><body pos="0 .1 .1"><joint axis="1 0 0"/><geom size=".02" pos="0 .1 0"/></body></body>
          </body>
          <body pos="-.2 0 .1"><joint type="slide" axis="1 0 0" damping="5"/><geom type="cylinder" size=".03 .1"/>
            <body pos="-.1 0 0"><joint axis="0 0 1"/><joint axis="0 1 0"/><joint axis="1 0 0"/><geom size=".02" pos="-.1 0 0"/></body>
          </body>
        </body>
        <body pos="2 0 1"><freejoint/><geom type="box" size=".1 .2 .3"/></body>
        <body pos="4 0 1"><geom size=".1"/><body><joint axis="0 1 0" pos="0 0 1" damping=".01"/><geom size=".1"/></body>
          <body pos="0 1 0"><geom size=".2"/></body></body>
        </worldbody></mujoco>"#;

    #[test]
    fn solutions_agree_with_the_inertia_matrix() {
        let spec = load_str(BRANCHES, "branches.xml", &MemoryAssets::new()).expect("valid");
        let model = std::sync::Arc::new(compile(spec).expect("valid"));
        let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
        let model = &*model;
        let mut s = engine.new_state();
        for (k, q) in s.qpos.iter_mut().enumerate().skip(7).take(9) {
            *q += 0.3 * (k % 5) as f64 - 0.6;
        }
        engine.forward(&mut s).expect("finite");
        let (mut bodies, mut composite) = (Articulated::new(model), CompositeInertia::default());
        crate::dynamics::crb(model, &Topology::new(model), &mut s, &mut composite);
        bodies.update(model, &s, &composite);
        let x: Vec<f64> = (0..model.nv).map(|d| (d % 7) as f64 - 3.0).collect();
        let (mut b, mut found) = (vec![0.0; model.nv], vec![0.0; model.nv]);
        mul_m(&Topology::new(model), &s.qm, &x, &mut b);
        bodies.solve(&s, Damping::Without, &b, &mut found);
        let worst = |found: &[f64]| x.iter().zip(found).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(worst(&found) < 1e-11, "{:e}", worst(&found));
        // b' M^-1 c from halves, of four at once
        let sides: Vec<Four> = b.iter().map(|v| [*v, 2.0 * v, v - 1.0, 0.0]).collect();
        let mut halves = vec![[0.0; 4]; model.nv];
        bodies.half_solve_four(&s, 0..model.nv, &sides, &mut halves);
        for lane in 0..4 {
            let whole: f64 = sides.iter().zip(&found).map(|(side, x)| side[lane] * x).sum();
            let half = |d: usize| halves[d][lane] * bodies.inverse(d) * halves[d][0];
            let product: f64 = (0..model.nv).map(half).sum();
            assert!((whole - product).abs() < 1e-9, "{lane}: {whole} {product}");
        }
        for d in 0..model.nv {
            b[d] += model.opt.timestep * s.params.dof_damping[d] * x[d];
        }
        bodies.solve(&s, Damping::Implicit, &b, &mut found);
        assert!(worst(&found) < 1e-11, "{:e}", worst(&found));
    }
}
