//! Semi-implicit Euler with implicit joint damping.

use crate::math::{axis_angle_to_quat, quat_mul, quat_normalize, unit};
use crate::model::{JointType, Model};
use crate::physics::dynamics::articulated::{Articulated, Damping};
use crate::physics::state::State;

/// Advances a state by one time step.
#[derive(Clone, Debug, Default)]
pub struct Integrator {
    force: Vec<f64>,
    acc: Vec<f64>,
}

impl Integrator {
    /// Advances `qpos, qvel, time`: `v+ = v + h (M + h D)^-1 (qfrc_smooth + qfrc_constraint)`, then `q+ = q (+) h v+`;
    /// without damping `v+ = v + h qacc`. `bodies` must be up to date.
    #[inline(always)]
    pub fn advance(&mut self, model: &Model, bodies: &mut Articulated, s: &mut State) {
        let h = model.opt.timestep;
        if s.params.dof_damping.iter().any(|&d| d > 0.0) {
            self.acc.resize(model.nv, 0.0);
            self.force.clear();
            let forces = s.qfrc_smooth.iter().zip(&s.qfrc_constraint);
            self.force.extend(forces.map(|(a, b)| a + b));
            bodies.solve(model, s, Damping::Implicit, &self.force, &mut self.acc);
            for (v, a) in s.qvel.iter_mut().zip(&self.acc) {
                *v += h * a;
            }
        } else {
            for (v, a) in s.qvel.iter_mut().zip(&s.qacc) {
                *v += h * a;
            }
        }
        let State { qpos, qvel, .. } = s;
        integrate_pos(model, qpos, qvel, h);
        s.time += h;
        s.step += 1;
    }
}

/// Computes `qpos (+)= h qvel`; quaternions turn by the body-frame angular velocity.
#[inline(always)]
pub fn integrate_pos(model: &Model, qpos: &mut [f64], qvel: &[f64], h: f64) {
    for j in 0..model.njnt() {
        let (q, d) = (model.jnt_qposadr[j], model.jnt_dofadr[j]);
        if model.jnt_type[j] == JointType::Free {
            for k in 0..3 {
                qpos[q + k] += h * qvel[d + k];
            }
            let (axis, speed) = unit([qvel[d + 3], qvel[d + 4], qvel[d + 5]]);
            let quat = quat_normalize([qpos[q + 3], qpos[q + 4], qpos[q + 5], qpos[q + 6]]);
            let turned = quat_mul(quat, axis_angle_to_quat(axis, h * speed));
            qpos[q + 3..q + 7].copy_from_slice(&turned);
        } else {
            qpos[q] += h * qvel[d];
        }
    }
}
