//! The constraint rows of a step in Rapier's terms.
//!
//! A row of MuJoCo's formulation asks for the acceleration `aref - R f`, so for the velocity `t - R p` at the end of
//! the step, with `t = vel + h aref` and the impulse `p = h f`. A velocity motor of Rapier with the damping `1 / (h R)`
//! asks for exactly that: joints are held by motors, not by Rapier's own locks and limits, where bounds allow.

use std::f64::consts::PI;

use rapier3d_f64::dynamics::{
    GenericJoint, JointAxesMask, JointLimits, JointMotor, MotorModel, MultibodyDofCoupling, SpringCoefficients,
};
use rapier3d_f64::parry::math::{Pose, Vector};

use crate::RapierSets;
use crate::bodies::RapierBodies;
use mjcf_sim_model::math::*;
use mjcf_sim_model::model::{EqualityKind, Model};
use mjcf_sim_physics::constraint::{Block, ConstraintType, Weld, weld_points};
use mjcf_sim_physics::dynamics::{Articulated, Damping};
use mjcf_sim_physics::state::State;
use mjcf_sim_physics::topology::Topology;

/// Index of the rotation about x among the axes of a joint.
const ANG_X: usize = 3;

/// The target of a row: the velocity at the end of the step, and the compliance, velocity per impulse, with which it yields.
#[derive(Clone, Copy, Debug, Default)]
struct RowTarget {
    velocity: f64,
    compliance: f64,
}

impl RowTarget {
    fn of(s: &State, row: usize, h: f64) -> Self {
        Self {
            velocity: s.efc.vel[row] + h * s.efc.aref[row],
            compliance: s.efc.r[row],
        }
    }

    /// Combines the targets of two rows.
    fn and(self, other: Self) -> Self {
        let (x, y) = (1.0 / self.compliance, 1.0 / other.compliance);
        Self {
            velocity: (x * self.velocity + y * other.velocity) / (x + y),
            compliance: 1.0 / (x + y),
        }
    }

    fn motor(self, h: f64, max_force: f64) -> JointMotor {
        JointMotor {
            target_vel: self.velocity,
            damping: 1.0 / (h * self.compliance),
            max_force,
            model: MotorModel::ForceBased,
            ..JointMotor::default()
        }
    }
}

/// The constraint rows on a single degree of freedom.
#[derive(Clone, Copy, Debug, Default)]
struct DofRows {
    lock: Option<RowTarget>,
    /// Sign of the limit's force, and the target along it.
    limit: Option<(f64, RowTarget)>,
    friction: Option<(f64, RowTarget)>,
}

/// Returns the softness whose constraint force mixing is `ratio` times the inverse effective mass, and its rate of
/// error reduction, 1/s.
pub(super) fn softness(ratio: f64, h: f64) -> (SpringCoefficients<f64>, f64) {
    let x = (1.0 + 1.0 / ratio.max(MINVAL)).sqrt() - 1.0;
    (SpringCoefficients::new(x / (2.0 * PI * h), 1.0), x / (h * (x + 2.0)))
}

/// Working memory for the rows of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct RapierRows {
    dofs: Vec<DofRows>,
    column: Vec<f64>,
    response: Vec<f64>,
}

