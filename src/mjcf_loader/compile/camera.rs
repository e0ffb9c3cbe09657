//! Compiles cameras and lights.

use super::context::{Context, Ids};
use super::geometry::{EPS, normalize};
use crate::document::{Camera, Light};
use crate::error::{ErrorKind, LoadError};
use crate::model::{self, Arrays};
use crate::schema::Element;
use crate::settings::single;
use crate::table::Table;

/// Compiles a camera.
pub(super) fn compile_camera(
    context: &Context,
    camera: &Camera,
    body: usize,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let find = |name: &String| ids.body.find(context.tree, camera.at, "target", name);
    arrays.cam_name.push(camera.name.clone());
    arrays.cam_mode.push(camera.mode);
    // kept in every mode: the distance that `trackcom` keeps is measured from it
    arrays
        .cam_targetbodyid
        .push(camera.target.as_ref().map(find).transpose()?);
    arrays.cam_bodyid.push(body);
    let quat = context.quat_of(camera.at, &camera.frame)?;
    let (pos, quat) = context.placed(camera.within, camera.frame.pos, quat);
    arrays.cam_pos.push(pos);
    arrays.cam_quat.push(quat);
    arrays.cam_orthographic.push(camera.orthographic);
    arrays.cam_resolution.push(camera.resolution.map(|v| v as usize));
    let (fovy, intrinsic) = optics(context, camera, arrays.vis.znear)?;
    arrays.cam_fovy.push(fovy);
    arrays.cam_sensorsize.push(camera.sensorsize.map(single));
    arrays.cam_intrinsic.push(intrinsic);
    Ok(())
}

/// Compiles a light.
pub(super) fn compile_light(
    context: &Context,
    light: &Light,
    body: usize,
    ids: &Ids,
) -> Result<model::Light, LoadError> {
    let mut dir = light.dir;
    if normalize(&mut dir) < EPS {
        return Err(context.invalid(light.at, "the direction is too short"));
    }
    let find = |name: &String| ids.body.find(context.tree, light.at, "target", name);
    Ok(model::Light {
        name: light.name.clone(),
        bodyid: body,
        directional: light.directional,
        castshadow: light.castshadow,
        active: light.active,
        pos: context.point(light.within, light.pos),
        dir: context.direction(light.within, dir),
        mode: light.mode,
        targetbodyid: light.target.as_ref().map(find).transpose()?,
        pos0: [0.0; 3],
        poscom0: [0.0; 3],
        dir0: [0.0; 3],
        ambient: light.ambient.map(single),
        diffuse: light.diffuse.map(single),
        specular: light.specular.map(single),
        attenuation: light.attenuation.map(single),
        cutoff: single(light.cutoff),
        exponent: single(light.exponent),
    })
}

/// Returns the vertical field of view of a camera, degrees, with the focal lengths and the principal point of its sensor, m.
fn optics(context: &Context, camera: &Camera, znear: f64) -> Result<(f64, [f64; 4]), LoadError> {
    let (at, attribute) = (camera.at, "fovy");
    if camera.resolution.iter().any(|v| *v < 0.0) {
        return Err(context.invalid(at, "a camera cannot have a negative resolution"));
    }
    let (value, want) = (camera.fovy, "below 180 degrees");
    if camera.sensorsize == [0.0; 2] {
        // MuJoCo's value if none is given
        let near = single(znear);
        return if value < 180.0 {
            Ok((value, [near, near, 0.0, 0.0]))
        } else {
            Err(context.error(at, ErrorKind::OutOfRange { attribute, value, want }))
        };
    }
    if camera.sensorsize.iter().any(|v| *v <= 0.0) || camera.resolution.contains(&0.0) {
        return Err(context.invalid(
            at,
            "a camera with a sensorsize needs both sides of it, and of its resolution, to be positive",
        ));
    }
    let twice = |[x, y]: [f64; 2], [across, down]: [f64; 2]| x * across != 0.0 || y * down != 0.0;
    if twice(camera.focal, camera.focalpixel) || twice(camera.principal, camera.principalpixel) {
        return Err(context.invalid(
            at,
            "a focal length or the principal point is given both in lengths and in pixels: leave one out",
        ));
    }
    // MuJoCo keeps these numbers in single precision
    let mut intrinsic = [0.0; 4];
    for axis in 0..2 {
        let density = single(single(camera.resolution[axis]) / single(camera.sensorsize[axis]));
        let length = |pixels: f64, length: f64| single(single(single(pixels) / density) + single(length));
        intrinsic[axis] = length(camera.focalpixel[axis], camera.focal[axis]);
        intrinsic[2 + axis] = length(camera.principalpixel[axis], camera.principal[axis]);
    }
    if intrinsic[0] <= 0.0 || intrinsic[1] <= 0.0 {
        return Err(context.invalid(
            at,
            "a camera with a sensorsize needs two positive focal lengths: give focal or focalpixel",
        ));
    }
    let half = single(pxfm::f_atan2(0.5 * single(camera.sensorsize[1]), intrinsic[1]));
    Ok((half * 360.0 / std::f64::consts::PI, intrinsic))
}

impl Camera {
    /// Stores the attributes of an element.
    ///
    /// # Errors
    /// A part of its optics is given without the attribute that it is relative to.
    pub(crate) fn look(&mut self, e: &Element) -> Result<(), &'static str> {
        let (focal, principal) = (self.focal, self.principal);
        self.apply(e);
        let given = |name: &str| e.values().any(|(other, _)| other == name);
        // if pixels are given, MuJoCo does not read lengths
        if given("focalpixel") {
            self.focal = focal;
        }
        if given("principalpixel") {
            self.principal = principal;
        }
        let lens = ["focal", "focalpixel"].iter().any(|name| given(name));
        let centre = ["principal", "principalpixel"].iter().any(|name| given(name));
        if (lens || centre) && !given("sensorsize") {
            return Err("focal lengths and principal points need the sensorsize of the camera");
        }
        if given("sensorsize") && !given("resolution") {
            return Err("a sensorsize needs the resolution of the camera");
        }
        if given("sensorsize") && given("fovy") {
            return Err("a camera has either fovy or sensorsize");
        }
        Ok(())
    }
}
