//! Bodies and what hangs on them.

use std::f64::consts::PI;

use crate::math::{
    MINVAL, QUAT_ID, Quat, Vec3, add, mat_t_vec, mat_vec, quat_conj, quat_mul, quat_normalize, quat_rotate,
    quat_to_mat, scale, sub,
};
use crate::model::{self, BodyId, CameraMode, GeomType, JointType, Model};

use super::compile::{Context, Ids};
use super::document::{Body, Camera, Document, Frame, Geom, Joint, Light, Orientation, Site, Tri};
use super::error::{ErrorKind, LoadError};
use super::geometry::{
    EPS, Solid, bounding_radius, inertia, merge, normalize, orientation, principal, segment, size_count, volume,
};
use super::read::single;

/// Compiles all bodies in order, so that ids are grouped by body.
pub(super) fn compile(context: &Context, document: &Document, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    let mut last_dof = Vec::with_capacity(document.bodies.len());
    for (id, body) in document.bodies.iter().enumerate() {
        frame(context, body, id, model)?;
        model.body_jntadr.push(model.jnt_name.len());
        model.body_dofadr.push(model.nv);
        let mut dof = last_dof.get(body.parent).copied().flatten();
        for joint in &body.joints {
            compile_joint(context, joint, body, id, &mut dof, model)?;
        }
        last_dof.push(dof);
        model.body_jntnum.push(body.joints.len());
        model.body_dofnum.push(model.nv - model.body_dofadr[id]);
        if model.body_dofnum[id] > 6 {
            return Err(context.invalid(body.at, "a body can have at most 6 degrees of freedom"));
        }
        model.body_weldid.push(if id == 0 || !body.joints.is_empty() {
            id
        } else {
            model.body_weldid[body.parent]
        });
        model.body_geomadr.push(model.geom_name.len());
        model.body_geomnum.push(body.geoms.len());
        let mut solids = Vec::with_capacity(body.geoms.len());
        for geom in &body.geoms {
            solids.push(compile_geom(context, geom, id, ids, model)?);
        }
        inertial(context, body, id, &solids, model)?;
        for site in &body.sites {
            compile_site(context, site, id, ids, model)?;
        }
        for camera in &body.cameras {
            compile_camera(context, camera, id, ids, model)?;
        }
        for light in &body.lights {
            model.lights.push(compile_light(context, light, id)?);
        }
    }
    subtree_masses(model);
    check_moving_masses(context, document, model)
}

fn frame(context: &Context, body: &Body, id: usize, model: &mut Model) -> Result<(), LoadError> {
    let root = match (id, body.parent) {
        (_, 0) => id,
        (_, parent) => model.body_rootid[parent],
    };
    model.body_name.push(body.name.clone());
    model.body_parentid.push(body.parent);
    model.body_rootid.push(root);
    model.body_pos.push(body.frame.pos);
    model.body_quat.push(quat_of(context, body.at, &body.frame)?);
    model.body_invweight0.push([0.0; 2]);
    Ok(())
}

fn quat_of(context: &Context, at: usize, frame: &Frame) -> Result<Quat, LoadError> {
    orientation(&frame.orientation, context.compiler).map_err(|message| context.invalid(at, message))
}