impl RapierRows {
    /// Sets the motors of the joints to the targets of the rows of `s.efc`. The hooks handle contacts.
    pub fn load(
        &mut self,
        rig: &RapierBodies,
        model: &Model,
        topology: &Topology,
        inertia: &mut Articulated,
        s: &State,
        sets: &mut RapierSets,
    ) {
        let h = model.opt.timestep;
        self.dofs.clear();
        self.dofs.resize(model.nv, DofRows::default());
        self.column.resize(model.nv, 0.0);
        self.response.resize(model.nv, 0.0);
        clear_joints(rig, sets);
        for block in &s.efc.blocks {
            let aim = RowTarget::of(s, block.row, h);
            match (block.kind, block.dof.map(|dof| dof as usize)) {
                // models with it are refused
                (ConstraintType::FrictionTendon, _) => {}
                (ConstraintType::FrictionDof, _) => self.dofs[block.id].friction = Some((block.frictionloss, aim)),
                (ConstraintType::Equality, _) if block.dim == 6 => load_weld(rig, model, s, block, sets),
                (ConstraintType::Equality, Some(dof)) => self.add_lock(dof, aim),
                (ConstraintType::LimitJoint | ConstraintType::LimitTendon, Some(dof)) => {
                    let side = nonzero(topology, s, block).next().map_or(0.0, |(_, v)| v);
                    self.dofs[dof].limit = Some((side, aim));
                }
                (ConstraintType::Equality | ConstraintType::LimitJoint | ConstraintType::LimitTendon, None) => {
                    if let Some(row) = pair(topology, s, block)
                        && let Some(target) = self.target(model, inertia, s, block, row)
                    {
                        couple(rig, row, target, h, sets);
                    }
                }
                (
                    ConstraintType::ContactFrictionless
                    | ConstraintType::ContactPyramidal
                    | ConstraintType::ContactElliptic,
                    _,
                ) => {}
            }
        }
        self.load_links(rig, model, inertia, s, sets);
    }

    /// Sets the motor, the limit and the dry friction of every hinge.
    fn load_links(
        &mut self,
        rig: &RapierBodies,
        model: &Model,
        inertia: &mut Articulated,
        s: &State,
        sets: &mut RapierSets,
    ) {
        let h = model.opt.timestep;
        for link in &rig.links {
            let rows = self.dofs[link.dof];
            let free = s.qvel[link.dof] + h * s.qacc_smooth[link.dof];
            // softness is relative to the effective mass
            let inverse_inertia = if rows.lock.is_some() || rows.limit.is_some() {
                self.quadratic(inertia, s, &[(link.dof, 1.0)])
            } else {
                1.0
            };
            let setting = rows.setting(free, inverse_inertia, h);
            if let Some(id) = sets.multibody_joints.rigid_body_link(link.handle).copied()
                && let Some(multibody) = sets.multibody_joints.get_multibody_mut(id.multibody)
                && let Some(l) = multibody.link_mut(id.id)
            {
                setting.apply(&mut l.joint.data);
                let at = l.assembly_id();
                multibody.frictions_mut()[at] = setting.loss;
            }
        }
    }

    fn add_lock(&mut self, dof: usize, aim: RowTarget) {
        let rows = &mut self.dofs[dof];
        rows.lock = Some(rows.lock.map_or(aim, |other| other.and(aim)));
    }

    /// Computes `J M^-1 J'` of a row with the given entries.
    fn quadratic(&mut self, inertia: &mut Articulated, s: &State, row: &[(usize, f64)]) -> f64 {
        self.column.fill(0.0);
        for &(d, v) in row {
            self.column[d] += v;
        }
        inertia.solve(s, Damping::Without, &self.column, &mut self.response);
        row.iter().map(|&(d, v)| v * self.response[d]).sum()
    }

    /// Returns the velocity that a row on two joints reaches when it is solved alone; `None` for an inactive limit.
    fn target(
        &mut self,
        model: &Model,
        inertia: &mut Articulated,
        s: &State,
        block: &Block,
        row: [(usize, f64); 2],
    ) -> Option<f64> {
        let h = model.opt.timestep;
        let aim = RowTarget::of(s, block.row, h);
        let free: f64 = row.iter().map(|&(d, v)| v * (s.qvel[d] + h * s.qacc_smooth[d])).sum();
        let effective = self.quadratic(inertia, s, &row);
        let impulse = (aim.velocity - free) / (effective + aim.compliance);
        let acts = block.kind == ConstraintType::Equality || impulse > 0.0;
        acts.then_some(aim.velocity - aim.compliance * impulse)
    }
}

/// Removes the couplings and motors of the last step from the joints.
fn clear_joints(rig: &RapierBodies, sets: &mut RapierSets) {
    for tree in rig.trees.iter().filter(|t| t.articulated) {
        if let Some(id) = sets.multibody_joints.rigid_body_link(tree.root).copied()
            && let Some(multibody) = sets.multibody_joints.get_multibody_mut(id.multibody)
        {
            multibody.clear_dof_couplings();
        }
    }
    for weld in &rig.welds {
        if let Some(joint) = sets.impulse_joints.get_mut(weld.handle, false) {
            joint.data.motor_axes = JointAxesMask::empty();
        }
    }
}

