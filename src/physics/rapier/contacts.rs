//! Contacts between Rapier's solver and a [`State`].
//!
//! Contacts are found by the sweep, as the rows of the step need them beforehand. Rapier's narrow phase finds the same
//! ones with the same routines; while it does, the hooks give each the velocity that its row asks for.

use rapier3d_f64::geometry::{ContactData, ContactManifold, NarrowPhase, SolverFlags};
use rapier3d_f64::parry::math::Vector;
use rapier3d_f64::pipeline::{ContactModificationContext, PairFilterContext, PhysicsHooks};

use crate::bodies::RapierBodies;
use crate::scene::{geom_pose, pose};
use mjcf_sim_model::math::*;
use mjcf_sim_model::model::{ConeType, Model};
use mjcf_sim_physics::constraint::ConstraintType;
use mjcf_sim_physics::contact::frame::from_normal;
use mjcf_sim_physics::{Contact, State};

/// The target of Rapier's solver for one contact.
#[derive(Clone, Copy, Debug)]
struct ContactTarget {
    geom: [usize; 2],
    /// Velocity of the second geom relative to the first, in the frame of the contact, m/s.
    velocity: Vec3,
    friction: f64,
}

/// Returns two geoms, the lower id first.
fn unordered([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The contacts of a pair of geoms.
#[derive(Clone, Copy, Debug)]
struct TouchingPair {
    /// The geoms, the lower id first.
    pair: [usize; 2],
    /// First contact of the state.
    first: usize,
    /// Number of contacts.
    number: usize,
}

/// The contacts of a step, prepared for Rapier's solver.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactTargets {
    /// Pairs that touch, ascending.
    pairs: Vec<TouchingPair>,
    /// The target of each contact of the state; `None` if it is not a constraint.
    aims: Vec<Option<ContactTarget>>,
    /// Frames of the contacts.
    frames: Vec<Mat3>,
    h: f64,
    rate: f64,
}

impl ContactTargets {
    /// Loads the contacts and rows of a state. `rate` is the rate at which Rapier reduces penetration, 1/s.
    pub fn load(&mut self, s: &State, h: f64, rate: f64) {
        (self.h, self.rate) = (h, rate);
        self.pairs.clear();
        self.aims.clear();
        self.frames.clear();
        for (k, c) in s.contact.iter().enumerate() {
            self.frames.push(c.frame);
            self.aims.push(None);
            let pair = unordered(c.geom);
            match self.pairs.last_mut() {
                Some(last) if last.pair == pair => last.number += 1,
                _ => self.pairs.push(TouchingPair {
                    pair,
                    first: k,
                    number: 1,
                }),
            }
        }
        self.pairs.sort_unstable_by_key(|p| p.pair);
        for block in &s.efc.blocks {
            if !matches!(
                block.kind,
                ConstraintType::ContactElliptic
                    | ConstraintType::ContactPyramidal
                    | ConstraintType::ContactFrictionless
            ) {
                continue;
            }
            let c = &s.contact[block.id];
            let row = |r: usize| s.efc.vel[block.row + r] + h * s.efc.aref[block.row + r];
            // the edges of a pyramid are the normal plus and minus a tangent times its friction
            let edge = |r: usize| (row(2 * r - 2), row(2 * r - 1));
            let aim = |r: usize| match (block.kind, r) {
                (ConstraintType::ContactPyramidal, 0) => 0.5 * (edge(1).0 + edge(1).1),
                (ConstraintType::ContactPyramidal, r) => 0.5 * (edge(r).0 - edge(r).1) / c.friction[r - 1],
                _ => row(r),
            };
            self.aims[block.id] = Some(ContactTarget {
                geom: c.geom,
                velocity: std::array::from_fn(|r| if r < c.dim { aim(r) } else { 0.0 }),
                friction: if c.dim > 1 { c.friction[0] } else { 0.0 },
            });
        }
    }

    /// Returns the contact at place `ordinal` in the list of a pair.
    fn find(&self, geoms: [usize; 2], ordinal: usize) -> Option<usize> {
        let at = self.pairs.binary_search_by_key(&unordered(geoms), |p| p.pair).ok()?;
        let TouchingPair { first, number, .. } = self.pairs[at];
        (ordinal < number).then_some(first + ordinal)
    }

    /// Returns the distance that makes Rapier target a normal velocity: it lets a gap close within the step, and
    /// reduces penetration at its rate.
    fn distance(&self, normal: f64) -> f64 {
        if normal < 0.0 {
            -normal * self.h
        } else {
            -normal / self.rate
        }
    }
}

/// The hooks for `PhysicsPipeline::step`: which geoms may touch, and how their contacts are solved. Contacts with
/// colliders that are not the model's are left to Rapier.
#[derive(Clone, Copy)]
pub struct ContactHooks<'a> {
    pub(super) rig: &'a RapierBodies,
    pub(super) aims: &'a ContactTargets,
}

impl std::fmt::Debug for ContactHooks<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactHooks").finish_non_exhaustive()
    }
}

impl ContactHooks<'_> {
    /// Returns the contact of a manifold, identified by its geoms and its place in the list of the pair.
    fn contact(&self, a: usize, b: usize, manifold: &ContactManifold) -> Option<usize> {
        self.aims.find([a, b], manifold.subshape1 as usize)
    }
}

