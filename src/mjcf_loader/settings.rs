//! Tables of what concerns the whole document: compiler, options, sizes, visual settings, statistics.

use crate::math::Vec3;
use crate::model::{self, ConeType, JacobianFormat, Options, Statistic};

use super::attribute::Sign::{Any, NonNegative, Positive, Unit};
use super::attribute::{FLAG, Kind, TEXT, int, real, reals, words};
use super::schema::Element;
use super::table::{Table, table};
use super::words::{MAX_COUNT, MAX_PIXELS, TRI, Tri};

table! {
    /// `<mujoco>`.
    group Root {
        "model" model: String = "MuJoCo Model".to_owned(), TEXT, "Name of the model.";
    }
}

table! {
    /// `<compiler>`.
    group Compiler {
        "angle" degree: bool = true, words! { "radian" => false, "degree" => true }, "Unit of angles in the document.";
        "eulerseq" eulerseq: [u8; 3] = *b"xyz", Kind::EulerSeq, "Axes of Euler angles; lower case turns with the body.";
        "inertiafromgeom" inertiafromgeom: Tri = Tri::Auto, TRI, "Whether inertia is inferred from geoms; `auto`: only where a body has no `inertial`.";
        "autolimits" autolimits: bool = true, FLAG, "Whether giving a range enables its limit.";
        "texturedir" texturedir: String = String::new(), TEXT, "Directory of the textures.";
        check "coordinate", Kind::Word(&["local"]), "Frame of positions; only the parent's.";
    }
}

table! {
    fields Options {
        "timestep" timestep: f64 = 0.002, real(Positive), "Time step, s.";
        "gravity" gravity: Vec3 = [0.0, 0.0, -9.81], reals(3, Any), "Gravity, m/s^2.";
        "iterations" iterations: usize = 100, int(0, MAX_COUNT), "Maximum number of Newton iterations per step.";
        "tolerance" tolerance: f64 = 1e-8, real(NonNegative), "Improvement or gradient below which Newton's method stops.";
        "ls_iterations" ls_iterations: usize = 50, int(0, MAX_COUNT), "Maximum number of line-search iterations per Newton iteration.";
        "ls_tolerance" ls_tolerance: f64 = 0.01, real(NonNegative), "Tolerance of the line search.";
        "impratio" impratio: f64 = 1.0, real(Positive), "Ratio of frictional to normal constraint impedance.";
        "cone" cone: ConeType = ConeType::Pyramidal, words! { "pyramidal" => ConeType::Pyramidal, "elliptic" => ConeType::Elliptic }, "Shape of the friction cones.";
        "jacobian" jacobian: JacobianFormat = JacobianFormat::Auto, words! { "dense" => JacobianFormat::Dense, "sparse" => JacobianFormat::Sparse, "auto" => JacobianFormat::Auto }, "Format of the constraint Jacobian in MuJoCo. It changes no accelerations; sparse, also equalities without effect keep their rows.";
        "ccd_iterations" ccd_iterations: usize = 50, int(0, MAX_COUNT), "Maximum number of iterations of the convex collision routine.";
        "ccd_tolerance" ccd_tolerance: f64 = 1e-6, real(NonNegative), "Tolerance of the convex collision routine, m.";
        check "integrator", Kind::Word(&["Euler"]), "Integrator; only implicit damping with Euler's method.";
        check "solver", Kind::Word(&["Newton"]), "Solver; only Newton's method.";
    }
}

table! {
    /// `<size>`.
    group Size {
        "nuser_actuator" nuser_actuator: Option<usize> = None, Kind::UserCount, "Length of `user` of actuators; -1 for the longest given.";
        "nuser_cam" nuser_cam: Option<usize> = None, Kind::UserCount, "Length of `user` of cameras; -1 for the longest given.";
        check "nconmax", int(-1, i64::MAX), "Memory of MuJoCo. Ignored.";
        check "njmax", int(-1, i64::MAX), "Memory of MuJoCo. Ignored.";
        check "nstack", int(-1, i64::MAX), "Memory of MuJoCo. Ignored.";
        check "memory", TEXT, "Memory of MuJoCo. Ignored.";
    }
}

table! {
    /// `<visual><global>`.
    group Global {
        "fovy" fovy: f64 = 45.0, real(Positive), "Vertical field of view of the free camera, degrees.";
        "offwidth" offwidth: usize = 640, int(1, MAX_PIXELS), "Width of pictures drawn offscreen, pixels.";
        "offheight" offheight: usize = 480, int(1, MAX_PIXELS), "Height of pictures drawn offscreen, pixels.";
    }
}

