//! `<composite type="cable">`: its bodies, joints, geoms, sites and excludes.

use super::cable_skin::{self, SkinGrid};
use super::insertion::Insertion;
use crate::composite::{Composite, CompositeSkin, CompositeType, Link, Prototypes};
use crate::custom::Text;
use crate::document::{AutoBool, Body, Orientation, TypedDocument};
use crate::error::{ErrorKind, LoadError, UNREAD};
use crate::model::{GeomType, JointType};
use crate::relation::Exclude;
use crate::schema::Element;
use crate::skin::{SKIN_ELEMENTS, Skin};
use crate::table::Table;
use crate::xml::Tree;

const GONE: &str = "MuJoCo 3.3.0 makes only cables: write particles as <replicate>, ropes as type=\"cable\"; cloth, grids and loops are flexes";
const LOST: &str = "MuJoCo 3.3.0 loses a composite in a <replicate> that is not in a body there: put a body around it";
const ONE_BOX: &str =
    "MuJoCo 3.3.0 cannot make a cable of one box, whose skin it hangs at a last body: give it more points";
const SHAPE: &str =
    "the geoms of a cable are capsules, cylinders or boxes: give <geom type=\"capsule\" size=\"0.01\"/>";

/// Returns whether MuJoCo would lose a composite: one in a `<replicate>` without a body around it is not copied. Other frames around it are
/// ignored.
fn is_lost(spot: Insertion, document: &TypedDocument) -> bool {
    let frame = |id: Option<usize>| id.map(|id| &document.frames[id]);
    std::iter::successors(frame(spot.within), |inner| frame(inner.within)).any(|frame| frame.copy.is_some())
}

/// Reads the prototypes of a cable's geoms, sites and joints.
pub(super) fn prototypes(e: &Element) -> Result<Prototypes, &'static str> {
    let mut like = Prototypes::initial();
    for part in &e.children {
        match part.name {
            "geom" => like.geom.apply(part),
            "site" => like.site.apply(part),
            "joint" => like.joint.apply(part),
            // read by `skin` below
            "skin" => {}
            _ => return Err(UNREAD),
        }
    }
    // MuJoCo 3.3.0 ignores the attribute here
    like.joint.limited = AutoBool::Auto;
    if e.children.iter().filter(|part| part.name == "joint").count() > 1 {
        return Err("a cable has one <joint kind=\"main\">");
    }
    if !matches!(like.geom.kind, GeomType::Capsule | GeomType::Cylinder | GeomType::Box) {
        return Err(SHAPE);
    }
    Ok(like)
}

/// Adds a cable.
pub(super) fn cable(e: &Element, spot: Insertion, tree: &Tree, document: &mut TypedDocument) -> Result<(), LoadError> {
    let invalid = |what| tree.error(e.at, ErrorKind::Invalid(what));
    let composite = Composite::read(e);
    if composite.kind == CompositeType::Gone {
        return Err(invalid(GONE));
    }
    if is_lost(spot, document) {
        return Err(invalid(LOST));
    }
    let mut like = prototypes(e).map_err(invalid)?;
    let links = composite.links().map_err(invalid)?;
    let (what, limit) = ("bodies", tree.limits.bodies);
    if document.bodies.len() + links.len() > limit {
        return Err(tree.error(e.at, ErrorKind::TooMuch { what, limit })); // each is a few bytes of text
    }
    // a prototype that is not written has no place, and errors need one
    (like.geom.at, like.site.at, like.joint.at) = (e.at, e.at, e.at);
    let prefix = &composite.prefix;
    // MuJoCo adds this text, and programs that read `text_data` find their own at the same index
    document.texts.push(Text {
        at: e.at,
        name: format!("composite_{prefix}"),
        data: format!("rope_{prefix}"),
    });
    let names = CableNames {
        prefix,
        count: links.len(),
    };
    // only cables of boxes have a skin, as in MuJoCo
    if like.geom.kind == GeomType::Box {
        // checked before the skin is made, because `subgrid` may ask for billions of vertices
        let taken = document.skins.iter().map(Skin::elements).sum();
        let left = tree.limits.mesh_elements.saturating_sub(taken);
        let skin = skin(e, names, like.geom.size, left).map_err(invalid)?;
        let (what, limit) = (SKIN_ELEMENTS, tree.limits.mesh_elements);
        document
            .skins
            .push(skin.ok_or_else(|| tree.error(e.at, ErrorKind::TooMuch { what, limit }))?);
    }
    for (index, link) in links.iter().enumerate() {
        let parent = if index == 0 {
            spot.body
        } else {
            document.bodies.len() - 1
        };
        let body = piece(&composite, &like, link, index, &names);
        document.bodies.push(Body {
            at: e.at,
            parent,
            ..body
        });
        // neighbours overlap at their joint
        if index + 1 < links.len() {
            document.excludes.push(Exclude {
                at: e.at,
                name: String::new(),
                body1: names.of("B", index),
                body2: names.of("B", index + 1),
            });
        }
    }
    Ok(())
}

