//! The model's proxies in the world: kinematic bodies that queries find and that push nothing.

use mjcf_sim_model::Model;
use mjcf_sim_model::math::Vec3;
use mjcf_sim_physics::State;
use rapier3d_f64::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d_f64::geometry::{ColliderBuilder, ColliderHandle, InteractionGroups};
use rapier3d_f64::parry::math::Pose;

use super::slots::Slots;
use super::{CouplingOptions, WorldSets};
use crate::scene::{geom_pose, pose, shape};

/// The bodies and colliders of a model in a world.
#[derive(Clone, Debug)]
pub(super) struct Proxies {
    /// Kinematic bodies, with the bodies of the model that they follow.
    bodies: Vec<(RigidBodyHandle, usize)>,
    /// The collider of each geom (ngeom); `None` for slots, and for fixed geoms that are not added to the world.
    pub colliders: Vec<Option<ColliderHandle>>,
    /// Size of each geom in the world.
    sizes: Vec<Vec3>,
}

impl Proxies {
    /// Inserts the bodies and colliders at the poses of a state.
    pub fn insert(
        model: &Model,
        s: &State,
        slots: &Slots,
        sets: &mut WorldSets<'_>,
        (options, frame): (&CouplingOptions, Pose),
    ) -> Self {
        let mut proxies = Self {
            bodies: Vec::new(),
            colliders: vec![None; model.ngeom()],
            sizes: s.params.geom_size.clone(),
        };
        for b in (0..model.nbody()).filter(|&b| slots.of_body[b].is_none()) {
            let moves = model.moves(b);
            let geoms = model.body_geomadr[b]..model.body_geomadr[b] + model.body_geomnum[b];
            if geoms.is_empty() || !(moves || options.scenery) {
                continue;
            }
            let builder = if moves {
                RigidBodyBuilder::kinematic_position_based()
            } else {
                RigidBodyBuilder::fixed()
            };
            let place = frame * pose(s.xpos[b], s.xquat[b]);
            let handle = sets.bodies.insert(builder.pose(place).user_data(b as u128));
            proxies.bodies.push((handle, b));
            for g in geoms {
                // without solver groups the pair has contacts, for events, and no forces
                let groups = if moves {
                    InteractionGroups::none()
                } else {
                    InteractionGroups::all()
                };
                let collider = ColliderBuilder::new(shape(model, g, s.params.geom_size[g]))
                    .position(geom_pose(model, g))
                    .density(0.0)
                    .friction(model.geom_friction[g][0])
                    .collision_groups(options.groups)
                    .solver_groups(groups)
                    .user_data(g as u128);
                let handle = sets.colliders.insert_with_parent(collider, handle, sets.bodies);
                proxies.colliders[g] = Some(handle);
            }
        }
        proxies
    }

    /// Makes the bodies follow a state in the next step of the world.
    pub fn follow(&mut self, model: &Model, s: &State, sets: &mut WorldSets<'_>, frame: Pose) {
        for (g, &size) in s.params.geom_size.iter().enumerate() {
            if self.sizes[g] != size {
                self.sizes[g] = size;
                if let Some(collider) = self.colliders[g].and_then(|handle| sets.colliders.get_mut(handle)) {
                    collider.set_shape(shape(model, g, size));
                }
            }
        }
        for &(handle, b) in &self.bodies {
            if model.moves(b)
                && let Some(body) = sets.bodies.get_mut(handle)
            {
                body.set_next_kinematic_position(frame * pose(s.xpos[b], s.xquat[b]));
            }
        }
    }

    /// Moves the bodies to the poses of a state at once.
    pub fn place(&self, model: &Model, s: &State, sets: &mut WorldSets<'_>, frame: Pose) {
        for &(handle, b) in &self.bodies {
            if model.moves(b)
                && let Some(body) = sets.bodies.get_mut(handle)
            {
                body.set_position(frame * pose(s.xpos[b], s.xquat[b]), false);
            }
        }
    }

    /// Removes the bodies and their colliders.
    pub fn remove(&mut self, sets: &mut WorldSets<'_>) {
        for (handle, _) in self.bodies.drain(..) {
            sets.bodies.remove(
                handle,
                sets.islands,
                sets.colliders,
                sets.impulse_joints,
                sets.multibody_joints,
                sets.soft_bodies,
                true,
            );
        }
        self.colliders.fill(None);
    }

    /// Returns the geom of a collider.
    pub fn geom_of(&self, collider: ColliderHandle) -> Option<usize> {
        self.colliders.iter().position(|&c| c == Some(collider))
    }

    /// Returns the bodies with those that they follow.
    pub fn bodies(&self) -> &[(RigidBodyHandle, usize)] {
        &self.bodies
    }
}
