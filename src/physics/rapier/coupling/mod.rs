//! A model in a Rapier world of your own, solved by our engine, with contacts that push both ways.
//!
//! [`CoupledSimulation`] is the short way, and its example shows all of it. [`Coupling`] is the part without an engine, for programs that
//! step models themselves.
//!
//! # A step
//!
//! 1. Bodies of the world near the model become bodies of the model: their mass, inertia, shapes, pose, velocity, and the forces that the
//!    program applies to them.
//! 2. Our engine steps the model, with their contacts with it and with each other.
//! 3. Each body gets the impulse of its contacts with the model, equal and opposite to what the model felt. Contacts between bodies of the
//!    world are Rapier's: in the model they only say what the model pushes against.
//! 4. The model's colliders in the world follow it. Then the program steps its world.
//!
//! # Shapes
//!
//! | in the world | in the model |
//! |---|---|
//! | ball, cuboid, capsule, cylinder, fixed half space | the same |
//! | convex hull, convex polyhedron | its hull, in single precision |
//! | cone | the hull of 24 corners and the apex |
//! | compound, several colliders of a body | a geom for each |
//! | rounded cuboid and cylinder | the shape around the rounding |
//! | fixed triangle mesh, triangle | for each triangle near the model the prism 5 cm below it; outside is where corners are counterclockwise |
//! | triangle mesh of a body that moves | its convex hull |
//! | fixed height field | a height field, in single precision |
//! | voxels, other rounded shapes, polylines, shapes of your own | an error, if near |
//!
//! # Bodies
//!
//! - Dynamic bodies have their mass, moments, damping, gravity scale and forces. Partly locked axes, joints, restitution, contact skin and
//!   dominance act in Rapier, so that the model feels them a step later: what it pushes first moves freely, and a joint then pulls it back.
//! - Kinematic bodies, links of multibodies and bodies without mass push with
//!   [`CouplingOptions::kinematic_mass`] and are not pushed.
//! - Sleeping bodies wake when the model touches them.
//! - The model has no continuous collision detection: what covers more than its own size and the limb's in a step may pass through. Rapier's
//!   does not see the model. Shorten the time step for fast bodies.
//! - Colliders and bodies may change, come and go between steps.
//!
//! # The model in the world
//!
//! Each moving body of the model with geoms is a kinematic body, with a collider for each geom. Ray casts, shape casts, overlap tests and
//! contact events find them; `user_data` is the id of the body and of the geom. They push nothing, because their solver groups are empty.
//! Two coupled models in a world do not touch each other.
//!
//! # Same bits
//!
//! From the same world, state and controls our part of a step has the same bits on every processor. Rapier's own steps do with its feature
//! `enhanced-determinism`.

mod coupled;
mod edit;
mod error;
mod exchange;
mod impulse;
mod neighbors;
mod options;
mod proxies;
mod shapes;
mod slots;
mod snapshot;
#[cfg(test)]
mod tests;

use mjcf_sim_model::Model;
use mjcf_sim_physics::{EngineError, Params, State, Topology, kinematics};
use rapier3d_f64::dynamics::{
    ImpulseJointSet, IslandManager, MultibodyJointSet, RigidBodyHandle, RigidBodySet, SoftBodySet,
};
use rapier3d_f64::geometry::{ColliderHandle, ColliderSet};
use rapier3d_f64::parry::bounding_volume::Aabb;
use rapier3d_f64::parry::math::{Pose, Vector};
use rapier3d_f64::pipeline::PhysicsWorld;

pub use coupled::CoupledSimulation;
pub use error::CouplingError;
pub use options::{CouplingOptions, Material, MaterialMap};
pub use snapshot::CouplingSnapshot;

use edit::Original;
use exchange::vector;
use impulse::Impulse;
use neighbors::{Neighbors, Source};
use proxies::Proxies;
use slots::Slots;

/// Borrows the parts of a Rapier world that a coupling reads and changes.
pub struct WorldSets<'a> {
    /// Bodies.
    pub bodies: &'a mut RigidBodySet,
    /// Colliders.
    pub colliders: &'a mut ColliderSet,
    /// Islands.
    pub islands: &'a mut IslandManager,
    /// Impulse joints.
    pub impulse_joints: &'a mut ImpulseJointSet,
    /// Multibody joints.
    pub multibody_joints: &'a mut MultibodyJointSet,
    /// Soft bodies.
    pub soft_bodies: &'a mut SoftBodySet,
    /// Gravity, m/s^2.
    pub gravity: Vector,
    /// Time by which the next step of the world advances, s.
    pub dt: f64,
    /// Substeps of Rapier's solver in a step of the world: `IntegrationParameters::num_solver_iterations`.
    pub substeps: usize,
}

