//! Models whose bodies `<attach>` takes, the names of what refers to others, and keyframes that come along.

use super::actuator::Actuator;
use super::custom::Key;
use super::document::{Body, Document};
use super::error::{ErrorKind, LoadError};
use super::mesh::Mesh;
use super::relation::{Along, Equality, Exclude, Held, Pair, Tendon, WeldEquality};
use super::sensor::{FrameOf, Object, Sensor};
use super::xml::Tree;
use crate::model::{DynType, ObjType};

/// A kind of element that others refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Thing {
    Body,
    Joint,
    Geom,
    Site,
    Camera,
    Tendon,
    Actuator,
}

/// An element that refers to others, and is left out where they do not come along.
pub(super) trait Referring: Clone {
    /// Whether one of two names, or some names of a tendon, may be those of things of the document itself.
    const LOOSE: bool;

    /// Returns the place in the text.
    fn at(&self) -> usize;

    /// Returns its own name.
    fn name(&mut self) -> &mut String;

    /// Returns the names that it refers to, with the kinds of what they name.
    fn names(&mut self) -> Vec<(Thing, &mut String)>;

    /// Returns what MuJoCo 3.3.0 looks for by its name in the model only, so that the element does not come along under another name:
    /// geoms that a tendon wraps around without a side site.
    fn left(&self) -> Option<(Thing, String)> {
        None
    }
}

/// Says what the elements refer to that have an `at` and a `name`.
macro_rules! referring {
    ($($element:ident, $loose:literal, $this:ident => $names:expr $(, $left:expr)?;)*) => {$(
        impl Referring for $element {
            const LOOSE: bool = $loose;

            fn at(&self) -> usize {
                self.at
            }

            fn name(&mut self) -> &mut String {
                &mut self.name
            }

            fn names(&mut self) -> Vec<(Thing, &mut String)> {
                let $this = self;
                $names
            }

            $(fn left(&self) -> Option<(Thing, String)> {
                $left(self)
            })?
        }
    )*};
}
referring! {
    Pair, true, pair => vec![(Thing::Geom, &mut pair.geom1), (Thing::Geom, &mut pair.geom2)];
    Exclude, true, exclude => vec![(Thing::Body, &mut exclude.body1), (Thing::Body, &mut exclude.body2)];
    Equality, false, equality => held(&mut equality.held);
    Tendon, true, tendon => tendon.path.iter_mut().flat_map(along).collect(), wrapped;
    Actuator, false, actuator => driven(actuator);
    Sensor, true, sensor => measured(&mut sensor.object);
}

/// Returns the names that an equality refers to.
fn held(held: &mut Held) -> Vec<(Thing, &mut String)> {
    let of = |kind, first, second| std::iter::chain(first, second).map(move |name| (kind, name));
    match held {
        Held::Joint(joint) => of(Thing::Joint, Some(&mut joint.joint1), joint.joint2.as_mut()).collect(),
        Held::Tendon(tendon) => of(Thing::Tendon, Some(&mut tendon.tendon1), tendon.tendon2.as_mut()).collect(),
        Held::Connect(ends) | Held::Weld(WeldEquality { ends, .. }) => {
            let bodies = of(Thing::Body, ends.body1.as_mut(), ends.body2.as_mut());
            bodies
                .chain(of(Thing::Site, ends.site1.as_mut(), ends.site2.as_mut()))
                .collect()
        }
    }
}

/// Returns the names of a piece of a tendon.
fn along(piece: &mut Along) -> Vec<(Thing, &mut String)> {
    match piece {
        Along::Joint(joint) => vec![(Thing::Joint, &mut joint.joint)],
        Along::Site(site) => vec![(Thing::Site, &mut site.site)],
        Along::Geom(geom) => {
            let side = geom.sidesite.iter_mut().map(|site| (Thing::Site, site));
            std::iter::once((Thing::Geom, &mut geom.geom)).chain(side).collect()
        }
        Along::Pulley(_) => Vec::new(),
    }
}

/// Returns the first geom that a tendon wraps around without a side site.
fn wrapped(tendon: &Tendon) -> Option<(Thing, String)> {
    tendon.path.iter().find_map(|piece| match piece {
        Along::Geom(geom) if geom.sidesite.as_ref().is_none_or(String::is_empty) => {
            Some((Thing::Geom, geom.geom.clone()))
        }
        _ => None,
    })
}

