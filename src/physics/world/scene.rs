//! The model in Rapier's sets: one rigid body per body, one collider per geom.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use parry3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::dynamics::{IslandManager, RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d_f64::geometry::{
    ActiveCollisionTypes, BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet, NarrowPhase, SharedShape,
    SolverFlags,
};
use rapier3d_f64::pipeline::{ActiveHooks, CollisionPipeline, PairFilterContext, PhysicsHooks};
#[cfg(feature = "rapier")]
use rapier3d_f64::pipeline::{QueryFilter, QueryPipeline};

use crate::math::{Quat, Vec3};
use crate::model::{GeomType, Model};
use crate::physics::contact::ContactOptions;
use crate::physics::state::State;
use crate::physics::world::{ContactDispatcher, PairTable};

/// Scenes of up to this many geoms go through Rapier's collision pipeline when they are made.
const EAGER: usize = 256;

/// A filter that lets Rapier test exactly the pairs of the table.
struct PairFilter {
    pairs: Arc<PairTable>,
    /// Geom of each collider, by its index.
    geom: Vec<usize>,
}

impl PhysicsHooks for PairFilter {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let geom = |h: ColliderHandle| self.geom.get(h.into_raw_parts().0 as usize);
        let (a, b) = (*geom(context.collider1)?, *geom(context.collider2)?);
        self.pairs.may_touch(a, b).then(SolverFlags::empty)
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

/// Rapier's bodies and colliders.
#[derive(Default)]
struct Sets {
    bodies: RigidBodySet,
    colliders: ColliderSet,
}

/// The model as a live Rapier scene. Poses are those of the last [`RapierScene::sync`], which the engine does each
/// step; they reach Rapier when someone looks.
///
/// Bodies are kinematic (fixed where nothing moves them); `user_data` of a body and a collider is the id of the body and
/// geom. Do not run a `PhysicsPipeline` on these sets: the engine owns the poses.
pub struct RapierScene {
    /// The sets, with the poses of the last `sync`; not here while nobody has looked since then.
    live: OnceLock<Sets>,
    /// The sets, with older poses, while they are not in `live`.
    stale: Mutex<Sets>,
    /// Pose of each moving body at the last `sync`.
    poses: Vec<(Vec3, Quat)>,
    /// Size of each geom at the last `sync`.
    sizes: Vec<Vec3>,
    /// Geoms whose colliders have another size, with their type.
    resized: Vec<(usize, GeomType)>,
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
            .field("bodies", &self.bodies().len())
            .field("colliders", &self.colliders().len())
            .finish_non_exhaustive()
    }
}

impl RapierScene {
    /// Builds the scene at the origin; [`RapierScene::sync`] gives it its poses.
    pub fn new(model: &Model, pairs: &Arc<PairTable>, options: ContactOptions) -> Self {
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
        let moving: Vec<usize> = (1..model.nbody()).filter(|&b| model.body_weldid[b] != 0).collect();
        for b in 1..model.nbody() {
            // fixed bodies get their poses here, once
            let parent = bodies.get(body_handle[model.body_parentid[b]]).map(|p| *p.position());
            if let (Some(parent), Some(body)) = (parent, bodies.get_mut(body_handle[b])) {
                body.set_position(parent * pose(model.body_pos[b], model.body_quat[b]), false);
            }
        }
        let mut scene = Self {
            live: OnceLock::from(Sets { bodies, colliders }),
            stale: Mutex::default(),
            poses: Vec::with_capacity(moving.len()),
            sizes: model.geom_size.clone(),
            resized: Vec::new(),
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::with_query_dispatcher(ContactDispatcher::new(options)),
            pipeline: CollisionPipeline::new(),
            filter: PairFilter {
                pairs: pairs.clone(),
                geom: order,
            },
            body_handle,
            collider_handle,
            moving,
            dirty: true,
        };
        // the first pipeline step clears the flags of creation, which saves work whenever somebody asks; where many geoms
        // may stand in one place, it waits until then
        if scene.colliders().len() <= EAGER {
            scene.update_queries();
        }
        scene
    }

    /// Takes the body poses of `s`, and the sizes of its geoms.
    pub fn sync(&mut self, model: &Model, s: &State) {
        if self.sizes != s.params.geom_size {
            for (g, (old, &new)) in self.sizes.iter_mut().zip(&s.params.geom_size).enumerate() {
                let entry = (g, model.geom_type[g]);
                if *old != new && !self.resized.contains(&entry) {
                    self.resized.push(entry);
                }
                *old = new;
            }
        }
        self.poses.clear();
        self.poses.extend(self.moving.iter().map(|&b| (s.xpos[b], s.xquat[b])));
        if let Some(sets) = self.live.take() {
            *self.stale.get_mut().unwrap_or_else(PoisonError::into_inner) = sets;
        }
        self.dirty = true;
    }

    /// Returns Rapier's sets with the poses of the last `sync`.
    fn sets(&self) -> &Sets {
        self.live.get_or_init(|| {
            let mut sets = std::mem::take(&mut *self.stale.lock().unwrap_or_else(PoisonError::into_inner));
            for (&b, &(pos, quat)) in self.moving.iter().zip(&self.poses) {
                if let Some(body) = sets.bodies.get_mut(self.body_handle[b]) {
                    body.set_position(pose(pos, quat), false);
                }
            }
            for &(g, kind) in &self.resized {
                if let Some(collider) = sets.colliders.get_mut(self.collider_handle[g]) {
                    collider.set_shape(shape(kind, self.sizes[g]));
                }
            }
            sets.bodies
                .propagate_modified_body_positions_to_colliders(&mut sets.colliders);
            sets
        })
    }

    /// Brings Rapier's broad and narrow phase up to date with the poses; nothing is done when they are.
    pub fn update_queries(&mut self) {
        self.sets();
        if let Some(sets) = self.live.get_mut()
            && std::mem::take(&mut self.dirty)
        {
            self.pipeline.step(
                0.0,
                &mut self.islands,
                &mut self.broad_phase,
                &mut self.narrow_phase,
                &mut sets.bodies,
                &mut sets.colliders,
                &self.filter,
                &(),
            );
        }
    }

    /// Returns a pipeline for ray casts, shape casts and overlap tests on the scene.
    #[cfg(feature = "rapier")]
    pub fn queries<'a>(&'a mut self, filter: QueryFilter<'a>) -> QueryPipeline<'a> {
        self.update_queries();
        let sets = self.sets();
        self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            &sets.bodies,
            &sets.colliders,
            filter,
        )
    }

    /// Lists the contacts that Rapier's collision pipeline finds, by geom pair.
    pub fn pipeline_contacts(&mut self) -> Vec<SceneContact> {
        self.update_queries();
        let mut out = Vec::new();
        let colliders = self.colliders();
        for pair in self.narrow_phase.contact_pairs() {
            let (Some(c1), Some(c2)) = (colliders.get(pair.collider1), colliders.get(pair.collider2)) else {
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
        &self.sets().bodies
    }

    /// Returns Rapier's colliders.
    pub fn colliders(&self) -> &ColliderSet {
        &self.sets().colliders
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