impl std::fmt::Debug for WorldSets<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WorldSets")
            .field("bodies", &self.bodies.len())
            .field("colliders", &self.colliders.len())
            .field("gravity", &self.gravity)
            .field("dt", &self.dt)
            .finish_non_exhaustive()
    }
}

impl<'a> From<&'a mut PhysicsWorld> for WorldSets<'a> {
    fn from(world: &'a mut PhysicsWorld) -> Self {
        Self {
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            islands: &mut world.islands,
            impulse_joints: &mut world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
            soft_bodies: &mut world.soft_bodies,
            gravity: world.gravity,
            dt: world.integration_parameters.dt,
            substeps: world.integration_parameters.num_solver_iterations,
        }
    }
}

/// Couples a model with a Rapier world.
///
/// A program that steps the model itself calls, for each step of the world: [`Coupling::update`], and if it returns a model, continues
/// with an engine for that; [`Coupling::load`]; for each step of the model the engine and [`Coupling::record`]; and
/// [`Coupling::unload`]. A copy continues as the original does, in a copy of the world.
#[derive(Clone)]
pub struct Coupling {
    options: CouplingOptions,
    slots: Slots,
    original: Original,
    /// The frame of the model in the world.
    frame: Pose,
    neighbors: Neighbors,
    excluded: Vec<[usize; 2]>,
    /// Scratch: the next list of excluded pairs.
    next_excluded: Vec<[usize; 2]>,
    impulses: Vec<Impulse>,
    proxies: Proxies,
    touching: Vec<usize>,
    /// Poses of the model after the last step.
    posed: State,
    /// Whether the model contains the neighbors.
    written: bool,
}

impl std::fmt::Debug for Coupling {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Coupling")
            .field("options", &self.options)
            .field("neighbors", &self.neighbors.all.len())
            .finish_non_exhaustive()
    }
}

