//! Transmission of actuators: their lengths, and how these change with the coordinates.

use crate::math::*;
use crate::model::{Arrays, JointType, TrnType};
use crate::spatial::{Spatial, angular, velocity_at};
use crate::state::State;
use crate::topology::Topology;

/// Returns the gear of an actuator: the ratio of its length to the coordinate that it acts on. Muscles of an actuation model act on joints
/// directly.
pub(super) fn gear(s: &State, actuator: usize) -> f64 {
    if s.muscle_torque.is_empty() {
        s.params.actuator_gear[actuator]
    } else {
        1.0
    }
}

/// Returns the length of an actuator with a gear.
#[inline(always)]
pub(super) fn length(model: &Arrays, topology: &Topology, s: &State, actuator: usize, gear: f64) -> f64 {
    match topology.actuator_scalar[actuator] {
        Some([q, _]) => gear * s.qpos[q as usize],
        None if model.actuator_trntype[actuator] == TrnType::Tendon => {
            gear * s.ten_length[model.actuator_trnid[actuator]]
        }
        // from the position stage, with the gear
        None => s.actuator_length[actuator],
    }
}

/// Returns the rate of [`length`].
#[inline(always)]
pub(super) fn velocity(model: &Arrays, topology: &Topology, s: &State, actuator: usize, gear: f64) -> f64 {
    // what adds nothing to a zero of either sign
    let mut rate = -0.0;
    moment(model, topology, s, (actuator, gear), |d, arm| rate += arm * s.qvel[d]);
    rate
}

/// Calls `each` with the degrees of freedom that an actuator with a gear acts on, and the derivative of [`length`] by each.
#[inline(always)]
pub(super) fn moment(
    model: &Arrays,
    topology: &Topology,
    s: &State,
    (actuator, gear): (usize, f64),
    mut each: impl FnMut(usize, f64),
) {
    // nearly all actuators act on a hinge
    if let Some([_, d]) = topology.actuator_scalar[actuator] {
        return each(d as usize, gear);
    }
    let id = model.actuator_trnid[actuator];
    let (rows, k, arms, gear) = match model.actuator_trntype[actuator] {
        TrnType::Tendon => (&topology.tendons, id, &s.ten_j, gear),
        _ => (&topology.actuators, actuator, &s.actuator_moment, 1.0),
    };
    for (&d, &arm) in rows.row(k).iter().zip(&arms[rows.range(k)]) {
        each(d as usize, gear * arm);
    }
}

/// Computes the derivative of an actuator's length by the degrees of freedom (nv).
#[doc(alias = "actuator_moment")]
pub fn dense_moment(model: &Arrays, topology: &Topology, s: &State, actuator: usize, out: &mut [f64]) {
    out.fill(0.0);
    let gear = s.params.actuator_gear[actuator];
    moment(model, topology, s, (actuator, gear), |d, arm| out[d] += arm);
}

/// Computes lengths and moments of actuators on ball joints, free joints, sites, slider-cranks and contacts: `actuator_length`, `actuator_moment`. Poses, `cdof`
/// and contacts with their rows must be up to date.
#[doc(alias = "mj_transmission")]
#[inline(always)]
pub fn transmissions(model: &Arrays, topology: &Topology, s: &mut State) {
    for &i in &topology.own_moments {
        own(model, topology, s, i);
    }
}

/// Computes one of them; separate from the code that is compiled twice.
#[inline(never)]
fn own(model: &Arrays, topology: &Topology, s: &mut State, i: usize) {
    let row = topology.actuators.range(i);
    s.actuator_moment[row.clone()].fill(0.0);
    let mut arms = std::mem::take(&mut s.actuator_moment);
    let mut moment = TransmissionMoment {
        model,
        topology,
        dofs: topology.actuators.row(i),
        arms: &mut arms[row],
    };
    s.actuator_length[i] = match (model.actuator_trntype[i], model.actuator_refid[i]) {
        (TrnType::SliderCrank, Some(slider)) => moment.crank(s, i, slider),
        (TrnType::Site, Some(reference)) => moment.between(s, i, reference),
        (TrnType::Site, None) => moment.at_site(s, i),
        (TrnType::Joint | TrnType::JointInParent, _) => moment.turning(s, i),
        _ => moment.contacts(s, model.actuator_trnid[i]),
    };
    s.actuator_moment = arms;
}

/// Accumulates the moment arms of an actuator.
struct TransmissionMoment<'a> {
    model: &'a Arrays,
    topology: &'a Topology,
    dofs: &'a [u32],
    arms: &'a mut [f64],
}

