//! The bodies of the world near the model, and the slots that stand for them.

use rapier3d_f64::dynamics::{LockedAxes, RigidBody, RigidBodyHandle, RigidBodyType};
use rapier3d_f64::geometry::{Collider, ColliderHandle, InteractionGroups, SharedShape};
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d_f64::parry::mass_properties::MassProperties;
use rapier3d_f64::parry::math::Pose;
use rapier3d_f64::parry::shape::ShapeType;

use super::impulse::Impulse;
use super::shapes::{GeomRow, GeomText};
use super::slots::Slots;
use super::{CouplingError, CouplingOptions, Material, WorldSets};

/// Distance from a neighbor below which a fixed collider is also a neighbor, m: the neighbor may stand on it.
const BENEATH: f64 = 0.02;

/// The part of the world that a neighbor stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// A dynamic or kinematic body.
    Body(RigidBodyHandle),
    /// A collider without a body, or of a fixed body.
    Fixed(ColliderHandle),
}

/// The properties of a collider from which its geoms were made.
#[derive(Clone)]
struct SeenCollider {
    handle: ColliderHandle,
    /// A reference to the shape, so that a program that changes the shape gets its own copy and the change is noticed.
    shape: SharedShape,
    at: Pose,
    friction: f64,
    groups: [InteractionGroups; 2],
}

impl SeenCollider {
    fn new(handle: ColliderHandle, collider: &Collider, at: Pose) -> Self {
        Self {
            handle,
            shape: collider.shared_shape().clone(),
            at,
            friction: collider.friction(),
            groups: [collider.collision_groups(), collider.solver_groups()],
        }
    }

    fn is(&self, handle: ColliderHandle, collider: &Collider, at: Pose) -> bool {
        self.handle == handle
            && std::sync::Arc::ptr_eq(&self.shape.0, &collider.shared_shape().0)
            && self.at == at
            && self.friction == collider.friction()
            && self.groups == [collider.collision_groups(), collider.solver_groups()]
    }
}

/// Inertia and damping of a neighbor in the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inertia {
    /// Mass, kg, and moments, kg m^2.
    pub mass: f64,
    pub moments: [f64; 3],
    /// Linear and angular damping, 1/s, as in Rapier.
    pub damping: [f64; 2],
}

/// A body or a fixed collider near the model.
#[derive(Clone)]
pub(super) struct Neighbor {
    pub source: Source,
    seen: Vec<SeenCollider>,
    local: Option<(MassProperties, RigidBodyType, LockedAxes)>,
    /// Inertia in the model; `None` for fixed colliders.
    pub inertia: Option<Inertia>,
    /// Whether contacts move it.
    pub moved: bool,
    /// Its geoms with their materials, and the places of their colliders in `seen`.
    pub geoms: Vec<(GeomRow, Material, usize)>,
    /// Its slots: one for a body, one for each geom of a fixed collider.
    pub slots: Vec<usize>,
    /// The part of the world in which the geoms of a fixed mesh are complete.
    pub region: Option<Aabb>,
    /// The part of the last impulse that acts after the step of the world.
    pub pending: Impulse,
}

impl Neighbor {
    /// Returns the collider of a geom: the one at `place` in a slot.
    pub fn collider(&self, slot: usize, place: usize) -> Option<ColliderHandle> {
        let geom = match self.inertia {
            Some(_) => place,
            None => self.slots.iter().position(|&taken| taken == slot)?,
        };
        Some(self.seen.get(self.geoms.get(geom)?.2)?.handle)
    }

    /// Returns the groups of the collider of a geom: for collisions and for the solver.
    pub fn groups(&self, geom: usize) -> [InteractionGroups; 2] {
        self.seen[self.geoms[geom].2].groups
    }
}

/// The neighbors of a model.
#[derive(Clone, Default)]
pub(super) struct Neighbors {
    pub all: Vec<Neighbor>,
    /// Fixed colliders that the model added. They are not neighbors.
    pub own: Vec<ColliderHandle>,
    /// Scratch: boxes around bodies that are neighbors.
    boxes: Vec<Aabb>,
}

