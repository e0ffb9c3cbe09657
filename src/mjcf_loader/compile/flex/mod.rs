//! Compiles flexes: bodies and positions of vertices, edges, elasticity, surface.

mod comp;
mod shapes;
mod shell;
mod stiffness;

use std::collections::BTreeMap;

use super::context::{Context, Ids, named};
use super::mesh::rows;
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::flex::Flex;
use crate::math::{Quat, Vec3, add, cross, dot, quat_mul, quat_rotate, sub};
use crate::model::{self, Arrays};
use crate::relation::EqualityElements;
pub(crate) use comp::expand_flexes;

/// The kind of elements that a limit on flexes counts.
const FLEX_ELEMENTS: &str = "vertices and elements of flexes";

const VERTEX: &str = "vertex must have three numbers for each vertex";
const ELEMENTS: &str = "element must have dim + 1 whole numbers for each element";
const RANGE: &str = "element names a vertex that the flex does not have";
const REPEATED: &str = "an element names a vertex twice";
const BODIES: &str = "body must name one body for all vertices, or one for each";
const FEW: &str = "a flex needs more vertices than dim";
const TEXCOORD: &str = "there must be two texture coordinates for each vertex";
const CONDIM: &str = "condim must be 1, 3, 4 or 6";
const STIFF: &str = "edges have a stiffness in flexes of lines (dim=\"1\") alone: write <elasticity>";
const POISSON: &str = "poisson must be from 0 to below 0.5";
const THICKNESS: &str = "triangles with young need a positive thickness";
const FLAT: &str = "an element has no area or volume, or numbers too large for elasticity";

/// Vertices of the edges of an element, by dimension.
const EDGES: [&[[usize; 2]]; 3] = [
    &[[0, 1]],
    &[[1, 2], [2, 0], [0, 1]],
    &[[0, 1], [1, 2], [2, 0], [2, 3], [0, 3], [1, 3]],
];

/// Compiles all flexes, once the bodies are compiled.
pub(super) fn compile_flexes(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    if document.flexes.is_empty() {
        return Ok(());
    }
    let poses = global_poses(arrays);
    let mut left = context.tree.limits.mesh_elements;
    for flex in &document.flexes {
        let count = (flex.vertex.len() / 3).max(flex.bodies.len()) + flex.element.len();
        left = left.checked_sub(count).ok_or_else(|| {
            let (what, limit) = (FLEX_ELEMENTS, context.tree.limits.mesh_elements);
            context.error(flex.at, ErrorKind::TooMuch { what, limit })
        })?;
        let bodies = flex.bodies.iter();
        let bodies = bodies.map(|name| ids.body.find(context.tree, flex.at, "body", name));
        let bodies = bodies.collect::<Result<Vec<_>, _>>()?;
        let find = |name: &String| ids.material.find(context.tree, flex.at, "material", name);
        let material = named(&flex.look.material).map(find).transpose()?;
        let invalid = |message| context.invalid(flex.at, message);
        let mut compiled = compile(flex, bodies, &poses, arrays).map_err(invalid)?;
        let holds = |held: &EqualityElements| matches!(held, EqualityElements::Flex(held) if held.flex == flex.name);
        compiled.edgeequality = document.equalities.iter().any(|equality| holds(&equality.held));
        compiled.material = material;
        (compiled.vertadr, compiled.edgeadr) = (arrays.nflexvert(), arrays.nflexedge());
        arrays.flexes.push(compiled);
    }
    Ok(())
}

/// Returns the poses of the document's bodies in the world, each composed with that of its parent.
fn global_poses(arrays: &Arrays) -> Vec<(Vec3, Quat)> {
    let mut poses: Vec<(Vec3, Quat)> = Vec::with_capacity(arrays.nbody());
    for b in 0..arrays.nbody() {
        let own = (arrays.body_pos[b], arrays.body_quat[b]);
        poses.push(match poses.get(arrays.body_parentid[b]) {
            Some(&(pos, quat)) if b > 0 => (add(quat_rotate(quat, own.0), pos), quat_mul(quat, own.1)),
            _ => ([0.0; 3], own.1),
        });
    }
    poses
}

/// Returns whole numbers below `count`.
fn indices(numbers: &[f64], count: usize) -> Option<Vec<usize>> {
    let index = |&x: &f64| (x.fract() == 0.0 && x >= 0.0 && x < count as f64).then_some(x as usize);
    numbers.iter().map(index).collect()
}

