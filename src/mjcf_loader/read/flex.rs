//! `<flex>` and `<flexcomp>`: their elements as they are written. The compiler makes the shapes, because some are in files.

use super::Classes;
use super::insertion::Insertion;
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError, UNREAD};
use crate::flex::{Flex, FlexComp, FlexDofs, Pin};
use crate::schema::Element;
use crate::table::Table;

const NODES: &str = "vertices between nodes (node, dof=\"trilinear\") are not simulated: give each vertex a body of its own (dof=\"full\")";
const PARENT: &str = "the body around a flexcomp needs a name";
const HELD: &str = "a flexcomp has elasticity or edges of constant length (equality=\"true\"), not both";
/// Also used where a model is attached.
pub(super) const COPIED: &str = "a flex in a <replicate> or in an attached model is not copied: write it into the document itself, once for each copy";

/// Reads a `<flex>`. An error describes the fault.
pub(super) fn flex(e: &Element) -> Result<Flex, &'static str> {
    if e.text("node").is_some_and(|nodes| !nodes.trim_ascii().is_empty()) {
        return Err(NODES);
    }
    let mut flex = Flex::read(e);
    flex.bodies = flex.body.split_ascii_whitespace().map(str::to_owned).collect();
    flex.body.clear();
    for part in &e.children {
        match part.name {
            "contact" => flex.contact.apply(part),
            "edge" => flex.edge.apply(part),
            "elasticity" => flex.elasticity.apply(part),
            _ => return Err(UNREAD),
        }
    }
    Ok(flex)
}

/// Adds a `<flexcomp>`. Frames around it are ignored, as in MuJoCo.
#[inline(never)]
pub(super) fn flexcomp(
    e: &Element,
    spot: Insertion,
    classes: &Classes,
    document: &mut TypedDocument,
) -> Result<(), LoadError> {
    let wrong = |what| classes.error(e, ErrorKind::Invalid(what));
    let mut comp = FlexComp::read(e);
    for part in &e.children {
        match part.name {
            "contact" => comp.contact.apply(part),
            "edge" => {
                comp.edge.apply(part);
                comp.equality.apply(part);
            }
            "elasticity" => {
                comp.elasticity.apply(part);
                comp.elastic = true;
            }
            "pin" => comp.pins.push(Pin::read(part)),
            _ => return Err(wrong(UNREAD)),
        }
    }
    if comp.dofs == FlexDofs::Trilinear {
        return Err(wrong(NODES));
    }
    if comp.elastic && comp.equality.equality {
        return Err(wrong(HELD));
    }
    if document.bodies[spot.body].name.is_empty() {
        return Err(wrong(PARENT));
    }
    comp.origin_given = e.values().any(|(name, _)| name == "origin");
    (comp.body, comp.place) = (spot.body, document.bodies.len());
    // joints of vertices have the document's defaults, as in MuJoCo
    if let Some(main) = classes.by_name.get(super::MAIN) {
        comp.joint = main.joint.clone();
    }
    document.flexcomps.push(comp);
    Ok(())
}

/// Refuses to copy an element with flexes.
pub(super) fn check_copied(e: &Element, flexes: bool, classes: &Classes) -> Result<(), LoadError> {
    if flexes {
        return Err(classes.error(e, ErrorKind::Invalid(COPIED)));
    }
    Ok(())
}
