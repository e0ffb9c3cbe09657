//! Parts of a step as single functions. A step inlines all of its parts into one function. These versions are compiled separately, so each part is in
//! a program only one more time.

use super::{Articulated, BiasScratch, CompositeInertia, Damping};
use crate::model::{Arrays, Model};
use crate::state::State;
use crate::topology::Topology;

/// Computes `xpos, xquat, xmat, xipos, ximat, xanchor, xaxis, geom_*, site_*` from `qpos`.
#[doc(alias = "mj_kinematics")]
#[inline(never)]
pub fn kinematics(model: &Arrays, s: &mut State) {
    super::kinematics(model, s);
}

/// Computes `subtree_com, cinert, cdof` from poses.
#[doc(alias = "mj_comPos")]
#[inline(never)]
pub fn com_pos(model: &Arrays, s: &mut State) {
    super::com_pos(model, s);
}

/// Computes the composite inertias and `qm` from `cinert` and `cdof`.
#[doc(alias = "mj_crb")]
#[inline(never)]
pub fn crb(model: &Arrays, topology: &Topology, s: &mut State, composite: &mut CompositeInertia) {
    super::crb(model, topology, s, composite);
}

/// Computes the articulated inertias from `cinert`, the composite inertias and `cdof`.
#[doc(alias = "mj_factorM")]
#[inline(never)]
pub fn update(bodies: &mut Articulated, model: &Arrays, s: &State, composite: &CompositeInertia) {
    bodies.update(model, s, composite);
}

/// Computes `cacc, cfrc_ext, cfrc_int` of a state whose other quantities are computed.
#[doc(alias = "mj_rnePostConstraint")]
#[inline(never)]
pub fn rne_post_constraint(model: &Model, s: &mut State, double_weld_torque: bool) {
    let bias = BiasScratch::of(s);
    super::rne_post_constraint(model, s, &bias, double_weld_torque);
}

/// Solves `M x = b` (nv).
#[doc(alias = "mj_solveM")]
#[inline(never)]
pub fn solve(bodies: &mut Articulated, s: &State, b: &[f64], x: &mut [f64]) {
    bodies.solve(s, Damping::Without, b, x);
}
