//! Sensors of frames: pose, velocity and acceleration of an object, relative to another one if requested.

use super::vector;
use crate::math::*;
use crate::model::{Model, ObjType, SensorType};
use crate::spatial::*;
use crate::state::State;

/// An object that has a frame.
struct FrameObject {
    body: usize,
    pos: Vec3,
    mat: Mat3,
    quat: Quat,
}

/// Returns the pose of an object; `None` if it has no frame.
fn framed(model: &Model, s: &State, kind: ObjType, id: Option<usize>) -> Option<FrameObject> {
    let id = id?;
    let (body, pos, mat, own) = match kind {
        ObjType::XBody => (id, s.xpos[id], s.xmat[id], QUAT_ID),
        ObjType::Body => (id, s.xipos[id], s.ximat[id], model.body_iquat[id]),
        ObjType::Geom => (
            model.geom_bodyid[id],
            s.geom_xpos[id],
            s.geom_xmat[id],
            model.geom_quat[id],
        ),
        ObjType::Site => (
            model.site_bodyid[id],
            s.site_xpos[id],
            s.site_xmat[id],
            model.site_quat[id],
        ),
        // as in MuJoCo, the quaternion of a camera is that of its frame in the body, wherever it aims
        ObjType::Camera => (model.cam_bodyid[id], s.cam_xpos[id], s.cam_xmat[id], model.cam_quat[id]),
        ObjType::Unknown | ObjType::Joint | ObjType::Tendon | ObjType::Actuator => return None,
    };
    let quat = if kind == ObjType::XBody {
        s.xquat[id]
    } else {
        quat_mul(s.xquat[body], own)
    };
    Some(FrameObject { body, pos, mat, quat })
}

/// Returns the value of a frame sensor.
pub(super) fn frame(model: &Model, s: &State, sensor: usize) -> [f64; 4] {
    let kind = model.sensor_type[sensor];
    let Some(object) = framed(model, s, model.sensor_objtype[sensor], model.sensor_objid[sensor]) else {
        return [0.0; 4];
    };
    let reference = framed(model, s, model.sensor_reftype[sensor], model.sensor_refid[sensor]);
    let seen = |v: Vec3| vector(reference.as_ref().map_or(v, |r| mat_t_vec(&r.mat, v)));
    let com = |f: &FrameObject| sub(f.pos, s.subtree_com[model.body_rootid[f.body]]);
    match kind {
        SensorType::FrameQuat => match &reference {
            Some(r) => quat_mul(quat_conj(r.quat), object.quat),
            None => object.quat,
        },
        SensorType::FrameXAxis => seen(column(&object.mat, 0)),
        SensorType::FrameYAxis => seen(column(&object.mat, 1)),
        SensorType::FrameZAxis => seen(column(&object.mat, 2)),
        SensorType::FrameLinVel | SensorType::FrameAngVel => {
            let mut v = spatial_velocity(s, object.body, com(&object));
            if let Some(r) = &reference {
                let of_reference = spatial_velocity(s, r.body, com(r));
                axpy6(&mut v, -1.0, &of_reference);
                if kind == SensorType::FrameLinVel {
                    // an object at rest moves backwards in the frame of a reference that turns
                    let turned = cross(sub(object.pos, r.pos), angular(&of_reference));
                    axpy6(&mut v, 1.0, &spatial([0.0; 3], turned));
                }
            }
            seen(if kind == SensorType::FrameLinVel {
                linear(&v)
            } else {
                angular(&v)
            })
        }
        SensorType::FrameLinAcc => vector(linear(&spatial_acceleration(s, object.body, com(&object)))),
        SensorType::FrameAngAcc => vector(angular(&spatial_acceleration(s, object.body, com(&object)))),
        _ => vector(match &reference {
            Some(r) => mat_t_vec(&r.mat, sub(object.pos, r.pos)),
            None => object.pos,
        }),
    }
}

/// Returns the angular velocity, and the velocity at a point of a body, in the axes of the world; `offset` is from the centre of mass of
/// the body's tree.
pub(super) fn spatial_velocity(s: &State, body: usize, offset: Vec3) -> Spatial {
    let v = &s.cvel[body];
    spatial(angular(v), velocity_at(v, offset))
}

/// Returns the angular acceleration, and the acceleration at a point of a body, likewise. Gravity counts as upward acceleration.
pub(super) fn spatial_acceleration(s: &State, body: usize, offset: Vec3) -> Spatial {
    let (v, a) = (&s.cvel[body], &s.cacc[body]);
    let moving = add(velocity_at(a, offset), cross(angular(v), velocity_at(v, offset)));
    spatial(angular(a), moving)
}
