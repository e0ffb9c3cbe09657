//! Leaves out visual geoms and unused assets (`discardvisual`).

use std::collections::BTreeSet;

use super::context::Names;
use crate::custom::TupleObject;
use crate::document::{Geom, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::math::order;
use crate::model::{Arrays, GeomType, ObjType};
use crate::relation::TendonElements;
use crate::sensor::{FrameObject, Object};
use crate::xml::Tree;

const MATERIAL: &str = "discardvisual=\"true\" leaves out all materials, and MuJoCo then finds none but those of geoms: remove this material";
const MESH: &str =
    "discardvisual=\"true\" leaves out meshes, and MuJoCo then loses count of those in tuples: remove this element";
const SHIFTED: &str = "discardvisual=\"true\" leaves out geoms in front of the one to which this sensor refers, of which MuJoCo loses count: \
     refer to a site or a body, or leave discardvisual out";

/// Marks the elements that MuJoCo 3.3.0 leaves out with `discardvisual`: textures, materials, and geoms without collision masks that no element
/// names. Such geoms still have mass.
pub(crate) fn leave_out(tree: &Tree, document: &mut TypedDocument) -> Result<(), LoadError> {
    if !document.compilers[0].discardvisual {
        return Ok(());
    }
    // of those that are left out, too
    let all = document.bodies.iter().flat_map(|body| &body.geoms);
    Names::new(tree, "geom", all.map(|geom| (geom.at, &geom.name)))?;
    Names::new(tree, "material", document.materials.iter().map(|m| (m.at, &m.name)))?;
    Names::new(tree, "texture", document.textures.iter().map(|t| (t.at, &t.name)))?;
    let named = named(document);
    let only_drawn = |geom: &Geom| geom.contype == 0 && geom.conaffinity == 0 && !named.contains(&geom.name);
    for geom in document.bodies.iter_mut().flat_map(|body| &mut body.geoms) {
        geom.left_out = only_drawn(geom);
        geom.material = None;
    }
    document.textures.clear();
    document.materials.clear();
    document.flexes.iter_mut().for_each(|flex| flex.look.texcoord.clear());
    let sites = document.bodies.iter().flat_map(|body| &body.sites);
    let others = sites.map(|site| (site.at, &site.material));
    let others = others.chain(
        document
            .tendons
            .iter()
            .map(|tendon| (tendon.at, &tendon.looks.material)),
    );
    let others = others.chain(document.skins.iter().map(|skin| (skin.at, &skin.material)));
    let mut others = others.chain(document.flexes.iter().map(|flex| (flex.at, &flex.look.material)));
    if let Some((at, _)) = others.find(|(_, material)| material.as_ref().is_some_and(|name| !name.is_empty())) {
        return Err(tree.error(at, ErrorKind::Invalid(MATERIAL)));
    }
    let mut listed = document.tuples.iter().flat_map(|tuple| &tuple.elements);
    if let Some(element) = listed.find(|element| element.objtype == Some(TupleObject::Mesh)) {
        return Err(tree.error(element.at, ErrorKind::Invalid(MESH)));
    }
    check_references(tree, document)
}

/// Returns the names of geoms that MuJoCo keeps because other elements name them: pairs, tendons, tuples, and sensors.
fn named(document: &TypedDocument) -> BTreeSet<String> {
    let pairs = document.pairs.iter().flat_map(|pair| [&pair.geom1, &pair.geom2]);
    let along = document.tendons.iter().flat_map(|tendon| &tendon.path);
    let wrapped = along.filter_map(|along| match along {
        TendonElements::Geom(around) => Some(&around.geom),
        _ => None,
    });
    let listed = document.tuples.iter().flat_map(|tuple| &tuple.elements);
    let listed = listed.filter(|element| element.objtype == Some(TupleObject::Geom));
    let sensed = document.sensors.iter().filter_map(|sensor| match &sensor.object {
        Object::Frame(of, _) if of.objtype == FrameObject::Geom => Some(&of.objname),
        Object::User(of) if of.objtype == Some(ObjType::Geom) => of.objname.as_ref(),
        // MuJoCo does not look at the second geom, which `check_references` deals with
        Object::Between(between) => between.geom1.as_ref(),
        _ => None,
    });
    let names = pairs.chain(wrapped).chain(listed.map(|element| &element.objname));
    order::set(names.chain(sensed).filter(|name| !name.is_empty()).cloned())
}

/// Refuses sensors whose reference is a geom that is left out, or a later geom.
fn check_references(tree: &Tree, document: &TypedDocument) -> Result<(), LoadError> {
    let all = document.bodies.iter().flat_map(|body| &body.geoms);
    let before: Vec<&String> = all.take_while(|geom| !geom.left_out).map(|geom| &geom.name).collect();
    let any = document
        .bodies
        .iter()
        .flat_map(|body| &body.geoms)
        .any(|geom| geom.left_out);
    for sensor in &document.sensors {
        let reference = match &sensor.object {
            Object::Frame(_, frame) if frame.reftype == Some(FrameObject::Geom) => frame.refname.as_ref(),
            Object::Between(between) => between.geom2.as_ref(),
            _ => None,
        };
        if any && reference.is_some_and(|name| !before.contains(&name)) {
            return Err(tree.error(sensor.at, ErrorKind::Invalid(SHIFTED)));
        }
    }
    Ok(())
}

/// Drops meshes without a geom.
pub(super) fn drop_meshes(arrays: &mut Arrays) {
    // the ids of height fields count in another list
    let of_mesh = |kind: GeomType, id: Option<usize>| id.filter(|_| kind != GeomType::HField);
    let geoms = arrays.geom_type.iter().zip(&arrays.geom_dataid);
    let used = order::set(geoms.filter_map(|(&kind, &id)| of_mesh(kind, id)));
    for (&kind, id) in arrays.geom_type.iter().zip(&mut arrays.geom_dataid) {
        if let Some(mesh) = of_mesh(kind, *id) {
            *id = Some(used.range(..mesh).count());
        }
    }
    let mut mesh = 0;
    arrays.meshes.retain(|_| {
        mesh += 1;
        used.contains(&(mesh - 1))
    });
}
