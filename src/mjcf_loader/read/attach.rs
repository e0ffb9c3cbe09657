//! `<attach>`: copies a body of another model, and the elements that refer to nothing outside it, as MuJoCo 3.3.0 does.

use std::collections::BTreeSet;

use super::flex::COPIED;
use super::insertion::Insertion;
use super::keys::{resize_keys, say_keys};
use crate::attached::{Reference, hanging};
use crate::attachment::{CopyCount, ElementKind, MissingReference};
use crate::compile::stem;
use crate::document::{Attach, Body, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::math::order;
use crate::schema::Element;
use crate::table::Table;
use crate::text::nearest;
use crate::xml::Tree;

const ABSENT: &str = "this refers to something that is not attached, by a name that another element of the document has, which MuJoCo 3.3.0 \
     may take for it: rename that, or attach the body that is meant";

/// Copies a body of another model to the place of the element.
pub(super) fn attach_model(
    e: &Element,
    spot: Insertion,
    tree: &Tree,
    document: &mut TypedDocument,
) -> Result<(), LoadError> {
    let attach = Attach::read(e);
    // out of the document while it is read, because the document is written at the same time
    let Some(mut model) = document.models.remove(&attach.model) else {
        let models = document.models.keys().map(String::as_str);
        return Err(unknown(tree, &attach, "model", &attach.model, models));
    };
    if !model.flexes.is_empty() || !model.flexcomps.is_empty() {
        return Err(tree.error(attach.at, ErrorKind::Invalid(COPIED)));
    }
    let taken = take(&attach, &mut model, spot, tree, document);
    document.models.insert(attach.model, model);
    taken
}

fn unknown<'a>(
    tree: &Tree,
    attach: &Attach,
    kind: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a str>,
) -> LoadError {
    let error = ErrorKind::UnknownName {
        attribute: kind,
        kind,
        name: name.to_owned(),
        nearest: nearest(name, known).map(str::to_owned),
    };
    tree.error(attach.at, error)
}

/// The part of a model that an `<attach>` copies.
pub(super) struct AttachedPart<'a> {
    prefix: &'a str,
    /// The bodies of the model that are copied.
    pub bodies: std::ops::Range<usize>,
    /// The names, in the model, of the elements that are copied.
    names: BTreeSet<(ElementKind, String)>,
    /// Index of the first copied body in the document.
    pub base: usize,
}

impl AttachedPart<'_> {
    /// Changes an element's own name to its name in the document.
    fn rename(&self, name: &mut String) {
        if !name.is_empty() {
            self.refer(name);
        }
    }

    /// Changes a name by which an element refers to another.
    fn refer(&self, name: &mut String) {
        *name = format!("{}{name}", self.prefix);
    }

    /// Changes the name of an asset; an unnamed one is named after its file.
    fn rename_asset(&self, name: &mut String, file: Option<&str>) {
        let whole = stem(name, file);
        if !whole.is_empty() {
            *name = format!("{}{whole}", self.prefix);
        }
    }

    fn refer_asset(&self, name: &mut Option<String>) {
        if let Some(name) = name.as_mut().filter(|name| !name.is_empty()) {
            *name = format!("{}{name}", self.prefix);
        }
    }

    /// Returns whether an element of the model is copied.
    fn has(&self, thing: ElementKind, name: &str) -> bool {
        // a reference to the world keeps its meaning only if the prefix does not change its name
        let world = thing == ElementKind::Body && name == "world" && self.prefix.is_empty();
        world || self.names.contains(&(thing, name.to_owned()))
    }

    /// Changes the names that an element refers to. Returns whether it is copied; if it is not, `absent` gets the missing references.
    fn admit<T: Reference>(&self, element: &mut T, absent: &mut Vec<MissingReference>) -> bool {
        let at = element.at();
        let renamed = !self.prefix.is_empty();
        // with an empty prefix the name does not change, so MuJoCo finds it
        if let Some((thing, name)) = element.left().filter(|_| renamed) {
            absent.push(MissingReference { at, thing, name });
            return false;
        }
        let mut names = element.names();
        let some = T::LOOSE && names.iter().any(|(thing, name)| self.has(*thing, name));
        // MuJoCo looks for the second name as it is written, if the first one is copied: so `world` is found
        let world = |thing: ElementKind, name: &str| some && thing == ElementKind::Body && name == "world";
        let there = |thing: ElementKind, name: &str| self.has(thing, name) || world(thing, name);
        let whole = names.iter().all(|(thing, name)| there(*thing, name));
        for (thing, name) in &mut names {
            let (thing, found) = (*thing, self.has(*thing, name));
            if whole && found {
                self.refer(name);
            } else if !whole && !found {
                // MuJoCo looks for the name with the prefix and, if another name of the element was found, as it is written: `check_absent`
                // refuses documents in which either finds an element by chance
                let mut add = |name: String| absent.push(MissingReference { at, thing, name });
                if some {
                    add(name.clone());
                }
                self.refer(name);
                add(std::mem::take(name));
            }
        }
        whole
    }

    /// Copies the elements of a list whose references are copied; returns the index of each copy.
    fn copy<T: Reference>(
        &self,
        from: &[T],
        to: &mut Vec<T>,
        absent: &mut Vec<MissingReference>,
    ) -> Vec<Option<usize>> {
        let copy = |element: &T| {
            let mut element = element.clone();
            self.admit(&mut element, absent).then(|| {
                self.rename(element.name());
                to.push(element);
                to.len() - 1
            })
        };
        from.iter().map(copy).collect()
    }
}

