//! The model in Rapier's sets: one rigid body per body, one collider per geom.

use parry3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::dynamics::{IslandManager, RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d_f64::geometry::{
    ActiveCollisionTypes, BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet, NarrowPhase, SharedShape,
    SolverFlags,
};
use rapier3d_f64::pipeline::{
    ActiveHooks, CollisionPipeline, PairFilterContext, PhysicsHooks, QueryFilter, QueryPipeline,
};

use crate::math::{Quat, Vec3};
use crate::model::{GeomType, Model};
use crate::physics::contact::ContactOptions;
use crate::physics::state::State;
use crate::physics::world::{ContactDispatcher, PairTable};

/// A filter that lets Rapier test exactly the pairs of the table.
struct PairFilter {
    ncollider: usize,
    allowed: Vec<bool>,
}

impl PhysicsHooks for PairFilter {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let index = |h: ColliderHandle| h.into_raw_parts().0 as usize;
        let (a, b) = (index(context.collider1), index(context.collider2));
        let allowed = a < self.ncollider && b < self.ncollider && self.allowed[a * self.ncollider + b];
        allowed.then(SolverFlags::empty)
    }
}

/// A contact as Rapier's collision pipeline reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneContact {
    /// The geoms, the lower type first.
    pub geom: [usize; 2],
    /// Distance between the surfaces, m.
    pub dist: f64,
    /// Midpoint between the surfaces, world, m.
    pub pos: Vec3,
    /// Unit normal from the first to the second geom, world.
    pub normal: Vec3,
}

/// The model as a live Rapier scene. Poses are those of the last [`RapierScene::sync`], which the engine does each
/// step.
///
/// Bodies are kinematic (fixed where nothing moves them); `user_data` of a body and a collider is the id of the body and
/// geom. Do not run a `PhysicsPipeline` on these sets: the engine owns the poses.
pub struct RapierScene {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    pipeline: CollisionPipeline,
    filter: PairFilter,
    body_handle: Vec<RigidBodyHandle>,
    collider_handle: Vec<ColliderHandle>,
    moving: Vec<usize>,
    dirty: bool,
}

pub(crate) fn pose(pos: Vec3, q: Quat) -> Pose {
    Pose::from_parts(
        Vector::new(pos[0], pos[1], pos[2]),
        Rotation::from_xyzw(q[1], q[2], q[3], q[0]),
    )
}

pub(crate) fn shape(kind: GeomType, s: Vec3) -> SharedShape {
    let along_z = Vector::new(0.0, 0.0, s[1]);
    match kind {
        GeomType::Plane => SharedShape::halfspace(Vector::Z),
        GeomType::Sphere => SharedShape::ball(s[0]),
        GeomType::Capsule => SharedShape::capsule(-along_z, along_z, s[0]),
        // Parry has no ellipsoid; ours collide with nothing, and a ball serves queries
        GeomType::Ellipsoid => SharedShape::ball(s[0].max(s[1]).max(s[2])),
        GeomType::Cylinder => SharedShape::cylinder(s[1], s[0]),
        GeomType::Box => SharedShape::cuboid(s[0], s[1], s[2]),
    }
}

/// Returns the pose of a geom's collider in its body.
pub(crate) fn geom_pose(model: &Model, geom: usize) -> Pose {
    let mut local = pose(model.geom_pos[geom], model.geom_quat[geom]);
    if model.geom_type[geom] == GeomType::Cylinder {
        // Parry's cylinders stand along y
        let half = 0.5_f64.sqrt();
        local.rotation *= Rotation::from_xyzw(half, 0.0, 0.0, half);
    }
    local
}

/// Returns the geoms in the order in which their colliders are made: by type, so that Rapier hands pairs over with the
/// lower type first.
pub(crate) fn collider_order(model: &Model) -> Vec<usize> {
    let mut order: Vec<usize> = (0..model.ngeom()).collect();
    order.sort_by_key(|&g| (model.geom_type[g], g));
    order
}

impl std::fmt::Debug for RapierScene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RapierScene")
            .field("bodies", &self.bodies.len())
            .field("colliders", &self.colliders.len())
            .finish_non_exhaustive()
    }
}

