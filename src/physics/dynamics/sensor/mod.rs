//! MuJoCo's `sensordata`: the values of the model's sensors.

mod between;
mod energy;
mod frame;
mod picture;
mod subtree;
mod touch;

use crate::constraint::ConstraintType;
use crate::math::*;
use crate::model::{DataType, Model, SensorType};
use crate::ray::nearest_geom;
use crate::spatial::{angular, linear, torque_at};
use crate::state::State;

use frame::{frame, spatial_acceleration, spatial_velocity};
use subtree::SubtreeScratch;

/// The working memory of sensors.
#[derive(Clone, Debug, Default)]
pub struct SensorScratch {
    subtrees: SubtreeScratch,
    between: between::DistanceScratch,
}

/// Computes `sensordata` from everything else. `scratch` keeps its memory between steps.
#[doc(alias("mj_sensorPos", "mj_sensorVel", "mj_sensorAcc"))]
pub fn sensors(model: &Model, s: &mut State, scratch: &mut SensorScratch) {
    let needs_subtrees = |kind: &SensorType| matches!(kind, SensorType::SubtreeLinVel | SensorType::SubtreeAngMom);
    if model.sensor_type.iter().any(needs_subtrees) {
        scratch.subtrees.update(model, s);
    }
    let mut data = std::mem::take(&mut s.sensordata);
    for sensor in 0..model.nsensor() {
        let (kind, adr, dim) = (
            model.sensor_type[sensor],
            model.sensor_adr[sensor],
            model.sensor_dim[sensor],
        );
        let (values, cutoff) = (&mut data[adr..adr + dim], model.sensor_cutoff[sensor]);
        match kind {
            SensorType::User => {}
            SensorType::GeomDist | SensorType::GeomNormal | SensorType::GeomFromTo => {
                values.copy_from_slice(&scratch.between.value(model, s, sensor)[..dim]);
                // the cutoff is for the distance
                continue;
            }
            _ => values.copy_from_slice(&value(model, s, &scratch.subtrees, sensor)[..dim]),
        }
        if cutoff > 0.0 {
            match model.sensor_datatype[sensor] {
                DataType::Real => values.iter_mut().for_each(|v| *v = v.clamp(-cutoff, cutoff)),
                DataType::Positive => values.iter_mut().for_each(|v| *v = v.min(cutoff)),
                DataType::Axis | DataType::Quaternion => {}
            }
        }
    }
    s.sensordata = data;
}

/// Returns the value of one sensor, padded with zeros; [`SensorType`] tells the quantities.
fn value(model: &Model, s: &State, scratch: &SubtreeScratch, sensor: usize) -> [f64; 4] {
    use SensorType::*;
    // the clock alone measures no object
    let id = model.sensor_objid[sensor].unwrap_or(0);
    let kind = model.sensor_type[sensor];
    match kind {
        Touch | Accelerometer | Velocimeter | Gyro | Force | Torque | Magnetometer | RangeFinder => {
            on_site(model, s, kind, id)
        }
        JointPos => scalar(s.qpos[model.jnt_qposadr[id]]),
        JointVel => scalar(s.qvel[model.jnt_dofadr[id]]),
        JointActFrc => scalar(s.qfrc_actuator[model.jnt_dofadr[id]]),
        BallQuat => quat_normalize(quat_at(&s.qpos, model.jnt_qposadr[id])),
        BallAngVel => {
            let d = model.jnt_dofadr[id];
            vector([s.qvel[d], s.qvel[d + 1], s.qvel[d + 2]])
        }
        TendonPos => scalar(s.ten_length[id]),
        TendonVel => scalar(s.ten_velocity[id]),
        ActuatorPos => scalar(s.actuator_length[id]),
        ActuatorVel => scalar(s.actuator_velocity[id]),
        ActuatorFrc => scalar(s.actuator_force[id]),
        JointLimitPos | JointLimitVel | JointLimitFrc => scalar(limit(s, ConstraintType::LimitJoint, kind, id)),
        TendonLimitPos | TendonLimitVel | TendonLimitFrc => scalar(limit(s, ConstraintType::LimitTendon, kind, id)),
        FramePos | FrameQuat | FrameXAxis | FrameYAxis | FrameZAxis | FrameLinVel | FrameAngVel | FrameLinAcc
        | FrameAngAcc => frame(model, s, sensor),
        SubtreeCom => vector(s.subtree_com[id]),
        SubtreeLinVel => vector(scratch.linvel[id]),
        SubtreeAngMom => vector(scratch.angmom[id]),
        CamProjection => picture::projection(model, s, id, model.sensor_refid[sensor].unwrap_or(0)),
        EPotential => scalar(energy::potential(model, s)),
        EKinetic => scalar(energy::kinetic(model, s)),
        Clock => scalar(s.time),
        // these are not computed here
        GeomDist | GeomNormal | GeomFromTo | User => scalar(0.0),
    }
}

fn scalar(v: f64) -> [f64; 4] {
    [v, 0.0, 0.0, 0.0]
}

fn vector([x, y, z]: Vec3) -> [f64; 4] {
    [x, y, z, 0.0]
}

/// Returns the value of a sensor that sits on a site, in the frame of the site.
fn on_site(model: &Model, s: &State, kind: SensorType, site: usize) -> [f64; 4] {
    let body = model.site_bodyid[site];
    let (pos, mat) = (s.site_xpos[site], &s.site_xmat[site]);
    let offset = sub(pos, s.subtree_com[model.body_rootid[body]]);
    let world = match kind {
        SensorType::Accelerometer => linear(&spatial_acceleration(s, body, offset)),
        SensorType::Velocimeter => linear(&spatial_velocity(s, body, offset)),
        SensorType::Gyro => angular(&s.cvel[body]),
        SensorType::Force => linear(&s.cfrc_int[body]),
        SensorType::Torque => torque_at(&s.cfrc_int[body], offset),
        SensorType::Magnetometer => model.opt.magnetic,
        SensorType::RangeFinder => {
            let hit = nearest_geom(model, s, pos, column(mat, 2), Some(body));
            return scalar(hit.map_or(-1.0, |hit| hit.distance));
        }
        _ => return scalar(touch::touch(model, s, site)),
    };
    vector(mat_t_vec(mat, world))
}

/// Returns the reading of a limit sensor from the first of its rows; 0 without rows.
fn limit(s: &State, rows: ConstraintType, kind: SensorType, id: usize) -> f64 {
    let Some(block) = s.efc.blocks.iter().find(|b| b.kind == rows && b.id == id) else {
        return 0.0;
    };
    match kind {
        SensorType::JointLimitPos | SensorType::TendonLimitPos => s.efc.pos[block.row] - s.efc.margin[block.row],
        SensorType::JointLimitVel | SensorType::TendonLimitVel => s.efc.vel[block.row],
        _ => s.efc.force[block.row],
    }
}