/// Returns whether a collider may touch the model.
fn touches(collider: &Collider, groups: InteractionGroups) -> bool {
    // the colliders of models have no solver groups: models do not touch each other
    collider.is_enabled()
        && !collider.is_sensor()
        && groups.test(collider.collision_groups())
        && collider.solver_groups().test(InteractionGroups::all())
}

/// Returns the neighbor that a collider would become; `None` if it cannot be one.
fn source(handle: ColliderHandle, collider: &Collider, sets: &WorldSets<'_>) -> Option<Source> {
    match collider.parent() {
        None => Some(Source::Fixed(handle)),
        Some(parent) => {
            let body = sets.bodies.get(parent).filter(|body| body.is_enabled())?;
            Some(if body.is_fixed() {
                Source::Fixed(handle)
            } else {
                Source::Body(parent)
            })
        }
    }
}

/// Returns the distance that a body may cover in two steps, m.
fn reach(body: &RigidBody, dt: f64) -> f64 {
    2.0 * dt * body.linvel().length()
}

impl Neighbors {
    /// Returns an empty set, for a model that added its own colliders.
    pub fn new(own: Vec<ColliderHandle>) -> Self {
        Self { own, ..Self::default() }
    }

    /// Updates the neighbors. Returns whether the model has to change.
    pub fn update(
        &mut self,
        sets: &WorldSets<'_>,
        bounds: Aabb,
        options: &CouplingOptions,
        (slots, multiccd): (&Slots, bool),
    ) -> Result<bool, CouplingError> {
        let mut changed = self.leave(sets, bounds, options);
        // bodies first, because what they stand on becomes a neighbor, too
        for fixed in [false, true] {
            if fixed {
                self.find_boxes(sets);
            }
            for (handle, collider) in sets.colliders.iter() {
                if !touches(collider, options.groups) || self.own.contains(&handle) {
                    continue;
                }
                let Some(source) = source(handle, collider, sets) else {
                    continue;
                };
                if matches!(source, Source::Fixed(_)) != fixed || self.all.iter().any(|n| n.source == source) {
                    continue;
                }
                if self.near(source, collider, sets, bounds, options.near, 1.0) {
                    let region = bounds.loosened(2.0 * options.near);
                    let mut found = meet(source, sets, region, options, multiccd)?;
                    self.find_slots(&mut found, slots, options)?;
                    self.all.push(found);
                    changed = true;
                }
            }
        }
        Ok(changed)
    }

    /// Drops neighbors that have gone or changed. Returns whether there were any.
    fn leave(&mut self, sets: &WorldSets<'_>, bounds: Aabb, options: &CouplingOptions) -> bool {
        self.find_boxes(sets);
        let mut neighbors = std::mem::take(&mut self.all);
        let before = neighbors.len();
        neighbors.retain(|n| {
            let near = |handle: ColliderHandle| {
                let Some(collider) = sets.colliders.get(handle) else {
                    return false;
                };
                touches(collider, options.groups)
                    && source(handle, collider, sets) == Some(n.source)
                    && self.near(n.source, collider, sets, bounds, options.near, 2.0)
            };
            let covered = n
                .region
                .is_none_or(|region| region.contains(&bounds.loosened(0.5 * options.near)));
            n.seen.iter().any(|seen| near(seen.handle)) && covered && unchanged(n, sets, options)
        });
        self.all = neighbors;
        self.all.len() != before
    }

    /// Stores the positions of the bodies among the neighbors.
    fn find_boxes(&mut self, sets: &WorldSets<'_>) {
        self.boxes.clear();
        for n in &self.all {
            let Source::Body(handle) = n.source else { continue };
            let Some(body) = sets.bodies.get(handle) else { continue };
            let colliders = body.colliders().iter().filter_map(|&handle| sets.colliders.get(handle));
            let around = colliders.map(Collider::compute_aabb).reduce(|a, b| a.merged(&b));
            self.boxes
                .extend(around.map(|around| around.loosened(reach(body, sets.dt))));
        }
    }

