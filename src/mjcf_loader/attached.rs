//! Models for `<attach>`: the names by which elements refer to others, and the sizes of keyframes.

use std::collections::{BTreeMap, BTreeSet};

use super::actuator::Actuator;
use super::attachment::{CopyCount, ElementKind};
use super::custom::Key;
use super::document::{Body, TypedDocument};
use super::mesh::Mesh;
use super::relation::{Equality, EqualityElements, Exclude, Pair, Tendon, TendonElements, WeldEquality};
use super::sensor::{FrameObject, Object, Sensor};
use crate::model::{DynType, ObjType};

/// An element that refers to others. `<attach>` leaves it out if those are not copied with it.
pub(super) trait Reference: Clone {
    /// Whether one of two names, or some names of a tendon, may belong to elements of the document itself.
    const LOOSE: bool;

    /// Returns the place in the text.
    fn at(&self) -> usize;

    /// Returns its own name.
    fn name(&mut self) -> &mut String;

    /// Returns the names that it refers to, with the kinds of the named elements.
    fn names(&mut self) -> Vec<(ElementKind, &mut String)>;

    /// Returns a name that MuJoCo 3.3.0 looks up in the model only, so that the element is not copied under another name: that of a geom
    /// that a tendon wraps around without a side site.
    fn left(&self) -> Option<(ElementKind, String)> {
        None
    }

    /// Adds `suffix` to the names that it refers to, where the result names something, as MuJoCo 3.3.0 does for a copy of the element; returns
    /// whether MuJoCo makes the copy. With an empty suffix the result tells whether everything that the element refers to exists.
    fn readdress(&mut self, suffix: &str, known: &NameTable) -> bool {
        let mut names = self.names();
        names.retain(|(_, name)| !name.is_empty());
        let found: Vec<bool> = names
            .iter()
            .map(|(thing, name)| known.has(*thing, name, suffix))
            .collect();
        let some = found.contains(&true);
        // one of two names need not be copied if it exists without the suffix
        let there =
            |((thing, name), found): (&(ElementKind, &mut String), &bool)| *found || known.has(*thing, name, "");
        let whole = match (some, Self::LOOSE) {
            // a sensor such as a clock names nothing, so nothing that it needs can be missing
            (false, _) => names.is_empty() && Self::LOOSE,
            (true, true) => names.iter().zip(&found).all(there),
            (true, false) => !found.contains(&false),
        };
        if whole {
            let copied = names.into_iter().zip(found).filter(|(_, found)| *found);
            copied.for_each(|((_, name), _)| name.push_str(suffix));
        }
        whole
    }

    /// Drops its values in keyframes.
    fn forget(&mut self) {}
}

/// The names that elements may refer to.
#[derive(Default)]
pub(super) struct NameTable {
    names: BTreeMap<ElementKind, BTreeSet<String>>,
}

impl NameTable {
    /// Collects the names of bodies with their elements, tendons and actuators.
    pub fn of(document: &TypedDocument) -> Self {
        let mut known = Self::default();
        known.add(document.bodies.iter().flat_map(hanging));
        known.add(
            document
                .tendons
                .iter()
                .map(|tendon| (ElementKind::Tendon, &tendon.name)),
        );
        known.add(
            document
                .actuators
                .iter()
                .map(|actuator| (ElementKind::Actuator, &actuator.name)),
        );
        known
    }

    pub fn add<'a>(&mut self, names: impl Iterator<Item = (ElementKind, &'a String)>) {
        for (thing, name) in names.filter(|(_, name)| !name.is_empty()) {
            self.names.entry(thing).or_default().insert(name.clone());
        }
    }

    pub fn remove(&mut self, thing: ElementKind, name: &str) {
        self.names.entry(thing).or_default().remove(name);
    }

    /// Returns whether an element has the name `name` followed by `suffix`.
    fn has(&self, thing: ElementKind, name: &str, suffix: &str) -> bool {
        let Some(names) = self.names.get(&thing) else {
            return false;
        };
        match suffix {
            "" => names.contains(name),
            _ => names.contains(&format!("{name}{suffix}")),
        }
    }
}

