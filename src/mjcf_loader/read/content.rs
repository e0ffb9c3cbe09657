//! Contents of bodies: child bodies, frames, copies, and the elements that hang on them.

use super::super::document::{Body, BodyFrame, Camera, Copied, Document, FreeJoint, Geom, Inertial, Joint};
use super::super::document::{Light, Orientation, Replicate, Site};
use super::super::error::{ErrorKind, LoadError, UNREAD};
use super::super::schema::Element;
use super::super::table::Table;
use super::attach::attach_model;
use super::cable::cable;
use super::{Classes, with};
use crate::model::JointType;

/// Where elements are put, and what is added to their names.
#[derive(Clone, Copy)]
pub(super) struct Spot<'a> {
    pub body: usize,
    pub within: Option<usize>,
    pub suffix: &'a str,
    /// Whether what stands here was read before, for another copy that a `<replicate>` makes.
    pub again: bool,
    /// Whether it stands in a `<replicate>`.
    pub copied: bool,
}

impl Spot<'_> {
    /// The world itself.
    pub const WORLD: Self = Spot {
        body: 0,
        within: None,
        suffix: "",
        again: false,
        copied: false,
    };
}

/// Reads what hangs on a body, or stands in a frame of it, and its child bodies depth first.
pub(super) fn content(
    parent: &Element,
    spot: Spot,
    around: &str,
    classes: &Classes,
    document: &mut Document,
) -> Result<(), LoadError> {
    for e in &parent.children {
        let inner = e.text("childclass").unwrap_or(around);
        match e.name {
            "body" => {
                let body = child(e, spot, inner, classes, document)?;
                let within = None;
                content(e, Spot { body, within, ..spot }, inner, classes, document)?;
            }
            "frame" => {
                let within = Some(frame(e, spot, inner, classes, document)?);
                content(e, Spot { within, ..spot }, inner, classes, document)?;
            }
            "replicate" => {
                let (mut number, mut previous) = (0, None);
                while let Some((id, suffix)) = copy(e, spot, (number, previous), inner, classes, document)? {
                    let spot = Spot {
                        body: spot.body,
                        within: Some(id),
                        suffix: &suffix,
                        again: spot.again || number > 0,
                        copied: true,
                    };
                    content(e, spot, inner, classes, document)?;
                    (number, previous) = (number + 1, Some(id));
                }
            }
            "composite" => cable(e, spot, classes.tree, document)?,
            "attach" => attach_model(e, spot, classes.tree, document)?,
            _ => hang(e, spot, around, classes, &mut document.bodies)?,
        }
    }
    Ok(())
}

/// Adds the frame of a copy of what a `<replicate>` holds; returns it with what is added to the names in it, and nothing when there are
/// enough. It is kept out of `content`, which recurses, so that its stack frames stay small.
#[inline(never)]
fn copy(
    e: &Element,
    spot: Spot,
    (number, previous): (usize, Option<usize>),
    inner: &str,
    classes: &Classes,
    document: &mut Document,
) -> Result<Option<(usize, String)>, LoadError> {
    known(e, inner, classes)?;
    let Replicate {
        at,
        count,
        sep,
        offset,
        euler,
    } = Replicate::read(e);
    let count = usize::try_from(count).unwrap_or(0);
    if number >= count {
        return Ok(None);
    }
    let limit = classes.tree.limits.elements;
    if document.frames.len() >= limit {
        let what = "frames and copies of elements";
        return Err(classes.error(e, ErrorKind::TooMuch { what, limit }));
    }
    let mut frame = BodyFrame {
        at,
        within: spot.within,
        copy: Some(Copied { number, previous }),
        ..BodyFrame::initial()
    };
    frame.frame.pos = offset;
    frame.frame.orientation = Orientation::Euler(euler);
    document.frames.push(frame);
    // inner copies are told apart before outer ones
    let digits = count.to_string().len();
    let own = format!("{sep}{number:0digits$}");
    let suffix = format!("{own}{}", spot.suffix);
    document.suffixes.insert(own);
    document.replicates = true;
    Ok(Some((document.frames.len() - 1, suffix)))
}