impl Coupling {
    /// Inserts a model into a world. `frame` is the frame of the model in the world; in worlds whose y points up it turns z into y.
    ///
    /// # Errors
    /// A model without [`CouplingOptions::slots`], options or a frame out of range, a state of another model; nothing is inserted then.
    pub fn join(
        model: &Model,
        topology: &Topology,
        state: &State,
        sets: &mut WorldSets<'_>,
        frame: Pose,
        options: CouplingOptions,
    ) -> Result<Self, CouplingError> {
        for (what, value) in [("near", options.near), ("kinematic_mass", options.kinematic_mass)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(CouplingError::Option { what, value });
            }
        }
        if !frame.is_finite() {
            return Err(CouplingError::NotFinite { what: "the frame" });
        }
        let slots = Slots::new(model, &options)?;
        let mut posed = State::new(model, topology);
        place(model, state, &mut posed)?;
        let fixed = edit::fixed_geoms(model, &slots);
        let touching = edit::touching_geoms(model, &slots);
        let proxies = Proxies::insert(model, &posed, &slots, sets, (&options, frame));
        let own = fixed.iter().filter_map(|&g| proxies.colliders[g]).collect();
        Ok(Self {
            impulses: vec![Impulse::default(); slots.free],
            original: Original::new(model, &fixed),
            neighbors: Neighbors::new(own),
            excluded: Vec::new(),
            next_excluded: Vec::new(),
            frame,
            proxies,
            touching,
            posed,
            slots,
            options,
            written: false,
        })
    }

    /// Returns the number of model steps per step of the world.
    ///
    /// # Errors
    /// The time step of the world is not a multiple of the model's.
    pub fn steps(model: &Model, dt: f64) -> Result<u32, CouplingError> {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(CouplingError::TimeStep { dt });
        }
        let timestep = model.opt.timestep;
        let steps = (dt / timestep).round().clamp(1.0, 1e6);
        if (steps * timestep - dt).abs() > 1e-9 * dt {
            let steps = steps as u32;
            return Err(CouplingError::Steps { dt, timestep, steps });
        }
        Ok(steps as u32)
    }

    /// Finds the neighbors of the model. If its slots have to change, returns the model with the new slots: the program continues with an
    /// engine for it and with [`Coupling::adopt`]. The sizes of the model, its ids and its names stay.
    ///
    /// # Errors
    /// More neighbors than slots, shapes that the model cannot have, a state of another model.
    pub fn update(
        &mut self,
        model: &Model,
        state: &State,
        sets: &mut WorldSets<'_>,
    ) -> Result<Option<Model>, CouplingError> {
        self.finish(sets);
        if !sets.gravity.is_finite() {
            return Err(CouplingError::NotFinite { what: "gravity" });
        }
        if self.posed.qpos != state.qpos || self.posed.mocap_pos != state.mocap_pos {
            place(model, state, &mut self.posed)?;
        }
        let Some(bounds) = self.bounds() else {
            return Ok(None);
        };
        let context = (&self.slots, model.opt.flags.multiccd);
        let changed = self.neighbors.update(sets, bounds, &self.options, context)?;
        let neighbors = &self.neighbors.all;
        edit::find_excluded(&self.slots, neighbors, sets.impulse_joints, &mut self.next_excluded);
        if !changed && self.next_excluded == self.excluded && self.written {
            return Ok(None);
        }
        std::mem::swap(&mut self.excluded, &mut self.next_excluded);
        self.written = true;
        Ok(Some(model.edited(|arrays| {
            edit::write_model(arrays, &self.slots, &self.original, neighbors, &self.excluded);
            if !self.options.scenery {
                self.original.drop_scenery(arrays);
            }
        })))
    }

    /// Writes the slots' numbers from a model that [`Coupling::update`] returned into parameters.
    pub fn adopt(&self, model: &Model, params: &mut Params) {
        edit::write_params(params, model, &self.slots);
    }

    /// Writes the neighbors and the world's gravity into a state, before the steps of the model.
    pub fn load(&mut self, state: &mut State, sets: &WorldSets<'_>) {
        self.impulses.fill(Impulse::default());
        exchange::load(state, &self.slots, &self.neighbors.all, sets, self.frame);
    }

    /// Records the effect of the contacts of a model step on the neighbors. The state must be as the engine left it.
    pub fn record(&mut self, model: &Model, state: &State) {
        let h = model.opt.timestep;
        exchange::record(state, model, &self.slots, h, &mut self.impulses);
    }

    /// Applies the impulses since [`Coupling::load`] to the bodies of the world. The model's colliders follow in the next step of the world.
    ///
    /// A part of each impulse acts after that step: [`Coupling::finish`] gives it, or else the next [`Coupling::update`]. With
    /// all of it before, a body at rest on the model would have a speed of 3/8 of what gravity adds in a step, with Rapier's default of four
    /// substeps.
    ///
    /// # Errors
    /// A state of another model.
    pub fn unload(&mut self, model: &Model, state: &State, sets: &mut WorldSets<'_>) -> Result<(), CouplingError> {
        exchange::unload(&self.impulses, &mut self.neighbors.all, sets, self.frame);
        place(model, state, &mut self.posed)?;
        self.proxies.follow(model, &self.posed, sets, self.frame);
        Ok(())
    }

    /// Applies the rest of the impulses to the bodies of the world after its step, for programs that read their velocities there.
    pub fn finish(&mut self, sets: &mut WorldSets<'_>) {
        exchange::finish(&mut self.neighbors.all, sets, self.frame);
    }

    /// Forgets the neighbors, before a reset, and returns the model without them and with its own fixed geoms. The next
    /// [`Coupling::update`] returns another.
    pub fn clear(&mut self, model: &Model, sets: &mut WorldSets<'_>) -> Model {
        self.finish(sets);
        self.neighbors.all.clear();
        self.excluded.clear();
        self.written = false;
        model.edited(|arrays| {
            edit::write_model(arrays, &self.slots, &self.original, &[], &[]);
            self.original.restore_scenery(arrays);
        })
    }

    /// Moves the model's colliders to the poses of a state at once, after a reset.
    ///
    /// # Errors
    /// A state of another model.
    pub fn place(&mut self, model: &Model, state: &State, sets: &mut WorldSets<'_>) -> Result<(), CouplingError> {
        place(model, state, &mut self.posed)?;
        self.proxies.place(model, &self.posed, sets, self.frame);
        Ok(())
    }

    /// Removes the model's bodies and colliders from the world.
    pub fn leave(mut self, sets: &mut WorldSets<'_>) {
        self.finish(sets);
        self.proxies.remove(sets);
    }

    /// Returns the frame of the model in the world.
    pub fn frame(&self) -> Pose {
        self.frame
    }

    /// Returns the options.
    pub fn options(&self) -> &CouplingOptions {
        &self.options
    }

    /// Iterates over the bodies of the world that are neighbors, except fixed ones.
    pub fn neighbors(&self) -> impl Iterator<Item = RigidBodyHandle> + '_ {
        self.neighbors.all.iter().filter_map(|n| match n.source {
            Source::Body(handle) => Some(handle),
            Source::Fixed(_) => None,
        })
    }

    /// Iterates over the fixed colliders that are neighbors.
    pub fn fixed_neighbors(&self) -> impl Iterator<Item = ColliderHandle> + '_ {
        self.neighbors.all.iter().filter_map(|n| match n.source {
            Source::Body(_) => None,
            Source::Fixed(handle) => Some(handle),
        })
    }

    /// Returns the impulse, N s, and the angular impulse about the centre of mass, N m s, that the model gave to a body in the last step,
    /// world frame.
    pub fn impulse_on(&self, body: RigidBodyHandle) -> [Vector; 2] {
        let found = self.neighbors.all.iter().find(|n| n.source == Source::Body(body));
        let impulse = found
            .and_then(|n| self.impulses.get(*n.slots.first()?))
            .copied()
            .unwrap_or_default();
        [impulse.linear, impulse.angular].map(|v| self.frame.rotation * vector(v))
    }

    /// Returns the geom of the model that corresponds to a collider of the world.
    pub fn geom_of(&self, collider: ColliderHandle) -> Option<usize> {
        self.proxies.geom_of(collider)
    }

    /// Returns the collider of a geom: the model's own collider, or the neighbor's that the geom stands for.
    pub fn collider_of(&self, geom: usize) -> Option<ColliderHandle> {
        if let Some(own) = self.proxies.colliders.get(geom).copied().flatten() {
            return Some(own);
        }
        let slot = self.slots.all.iter().position(|slot| slot.geoms.contains(&geom))?;
        let neighbor = self.neighbors.all.iter().find(|n| n.slots.contains(&slot))?;
        neighbor.collider(slot, geom - self.slots.all[slot].geoms.start)
    }

    /// Returns the bodies of the world that follow the model, with the model's bodies.
    pub fn bodies(&self) -> &[(RigidBodyHandle, usize)] {
        self.proxies.bodies()
    }

    /// Returns the box around all geoms of the model that can touch, in the world; `None` if there are none.
    fn bounds(&self) -> Option<Aabb> {
        let (posed, low, high) = (&self.posed, f64::INFINITY, f64::NEG_INFINITY);
        if self.touching.is_empty() {
            return None;
        }
        let (mut mins, mut maxs) = (Vector::splat(low), Vector::splat(high));
        for &g in &self.touching {
            let (center, radius) = (vector(posed.geom_xpos[g]), Vector::splat(posed.params.geom_rbound[g]));
            (mins, maxs) = (mins.min(center - radius), maxs.max(center + radius));
        }
        Some(Aabb::new(mins, maxs).transform_by(&self.frame))
    }
}

/// Computes the poses of a state in another state.
fn place(model: &Model, state: &State, posed: &mut State) -> Result<(), EngineError> {
    let lengths = [
        ("qpos", state.qpos.len(), model.nq),
        ("mocap_pos", state.mocap_pos.len(), model.nmocap),
        ("mocap_quat", state.mocap_quat.len(), model.nmocap),
    ];
    if let Some((what, found, expected)) = lengths.into_iter().find(|(_, found, expected)| found != expected) {
        return Err(EngineError::Shape { what, found, expected });
    }
    posed.qpos.clone_from(&state.qpos);
    posed.mocap_pos.clone_from(&state.mocap_pos);
    posed.mocap_quat.clone_from(&state.mocap_quat);
    posed.params.clone_from(&state.params);
    kinematics(model, posed);
    Ok(())
}