impl PhysicsHooks for ContactHooks<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let of = |c| self.rig.geom_of(c);
        let touching = match (of(context.collider1), of(context.collider2)) {
            (Some(a), Some(b)) => self.aims.find([a, b], 0).is_some(),
            _ => true,
        };
        touching.then_some(SolverFlags::COMPUTE_RIGID_IMPULSES)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let of = |c| self.rig.geom_of(c);
        let (Some(a), Some(b)) = (of(context.collider1), of(context.collider2)) else {
            return;
        };
        let Some(manifold) = context.rigid_mut() else { return };
        let found = self.contact(a, b, manifold.manifold);
        let Some((k, aim)) = found.and_then(|k| Some((k, self.aims.aims[k]?))) else {
            manifold.solver_contacts.clear();
            return;
        };
        (*manifold.friction, *manifold.restitution) = (aim.friction, 0.0);
        let sign = if aim.geom[0] == a { 1.0 } else { -1.0 };
        let [_, t1, t2] = aim.velocity;
        let slip = scale(mat_t_vec(&self.aims.frames[k], [0.0, t1, t2]), sign);
        for contact in manifold.solver_contacts.iter_mut() {
            contact.dist = self.aims.distance(aim.velocity[0]);
            contact.tangent_velocity = Vector::new(slip[0], slip[1], slip[2]);
        }
    }
}

/// Writes the forces of contacts to the state, in the contacts' frames, and to the rows of `s.efc`. Contacts with
/// colliders that are not the model's are appended, with the geom `stranger` instead of the other collider.
pub(super) fn read_contacts(
    hooks: &ContactHooks,
    model: &Model,
    narrow: &NarrowPhase,
    s: &mut State,
    stranger: Option<usize>,
) {
    s.contact.truncate(hooks.aims.aims.len());
    s.contact.iter_mut().for_each(|c| c.force = [0.0; 6]);
    for pair in narrow.contact_pairs() {
        let geoms = [pair.collider1, pair.collider2].map(|c| hooks.rig.geom_of(c));
        for manifold in pair.manifolds() {
            match geoms {
                [Some(a), Some(b)] => {
                    if let Some(k) = hooks.contact(a, b, manifold) {
                        read_own(model, manifold, a, &mut s.contact[k], &mut s.efc.force);
                    }
                }
                [Some(own), None] => read_foreign(model, manifold, own, 0, stranger, s),
                [None, Some(own)] => read_foreign(model, manifold, own, 1, stranger, s),
                [None, None] => {}
            }
        }
    }
}

/// Returns the force on the second body of a manifold at one of its points, world, N.
fn force(manifold: &ContactManifold, point: &ContactData, h: f64) -> Vec3 {
    let f = manifold.data.normal * point.impulse - point.warmstart_tangent_world;
    scale([f.x, f.y, f.z], 1.0 / h)
}

fn read_own(model: &Model, manifold: &ContactManifold, first: usize, c: &mut Contact, rows: &mut [f64]) {
    let Some(point) = manifold.points.first() else { return };
    let sign = if c.geom[0] == first { 1.0 } else { -1.0 };
    let f = mat_vec(&c.frame, scale(force(manifold, &point.data, model.opt.timestep), sign));
    c.force[..3].copy_from_slice(&f);
    if let Some(row) = c.efc_address {
        if model.opt.cone == ConeType::Pyramidal && c.dim > 1 {
            // As evenly as it goes (MuJoCo's `mju_encodePyramid`). Where geoms are deep in each other Rapier's normal may be the other
            // one: its force is a pull then, for which the edges have no numbers.
            let edges = &mut rows[row..row + 2 * (c.dim - 1)];
            let share = (c.force[0] / (c.dim - 1) as f64).max(0.0);
            for (k, edge) in edges.chunks_exact_mut(2).enumerate() {
                let along = (c.force[k + 1] / c.friction[k]).clamp(-share, share);
                edge.copy_from_slice(&[0.5 * (share + along), 0.5 * (share - along)]);
            }
        } else {
            let n = c.dim.min(3);
            rows[row..row + n].copy_from_slice(&f[..n]);
        }
    }
}

/// Reads a contact with a collider that is not the model's; `own` is the geom of the model and its side of the
/// manifold.
fn read_foreign(
    model: &Model,
    manifold: &ContactManifold,
    own: usize,
    side: usize,
    stranger: Option<usize>,
    s: &mut State,
) {
    let Some(stranger) = stranger else { return };
    let body = model.geom_bodyid[own];
    let place = pose(s.xpos[body], s.xquat[body]) * geom_pose(model, own);
    for point in manifold.points.iter().filter(|p| p.data.impulse > 0.0) {
        let (local, outward, sign) = match side {
            0 => (point.local_p1, manifold.local_n1, -1.0),
            _ => (point.local_p2, manifold.local_n2, 1.0),
        };
        let (on, n) = (place * local, -(place.rotation * outward));
        let frame = from_normal([n.x, n.y, n.z]);
        let f = mat_vec(&frame, scale(force(manifold, &point.data, model.opt.timestep), sign));
        let slip = manifold.data.friction;
        s.contact.push(Contact {
            geom: [stranger, own],
            dist: point.dist,
            pos: add_scaled([on.x, on.y, on.z], row(&frame, 0), -0.5 * point.dist),
            frame,
            dim: 3,
            friction: [slip, slip, 0.0, 0.0, 0.0],
            solref: model.geom_solref[own],
            solreffriction: [0.0; 2],
            solimp: model.geom_solimp[own],
            includemargin: 0.0,
            // it has no row, but it is a constraint
            efc_address: Some(s.efc.nefc()),
            force: [f[0], f[1], f[2], 0.0, 0.0, 0.0],
        });
    }
}
