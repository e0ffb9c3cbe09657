//! Parameters of a scene that a program may change while it runs.

use crate::math::Vec3;
use crate::model::{Arrays, EqualityKind};
use crate::table::table;

table! {
    |model: &Arrays|
    /// The parameters that a program may change while the scene runs; copied from the model at construction.
    #[derive(Debug, PartialEq)]
    pub struct Params, "params.";
    dynamic {
        /// Whether each equality constraint holds (neq): MuJoCo's `mjData::eq_active`.
        pub eq_active: [bool; model.neq()] => model.eq_active0.clone();
        /// Constant term of each equality of joints or tendons (neq), rad or m: the first number of MuJoCo's `eq_data`. Unused for
        /// connects and welds.
        pub eq_offset: [f64; model.neq()] finite => model.eq_kind.iter().map(offset).collect();
        /// Stiffness of each joint's spring (njnt): N m/rad for hinges and balls, N/m for slides. A free joint has both.
        pub jnt_stiffness: [f64; model.njnt()] finite => model.jnt_stiffness.clone();
        /// Damping of each degree of freedom (nv): N m s/rad for rotations, N s/m for translations.
        pub dof_damping: [f64; model.nv] finite => model.dof_damping.clone();
        /// Gear of each actuator (nu), no unit on hinges and slides: the first of MuJoCo's six.
        pub actuator_gear: [f64; model.nu()] finite => model.actuator_gear.clone();
        /// Whether `actuator_forcerange` of the model limits the force of each actuator (nu).
        pub actuator_forcelimited: [bool; model.nu()] => model.actuator_forcelimited.clone();
        /// Gravity (3), world frame, m/s^2: MuJoCo's `opt.gravity`.
        pub gravity: (Vec3) finite = if model.opt.flags.gravity { model.opt.gravity } else { [0.0; 3] };
        /// Inverse weight of each degree of freedom (nv), as [`Arrays::dof_invweight0`]: 1/(kg m^2) for rotations, 1/kg for
        /// translations.
        pub dof_invweight0: [f64; model.nv] => model.dof_invweight0.clone();
        /// Mass of each body (nbody), kg. [`State::set_free_body`](crate::State::set_free_body) keeps dependent quantities consistent; the same is
        /// true of the fields below.
        pub body_mass: [f64; model.nbody()] => model.body_mass.clone();
        /// Mass of each body with all bodies below it (nbody), kg.
        pub body_subtreemass: [f64; model.nbody()] => model.body_subtreemass.clone();
        /// Principal moments of inertia of each body (nbody, 3), along the axes of `body_iquat`, kg m^2.
        pub body_inertia: [Vec3; model.nbody()] => model.body_inertia.clone();
        /// Inverse weights of each body (nbody, 2), as [`Arrays::body_invweight0`]: translation, 1/kg, and rotation, 1/(kg m^2).
        pub body_invweight0: [[f64; 2]; model.nbody()] => model.body_invweight0.clone();
        /// Size of each geom (ngeom, 3), m; see [`GeomType`](crate::model::GeomType). Touch sensors keep their positions in the model.
        pub geom_size: [Vec3; model.ngeom()] => model.geom_size.clone();
        /// Radius of each geom's bounding sphere (ngeom), m; 0 for planes.
        pub geom_rbound: [f64; model.ngeom()] => model.geom_rbound.clone();
    }
    computed {}
}

impl Params {
    /// Returns the model's own values.
    pub fn new(model: &Arrays) -> Self {
        Self::first(model)
    }
}

/// Returns the constant term of an equality.
fn offset(kind: &EqualityKind) -> f64 {
    match kind {
        EqualityKind::Joint { polycoef, .. } | EqualityKind::Tendon { polycoef, .. } => polycoef[0],
        EqualityKind::Connect { .. } | EqualityKind::Weld { .. } | EqualityKind::Flex { .. } => 0.0,
    }
}
