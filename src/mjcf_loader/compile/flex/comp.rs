//! `<flexcomp>`: a flex of a given shape, with a body for each vertex.

use super::shapes::FlexShape;
use super::{FLEX_ELEMENTS, indices};
use crate::assets::AssetSource;
use crate::compile::context::Context;
use crate::compile::normalize;
use crate::document::{Body, Inertial, TypedDocument};
use crate::error::{ErrorKind, LoadError};
use crate::flex::{Flex, FlexComp, FlexCompType, FlexDofs};
use crate::formats::mesh::{MeshFormat, Triangles};
use crate::limits::Limits;
use crate::math::{MINVAL, Vec3, add, quat_rotate};
use crate::model::JointType;
use crate::relation::{Equality, EqualityElements, FlexEquality};
use crate::table::Table;
use crate::xml::Tree;

const COUNT: &str = "count must be whole numbers from 1";
const SPACING: &str = "spacing must be at least twice the radius and the margin";
const SCALE: &str = "scale must be positive";
const MASS: &str = "mass and inertiabox must be positive";
const GMSH: &str =
    "files of Gmsh are not read: convert the file to OBJ or STL, or write its points and elements (type=\"direct\")";
const FILE: &str = "a flexcomp of a mesh needs its file";
const FORMAT: &str = "the file of a flexcomp must end in stl, obj or msh";
const SURFACE: &str = "a mesh has triangles: dim must be 2 or 3";
const ORIGIN: &str = "give origin, a point inside of the mesh, for dim=\"3\"";
const WRITTEN: &str = "give point and element: three numbers for each point, dim + 1 for each element";
const PINS: &str = "a pin names a point that is not there";
const PAIRS: &str = "range of a pin must have two numbers for each range";
const GRIDS: &str = "grid and gridrange of pins are for grids of two or three dimensions: dim numbers for each point, twice as many for each range";
const UNUSED: &str =
    "MuJoCo 3.3.0 mixes up the points of a flexcomp with pins of which some belong to no element: remove these points";
const CENTER: &str =
    "a vertex of a radial flexcomp is at the origin of the parent: move the flexcomp, or pin the vertex";

/// Adds the bodies, flexes and equalities of all `<flexcomp>`s. Their files are looked up in `source`.
pub(crate) fn expand_flexes(
    tree: &Tree,
    document: &mut TypedDocument,
    source: &dyn AssetSource,
) -> Result<(), LoadError> {
    if document.flexcomps.is_empty() {
        return Ok(());
    }
    let comps = std::mem::take(&mut document.flexcomps);
    let compilers = document.compilers.clone();
    let context = Context {
        tree,
        compilers: &compilers,
        frames: Vec::new(),
    };
    let mut bodies = Vec::with_capacity(document.bodies.len());
    // places of the document's own bodies
    let mut places = Vec::with_capacity(document.bodies.len());
    let old = std::mem::take(&mut document.bodies);
    let (count, names) = (old.len(), old.iter().map(|body| body.name.clone()).collect::<Vec<_>>());
    let mut old = old.into_iter();
    let mut left = tree.limits.mesh_elements;
    let mut comps = comps.iter().peekable();
    // the bodies of a flexcomp follow those that were read before it, also if it comes after all of them
    for k in 0..=count {
        while let Some(comp) = comps.next_if(|comp| comp.place == k) {
            let made = Vertices::of(&context, comp, &names[comp.body], source, &mut left)?;
            let (what, limit) = ("bodies", tree.limits.bodies);
            if made.bodies.len() + bodies.len() > limit {
                return Err(tree.error(comp.at, ErrorKind::TooMuch { what, limit }));
            }
            let parent = places[comp.body];
            bodies.extend(made.bodies.into_iter().map(|body| Body { parent, ..body }));
            document.flexes.push(made.flex);
            document.equalities.extend(made.equality);
        }
        if let Some(mut body) = old.next() {
            body.parent = places.get(body.parent).copied().unwrap_or(0);
            places.push(bodies.len());
            bodies.push(body);
        }
    }
    document.bodies = bodies;
    Ok(())
}