fn compile_joint(
    context: &Context,
    joint: &Joint,
    body: &Body,
    body_id: usize,
    dof: &mut Option<usize>,
    model: &mut Model,
) -> Result<(), LoadError> {
    let id = model.jnt_name.len();
    let turns = joint.kind == JointType::Hinge && context.compiler.degree;
    let angle = |value: f64| if turns { value * (PI / 180.0) } else { value };
    let mut axis = joint.axis;
    let mut pos = joint.pos;
    let mut limited = false;
    if joint.kind == JointType::Free {
        if body_id == 0 || body.parent != 0 {
            return Err(context.invalid(joint.at, "a free joint can only be in a child of the world"));
        }
        if body.joints.len() > 1 {
            return Err(context.invalid(joint.at, "a free joint must be the only joint of its body"));
        }
        (axis, pos) = ([0.0, 0.0, 1.0], [0.0; 3]);
    } else {
        if normalize(&mut axis) < EPS {
            return Err(context.invalid(joint.at, "the axis is too short"));
        }
        limited = context.limited(joint.at, "range", joint.limited, joint.range)?;
    }
    model.jnt_name.push(joint.name.clone());
    model.jnt_type.push(joint.kind);
    model.jnt_bodyid.push(body_id);
    model.jnt_qposadr.push(model.nq);
    model.jnt_dofadr.push(model.nv);
    model.jnt_pos.push(pos);
    model.jnt_axis.push(axis);
    model.jnt_limited.push(limited);
    // A range that does not limit stays as written.
    model
        .jnt_range
        .push(if limited { joint.range.map(angle) } else { joint.range });
    model.jnt_margin.push(joint.margin);
    model.jnt_stiffness.push(joint.stiffness);
    model.jnt_solref.push(joint.solref_limit);
    model.jnt_solimp.push(joint.solimp_limit);
    model.jnt_group.push(joint.group);
    if joint.kind == JointType::Free {
        let pose = model.body_pos[body_id].into_iter().chain(model.body_quat[body_id]);
        model.qpos0.extend(pose.clone());
        model.qpos_spring.extend(pose);
    } else {
        model.qpos0.push(angle(joint.reference));
        model.qpos_spring.push(angle(joint.springref));
    }
    for _ in 0..joint.kind.nv() {
        model.dof_bodyid.push(body_id);
        model.dof_jntid.push(id);
        model.dof_parentid.push(*dof);
        model.dof_armature.push(joint.armature);
        model.dof_damping.push(joint.damping);
        model.dof_frictionloss.push(joint.frictionloss);
        model.dof_invweight0.push(0.0);
        model.dof_solref.push(joint.solref_friction);
        model.dof_solimp.push(joint.solimp_friction);
        *dof = Some(model.nv);
        model.nv += 1;
    }
    model.nq += joint.kind.nq();
    Ok(())
}

/// Pose and size of a shape, from its frame or from `fromto`.
fn place(
    context: &Context,
    at: usize,
    kind: GeomType,
    mut size: Vec3,
    frame: &Frame,
    fromto: Option<[f64; 6]>,
) -> Result<(Vec3, Quat, Vec3), LoadError> {
    let Some(fromto) = fromto else {
        return Ok((frame.pos, quat_of(context, at, frame)?, size));
    };
    if frame.pos != [0.0; 3] {
        return Err(context.invalid(at, "fromto and a pos that is not 0 exclude each other"));
    }
    let (pos, quat, half) = segment(&fromto);
    match kind {
        GeomType::Capsule | GeomType::Cylinder => size[1] = half,
        GeomType::Box | GeomType::Ellipsoid => size = [size[0], size[0], half],
        GeomType::Plane | GeomType::Sphere => {
            return Err(context.invalid(at, "fromto needs a capsule, cylinder, box or ellipsoid"));
        }
    }
    if half < EPS {
        return Err(context.invalid(at, "the points of fromto are too close"));
    }
    Ok((pos, quat, size))
}

/// The entries of a size that the shape uses must be positive; the extent of a plane may be zero, that is, infinite.
fn check_size(context: &Context, at: usize, kind: GeomType, size: &Vec3) -> Result<(), LoadError> {
    let first = if kind == GeomType::Plane { 2 } else { 0 };
    match size[first..size_count(kind)].iter().find(|value| **value <= 0.0) {
        Some(&value) => Err(context.error(
            at,
            ErrorKind::OutOfRange {
                attribute: "size",
                value,
                want: "positive",
            },
        )),
        None => Ok(()),
    }
}

