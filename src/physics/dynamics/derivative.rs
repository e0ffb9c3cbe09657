//! Derivatives of the smooth forces by the velocities, for the implicit integrators.

use super::ellipsoid::{swim_slopes, swims};
use super::fluid::medium_slopes;
use super::tree_matrix::TreeMatrix;
use super::{muscle, transmission};
use crate::body_simple::is_simple;
use crate::math::*;
use crate::model::{BiasType, GainType, IntegratorType, Model};
use crate::spatial::*;
use crate::state::State;
use crate::topology::Topology;

/// Computes `d (qfrc_actuator + qfrc_passive - qfrc_bias) / d qvel`; holds the working memory.
///
/// As in MuJoCo, what does not fit the pattern of the tree is left out: a tendon's damping between joints of which neither is above the
/// other; without bias forces, also what a body alone in the world has beside the diagonal.
#[derive(Clone, Debug, Default)]
pub(super) struct VelocityDerivative {
    /// Derivatives of velocity, acceleration and force of each body by one coordinate.
    velocity: Vec<Spatial>,
    acc: Vec<Spatial>,
    force: Vec<Spatial>,
    /// Entries of one row of a Jacobian.
    entries: Vec<(usize, f64)>,
    /// Entries of six rows of a Jacobian.
    rows: Vec<(usize, Spatial)>,
}

impl VelocityDerivative {
    /// Fills `out`; the bias forces count only if `bias` is set.
    #[doc(alias = "mjd_smooth_vel")]
    pub fn fill(&mut self, model: &Model, topology: &Topology, s: &State, bias: bool, out: &mut TreeMatrix) {
        out.clear(topology);
        if model.opt.flags.actuation {
            self.actuators(model, topology, s, out);
        }
        if model.opt.flags.passive {
            self.passive(model, topology, s, out);
        }
        if bias {
            self.bias(model, topology, s, out);
            return;
        }
        // the pattern of `implicitfast` is that of the inertia, which MuJoCo takes for diagonal there
        for b in (1..model.nbody()).filter(|&b| model.body_dofnum[b] > 1 && is_simple(model, b)) {
            for d in model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b] {
                out.keep_diagonal(topology, d);
            }
        }
    }

    /// Adds the velocity terms of gains and biases.
    fn actuators(&mut self, model: &Model, topology: &Topology, s: &State, out: &mut TreeMatrix) {
        for i in 0..model.nu() {
            let slope = force_slope(model, s, i);
            if slope == 0.0 {
                continue;
            }
            let muscle = s.muscle_torque.get(i).is_some() && model.actuator_biastype[i] == BiasType::None;
            let gear = if muscle { 1.0 } else { s.params.actuator_gear[i] };
            self.entries.clear();
            let entries = &mut self.entries;
            transmission::moment(model, topology, s, (i, gear), |d, arm| entries.push((d, arm)));
            out.add_square(topology, &self.entries, slope);
        }
    }

    /// Adds the damping of joints, edges of flexes and tendons, and the resistance of the medium.
    fn passive(&mut self, model: &Model, topology: &Topology, s: &State, out: &mut TreeMatrix) {
        for (d, damping) in s.params.dof_damping.iter().enumerate() {
            out.add(topology, d, d, -damping);
        }
        for flex in model
            .flexes
            .iter()
            .filter(|flex| !flex.rigid && flex.edgedamping != 0.0)
        {
            for (k, _) in flex.edge_rigid.iter().enumerate().filter(|(_, rigid)| !**rigid) {
                let e = flex.edgeadr + k;
                let arms = &s.flexedge_j[topology.flexedges.range(e)];
                self.damper(topology, topology.flexedges.row(e), arms, -flex.edgedamping, out);
            }
        }
        for (t, damping) in model.tendon_damping.iter().enumerate() {
            if *damping > 0.0 {
                let arms = &s.ten_j[topology.tendons.range(t)];
                self.damper(topology, topology.tendons.row(t), arms, -damping, out);
            }
        }
        if model.opt.density == 0.0 && model.opt.viscosity == 0.0 {
            return;
        }
        for b in 1..model.nbody() {
            if s.params.body_mass[b] < MINVAL {
                continue;
            }
            if swims(model, b) {
                let symmetric = model.opt.integrator == IntegratorType::ImplicitFast;
                swim_slopes(model, topology, s, (b, symmetric), &mut self.rows, out);
                continue;
            }
            let slopes = medium_slopes(model, s, b);
            let offset = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
            for (k, slope) in slopes.into_iter().enumerate() {
                let along = |&d: &u32| {
                    let cdof = &s.cdof[d as usize];
                    let motion = if k < 3 {
                        angular(cdof)
                    } else {
                        velocity_at(cdof, offset)
                    };
                    (d as usize, mat_t_vec(&s.ximat[b], motion)[k % 3])
                };
                self.entries.clear();
                self.entries.extend(topology.body_chain(b).iter().map(along));
                out.add_square(topology, &self.entries, slope);
            }
        }
    }

    /// Adds the resistance to changes of a length, whose derivatives by coordinates are `arms`.
    fn damper(&mut self, topology: &Topology, dofs: &[u32], arms: &[f64], slope: f64, out: &mut TreeMatrix) {
        self.entries.clear();
        let entries = dofs.iter().zip(arms).map(|(&d, &arm)| (d as usize, arm));
        self.entries.extend(entries);
        out.add_square(topology, &self.entries, slope);
    }

    /// Subtracts the derivative of Coriolis and centrifugal forces: the recursive Newton-Euler algorithm, differentiated by one coordinate after
    /// another. Each coordinate moves only the bodies below it.
    fn bias(&mut self, model: &Model, topology: &Topology, s: &State, out: &mut TreeMatrix) {
        for values in [&mut self.velocity, &mut self.acc, &mut self.force] {
            values.resize(model.nbody(), [0.0; 6]);
        }
        for k in 0..model.nv {
            let first = model.dof_bodyid[k];
            let below = (first + 1..model.nbody()).find(|&b| model.body_parentid[b] < first);
            let bodies = first..below.unwrap_or(model.nbody());
            for b in bodies.clone() {
                let from = (b > first).then(|| model.body_parentid[b]);
                self.body(model, s, (k, b), from);
            }
            for b in (first + 1..bodies.end).rev() {
                let f = self.force[b];
                axpy6(&mut self.force[model.body_parentid[b]], 1.0, &f);
            }
            let chain = topology.dof_chain(k);
            let place = chain.len() - 1;
            for (a, &d) in chain[..place].iter().enumerate() {
                out.add_upper(topology, k, a, -dot6(&s.cdof[d as usize], &self.force[first]));
            }
            for b in bodies {
                let dofs = model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b];
                for d in dofs.filter(|&d| d >= k) {
                    out.add_lower(topology, d, place, -dot6(&s.cdof[d], &self.force[b]));
                }
            }
        }
    }

    /// Computes the derivatives of a body by the velocity of coordinate `k`, from those of its parent if that moves with it.
    fn body(&mut self, model: &Model, s: &State, (k, b): (usize, usize), parent: Option<usize>) {
        let (mut v, mut a) = parent.map_or(([0.0; 6], [0.0; 6]), |p| (self.velocity[p], self.acc[p]));
        for j in model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b] {
            let (start, count) = (model.jnt_dofadr[j], model.jnt_type[j].nv());
            // the axes of translation of a free joint stand still; those of rotation all turn with what is before them
            let (turning, end) = (start + count.saturating_sub(3), start + count);
            if (start..turning).contains(&k) {
                axpy6(&mut v, 1.0, &s.cdof[k]);
            }
            for d in turning..end {
                axpy6(&mut a, s.qvel[d], &cross_motion(&v, &s.cdof[d]));
            }
            if (turning..end).contains(&k) {
                axpy6(&mut a, 1.0, &s.cdof_dot[k]);
                axpy6(&mut v, 1.0, &s.cdof[k]);
            }
        }
        let inertia = &s.cinert[b];
        let mut f = inertia_mul(inertia, &a);
        axpy6(&mut f, 1.0, &cross_force(&v, &inertia_mul(inertia, &s.cvel[b])));
        axpy6(&mut f, 1.0, &cross_force(&s.cvel[b], &inertia_mul(inertia, &v)));
        (self.velocity[b], self.acc[b], self.force[b]) = (v, a, f);
    }
}