/// Implements [`Reference`] for elements with an `at` and a `name`.
macro_rules! referring {
    ($($element:ident, $loose:literal, $this:ident => $names:expr $(, { $($own:tt)* })?;)*) => {$(
        impl Reference for $element {
            const LOOSE: bool = $loose;

            fn at(&self) -> usize {
                self.at
            }

            fn name(&mut self) -> &mut String {
                &mut self.name
            }

            fn names(&mut self) -> Vec<(ElementKind, &mut String)> {
                let $this = self;
                $names
            }

            $($($own)*)?
        }
    )*};
}
referring! {
    Pair, true, pair => vec![(ElementKind::Geom, &mut pair.geom1), (ElementKind::Geom, &mut pair.geom2)];
    Exclude, true, exclude => vec![(ElementKind::Body, &mut exclude.body1), (ElementKind::Body, &mut exclude.body2)];
    Equality, false, equality => held(&mut equality.held);
    Tendon, true, tendon => tendon.path.iter_mut().flat_map(along).collect(), {
        fn left(&self) -> Option<(ElementKind, String)> {
            wrapped(self)
        }

        fn readdress(&mut self, suffix: &str, known: &NameTable) -> bool {
            thread(&mut self.path, suffix, known)
        }
    };
    Actuator, false, actuator => driven(actuator), {
        fn forget(&mut self) {
            self.states.clear();
        }
    };
    Sensor, true, sensor => measured(&mut sensor.object);
}

/// Returns the names that an equality refers to.
fn held(held: &mut EqualityElements) -> Vec<(ElementKind, &mut String)> {
    let of = |kind, first, second| std::iter::chain(first, second).map(move |name| (kind, name));
    match held {
        EqualityElements::Joint(joint) => {
            of(ElementKind::Joint, Some(&mut joint.joint1), joint.joint2.as_mut()).collect()
        }
        // flexes are not copied
        EqualityElements::Flex(_) => Vec::new(),
        EqualityElements::Tendon(tendon) => {
            of(ElementKind::Tendon, Some(&mut tendon.tendon1), tendon.tendon2.as_mut()).collect()
        }
        EqualityElements::Connect(ends) | EqualityElements::Weld(WeldEquality { ends, .. }) => {
            let bodies = of(ElementKind::Body, ends.body1.as_mut(), ends.body2.as_mut());
            bodies
                .chain(of(ElementKind::Site, ends.site1.as_mut(), ends.site2.as_mut()))
                .collect()
        }
    }
}

/// Returns the names of a piece of a tendon.
fn along(piece: &mut TendonElements) -> Vec<(ElementKind, &mut String)> {
    match piece {
        TendonElements::Joint(joint) => vec![(ElementKind::Joint, &mut joint.joint)],
        TendonElements::Site(site) => vec![(ElementKind::Site, &mut site.site)],
        TendonElements::Geom(geom) => {
            let side = geom.sidesite.iter_mut().map(|site| (ElementKind::Site, site));
            std::iter::once((ElementKind::Geom, &mut geom.geom))
                .chain(side)
                .collect()
        }
        TendonElements::Pulley(_) => Vec::new(),
    }
}

/// Does the same as [`Reference::readdress`] for the path of a tendon. Pieces without copies stay. A piece with a geom and no side site is not
/// copied, because MuJoCo 3.3.0 looks for a side site named like the suffix.
fn thread(path: &mut [TendonElements], suffix: &str, known: &NameTable) -> bool {
    let mut copied = false;
    for piece in path {
        let bare = matches!(piece, TendonElements::Geom(geom) if geom.sidesite.as_ref().is_none_or(String::is_empty));
        let mut names = along(piece);
        names.retain(|(_, name)| !name.is_empty());
        if names.is_empty() {
            continue; // a pulley
        }
        let all = |suffix: &str| names.iter().all(|(thing, name)| known.has(*thing, name, suffix));
        if all(suffix) && (suffix.is_empty() || !bare) {
            names.into_iter().for_each(|(_, name)| name.push_str(suffix));
            copied = true;
        } else if !all("") {
            return false;
        }
    }
    copied
}