fn take(
    attach: &Attach,
    model: &mut TypedDocument,
    spot: Insertion,
    tree: &Tree,
    document: &mut TypedDocument,
) -> Result<(), LoadError> {
    // all of the model, because each <attach> copies its assets and examines all its other elements
    document.copied.add(CopyCount::of(model), attach.at, tree)?;
    // before anything is copied, so that the copies take their part of each keyframe with them
    let keys = say_keys(model, (&attach.prefix, ""), tree)?;
    document.moved_keys.extend(keys);
    let bodies = &model.bodies;
    let Some(root) = bodies.iter().position(|body| body.name == attach.body) else {
        let names = bodies.iter().map(|body| &*body.name);
        return Err(unknown(tree, attach, "body", &attach.body, names));
    };
    // children follow their parents, depth first
    let below = bodies[root + 1..].iter().take_while(|body| body.parent >= root).count();
    let mut taking = AttachedPart {
        prefix: &attach.prefix,
        bodies: root..root + 1 + below,
        names: BTreeSet::new(),
        base: document.bodies.len(),
    };
    let taken = bodies[taking.bodies.clone()].iter().flat_map(hanging);
    let named = taken.filter(|(_, name)| !name.is_empty());
    taking.names = order::set(named.map(|(thing, name)| (thing, name.clone())));
    // bodies first, then the elements that refer to them: sensors may refer to copied tendons and actuators
    take_tree(&taking, model, spot, document);
    // keyframes of models that it is made of keep the names that they have there
    document.moved_keys.append(&mut model.moved_keys);
    take_assets(&taking, model, document);
    take_referring(&mut taking, model, document);
    resize_keys(document);
    Ok(())
}

/// Copies bodies with their joints, geoms, sites, cameras and lights, and their frames. The values of keyframes move with a body;
/// a body that is not copied keeps them for the next `<attach>` of this model.
fn take_tree(taking: &AttachedPart, from: &mut TypedDocument, spot: Insertion, document: &mut TypedDocument) {
    let bodies = &from.bodies[taking.bodies.clone()];
    let mut used = vec![false; from.frames.len()];
    // not the frame of the root, which the place of the <attach> replaces
    let inner = bodies.iter().skip(1).filter_map(|body| body.within);
    let mut open: Vec<usize> = inner.chain(bodies.iter().flat_map(withins)).collect();
    while let Some(id) = open.pop() {
        let frame = &from.frames[id];
        if !std::mem::replace(&mut used[id], true) {
            open.extend(frame.within);
            // the pose of a copy is a step from the copy before it, so that must come, too
            open.extend(frame.copy.and_then(|copy| copy.previous));
        }
    }
    let mut places = vec![None; used.len()];
    // frames refer to earlier frames only, so those are copied already
    for (id, frame) in from.frames.iter().enumerate().filter(|(id, _)| used[*id]) {
        let mut frame = frame.clone();
        taking.rename(&mut frame.name);
        frame.within = frame.within.and_then(|within| places[within]);
        if let Some(copied) = &mut frame.copy {
            copied.previous = copied.previous.and_then(|previous| places[previous]);
        }
        places[id] = Some(document.frames.len());
        document.frames.push(frame);
    }
    for (index, original) in from.bodies[taking.bodies.clone()].iter_mut().enumerate() {
        let mut body = original.clone();
        // as MuJoCo does: a second <attach> of the same body finds no values
        original.states.clear();
        original.joints.iter_mut().for_each(|joint| joint.states.clear());
        let moved = |within: Option<usize>| within.and_then(|within| places[within]);
        (body.parent, body.within) = match index {
            0 => (spot.body, spot.within),
            _ => (body.parent - taking.bodies.start + taking.base, moved(body.within)),
        };
        take_body(taking, &mut body, moved);
        document.bodies.push(body);
    }
}

/// Returns the frames of the elements of a body.
fn withins(body: &Body) -> impl Iterator<Item = usize> {
    let joints = body.joints.iter().map(|joint| joint.within);
    let geoms = body.geoms.iter().map(|geom| geom.within);
    let sites = body.sites.iter().map(|site| site.within);
    let cameras = body.cameras.iter().map(|camera| camera.within);
    let lights = body.lights.iter().map(|light| light.within);
    joints.chain(geoms).chain(sites).chain(cameras).chain(lights).flatten()
}