/// Returns the derivative of an actuator's force by the rate of its length, which MuJoCo 3.3.0 also uses if the force is at its limit.
fn force_slope(model: &Model, s: &State, i: usize) -> f64 {
    if model.actuator_disabled(i) {
        return 0.0;
    }
    let mut slope = match model.actuator_biastype[i] {
        // MuJoCo's does not depend on the velocity
        BiasType::None | BiasType::Muscle => 0.0,
        BiasType::Affine => model.actuator_biasprm[i][2],
    };
    let gain = match model.actuator_gaintype[i] {
        GainType::Fixed => 0.0,
        GainType::Affine => model.actuator_gainprm[i][2],
        GainType::Muscle => muscle::gain_slope(model, i, s.actuator_length[i], s.actuator_velocity[i]),
    };
    if gain != 0.0 {
        // the control as it is given, not as it is clamped, and the activation at the start of the step: so MuJoCo has it
        let ctrl = match model.actuator_actadr[i] {
            Some(k) => s.act[k],
            None => s.ctrl[i],
        };
        let torque = s.muscle_torque.get(i).copied();
        let muscle = torque.filter(|_| model.actuator_biastype[i] == BiasType::None);
        slope += gain * ctrl * muscle.unwrap_or(1.0);
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;
    use crate::{Engine, SoftEngine, SoftOptions, compile};

    /// A free body with branching limbs, dampers, a medium, tendons along a limb, actuators with velocity terms.
    const LIMBS: &str = r#"<mujoco><option density="300" viscosity="2" wind="0.3 0.1 0"><flag contact="disable"/></option><worldbody><site name="fixed" pos=".1 -.5 .8"/>
        <body pos="0 0 1"><freejoint/><geom type="box" size=".1 .2 .05" density="300"/><geom name="ball" size=".05"/>
          <body pos=".2 0 .1"><joint name="a" axis="0 1 0" damping=".3"/><joint name="b" axis="1 0 0"/><geom type="capsule" size=".04 .1" fluidshape="ellipsoid" fluidcoef=".6 .3 1.2 .8 .5"/>
            <body pos=".2 0 0"><joint name="c" axis="0 0 1"/><geom type="box" size=".05 .02 .1" pos=".1 0 0" fluidshape="ellipsoid"/><site name="end" pos=".2 0 0"/></body>
          </body>
          <body pos="-.2 0 .1"><joint name="d" type="slide" axis="1 0 0"/><joint name="e"/><geom type="box" size=".03 .1 .06" pos=".1 0 0"/></body>
        </body></worldbody>
        <tendon><fixed name="t" damping="1.5"><joint joint="a" coef="1"/><joint joint="c" coef="-.5"/></fixed>
          <spatial name="s" damping="2"><site site="fixed"/><geom geom="ball"/><site site="end"/></spatial></tendon>
        <actuator><position joint="b" kp="3" kv=".4" gear="2"/><damper joint="d" kv="2" ctrlrange="0 1"/><velocity tendon="t" kv=".7"/>
          <general joint="e" dyntype="integrator" gaintype="affine" gainprm="1 0 .5" biastype="affine" biasprm="0 0 -.3"/>
          <muscle tendon="s" lengthrange=".4 1.6"/><motor site="end" refsite="fixed" gear="1 2 3 .1 .2 .3"/>
        </actuator></mujoco>"#;

    fn engine() -> SoftEngine {
        let spec = load_str(LIMBS, "limbs.xml", &MemoryAssets::new()).expect("valid");
        SoftEngine::new(compile(spec).expect("valid").into(), SoftOptions::default())
    }

    /// A state in which everything moves.
    fn moving(engine: &SoftEngine) -> State {
        let mut s = engine.new_state();
        for (k, v) in s.qvel.iter_mut().enumerate() {
            *v = 0.7 * (k % 5) as f64 - 1.1;
        }
        for (k, q) in s.qpos.iter_mut().enumerate().skip(7) {
            *q = 0.2 * (k % 4) as f64 - 0.35;
        }
        s.ctrl = vec![0.3, 0.8, 0.2, 0.5, 0.9, 0.1];
        s.act = vec![0.4, 0.7];
        s
    }

    fn forces(engine: &mut SoftEngine, s: &mut State) -> Vec<f64> {
        engine.forward(s).expect("finite");
        let parts = s.qfrc_passive.iter().zip(&s.qfrc_actuator).zip(&s.qfrc_bias);
        parts.map(|((p, a), b)| p + a - b).collect()
    }

    /// Returns a state in motion, and the derivative there.
    fn filled() -> (SoftEngine, State, Topology, TreeMatrix) {
        let mut engine = engine();
        let mut s = moving(&engine);
        forces(&mut engine, &mut s);
        let topology = Topology::new(engine.model());
        let (mut derivative, mut matrix) = (VelocityDerivative::default(), TreeMatrix::default());
        derivative.fill(engine.model(), &topology, &s, true, &mut matrix);
        (engine, s, topology, matrix)
    }

    #[test]
    fn it_is_the_slope_of_the_forces() {
        let (mut engine, _, topology, matrix) = filled();
        let nv = engine.model().nv;
        let mut worst = 0.0_f64;
        for col in 0..nv {
            let mut slope = |step: f64| {
                let mut s = moving(&engine);
                s.qvel[col] += step;
                forces(&mut engine, &mut s)
            };
            let eps = 1e-5;
            let (up, down) = (slope(eps), slope(-eps));
            for row in 0..nv {
                let numeric = (up[row] - down[row]) / (2.0 * eps);
                let entry = matrix.entry(&topology, row, col);
                worst = worst.max((entry - numeric).abs() / (1.0 + numeric.abs()));
            }
        }
        assert!(worst < 1e-7, "{worst:e}");
    }

    #[test]
    fn factors_solve_the_matrix() {
        let (engine, s, topology, mut matrix) = filled();
        matrix.subtract_from(&topology, &s.qm, 0.01);
        let nv = engine.model().nv;
        let expected: Vec<f64> = (0..nv).map(|d| (d % 7) as f64 - 3.0).collect();
        let row = |row: usize| {
            (0..nv)
                .map(|col| matrix.entry(&topology, row, col) * expected[col])
                .sum::<f64>()
        };
        let mut x: Vec<f64> = (0..nv).map(row).collect();
        assert!(
            (matrix.entry(&topology, 6, 1) - matrix.entry(&topology, 1, 6)).abs() > 1e-6,
            "not symmetric"
        );
        matrix.factor(&topology);
        matrix.solve(&topology, &mut x);
        let worst = x.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-10, "{worst:e}");
    }
}