/// Returns the names that an actuator refers to.
fn driven(actuator: &mut Actuator) -> Vec<(Thing, &mut String)> {
    let (target, at_site) = (&mut actuator.target, &mut actuator.at_site);
    let named = [
        (Thing::Joint, &mut target.joint),
        (Thing::Joint, &mut target.jointinparent),
        (Thing::Tendon, &mut target.tendon),
        (Thing::Site, &mut target.cranksite),
        (Thing::Site, &mut target.slidersite),
        (Thing::Site, &mut at_site.site),
        (Thing::Site, &mut at_site.refsite),
        (Thing::Body, &mut actuator.on_body.body),
    ];
    let given = named
        .into_iter()
        .filter_map(|(kind, name)| Some((kind, name.as_mut()?)));
    given.collect()
}

/// Returns the names that a sensor refers to.
fn measured(object: &mut Object) -> Vec<(Thing, &mut String)> {
    match object {
        Object::Nothing => Vec::new(),
        Object::Site(name) => vec![(Thing::Site, name)],
        Object::Joint(name) => vec![(Thing::Joint, name)],
        Object::Tendon(name) => vec![(Thing::Tendon, name)],
        Object::Actuator(name) => vec![(Thing::Actuator, name)],
        Object::Subtree(name) => vec![(Thing::Body, name)],
        Object::Frame(of, within) => {
            let object = (framed(of.objtype), &mut of.objname);
            let reference = within.refname.iter_mut();
            let kind = framed(within.reftype.unwrap_or(FrameOf::Body));
            std::iter::once(object)
                .chain(reference.map(|name| (kind, name)))
                .collect()
        }
        Object::Picture(picture) => vec![(Thing::Site, &mut picture.site), (Thing::Camera, &mut picture.camera)],
        Object::Between(between) => {
            let named = [
                (Thing::Geom, &mut between.geom1),
                (Thing::Body, &mut between.body1),
                (Thing::Geom, &mut between.geom2),
                (Thing::Body, &mut between.body2),
            ];
            let given = named
                .into_iter()
                .filter_map(|(kind, name)| Some((kind, name.as_mut()?)));
            given.collect()
        }
        Object::User(user) => {
            let kind = match user.objtype {
                Some(ObjType::Joint) => Thing::Joint,
                Some(ObjType::Geom) => Thing::Geom,
                Some(ObjType::Site) => Thing::Site,
                Some(ObjType::Camera) => Thing::Camera,
                Some(ObjType::Tendon) => Thing::Tendon,
                Some(ObjType::Actuator) => Thing::Actuator,
                _ => Thing::Body,
            };
            user.objname.iter_mut().map(|name| (kind, name)).collect()
        }
    }
}

fn framed(of: FrameOf) -> Thing {
    match of {
        FrameOf::Body | FrameOf::XBody => Thing::Body,
        FrameOf::Geom => Thing::Geom,
        FrameOf::Site => Thing::Site,
        FrameOf::Camera => Thing::Camera,
    }
}

/// A keyframe of another model: what it says of all that comes along. The rest is as in `qpos0`.
#[derive(Clone)]
pub(super) struct AttachedKey {
    pub at: usize,
    pub name: String,
    pub time: f64,
    pub parts: Vec<KeyPart>,
}

/// The part of a keyframe that concerns one element.
#[derive(Clone)]
pub(super) struct KeyPart {
    pub of: Keyed,
    pub values: Vec<f64>,
}

/// Of what a keyframe tells something. Bodies and actuators are meant by their place in the document, joints by that in their body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyed {
    Qpos { body: usize, joint: usize },
    Qvel { body: usize, joint: usize },
    Act(usize),
    Ctrl(usize),
    Mpos(usize),
    Mquat(usize),
}

/// Says that a keyframe, one of the document by its place in the list, says the same as one of a model.
#[derive(Clone, Copy)]
pub(super) struct Saying {
    pub key: usize,
    pub as_in: usize,
}

/// A model whose bodies can be attached.
pub(super) struct Attachable {
    pub document: Document,
    /// Parts of the document's keyframes that concern elements of the model that have not come along since they were made, as in MuJoCo,
    /// which keeps it for the next time that something is taken.
    pub said: Said,
}