/// What a `<flexcomp>` becomes.
struct Vertices {
    bodies: Vec<Body>,
    flex: Flex,
    equality: Option<Equality>,
}

impl Vertices {
    fn of(
        context: &Context,
        comp: &FlexComp,
        parent: &str,
        source: &dyn AssetSource,
        left: &mut usize,
    ) -> Result<Self, LoadError> {
        let invalid = |message| context.invalid(comp.at, message);
        let mut comp = comp.clone();
        match comp.kind {
            FlexCompType::Square | FlexCompType::Disc => comp.look.dim = 2,
            FlexCompType::Box | FlexCompType::Cylinder | FlexCompType::Ellipsoid => comp.look.dim = 3,
            _ => {}
        }
        let count = check(&comp).map_err(invalid)?;
        let quat = context.quat_of(comp.at, &comp.frame)?;
        let too_much = || {
            let (what, limit) = (FLEX_ELEMENTS, context.tree.limits.mesh_elements);
            context.error(comp.at, ErrorKind::TooMuch { what, limit })
        };
        let direct = matches!(comp.kind, FlexCompType::Mesh | FlexCompType::Direct);
        let mut shape = match comp.kind {
            FlexCompType::Gmsh => return Err(invalid(GMSH)),
            FlexCompType::Mesh => mesh(context, &comp, source, *left)?,
            FlexCompType::Direct => written(&comp).map_err(invalid)?,
            _ => {
                let points = count.iter().try_fold(1_usize, |all, n| all.checked_mul(*n));
                if points.is_none_or(|points| points > *left) {
                    return Err(too_much());
                }
                FlexShape::of(&comp, count).map_err(invalid)?
            }
        };
        *left = left
            .checked_sub(shape.points.len() + shape.elements.len())
            .ok_or_else(too_much)?;
        if direct && comp.scale != [1.0; 3] {
            for point in &mut shape.points {
                *point = std::array::from_fn(|k| point[k] * comp.scale[k]);
            }
        }
        for point in &mut shape.points {
            *point = add(quat_rotate(quat, *point), comp.frame.pos);
        }
        if (comp.kind == FlexCompType::Grid && comp.look.dim == 3)
            || matches!(comp.kind, FlexCompType::Box | FlexCompType::Cylinder)
        {
            comp.look.flatskin = true;
        }
        let pinned = pinned(&comp, shape.points.len(), count).map_err(invalid)?;
        assemble(comp, shape, pinned, parent, direct).map_err(invalid)
    }
}

/// Checks the numbers of a `<flexcomp>`; returns its numbers of points along the axes.
fn check(comp: &FlexComp) -> Result<[usize; 3], &'static str> {
    let whole = |x: &f64| x.fract() == 0.0 && *x >= 1.0 && *x <= f64::from(i32::MAX);
    let radial = comp.dofs == FlexDofs::Radial && comp.look.dim == 3;
    if !comp.count.iter().all(whole) || (radial && comp.count.contains(&1.0)) {
        return Err(COUNT);
    }
    let least = 2.0 * comp.look.radius + comp.contact.margin;
    let grid = !matches!(
        comp.kind,
        FlexCompType::Mesh | FlexCompType::Gmsh | FlexCompType::Direct
    );
    if grid && comp.spacing.iter().any(|spacing| *spacing < least) {
        return Err(SPACING);
    }
    if comp.scale.iter().any(|scale| *scale < MINVAL) {
        return Err(SCALE);
    }
    if comp.mass < MINVAL || comp.inertiabox < MINVAL {
        return Err(MASS);
    }
    Ok(comp.count.map(|x| x as usize))
}

/// Returns the points and elements given in the document.
fn written(comp: &FlexComp) -> Result<FlexShape, &'static str> {
    let (points, rest) = comp.point.as_chunks::<3>();
    let whole = comp.element.len().is_multiple_of(comp.look.dim + 1);
    if points.is_empty() || comp.element.is_empty() || !rest.is_empty() || !whole {
        return Err(WRITTEN);
    }
    Ok(FlexShape {
        points: points.to_vec(),
        elements: indices(&comp.element, points.len()).ok_or(super::RANGE)?,
        texcoord: Vec::new(),
    })
}