impl RapierScene {
    /// Builds the scene at the origin; [`RapierScene::sync`] gives it its poses.
    pub fn new(model: &Model, pairs: &PairTable, options: ContactOptions) -> Self {
        let mut bodies = RigidBodySet::new();
        let mut colliders = ColliderSet::new();
        let body_handle: Vec<RigidBodyHandle> = (0..model.nbody())
            .map(|b| {
                let fixed = model.body_weldid[b] == 0;
                let builder = if fixed {
                    RigidBodyBuilder::fixed()
                } else {
                    RigidBodyBuilder::kinematic_position_based()
                };
                bodies.insert(builder.user_data(b as u128))
            })
            .collect();
        let order = collider_order(model);
        let mut collider_handle = vec![ColliderHandle::invalid(); order.len()];
        for &g in &order {
            let local = geom_pose(model, g);
            let types = ActiveCollisionTypes::KINEMATIC_KINEMATIC | ActiveCollisionTypes::KINEMATIC_FIXED;
            let collider = ColliderBuilder::new(shape(model.geom_type[g], model.geom_size[g]))
                .position(local)
                .density(0.0)
                .user_data(g as u128)
                .active_collision_types(types)
                .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
            collider_handle[g] = colliders.insert_with_parent(collider, body_handle[model.geom_bodyid[g]], &mut bodies);
        }
        let n = order.len();
        let mut allowed = vec![false; n * n];
        for p in pairs.pairs() {
            let [a, b] = p.geom.map(|g| collider_handle[g].into_raw_parts().0 as usize);
            allowed[a * n + b] = true;
            allowed[b * n + a] = true;
        }
        Self {
            bodies,
            colliders,
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::with_query_dispatcher(ContactDispatcher::new(options)),
            pipeline: CollisionPipeline::new(),
            filter: PairFilter { ncollider: n, allowed },
            body_handle,
            collider_handle,
            moving: (1..model.nbody()).filter(|&b| model.body_weldid[b] != 0).collect(),
            dirty: false,
        }
        .with_fixed_poses(model)
    }

    /// Gives fixed bodies their poses, once: chains of constant transforms from the world.
    fn with_fixed_poses(mut self, model: &Model) -> Self {
        let mut world = vec![Pose::IDENTITY; model.nbody()];
        for b in 1..model.nbody() {
            world[b] = world[model.body_parentid[b]] * pose(model.body_pos[b], model.body_quat[b]);
            if let Some(body) = self.bodies.get_mut(self.body_handle[b]) {
                body.set_position(world[b], false);
            }
        }
        // the first pipeline step clears the flags of creation
        self.dirty = true;
        self.update_queries();
        self
    }

    /// Writes the body poses of `s` to the moving bodies and their colliders.
    pub fn sync(&mut self, s: &State) {
        for &b in &self.moving {
            if let Some(body) = self.bodies.get_mut(self.body_handle[b]) {
                body.set_position(pose(s.xpos[b], s.xquat[b]), false);
            }
        }
        self.bodies
            .propagate_modified_body_positions_to_colliders(&mut self.colliders);
        self.dirty = true;
    }

    /// Brings Rapier's broad and narrow phase up to date with the poses; nothing is done when they are.
    pub fn update_queries(&mut self) {
        if std::mem::take(&mut self.dirty) {
            self.pipeline.step(
                0.0,
                &mut self.islands,
                &mut self.broad_phase,
                &mut self.narrow_phase,
                &mut self.bodies,
                &mut self.colliders,
                &self.filter,
                &(),
            );
        }
    }

    /// Returns a pipeline for ray casts, shape casts and overlap tests on the scene.
    pub fn queries<'a>(&'a mut self, filter: QueryFilter<'a>) -> QueryPipeline<'a> {
        self.update_queries();
        self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            &self.bodies,
            &self.colliders,
            filter,
        )
    }

    /// Lists the contacts that Rapier's collision pipeline finds, by geom pair.
    pub fn pipeline_contacts(&mut self) -> Vec<SceneContact> {
        self.update_queries();
        let mut out = Vec::new();
        for pair in self.narrow_phase.contact_pairs() {
            let (Some(c1), Some(c2)) = (self.colliders.get(pair.collider1), self.colliders.get(pair.collider2)) else {
                continue;
            };
            for m in pair.manifolds() {
                let normal = c1.position().rotation * m.local_n1;
                for p in &m.points {
                    let pos = c1.position().transform_point(p.local_p1) + normal * (0.5 * p.dist);
                    out.push(SceneContact {
                        geom: [c1.user_data as usize, c2.user_data as usize],
                        dist: p.dist,
                        pos: [pos.x, pos.y, pos.z],
                        normal: [normal.x, normal.y, normal.z],
                    });
                }
            }
        }
        out.sort_by_key(|c| c.geom);
        out
    }

    /// Returns Rapier's bodies.
    pub fn bodies(&self) -> &RigidBodySet {
        &self.bodies
    }

    /// Returns Rapier's colliders.
    pub fn colliders(&self) -> &ColliderSet {
        &self.colliders
    }

    /// Returns the handle of a body, by its id.
    pub fn body_handle(&self, body: usize) -> Option<RigidBodyHandle> {
        self.body_handle.get(body).copied()
    }

    /// Returns the handle of a geom's collider, by the geom's id.
    pub fn collider_handle(&self, geom: usize) -> Option<ColliderHandle> {
        self.collider_handle.get(geom).copied()
    }
}
