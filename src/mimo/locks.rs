//! Locking joints: a soft constraint holds a joint at an angle.
//!
//! MIMo's scenes carry one equality constraint per joint, named like the joint and switched off. A lock switches it on and
//! sets its angle, in [`Params`]; the joint stays an observed, and perhaps actuated, joint. A locked joint gives way by
//! 1e-4 to 1e-2 rad under load, and takes tens of steps to reach an angle far away.

use thiserror::Error;

use crate::config::Part;
use crate::mimo::joint_part;
use crate::model::{EqualityId, EqualityKind, JointId, JointType, Model};
use crate::physics::Params;

/// What to lock or unlock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LockTarget<'a> {
    /// A joint.
    Joint(JointId),
    /// A joint by its name, such as `robot:right_elbow`.
    Name(&'a str),
    /// All joints of a part.
    Part(Part),
}

impl From<JointId> for LockTarget<'_> {
    fn from(joint: JointId) -> Self {
        Self::Joint(joint)
    }
}

impl<'a> From<&'a str> for LockTarget<'a> {
    fn from(name: &'a str) -> Self {
        Self::Name(name)
    }
}

impl From<Part> for LockTarget<'_> {
    fn from(part: Part) -> Self {
        Self::Part(part)
    }
}

/// What locking or unlocking did.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct LockReport {
    /// Joints that were locked or unlocked.
    pub changed: Vec<JointId>,
    /// Joints that another active constraint of the scene holds, with that constraint: they are not locked, and not freed
    /// by unlocking.
    pub held: Vec<(JointId, EqualityId)>,
    /// Locked joints whose range does not contain the angle: limit and lock will pull against each other.
    pub beyond_limits: Vec<JointId>,
}

/// Why something cannot be locked.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LockError {
    /// There is no such joint.
    #[error("the scene has no joint {joint:?}")]
    NoJoint {
        /// Its name or number.
        joint: String,
    },
    /// The joint has no constraint to lock it with.
    #[error("joint {joint:?} cannot be locked: the scene has no joint equality of that name")]
    NoLock {
        /// Its name.
        joint: String,
    },
    /// The angle is not finite.
    #[error("cannot lock at the angle {angle}: it must be finite, in radians")]
    Angle {
        /// The angle.
        angle: f64,
    },
}

/// The equality constraint that locks a joint: the one that carries its name and constrains nothing else.
pub fn lock_of(model: &Model, joint: JointId) -> Option<EqualityId> {
    let name = model.jnt_name.get(joint.0)?;
    let lock = model.equality(name)?;
    let alone = matches!(model.eq_kind[lock.0], EqualityKind::Joint { joint1, joint2: None, .. } if joint1 == joint);
    (alone && model.jnt_type[joint.0] != JointType::Free).then_some(lock)
}

/// The first active joint equality on a joint other than its lock.
pub fn held_by(model: &Model, params: &Params, joint: JointId) -> Option<EqualityId> {
    let lock = lock_of(model, joint);
    let on = |e: &usize| {
        Some(EqualityId(*e)) != lock
            && params.eq_active[*e]
            && matches!(model.eq_kind[*e], EqualityKind::Joint { joint1, joint2, .. }
                if joint1 == joint || joint2 == Some(joint))
    };
    (0..model.neq()).find(on).map(EqualityId)
}

/// Locks a joint, or all joints of a part, at an angle in rad. Joints that another active equality holds are left to it.
///
/// # Errors
/// No such joint, a joint without a lock, an angle that is not finite; nothing is changed then.
pub fn lock(model: &Model, params: &mut Params, target: LockTarget, angle: f64) -> Result<LockReport, LockError> {
    if !angle.is_finite() {
        return Err(LockError::Angle { angle });
    }
    let mut report = LockReport::default();
    for (joint, lock) in locks(model, target)? {
        if let Some(other) = held_by(model, params, joint) {
            report.held.push((joint, other));
            continue;
        }
        params.eq_active[lock.0] = true;
        params.eq_offset[lock.0] = angle - model.qpos0[model.jnt_qposadr[joint.0]];
        report.changed.push(joint);
        let [low, high] = model.jnt_range[joint.0];
        if model.jnt_limited[joint.0] && !(low..=high).contains(&angle) {
            report.beyond_limits.push(joint);
        }
    }
    Ok(report)
}

/// Takes the lock off a joint, or all joints of a part. Other constraints stay.
///
/// # Errors
/// No such joint, a joint without a lock; nothing is changed then.
pub fn unlock(model: &Model, params: &mut Params, target: LockTarget) -> Result<LockReport, LockError> {
    let mut report = LockReport::default();
    for (joint, lock) in locks(model, target)? {
        if std::mem::replace(&mut params.eq_active[lock.0], false) {
            report.changed.push(joint);
        }
        report.held.extend(held_by(model, params, joint).map(|e| (joint, e)));
    }
    Ok(report)
}

/// The joints of a target and their locks. Joints of a part that have none are left out.
fn locks(model: &Model, target: LockTarget) -> Result<Vec<(JointId, EqualityId)>, LockError> {
    let no_joint = |joint: String| LockError::NoJoint { joint };
    let joint = match target {
        LockTarget::Part(part) => {
            let joints = (0..model.njnt()).map(JointId);
            let of_part = joints.filter(|&j| joint_part(model, j) == Some(part));
            return Ok(of_part.filter_map(|j| Some((j, lock_of(model, j)?))).collect());
        }
        LockTarget::Name(name) => model.joint(name).ok_or_else(|| no_joint(name.to_string()))?,
        LockTarget::Joint(joint) if joint.0 < model.njnt() => joint,
        LockTarget::Joint(joint) => return Err(no_joint(joint.0.to_string())),
    };
    match lock_of(model, joint) {
        Some(lock) => Ok(vec![(joint, lock)]),
        None => Err(LockError::NoLock {
            joint: model.jnt_name[joint.0].clone(),
        }),
    }
}
