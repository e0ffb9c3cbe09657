//! Compiles bodies with their joints, geoms, sites, cameras and lights.

use super::align::align;
use super::camera::{compile_camera, compile_light};
use super::context::{Context, Ids, UserDataSize, named};
use super::fuse::{KeptBody, places};
use super::geom::{check_size, compile_geom, place};
use super::geometry::{Solid, merge, principal};
use super::joint::compile_joints;
use crate::document::{AutoBool, Body, BodyFrame, Geom, Orientation, ReplicaIndex, Site, TypedDocument};
use crate::error::LoadError;
use crate::math::{MINVAL, Quat, Vec3, add, mat_vec, quat_to_mat};
use crate::model::Arrays;
use crate::settings::single;

/// Compiles all bodies in order, so that ids are grouped by body; returns their elements.
pub(super) fn compile(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<Vec<usize>, LoadError> {
    let places = places(context, document)?;
    let mut last_dof = Vec::with_capacity(places.len());
    let users = UserDataSizes::new(document);
    let limits = &context.tree.limits;
    for (id, place) in places.iter().enumerate() {
        let body = &document.bodies[place.body];
        context.within(body.at, "bodies", limits.bodies, id + 1)?;
        frame(body, place, id, arrays);
        let user = users.body.of(context, body.at, &body.user)?;
        arrays.body_user.push(user);
        arrays.body_gravcomp.push(body.gravcomp);
        // the parent in the document counts, even if it is fused with the world
        if body.mocap && (id == 0 || body.parent != 0 || !body.joints.is_empty()) {
            return Err(context.invalid(body.at, "a mocap body must be a child of the world without joints"));
        }
        arrays.body_mocapid.push(body.mocap.then_some(arrays.nmocap));
        arrays.nmocap += usize::from(body.mocap);
        let above = last_dof.get(place.parent).copied().flatten();
        last_dof.push(compile_joints(context, body, id, above, &users.jnt, arrays)?);
        // bodies without joints move with the first ancestor that has some
        arrays.body_weldid.push(if id == 0 || !body.joints.is_empty() {
            id
        } else {
            arrays.body_weldid[place.parent]
        });
        arrays.body_geomadr.push(arrays.geom_name.len());
        let mut solid = compile_part(context, document, [place.body, id], ids, &users, arrays)?;
        for fused in &place.fused {
            let part = &document.bodies[fused.body];
            // checked, though it is lost with the body, so that fusing hides no error
            users.body.of(context, part.at, &part.user)?;
            let (geom, site) = (arrays.geom_name.len(), arrays.site_name.len());
            let own = compile_part(context, document, [fused.body, id], ids, &users, arrays)?;
            fused.carry(&mut arrays.geom_pos[geom..], &mut arrays.geom_quat[geom..]);
            fused.carry(&mut arrays.site_pos[site..], &mut arrays.site_quat[site..]);
            // the world has no mass
            if id > 0 {
                solid = fused.added_to(solid, own).map_err(|m| context.invalid(part.at, m))?;
            }
        }
        arrays
            .body_geomnum
            .push(arrays.geom_name.len() - arrays.body_geomadr[id]);
        arrays.body_ipos.push(solid.pos);
        arrays.body_iquat.push(solid.quat);
        arrays.body_mass.push(solid.mass);
        arrays.body_inertia.push(solid.inertia);
        for camera in &body.cameras {
            compile_camera(context, camera, id, ids, arrays)?;
            let user = users.cam.of(context, camera.at, &camera.user)?;
            arrays.cam_user.push(user);
        }
        for light in &body.lights {
            arrays.lights.push(compile_light(context, light, id, ids)?);
        }
        // before the next body, because this changes the last entries of the arrays
        align(context, document, place.body, id, arrays);
    }
    scale_masses(context, arrays);
    subtree_masses(arrays);
    check_moving_masses(context, document, &places, arrays)?;
    Ok(places.iter().map(|place| document.bodies[place.body].at).collect())
}

/// The lengths of the user data of bodies, joints, geoms, sites and cameras.
struct UserDataSizes {
    body: UserDataSize,
    jnt: UserDataSize,
    geom: UserDataSize,
    site: UserDataSize,
    cam: UserDataSize,
}

impl UserDataSizes {
    fn new(document: &TypedDocument) -> Self {
        let (size, bodies) = (&document.size, &document.bodies);
        Self {
            body: UserDataSize::new("nuser_body", size.nuser_body, bodies.iter().map(|b| &b.user)),
            jnt: UserDataSize::new(
                "nuser_jnt",
                size.nuser_jnt,
                bodies.iter().flat_map(|b| &b.joints).map(|j| &j.user),
            ),
            geom: UserDataSize::new(
                "nuser_geom",
                size.nuser_geom,
                bodies.iter().flat_map(|b| &b.geoms).map(|g| &g.user),
            ),
            site: UserDataSize::new(
                "nuser_site",
                size.nuser_site,
                bodies.iter().flat_map(|b| &b.sites).map(|s| &s.user),
            ),
            cam: UserDataSize::new(
                "nuser_cam",
                size.nuser_cam,
                bodies.iter().flat_map(|b| &b.cameras).map(|c| &c.user),
            ),
        }
    }
}

fn frame(body: &Body, place: &KeptBody, id: usize, arrays: &mut Arrays) {
    let root = match (id, place.parent) {
        (_, 0) => id,
        (_, parent) => arrays.body_rootid[parent],
    };
    arrays.body_name.push(body.name.clone());
    arrays.body_parentid.push(place.parent);
    arrays.body_rootid.push(root);
    arrays.body_pos.push(place.pos);
    arrays.body_quat.push(place.quat);
}

/// Compiles the geoms and sites of a body of the document as those of `id`, with which it may be fused; returns its inertia.
fn compile_part(
    context: &Context,
    document: &TypedDocument,
    [own, id]: [usize; 2],
    ids: &Ids,
    users: &UserDataSizes,
    arrays: &mut Arrays,
) -> Result<Solid, LoadError> {
    let body = &document.bodies[own];
    let solids = compile_geoms(context, body, id, ids, &users.geom, arrays)?;
    let solid = inertial(context, body, own, &solids)?;
    for site in &body.sites {
        compile_site(context, site, id, ids, arrays)?;
        let user = users.site.of(context, site.at, &site.user)?;
        arrays.site_user.push(user);
    }
    Ok(solid)
}

/// Compiles the geoms of a body; returns those that count for its inertia.
fn compile_geoms(
    context: &Context,
    body: &Body,
    id: usize,
    ids: &Ids,
    user: &UserDataSize,
    arrays: &mut Arrays,
) -> Result<Vec<Solid>, LoadError> {
    let mut solids = Vec::with_capacity(body.geoms.len());
    for geom in &body.geoms {
        let limit = context.tree.limits.geoms;
        context.within(geom.at, "geoms", limit, arrays.geom_name.len() + 1)?;
        let solid = if geom.left_out {
            weigh(context, geom, id, ids, arrays)?
        } else {
            compile_geom(context, geom, id, ids, arrays)?
        };
        // geoms of other groups are only drawn, or only collide
        let [lowest, highest] = context.compiler(body.at).inertiagrouprange;
        if (lowest..=highest).contains(&(geom.group as f64)) {
            solids.push(solid);
        }
        // also for geoms that are left out, so that leaving them out hides no error
        let user = user.of(context, geom.at, &geom.user)?;
        if !geom.left_out {
            arrays.geom_user.push(user);
        }
    }
    Ok(solids)
}

/// Compiles a geom that is left out of the model, for its mass and its errors.
fn weigh(context: &Context, geom: &Geom, body: usize, ids: &Ids, arrays: &mut Arrays) -> Result<Solid, LoadError> {
    let mut aside = Arrays::without_elements(
        String::new(),
        arrays.opt.clone(),
        arrays.vis.clone(),
        arrays.stat.clone(),
    );
    // the arrays that a geom depends on. Meshes are moved, not copied: compiling a geom may fit its mesh, which later geoms see, too
    aside.meshes = std::mem::take(&mut arrays.meshes);
    aside.hfields = std::mem::take(&mut arrays.hfields);
    aside.body_weldid = std::mem::take(&mut arrays.body_weldid);
    let solid = compile_geom(context, geom, body, ids, &mut aside);
    (arrays.meshes, arrays.hfields, arrays.body_weldid) = (aside.meshes, aside.hfields, aside.body_weldid);
    solid
}

/// Returns mass and inertia of body `own` of the document: explicit ones, or else those of its geoms. The world has none.
fn inertial(context: &Context, body: &Body, own: usize, solids: &[Solid]) -> Result<Solid, LoadError> {
    let compiler = context.compiler(body.at);
    let from_geoms = match compiler.inertiafromgeom {
        AutoBool::No => false,
        AutoBool::Yes => true,
        AutoBool::Auto => body.inertial.is_none(),
    };
    let invalid = |message| context.invalid(body.at, message);
    // Without mass the inertial frame repeats the frame of the body as it is written, as in MuJoCo.
    let mut solid = Solid {
        pos: body.frame.pos,
        quat: context.quat_of(body.at, &body.frame)?,
        mass: 0.0,
        inertia: [0.0; 3],
    };
    match (&body.inertial, solids) {
        _ if own == 0 => {}
        // a single geom keeps its axes; `merge` would sort them by moment
        (_, [single]) if from_geoms => solid = Solid { ..*single },
        (_, [_, _, ..]) if from_geoms => solid = merge(solids).map_err(invalid)?,
        (Some(given), _) => {
            solid.pos = given.frame.pos;
            solid.quat = context.quat_of(given.at, &given.frame)?;
            (solid.mass, solid.inertia) = (given.mass, given.diaginertia);
            if let Some(full) = &given.fullinertia {
                (solid.quat, solid.inertia) = principal(full).map_err(|m| context.invalid(given.at, m))?;
            }
        }
        _ => {}
    }
    if own > 0 {
        solid.mass = solid.mass.max(compiler.boundmass);
        solid.inertia = solid.inertia.map(|moment| moment.max(compiler.boundinertia));
    }
    // the moments of no distribution of mass violate the triangle inequality
    let [a, b, c] = solid.inertia;
    if a + b < c || a + c < b || b + c < a {
        if !compiler.balanceinertia {
            return Err(invalid(
                "the principal moments must satisfy A + B >= C; correct them, or set balanceinertia in <compiler>",
            ));
        }
        solid.inertia = [(a + b + c) / 3.0; 3];
    }
    Ok(solid)
}

fn compile_site(context: &Context, site: &Site, body: usize, ids: &Ids, arrays: &mut Arrays) -> Result<(), LoadError> {
    let (pos, quat, size) = place(context, site.at, site.kind, site.size, &site.frame, site.fromto)?;
    let (pos, quat) = context.placed(site.within, pos, quat);
    check_size(context, site.at, site.kind, &size)?;
    let find = |name: &String| ids.material.find(context.tree, site.at, "material", name);
    arrays.site_name.push(site.name.clone());
    arrays.site_type.push(site.kind);
    arrays.site_bodyid.push(body);
    arrays.site_size.push(size);
    arrays.site_pos.push(pos);
    arrays.site_quat.push(quat);
    arrays.site_group.push(site.group);
    arrays.site_rgba.push(site.rgba.map(single));
    arrays.site_matid.push(named(&site.material).map(find).transpose()?);
    Ok(())
}

/// Scales all masses and inertias so that the bodies together weigh `settotalmass`, if it is given.
fn scale_masses(context: &Context, arrays: &mut Arrays) {
    let wanted = context.settings().settotalmass;
    if wanted <= 0.0 {
        return;
    }
    let total: f64 = arrays.body_mass.iter().skip(1).sum();
    // MuJoCo's mjMINVAL keeps a model without mass from dividing by zero
    let scale = (wanted / total.max(MINVAL)).max(MINVAL);
    for (mass, inertia) in arrays.body_mass.iter_mut().zip(&mut arrays.body_inertia).skip(1) {
        *mass *= scale;
        *inertia = inertia.map(|moment| moment * scale);
    }
}

fn subtree_masses(arrays: &mut Arrays) {
    arrays.body_subtreemass = arrays.body_mass.clone();
    // children come after their parents, so a body's sum is complete when it is added to its parent's
    for body in (1..arrays.body_mass.len()).rev() {
        arrays.body_subtreemass[arrays.body_parentid[body]] += arrays.body_subtreemass[body];
    }
}

/// Checks that bodies that move together have mass and inertia, without which the joint-space inertia is singular.
fn check_moving_masses(
    context: &Context,
    document: &TypedDocument,
    places: &[KeptBody],
    arrays: &Arrays,
) -> Result<(), LoadError> {
    let mut heavy = vec![false; arrays.body_mass.len()];
    for (body, &weld) in arrays.body_weldid.iter().enumerate() {
        let inert = arrays.body_inertia[body].iter().all(|&moment| moment > MINVAL);
        heavy[weld] |= arrays.body_mass[body] > MINVAL && inert;
    }
    for (id, place) in places.iter().enumerate() {
        let body = &document.bodies[place.body];
        if !body.joints.is_empty() && !heavy[id] {
            return Err(context.invalid(body.at, "a moving body must have mass and inertia"));
        }
    }
    Ok(())
}

/// Returns the pose of a copy of a `<replicate>`; `own` are the positions of the frames before it. As in MuJoCo 3.3.0 the step
/// to a copy is turned as the copy two before it is, and its own turn is that of all steps at once.
pub(super) fn copied(
    context: &Context,
    frame: &BodyFrame,
    copy: ReplicaIndex,
    own: &[Vec3],
) -> Result<(Vec3, Quat), LoadError> {
    let turned = |times: usize| {
        let mut step = frame.frame;
        if let Orientation::Euler(angles) = &mut step.orientation {
            angles.iter_mut().for_each(|angle| *angle *= times as f64);
        }
        context.quat_of(frame.at, &step)
    };
    let pos = match copy.previous {
        Some(previous) => add(
            own[previous],
            mat_vec(&quat_to_mat(turned(copy.number.saturating_sub(2))?), frame.frame.pos),
        ),
        None => [0.0; 3],
    };
    Ok((pos, turned(copy.number)?))
}