fn compile(
    flex: &Flex,
    mut bodies: Vec<usize>,
    poses: &[(Vec3, Quat)],
    arrays: &Arrays,
) -> Result<model::Flex, &'static str> {
    let (dim, contact) = (flex.look.dim, &flex.contact);
    let (vert, rest) = flex.vertex.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(VERTEX);
    }
    let nvert = if vert.is_empty() { bodies.len() } else { vert.len() };
    let mut vert = vert.to_vec();
    vert.resize(nvert, [0.0; 3]);
    if let [single] = bodies[..] {
        bodies.resize(nvert.max(1), single);
    }
    if nvert <= dim {
        return Err(FEW);
    }
    if bodies.len() != nvert {
        return Err(BODIES);
    }
    if flex.edge.stiffness > 0.0 && dim > 1 {
        return Err(STIFF);
    }
    if !matches!(contact.condim, 1 | 3 | 4 | 6) {
        return Err(CONDIM);
    }
    let texcoord: Vec<[f32; 2]> = rows(&flex.look.texcoord, TEXCOORD)?;
    if !texcoord.is_empty() && texcoord.len() != nvert {
        return Err(TEXCOORD);
    }
    if flex.element.is_empty() || !flex.element.len().is_multiple_of(dim + 1) {
        return Err(ELEMENTS);
    }
    let mut elem = indices(&flex.element, nvert).ok_or(RANGE)?;
    let repeats = |e: &[usize]| (1..e.len()).any(|k| e[..k].contains(&e[k]));
    if elem.chunks_exact(dim + 1).any(repeats) {
        return Err(REPEATED);
    }
    let place = |(&b, &v): (&usize, &Vec3)| add(quat_rotate(poses[b].1, v), poses[b].0);
    let places: Vec<Vec3> = bodies.iter().zip(&vert).map(place).collect();
    if dim == 3 {
        turn_outside(&mut elem, &places);
    }
    let rigid = bodies.iter().all(|b| *b == bodies[0]);
    let (edge, elemedge) = edges(&elem, dim);
    let fixed = |&[a, b]: &[usize; 2]| rigid || arrays.body_weldid[bodies[a]] == arrays.body_weldid[bodies[b]];
    let shell = shell::shell(&elem, dim);
    Ok(model::Flex {
        name: flex.name.clone(),
        dim,
        radius: flex.look.radius,
        rigid,
        centered: vert.iter().all(|v| *v == [0.0; 3]),
        vertadr: 0,
        edgeadr: 0,
        edge_rigid: edge.iter().map(fixed).collect(),
        edge_length0: Vec::new(),
        edge_invweight0: Vec::new(),
        stiffness: elasticity(flex, &elem, &places)?,
        vert,
        vertbodyid: bodies,
        edge,
        elem,
        elemedge,
        elemlayer: shell.layer,
        shell: shell.fragments,
        evpair: shell.pairs,
        texcoord,
        damping: flex.elasticity.damping,
        edgestiffness: flex.edge.stiffness,
        edgedamping: flex.edge.damping,
        edgeequality: false,
        contype: contact.contype,
        conaffinity: contact.conaffinity,
        condim: contact.condim,
        priority: contact.priority,
        friction: contact.friction,
        solmix: contact.solmix,
        solref: contact.solref,
        solimp: contact.solimp,
        margin: contact.margin,
        gap: contact.gap,
        internal: contact.internal,
        selfcollide: contact.selfcollide,
        activelayers: contact.activelayers,
        group: flex.look.group,
        material: None,
        rgba: flex.look.rgba.map(|x| f64::from(x as f32)),
        flatskin: flex.look.flatskin,
    })
}

/// Orders the vertices of tetrahedra so that the faces 012, 023, 031 and 132 are counterclockwise from outside.
fn turn_outside(elem: &mut [usize], places: &[Vec3]) {
    for e in elem.chunks_exact_mut(4) {
        let side = |k: usize| sub(places[e[k]], places[e[0]]);
        if dot(cross(side(1), side(2)), side(3)) > 0.0 {
            e.swap(1, 2);
        }
    }
}

/// Returns the edges, in the order of their first use by elements, and those of each element.
fn edges(elem: &[usize], dim: usize) -> (Vec<[usize; 2]>, Vec<usize>) {
    let (mut edges, mut of_elements, mut known) = (Vec::new(), Vec::new(), BTreeMap::new());
    for e in elem.chunks_exact(dim + 1) {
        for &[a, b] in EDGES[dim - 1] {
            let edge = [e[a].min(e[b]), e[a].max(e[b])];
            let id = *known.entry(edge).or_insert(edges.len());
            if id == edges.len() {
                edges.push(edge);
            }
            of_elements.push(id);
        }
    }
    (edges, of_elements)
}

/// Returns the metrics of the elements, or none for a flex without elasticity.
fn elasticity(flex: &Flex, elem: &[usize], places: &[Vec3]) -> Result<Vec<[f64; 21]>, &'static str> {
    let (dim, material) = (flex.look.dim, &flex.elasticity);
    if material.young == 0.0 {
        return Ok(Vec::new());
    }
    if !(0.0..0.5).contains(&material.poisson) {
        return Err(POISSON);
    }
    if dim == 2 && material.thickness <= 0.0 {
        return Err(THICKNESS);
    }
    let metric = |e: &[usize]| match *e {
        [a, b, c] => stiffness::triangle([a, b, c].map(|v| places[v]), material),
        [a, b, c, d] => stiffness::tetrahedron([a, b, c, d].map(|v| places[v]), material),
        _ => [0.0; 21],
    };
    let metrics: Vec<_> = elem.chunks_exact(dim + 1).map(metric).collect();
    if metrics.as_flattened().iter().all(|x| x.is_finite()) {
        Ok(metrics)
    } else {
        Err(FLAT)
    }
}