/// Makes the skin of a cable of boxes with half lengths `size`; `None` if it has more vertices, texture coordinates and faces than are `left`.
fn skin(e: &Element, names: CableNames, size: [f64; 3], left: usize) -> Result<Option<Skin>, &'static str> {
    if names.count == 1 {
        return Err(ONE_BOX);
    }
    let bodies: Vec<_> = (0..names.count).map(|index| names.of("B", index)).collect();
    let like = match e.children.iter().find(|part| part.name == "skin") {
        Some(skin) => CompositeSkin::read(skin),
        None => CompositeSkin {
            at: e.at,
            ..CompositeSkin::initial()
        },
    };
    let band = SkinGrid::new(bodies.len(), like.subgrid);
    let fits = band.elements(like.texcoord) <= left;
    Ok(fits.then(|| cable_skin::skin(&like, band, names.prefix, &bodies, size)))
}

/// The names of a cable's parts. Those of the first and the last body end in `first` and `last`.
#[derive(Clone, Copy)]
struct CableNames<'a> {
    prefix: &'a str,
    /// Number of bodies.
    count: usize,
}

impl CableNames<'_> {
    fn of(&self, kind: &str, index: usize) -> String {
        let Self { prefix, count } = self;
        match index {
            0 => format!("{prefix}{kind}_first"),
            _ if index + 1 == *count => format!("{prefix}{kind}_last"),
            _ => format!("{prefix}{kind}_{index}"),
        }
    }
}

/// Returns a body of a cable: a geom along the link, a joint to the body before, and sites at the ends of the cable.
fn piece(composite: &Composite, like: &Prototypes, link: &Link, index: usize, names: &CableNames) -> Body {
    let (first, last) = (index == 0, index + 1 == names.count);
    let mut body = Body {
        name: names.of("B", index),
        ..Body::initial()
    };
    body.frame.pos = link.pos;
    body.frame.orientation = Orientation::Quat(link.quat);
    let mut geom = like.geom.clone();
    geom.name = format!("{}G{index}", names.prefix);
    // `fromto` would put the length of a box along z and make its other two sides equal
    if geom.kind == GeomType::Box {
        geom.frame.pos = [link.length / 2.0, 0.0, 0.0];
        geom.size[0] = link.length / 2.0;
    } else {
        geom.fromto = Some([0.0, 0.0, 0.0, link.length, 0.0, 0.0]);
    }
    body.geoms.push(geom);
    if !first || composite.initial != "none" {
        let mut joint = like.joint.clone();
        joint.name = names.of("J", index);
        joint.kind = JointType::Ball;
        if first && composite.initial == "free" {
            joint.kind = JointType::Free;
            // the joint of the whole cable, not one between its parts
            (joint.damping, joint.armature, joint.frictionloss) = (0.0, 0.0, 0.0);
        }
        body.joints.push(joint);
    }
    if first || last {
        let mut site = like.site.clone();
        site.name = names.of("S", index);
        site.frame.pos = [if last { link.length } else { 0.0 }, 0.0, 0.0];
        body.sites.push(site);
    }
    body
}