    fn near(
        &self,
        source: Source,
        collider: &Collider,
        sets: &WorldSets<'_>,
        bounds: Aabb,
        near: f64,
        times: f64,
    ) -> bool {
        let around = collider.compute_aabb();
        match source {
            Source::Body(handle) => {
                let reach = sets.bodies.get(handle).map_or(0.0, |body| reach(body, sets.dt));
                bounds.loosened(times * near + reach).intersects(&around)
            }
            Source::Fixed(_) => {
                let beneath = |other: &Aabb| other.loosened(times * BENEATH).intersects(&around);
                bounds.loosened(times * near).intersects(&around) || self.boxes.iter().any(beneath)
            }
        }
    }

    fn find_slots(
        &self,
        neighbor: &mut Neighbor,
        slots: &Slots,
        options: &CouplingOptions,
    ) -> Result<(), CouplingError> {
        let taken = |slot: usize| self.all.iter().any(|n| n.slots.contains(&slot));
        let too_many = |what, slots, option| CouplingError::TooManyNeighbors { what, slots, option };
        let shapes = neighbor.geoms.len();
        if neighbor.inertia.is_none() {
            let mut idle = (slots.free..slots.all.len()).filter(|&slot| !taken(slot));
            for _ in 0..shapes {
                let slot = idle.next();
                let slot = slot.ok_or_else(|| too_many("fixed shapes and triangles", options.fixed, "fixed"))?;
                neighbor.slots.push(slot);
            }
            return Ok(());
        }
        if shapes > slots.all.get(slots.bodies).map_or(1, |slot| slot.geoms.len()) {
            return Err(too_many(
                "shapes of one body",
                options.compound_shapes,
                "compound_shapes",
            ));
        }
        let first = if shapes > 1 { slots.bodies } else { 0 };
        let slot = (first..slots.free).find(|&slot| !taken(slot));
        let (what, count, option) = if shapes > 1 {
            ("bodies of several shapes", options.compounds, "compounds")
        } else {
            ("bodies", options.bodies + options.compounds, "bodies")
        };
        neighbor.slots.push(slot.ok_or_else(|| too_many(what, count, option))?);
        Ok(())
    }
}

/// Makes a neighbor without slots. For fixed meshes it contains only the part in a region.
pub(super) fn meet(
    source: Source,
    sets: &WorldSets<'_>,
    region: Aabb,
    options: &CouplingOptions,
    multiccd: bool,
) -> Result<Neighbor, CouplingError> {
    let mut neighbor = Neighbor {
        source,
        seen: Vec::new(),
        local: None,
        inertia: None,
        moved: false,
        geoms: Vec::new(),
        slots: Vec::new(),
        region: None,
        pending: Impulse::default(),
    };
    match source {
        Source::Body(handle) => {
            let Some(body) = sets.bodies.get(handle) else {
                return Ok(neighbor);
            };
            let local = body.mass_properties().local_mprops;
            neighbor.local = Some((local, body.body_type(), body.locked_axes()));
            let link = sets.multibody_joints.rigid_body_link(handle).is_some();
            let inertia = inertia(body, link, options);
            neighbor.moved = inertia.mass < options.kinematic_mass && body.is_dynamic();
            neighbor.inertia = Some(inertia);
            // the frame of the slot is that of the principal axes at the centre of mass
            let frame = Pose::from_parts(local.local_com, local.principal_inertia_local_frame).inverse();
            for &handle in body.colliders() {
                if let Some(collider) = sets.colliders.get(handle)
                    && touches(collider, options.groups)
                {
                    let at = collider.position_wrt_parent().copied().unwrap_or(Pose::IDENTITY);
                    neighbor.take(handle, collider, at, frame * at, (None, multiccd), options)?;
                }
            }
        }
        Source::Fixed(handle) => {
            let Some(collider) = sets.colliders.get(handle) else {
                return Ok(neighbor);
            };
            let position = *collider.position();
            let kind = collider.shape().shape_type();
            let mesh = kind == ShapeType::TriMesh || kind == ShapeType::Compound;
            neighbor.region = mesh.then_some(region);
            let region = neighbor.region.map(|region| region.transform_by(&position.inverse()));
            // where a mesh lies decides which of its triangles count
            let at = if mesh { position } else { Pose::IDENTITY };
            neighbor.take(handle, collider, at, Pose::IDENTITY, (region, multiccd), options)?;
        }
    }
    Ok(neighbor)
}

