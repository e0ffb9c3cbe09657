//! Compiles custom data and keyframes.

use super::context::{Context, Ids};
use super::geometry::normalize;
use crate::attachment::AttachedKeyframe;
use crate::custom::{Key, TupleElement, TupleObject};
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::math::{Quat, Vec3, quat_at, quat_normalize};
use crate::model::{Arrays, Keyframe};
use crate::table::Table;

/// Compiles `<custom>`: numbers and texts for programs.
pub(super) fn compile_custom(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    for tuple in &document.tuples {
        if tuple.elements.is_empty() {
            return Err(context.invalid(tuple.at, "a tuple needs elements"));
        }
        for element in &tuple.elements {
            check_element(context, element, ids)?;
        }
    }
    for numeric in &document.numerics {
        let mut data = numeric.data.clone();
        let size = numeric.size.unwrap_or(data.len());
        if size < data.len() {
            return Err(context.invalid(numeric.at, "data has more values than size"));
        }
        if size == 0 {
            return Err(context.invalid(numeric.at, "a numeric needs data or a size"));
        }
        data.resize(size, 0.0);
        arrays.numeric_name.push(numeric.name.clone());
        arrays.numeric_data.push(data);
    }
    for text in &document.texts {
        if text.data.is_empty() {
            return Err(context.invalid(text.at, "data is empty"));
        }
        arrays.text_name.push(text.name.clone());
        arrays.text_data.push(text.data.clone());
    }
    Ok(())
}

/// Checks that the element that a tuple names exists.
fn check_element(context: &Context, element: &TupleElement, ids: &Ids) -> Result<(), LoadError> {
    let names = match element.objtype {
        Some(TupleObject::Body) => &ids.body,
        Some(TupleObject::Joint) => &ids.joint,
        Some(TupleObject::Geom) => &ids.geom,
        Some(TupleObject::Site) => &ids.site,
        Some(TupleObject::Camera) => &ids.camera,
        Some(TupleObject::Mesh) => &ids.mesh,
        Some(TupleObject::HField) => &ids.hfield,
        Some(TupleObject::Texture) => &ids.texture,
        Some(TupleObject::Material) => &ids.material,
        Some(TupleObject::Tendon) => &ids.tendon,
        Some(TupleObject::Actuator) => &ids.actuator,
        Some(TupleObject::Other) | None => return Ok(()),
    };
    names
        .find(context.tree, element.at, "objname", &element.objname)
        .map(drop)
}

/// Compiles the keyframes, after everything that has coordinates or controls.
pub(super) fn compile_keys(context: &Context, document: &TypedDocument, arrays: &mut Arrays) -> Result<(), LoadError> {
    // fewer than none are none
    let least = usize::try_from(document.size.nkey).unwrap_or(0);
    let numbers = arrays.nq + arrays.nv + arrays.na + arrays.nu() + 7 * arrays.nmocap;
    let (limit, most) = (
        context.tree.limits.key_numbers,
        least.max(document.keys.len()) + document.moved_keys.len(),
    );
    // before keyframes are made, because `nkey` asks for many in a few bytes
    if most.saturating_mul(numbers) > limit {
        let at = document.keys.last().map_or(0, |key| key.at);
        let what = "numbers in keyframes";
        return Err(context.error(at, ErrorKind::TooMuch { what, limit }));
    }
    for key in &document.keys {
        let key = compile_key(context, key, arrays)?;
        arrays.keys.push(key);
    }
    let reference = Keyframe {
        name: String::new(),
        time: 0.0,
        qpos: arrays.qpos0.clone(),
        qvel: vec![0.0; arrays.nv],
        act: vec![0.0; arrays.na],
        ctrl: vec![0.0; arrays.nu()],
        mpos: mocap_poses(arrays).map(|pose| pose.0).collect(),
        mquat: mocap_poses(arrays).map(|pose| pose.1).collect(),
    };
    let missing = least.saturating_sub(arrays.keys.len());
    arrays.keys.extend(std::iter::repeat_n(reference.clone(), missing));
    let last_unnamed = document.moved_keys.iter().rposition(|key| key.name.is_empty());
    for (at, key) in document.moved_keys.iter().enumerate() {
        // of those without a name MuJoCo fills only the last
        let filled = !key.name.is_empty() || last_unnamed == Some(at);
        let key = if filled {
            moved_key(context, key, document, arrays)?
        } else {
            reference.clone()
        };
        arrays.keys.push(key);
    }
    Ok(())
}