/// Sets a row on two joints as a coupling of Rapier, which is stiff and acts both ways: with the target [`RapierRows::target`], it yields as the row
/// should.
fn couple(rig: &RapierBodies, [(d1, j1), (d2, j2)]: [(usize, f64); 2], target: f64, h: f64, sets: &mut RapierSets) {
    let link = |dof: usize| rig.links.iter().find(|l| l.dof == dof);
    let (Some(first), Some(second)) = (link(d1), link(d2)) else {
        return;
    };
    let rate = SpringCoefficients::<f64>::joint_defaults().erp_inv_dt(h);
    let (Some(id1), Some(id2)) = (
        sets.multibody_joints.rigid_body_link(first.handle).copied(),
        sets.multibody_joints.rigid_body_link(second.handle).copied(),
    ) else {
        return;
    };
    if let Some(multibody) = sets.multibody_joints.get_multibody_mut(id1.multibody) {
        multibody.add_dof_coupling(MultibodyDofCoupling {
            link1: id1.id,
            dof1: 0,
            axis1: ANG_X,
            link2: id2.id,
            dof2: 0,
            axis2: ANG_X,
            coeff: -j1 / j2,
            offset: target / (j2 * rate),
        });
    }
}

/// Returns the two entries of a row on two joints: degree of freedom and value.
fn pair(topology: &Topology, s: &State, block: &Block) -> Option<[(usize, f64); 2]> {
    let mut found = nonzero(topology, s, block);
    Some([found.next()?, found.next()?])
}

/// Returns the entries of the first row of a block that are not zero.
fn nonzero(topology: &Topology, s: &State, block: &Block) -> impl Iterator<Item = (usize, f64)> {
    s.efc
        .entries(topology, block)
        .filter(|&(row, _, v)| row == 0 && v != 0.0)
        .map(|(_, d, v)| (d, v))
}

/// The setting of a Rapier joint for a step.
#[derive(Clone, Copy, Debug)]
struct JointSetting {
    motor: Option<JointMotor>,
    limit: Option<JointLimits<f64>>,
    softness: SpringCoefficients<f64>,
    /// Dry friction that the motor does not represent, N m.
    loss: f64,
}

impl JointSetting {
    fn apply(&self, joint: &mut GenericJoint) {
        let axis = |on: bool| {
            if on {
                JointAxesMask::ANG_X
            } else {
                JointAxesMask::empty()
            }
        };
        joint.motor_axes = axis(self.motor.is_some());
        joint.limit_axes = axis(self.limit.is_some());
        joint.motors[ANG_X] = self.motor.unwrap_or_default();
        joint.limits[ANG_X] = self.limit.unwrap_or_default();
        joint.softness = self.softness;
    }
}

impl DofRows {
    /// Returns the motor for a row: `free` is the velocity without constraints, `inverse_inertia` the diagonal of the
    /// inverse inertia.
    ///
    /// A joint of Rapier has one motor, which gives way exactly as a row does, and a limit and dry friction, which
    /// share a softness. The motor stands for a lock, or for a limit that is being run into, or else for the friction.
    fn setting(&self, free: f64, inverse_inertia: f64, h: f64) -> JointSetting {
        let (loss, friction) = self.friction.unwrap_or_default();
        let two_sided = |(side, limit): (f64, RowTarget)| RowTarget {
            velocity: side * limit.velocity,
            ..limit
        };
        let (mut hold, mut push) = (self.lock, None);
        if let Some((side, aim)) = self.limit {
            if let Some(lock) = self.lock {
                hold = Some(lock.and(two_sided((side, aim))));
            } else if aim.velocity > 0.0 {
                push = Some((side, aim));
            } else if side * free < aim.velocity {
                // Rapier's limits only push outwards
                hold = Some(two_sided((side, aim)));
            }
        }
        let compliance = push.map_or(friction.compliance, |(_, aim)| aim.compliance);
        let (softness, rate) = softness(compliance / inverse_inertia, h);
        let limit = push.map(|(side, aim)| {
            let error = aim.velocity / rate;
            let (min, max) = if side > 0.0 {
                (error, f64::MAX)
            } else {
                (-f64::MAX, -error)
            };
            JointLimits { min, max, impulse: 0.0 }
        });
        let free_motor = hold.is_none() && push.is_none();
        JointSetting {
            motor: match hold {
                Some(aim) => Some(aim.motor(h, f64::MAX)),
                None => (free_motor && loss > 0.0).then(|| friction.motor(h, loss)),
            },
            limit,
            softness,
            loss: if free_motor { 0.0 } else { loss },
        }
    }
}

