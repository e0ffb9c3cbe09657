//! Locks: soft constraints that hold joints at an angle.
//!
//! MIMo's scenes carry one equality constraint per joint, named like the joint and switched off. A lock switches it on and
//! sets its angle, in [`Params`]; the joint stays an observed, and perhaps actuated, joint. A locked joint gives way by
//! 1e-4 to 1e-2 rad under load, and takes tens of steps to reach an angle far away.

use thiserror::Error;

use super::joint_part;
use crate::config::Part;
use crate::model::{EqualityKind, Model};
use crate::physics::Params;

/// The joints to lock or unlock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LockTarget<'a> {
    /// A joint, by id.
    Joint(usize),
    /// A joint, by a name such as `robot:right_elbow`.
    Name(&'a str),
    /// All joints of a part.
    Part(Part),
}

impl From<usize> for LockTarget<'_> {
    fn from(joint: usize) -> Self {
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

/// The result of locking or unlocking.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct LockReport {
    /// Joints that were locked or unlocked, by id.
    pub changed: Vec<usize>,
    /// Joints that another active constraint of the scene holds, with that constraint: they are neither locked nor
    /// freed by unlocking.
    pub held: Vec<(usize, usize)>,
    /// Locked joints whose range does not contain the angle: limit and lock pull against each other.
    pub beyond_limits: Vec<usize>,
}

/// A reason why a joint cannot be locked.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LockError {
    /// The joint does not exist.
    #[error("the scene has no joint {joint:?}")]
    NoJoint {
        /// Name or number of the joint.
        joint: String,
    },
    /// The joint has no constraint to lock it with.
    #[error("joint {joint:?} cannot be locked: the scene has no joint equality of that name")]
    NoLock {
        /// Name of the joint.
        joint: String,
    },
    /// The angle is not finite.
    #[error("cannot lock at the angle {angle}: it must be finite, in radians")]
    Angle {
        /// The requested angle, rad.
        angle: f64,
    },
}

/// Returns the equality constraint that locks a joint: the one with the joint's name that constrains nothing else.
pub fn lock_of(model: &Model, joint: usize) -> Option<usize> {
    let name = model.jnt_name.get(joint)?;
    let lock = model.equality(name)?;
    let alone = matches!(model.eq_kind[lock], EqualityKind::Joint { joint1, joint2: None, .. } if joint1 == joint);
    (alone && model.jnt_type[joint].nv() == 1).then_some(lock)
}

/// Returns the first active joint equality on a joint other than its lock.
pub fn held_by(model: &Model, params: &Params, joint: usize) -> Option<usize> {
    let lock = lock_of(model, joint);
    let on = |e: &usize| {
        Some(*e) != lock
            && params.eq_active[*e]
            && matches!(model.eq_kind[*e], EqualityKind::Joint { joint1, joint2, .. }
                if joint1 == joint || joint2 == Some(joint))
    };
    (0..model.neq()).find(on)
}

/// Locks a joint, or all joints of a part, at an angle in rad. Joints that another active equality holds are left to it.
///
/// # Errors
/// Fails, and changes nothing, if a joint does not exist or has no lock, or the angle is not finite.
pub fn lock(model: &Model, params: &mut Params, target: LockTarget, angle: f64) -> Result<LockReport, LockError> {
    if !angle.is_finite() {
        return Err(LockError::Angle { angle });
    }
    let mut report = LockReport::default();
    // all joints are looked up before the first one changes
    for (joint, lock) in locks(model, target)? {
        // two constraints with different angles would pull against each other forever
        if let Some(other) = held_by(model, params, joint) {
            report.held.push((joint, other));
            continue;
        }
        params.eq_active[lock] = true;
        // joint equalities count from `qpos0`, as in MuJoCo
        params.eq_offset[lock] = angle - model.qpos0[model.jnt_qposadr[joint]];
        report.changed.push(joint);
        let [low, high] = model.jnt_range[joint];
        if model.jnt_limited[joint] && !(low..=high).contains(&angle) {
            report.beyond_limits.push(joint);
        }
    }
    Ok(report)
}

/// Unlocks a joint, or all joints of a part. Other constraints stay.
///
/// # Errors
/// Fails, and changes nothing, if a joint does not exist or has no lock.
pub fn unlock(model: &Model, params: &mut Params, target: LockTarget) -> Result<LockReport, LockError> {
    let mut report = LockReport::default();
    for (joint, lock) in locks(model, target)? {
        if std::mem::replace(&mut params.eq_active[lock], false) {
            report.changed.push(joint);
        }
        report.held.extend(held_by(model, params, joint).map(|e| (joint, e)));
    }
    Ok(report)
}

/// Lists the joints of a target with their locks. Joints of a part that have none are left out.
fn locks(model: &Model, target: LockTarget) -> Result<Vec<(usize, usize)>, LockError> {
    let no_joint = |joint: String| LockError::NoJoint { joint };
    let joint = match target {
        LockTarget::Part(part) => {
            let joints = 0..model.njnt();
            let of_part = joints.filter(|&j| joint_part(model, j) == Some(part));
            return Ok(of_part.filter_map(|j| Some((j, lock_of(model, j)?))).collect());
        }
        LockTarget::Name(name) => model.joint(name).ok_or_else(|| no_joint(name.to_string()))?,
        LockTarget::Joint(joint) if joint < model.njnt() => joint,
        LockTarget::Joint(joint) => return Err(no_joint(joint.to_string())),
    };
    match lock_of(model, joint) {
        Some(lock) => Ok(vec![(joint, lock)]),
        None => Err(LockError::NoLock {
            joint: model.jnt_name[joint].clone(),
        }),
    }
}
