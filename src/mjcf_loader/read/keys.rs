//! Keyframes in documents with `<attach>` and `<replicate>`, as in MuJoCo 3.3.0: the joints, actuators and mocap bodies that exist at that
//! time keep the values of a keyframe, and their copies get the same values.

use crate::actuator::Actuator;
use crate::attached::{Sizes, na};
use crate::attachment::AttachedKeyframe;
use crate::custom::Key;
use crate::document::{Body, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::xml::Tree;

/// Distributes the values of the keyframes to the elements of the document. Returns the keyframes, with a prefix and a suffix on their names.
///
/// # Errors
/// The size of a keyframe differs from that of the state at this time.
pub(super) fn say_keys(
    document: &mut TypedDocument,
    (prefix, suffix): (&str, &str),
    tree: &Tree,
) -> Result<Vec<AttachedKeyframe>, LoadError> {
    let sizes = Sizes::of(document);
    let TypedDocument {
        keys,
        bodies,
        actuators,
        ..
    } = document;
    let mut moved = Vec::with_capacity(keys.len());
    for key in keys.iter() {
        // a keyframe of another length cannot be divided among the elements
        if let Some((attribute, found, wanted)) = sizes.misfit(key) {
            let (min, max) = (wanted, wanted);
            let kind = ErrorKind::WrongCount {
                attribute,
                found,
                min,
                max,
            };
            return Err(tree.error(key.at, kind));
        }
        let name = format!("{prefix}{}{suffix}", key.name);
        say(key, &name, bodies, actuators);
        let (at, time) = (key.at, key.time);
        moved.push(AttachedKeyframe { at, name, time });
    }
    Ok(moved)
}

/// Removes the next numbers of a keyframe; none if it does not give them.
fn next(numbers: &mut &[f64], count: usize) -> Vec<f64> {
    let (own, rest) = numbers.split_at(count.min(numbers.len()));
    *numbers = rest;
    own.to_vec()
}

/// Distributes the values of a keyframe to the elements.
fn say(key: &Key, name: &str, bodies: &mut [Body], actuators: &mut [Actuator]) {
    let mut qpos = key.qpos.as_slice();
    let mut qvel = key.qvel.as_slice();
    let mut mpos = key.mpos.as_slice();
    let mut mquat = key.mquat.as_slice();
    for body in bodies {
        for joint in &mut body.joints {
            let said = [next(&mut qpos, joint.kind.nq()), next(&mut qvel, joint.kind.nv())];
            joint.states.insert(name.to_owned(), said);
        }
        if body.mocap {
            let said = [next(&mut mpos, 3), next(&mut mquat, 4)];
            body.states.insert(name.to_owned(), said);
        }
    }
    let (mut act, mut ctrl) = (key.act.as_slice(), key.ctrl.as_slice());
    for actuator in actuators {
        let said = [next(&mut act, na(actuator)), next(&mut ctrl, 1)];
        actuator.states.insert(name.to_owned(), said);
    }
}

/// Makes the document's own keyframes as long as its state, after elements were added. At this point MuJoCo 3.3.0 knows neither the unit of angles
/// nor the coordinates of ball and free joints: those become 0, the others `ref` as written.
pub(super) fn resize_keys(document: &mut TypedDocument) {
    if document.keys.is_empty() {
        return;
    }
    let sizes = Sizes::of(document);
    let mut reference = Vec::with_capacity(sizes.nq);
    let mut mpos = Vec::with_capacity(3 * sizes.nmocap);
    for body in &document.bodies {
        for joint in &body.joints {
            reference.push(joint.reference);
            reference.resize(reference.len() + joint.kind.nq() - 1, 0.0);
        }
        if body.mocap {
            mpos.extend(body.frame.pos);
        }
    }
    let mquat = body_quats(&document.bodies);
    let grow = |numbers: &mut Vec<f64>, rest: &[f64]| {
        // an attribute that is not given stays so, and takes its default when keyframes are compiled
        if !numbers.is_empty() {
            numbers.truncate(rest.len());
            numbers.extend(&rest[numbers.len()..]);
        }
    };
    let zeros = |count: usize| vec![0.0; count];
    for key in &mut document.keys {
        grow(&mut key.qpos, &reference);
        grow(&mut key.qvel, &zeros(sizes.nv));
        grow(&mut key.act, &zeros(sizes.na));
        grow(&mut key.ctrl, &zeros(sizes.nu));
        grow(&mut key.mpos, &mpos);
        grow(&mut key.mquat, &mquat);
    }
}

/// Returns the quaternions of mocap bodies. Orientations in other forms are not converted yet, as in MuJoCo, and count as missing.
fn body_quats(bodies: &[Body]) -> Vec<f64> {
    use crate::document::Orientation;
    let moved = bodies.iter().filter(|body| body.mocap);
    let quat = |body: &Body| match body.frame.orientation {
        Orientation::Quat(quat) => quat,
        _ => crate::math::QUAT_ID,
    };
    moved.flat_map(quat).collect()
}
