//! Parameters of a scene that a program may change while it runs.

use crate::math::Vec3;
use crate::model::{Arrays, EqualityKind};

macro_rules! params {
    ($($(#[$doc:meta])* $field:ident: $ty:ty = |$model:ident| $init:expr;)*) => {
        /// The parameters that a program may change while the scene runs; copied from the model at construction.
        #[derive(Debug, PartialEq)]
        pub struct Params {
            $($(#[$doc])* pub $field: $ty,)*
        }

        impl Clone for Params {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone(),)* }
            }

            /// Keeps the memory, so that a reset does not allocate.
            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)*
            }
        }

        impl Params {
            /// Returns the model's own values.
            pub fn new(model: &Arrays) -> Self {
                Self { $($field: { let $model = model; $init },)* }
            }
        }
    };
}

params! {
    /// Gravity, m/s^2.
    gravity: Vec3 = |model| model.opt.gravity;
    /// Which equality constraints hold (neq).
    eq_active: Vec<bool> = |model| model.eq_active0.clone();
    /// Constant term of each joint equality (neq), rad; unused for welds.
    eq_offset: Vec<f64> = |model| model.eq_kind.iter().map(offset).collect();
    /// Joint stiffness (njnt), N m/rad.
    jnt_stiffness: Vec<f64> = |model| model.jnt_stiffness.clone();
    /// Damping (nv), N m s/rad.
    dof_damping: Vec<f64> = |model| model.dof_damping.clone();
    /// Inverse weight of each degree of freedom (nv), as [`Arrays::dof_invweight0`].
    dof_invweight0: Vec<f64> = |model| model.dof_invweight0.clone();
    /// Actuator gear (nu).
    actuator_gear: Vec<f64> = |model| model.actuator_gear.clone();
    /// Whether the actuator force is limited (nu).
    actuator_forcelimited: Vec<bool> = |model| model.actuator_forcelimited.clone();
    /// Mass of each body (nbody), kg. [`State::set_free_body`](crate::physics::State::set_free_body) keeps what depends on it
    /// in step; the same is true of the fields below.
    body_mass: Vec<f64> = |model| model.body_mass.clone();
    /// Mass of each body with all below it (nbody), kg.
    body_subtreemass: Vec<f64> = |model| model.body_subtreemass.clone();
    /// Principal moments of inertia (nbody), kg m^2.
    body_inertia: Vec<Vec3> = |model| model.body_inertia.clone();
    /// Inverse weights of each body (nbody), as [`Arrays::body_invweight0`].
    body_invweight0: Vec<[f64; 2]> = |model| model.body_invweight0.clone();
    /// Size of each geom (ngeom), m; see [`GeomType`](crate::model::GeomType). Touch sensors stay where the model has them.
    geom_size: Vec<Vec3> = |model| model.geom_size.clone();
    /// Radius of each geom's bounding sphere (ngeom), m.
    geom_rbound: Vec<f64> = |model| model.geom_rbound.clone();
}

/// Returns the constant term of an equality.
fn offset(kind: &EqualityKind) -> f64 {
    match kind {
        EqualityKind::Joint { polycoef, .. } => polycoef[0],
        EqualityKind::Weld { .. } => 0.0,
    }
}
