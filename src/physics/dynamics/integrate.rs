//! Integration: semi-implicit Euler with implicit joint damping, implicit methods, and Runge and Kutta's; activations of actuators.

use super::activation;
use super::articulated::{Articulated, Damping};
use super::derivative::VelocityDerivative;
use super::tree_matrix::TreeMatrix;
use crate::math::{axis_angle_to_quat, quat_at, quat_mul, quat_normalize, unit};
use crate::model::{IntegratorType, Model};
use crate::state::State;
use crate::topology::Topology;

/// Advances a state by one time step.
#[derive(Clone, Debug, Default)]
pub struct Integrator {
    acc: Vec<f64>,
    force: Vec<f64>,
    derivative: VelocityDerivative,
    matrix: TreeMatrix,
}

impl Integrator {
    /// Advances `act, qpos, qvel, time`: `v+ = v + h a`, then `q+ = q (+) h v+`. The acceleration `a` is that of the method,
    /// with `f = qfrc_smooth + qfrc_constraint`:
    ///
    /// - Euler: `(M + h D)^-1 f` with the damping `D` of the joints; without damping `qacc`.
    /// - Implicit: `(M - h d f / d v)^-1 f`; the fast one leaves Coriolis forces out of the derivative.
    ///
    /// `bodies` must be up to date.
    #[doc(alias("mj_Euler", "mj_implicit"))]
    #[inline(always)]
    pub fn advance(&mut self, model: &Model, topology: &Topology, bodies: &mut Articulated, s: &mut State) {
        let h = model.opt.timestep;
        let damped = match model.opt.integrator {
            IntegratorType::Implicit | IntegratorType::ImplicitFast => {
                self.solve_implicit(model, topology, s);
                true
            }
            _ if model.opt.flags.eulerdamp && s.params.dof_damping.iter().any(|&d| d > 0.0) => {
                self.acc.resize(model.nv, 0.0);
                self.force.clear();
                let forces = s.qfrc_smooth.iter().zip(&s.qfrc_constraint);
                self.force.extend(forces.map(|(a, b)| a + b));
                bodies.solve(s, Damping::Implicit, &self.force, &mut self.acc);
                true
            }
            _ => false,
        };
        activation::advance(model, &mut s.act, &s.act_dot);
        let acc = if damped { &self.acc } else { &s.qacc };
        for (v, a) in s.qvel.iter_mut().zip(acc) {
            *v += h * a;
        }
        let State { qpos, qvel, .. } = s;
        integrate_pos(model, qpos, qvel, h);
        s.time += h;
        s.step += 1;
    }

    /// Computes the acceleration of the implicit methods. It is separate from `advance`, which is compiled twice.
    #[inline(never)]
    fn solve_implicit(&mut self, model: &Model, topology: &Topology, s: &State) {
        let bias = model.opt.integrator == IntegratorType::Implicit;
        self.derivative.fill(model, topology, s, bias, &mut self.matrix);
        self.matrix.subtract_from(topology, &s.qm, model.opt.timestep);
        self.matrix.factor(topology);
        self.acc.clear();
        let forces = s.qfrc_smooth.iter().zip(&s.qfrc_constraint);
        self.acc.extend(forces.map(|(a, b)| a + b));
        self.matrix.solve(topology, &mut self.acc);
    }
}

/// The fourth-order method of Runge and Kutta: the intermediate states and their derivatives.
#[derive(Clone, Debug, Default)]
pub struct RungeKutta {
    qpos: Vec<f64>,
    /// Velocities and accelerations at the evaluations so far, one after another (4 nv each).
    qvel: Vec<f64>,
    qacc: Vec<f64>,
    /// Their weighted sums (nv).
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    /// Activations at the start (na), and the weighted sum of their rates so far.
    act: Vec<f64>,
    act_dot: Vec<f64>,
}

/// Times of the evaluations after the first, in time steps. Each follows the slope of the one before it.
const STAGES: [f64; 3] = [0.5, 0.5, 1.0];
/// The weights of the slopes in the step.
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

