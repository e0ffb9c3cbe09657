//! Compiles sensors.

use super::context::{Context, Ids, UserDataSize};
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::model::{Arrays, DataType, GeomType, JointType, ObjType, SensorType};
use crate::sensor::{Between, FrameObject, InFrame, InPicture, Object, OfFrame, OfUser, Sensor};

/// Compiles the sensors, whose values follow one another.
pub(super) fn compile_sensors(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let users = document.sensors.iter().map(|sensor| &sensor.user);
    let users = UserDataSize::new("nuser_sensor", document.size.nuser_sensor, users);
    let mut adr = 0;
    for sensor in &document.sensors {
        let user = users.of(context, sensor.at, &sensor.user)?;
        let (dim, data, stage) = match &sensor.object {
            Object::User(user) => (user.dim, user.datatype, user.needstage),
            _ => (sensor.kind.dim(), sensor.kind.datatype(), sensor.kind.needstage()),
        };
        let count = match data {
            DataType::Axis => 3,
            DataType::Quaternion => 4,
            DataType::Real | DataType::Positive => dim,
        };
        if dim != count {
            return Err(context.invalid(sensor.at, "an axis needs dim=\"3\", a quaternion dim=\"4\""));
        }
        let axis = matches!(data, DataType::Axis | DataType::Quaternion);
        // that of a normal bounds a distance
        if axis && sensor.cutoff > 0.0 && sensor.kind != SensorType::GeomNormal {
            return Err(context.invalid(sensor.at, "an axis or a quaternion has no cutoff; remove it"));
        }
        let (object, reference) = sensed(context, sensor, ids, arrays)?;
        arrays.sensor_name.push(sensor.name.clone());
        arrays.sensor_type.push(sensor.kind);
        arrays.sensor_objtype.push(object.0);
        arrays.sensor_objid.push(object.1);
        arrays.sensor_reftype.push(reference.0);
        arrays.sensor_refid.push(reference.1);
        arrays.sensor_cutoff.push(sensor.cutoff);
        arrays.sensor_noise.push(sensor.noise);
        arrays.sensor_dim.push(dim);
        arrays.sensor_datatype.push(data);
        arrays.sensor_needstage.push(stage);
        arrays.sensor_adr.push(adr);
        arrays.sensor_user.push(user);
        adr += dim;
    }
    Ok(())
}

/// An object by kind and id.
type SensedObject = (ObjType, Option<usize>);

const NOTHING: SensedObject = (ObjType::Unknown, None);

/// Finds the object of a sensor, and its reference frame.
fn sensed(
    context: &Context,
    sensor: &Sensor,
    ids: &Ids,
    arrays: &Arrays,
) -> Result<(SensedObject, SensedObject), LoadError> {
    let (tree, at) = (context.tree, sensor.at);
    let object = match &sensor.object {
        Object::Nothing => NOTHING,
        Object::Site(name) => (ObjType::Site, Some(ids.site.find(tree, at, "site", name)?)),
        Object::Subtree(name) => (ObjType::Body, Some(ids.body.find(tree, at, "body", name)?)),
        Object::Joint(name) => (ObjType::Joint, Some(joint(context, sensor, name, ids, arrays)?)),
        Object::Tendon(name) => {
            let tendon = ids.tendon.find(tree, at, "tendon", name)?;
            let of_limit = matches!(
                sensor.kind,
                SensorType::TendonLimitPos | SensorType::TendonLimitVel | SensorType::TendonLimitFrc
            );
            if of_limit && !arrays.tendon_limited[tendon] {
                return Err(context.invalid(at, "the tendon has no limit; give it a range"));
            }
            (ObjType::Tendon, Some(tendon))
        }
        Object::Actuator(name) => (ObjType::Actuator, Some(ids.actuator.find(tree, at, "actuator", name)?)),
        Object::Frame(of, within) => return frames(context, at, of, within, ids),
        Object::Between(between) => return two(context, at, between, ids, arrays),
        Object::Picture(InPicture { site, camera }) => {
            let site = ids.site.find(tree, at, "site", site)?;
            let camera = ids.camera.find(tree, at, "camera", camera)?;
            return Ok(((ObjType::Site, Some(site)), (ObjType::Camera, Some(camera))));
        }
        Object::User(OfUser { objtype, objname, .. }) => match (objtype, objname) {
            (None, None) => NOTHING,
            (Some(_), None) => return Err(context.error(at, ErrorKind::MissingAttribute("objname"))),
            (None, Some(_)) => return Err(context.error(at, ErrorKind::MissingAttribute("objtype"))),
            (Some(kind), Some(name)) => (*kind, Some(any(context, at, *kind, name, ids)?)),
        },
    };
    Ok((object, NOTHING))
}

