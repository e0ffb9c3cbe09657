//! The rows of joints' limits.

use super::ConstraintType;
use super::append::{RowAppender, RowParameters};
use crate::math::{QUAT_ID, quat_at, quat_normalize, rotation_between, unit};
use crate::model::JointType;
use crate::state::State;

/// Appends a row for each limit of a joint that is within its margin.
#[doc(alias = "mj_instantiateLimit")]
#[inline(always)]
pub fn joint_limits(rows: &mut RowAppender, s: &State) {
    let model = rows.model;
    for j in 0..model.njnt() {
        if !model.jnt_limited[j] {
            continue;
        }
        if model.jnt_type[j] == JointType::Ball {
            ball_limit(rows, s, j);
            continue;
        }
        let (value, margin, d) = (s.qpos[model.jnt_qposadr[j]], model.jnt_margin[j], model.jnt_dofadr[j]);
        // both sides: in a wide margin a joint may be near both of its limits
        for (side, limit) in [(-1.0, model.jnt_range[j][0]), (1.0, model.jnt_range[j][1])] {
            let dist = side * (limit - value);
            if dist < margin {
                let spec = RowParameters {
                    solref: model.jnt_solref[j],
                    solimp: model.jnt_solimp[j],
                    diag: s.params.dof_invweight0[d],
                };
                rows.single(ConstraintType::LimitJoint, j, d, -side);
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
}

/// Appends a row if the rotation of a ball joint about any axis is within the margin of its limit.
#[inline(never)]
fn ball_limit(rows: &mut RowAppender, s: &State, j: usize) {
    let model = rows.model;
    let quat = quat_normalize(quat_at(&s.qpos, model.jnt_qposadr[j]));
    let (axis, angle) = unit(rotation_between(QUAT_ID, quat));
    let (margin, d, [low, high]) = (model.jnt_margin[j], model.jnt_dofadr[j], model.jnt_range[j]);
    let dist = low.max(high) - angle;
    if dist < margin {
        let spec = RowParameters {
            solref: model.jnt_solref[j],
            solimp: model.jnt_solimp[j],
            diag: s.params.dof_invweight0[d],
        };
        rows.block(ConstraintType::LimitJoint, j, 1);
        for (k, along) in axis.into_iter().enumerate() {
            rows.entry(d + k, -along);
        }
        rows.row(dist, margin, dist - margin, spec);
    }
}