/// Sets the motors of a weld, along the axes of the world at the constrained point of body 2.
fn load_weld(rig: &RapierBodies, model: &Model, s: &State, block: &Block, sets: &mut RapierSets) {
    let h = model.opt.timestep;
    let Some(weld) = weld_points(model, s, block.id) else {
        return;
    };
    let Some(joint) = rig.welds.iter().find(|w| w.equality == block.id) else {
        return;
    };
    let EqualityKind::Weld { body1, body2, .. } = model.eq_kind[block.id] else {
        return;
    };
    let aims: [RowTarget; 6] = std::array::from_fn(|k| RowTarget::of(s, block.row + k, h));
    let inverse = inverse_rate(&weld);
    let angular = mat_vec(&inverse, [aims[3].velocity, aims[4].velocity, aims[5].velocity]);
    let frame = |b: usize, point: Vec3| {
        let place = Pose::from_translation(Vector::new(point[0], point[1], point[2]));
        match model.body_weldid[b] {
            0 => place,
            _ => rig.pose(s, b).inverse() * place,
        }
    };
    if let Some(joint) = sets.impulse_joints.get_mut(joint.handle, false) {
        joint.data.local_frame1 = frame(body2, weld.point2);
        joint.data.local_frame2 = frame(body1, weld.point1);
        for k in 0..6 {
            let aim = if k < 3 {
                aims[k]
            } else {
                let along = row(&inverse, k - 3);
                RowTarget {
                    velocity: angular[k - 3],
                    compliance: dot(along, along) * aims[k].compliance,
                }
            };
            joint.data.motors[k] = aim.motor(h, f64::MAX);
        }
        joint.data.motor_axes = JointAxesMask::all();
    }
}

/// Returns the map from the rate of a weld's rotational error to the relative angular velocity.
fn inverse_rate(weld: &Weld) -> Mat3 {
    let column = |k: usize| {
        let mut axis = [0.0; 3];
        axis[k] = 1.0;
        weld.rotation_rate(axis)
    };
    let (x, y, z) = (column(0), column(1), column(2));
    let det = dot(x, cross(y, z));
    let det = if det.abs() < MINVAL { MINVAL } else { det };
    let (a, b, c) = (cross(y, z), cross(z, x), cross(x, y));
    [a, b, c]
        .map(|v| scale(v, 1.0 / det))
        .concat()
        .try_into()
        .unwrap_or(MAT3_ID)
}

/// Writes the forces of welds to the rows of `s.efc`.
pub(super) fn read_welds(rig: &RapierBodies, model: &Model, s: &mut State, sets: &RapierSets) {
    let h = model.opt.timestep;
    for k in 0..s.efc.blocks.len() {
        let block = s.efc.blocks[k];
        if block.kind != ConstraintType::Equality || block.dim != 6 {
            continue;
        }
        let Some(weld) = weld_points(model, s, block.id) else {
            continue;
        };
        let Some(joint) = rig.welds.iter().find(|w| w.equality == block.id) else {
            continue;
        };
        let Some(joint) = sets.impulse_joints.get(joint.handle) else {
            continue;
        };
        // Rapier reports the impulse that the first body exerts
        let f: [f64; 6] = std::array::from_fn(|k| -joint.data.motors[k].impulse / h);
        let inverse = inverse_rate(&weld);
        let rows = mat_t_vec(&inverse, [f[3], f[4], f[5]]);
        for k in 0..3 {
            s.efc.force[block.row + k] = f[k];
            s.efc.force[block.row + 3 + k] = rows[k];
        }
    }
}
