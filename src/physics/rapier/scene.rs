//! A mirror of the model in Rapier: one rigid body per body, one collider per geom.

use std::sync::Arc;

use rapier3d_f64::dynamics::{IslandManager, RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d_f64::geometry::{
    ActiveCollisionTypes, BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet, NarrowPhase, SharedShape,
    SolverFlags,
};
use rapier3d_f64::parry::math::{Pose, Rotation, Vector};
use rapier3d_f64::pipeline::{
    ActiveHooks, CollisionPipeline, PairFilterContext, PhysicsHooks, QueryFilter, QueryPipeline,
};

use crate::ContactDispatcher;
use crate::hull::HullShape;
use mjcf_sim_model::math::{Quat, Vec3};
use mjcf_sim_model::model::{GeomType, Model};
use mjcf_sim_physics::EngineError;
use mjcf_sim_physics::Quirks;
use mjcf_sim_physics::collision::{ContactRules, contact_options};
use mjcf_sim_physics::state::State;

/// A filter that lets Rapier test exactly the pairs of geoms that may touch.
struct PairFilter {
    rules: ContactRules,
    /// Geom of each collider, by its index.
    geom: Vec<usize>,
}

impl PhysicsHooks for PairFilter {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let geom = |h: ColliderHandle| self.geom.get(h.into_raw_parts().0 as usize);
        let (a, b) = (*geom(context.collider1)?, *geom(context.collider2)?);
        self.rules.allow(a, b).then(SolverFlags::empty)
    }
}

/// A contact reported by Rapier's collision pipeline.
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

/// A mirror of a model in Rapier's sets, for ray casts, shape queries and debug rendering. `Blueprint::rapier_scene` of
/// babybench makes one from a state.
///
/// [`RapierScene::sync`] gives it the poses of a state; nothing flows back. Bodies are kinematic (fixed where nothing
/// moves them); `user_data` of a body and of a collider is the id of the body and of the geom. Rapier's collision pipeline
/// finds the contacts that the soft engine finds, as the same routines are behind its query dispatcher
/// ([`ContactDispatcher`]).
///
/// ```
/// use std::sync::Arc;
///
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::mjcf_loader::load_str;
/// use mjcf_sim::physics::{Engine, Quirks, SoftEngine, SoftOptions, compile};
/// use mjcf_sim::rapier::RapierScene;
/// use mjcf_sim::rapier::rapier3d_f64::prelude::{QueryFilter, Ray, Vector};
///
/// let text = "<mujoco><worldbody><geom type='plane' size='5 5 1'/></worldbody></mujoco>";
/// let model = Arc::new(compile(load_str(text, "floor.xml", &MemoryAssets::new())?)?);
/// let mut scene = RapierScene::new(model.clone(), Quirks::default());
///
/// let mut engine = SoftEngine::new(model, SoftOptions::default());
/// let mut state = engine.new_state();
/// engine.step(&mut state)?;
/// scene.sync(&state)?;
///
/// let down = Ray::new(Vector::new(3.0, 3.0, 1.0), -Vector::Z);
/// let (collider, distance) = scene.queries(QueryFilter::default()).cast_ray(&down, 10.0, true).ok_or("a hit")?;
/// let geom = scene.geom_of(collider).ok_or("a geom")?;
/// assert_eq!((engine.model().geom_bodyid[geom], distance), (0, 1.0)); // the floor is the world's
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RapierScene {
    model: Arc<Model>,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    pipeline: CollisionPipeline,
    filter: PairFilter,
    /// Size of each geom in the last state.
    sizes: Vec<Vec3>,
    body_handle: Vec<RigidBodyHandle>,
    collider_handle: Vec<ColliderHandle>,
}

pub(super) fn pose(pos: Vec3, q: Quat) -> Pose {
    Pose::from_parts(
        Vector::new(pos[0], pos[1], pos[2]),
        Rotation::from_xyzw(q[1], q[2], q[3], q[0]),
    )
}

/// Returns the shape of a geom of this size.
pub(super) fn shape(model: &Model, geom: usize, s: Vec3) -> SharedShape {
    let along_z = Vector::new(0.0, 0.0, s[1]);
    match model.geom_type[geom] {
        GeomType::Plane => SharedShape::halfspace(Vector::Z),
        GeomType::Sphere => SharedShape::ball(s[0]),
        GeomType::Capsule => SharedShape::capsule(-along_z, along_z, s[0]),
        // Parry has no ellipsoid; ours collide with nothing, and a ball serves queries
        GeomType::Ellipsoid => SharedShape::ball(s[0].max(s[1]).max(s[2])),
        GeomType::Cylinder => SharedShape::cylinder(s[1], s[0]),
        GeomType::Mesh => match model.geom_dataid[geom].and_then(|id| model.meshes.get(id)) {
            Some(mesh) => HullShape::shared(mesh, s),
            None => SharedShape::cuboid(s[0], s[1], s[2]),
        },
        // a height field that touches is refused; queries see the box around it
        GeomType::Box | GeomType::HField => SharedShape::cuboid(s[0], s[1], s[2]),
    }
}

/// Returns the pose of a geom's collider in its body.
pub(super) fn geom_pose(model: &Model, geom: usize) -> Pose {
    let mut local = pose(model.geom_pos[geom], model.geom_quat[geom]);
    if model.geom_type[geom] == GeomType::Cylinder {
        // Parry's cylinders stand along y
        let half = 0.5_f64.sqrt();
        local.rotation *= Rotation::from_xyzw(half, 0.0, 0.0, half);
    }
    local
}

