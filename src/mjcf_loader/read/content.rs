//! Contents of bodies: child bodies, frames, copies, and their elements.

use super::attach::attach_model;
use super::cable::cable;
use super::insertion::{Insertion, known};
use super::{Classes, flex, replicate, with};
use crate::document::{Body, BodyFrame, Camera, Geom, Inertial, Light, Site, TypedDocument};
use crate::error::{ErrorKind, LoadError, UNREAD};
use crate::joint::{FreeJoint, Joint};
use crate::model::JointType;
use crate::schema::Element;
use crate::table::Table;

/// Reads the elements of a body or of a frame in it, and its child bodies depth first.
pub(super) fn content(
    parent: &Element,
    spot: Insertion,
    around: &str,
    classes: &Classes,
    document: &mut TypedDocument,
) -> Result<(), LoadError> {
    for e in &parent.children {
        let inner = e.text("childclass").unwrap_or(around);
        match e.name {
            "body" => {
                let body = child(e, spot, inner, classes, document)?;
                // the frames around a body place the body, and not its contents once more
                let within = None;
                content(e, Insertion { body, within }, inner, classes, document)?;
            }
            "frame" => {
                let within = Some(frame(e, spot, inner, classes, document)?);
                content(e, Insertion { within, ..spot }, inner, classes, document)?;
            }
            "replicate" => {
                let original = replicate::open(e, spot, inner, classes, document)?;
                // counted before and after the content, because a flexcomp may be deep inside
                let flexes = document.flexcomps.len();
                content(e, original.spot(), inner, classes, document)?;
                flex::check_copied(e, document.flexcomps.len() > flexes, classes)?;
                original.copy(spot, classes.tree, document)?;
            }
            "composite" => cable(e, spot, classes.tree, document)?,
            "flexcomp" => flex::flexcomp(e, spot, classes, document)?,
            "attach" => attach_model(e, spot, classes.tree, document)?,
            _ => hang(e, spot, around, classes, &mut document.bodies)?,
        }
    }
    Ok(())
}

/// Adds a child body. It is separate from `content`, which recurses, so that stack frames stay small.
#[inline(never)]
fn child(
    e: &Element,
    spot: Insertion,
    inner: &str,
    classes: &Classes,
    document: &mut TypedDocument,
) -> Result<usize, LoadError> {
    known(e, inner, classes)?;
    let body = Body {
        parent: spot.body,
        within: spot.within,
        ..Body::read(e)
    };
    document.bodies.push(body);
    Ok(document.bodies.len() - 1)
}

/// Adds a frame. It is separate from `content`, which recurses, so that stack frames stay small.
#[inline(never)]
fn frame(
    e: &Element,
    spot: Insertion,
    inner: &str,
    classes: &Classes,
    document: &mut TypedDocument,
) -> Result<usize, LoadError> {
    known(e, inner, classes)?;
    let frame = BodyFrame {
        within: spot.within,
        ..BodyFrame::read(e)
    };
    document.frames.push(frame);
    Ok(document.frames.len() - 1)
}

/// Reads a `<freejoint>`, which no default class changes.
fn free_joint(e: &Element) -> Joint {
    let FreeJoint { at, name, group, align } = FreeJoint::read(e);
    Joint {
        at,
        name,
        kind: JointType::Free,
        group,
        align,
        ..Joint::initial()
    }
}

const FULL: &str = "fullinertia and an orientation are mutually exclusive";

/// Adds any other element to a body. It is separate from `content`, which recurses, so that stack frames stay small.
#[inline(never)]
fn hang(e: &Element, spot: Insertion, around: &str, classes: &Classes, bodies: &mut [Body]) -> Result<(), LoadError> {
    let (id, within) = (spot.body, spot.within);
    let body = &mut bodies[id];
    match e.name {
        // which the rules keep out of the world itself, but not out of frames in it
        "inertial" | "freejoint" | "joint" if id == 0 => {
            return Err(classes.error(e, ErrorKind::Invalid("the world has no joints and no inertia")));
        }
        // the rules allow one in a body and another in a frame of that body
        "inertial" if body.inertial.is_some() => {
            return Err(classes.error(e, ErrorKind::RepeatedElement("inertial")));
        }
        "inertial" => {
            let given = |names: &[&str]| e.values().any(|(name, _)| names.contains(&name));
            if given(&["fullinertia"]) && given(&["quat", "axisangle", "xyaxes", "zaxis", "euler"]) {
                return Err(classes.error(e, ErrorKind::Invalid(FULL)));
            }
            body.inertial = Some(Inertial::read(e));
        }
        "freejoint" => body.joints.push(free_joint(e)),
        "joint" => {
            let joint = with(&classes.of(e, around)?.joint, e, Joint::apply);
            body.joints.push(Joint { within, ..joint });
        }
        "geom" => {
            let geom = with(&classes.of(e, around)?.geom, e, Geom::apply);
            body.geoms.push(Geom { within, ..geom });
        }
        "site" => {
            let site = with(&classes.of(e, around)?.site, e, Site::apply);
            body.sites.push(Site { within, ..site });
        }
        "camera" => {
            let mut camera: Camera = classes.of(e, around)?.camera.clone();
            camera
                .look(e)
                .map_err(|what| classes.error(e, ErrorKind::Invalid(what)))?;
            body.cameras.push(Camera { within, ..camera });
        }
        "light" => {
            let light = with(&classes.of(e, around)?.light, e, Light::apply);
            body.lights.push(Light { within, ..light });
        }
        _ => return Err(classes.error(e, ErrorKind::Invalid(UNREAD))),
    }
    Ok(())
}
