//! Forces of a medium on geoms approximated by ellipsoids ("ellipsoidal model" in MuJoCo's documentation): added mass, drag, lift,
//! the Magnus effect; and their derivatives by velocities.

use std::f64::consts::PI;

use super::applied::add_force;
use super::tree_matrix::TreeMatrix;
use crate::math::*;
use crate::model::{GeomType, Model};
use crate::spatial::*;
use crate::state::State;
use crate::topology::Topology;

/// Derivatives of torque (3) and force (3) by angular velocity (3) and velocity (3).
type FluidDerivatives = [[f64; 6]; 6];

/// A geom that moves through the medium, all in its own axes.
struct FluidGeom {
    /// Semi-axes of the ellipsoid, m.
    axes: Vec3,
    turning: Vec3,
    /// Velocity through the medium, m/s.
    moving: Vec3,
    density: f64,
    viscosity: f64,
    /// Coefficients of blunt, slender and angular drag, of Kutta's lift and of Magnus's.
    coefs: [f64; 5],
    /// Volume and moments that move with it, m^3 and m^5.
    added: [Vec3; 2],
}

/// Returns whether the medium acts on the geoms of a body instead of on the body as a whole.
pub(super) fn swims(model: &Model, b: usize) -> bool {
    let geoms = model.body_geomadr[b]..model.body_geomadr[b] + model.body_geomnum[b];
    model.geom_fluid[geoms].iter().any(|fluid| fluid[0] > 0.0)
}

/// Iterates over the geoms of a body on which the medium acts.
fn swimmers<'a>(model: &'a Model, b: usize) -> impl Iterator<Item = usize> + use<'a> {
    let geoms = model.body_geomadr[b]..model.body_geomadr[b] + model.body_geomnum[b];
    geoms.filter(|&g| model.geom_fluid[g][0] != 0.0)
}

/// Adds the forces of the medium on the geoms of a body to `qfrc_passive`.
#[doc(alias = "mj_ellipsoidFluidModel")]
#[inline(never)]
pub(super) fn swim(model: &Model, s: &mut State, b: usize) {
    for g in swimmers(model, b) {
        let (torque, force) = FluidGeom::new(model, s, g).wrench();
        let (mat, point) = (s.geom_xmat[g], s.geom_xpos[g]);
        let (torque, force) = (mat_vec(&mat, torque), mat_vec(&mat, force));
        let State {
            qfrc_passive,
            cdof,
            subtree_com,
            ..
        } = s;
        add_force(model, cdof, subtree_com, (b, force, torque, point), qfrc_passive);
    }
}

/// Adds the derivatives of these forces by `qvel` to a matrix, made symmetric if `symmetric` is set. `rows` is working memory.
#[doc(alias = "mjd_ellipsoidFluid")]
pub(super) fn swim_slopes(
    model: &Model,
    topology: &Topology,
    s: &State,
    (b, symmetric): (usize, bool),
    rows: &mut Vec<(usize, Spatial)>,
    out: &mut TreeMatrix,
) {
    for g in swimmers(model, b) {
        let mut slopes = FluidGeom::new(model, s, g).slopes();
        if symmetric {
            let whole = slopes;
            for (i, row) in slopes.iter_mut().enumerate() {
                for (k, value) in row.iter_mut().enumerate() {
                    *value = 0.5 * (whole[i][k] + whole[k][i]);
                }
            }
        }
        let (mat, offset) = (
            &s.geom_xmat[g],
            sub(s.geom_xpos[g], s.subtree_com[model.body_rootid[b]]),
        );
        rows.clear();
        rows.extend(topology.body_chain(b).iter().map(|&d| {
            let cdof = &s.cdof[d as usize];
            let turning = mat_t_vec(mat, angular(cdof));
            (d as usize, spatial(turning, mat_t_vec(mat, velocity_at(cdof, offset))))
        }));
        for (row, left) in rows.iter() {
            let pulled: Spatial = std::array::from_fn(|k| (0..6).map(|i| left[i] * slopes[i][k]).sum());
            for (col, right) in rows.iter() {
                out.add(topology, *row, *col, dot6(&pulled, right));
            }
        }
    }
}

/// Returns the semi-axes of the ellipsoid that approximates a shape, m.
fn semi_axes(kind: GeomType, size: Vec3) -> Vec3 {
    match kind {
        GeomType::Sphere => [size[0]; 3],
        GeomType::Capsule => [size[0], size[0], size[1] + size[0]],
        GeomType::Cylinder => [size[0], size[0], size[1]],
        _ => size,
    }
}