/// Returns the geoms in the order in which their colliders are made: by type, so that Rapier passes pairs with the lower type first.
pub(super) fn collider_order(model: &Model) -> Vec<usize> {
    let mut order: Vec<usize> = (0..model.ngeom()).collect();
    order.sort_by_key(|&g| (model.geom_type[g], g));
    order
}

/// Inserts a body for each body of a model, at `qpos0`.
fn insert_bodies(model: &Model, bodies: &mut RigidBodySet) -> Vec<RigidBodyHandle> {
    let mut poses = vec![Pose::IDENTITY];
    for b in 1..model.nbody() {
        poses.push(poses[model.body_parentid[b]] * pose(model.body_pos[b], model.body_quat[b]));
    }
    let body = |(b, pose): (usize, Pose)| {
        let builder = if model.moves(b) {
            RigidBodyBuilder::kinematic_position_based()
        } else {
            RigidBodyBuilder::fixed()
        };
        bodies.insert(builder.pose(pose).user_data(b as u128))
    };
    poses.into_iter().enumerate().map(body).collect()
}

/// Inserts a collider for each geom of a model, in the given order.
fn insert_colliders(
    model: &Model,
    order: &[usize],
    body_handle: &[RigidBodyHandle],
    bodies: &mut RigidBodySet,
    colliders: &mut ColliderSet,
) -> Vec<ColliderHandle> {
    let types = ActiveCollisionTypes::KINEMATIC_KINEMATIC | ActiveCollisionTypes::KINEMATIC_FIXED;
    let mut handles = vec![ColliderHandle::invalid(); order.len()];
    for &g in order {
        let collider = ColliderBuilder::new(shape(model, g, model.geom_size[g]))
            .position(geom_pose(model, g))
            .density(0.0)
            .user_data(g as u128)
            .active_collision_types(types)
            .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
        handles[g] = colliders.insert_with_parent(collider, body_handle[model.geom_bodyid[g]], bodies);
    }
    handles
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
    /// Builds the mirror of `model` at `qpos0`. Its collision pipeline keeps the peculiarities of contact geometry that
    /// `quirks` names; the default is that of the engines.
    pub fn new(model: Arc<Model>, quirks: Quirks) -> Self {
        let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
        let order = collider_order(&model);
        let body_handle = insert_bodies(&model, &mut bodies);
        let collider_handle = insert_colliders(&model, &order, &body_handle, &mut bodies, &mut colliders);
        let dispatcher = ContactDispatcher::new(contact_options(&model, quirks));
        let mut scene = Self {
            bodies,
            colliders,
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher),
            pipeline: CollisionPipeline::new(),
            filter: PairFilter {
                rules: ContactRules::new(&model),
                geom: order,
            },
            sizes: model.geom_size.clone(),
            body_handle,
            collider_handle,
            model,
        };
        scene.detect();
        scene
    }

    /// Copies the body poses of a state, which belong to the start of its last step, and the sizes of its geoms, and detects collisions.
    ///
    /// # Errors
    /// A state of another model; nothing is changed then.
    pub fn sync(&mut self, state: &State) -> Result<(), EngineError> {
        let (nbody, ngeom) = (self.model.nbody(), self.model.ngeom());
        let lengths = [
            ("xpos", state.xpos.len(), nbody),
            ("xquat", state.xquat.len(), nbody),
            ("params.geom_size", state.params.geom_size.len(), ngeom),
        ];
        if let Some((what, found, expected)) = lengths.into_iter().find(|(_, found, expected)| found != expected) {
            return Err(EngineError::Shape { what, found, expected });
        }
        for (b, &handle) in self.body_handle.iter().enumerate() {
            if self.model.moves(b)
                && let Some(body) = self.bodies.get_mut(handle)
            {
                body.set_position(pose(state.xpos[b], state.xquat[b]), false);
            }
        }
        for (g, &size) in state.params.geom_size.iter().enumerate() {
            if self.sizes[g] != size
                && let Some(collider) = self.colliders.get_mut(self.collider_handle[g])
            {
                collider.set_shape(shape(&self.model, g, size));
                self.sizes[g] = size;
            }
        }
        self.detect();
        Ok(())
    }

    /// Updates Rapier's broad and narrow phase with bodies and colliders.
    fn detect(&mut self) {
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

    /// Returns a pipeline for ray casts, shape casts and overlap tests on the scene.
    pub fn queries<'a>(&'a self, filter: QueryFilter<'a>) -> QueryPipeline<'a> {
        let dispatcher = self.narrow_phase.query_dispatcher();
        self.broad_phase
            .as_query_pipeline(dispatcher, &self.bodies, &self.colliders, filter)
    }

    /// Lists the contacts that Rapier's collision pipeline finds, by geom pair.
    pub fn contacts(&self) -> Vec<SceneContact> {
        let mut out = Vec::new();
        for pair in self.narrow_phase.contact_pairs() {
            let colliders = (self.colliders.get(pair.collider1), self.colliders.get(pair.collider2));
            let (Some(c1), Some(c2)) = colliders else { continue };
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

    /// Returns the compiled model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
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

    /// Returns the id of the geom of a collider, for collider handles from queries.
    pub fn geom_of(&self, collider: ColliderHandle) -> Option<usize> {
        self.colliders.get(collider).map(|c| c.user_data as usize)
    }
}