table! {
    /// `<visual><map>`.
    group Map {
        "force" force: f64 = 0.005, real(NonNegative), "Scale of forces in MuJoCo's viewer, which are not drawn.";
        "fogstart" fogstart: f64 = 3.0, real(NonNegative), "Start of fog, which is not drawn, times the extent.";
        "fogend" fogend: f64 = 10.0, real(NonNegative), "End of fog, which is not drawn, times the extent.";
        "znear" znear: f64 = 0.01, real(Positive), "Distance of the near plane, times the extent.";
        "zfar" zfar: f64 = 50.0, real(Positive), "Distance of the far plane, times the extent.";
        "haze" haze: f64 = 0.3, real(NonNegative), "Haze at the horizon, which is not drawn, 0..1.";
        "shadowclip" shadowclip: f64 = 1.0, real(NonNegative), "Clip distance of shadows, which are not drawn, times the extent.";
    }
}

table! {
    /// `<visual><quality>`.
    group Quality {
        "shadowsize" shadowsize: usize = 4096, int(0, MAX_PIXELS), "Size of the map of shadows, which are not drawn, pixels.";
        "offsamples" offsamples: usize = 4, int(0, 64), "Samples per pixel of pictures drawn offscreen.";
    }
}

table! {
    /// `<visual><headlight>`.
    group Headlight {
        "active" active: usize = 1, int(0, 1), "Whether the light at the camera is on.";
        "ambient" ambient: [f64; 3] = [0.1; 3], reals(3, Unit), "Ambient colour.";
        "diffuse" diffuse: [f64; 3] = [0.4; 3], reals(3, Unit), "Diffuse colour.";
        "specular" specular: [f64; 3] = [0.5; 3], reals(3, Unit), "Colour of highlights.";
    }
}

table! {
    /// `<visual><rgba>`: colours of what only MuJoCo's viewer draws. Renderers and physics know nothing of them.
    group Rgba {
        check "fog" | "haze" | "force" | "inertia" | "joint" | "actuator" | "actuatornegative" | "actuatorpositive" | "com" | "camera" | "light" | "selectpoint" | "connect" | "contactpoint" | "contactforce" | "contactfriction" | "contacttorque" | "contactgap" | "rangefinder" | "constraint" | "slidercrank" | "crankbroken" | "frustum" | "bv" | "bvactive", reals(4, Any), "Colour in MuJoCo's viewer. Ignored: it is not drawn.";
    }
}

table! {
    fields Statistic {
        "meaninertia" meaninertia: f64 = 0.0, real(Positive), "Mean diagonal of the inertia at `qpos0`, kg m^2; 0 (here and below) means computed.";
        "meanmass" meanmass: f64 = 0.0, real(Positive), "Mean mass of the bodies, kg.";
        "meansize" meansize: f64 = 0.0, real(Positive), "Mean size of the bodies, m.";
        "extent" extent: f64 = 0.0, real(Positive), "Extent of the model, m.";
        "center" center: Vec3 = [f64::NAN; 3], reals(3, Any), "Centre of the model, m; NaN means computed.";
    }
}

/// `<visual>`.
#[derive(Default)]
pub(super) struct Visual {
    pub global: Global,
    pub map: Map,
    pub quality: Quality,
    pub headlight: Headlight,
}

impl Visual {
    pub fn apply(&mut self, e: &Element) {
        match e.name {
            "global" => self.global.apply(e),
            "map" => self.map.apply(e),
            "quality" => self.quality.apply(e),
            "headlight" => self.headlight.apply(e),
            // colours of what is not drawn
            _ => {}
        }
    }

    /// Returns the settings as the model has them: MuJoCo stores reals in single precision.
    pub fn compiled(&self) -> model::Visual {
        let Visual {
            global,
            map,
            quality,
            headlight,
        } = self;
        model::Visual {
            fovy: single(global.fovy),
            znear: single(map.znear),
            zfar: single(map.zfar),
            fogstart: single(map.fogstart),
            fogend: single(map.fogend),
            haze: single(map.haze),
            shadowclip: single(map.shadowclip),
            force: single(map.force),
            shadowsize: quality.shadowsize,
            offsamples: quality.offsamples,
            offwidth: global.offwidth,
            offheight: global.offheight,
            headlight_active: headlight.active != 0,
            headlight_ambient: headlight.ambient.map(single),
            headlight_diffuse: headlight.diffuse.map(single),
            headlight_specular: headlight.specular.map(single),
        }
    }
}

/// Rounds as MuJoCo does where it stores single precision.
pub(super) fn single(value: f64) -> f64 {
    f64::from(value as f32)
}
