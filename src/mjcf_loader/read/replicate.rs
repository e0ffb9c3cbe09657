//! `<replicate>`: copies of its content and of all elements that refer to it, as MuJoCo 3.3.0 makes them.
//!
//! What it holds is read once, under its own names, into a body that stands for all copies. Each copy takes what hangs on that body and the
//! bodies in it, with the number of the copy behind their names. Elements outside that refer to it by name are copied with it, as far as
//! all or, of some kinds, a part of what they refer to was copied; those that refer to the original go with it.

use std::collections::BTreeSet;

use super::Classes;
use super::insertion::{Insertion, known};
use super::keys::{resize_keys, say_keys};
use crate::attached::{NameTable, Reference, hanging, said};
use crate::attachment::ElementKind;
use crate::document::{Body, BodyFrame, Orientation, ReplicaIndex, Replicate, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::schema::Element;
use crate::table::Table;
use crate::xml::Tree;

/// Limit on the elements examined for copies, relative to the limit on a document's elements: those that refer to others are examined again
/// for every copy.
const LOOKS: usize = 100;

/// The content of a `<replicate>`, while it is read.
pub(super) struct ReplicateContent {
    replicate: Replicate,
    /// The body and the frame that it is in. The bodies and frames that it holds come after them in the document.
    body: usize,
    frame: usize,
}

impl ReplicateContent {
    /// Returns where its elements are inserted.
    pub fn spot(&self) -> Insertion {
        Insertion {
            body: self.body,
            within: Some(self.frame),
        }
    }
}

/// Adds the body and the frame for the content of a `<replicate>`. It is separate from `content`, which recurses, so that stack frames stay small.
#[inline(never)]
pub(super) fn open(
    e: &Element,
    spot: Insertion,
    inner: &str,
    classes: &Classes,
    document: &mut TypedDocument,
) -> Result<ReplicateContent, LoadError> {
    known(e, inner, classes)?;
    let original = ReplicateContent {
        replicate: Replicate::read(e),
        body: document.bodies.len(),
        frame: document.frames.len(),
    };
    // a body for the original, which is read like any other and taken away after the copies: its bodies and frames are then in one range
    document.bodies.push(Body {
        at: e.at,
        parent: spot.body,
        ..Body::initial()
    });
    let frame = original.step(spot, 0, None);
    document.frames.push(frame);
    Ok(original)
}

impl ReplicateContent {
    /// Returns the frame of a copy, whose pose is the step from the copy before.
    fn step(&self, spot: Insertion, number: usize, previous: Option<usize>) -> BodyFrame {
        let mut frame = BodyFrame {
            at: self.replicate.at,
            within: spot.within,
            copy: Some(ReplicaIndex { number, previous }),
            ..BodyFrame::initial()
        };
        frame.frame.pos = self.replicate.offset;
        frame.frame.orientation = Orientation::Euler(self.replicate.euler);
        frame
    }

    /// Makes the copies and removes the original. Like [`open`], it is separate from `content`.
    #[inline(never)]
    pub fn copy(&self, spot: Insertion, tree: &Tree, document: &mut TypedDocument) -> Result<(), LoadError> {
        let at = self.replicate.at;
        let count = usize::try_from(self.replicate.count).unwrap_or(0);
        let joints = &document.bodies[self.body].joints;
        // `hang` saw the body of the original and not the world, into which the copies go
        if let Some(joint) = joints.first().filter(|_| spot.body == 0 && count > 0) {
            let what = "the world has no joints and no inertia";
            return Err(tree.error(joint.at, ErrorKind::Invalid(what)));
        }
        distinct(document, tree)?;
        let ends = (document.bodies.len(), document.frames.len());
        // nested <replicate>s multiply: a few of them in a row ask for billions of elements
        let each = amount(&document.bodies[self.body..]) + ends.1 - self.frame;
        // with the names of the original, by which `forget_lost` tells lost references from those that never existed
        let mut names = NameTable::of(document);
        look(document, at, tree)?;
        // suffixes are padded with zeros to the digits of the count, as MuJoCo pads them
        let (digits, mut previous) = (count.to_string().len(), None);
        for number in 0..count {
            document.copies = document.copies.saturating_add(each);
            let limit = tree.limits.elements;
            if document.copies > limit {
                let what = "frames and copies of elements";
                return Err(tree.error(at, ErrorKind::TooMuch { what, limit }));
            }
            let suffix = format!("{}{number:0digits$}", self.replicate.sep);
            move_keys(document, &suffix, at, tree)?;
            let (body, frame) = (document.bodies.len(), document.frames.len());
            self.copy_tree(spot, ends, (number, previous), &suffix, document);
            previous = Some(frame);
            // copies of elements that refer to the original look for its names with this suffix
            names.add(document.bodies[body..].iter().flat_map(hanging));
            // elements directly in the <replicate> are now in this body
            names.add(hanging(&document.bodies[spot.body]));
            look(document, at, tree)?;
            copy_referring(&suffix, &mut names, document);
            // the next copy distributes the keyframes again, and they must have the new length by then
            resize_keys(document);
        }
        // MuJoCo compares with a copy of the whole model, and loses the actuators' values in keyframes when it makes the copy
        for actuator in &mut document.actuators {
            if actuator.readdress("", &names) {
                actuator.forget();
            }
        }
        move_keys(document, "", at, tree)?;
        // their values are now with the elements
        document.keys.clear();
        self.take_away(spot, ends, document);
        look(document, at, tree)?;
        forget_lost(&names, document);
        Ok(())
    }

    /// Adds a copy of the bodies starting at `self.body` and of the frames starting at `self.frame`, up to `ends`.
    fn copy_tree(
        &self,
        spot: Insertion,
        ends: (usize, usize),
        (number, previous): (usize, Option<usize>),
        suffix: &str,
        document: &mut TypedDocument,
    ) {
        let by_frame = document.frames.len() - self.frame;
        // frames of the original become those of the copy; frames around the <replicate> stay
        let moved = |within: Option<usize>| within.map(|at| if at >= self.frame { at + by_frame } else { at });
        document.frames.push(self.step(spot, number, previous));
        for at in self.frame + 1..ends.1 {
            let mut frame = document.frames[at].clone();
            rename(&mut frame.name, suffix);
            frame.within = moved(frame.within);
            if let Some(copied) = &mut frame.copy {
                copied.previous = moved(copied.previous);
            }
            document.frames.push(frame);
        }
        let mut held = document.bodies[self.body].clone();
        readdress_hung(&mut held, suffix, &moved);
        let to = &mut document.bodies[spot.body];
        to.joints.append(&mut held.joints);
        to.geoms.append(&mut held.geoms);
        to.sites.append(&mut held.sites);
        to.cameras.append(&mut held.cameras);
        to.lights.append(&mut held.lights);
        // the body around the original is not copied
        let by_body = document.bodies.len() - self.body - 1;
        for at in self.body + 1..ends.0 {
            let original = &mut document.bodies[at];
            let mut body = original.clone();
            // values of this keyframe belong to this copy; the next copy gets those of its own
            original.states.clear();
            original.joints.iter_mut().for_each(|joint| joint.states.clear());
            rename(&mut body.name, suffix);
            body.within = moved(body.within);
            body.parent = match body.parent {
                parent if parent == self.body => spot.body,
                parent => parent + by_body,
            };
            readdress_hung(&mut body, suffix, &moved);
            document.bodies.push(body);
        }
    }

    /// Removes the original. Bodies and frames after it move up.
    fn take_away(&self, spot: Insertion, ends: (usize, usize), document: &mut TypedDocument) {
        let (bodies, frames) = (ends.0 - self.body, ends.1 - self.frame);
        document.bodies.drain(self.body..ends.0);
        document.frames.drain(self.frame..ends.1);
        let moved = |within: Option<usize>| within.map(|at| if at >= ends.1 { at - frames } else { at });
        // earlier frames never refer to later ones
        for frame in &mut document.frames[self.frame..] {
            frame.within = moved(frame.within);
            if let Some(copied) = &mut frame.copy {
                copied.previous = moved(copied.previous);
            }
        }
        // this body comes before the original, but the frames of its copied elements come after it
        readdress_hung(&mut document.bodies[spot.body], "", &moved);
        for body in &mut document.bodies[self.body..] {
            body.within = moved(body.within);
            if body.parent >= ends.0 {
                body.parent -= bodies;
            }
            readdress_hung(body, "", &moved);
        }
    }
}

/// Appends a suffix to a name, if there is one.
fn rename(name: &mut String, suffix: &str) {
    if !name.is_empty() {
        name.push_str(suffix);
    }
}

/// Appends a suffix to the names of a body's elements. `moved` maps their frames. Cameras and lights aim at the copies of
/// their targets.
fn readdress_hung(body: &mut Body, suffix: &str, moved: &dyn Fn(Option<usize>) -> Option<usize>) {
    for joint in &mut body.joints {
        rename(&mut joint.name, suffix);
        joint.within = moved(joint.within);
    }
    for geom in &mut body.geoms {
        rename(&mut geom.name, suffix);
        geom.within = moved(geom.within);
    }
    for site in &mut body.sites {
        rename(&mut site.name, suffix);
        site.within = moved(site.within);
    }
    for camera in &mut body.cameras {
        rename(&mut camera.name, suffix);
        camera.target.iter_mut().for_each(|target| rename(target, suffix));
        camera.within = moved(camera.within);
    }
    for light in &mut body.lights {
        rename(&mut light.name, suffix);
        light.target.iter_mut().for_each(|target| rename(target, suffix));
        light.within = moved(light.within);
    }
}

/// Returns the number of bodies and of their elements.
fn amount(bodies: &[Body]) -> usize {
    bodies
        .iter()
        .map(|body| hanging(body).count() + body.lights.len())
        .sum()
}

/// Refuses a name that two elements of a kind share: if they refer to copies, one may be lost before the compiler checks.
fn distinct(document: &TypedDocument, tree: &Tree) -> Result<(), LoadError> {
    let tendons = document.tendons.iter().map(|e| (e.at, "tendon", &e.name));
    let actuators = document.actuators.iter().map(|e| (e.at, "actuator", &e.name));
    let equalities = document.equalities.iter().map(|e| (e.at, "equality", &e.name));
    let sensors = document.sensors.iter().map(|e| (e.at, "sensor", &e.name));
    let mut seen = BTreeSet::new();
    let named = tendons.chain(actuators).chain(equalities).chain(sensors);
    for (at, kind, name) in named.filter(|(.., name)| !name.is_empty()) {
        if !seen.insert((kind, name)) {
            let name = name.clone();
            return Err(tree.error(at, ErrorKind::DuplicateName { kind, name }));
        }
    }
    Ok(())
}

/// Counts the elements that are searched for references to a copy.
fn look(document: &mut TypedDocument, at: usize, tree: &Tree) -> Result<(), LoadError> {
    let pieces: usize = document.tendons.iter().map(|tendon| tendon.path.len()).sum();
    let referring = document.pairs.len() + document.excludes.len() + document.equalities.len();
    // every copy searches all elements again: without a limit a short document takes quadratic time
    document.looks += 1 + pieces + referring + document.actuators.len() + document.sensors.len();
    let limit = LOOKS.saturating_mul(tree.limits.elements);
    if document.looks > limit {
        let what = "elements that are looked at for what refers to copies";
        return Err(tree.error(at, ErrorKind::TooMuch { what, limit }));
    }
    Ok(())
}

/// Appends the document's keyframes, with a suffix, to its own.
fn move_keys(document: &mut TypedDocument, suffix: &str, at: usize, tree: &Tree) -> Result<(), LoadError> {
    let said = said(document);
    document.copied.add_keys(said, at, tree)?;
    let keys = say_keys(document, ("", suffix), tree)?;
    document.moved_keys.extend(keys);
    Ok(())
}

/// Copies the elements that refer to the original.
fn copy_referring(suffix: &str, names: &mut NameTable, document: &mut TypedDocument) {
    copy_list(&mut document.pairs, suffix, names);
    copy_list(&mut document.excludes, suffix, names);
    let tendons = copy_list(&mut document.tendons, suffix, names);
    let tendons = &document.tendons[tendons..];
    names.add(tendons.iter().map(|tendon| (ElementKind::Tendon, &tendon.name)));
    copy_list(&mut document.equalities, suffix, names);
    let actuators = copy_list(&mut document.actuators, suffix, names);
    let actuators = &document.actuators[actuators..];
    names.add(actuators.iter().map(|actuator| (ElementKind::Actuator, &actuator.name)));
    copy_list(&mut document.sensors, suffix, names);
}

/// Copies elements of a list to its end; returns where the copies begin.
fn copy_list<T: Reference>(list: &mut Vec<T>, suffix: &str, names: &NameTable) -> usize {
    let end = list.len();
    // up to the old end: copies are not copied again
    for at in 0..end {
        let mut copy = list[at].clone();
        if copy.readdress(suffix, names) {
            list[at].forget();
            rename(copy.name(), suffix);
            list.push(copy);
        }
    }
    end
}

/// Removes the elements that refer to the original. Elements whose references never existed stay, so that they are reported as errors.
fn forget_lost(before: &NameTable, document: &mut TypedDocument) {
    let mut now = NameTable::of(document);
    keep(&mut document.pairs, before, &now);
    keep(&mut document.excludes, before, &now);
    let tendons: Vec<String> = document.tendons.iter().map(|tendon| tendon.name.clone()).collect();
    let lost = keep(&mut document.tendons, before, &now);
    forget_names(ElementKind::Tendon, &tendons, lost, &mut now);
    keep(&mut document.equalities, before, &now);
    let actuators: Vec<String> = document
        .actuators
        .iter()
        .map(|actuator| actuator.name.clone())
        .collect();
    let lost = keep(&mut document.actuators, before, &now);
    forget_names(ElementKind::Actuator, &actuators, lost, &mut now);
    keep(&mut document.sensors, before, &now);
}

/// Removes the names of removed elements, and those that MuJoCo 3.3.0 no longer finds: it looks up the rest by their old indices, and the last ones
/// have moved up. Elements that refer to those are also removed.
fn forget_names<T: Reference>(thing: ElementKind, before: &[String], mut lost: Vec<T>, now: &mut NameTable) {
    let left = before.len() - lost.len();
    let taken = lost.iter_mut().map(|element| element.name().clone());
    let gone = taken.chain(before[left..].iter().cloned());
    gone.for_each(|name| now.remove(thing, &name));
}

/// Removes the elements of a list that refer to names that are gone, and returns them.
fn keep<T: Reference>(list: &mut Vec<T>, before: &NameTable, now: &NameTable) -> Vec<T> {
    // with an empty suffix `readdress` asks and changes nothing
    let lost = |element: &mut T| element.readdress("", before) && !element.readdress("", now);
    list.extract_if(.., lost).collect()
}