/// Returns the first geom that a tendon wraps around without a side site.
fn wrapped(tendon: &Tendon) -> Option<(ElementKind, String)> {
    tendon.path.iter().find_map(|piece| match piece {
        TendonElements::Geom(geom) if geom.sidesite.as_ref().is_none_or(String::is_empty) => {
            Some((ElementKind::Geom, geom.geom.clone()))
        }
        _ => None,
    })
}

/// Returns the names that an actuator refers to.
fn driven(actuator: &mut Actuator) -> Vec<(ElementKind, &mut String)> {
    let (target, at_site) = (&mut actuator.target, &mut actuator.at_site);
    let named = [
        (ElementKind::Joint, &mut target.joint),
        (ElementKind::Joint, &mut target.jointinparent),
        (ElementKind::Tendon, &mut target.tendon),
        (ElementKind::Site, &mut target.cranksite),
        (ElementKind::Site, &mut target.slidersite),
        (ElementKind::Site, &mut at_site.site),
        (ElementKind::Site, &mut at_site.refsite),
        (ElementKind::Body, &mut actuator.on_body.body),
    ];
    let given = named
        .into_iter()
        .filter_map(|(kind, name)| Some((kind, name.as_mut()?)));
    given.collect()
}

/// Returns the names that a sensor refers to.
fn measured(object: &mut Object) -> Vec<(ElementKind, &mut String)> {
    match object {
        Object::Nothing => Vec::new(),
        Object::Site(name) => vec![(ElementKind::Site, name)],
        Object::Joint(name) => vec![(ElementKind::Joint, name)],
        Object::Tendon(name) => vec![(ElementKind::Tendon, name)],
        Object::Actuator(name) => vec![(ElementKind::Actuator, name)],
        Object::Subtree(name) => vec![(ElementKind::Body, name)],
        Object::Frame(of, within) => {
            let object = (framed(of.objtype), &mut of.objname);
            let reference = within.refname.iter_mut();
            // a refname without a reftype is refused when sensors are compiled
            let kind = framed(within.reftype.unwrap_or(FrameObject::Body));
            std::iter::once(object)
                .chain(reference.map(|name| (kind, name)))
                .collect()
        }
        Object::Picture(picture) => vec![
            (ElementKind::Site, &mut picture.site),
            (ElementKind::Camera, &mut picture.camera),
        ],
        Object::Between(between) => {
            let named = [
                (ElementKind::Geom, &mut between.geom1),
                (ElementKind::Body, &mut between.body1),
                (ElementKind::Geom, &mut between.geom2),
                (ElementKind::Body, &mut between.body2),
            ];
            let given = named
                .into_iter()
                .filter_map(|(kind, name)| Some((kind, name.as_mut()?)));
            given.collect()
        }
        Object::User(user) => {
            let kind = match user.objtype {
                Some(ObjType::Joint) => ElementKind::Joint,
                Some(ObjType::Geom) => ElementKind::Geom,
                Some(ObjType::Site) => ElementKind::Site,
                Some(ObjType::Camera) => ElementKind::Camera,
                Some(ObjType::Tendon) => ElementKind::Tendon,
                Some(ObjType::Actuator) => ElementKind::Actuator,
                // an objname without an objtype is refused when sensors are compiled
                _ => ElementKind::Body,
            };
            user.objname.iter_mut().map(|name| (kind, name)).collect()
        }
    }
}

fn framed(of: FrameObject) -> ElementKind {
    match of {
        FrameObject::Body | FrameObject::XBody => ElementKind::Body,
        FrameObject::Geom => ElementKind::Geom,
        FrameObject::Site => ElementKind::Site,
        FrameObject::Camera => ElementKind::Camera,
    }
}