/// Changes the names of a body and of its elements. `moved` maps frames of the model to frames of the document.
fn take_body(taking: &AttachedPart, body: &mut Body, moved: impl Fn(Option<usize>) -> Option<usize>) {
    taking.rename(&mut body.name);
    for joint in &mut body.joints {
        taking.rename(&mut joint.name);
        joint.within = moved(joint.within);
    }
    for geom in &mut body.geoms {
        taking.rename(&mut geom.name);
        taking.refer_asset(&mut geom.material);
        taking.refer_asset(&mut geom.mesh);
        taking.refer_asset(&mut geom.hfield);
        geom.within = moved(geom.within);
    }
    for site in &mut body.sites {
        taking.rename(&mut site.name);
        taking.refer_asset(&mut site.material);
        site.within = moved(site.within);
    }
    for camera in &mut body.cameras {
        taking.rename(&mut camera.name);
        // a target that is not copied becomes an unknown name, which the compiler reports
        camera.target.iter_mut().for_each(|target| taking.rename(target));
        camera.within = moved(camera.within);
    }
    for light in &mut body.lights {
        taking.rename(&mut light.name);
        light.target.iter_mut().for_each(|target| taking.rename(target));
        light.within = moved(light.within);
    }
}

/// Copies assets, skins and custom data, whether anything refers to them or not.
fn take_assets(taking: &AttachedPart, from: &TypedDocument, document: &mut TypedDocument) {
    for texture in &from.textures {
        let mut texture = texture.clone();
        taking.rename_asset(&mut texture.name, texture.file.as_deref());
        document.textures.push(texture);
    }
    for material in &from.materials {
        let mut material = material.clone();
        taking.rename_asset(&mut material.name, None);
        taking.refer_asset(&mut material.texture);
        document.materials.push(material);
    }
    for mesh in &from.meshes {
        let mut mesh = mesh.clone();
        taking.rename_asset(&mut mesh.name, mesh.file.as_deref());
        document.meshes.push(mesh);
    }
    for hfield in &from.hfields {
        let mut hfield = hfield.clone();
        taking.rename_asset(&mut hfield.name, hfield.file.as_deref());
        document.hfields.push(hfield);
    }
    for skin in &from.skins {
        if skin.bones.iter().all(|bone| taking.has(ElementKind::Body, &bone.body)) {
            // MuJoCo 3.3.0 gives the name of a skin no prefix
            let mut skin = skin.clone();
            taking.refer_asset(&mut skin.material);
            skin.bones.iter_mut().for_each(|bone| taking.refer(&mut bone.body));
            document.skins.push(skin);
        }
    }
    for numeric in &from.numerics {
        let mut numeric = numeric.clone();
        taking.rename_asset(&mut numeric.name, None);
        document.numerics.push(numeric);
    }
    for text in &from.texts {
        let mut text = text.clone();
        taking.rename_asset(&mut text.name, None);
        document.texts.push(text);
    }
}

/// Copies the elements that refer to others, if all of those are copied.
fn take_referring(taking: &mut AttachedPart, from: &mut TypedDocument, document: &mut TypedDocument) {
    let absent = &mut document.absent;
    taking.copy(&from.pairs, &mut document.pairs, absent);
    taking.copy(&from.excludes, &mut document.excludes, absent);
    let tendons = taking.copy(&from.tendons, &mut document.tendons, absent);
    let names = from
        .tendons
        .iter()
        .zip(&tendons)
        .filter(|(tendon, place)| place.is_some() && !tendon.name.is_empty());
    // only now, as equalities, actuators and sensors may refer to tendons that were copied
    let names = names.map(|(tendon, _)| (ElementKind::Tendon, tendon.name.clone()));
    taking.names.extend(names);
    taking.copy(&from.equalities, &mut document.equalities, absent);
    let actuators = taking.copy(&from.actuators, &mut document.actuators, absent);
    let names = from
        .actuators
        .iter()
        .zip(&actuators)
        .filter(|(one, place)| place.is_some() && !one.name.is_empty());
    let names = names.map(|(actuator, _)| (ElementKind::Actuator, actuator.name.clone()));
    taking.names.extend(names);
    taking.copy(&from.sensors, &mut document.sensors, absent);
    let taken = from
        .actuators
        .iter_mut()
        .zip(&actuators)
        .filter(|(_, place)| place.is_some());
    // as with joints, only the first copy gets the values in keyframes
    taken.for_each(|(actuator, _)| actuator.forget());
}

/// Refuses a document in which MuJoCo may find another element for a reference that was not copied. It runs when the whole document is
/// read, because the other element may come later.
pub(super) fn check_absent(tree: &Tree, document: &TypedDocument) -> Result<(), LoadError> {
    if document.absent.is_empty() {
        return Ok(());
    }
    let tendons = document
        .tendons
        .iter()
        .map(|tendon| (ElementKind::Tendon, tendon.name.as_str()));
    let actuators = document
        .actuators
        .iter()
        .map(|actuator| (ElementKind::Actuator, actuator.name.as_str()));
    let hung = document.bodies.iter().flat_map(hanging);
    let hung = hung.map(|(thing, name)| (thing, name.as_str()));
    let names = order::set(hung.chain(tendons).chain(actuators));
    match document
        .absent
        .iter()
        .find(|absent| names.contains(&(absent.thing, absent.name.as_str())))
    {
        Some(absent) => Err(tree.error(absent.at, ErrorKind::Invalid(ABSENT))),
        None => Ok(()),
    }
}