fn compile_geom(context: &Context, geom: &Geom, body: usize, ids: &Ids, model: &mut Model) -> Result<Solid, LoadError> {
    let (pos, quat, size) = place(context, geom.at, geom.kind, geom.size, &geom.frame, geom.fromto)?;
    check_size(context, geom.at, geom.kind, &size)?;
    if !matches!(geom.condim, 1 | 3 | 4 | 6) {
        return Err(context.invalid(geom.at, "condim must be 1, 3, 4 or 6"));
    }
    if geom.kind == GeomType::Plane && model.body_weldid[body] != 0 {
        return Err(context.invalid(geom.at, "a plane can only be in a body that does not move"));
    }
    let find = |name: &String| ids.material.find(context.tree, geom.at, "material", name);
    model.geom_name.push(geom.name.clone());
    model.geom_type.push(geom.kind);
    model.geom_size.push(size);
    model.geom_bodyid.push(body);
    model.geom_pos.push(pos);
    model.geom_quat.push(quat);
    model.geom_contype.push(geom.contype);
    model.geom_conaffinity.push(geom.conaffinity);
    model.geom_condim.push(geom.condim);
    model.geom_priority.push(geom.priority);
    model.geom_friction.push(geom.friction);
    model.geom_solmix.push(geom.solmix);
    model.geom_solref.push(geom.solref);
    model.geom_solimp.push(geom.solimp);
    model.geom_margin.push(geom.margin);
    model.geom_gap.push(geom.gap);
    model.geom_rbound.push(bounding_radius(geom.kind, &size));
    model.geom_group.push(geom.group);
    model.geom_rgba.push(geom.rgba.map(single));
    model.geom_matid.push(geom.material.as_ref().map(find).transpose()?);
    let volume = volume(geom.kind, &size);
    let mass = match geom.mass {
        Some(mass) if volume > EPS => mass,
        Some(_) => 0.0,
        None => geom.density * volume,
    };
    Ok(Solid {
        pos,
        quat,
        mass,
        inertia: inertia(geom.kind, &size, mass),
    })
}

/// Mass and inertia of a body: explicit, else from its geoms, else none.
fn inertial(context: &Context, body: &Body, id: usize, solids: &[Solid], model: &mut Model) -> Result<(), LoadError> {
    let from_geoms = match context.compiler.inertiafromgeom {
        Tri::No => false,
        Tri::Yes => true,
        Tri::Auto => body.inertial.is_none(),
    };
    let invalid = |message| context.invalid(body.at, message);
    // Without mass the inertial frame repeats the frame of the body in its parent, as in MuJoCo.
    let mut solid = Solid {
        pos: model.body_pos[id],
        quat: model.body_quat[id],
        mass: 0.0,
        inertia: [0.0; 3],
    };
    match (&body.inertial, solids) {
        _ if id == 0 => {}
        (_, [single]) if from_geoms => solid = Solid { ..*single },
        (_, [_, _, ..]) if from_geoms => solid = merge(solids).map_err(invalid)?,
        (Some(given), _) => {
            solid.pos = given.frame.pos;
            solid.quat = quat_of(context, given.at, &given.frame)?;
            (solid.mass, solid.inertia) = (given.mass, given.diaginertia);
            if let Some(full) = &given.fullinertia {
                if !matches!(given.frame.orientation, Orientation::Quat(QUAT_ID)) {
                    return Err(context.invalid(given.at, "fullinertia and an orientation exclude each other"));
                }
                (solid.quat, solid.inertia) = principal(full).map_err(|m| context.invalid(given.at, m))?;
            }
        }
        _ => {}
    }
    let [a, b, c] = solid.inertia;
    if a + b < c || a + c < b || b + c < a {
        return Err(invalid("the principal moments must satisfy A + B >= C"));
    }
    model.body_ipos.push(solid.pos);
    model.body_iquat.push(solid.quat);
    model.body_mass.push(solid.mass);
    model.body_inertia.push(solid.inertia);
    Ok(())
}

fn compile_site(context: &Context, site: &Site, body: usize, ids: &Ids, model: &mut Model) -> Result<(), LoadError> {
    let (pos, quat, size) = place(context, site.at, site.kind, site.size, &site.frame, site.fromto)?;
    check_size(context, site.at, site.kind, &size)?;
    let find = |name: &String| ids.material.find(context.tree, site.at, "material", name);
    model.site_name.push(site.name.clone());
    model.site_type.push(site.kind);
    model.site_bodyid.push(body);
    model.site_size.push(size);
    model.site_pos.push(pos);
    model.site_quat.push(quat);
    model.site_group.push(site.group);
    model.site_rgba.push(site.rgba.map(single));
    model.site_matid.push(site.material.as_ref().map(find).transpose()?);
    Ok(())
}