/// The numbers of coordinates of the elements read so far.
#[derive(Clone, Copy, Default)]
pub(super) struct Sizes {
    pub nq: usize,
    pub nv: usize,
    pub na: usize,
    pub nu: usize,
    pub nmocap: usize,
}

impl Sizes {
    pub fn of(document: &TypedDocument) -> Self {
        let joints = || document.bodies.iter().flat_map(|body| &body.joints);
        Self {
            nq: joints().map(|joint| joint.kind.nq()).sum(),
            nv: joints().map(|joint| joint.kind.nv()).sum(),
            na: document.actuators.iter().map(na).sum(),
            nu: document.actuators.len(),
            nmocap: document.bodies.iter().filter(|body| body.mocap).count(),
        }
    }

    /// Returns the number of values of a keyframe.
    fn numbers(&self) -> usize {
        self.nq + self.nv + self.na + self.nu + 7 * self.nmocap
    }

    /// Returns the first attribute of a keyframe whose length differs from that of the state, and both lengths.
    pub fn misfit(&self, key: &Key) -> Option<(&'static str, usize, usize)> {
        let given = [
            ("qpos", key.qpos.len(), self.nq),
            ("qvel", key.qvel.len(), self.nv),
            ("act", key.act.len(), self.na),
            ("ctrl", key.ctrl.len(), self.nu),
            ("mpos", key.mpos.len(), 3 * self.nmocap),
            ("mquat", key.mquat.len(), 4 * self.nmocap),
        ];
        given
            .into_iter()
            // an attribute that is not given has no numbers, and takes its default later
            .find(|(_, found, wanted)| *found > 0 && found != wanted)
    }
}

/// Returns the number of values of a document's keyframes.
pub(super) fn said(document: &TypedDocument) -> usize {
    document.keys.len() * Sizes::of(document).numbers()
}

/// Returns the number of activations of an actuator.
pub(super) fn na(actuator: &Actuator) -> usize {
    usize::from(actuator.law.dyntype != DynType::None)
}

/// Returns the kinds and names of a body and its joints, geoms, sites and cameras.
pub(super) fn hanging(body: &Body) -> impl Iterator<Item = (ElementKind, &String)> {
    let joints = body.joints.iter().map(|joint| (ElementKind::Joint, &joint.name));
    let geoms = body.geoms.iter().map(|geom| (ElementKind::Geom, &geom.name));
    let sites = body.sites.iter().map(|site| (ElementKind::Site, &site.name));
    let cameras = body.cameras.iter().map(|camera| (ElementKind::Camera, &camera.name));
    let own = std::iter::once((ElementKind::Body, &body.name));
    own.chain(joints).chain(geoms).chain(sites).chain(cameras)
}

impl CopyCount {
    /// Counts everything in a model.
    pub fn of(from: &TypedDocument) -> Self {
        let hung: usize = from
            .bodies
            .iter()
            .map(|body| hanging(body).count() + body.lights.len())
            .sum();
        let referring = from.pairs.len() + from.excludes.len() + from.equalities.len() + from.tendons.len();
        let pieces: usize = from.tendons.iter().map(|tendon| tendon.path.len()).sum();
        let measured = from.actuators.len() + from.sensors.len();
        let assets =
            from.textures.len() + from.materials.len() + from.meshes.len() + from.hfields.len() + from.skins.len();
        let rest = from.numerics.len() + from.texts.len() + from.keys.len() + from.frames.len();
        let of_mesh = |mesh: &Mesh| mesh.vertex.len() + mesh.normal.len() + mesh.texcoord.len() + mesh.face.len();
        let numbers: usize = from
            .meshes
            .iter()
            .map(of_mesh)
            .chain(from.hfields.iter().map(|field| field.elevation.len()))
            .chain(
                from.skins
                    .iter()
                    .map(|skin| skin.vertex.len() + skin.face.len() + skin.elements()),
            )
            .chain(from.numerics.iter().map(|numeric| numeric.data.len()))
            .sum();
        Self {
            elements: 1 + hung + referring + pieces + measured + assets + rest,
            numbers,
            said: said(from),
        }
    }
}