/// Compiles a keyframe of attached or copied bodies. Missing values are those of `qpos0`.
fn moved_key(
    context: &Context,
    key: &AttachedKeyframe,
    document: &TypedDocument,
    arrays: &Arrays,
) -> Result<Keyframe, LoadError> {
    let mut whole = Key {
        at: key.at,
        name: key.name.clone(),
        time: key.time,
        qpos: arrays.qpos0.clone(),
        qvel: vec![0.0; arrays.nv],
        act: vec![0.0; arrays.na],
        ctrl: vec![0.0; arrays.nu()],
        ..Key::initial()
    };
    for (pos, quat) in mocap_poses(arrays) {
        whole.mpos.extend(pos);
        whole.mquat.extend(quat);
    }
    let write = |to: &mut [f64], at: usize, values: &[f64]| {
        let places = to.iter_mut().skip(at);
        places.zip(values).for_each(|(to, value)| *to = *value);
    };
    // places in these lists are ids, because fused bodies have no joints and are not mocap bodies
    let joints = document.bodies.iter().flat_map(|body| &body.joints);
    for (id, joint) in joints.enumerate() {
        if let Some([qpos, qvel]) = joint.states.get(&key.name) {
            write(&mut whole.qpos, arrays.jnt_qposadr[id], qpos);
            write(&mut whole.qvel, arrays.jnt_dofadr[id], qvel);
        }
    }
    for (id, actuator) in document.actuators.iter().enumerate() {
        if let Some([act, ctrl]) = actuator.states.get(&key.name) {
            write(&mut whole.act, arrays.actuator_actadr[id].unwrap_or(0), act);
            write(&mut whole.ctrl, id, ctrl);
        }
    }
    let moved = document.bodies.iter().filter(|body| body.mocap);
    for (id, body) in moved.enumerate() {
        if let Some([mpos, mquat]) = body.states.get(&key.name) {
            write(&mut whole.mpos, 3 * id, mpos);
            write(&mut whole.mquat, 4 * id, mquat);
        }
    }
    compile_key(context, &whole, arrays)
}

/// Iterates over the poses of mocap bodies in the document.
fn mocap_poses(arrays: &Arrays) -> impl Iterator<Item = (Vec3, Quat)> {
    let moved = (0..arrays.nbody()).filter(|&b| arrays.body_mocapid[b].is_some());
    moved.map(|b| (arrays.body_pos[b], arrays.body_quat[b]))
}

fn compile_key(context: &Context, key: &Key, arrays: &Arrays) -> Result<Keyframe, LoadError> {
    let sized = |given: &Vec<f64>, attribute: &'static str, default: &[f64]| match given.len() {
        0 => Ok(default.to_vec()),
        found if found == default.len() => Ok(given.clone()),
        found => {
            let (min, max) = (default.len(), default.len());
            Err(context.error(
                key.at,
                ErrorKind::WrongCount {
                    attribute,
                    found,
                    min,
                    max,
                },
            ))
        }
    };
    let mut qpos = sized(&key.qpos, "qpos", &arrays.qpos0)?;
    for (kind, &adr) in arrays.jnt_type.iter().zip(&arrays.jnt_qposadr) {
        if let Some(at) = kind.quat(adr) {
            let quat = quat_normalize(quat_at(&qpos, at));
            qpos[at..at + 4].copy_from_slice(&quat);
        }
    }
    let (mpos, mquat): (Vec<Vec3>, Vec<Quat>) = mocap_poses(arrays).unzip();
    let mpos = sized(&key.mpos, "mpos", mpos.as_flattened())?;
    let mut mquat = sized(&key.mquat, "mquat", mquat.as_flattened())?
        .as_chunks::<4>()
        .0
        .to_vec();
    mquat.iter_mut().for_each(|quat| {
        normalize(quat);
    });
    Ok(Keyframe {
        name: key.name.clone(),
        time: key.time,
        qpos,
        qvel: sized(&key.qvel, "qvel", &vec![0.0; arrays.nv])?,
        act: sized(&key.act, "act", &vec![0.0; arrays.na])?,
        ctrl: sized(&key.ctrl, "ctrl", &vec![0.0; arrays.nu()])?,
        mpos: mpos.as_chunks::<3>().0.to_vec(),
        mquat,
    })
}