/// Reads the points and elements of a mesh.
fn mesh(context: &Context, comp: &FlexComp, source: &dyn AssetSource, left: usize) -> Result<FlexShape, LoadError> {
    let invalid = |message| context.invalid(comp.at, message);
    let Some(file) = comp.file.as_deref().filter(|file| !file.is_empty()) else {
        return Err(invalid(FILE));
    };
    let format = MeshFormat::of_path(file).ok_or_else(|| invalid(FORMAT))?;
    if comp.look.dim < 2 {
        return Err(invalid(SURFACE));
    }
    if comp.look.dim == 3 && !comp.origin_given {
        return Err(invalid(ORIGIN));
    }
    let path = context.asset_path(comp.at, file, [context.meshdir(comp.at); 2], source)?;
    let bytes = source.read(&path).map_err(|e| context.error(comp.at, e))?;
    let limits = Limits {
        mesh_elements: left,
        ..context.tree.limits.clone()
    };
    let triangles = Triangles::read(&bytes, format, false, &limits).map_err(|error| {
        let (file, message) = (Some(path), error.to_string());
        context.error(comp.at, ErrorKind::Mesh { file, message })
    })?;
    // files of the two other formats have each vertex once, or mean what they say
    let triangles = if format == MeshFormat::Obj {
        triangles.united()
    } else {
        triangles
    };
    let mut shape = FlexShape {
        points: triangles.vert.iter().map(|v| v.map(f64::from)).collect(),
        elements: triangles.face.as_flattened().iter().map(|&v| v as usize).collect(),
        texcoord: Vec::new(),
    };
    if comp.look.dim == 3 {
        shape.filled(comp.origin);
    }
    if shape.elements.is_empty() {
        return Err(invalid(WRITTEN));
    }
    Ok(shape)
}

/// Returns which points are fixed to the parent.
fn pinned(comp: &FlexComp, points: usize, count: [usize; 3]) -> Result<Vec<bool>, &'static str> {
    let mut pinned = vec![comp.rigid; points];
    if comp.rigid {
        return Ok(pinned);
    }
    let dim = comp.look.dim;
    let grid_pins = |pin: &crate::flex::Pin| !pin.grid.is_empty() || !pin.gridrange.is_empty();
    if comp.pins.iter().any(grid_pins) && (comp.kind != FlexCompType::Grid || dim == 1) {
        return Err(GRIDS);
    }
    let all =
        |list: fn(&crate::flex::Pin) -> &Vec<f64>| -> Vec<f64> { comp.pins.iter().flat_map(list).copied().collect() };
    let (range, grid, gridrange) = (all(|pin| &pin.range), all(|pin| &pin.grid), all(|pin| &pin.gridrange));
    for id in indices(&all(|pin| &pin.id), points).ok_or(PINS)? {
        pinned[id] = true;
    }
    if !range.len().is_multiple_of(2) {
        return Err(PAIRS);
    }
    for ends in indices(&range, points).ok_or(PINS)?.as_chunks::<2>().0 {
        (ends[0]..=ends[1]).for_each(|id| pinned[id] = true);
    }
    if !grid.len().is_multiple_of(dim) || !gridrange.len().is_multiple_of(2 * dim) {
        return Err(GRIDS);
    }
    // a point is a range from itself to itself
    let single = grid.chunks_exact(dim).flat_map(|at| [at, at].concat());
    let ranges: Vec<f64> = single.chain(gridrange.iter().copied()).collect();
    let ranges = indices(&ranges, usize::MAX).ok_or(PINS)?;
    for range in ranges.chunks_exact(2 * dim) {
        let (first, last) = range.split_at(dim);
        if (0..dim).any(|k| first[k] >= count[k] || last[k] >= count[k]) {
            return Err(PINS);
        }
        let along = |axis: usize| {
            if axis < dim { first[axis]..=last[axis] } else { 0..=0 }
        };
        let depth = if dim == 3 { count[2] } else { 1 };
        for (x, y) in along(0).flat_map(|x| along(1).map(move |y| (x, y))) {
            for z in along(2) {
                let id = (x * count[1] + y) * depth + z;
                *pinned.get_mut(id).ok_or(PINS)? = true;
            }
        }
    }
    if comp.dofs == FlexDofs::Radial {
        // the centre
        pinned[0] = true;
    }
    Ok(pinned)
}