/// Adds to a name that is given.
fn rename(name: &mut String, spot: Spot) {
    if !name.is_empty() {
        name.push_str(spot.suffix);
    }
}

/// Checks that a default class for children exists.
fn known(e: &Element, class: &str, classes: &Classes) -> Result<(), LoadError> {
    if classes.by_name.contains_key(class) {
        Ok(())
    } else {
        Err(classes.error(e, ErrorKind::UnknownClass(class.to_owned())))
    }
}

/// Adds a child body. It is kept out of `content`, which recurses, so that its stack frames stay small.
#[inline(never)]
fn child(e: &Element, spot: Spot, inner: &str, classes: &Classes, document: &mut Document) -> Result<usize, LoadError> {
    known(e, inner, classes)?;
    let mut body = Body {
        parent: spot.body,
        within: spot.within,
        ..Body::read(e)
    };
    rename(&mut body.name, spot);
    document.bodies.push(body);
    Ok(document.bodies.len() - 1)
}

/// Adds a frame. It is kept out of `content`, which recurses, so that its stack frames stay small.
#[inline(never)]
fn frame(e: &Element, spot: Spot, inner: &str, classes: &Classes, document: &mut Document) -> Result<usize, LoadError> {
    known(e, inner, classes)?;
    let mut frame = BodyFrame {
        within: spot.within,
        ..BodyFrame::read(e)
    };
    rename(&mut frame.name, spot);
    document.frames.push(frame);
    Ok(document.frames.len() - 1)
}

/// Reads a `<freejoint>`, which no default class changes.
fn free_joint(e: &Element, spot: Spot) -> Joint {
    let FreeJoint {
        at,
        mut name,
        group,
        align,
    } = FreeJoint::read(e);
    rename(&mut name, spot);
    Joint {
        at,
        name,
        kind: JointType::Free,
        group,
        align,
        ..Joint::initial()
    }
}

/// Adds any other element to a body. It is kept out of `content`, which recurses, so that its stack frames stay small.
#[inline(never)]
fn hang(e: &Element, spot: Spot, around: &str, classes: &Classes, bodies: &mut [Body]) -> Result<(), LoadError> {
    let (id, within) = (spot.body, spot.within);
    let body = &mut bodies[id];
    match e.name {
        // which the rules keep out of the world itself, but not out of frames in it
        "inertial" | "freejoint" | "joint" if id == 0 => {
            return Err(classes.error(e, ErrorKind::Invalid("the world has no joints and no inertia")));
        }
        "inertial" if body.inertial.is_some() => {
            return Err(classes.error(e, ErrorKind::RepeatedElement("inertial")));
        }
        "inertial" => body.inertial = Some(Inertial::read(e)),
        "freejoint" => body.joints.push(free_joint(e, spot)),
        "joint" => {
            let mut joint = with(&classes.of(e, around)?.joint, e, Joint::apply);
            rename(&mut joint.name, spot);
            body.joints.push(Joint { within, ..joint });
        }
        "geom" => {
            let mut geom = with(&classes.of(e, around)?.geom, e, Geom::apply);
            rename(&mut geom.name, spot);
            body.geoms.push(Geom { within, ..geom });
        }
        "site" => {
            let mut site = with(&classes.of(e, around)?.site, e, Site::apply);
            rename(&mut site.name, spot);
            body.sites.push(Site { within, ..site });
        }
        "camera" => {
            let mut camera: Camera = classes.of(e, around)?.camera.clone();
            camera
                .look(e)
                .map_err(|what| classes.error(e, ErrorKind::Invalid(what)))?;
            rename(&mut camera.name, spot);
            // MuJoCo looks for the body that it aims at among the copies
            camera.target.iter_mut().for_each(|target| rename(target, spot));
            body.cameras.push(Camera { within, ..camera });
        }
        "light" => {
            let mut light = with(&classes.of(e, around)?.light, e, Light::apply);
            rename(&mut light.name, spot);
            // MuJoCo looks for the body that it aims at among the copies
            light.target.iter_mut().for_each(|target| rename(target, spot));
            body.lights.push(Light { within, ..light });
        }
        _ => return Err(classes.error(e, ErrorKind::Invalid(UNREAD))),
    }
    Ok(())
}