impl TransmissionMoment<'_> {
    /// Adds the contributions of motion axes to the entries of some degrees of freedom, in ascending order.
    fn add(&mut self, s: &State, chain: &[u32], arm: impl Fn(&Spatial) -> f64) {
        let mut place = 0;
        for &d in chain {
            while self.dofs[place] < d {
                place += 1;
            }
            self.arms[place] += arm(&s.cdof[d as usize]);
        }
    }

    /// Returns the offset of a point of a body from the centre to which its motion axes refer.
    fn offset(&self, s: &State, body: usize, point: Vec3) -> Vec3 {
        sub(point, s.subtree_com[self.model.body_rootid[body]])
    }

    /// Returns the gears of an actuator, translation and rotation.
    fn gears(&self, s: &State, i: usize) -> [Vec3; 2] {
        let [_, y, z, rotation @ ..] = self.model.actuator_gear6[i];
        [[s.params.actuator_gear[i], y, z], rotation]
    }

    /// Turns a ball joint, whose length is its rotation vector along the gears, or pushes and turns a free joint, which has no length. The gears are
    /// in the axes of the body, or in those from which it turns.
    fn turning(&mut self, s: &State, i: usize) -> f64 {
        let (model, joint) = (self.model, self.model.actuator_trnid[i]);
        let Some(at) = model.jnt_type[joint].quat(model.jnt_qposadr[joint]) else {
            return 0.0;
        };
        let [first, second] = self.gears(s, i);
        let quat = quat_normalize(quat_at(&s.qpos, at));
        let turned = |gear: Vec3| match model.actuator_trntype[i] {
            TrnType::JointInParent => quat_rotate(quat_conj(quat), gear),
            _ => gear,
        };
        if model.jnt_type[joint] == JointType::Ball {
            let gear = turned(first);
            self.arms.copy_from_slice(&gear);
            return dot(rotation_between(QUAT_ID, quat), gear);
        }
        let (pushing, turning) = self.arms.split_at_mut(3);
        pushing.copy_from_slice(&first);
        turning.copy_from_slice(&turned(second));
        0.0
    }

    /// Applies a wrench in the frame of a site, which has no length.
    fn at_site(&mut self, s: &State, i: usize) -> f64 {
        let site = self.model.actuator_trnid[i];
        let [force, torque] = self.gears(s, i).map(|gear| mat_vec(&s.site_xmat[site], gear));
        let body = self.model.site_bodyid[site];
        let offset = self.offset(s, body, s.site_xpos[site]);
        self.add(s, self.topology.body_chain(body), |axis| {
            dot(velocity_at(axis, offset), force) + dot(angular(axis), torque)
        });
        0.0
    }

    /// Moves a site in the frame of another one; returns its displacement along the gears.
    fn between(&mut self, s: &State, i: usize, reference: usize) -> f64 {
        let site = self.model.actuator_trnid[i];
        let gears = self.gears(s, i);
        let frame = &s.site_xmat[reference];
        let bodies = [site, reference].map(|site| self.model.site_bodyid[site]);
        let points = [s.site_xpos[site], s.site_xpos[reference]];
        let mut length = 0.0;
        if gears[0] != [0.0; 3] {
            length += dot(mat_t_vec(frame, sub(points[0], points[1])), gears[0]);
        }
        if gears[1] != [0.0; 3] {
            // MuJoCo has the frames of the sites before those of their bodies
            let [own, other] = [site, reference].map(|site| {
                let body = self.model.site_bodyid[site];
                quat_mul(self.model.site_quat[site], s.xquat[body])
            });
            length += dot(rotation_between(other, own), gears[1]);
        }
        let [force, torque] = gears.map(|gear| mat_vec(frame, gear));
        let (moved, held) = self.topology.apart(bodies[0], bodies[1]);
        for (k, chain) in [moved, held].into_iter().enumerate() {
            let offset = self.offset(s, bodies[k], points[k]);
            let sign = if k == 0 { 1.0 } else { -1.0 };
            self.add(s, chain, |axis| {
                sign * (dot(velocity_at(axis, offset), force) + dot(angular(axis), torque))
            });
        }
        length
    }

    /// Moves a slider along its axis, at the end of a rod from a crank; returns its position relative to the crank. If the slider is out of reach,
    /// the rod is perpendicular to the axis.
    fn crank(&mut self, s: &State, i: usize, slider: usize) -> f64 {
        let (site, rod, gear) = (
            self.model.actuator_trnid[i],
            self.model.actuator_cranklength[i],
            s.params.actuator_gear[i],
        );
        let axis = column(&s.site_xmat[slider], 2);
        let way = sub(s.site_xpos[site], s.site_xpos[slider]);
        let along = dot(way, axis);
        let square = along * along + rod * rod - dot(way, way);
        // the length, and its derivatives by `way` and `axis`
        let (length, by_way, by_axis) = if square <= 0.0 {
            (along, axis, way)
        } else {
            let root = square.sqrt();
            let share = 1.0 - along / root;
            (
                along - root,
                add_scaled(scale(axis, share), way, 1.0 / root),
                scale(way, share),
            )
        };
        let bodies = [site, slider].map(|site| self.model.site_bodyid[site]);
        let offsets = [site, slider].map(|site| self.offset(s, self.model.site_bodyid[site], s.site_xpos[site]));
        self.add(s, self.topology.body_chain(bodies[0]), |cdof| {
            gear * dot(velocity_at(cdof, offsets[0]), by_way)
        });
        self.add(s, self.topology.body_chain(bodies[1]), |cdof| {
            let turned = dot(cross(angular(cdof), axis), by_axis);
            gear * (turned - dot(velocity_at(cdof, offsets[1]), by_way))
        });
        gear * length
    }

    /// Presses the contacts of a body together: the mean over their normals, including contacts in the gap.
    fn contacts(&mut self, s: &State, body: usize) -> f64 {
        let mut count = 0.0;
        for contact in &s.contact {
            let bodies = contact.geom.map(|g| self.model.geom_bodyid[g]);
            let acts = contact.efc_address.is_some() || contact.dist >= contact.includemargin;
            if !acts || !bodies.contains(&body) {
                continue;
            }
            count += 1.0;
            let normal = row(&contact.frame, 0);
            let (first, second) = self.topology.apart(bodies[0], bodies[1]);
            for (k, chain) in [first, second].into_iter().enumerate() {
                let offset = self.offset(s, bodies[k], contact.pos);
                let sign = if k == 0 { -1.0 } else { 1.0 };
                self.add(s, chain, |axis| sign * dot(velocity_at(axis, offset), normal));
            }
        }
        if count > 0.0 {
            self.arms.iter_mut().for_each(|arm| *arm *= -1.0 / count);
        }
        0.0
    }
}