fn compile_camera(
    context: &Context,
    camera: &Camera,
    body: usize,
    ids: &Ids,
    model: &mut Model,
) -> Result<(), LoadError> {
    let mode = match (&camera.target, camera.targets) {
        (Some(name), true) => CameraMode::TargetBody(BodyId(ids.body.find(context.tree, camera.at, "target", name)?)),
        (None, true) => return Err(context.error(camera.at, ErrorKind::MissingAttribute("target"))),
        (Some(_), false) => {
            return Err(context.invalid(camera.at, "only a camera with mode=\"targetbody\" has a target"));
        }
        (None, false) => CameraMode::Fixed,
    };
    if camera.fovy >= 180.0 {
        let want = "below 180 degrees";
        return Err(context.error(
            camera.at,
            ErrorKind::OutOfRange {
                attribute: "fovy",
                value: camera.fovy,
                want,
            },
        ));
    }
    model.cam_name.push(camera.name.clone());
    model.cam_mode.push(mode);
    model.cam_bodyid.push(body);
    model.cam_pos.push(camera.frame.pos);
    model.cam_quat.push(quat_of(context, camera.at, &camera.frame)?);
    model.cam_fovy.push(camera.fovy);
    Ok(())
}

fn compile_light(context: &Context, light: &Light, body: usize) -> Result<model::Light, LoadError> {
    let mut dir = light.dir;
    if normalize(&mut dir) < EPS {
        return Err(context.invalid(light.at, "the direction is too short"));
    }
    Ok(model::Light {
        name: light.name.clone(),
        bodyid: body,
        directional: light.directional,
        castshadow: light.castshadow,
        pos: light.pos,
        dir,
        ambient: light.ambient.map(single),
        diffuse: light.diffuse.map(single),
        specular: light.specular.map(single),
        attenuation: light.attenuation.map(single),
        cutoff: single(light.cutoff),
        exponent: single(light.exponent),
    })
}

fn subtree_masses(model: &mut Model) {
    model.body_subtreemass = model.body_mass.clone();
    for body in (1..model.body_mass.len()).rev() {
        model.body_subtreemass[model.body_parentid[body]] += model.body_subtreemass[body];
    }
}

/// What moves as one must have mass and inertia, or the joint-space inertia is singular.
fn check_moving_masses(context: &Context, document: &Document, model: &Model) -> Result<(), LoadError> {
    let mut heavy = vec![false; model.body_mass.len()];
    for (body, &weld) in model.body_weldid.iter().enumerate() {
        let inert = model.body_inertia[body].iter().all(|&moment| moment > MINVAL);
        heavy[weld] |= model.body_mass[body] > MINVAL && inert;
    }
    for (id, body) in document.bodies.iter().enumerate() {
        if !body.joints.is_empty() && !heavy[id] {
            return Err(context.invalid(body.at, "a moving body must have mass and inertia"));
        }
    }
    Ok(())
}

/// Relative pose that a weld holds: as written (`relpose`), or, where its quaternion is zero, that at `qpos0`. The
/// position is that of the anchor of body 2, seen from body 1.
pub(super) fn weld_pose(model: &Model, body1: usize, body2: usize, anchor: Vec3, relpose: &[f64; 7]) -> (Vec3, Quat) {
    let [x, y, z, quat @ ..] = *relpose;
    if quat != [0.0; 4] {
        return ([x, y, z], quat_normalize(quat));
    }
    let (pos1, quat1) = pose0(model, body1);
    let (pos2, quat2) = pose0(model, body2);
    let point = add(mat_vec(&quat_to_mat(quat2), anchor), pos2);
    (
        mat_t_vec(&quat_to_mat(quat1), sub(point, pos1)),
        quat_mul(quat_conj(quat1), quat2),
    )
}

/// World pose of a body at `qpos0`, with the roundings of forward kinematics.
fn pose0(model: &Model, body: usize) -> (Vec3, Quat) {
    let mut chain = Vec::new();
    let mut up = body;
    while up != 0 {
        chain.push(up);
        up = model.body_parentid[up];
    }
    let (mut pos, mut quat) = ([0.0; 3], QUAT_ID);
    for &id in chain.iter().rev() {
        if model.body_parentid[id] == 0 {
            (pos, quat) = (model.body_pos[id], model.body_quat[id]);
        } else {
            pos = add(mat_vec(&quat_to_mat(quat), model.body_pos[id]), pos);
            quat = quat_mul(quat, model.body_quat[id]);
        }
        let first = model.body_jntadr[id];
        for joint in first..first + model.body_jntnum[id] {
            if model.jnt_type[joint] == JointType::Hinge {
                // Turning by nothing about an anchor off the origin still rounds.
                let arm = quat_rotate(quat, model.jnt_pos[joint]);
                pos = add(add(arm, pos), scale(arm, -1.0));
            }
        }
        quat = quat_normalize(quat);
    }
    (pos, quat)
}
