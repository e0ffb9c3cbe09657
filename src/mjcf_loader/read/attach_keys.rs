//! Keyframes of models whose bodies `<attach>` takes.

use super::super::attached::{Attachable, AttachedKey, KeyPart, Keyed, Said, Saying, na};
use super::super::document::{Attach, Document};
use super::super::error::{ErrorKind, LoadError};
use super::super::xml::Tree;
use super::attach::Taking;
use super::content::Spot;

const KEYS_COPIED: &str = "the model has keyframes, which MuJoCo 3.3.0 mixes up where a <replicate> copies it: remove them, or write the copies out";
const KEYS_NESTED: &str =
    "the model has keyframes of models that it is made of, to which MuJoCo 3.3.0 gives wrong names: remove them";

/// Makes the keyframes of a model keyframes of the document.
pub(super) fn keep_keys(
    attach: &Attach,
    model: &mut Attachable,
    spot: Spot,
    tree: &Tree,
    document: &mut Document,
) -> Result<(), LoadError> {
    let invalid = |what| Err(tree.error(attach.at, ErrorKind::Invalid(what)));
    if !model.document.attached_keys.is_empty() {
        return invalid(KEYS_NESTED);
    }
    if spot.copied && !model.document.keys.is_empty() {
        return invalid(KEYS_COPIED);
    }
    for as_in in 0..model.document.keys.len() {
        let key = &model.document.keys[as_in];
        if let Some((attribute, found, wanted)) = model.misfit(key) {
            let (min, max) = (wanted, wanted);
            let kind = ErrorKind::WrongCount {
                attribute,
                found,
                min,
                max,
            };
            return Err(tree.error(key.at, kind));
        }
        let saying = Saying {
            key: document.attached_keys.len(),
            as_in,
        };
        document.attached_keys.push(AttachedKey {
            at: key.at,
            name: format!("{}{}", attach.prefix, key.name),
            time: key.time,
            parts: Vec::new(),
        });
        let Said {
            joints,
            actuators,
            mocaps,
        } = &mut model.said;
        let all = joints.iter_mut().chain(actuators).chain(mocaps);
        all.for_each(|said| said.push(saying));
    }
    Ok(())
}

/// Says in the keyframes of the document what those of the model say of all that has come along.
pub(super) fn say(
    taking: &Taking,
    from: &Document,
    said: &mut Said,
    actuators: &[Option<usize>],
    document: &mut Document,
) {
    if from.keys.is_empty() {
        return;
    }
    say_bodies(taking, from, said, document);
    let mut act = 0;
    for (id, (actuator, place)) in from.actuators.iter().zip(actuators).enumerate() {
        if let Some(place) = *place {
            for saying in std::mem::take(&mut said.actuators[id]) {
                let key = &from.keys[saying.as_in];
                tell(document, saying, Keyed::Act(place), &key.act, (act, na(actuator)));
                tell(document, saying, Keyed::Ctrl(place), &key.ctrl, (id, 1));
            }
        }
        act += na(actuator);
    }
}

/// Says what keyframes say of joints and of bodies that a program moves.
fn say_bodies(taking: &Taking, from: &Document, said: &mut Said, document: &mut Document) {
    let (mut joint, mut qpos, mut qvel, mut mocap) = (0, 0, 0, 0);
    for (id, body) in from.bodies.iter().enumerate() {
        let here = taking.bodies.contains(&id);
        // a body that has not come along says nothing, and keeps it for the next time that something is taken
        let taken = |sayings: &mut Vec<Saying>| if here { std::mem::take(sayings) } else { Vec::new() };
        let place = (id + taking.base).saturating_sub(taking.bodies.start);
        for (index, one) in body.joints.iter().enumerate() {
            for saying in taken(&mut said.joints[joint]) {
                let key = &from.keys[saying.as_in];
                let (body, joint) = (place, index);
                let (of_qpos, of_qvel) = (Keyed::Qpos { body, joint }, Keyed::Qvel { body, joint });
                tell(document, saying, of_qpos, &key.qpos, (qpos, one.kind.nq()));
                tell(document, saying, of_qvel, &key.qvel, (qvel, one.kind.nv()));
            }
            joint += 1;
            qpos += one.kind.nq();
            qvel += one.kind.nv();
        }
        if body.mocap {
            for saying in taken(&mut said.mocaps[mocap]) {
                let key = &from.keys[saying.as_in];
                tell(document, saying, Keyed::Mpos(place), &key.mpos, (3 * mocap, 3));
                tell(document, saying, Keyed::Mquat(place), &key.mquat, (4 * mocap, 4));
            }
            mocap += 1;
        }
    }
}

/// Says one thing in a keyframe of the document: the numbers from a place on, if the keyframe of the model has them.
fn tell(document: &mut Document, saying: Saying, of: Keyed, numbers: &[f64], (from, length): (usize, usize)) {
    if let Some(values) = numbers.get(from..from + length).filter(|values| !values.is_empty()) {
        let values = values.to_vec();
        document.attached_keys[saying.key].parts.push(KeyPart { of, values });
    }
}