/// Keyframes by joint, by actuator and by mocap body.
#[derive(Clone, Default)]
pub(super) struct Said {
    pub joints: Vec<Vec<Saying>>,
    pub actuators: Vec<Vec<Saying>>,
    pub mocaps: Vec<Vec<Saying>>,
}

impl Attachable {
    pub fn new(document: Document) -> Self {
        let joints = document.bodies.iter().map(|body| body.joints.len()).sum();
        let mocaps = document.bodies.iter().filter(|body| body.mocap).count();
        let said = Said {
            joints: vec![Vec::new(); joints],
            actuators: vec![Vec::new(); document.actuators.len()],
            mocaps: vec![Vec::new(); mocaps],
        };
        Self { document, said }
    }

    /// Returns the first attribute of a keyframe of the model whose length is another than that of the model's state, and both lengths.
    pub fn misfit(&self, key: &Key) -> Option<(&'static str, usize, usize)> {
        let joints = || self.document.bodies.iter().flat_map(|body| &body.joints);
        let nq: usize = joints().map(|joint| joint.kind.nq()).sum();
        let nv: usize = joints().map(|joint| joint.kind.nv()).sum();
        let na: usize = self.document.actuators.iter().map(na).sum();
        let (nu, nmocap) = (self.said.actuators.len(), self.said.mocaps.len());
        let given = [
            ("qpos", key.qpos.len(), nq),
            ("qvel", key.qvel.len(), nv),
            ("act", key.act.len(), na),
            ("ctrl", key.ctrl.len(), nu),
            ("mpos", key.mpos.len(), 3 * nmocap),
            ("mquat", key.mquat.len(), 4 * nmocap),
        ];
        given
            .into_iter()
            .find(|(_, found, wanted)| *found > 0 && found != wanted)
    }
}

/// Returns the number of activations of an actuator.
pub(super) fn na(actuator: &Actuator) -> usize {
    usize::from(actuator.law.dyntype != DynType::None)
}

/// Returns the kinds and names of what hangs on a body.
pub(super) fn hanging(body: &Body) -> impl Iterator<Item = (Thing, &String)> {
    let joints = body.joints.iter().map(|joint| (Thing::Joint, &joint.name));
    let geoms = body.geoms.iter().map(|geom| (Thing::Geom, &geom.name));
    let sites = body.sites.iter().map(|site| (Thing::Site, &site.name));
    let cameras = body.cameras.iter().map(|camera| (Thing::Camera, &camera.name));
    let own = std::iter::once((Thing::Body, &body.name));
    own.chain(joints).chain(geoms).chain(sites).chain(cameras)
}

/// A reference of an element of a model to one that did not come along, and its name: then the element did not, either.
pub(super) struct Absent {
    pub at: usize,
    pub thing: Thing,
    pub name: String,
}

/// How much was copied or looked at for bodies of other models, which the limits bound: a few bytes of text may ask for all of a model again.
#[derive(Clone, Copy, Default)]
pub(super) struct Amount {
    elements: usize,
    /// Numbers of assets.
    numbers: usize,
    /// Number of parts of keyframes.
    said: usize,
}

impl Amount {
    /// Counts all of a model.
    pub fn of(model: &Attachable) -> Self {
        let from = &model.document;
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
        let said = &model.said;
        Self {
            elements: 1 + hung + referring + pieces + measured + assets + rest,
            numbers,
            said: from.keys.len() * (said.joints.len() + said.actuators.len() + said.mocaps.len()),
        }
    }

    /// Adds others for the element at a place.
    ///
    /// # Errors
    /// It is more than the limits allow.
    pub(super) fn add(&mut self, others: Self, at: usize, tree: &Tree) -> Result<(), LoadError> {
        self.elements += others.elements;
        self.numbers += others.numbers;
        self.said += others.said;
        let limits = &tree.limits;
        for (what, found, limit) in [
            ("elements of attached models", self.elements, limits.elements),
            (
                "numbers in assets of attached models",
                self.numbers,
                limits.mesh_elements,
            ),
            ("numbers in keyframes", self.said, limits.key_numbers),
        ] {
            if found > limit {
                return Err(tree.error(at, ErrorKind::TooMuch { what, limit }));
            }
        }
        Ok(())
    }
}