fn square(v: f64) -> f64 {
    v * v
}

/// Returns the matrix of the cross product with a vector on the left.
fn crossing(v: Vec3) -> [Vec3; 3] {
    [[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]]
}

/// Adds `scale` times a matrix, its columns weighted, to a quadrant.
fn add_block(slopes: &mut FluidDerivatives, (row, col): (usize, usize), block: &[Vec3; 3], scale: f64, weights: Vec3) {
    for i in 0..3 {
        for k in 0..3 {
            slopes[row + i][col + k] += scale * weights[k] * block[i][k];
        }
    }
}

impl FluidGeom {
    fn new(model: &Model, s: &State, g: usize) -> Self {
        let b = model.geom_bodyid[g];
        let (mat, offset) = (
            &s.geom_xmat[g],
            sub(s.geom_xpos[g], s.subtree_com[model.body_rootid[b]]),
        );
        let moving = mat_t_vec(mat, velocity_at(&s.cvel[b], offset));
        let [_, a, b1, c, d, e, x, y, z, jx, jy, jz] = model.geom_fluid[g];
        Self {
            axes: semi_axes(model.geom_type[g], s.params.geom_size[g]),
            turning: mat_t_vec(mat, angular(&s.cvel[b])),
            moving: sub(moving, mat_t_vec(mat, model.opt.wind)),
            density: model.opt.density,
            viscosity: model.opt.viscosity,
            coefs: [a, b1, c, d, e],
            added: [[x, y, z], [jx, jy, jz]],
        }
    }

    fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * self.axes[0] * self.axes[1] * self.axes[2]
    }

    /// Returns the longest and the middle semi-axis.
    fn longest(&self) -> [f64; 2] {
        let [x, y, z] = self.axes;
        let (most, least) = (x.max(y).max(z), x.min(y).min(z));
        [most, x + y + z - most - least]
    }

    /// Returns the diameter of a sphere of the same overall size.
    fn diameter(&self) -> f64 {
        2.0 / 3.0 * (self.axes[0] + self.axes[1] + self.axes[2])
    }

    /// Returns the squares of the products of two semi-axes each, which weigh the velocity in the normal of the projected area.
    fn weights(&self) -> Vec3 {
        let [x, y, z] = self.axes;
        [square(y * z), square(z * x), square(x * y)]
    }

    /// Returns sums over the squared velocity with the weights squared and with the weights: the projected area is pi times the root
    /// of their quotient.
    fn projection(&self) -> [f64; 2] {
        let (w, v) = (self.weights(), self.moving);
        [
            w[0] * w[0] * square(v[0]) + w[1] * w[1] * square(v[1]) + w[2] * w[2] * square(v[2]),
            w[0] * square(v[0]) + w[1] * square(v[1]) + w[2] * square(v[2]),
        ]
    }

    fn projected_area(&self) -> f64 {
        let [outer, inner] = self.projection();
        PI * (outer / inner.max(MINVAL)).sqrt()
    }

    /// Returns the coefficients of quadratic angular drag about each axis.
    fn angular_drag(&self) -> Vec3 {
        let ([most, middle], [_, slender, turning, ..]) = (self.longest(), self.coefs);
        let largest = 8.0 / 15.0 * PI * middle * square(square(most));
        std::array::from_fn(|k| {
            let [own, a, b] = [0, 1, 2].map(|i| self.axes[(k + i) % 3]);
            let moment = 8.0 / 15.0 * PI * own * square(square(a.max(b)));
            turning * moment + slender * (largest - moment)
        })
    }

    /// Returns the coefficient of drag that is quadratic in the velocity, over its magnitude and the density.
    fn linear_drag(&self) -> f64 {
        let ([most, middle], [blunt, slender, ..]) = (self.longest(), self.coefs);
        let area = self.projected_area();
        area * blunt + slender * (PI * most * middle - area)
    }

    /// Returns torque, N m, and force, N.
    fn wrench(&self) -> (Vec3, Vec3) {
        let (w, v, density) = (self.turning, self.moving, self.density);
        let [.., kutta, magnus] = self.coefs;
        // velocities in the axes of the geom
        let momentum = |of: Vec3, by: Vec3| std::array::from_fn(|k| density * of[k] * by[k]);
        let (linear, turned) = (momentum(self.added[0], v), momentum(self.added[1], w));
        let mut torque = add(cross(linear, v), cross(turned, w));
        let mut force = cross(linear, w);
        // lift
        let [outer, inner] = self.projection();
        let weights = self.weights();
        let normal = std::array::from_fn(|k| weights[k] * v[k]);
        let cosine = inner / (norm(v) * outer).max(MINVAL);
        let circulation = scale(cross(normal, v), kutta * density * cosine * self.projected_area());
        force = add(force, cross(circulation, v));
        force = add(force, scale(cross(w, v), magnus * density * self.volume()));
        // drag
        let (diameter, resisting) = (self.diameter(), self.angular_drag());
        let moment = norm(std::array::from_fn(|k| w[k] * resisting[k]));
        let turning = self.viscosity * (PI * diameter * diameter * diameter) + density * moment;
        let moving = self.viscosity * (3.0 * PI * diameter) + density * norm(v) * self.linear_drag();
        torque = sub(torque, scale(w, turning));
        force = sub(force, scale(v, moving));
        (torque, force)
    }

    /// Returns the derivatives of torque and force.
    fn slopes(&self) -> FluidDerivatives {
        let mut out = [[0.0; 6]; 6];
        let (w, v, density) = (self.turning, self.moving, self.density);
        let each = [1.0; 3];
        // of a x b by a and by b: minus b crossing, a crossing
        let magnus = self.coefs[4] * density * self.volume();
        add_block(&mut out, (3, 0), &crossing(v), -magnus, each);
        add_block(&mut out, (3, 3), &crossing(w), magnus, each);
        let [mass, moments] = self.added;
        for (row, (of, from), by, to) in [(0, (moments, 0), w, 0), (0, (mass, 3), v, 3), (3, (mass, 3), w, 0)] {
            let carried = if from == 0 { w } else { v };
            let momentum = std::array::from_fn(|k| density * of[k] * carried[k]);
            add_block(&mut out, (row, to), &crossing(momentum), 1.0, each);
            add_block(&mut out, (row, from), &crossing(by), -density, of);
        }
        add_block(&mut out, (3, 3), &self.lift_slopes(), 1.0, each);
        add_block(&mut out, (3, 3), &self.drag_slopes(), 1.0, each);
        add_block(&mut out, (0, 0), &self.torque_slopes(), 1.0, each);
        out
    }

    fn torque_slopes(&self) -> [Vec3; 3] {
        let (w, resisting, diameter) = (self.turning, self.angular_drag(), self.diameter());
        let moment = norm(std::array::from_fn(|k| w[k] * resisting[k]));
        let density = self.density / moment.max(MINVAL);
        let by: Vec3 = std::array::from_fn(|k| -density * w[k] * resisting[k] * resisting[k]);
        let own = dot(w, by) - self.viscosity * (PI * diameter * diameter * diameter);
        std::array::from_fn(|i| std::array::from_fn(|k| w[i] * by[k] + if i == k { own } else { 0.0 }))
    }

    fn drag_slopes(&self) -> [Vec3; 3] {
        let (v, a, [blunt, slender, ..]) = (self.moving, self.weights(), self.coefs);
        let ([outer, inner], speed2) = (self.projection(), dot(v, v));
        let speed = speed2.sqrt();
        let quadratic = -self.density * self.linear_drag() / speed.max(MINVAL);
        let area = PI / (inner * inner * inner * outer).sqrt().max(MINVAL);
        let by: Vec3 = std::array::from_fn(|k| {
            let among: f64 = (0..3).map(|i| a[i] * v[i] * v[i] * (a[k] - a[i])).sum();
            self.density * speed * (blunt - slender) * area * a[k] * v[k] * among
        });
        let viscous = self.viscosity * 3.0 * PI * self.diameter();
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let same = if i == k { 1.0 } else { 0.0 };
                quadratic * (v[i] * v[k] + same * speed2) - v[i] * by[k] - same * viscous
            })
        })
    }

    fn lift_slopes(&self) -> [Vec3; 3] {
        let (v, a) = (self.moving, self.weights());
        let ([outer, inner], speed2) = (self.projection(), dot(v, v));
        let size = PI * self.coefs[3] * self.density / (outer * inner * speed2).sqrt().max(MINVAL);
        let (along, cosine) = (inner / outer.max(MINVAL), inner / speed2.max(MINVAL));
        // the lift is minus the velocity times these, times the size and the root of what is in it
        let apart: Vec3 = std::array::from_fn(|i| (0..3).map(|k| v[k] * v[k] * (a[i] - a[k])).sum());
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let steep = 2.0 * inner * (a[k] - a[i]) + apart[i] * (a[k] * a[k] * along - a[k] + cosine);
                let own = if i == k { apart[i] * inner } else { 0.0 };
                size * (v[i] * v[k] * steep - own)
            })
        })
    }
}
