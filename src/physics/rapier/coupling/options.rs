//! The options of a coupling, and the contact parameters that a collider has in the model.

use std::fmt;
use std::sync::Arc;

use rapier3d_f64::geometry::{Collider, InteractionGroups};

/// The contact parameters and the colour that a collider of the world has in the model.
///
/// [`Material::of`] is the default. Contacts mix the values of both geoms as MJCF says: the larger coefficient of friction and the
/// mean of `solref` and `solimp`, or the values of the geom with the higher priority.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coefficients of friction: sliding, no unit; torsional, m; rolling, m.
    pub friction: [f64; 3],
    /// Dimension of contacts: 1 frictionless, 3 sliding, 4 torsional, 6 rolling friction.
    pub condim: usize,
    /// Priority of these values over those of the model's geoms.
    pub priority: i32,
    /// `solref`; see [Solver parameters](mjcf_sim_model::model::Arrays#solver-parameters).
    pub solref: [f64; 2],
    /// `solimp`; see [Solver parameters](mjcf_sim_model::model::Arrays#solver-parameters).
    pub solimp: [f64; 5],
    /// Red, green, blue, opacity, 0..1, in pictures of the model's cameras.
    pub rgba: [f64; 4],
}

impl Material {
    /// Returns the default for a collider: its coefficient as sliding friction, and MuJoCo's defaults otherwise.
    ///
    /// Rapier's rules for mixing coefficients, restitution, contact skin and contact softness have no counterpart. They hold between
    /// bodies of the world.
    pub fn of(collider: &Collider) -> Self {
        Self {
            friction: [collider.friction(), 0.005, 0.0001],
            condim: 3,
            priority: 0,
            solref: [0.02, 1.0],
            solimp: [0.9, 0.95, 0.001, 0.5, 2.0],
            rgba: [0.5, 0.5, 0.5, 1.0],
        }
    }
}

/// A function that chooses the material of a collider.
pub type MaterialMap = Arc<dyn Fn(&Collider) -> Material + Send + Sync>;

/// The options of a [`Coupling`](super::Coupling).
#[derive(Clone)]
pub struct CouplingOptions {
    /// Greatest number of dynamic and kinematic bodies of one convex shape near the model at a time.
    pub bodies: usize,
    /// Greatest number of dynamic and kinematic bodies of several shapes near the model at a time. They also take bodies of one shape,
    /// if those exceed `bodies`.
    pub compounds: usize,
    /// Greatest number of shapes of one such body.
    pub compound_shapes: usize,
    /// Greatest number of shapes of fixed bodies near the model at a time, and of triangles of fixed meshes.
    pub fixed: usize,
    /// Distance from the model's bounding box below which a body becomes a neighbor, m. It stays one up to twice the distance.
    pub near: f64,
    /// Mass that a kinematic body has in the model, kg. It must be large compared with the masses that touch it.
    pub kinematic_mass: f64,
    /// Whether the model's own fixed geoms, such as a floor, are added to the world as fixed colliders. Otherwise they touch nothing
    /// and are not drawn.
    pub scenery: bool,
    /// Groups of the model's colliders for collisions and queries. Colliders of the world whose groups do not match these do not touch
    /// the model.
    pub groups: InteractionGroups,
    /// The materials of colliders.
    pub material: MaterialMap,
}

impl Default for CouplingOptions {
    fn default() -> Self {
        Self {
            bodies: 6,
            compounds: 1,
            compound_shapes: 8,
            fixed: 16,
            near: 0.1,
            kinematic_mass: 1e6,
            scenery: false,
            groups: InteractionGroups::all(),
            material: Arc::new(Material::of),
        }
    }
}

impl fmt::Debug for CouplingOptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CouplingOptions")
            .field("bodies", &self.bodies)
            .field("compounds", &self.compounds)
            .field("compound_shapes", &self.compound_shapes)
            .field("fixed", &self.fixed)
            .field("near", &self.near)
            .field("kinematic_mass", &self.kinematic_mass)
            .field("scenery", &self.scenery)
            .field("groups", &self.groups)
            .finish_non_exhaustive()
    }
}