impl Neighbor {
    /// Adds the geoms of a collider.
    fn take(
        &mut self,
        handle: ColliderHandle,
        collider: &Collider,
        seen: Pose,
        at: Pose,
        (region, multiccd): (Option<Aabb>, bool),
        options: &CouplingOptions,
    ) -> Result<(), CouplingError> {
        let mut text = GeomText::new(self.inertia.is_none(), region);
        text.add(collider.shape(), at, handle)?;
        let rows = text.compile(multiccd).map_err(|error| CouplingError::Geom {
            collider: handle,
            error: Box::new(error),
        })?;
        let (material, index) = ((options.material)(collider), self.seen.len());
        self.geoms.extend(rows.into_iter().map(|row| (row, material, index)));
        self.seen.push(SeenCollider::new(handle, collider, seen));
        Ok(())
    }
}

/// Returns whether a neighbor is unchanged since its geoms were made.
fn unchanged(n: &Neighbor, sets: &WorldSets<'_>, options: &CouplingOptions) -> bool {
    match n.source {
        Source::Body(handle) => {
            let Some(body) = sets.bodies.get(handle) else {
                return false;
            };
            let local = (
                body.mass_properties().local_mprops,
                body.body_type(),
                body.locked_axes(),
            );
            let link = sets.multibody_joints.rigid_body_link(handle).is_some();
            let all = || {
                body.colliders()
                    .iter()
                    .filter_map(|&handle| Some((handle, sets.colliders.get(handle)?)))
            };
            let mut now = all().filter(|(_, collider)| touches(collider, options.groups));
            let same = |seen: &SeenCollider| {
                now.next().is_some_and(|(handle, collider)| {
                    let at = collider.position_wrt_parent().copied().unwrap_or(Pose::IDENTITY);
                    seen.is(handle, collider, at)
                })
            };
            n.local == Some(local)
                && n.inertia == Some(inertia(body, link, options))
                && n.seen.iter().all(same)
                && now.next().is_none()
        }
        Source::Fixed(handle) => sets.colliders.get(handle).is_some_and(|collider| {
            let at = n.region.map_or(Pose::IDENTITY, |_| *collider.position());
            n.seen.first().is_some_and(|seen| seen.is(handle, collider, at))
        }),
    }
}

/// Returns the inertia that a body has in the model. Links of multibodies take no impulses.
fn inertia(body: &RigidBody, link: bool, options: &CouplingOptions) -> Inertia {
    let local = body.mass_properties().local_mprops;
    let heavy = options.kinematic_mass;
    let locked = body.locked_axes();
    let held = !body.is_dynamic() || link || locked.contains(LockedAxes::TRANSLATION_LOCKED);
    let turns = body.is_dynamic() && !link && !locked.contains(LockedAxes::ROTATION_LOCKED);
    // Rapier's inverse mass is 0 for one that nothing moves
    let inverse = |inverse: f64| if inverse > 0.0 { 1.0 / inverse } else { heavy };
    let moments = local.inv_principal_inertia;
    Inertia {
        mass: if held { heavy } else { inverse(local.inv_mass) },
        moments: if turns {
            [inverse(moments.x), inverse(moments.y), inverse(moments.z)]
        } else {
            [heavy; 3]
        },
        damping: [body.linear_damping(), body.angular_damping()],
    }
}
