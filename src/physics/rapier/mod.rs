//! MJCF models in Rapier.
//!
//! - [`CoupledSimulation`] puts a model among the bodies of a Rapier world of your own. Our engine solves it, Rapier the rest, and contacts push
//!   both ways. [`Coupling`] is its part without an engine.
//! - [`RapierScene`] is a mirror of a state, for Rapier's ray casts and shape queries.
//! - [`RapierEngine`] simulates a model with Rapier's own pipeline, behind the [`Engine`](mjcf_sim_physics::Engine) trait, and [`Bridge`] does so
//!   in a world of yours. They are kept for comparison.
//!
//! # The engine on Rapier's pipeline
//!
//! | of the model | in Rapier |
//! |---|---|
//! | tree with hinges | multibody; one link per hinge, all but the last of a body without mass |
//! | free joint | root of the multibody, or a plain body if nothing hangs on it |
//! | armature | `Multibody::armature` |
//! | gravity, springs, dampers, actuators, Coriolis forces | force, from the same functions as in the soft engine |
//! | lock, limit run into, friction loss | velocity motor: `target_vel = vel + h aref`, `damping = 1 / (h R)` of the row |
//! | limit that pushes | limit, with the softness of the row |
//! | limited tendon over two joints, joint equality | coupling of two coordinates |
//! | weld | impulse joint with six motors |
//! | contact | contact with the row's normal and tangential velocity; one compliance for all |
//!
//! With the force `M qvel / h` in place of a velocity, Rapier's implicit Coriolis terms vanish: without constraints
//! accelerations agree with the soft engine's to rounding. Rapier's contacts have no compliance in friction, one
//! compliance in the normal direction, no torsional and rolling friction, and no convex coupling of sliding and
//! lifting: there the engines differ.
//!
//! Positions are integrated from Rapier's accelerations as MuJoCo does. `State::efc` holds the rows with the forces of
//! contacts and welds; Rapier does not tell those of single joints, whose sum is in `State::qfrc_constraint`.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
mod activation_tests;
mod bodies;
mod bridge;
mod contacts;
mod coupling;
mod dispatcher;
mod engine;
mod hull;
mod inertial;
mod rows;
mod scene;
mod support;

use rapier3d_f64::dynamics::{ImpulseJointSet, MultibodyJointSet, RigidBodySet};
use rapier3d_f64::geometry::ColliderSet;
use rapier3d_f64::pipeline::PhysicsWorld;
use thiserror::Error;

pub use bodies::RapierBodies;
pub use bridge::Bridge;
pub use contacts::ContactHooks;
pub use coupling::{
    CoupledSimulation, Coupling, CouplingError, CouplingOptions, CouplingSnapshot, Material, MaterialMap, WorldSets,
};
pub use dispatcher::ContactDispatcher;
pub use engine::RapierEngine;
pub use engine::RapierModel;
/// Rapier, which is part of this interface; [`rapier3d_f64::parry`] is its Parry.
pub use rapier3d_f64;
pub use scene::{RapierScene, SceneContact};

/// Borrows the sets of a Rapier world.
#[derive(Debug)]
pub struct RapierSets<'a> {
    /// Bodies.
    pub bodies: &'a mut RigidBodySet,
    /// Colliders.
    pub colliders: &'a mut ColliderSet,
    /// Impulse joints.
    pub impulse_joints: &'a mut ImpulseJointSet,
    /// Multibody joints.
    pub multibody_joints: &'a mut MultibodyJointSet,
}

impl<'a> From<&'a mut PhysicsWorld> for RapierSets<'a> {
    fn from(world: &'a mut PhysicsWorld) -> Self {
        Self {
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &mut world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
        }
    }
}

/// The options of [`RapierEngine`] and [`Bridge`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RapierOptions {
    /// Iterations of Rapier's solver in a step.
    pub iterations: usize,
    /// Compliance of contacts relative to their inverse effective mass. The default is that of MuJoCo's default `dmax`,
    /// `(1 - 0.95) / 0.95`.
    pub contact_compliance: f64,
    /// Whether torque sensors count a weld's torque twice, see
    /// [`SoftOptions`](mjcf_sim_physics::SoftOptions::double_weld_torque).
    pub double_weld_torque: bool,
    /// Whether contacts between geoms of the model are ignored.
    pub disable_contacts: bool,
}

impl Default for RapierOptions {
    fn default() -> Self {
        Self {
            iterations: 20,
            contact_compliance: (1.0 - 0.95) / 0.95,
            double_weld_torque: false,
            disable_contacts: false,
        }
    }
}

/// A reason why a model cannot be simulated by Rapier.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum RapierError {
    /// An element that Rapier's multibodies cannot represent.
    #[error("the rapier engine cannot simulate {element} {name:?}: {what}; use the soft engine")]
    Unsupported {
        /// Kind of element.
        element: &'static str,
        /// Name of the element.
        name: String,
        /// Reason.
        what: &'static str,
    },
}

impl RapierError {
    fn unsupported(element: &'static str, name: &str, what: &'static str) -> Self {
        Self::Unsupported {
            element,
            name: name.to_string(),
            what,
        }
    }
}