/// Finds the joint of a sensor. It must have a limit if the sensor measures limits, and otherwise the kind that the sensor measures.
fn joint(context: &Context, sensor: &Sensor, name: &str, ids: &Ids, arrays: &Arrays) -> Result<usize, LoadError> {
    use SensorType::{BallAngVel, BallQuat, JointLimitFrc, JointLimitPos, JointLimitVel};
    let (at, any) = (sensor.at, ids.joint.find(context.tree, sensor.at, "joint", name)?);
    match sensor.kind {
        JointLimitPos | JointLimitVel | JointLimitFrc if !arrays.jnt_limited[any] => {
            Err(context.invalid(at, "the joint has no limit; give it a range"))
        }
        BallQuat | BallAngVel if arrays.jnt_type[any] != JointType::Ball => {
            Err(context.invalid(at, "only ball joints can be used here"))
        }
        JointLimitPos | JointLimitVel | JointLimitFrc | BallQuat | BallAngVel => Ok(any),
        _ => ids.scalar_joint(context, arrays, at, "joint", name),
    }
}

/// Finds the object of a frame sensor, and the object in whose frame it measures.
fn frames(
    context: &Context,
    at: usize,
    of: &OfFrame,
    within: &InFrame,
    ids: &Ids,
) -> Result<(SensedObject, SensedObject), LoadError> {
    let find = |kind, attribute, name: &str| {
        let tree = context.tree;
        Ok::<_, LoadError>(match kind {
            FrameObject::Body => (ObjType::Body, Some(ids.body.find(tree, at, attribute, name)?)),
            FrameObject::XBody => (ObjType::XBody, Some(ids.body.find(tree, at, attribute, name)?)),
            FrameObject::Geom => (ObjType::Geom, Some(ids.geom.find(tree, at, attribute, name)?)),
            FrameObject::Site => (ObjType::Site, Some(ids.site.find(tree, at, attribute, name)?)),
            FrameObject::Camera => (ObjType::Camera, Some(ids.camera.find(tree, at, attribute, name)?)),
        })
    };
    let object = find(of.objtype, "objname", &of.objname)?;
    let reference = match (within.reftype, &within.refname) {
        (Some(kind), Some(name)) => find(kind, "refname", name)?,
        (None, None) => NOTHING,
        (Some(_), None) => return Err(context.error(at, ErrorKind::MissingAttribute("refname"))),
        (None, Some(_)) => return Err(context.error(at, ErrorKind::MissingAttribute("reftype"))),
    };
    Ok((object, reference))
}

/// Finds an object of any kind by its name.
fn any(context: &Context, at: usize, kind: ObjType, name: &str, ids: &Ids) -> Result<usize, LoadError> {
    let names = match kind {
        ObjType::Joint => &ids.joint,
        ObjType::Geom => &ids.geom,
        ObjType::Site => &ids.site,
        ObjType::Camera => &ids.camera,
        ObjType::Tendon => &ids.tendon,
        ObjType::Actuator => &ids.actuator,
        ObjType::Unknown | ObjType::Body | ObjType::XBody => &ids.body,
    };
    names.find(context.tree, at, "objname", name)
}

/// Finds the two geoms, or bodies with geoms, between which a sensor measures.
fn two(
    context: &Context,
    at: usize,
    between: &Between,
    ids: &Ids,
    arrays: &Arrays,
) -> Result<(SensedObject, SensedObject), LoadError> {
    let find = |geom: &Option<String>, body: &Option<String>, [of_geom, of_body]: [&'static str; 2]| {
        Ok::<_, LoadError>(match (geom, body) {
            (Some(name), _) => (ObjType::Geom, Some(ids.geom.find(context.tree, at, of_geom, name)?)),
            (None, Some(name)) => (ObjType::Body, Some(ids.body.find(context.tree, at, of_body, name)?)),
            (None, None) => return Err(context.error(at, ErrorKind::MissingAttribute(of_geom))),
        })
    };
    let first = find(&between.geom1, &between.body1, ["geom1", "body1"])?;
    let second = find(&between.geom2, &between.body2, ["geom2", "body2"])?;
    if first == second {
        return Err(context.invalid(at, "a sensor cannot be between something and itself"));
    }
    let measured = |(kind, id): SensedObject, g: usize| match kind {
        ObjType::Body => Some(arrays.geom_bodyid[g]) == id,
        _ => Some(g) == id,
    };
    let corners = |g: usize| matches!(arrays.geom_type[g], GeomType::Box | GeomType::Mesh);
    if (0..arrays.ngeom()).any(|g| corners(g) && measured(first, g) && measured(second, g)) {
        // in which direction it is out of itself, MuJoCo finds by rounding errors
        let message = "a box or a mesh has no distance from itself: measure between two geoms, or from a body that is another one";
        return Err(context.invalid(at, message));
    }
    let terrain = |g: usize| arrays.geom_type[g] == GeomType::HField;
    if (0..arrays.ngeom()).any(|g| terrain(g) && (measured(first, g) || measured(second, g))) {
        let message = "distances from height fields are not measured: use a rangefinder, or measure from another geom";
        return Err(context.invalid(at, message));
    }
    Ok((first, second))
}
