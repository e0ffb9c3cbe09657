//! The content of a document, before the constants that need dynamics.

use super::error::{ErrorKind, LoadError};
use super::settings::LengthRange;
use super::xml::Tree;
use crate::limits::Limits;
use crate::model::Arrays;

/// The content of an MJCF document, checked and with MuJoCo's ids and units, like MuJoCo's `mjSpec`.
///
/// `compile` of mjcf-sim-physics makes a [`Model`](mjcf_sim_model::Model) of it.
#[doc(alias = "mjSpec")]
#[derive(Clone, Debug)]
pub struct Spec {
    pub(super) arrays: Arrays,
    pub(super) places: Locations,
    pub(super) lengthrange: LengthRange,
}

/// The locations of the elements in their document.
#[derive(Clone, Debug)]
pub struct Locations {
    pub(super) tree: Tree,
    /// The body elements (nbody), the root for the world.
    pub(super) bodies: Vec<usize>,
    /// The tendon elements (ntendon).
    pub(super) tendons: Vec<usize>,
    /// The actuator elements (nu).
    pub(super) actuators: Vec<usize>,
}

impl Locations {
    /// Returns an error at a body; for the world, an error of the whole document.
    pub fn body_error(&self, body: usize, message: &'static str) -> LoadError {
        self.tree.error(self.bodies[body], ErrorKind::Invalid(message))
    }

    /// Returns an error at a tendon.
    pub fn tendon_error(&self, tendon: usize, message: &'static str) -> LoadError {
        self.tree.error(self.tendons[tendon], ErrorKind::Invalid(message))
    }

    /// Returns the limits within which the document was read.
    pub fn limits(&self) -> &Limits {
        &self.tree.limits
    }

    /// Returns an error at an actuator.
    pub fn actuator_error(&self, actuator: usize, message: &'static str) -> LoadError {
        self.tree.error(self.actuators[actuator], ErrorKind::Invalid(message))
    }
}

macro_rules! counts {
    ($($fun:ident $field:ident $what:literal),* $(,)?) => {
        impl Spec {$(
            #[doc = concat!("Returns the number of ", $what, ".")]
            pub fn $fun(&self) -> usize {
                self.arrays.$field.len()
            }
        )*}
    };
}

counts! {
    nq qpos0 "position coordinates",
    nv dof_jntid "degrees of freedom",
    nbody body_name "bodies, the world included",
    njnt jnt_name "joints",
    ngeom geom_name "geoms",
    nsite site_name "sites",
    ncam cam_name "cameras",
    nlight lights "lights",
    nmat materials "materials",
    ntex textures "textures",
    nmesh meshes "meshes",
    nhfield hfields "height fields",
    npair pair_geom "explicit contact pairs",
    nexclude exclude "excluded body pairs",
    neq eq_name "equality constraints",
    ntendon tendon_name "tendons",
    nu actuator_name "actuators",
    nsensor sensor_name "sensors",
}

impl Spec {
    /// Returns the name of the model.
    pub fn name(&self) -> &str {
        &self.arrays.name
    }

    /// Returns the arrays, without the constants that need dynamics, the places of the elements, and how lengths of actuators are found.
    pub fn into_parts(self) -> (Arrays, Locations, LengthRange) {
        (self.arrays, self.places, self.lengthrange)
    }
}
