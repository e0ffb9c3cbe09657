//! Spatial algebra in MuJoCo's arrangement: motion and force vectors are `[rotation (3), translation (3)]`, expressed
//! in axes parallel to the world's with the origin at the centre of mass of the body's kinematic tree.

use crate::math::{Vec3, add, cross, scale, sub};

/// A spatial motion or force vector, `[angular (3), linear (3)]` or `[torque (3), force (3)]`.
pub type Spatial = [f64; 6];

/// A spatial inertia: `Ixx, Iyy, Izz, Ixy, Ixz, Iyz` about the reference point, mass times offset (3), mass.
pub type Inertia = [f64; 10];

/// Joins angular (or torque) and linear (or force) part.
#[inline(always)]
pub fn spatial(angular: Vec3, linear: Vec3) -> Spatial {
    [angular[0], angular[1], angular[2], linear[0], linear[1], linear[2]]
}

/// Returns the angular part of a motion, torque of a force.
#[inline(always)]
pub fn angular(a: &Spatial) -> Vec3 {
    [a[0], a[1], a[2]]
}

/// Returns the linear part of a motion, force of a force.
#[inline(always)]
pub fn linear(a: &Spatial) -> Vec3 {
    [a[3], a[4], a[5]]
}

/// Returns the power: the product of a motion and a force.
#[inline(always)]
pub fn dot6(a: &Spatial, b: &Spatial) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}

/// Computes `y += a x`.
#[inline(always)]
pub fn axpy6(y: &mut Spatial, a: f64, x: &Spatial) {
    for k in 0..6 {
        y[k] += a * x[k];
    }
}

/// Returns the rate of change of the motion `m` carried along with velocity `v`: `v x m`.
#[inline(always)]
pub fn cross_motion(v: &Spatial, m: &Spatial) -> Spatial {
    let (w, l) = (angular(v), linear(v));
    spatial(cross(w, angular(m)), add(cross(w, linear(m)), cross(l, angular(m))))
}

/// Returns the rate of change of the force (momentum) `f` carried along with velocity `v`: `v x* f`.
#[inline(always)]
pub fn cross_force(v: &Spatial, f: &Spatial) -> Spatial {
    let (w, l) = (angular(v), linear(v));
    spatial(add(cross(w, angular(f)), cross(l, linear(f))), cross(w, linear(f)))
}

/// Returns the momentum of an inertia moving with `v`, or the force that gives it the acceleration `v`.
#[inline(always)]
pub fn inertia_mul(i: &Inertia, v: &Spatial) -> Spatial {
    let (w, l) = (angular(v), linear(v));
    let h = [i[6], i[7], i[8]];
    let iw = [
        i[0] * w[0] + i[3] * w[1] + i[4] * w[2],
        i[3] * w[0] + i[1] * w[1] + i[5] * w[2],
        i[4] * w[0] + i[5] * w[1] + i[2] * w[2],
    ];
    spatial(add(iw, cross(h, l)), sub(scale(l, i[9]), cross(h, w)))
}

/// Returns the linear velocity at `offset` from the reference point.
#[inline(always)]
pub fn velocity_at(v: &Spatial, offset: Vec3) -> Vec3 {
    add(linear(v), cross(angular(v), offset))
}

/// Returns the torque about a point at `offset` from the reference point.
#[inline(always)]
pub fn torque_at(f: &Spatial, offset: Vec3) -> Vec3 {
    sub(angular(f), cross(offset, linear(f)))
}

/// Moves the wrench `(torque, force)` acting at `offset` from the reference point to the reference point.
#[inline(always)]
pub fn wrench_from(torque: Vec3, force: Vec3, offset: Vec3) -> Spatial {
    spatial(add(torque, cross(offset, force)), force)
}
