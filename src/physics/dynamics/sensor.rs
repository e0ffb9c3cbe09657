//! MuJoCo's `sensordata`: the values of the model's sensors.

use crate::math::*;
use crate::model::{Model, SensorType};
use crate::physics::spatial::{angular, torque_at, velocity_at};
use crate::physics::state::State;

/// Computes `sensordata` from `site_xpos, site_xmat, subtree_com, cvel, cacc, cfrc_int`.
pub fn sensors(model: &Model, s: &mut State) {
    let mut data = std::mem::take(&mut s.sensordata);
    for (sensor, values) in data.chunks_exact_mut(3).enumerate().take(model.nsensor()) {
        values.copy_from_slice(&sensor_value(model, s, sensor));
    }
    s.sensordata = data;
}

/// Returns the value of one sensor in the frame of its site; [`State::sensordata`] tells the quantities.
fn sensor_value(model: &Model, s: &State, sensor: usize) -> Vec3 {
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