impl RungeKutta {
    /// Advances `qpos, qvel, time` from a state that `evaluate` has already computed. `evaluate` computes accelerations from
    /// positions and velocities.
    ///
    /// As in MuJoCo, everything that `evaluate` computes is afterwards that of the last evaluation. It does not change the sensors and what they
    /// read, so that these stay those of the start.
    #[doc(alias = "mj_RungeKutta")]
    pub fn advance<E>(
        &mut self,
        model: &Model,
        s: &mut State,
        mut evaluate: impl FnMut(&mut State) -> Result<(), E>,
    ) -> Result<(), E> {
        let (h, nv, start) = (model.opt.timestep, model.nv, s.time);
        self.qpos.clone_from(&s.qpos);
        self.act.clone_from(&s.act);
        self.act_dot.clear();
        self.act_dot.extend(s.act_dot.iter().map(|rate| WEIGHTS[0] * rate));
        self.qvel.clear();
        self.qacc.clear();
        self.velocity.resize(nv, 0.0);
        self.acceleration.resize(nv, 0.0);
        for (stage, weight) in STAGES.into_iter().zip(&WEIGHTS[1..]) {
            self.qvel.extend_from_slice(&s.qvel);
            self.qacc.extend_from_slice(&s.qacc);
            for d in 0..nv {
                self.velocity[d] = stage * s.qvel[d];
                self.acceleration[d] = stage * s.qacc[d];
            }
            self.set(model, s, h);
            // on the way activations go straight on, without limits: those are for the end
            for ((act, from), rate) in s.act.iter_mut().zip(&self.act).zip(&s.act_dot) {
                *act = from + stage * h * rate;
            }
            s.time = start + stage * h;
            evaluate(s)?;
            for (sum, rate) in self.act_dot.iter_mut().zip(&s.act_dot) {
                *sum += weight * rate;
            }
        }
        self.qvel.extend_from_slice(&s.qvel);
        self.qacc.extend_from_slice(&s.qacc);
        self.velocity.fill(0.0);
        self.acceleration.fill(0.0);
        for (k, weight) in WEIGHTS.into_iter().enumerate() {
            for d in 0..nv {
                self.velocity[d] += weight * self.qvel[k * nv + d];
                self.acceleration[d] += weight * self.qacc[k * nv + d];
            }
        }
        self.set(model, s, h);
        s.act.clone_from(&self.act);
        activation::advance(model, &mut s.act, &self.act_dot);
        s.time = start + h;
        s.step += 1;
        Ok(())
    }

    /// Sets positions and velocities to those at the start, advanced by `h` with the sums.
    fn set(&self, model: &Model, s: &mut State, h: f64) {
        s.qpos.clone_from(&self.qpos);
        integrate_pos(model, &mut s.qpos, &self.velocity, h);
        for (d, v) in s.qvel.iter_mut().enumerate() {
            *v = self.qvel[d] + h * self.acceleration[d];
        }
    }
}

/// Computes `qpos (+)= h qvel`; quaternions turn by the body-frame angular velocity.
#[doc(alias = "mj_integratePos")]
#[inline(always)]
pub fn integrate_pos(model: &Model, qpos: &mut [f64], qvel: &[f64], h: f64) {
    for j in 0..model.njnt() {
        let (q, d) = (model.jnt_qposadr[j], model.jnt_dofadr[j]);
        let kind = model.jnt_type[j];
        let Some(at) = kind.quat(q) else {
            qpos[q] += h * qvel[d];
            continue;
        };
        let turning = d + kind.nv() - 3;
        for k in 0..turning - d {
            qpos[q + k] += h * qvel[d + k];
        }
        let (axis, speed) = unit([qvel[turning], qvel[turning + 1], qvel[turning + 2]]);
        let quat = quat_normalize(quat_at(qpos, at));
        let turned = quat_mul(quat, axis_angle_to_quat(axis, h * speed));
        qpos[at..at + 4].copy_from_slice(&turned);
    }
}
