//! The numbers of a model that may change while an environment runs.

use thiserror::Error;

use crate::model::Arrays;
use crate::physics::{Params, Row};

/// An error of [`ModelMut::change`](crate::env::ModelMut::change).
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ModelChangeError {
    /// Something else was changed.
    #[error(
        "the model was changed in what cannot change while an environment lives; what can are the numbers of {}: change the document or the \
         configuration for the rest, and make another environment",
        CHANGEABLE.join(", ")
    )]
    Fixed,
    /// A number is not finite.
    #[error("{name}, number {index}, is {value}: the model has finite numbers only")]
    NotFinite {
        /// Name of the array.
        name: &'static str,
        /// Index of the number in the array, row by row.
        index: usize,
        /// Its value, as text.
        value: String,
    },
    /// A number is too small.
    #[error("{name}, number {index}, is {value}: it must be {least}")]
    TooSmall {
        /// Name of the array.
        name: &'static str,
        /// Index of the number in the array, row by row.
        index: usize,
        /// Its value, as text.
        value: String,
        /// The bound.
        least: &'static str,
    },
    /// Muscles write the gears in each step.
    #[error(
        "actuator_gear belongs to the muscles, which set it in each step: it can be changed with other actuation models only"
    )]
    Muscles,
}

/// Lists the numbers that a program may change: first those of the parameters, with their name there, then those of the model.
macro_rules! changeable {
    (parameters { $($own:literal = $($path:ident).+, $field:ident;)* } model { $($name:literal = $($at:ident).+;)* }) => {
        /// The names of the arrays that [`ModelMut::change`](crate::env::ModelMut::change) may change, as in [`Arrays`].
        pub const CHANGEABLE: &[&str] = &[$($own,)* $($name),*];

        pub(super) fn rows(arrays: &Arrays) -> Vec<&[f64]> {
            let mut out = Vec::with_capacity(CHANGEABLE.len());
            $(arrays.$($path).+.numbers(&mut out);)*
            $(arrays.$($at).+.numbers(&mut out);)*
            out
        }

        pub(super) fn rows_mut(arrays: &mut Arrays) -> Vec<&mut [f64]> {
            let mut out = Vec::with_capacity(CHANGEABLE.len());
            $(arrays.$($path).+.numbers_mut(&mut out);)*
            $(arrays.$($at).+.numbers_mut(&mut out);)*
            out
        }

        pub(super) fn parameters(params: &Params) -> Vec<&[f64]> {
            let mut out = Vec::with_capacity(CHANGEABLE.len());
            $(params.$field.numbers(&mut out);)*
            out
        }

        pub(super) fn parameters_mut(params: &mut Params) -> Vec<&mut [f64]> {
            let mut out = Vec::with_capacity(CHANGEABLE.len());
            $(params.$field.numbers_mut(&mut out);)*
            out
        }
    };
}

changeable! {
    parameters {
        "opt.gravity" = opt.gravity, gravity;
        "body_mass" = body_mass, body_mass;
        "body_inertia" = body_inertia, body_inertia;
        "body_invweight0" = body_invweight0, body_invweight0;
        "dof_invweight0" = dof_invweight0, dof_invweight0;
        "dof_damping" = dof_damping, dof_damping;
        "jnt_stiffness" = jnt_stiffness, jnt_stiffness;
        "actuator_gear" = actuator_gear, actuator_gear;
        "geom_size" = geom_size, geom_size;
        "geom_rbound" = geom_rbound, geom_rbound;
    }
    model {
        "opt.timestep" = opt.timestep;
        "opt.tolerance" = opt.tolerance;
        "opt.ls_tolerance" = opt.ls_tolerance;
        "opt.ccd_tolerance" = opt.ccd_tolerance;
        "opt.impratio" = opt.impratio;
        "opt.density" = opt.density;
        "opt.viscosity" = opt.viscosity;
        "opt.wind" = opt.wind;
        "body_pos" = body_pos;
        "body_quat" = body_quat;
        "jnt_range" = jnt_range;
        "jnt_margin" = jnt_margin;
        "jnt_pos" = jnt_pos;
        "jnt_axis" = jnt_axis;
        "jnt_actfrcrange" = jnt_actfrcrange;
        "qpos0" = qpos0;
        "qpos_spring" = qpos_spring;
        "jnt_solref" = jnt_solref;
        "jnt_solimp" = jnt_solimp;
        "dof_armature" = dof_armature;
        "dof_frictionloss" = dof_frictionloss;
        "dof_solref" = dof_solref;
        "dof_solimp" = dof_solimp;
        "geom_pos" = geom_pos;
        "geom_quat" = geom_quat;
        "geom_friction" = geom_friction;
        "geom_solmix" = geom_solmix;
        "geom_solref" = geom_solref;
        "geom_solimp" = geom_solimp;
        "geom_margin" = geom_margin;
        "geom_gap" = geom_gap;
        "site_pos" = site_pos;
        "site_quat" = site_quat;
        "cam_pos" = cam_pos;
        "cam_quat" = cam_quat;
        "pair_friction" = pair_friction;
        "pair_solref" = pair_solref;
        "pair_solreffriction" = pair_solreffriction;
        "pair_solimp" = pair_solimp;
        "pair_margin" = pair_margin;
        "pair_gap" = pair_gap;
        "eq_solref" = eq_solref;
        "eq_solimp" = eq_solimp;
        "tendon_range" = tendon_range;
        "tendon_margin" = tendon_margin;
        "tendon_stiffness" = tendon_stiffness;
        "tendon_damping" = tendon_damping;
        "tendon_frictionloss" = tendon_frictionloss;
        "tendon_lengthspring" = tendon_lengthspring;
        "tendon_solref_lim" = tendon_solref_lim;
        "tendon_solimp_lim" = tendon_solimp_lim;
        "tendon_solref_fri" = tendon_solref_fri;
        "tendon_solimp_fri" = tendon_solimp_fri;
        "actuator_forcerange" = actuator_forcerange;
        "actuator_actrange" = actuator_actrange;
        "actuator_dynprm" = actuator_dynprm;
        "actuator_gainprm" = actuator_gainprm;
        "actuator_biasprm" = actuator_biasprm;
        "actuator_lengthrange" = actuator_lengthrange;
    }
}
