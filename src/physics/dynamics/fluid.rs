//! Forces of a medium on bodies, and of compensated gravity.

use std::f64::consts::PI;

use super::applied::add_force;
use super::ellipsoid::{swim, swims};
use crate::math::*;
use crate::model::Model;
use crate::spatial::*;
use crate::state::State;

/// Adds the forces of a medium on moving bodies to `qfrc_passive`: viscous resistance of a sphere and drag of a box, both of
/// the size of the box that has the body's mass and inertia ("inertia-based model" in MuJoCo's documentation).
#[doc(alias = "mj_inertiaBoxFluidModel")]
pub(super) fn medium(model: &Model, s: &mut State) {
    let opt = &model.opt;
    if opt.density == 0.0 && opt.viscosity == 0.0 {
        return;
    }
    for b in 1..model.nbody() {
        if s.params.body_mass[b] < MINVAL {
            continue;
        }
        if swims(model, b) {
            swim(model, s, b);
            continue;
        }
        let (turning, moving) = relative_to_medium(model, s, b);
        let (torque, force) = resistance(box_of(s, b), turning, moving, opt.density, opt.viscosity);
        let axes = &s.ximat[b];
        let (torque, force) = (mat_vec(axes, torque), mat_vec(axes, force));
        let point = s.xipos[b];
        let State {
            qfrc_passive,
            cdof,
            subtree_com,
            ..
        } = s;
        add_force(model, cdof, subtree_com, (b, force, torque, point), qfrc_passive);
    }
}

/// Returns the angular velocity of a body, rad/s, and the velocity of its centre of mass through the medium, m/s, along its principal axes.
fn relative_to_medium(model: &Model, s: &State, b: usize) -> (Vec3, Vec3) {
    let offset = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
    let axes = &s.ximat[b];
    let turning = mat_t_vec(axes, angular(&s.cvel[b]));
    let moving = mat_t_vec(axes, velocity_at(&s.cvel[b], offset));
    (turning, sub(moving, mat_t_vec(axes, model.opt.wind)))
}

/// Returns the derivatives of torque (3) and force (3) of a medium on a body by the angular and linear velocity along the same principal axis, N m s
/// and N s/m.
#[doc(alias = "mjd_inertiaBoxFluid")]
pub(super) fn medium_slopes(model: &Model, s: &State, b: usize) -> [f64; 6] {
    let (turning, moving) = relative_to_medium(model, s, b);
    let (size, opt) = (box_of(s, b), &model.opt);
    let mut slopes = [0.0; 6];
    if opt.viscosity > 0.0 {
        let diameter = (size[0] + size[1] + size[2]) / 3.0;
        slopes[..3].fill(-PI * diameter * diameter * diameter * opt.viscosity);
        slopes[3..].fill(-3.0 * PI * diameter * opt.viscosity);
    }
    if opt.density > 0.0 {
        let fourth = |v: f64| v * v * v * v;
        for k in 0..3 {
            let (a, b) = (size[(k + 1) % 3], size[(k + 2) % 3]);
            slopes[k] -= opt.density * size[k] * (fourth(a) + fourth(b)) * 2.0 * turning[k].abs() / 64.0;
            slopes[3 + k] -= opt.density * a * b * moving[k].abs();
        }
    }
    slopes
}

/// Returns the sides of the box with the mass and the principal moments of a body, m.
fn box_of(s: &State, b: usize) -> Vec3 {
    let ([x, y, z], mass) = (s.params.body_inertia[b], s.params.body_mass[b]);
    let side = |a: f64, b: f64, c: f64| ((a + b - c).max(MINVAL) / mass * 6.0).sqrt();
    [side(y, z, x), side(x, z, y), side(x, y, z)]
}

/// Returns the torque, N m, and the force, N, of a medium on a box that turns (rad/s) and moves (m/s) along its axes.
fn resistance(size: Vec3, turning: Vec3, moving: Vec3, density: f64, viscosity: f64) -> (Vec3, Vec3) {
    let (mut torque, mut force) = ([0.0; 3], [0.0; 3]);
    if viscosity > 0.0 {
        let diameter = (size[0] + size[1] + size[2]) / 3.0;
        torque = scale(turning, -PI * diameter * diameter * diameter * viscosity);
        force = scale(moving, -3.0 * PI * diameter * viscosity);
    }
    if density > 0.0 {
        let fourth = |v: f64| v * v * v * v;
        for k in 0..3 {
            let (a, b) = (size[(k + 1) % 3], size[(k + 2) % 3]);
            force[k] -= 0.5 * density * a * b * moving[k].abs() * moving[k];
            torque[k] -= density * size[k] * (fourth(a) + fourth(b)) * turning[k].abs() * turning[k] / 64.0;
        }
    }
    (torque, force)
}

/// Computes `qfrc_gravcomp`, which carries the compensated part of each body's weight, and adds it to `qfrc_passive`, except for joints
/// whose actuators carry it.
#[doc(alias = "mj_gravcomp")]
pub(super) fn gravity_compensation(model: &Model, s: &mut State) {
    // MuJoCo 3.3.0 counts the positive ones: without any the others hold nothing, either
    if model.body_gravcomp.iter().all(|part| *part <= 0.0) {
        return;
    }
    s.qfrc_gravcomp.fill(0.0);
    for b in 1..model.nbody() {
        let part = model.body_gravcomp[b];
        if part == 0.0 {
            continue;
        }
        let force = scale(s.params.gravity, -s.params.body_mass[b] * part);
        let point = s.xipos[b];
        let State {
            qfrc_gravcomp,
            cdof,
            subtree_com,
            ..
        } = s;
        add_force(model, cdof, subtree_com, (b, force, [0.0; 3], point), qfrc_gravcomp);
    }
    for d in 0..model.nv {
        if !model.jnt_actgravcomp[model.dof_jntid[d]] {
            s.qfrc_passive[d] += s.qfrc_gravcomp[d];
        }
    }
}