/// Makes the bodies and the flex.
fn assemble(
    comp: FlexComp,
    shape: FlexShape,
    pinned: Vec<bool>,
    parent: &str,
    direct: bool,
) -> Result<Vertices, &'static str> {
    let FlexShape {
        mut points,
        mut elements,
        texcoord,
    } = shape;
    let (rigid, centered) = (!pinned.contains(&false), !pinned.contains(&true));
    if elements.iter().any(|&v| v >= points.len()) {
        return Err(super::RANGE);
    }
    let mut used = vec![!direct; points.len()];
    elements.iter().for_each(|&v| used[v] = true);
    if used.contains(&false) {
        if !centered {
            return Err(UNUSED);
        }
        let mut number = 0;
        let numbers: Vec<usize> = used
            .iter()
            .map(|&used| {
                let own = number;
                number += usize::from(used);
                own
            })
            .collect();
        elements.iter_mut().for_each(|v| *v = numbers[*v]);
    }
    // over all points: the shares of pinned and unused ones are lost
    let mass = comp.mass / points.len() as f64;
    let inertia = mass * (2.0 * comp.inertiabox * comp.inertiabox) / 3.0;
    let (mut bodies, mut names) = (Vec::new(), Vec::new());
    if rigid {
        names.push(parent.to_owned());
    } else {
        for (i, point) in points.iter_mut().enumerate().filter(|(i, _)| used[*i]) {
            if pinned[i] {
                names.push(parent.to_owned());
                continue;
            }
            let body = vertex(&comp, i, *point, (mass, inertia))?;
            names.push(body.name.clone());
            bodies.push(body);
            *point = [0.0; 3];
        }
    }
    let equality = comp.equality.equality && !rigid;
    let equality = equality.then(|| Equality {
        at: comp.at,
        held: EqualityElements::Flex(FlexEquality {
            flex: comp.name.clone(),
        }),
        solref: comp.equality.solref,
        solimp: comp.equality.solimp,
        ..Equality::initial()
    });
    let mut look = comp.look;
    if !texcoord.is_empty() {
        look.texcoord = texcoord;
    }
    let flex = Flex {
        at: comp.at,
        contact: comp.contact,
        edge: comp.edge,
        elasticity: comp.elasticity,
        bodies: names,
        name: comp.name,
        vertex: if centered {
            Vec::new()
        } else {
            points.as_flattened().to_vec()
        },
        element: elements.iter().map(|&v| v as f64).collect(),
        look,
        ..Flex::initial()
    };
    Ok(Vertices { bodies, flex, equality })
}

/// Makes the body of a vertex.
fn vertex(comp: &FlexComp, i: usize, point: Vec3, (mass, inertia): (f64, f64)) -> Result<Body, &'static str> {
    let mut body = Body {
        at: comp.at,
        name: format!("{}_{i}", comp.name),
        ..Body::initial()
    };
    body.frame.pos = point;
    body.inertial = Some(Inertial {
        at: comp.at,
        mass,
        diaginertia: [inertia; 3],
        ..Inertial::initial()
    });
    let mut slide = |axis: Vec3| {
        let mut joint = comp.joint.clone();
        (joint.at, joint.kind, joint.pos, joint.axis) = (comp.at, JointType::Slide, [0.0; 3], axis);
        body.joints.push(joint);
    };
    if comp.dofs == FlexDofs::Radial {
        let mut axis = point;
        if normalize(&mut axis) == 0.0 {
            return Err(CENTER);
        }
        slide(axis);
    } else {
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            slide(axis);
        }
    }
    Ok(body)
}
