//! The sensors of the model.

use crate::math::*;
use crate::model::{Model, SensorType};
use crate::physics::State;
use crate::physics::spatial::{angular, torque_at, velocity_at};

/// All sensors, three values each, in the order of the model (`nsensordata`).
pub fn sensordata(model: &Model, s: &State, out: &mut [f64]) {
    for (sensor, values) in out.chunks_exact_mut(3).enumerate().take(model.nsensor()) {
        values.copy_from_slice(&sensor_value(model, s, sensor));
    }
}

/// Value of one sensor, in the frame of its site, at the start of the last step.
///
/// - Accelerometer: acceleration of the site minus gravity, m/s^2.
/// - Gyro: angular velocity, rad/s.
/// - Torque: torque about the site that the parent exerts on the site's body, N m.
pub fn sensor_value(model: &Model, s: &State, sensor: usize) -> Vec3 {
    let site = model.sensor_objid[sensor];
    let body = model.site_bodyid[site];
    let (pos, mat) = (s.site_xpos[site], &s.site_xmat[site]);
    let offset = sub(pos, s.subtree_com[model.body_rootid[body]]);
    let world = match model.sensor_type[sensor] {
        SensorType::Accelerometer => {
            let (v, a) = (&s.cvel[body], &s.cacc[body]);
            add(velocity_at(a, offset), cross(angular(v), velocity_at(v, offset)))
        }
        SensorType::Gyro => angular(&s.cvel[body]),
        SensorType::Torque => torque_at(&s.cfrc_int[body], offset),
    };
    mat_t_vec(mat, world)
}
