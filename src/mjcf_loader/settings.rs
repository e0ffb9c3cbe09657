//! Tables of settings of the whole document: compiler, options, sizes, visual settings, statistics.

use crate::math::Vec3;
use crate::model::{self, ConeType, Flags, IntegratorType, JacobianFormat, Options, SolverType, Statistic};

use super::attribute::Sign::{Any, NonNegative, Positive};
use super::attribute::{AttributeKind, FLAG, INTS, Keywords, TEXT, int, real, reals, some, words};
use super::error::UNREAD;
use super::schema::Element;
use super::table::{Table, table};
use super::words::{AutoBool, MAX_COUNT, MAX_KEYS, MAX_PIXELS, TRI};

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
        "eulerseq" eulerseq: [u8; 3] = *b"xyz", AttributeKind::EulerSeq, "Axes of Euler angles; lower case turns with the body.";
        "inertiafromgeom" inertiafromgeom: AutoBool = AutoBool::Auto, TRI, "Whether inertia is inferred from geoms; `auto`: only where a body has no `inertial`.";
        "autolimits" autolimits: bool = true, FLAG, "Whether giving a range enables its limit.";
        "inertiagrouprange" inertiagrouprange: [f64; 2] = [0.0, 5.0], INTS, "Lowest and highest group of the geoms from which inertia is inferred.";
        "balanceinertia" balanceinertia: bool = false, FLAG, "Whether principal moments that no body can have are replaced by their mean.";
        "boundmass" boundmass: f64 = 0.0, real(NonNegative), "Least mass of a body, kg.";
        "boundinertia" boundinertia: f64 = 0.0, real(NonNegative), "Least principal moment of a body, kg m^2.";
        "settotalmass" settotalmass: f64 = -1.0, real(Any), "Mass to which all bodies together are scaled, kg; not above 0 for none.";
        "texturedir" texturedir: String = String::new(), TEXT, "Directory of the textures.";
        "meshdir" meshdir: String = String::new(), TEXT, "Directory of the meshes.";
        "assetdir" assetdir: String = String::new(), TEXT, "Directory of textures and meshes, where `texturedir` and `meshdir` say no other.";
        "alignfree" alignfree: bool = false, FLAG, "Whether the frames of free bodies, where no others are in them, are moved into their centres of mass and along their principal axes.";
        "fitaabb" fitaabb: bool = false, FLAG, "Whether shapes are fitted to the box around a mesh; else to that of the same inertia.";
        "strippath" strippath: bool = false, FLAG, "Whether directories in the names of files are dropped.";
        "fusestatic" fusestatic: bool = false, FLAG, "Whether bodies without joints are fused with what carries them, where nothing in the document may name them: no contact, equality, tendon, actuator, sensor, tuple or skin, no camera and no light.";
        "discardvisual" discardvisual: bool = false, FLAG, "Whether what is only drawn is left out: textures, materials, geoms that collide by no mask and that nothing names (they still weigh), and meshes of none.";
        check "coordinate", AttributeKind::Word(&["local"]), "Frame of positions; only the parent's.";
        check "usethread", FLAG, "How MuJoCo compiles meshes. Ignored.";
    }
}

/// Greatest length of `userdata`.
const MAX_USERDATA: i64 = 1_000_000;

/// Which actuators get their `lengthrange` by simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthRangeMode {
    /// No actuator.
    None,
    /// Muscles.
    Muscle,
    /// All actuators.
    All,
}

/// Muscles and user-defined actuators. This engine has none of the latter.
const LENGTH_RANGES: Keywords<LengthRangeMode> = words! {
    "none" => LengthRangeMode::None,
    "muscle" => LengthRangeMode::Muscle,
    "muscleuser" => LengthRangeMode::Muscle,
    "all" => LengthRangeMode::All,
};

/// Settings for the simulation that finds the `lengthrange` of actuators without one (`<compiler><lengthrange>`).
#[derive(Clone, Copy, Debug)]
pub struct LengthRange {
    /// Which actuators get their `lengthrange`.
    pub mode: LengthRangeMode,
    /// Whether a given `lengthrange` is used.
    pub useexisting: bool,
    /// Whether the limit of the joint or the tendon is used.
    pub uselimit: bool,
    /// Norm of the acceleration with which the simulation pulls and pushes the actuator.
    pub accel: f64,
    /// Greatest norm of the force for this; 0 for no bound.
    pub maxforce: f64,
    /// Time constant of the damping of velocities, s.
    pub timeconst: f64,
    /// Time step of the simulation, s; 0 for that of the model.
    pub timestep: f64,
    /// Duration of the simulation in each direction, s.
    pub inttotal: f64,
    /// Time at the end of the simulation in which the length is measured, s.
    pub interval: f64,
    /// Largest change of the length in that time, relative to the range.
    pub tolrange: f64,
}

table! {
    fields LengthRange {
        "mode" mode: LengthRangeMode = LengthRangeMode::Muscle, LENGTH_RANGES, "Which actuators get their `lengthrange`.";
        "useexisting" useexisting: bool = true, FLAG, "Whether a given `lengthrange` is used.";
        "uselimit" uselimit: bool = false, FLAG, "Whether the limit of the joint or the tendon is used.";
        "accel" accel: f64 = 20.0, real(Any), "Norm of the acceleration with which the simulation pulls and pushes the actuator.";
        "maxforce" maxforce: f64 = 0.0, real(Any), "Greatest norm of the force for this; 0 for no bound.";
        "timeconst" timeconst: f64 = 1.0, real(Any), "Time constant of the damping of velocities, s.";
        "timestep" timestep: f64 = 0.01, real(Any), "Time step of the simulation, s; 0 for that of the model.";
        "inttotal" inttotal: f64 = 10.0, real(Any), "Duration of the simulation in each direction, s.";
        "interval" interval: f64 = 2.0, real(Any), "Time at the end of the simulation in which the length is measured, s.";
        "tolrange" tolrange: f64 = 0.05, real(Any), "Largest change of the length in that time, relative to the range.";
    }
}

const INTEGRATORS: Keywords<IntegratorType> = words! {
    "Euler" => IntegratorType::Euler,
    "RK4" => IntegratorType::Rk4,
    "implicit" => IntegratorType::Implicit,
    "implicitfast" => IntegratorType::ImplicitFast,
};

table! {
    fields Options {
        also flags: Flags = Flags::initial();
        "timestep" timestep: f64 = 0.002, real(Positive), "Time step, s.";
        "gravity" gravity: Vec3 = [0.0, 0.0, -9.81], reals(3, Any), "Gravity, m/s^2.";
        "iterations" iterations: usize = 100, int(0, MAX_COUNT), "Maximum number of iterations of the solver per step.";
        "tolerance" tolerance: f64 = 1e-8, real(NonNegative), "Improvement or gradient below which the solver stops.";
        "noslip_iterations" noslip_iterations: usize = 0, int(0, MAX_COUNT), "Maximum number of iterations of the solver against slip, which takes the softness out of friction.";
        "noslip_tolerance" noslip_tolerance: f64 = 1e-6, real(NonNegative), "Improvement below which the solver against slip stops.";
        "ls_iterations" ls_iterations: usize = 50, int(0, MAX_COUNT), "Maximum number of line-search iterations per iteration of the solver.";
        "ls_tolerance" ls_tolerance: f64 = 0.01, real(NonNegative), "Tolerance of the line search.";
        "impratio" impratio: f64 = 1.0, real(Positive), "Ratio of frictional to normal constraint impedance.";
        "cone" cone: ConeType = ConeType::Pyramidal, words! { "pyramidal" => ConeType::Pyramidal, "elliptic" => ConeType::Elliptic }, "Shape of the friction cones.";
        "jacobian" jacobian: JacobianFormat = JacobianFormat::Auto, words! { "dense" => JacobianFormat::Dense, "sparse" => JacobianFormat::Sparse, "auto" => JacobianFormat::Auto }, "Format of the constraint Jacobian in MuJoCo. It changes no accelerations; sparse, also equalities without effect keep their rows.";
        "ccd_iterations" ccd_iterations: usize = 50, int(0, MAX_COUNT), "Maximum number of iterations of the convex collision routine.";
        "ccd_tolerance" ccd_tolerance: f64 = 1e-6, real(NonNegative), "Tolerance of the convex collision routine, m.";
        "integrator" integrator: IntegratorType = IntegratorType::Euler, INTEGRATORS, "Integrator: Euler's method with implicit damping, Runge and Kutta's of fourth order, or Euler's method implicit in all velocities, `implicitfast` in all but those of Coriolis forces.";
        "solver" solver: SolverType = SolverType::Newton, words! { "PGS" => SolverType::Pgs, "CG" => SolverType::Cg, "Newton" => SolverType::Newton }, "Solver of constraints: Newton's method, conjugate gradients, or projected Gauss-Seidel.";
        "density" density: f64 = 0.0, real(NonNegative), "Density of the medium around bodies, kg/m^3.";
        "viscosity" viscosity: f64 = 0.0, real(NonNegative), "Viscosity of the medium around bodies, Pa s.";
        "wind" wind: Vec3 = [0.0; 3], reals(3, Any), "Velocity of the medium, m/s.";
        "magnetic" magnetic: Vec3 = [0.0, -0.5, 0.0], reals(3, Any), "Magnetic flux, which magnetometers read.";
        "actuatorgroupdisable" disableactuator: u32 = 0, AttributeKind::Groups, "Groups of actuators that exert no force, from 0 to 30.";
        check "apirate", real(NonNegative), "Rate at which programs are to be told. Ignored.";
        check "o_margin", real(Any), "Margin of all contacts where the flag `override` is on, which it cannot be. Ignored.";
        check "o_solref", some(1, 2, Any), "`solref` of all contacts, as `o_margin`. Ignored.";
        check "o_solimp" | "o_friction", some(1, 5, Any), "`solimp` and friction of all contacts, as `o_margin`. Ignored.";
        check "sdf_iterations" | "sdf_initpoints", int(0, MAX_COUNT), "Collision of signed distance fields, of which there are none. Ignored.";
    }
}

/// The words of a flag.
const SWITCH: Keywords<bool> = words! { "enable" => true, "disable" => false };

table! {
    fields Flags {
        "constraint" constraint: bool = true, SWITCH, "Whether there are constraints: equalities, dry friction, limits, contacts.";
        "equality" equality: bool = true, SWITCH, "Whether equalities hold.";
        "frictionloss" frictionloss: bool = true, SWITCH, "Whether joints have dry friction.";
        "limit" limit: bool = true, SWITCH, "Whether joints and tendons have limits.";
        "contact" contact: bool = true, SWITCH, "Whether geoms touch.";
        "passive" passive: bool = true, SWITCH, "Whether springs, dampers, the medium and compensated gravity act.";
        "gravity" gravity: bool = true, SWITCH, "Whether gravity acts.";
        "clampctrl" clampctrl: bool = true, SWITCH, "Whether controls are kept in their range.";
        "warmstart" warmstart: bool = true, SWITCH, "Whether the solver may start from the last acceleration.";
        "filterparent" filterparent: bool = true, SWITCH, "Whether geoms of a body pass through those of its parent.";
        "actuation" actuation: bool = true, SWITCH, "Whether actuators act.";
        "refsafe" refsafe: bool = true, SWITCH, "Whether time constants in `solref` are at least two time steps.";
        "sensor" sensor: bool = true, SWITCH, "Whether sensors are computed.";
        "midphase" midphase: bool = true, SWITCH, "Whether contacts of two bodies are listed by the types of the geoms; else by their ids.";
        "eulerdamp" eulerdamp: bool = true, SWITCH, "Whether Euler's method takes joint damping implicitly.";
        "nativeccd" nativeccd: bool = true, SWITCH, "Whether convex collision is by GJK and EPA, MuJoCo's own; else by Minkowski portal refinement, as in libccd.";
        "multiccd" multiccd: bool = false, SWITCH, "Whether pairs of convex collision may have several contacts.";
        "island" island: bool = false, SWITCH, "Whether islands of bodies are found one by one; on only with other solvers than conjugate gradients, where it makes no difference.";
        "autoreset" autoreset: bool = true, SWITCH, "Whether MuJoCo starts anew where a simulation diverges, which is an error here. For programs.";
        "energy" energy: bool = false, SWITCH, "Whether MuJoCo computes energies in every step. For programs: it changes no motion.";
        "fwdinv" fwdinv: bool = false, SWITCH, "Whether MuJoCo compares forward and inverse dynamics. For programs: it changes no motion.";
        "invdiscrete" invdiscrete: bool = false, SWITCH, "Whether MuJoCo's inverse dynamics are those of its integrator. For programs: it changes no motion.";
        check "override", AttributeKind::Word(&["disable"]), "Whether all contacts have the parameters of `<option>`; only off.";
    }
}

table! {
    /// `<size>`.
    group Size {
        "nuser_body" nuser_body: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of bodies; -1 for the longest given.";
        "nuser_jnt" nuser_jnt: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of joints; -1 for the longest given.";
        "nuser_geom" nuser_geom: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of geoms; -1 for the longest given.";
        "nuser_site" nuser_site: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of sites; -1 for the longest given.";
        "nuser_cam" nuser_cam: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of cameras; -1 for the longest given.";
        "nuser_tendon" nuser_tendon: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of tendons; -1 for the longest given.";
        "nuser_actuator" nuser_actuator: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of actuators; -1 for the longest given.";
        "nuser_sensor" nuser_sensor: Option<usize> = None, AttributeKind::UserCount, "Length of `user` of sensors; -1 for the longest given.";
        "nuserdata" nuserdata: usize = 0, int(0, MAX_USERDATA), "Length of `userdata` of a simulation, which only programs use.";
        "nconmax" nconmax: Option<i64> = None, int(-1, i64::MAX), "Memory of MuJoCo; 0 for no contacts, else ignored.";
        "njmax" njmax: Option<i64> = None, int(-1, i64::MAX), "Memory of MuJoCo. Ignored.";
        "nstack" nstack: Option<i64> = None, int(-1, i64::MAX), "Memory of MuJoCo. Ignored.";
        "memory" memory: Option<String> = None, AttributeKind::Memory, "Memory of MuJoCo. Ignored.";
        "nkey" nkey: i64 = 0, int(i32::MIN as i64, MAX_KEYS), "Least number of keyframes; those that are not given hold the reference configuration.";
    }
}

table! {
    /// `<visual><global>`.
    group Global {
        "fovy" fovy: f64 = 45.0, real(Positive), "Vertical field of view of the free camera, degrees.";
        "offwidth" offwidth: usize = 640, int(1, MAX_PIXELS), "Width of pictures drawn offscreen, pixels.";
        "offheight" offheight: usize = 480, int(1, MAX_PIXELS), "Height of pictures drawn offscreen, pixels.";
        "azimuth" azimuth: f64 = 90.0, real(Any), "Direction of view of the free camera about the vertical axis, degrees; 0 is along x.";
        "elevation" elevation: f64 = -45.0, real(Any), "Angle of the free camera's view above the horizon, degrees.";
        check "ipd" | "linewidth" | "glow", real(Any), "View and drawing of MuJoCo's viewer. Ignored.";
        check "realtime", real(Positive), "Speed of MuJoCo's viewer. Ignored.";
        check "ellipsoidinertia" | "bvactive" | "orthographic", FLAG, "What MuJoCo's viewer draws. Ignored.";
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
        check "stiffness" | "stiffnessrot" | "torque" | "alpha" | "shadowscale" | "actuatortendon", real(Any), "Scale in MuJoCo's viewer. Ignored.";
    }
}

table! {
    /// `<visual><quality>`.
    group Quality {
        "shadowsize" shadowsize: usize = 4096, int(0, MAX_PIXELS), "Size of the map of shadows, which are not drawn, pixels.";
        "offsamples" offsamples: usize = 4, int(0, 64), "Samples per pixel of pictures drawn offscreen.";
        check "numslices" | "numstacks" | "numquads", int(0, MAX_COUNT), "Fineness of round shapes in MuJoCo's viewer. Ignored.";
    }
}

table! {
    /// `<visual><headlight>`.
    group Headlight {
        "active" active: usize = 1, int(0, 1), "Whether the light at the camera is on.";
        "ambient" ambient: [f64; 3] = [0.1; 3], reals(3, Any), "Ambient colour.";
        "diffuse" diffuse: [f64; 3] = [0.4; 3], reals(3, Any), "Diffuse colour.";
        "specular" specular: [f64; 3] = [0.5; 3], reals(3, Any), "Colour of highlights.";
    }
}

table! {
    /// `<visual><rgba>`: colours of decorations in MuJoCo's viewer. Renderers and physics ignore them.
    group Rgba {
        check "fog" | "haze" | "force" | "inertia" | "joint" | "actuator" | "actuatornegative" | "actuatorpositive" | "com" | "camera" | "light" | "selectpoint" | "connect" | "contactpoint" | "contactforce" | "contactfriction" | "contacttorque" | "contactgap" | "rangefinder" | "constraint" | "slidercrank" | "crankbroken" | "frustum" | "bv" | "bvactive", reals(4, Any), "Colour in MuJoCo's viewer. Ignored: it is not drawn.";
    }
}

table! {
    /// `<visual><scale>`: sizes of decorations in MuJoCo's viewer.
    group Scale {
        check "forcewidth" | "contactwidth" | "contactheight" | "connect" | "com" | "camera" | "light" | "selectpoint" | "jointlength" | "jointwidth" | "actuatorlength" | "actuatorwidth" | "framelength" | "framewidth" | "constraint" | "slidercrank" | "frustum", real(Any), "Size in MuJoCo's viewer. Ignored: it is not drawn.";
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

const TWO_MEMORIES: &str = "memory and njmax or nstack are two ways to say the same: give one of them";

impl Size {
    /// Reads a section; later sections take precedence.
    ///
    /// # Errors
    /// It sets MuJoCo's memory in two ways.
    pub fn section(&mut self, e: &Element) -> Result<(), &'static str> {
        (self.njmax, self.nstack) = (None, None);
        self.apply(e);
        let memory = self.memory.as_deref().is_some_and(|memory| memory.trim_ascii() != "-1");
        if memory && (self.njmax.is_some() || self.nstack.is_some()) {
            return Err(TWO_MEMORIES);
        }
        Ok(())
    }
}

impl Compiler {
    /// Reads a section; later sections take precedence. The directory of all assets applies if the section names none.
    pub fn section(&mut self, e: &Element) {
        if let Some(dir) = e.text("assetdir") {
            dir.clone_into(&mut self.texturedir);
            dir.clone_into(&mut self.meshdir);
        }
        self.apply(e);
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
    /// Applies an element of the section. An error describes the fault.
    pub fn apply(&mut self, e: &Element) -> Result<(), &'static str> {
        match e.name {
            "global" => self.global.apply(e),
            "map" => self.map.apply(e),
            "quality" => self.quality.apply(e),
            "headlight" => self.headlight.apply(e),
            // colours and sizes of decorations that are not drawn
            "rgba" | "scale" => {}
            _ => return Err(UNREAD),
        }
        Ok(())
    }

    /// Returns the settings in the form of the model: MuJoCo stores reals in single precision.
    pub fn compiled(&self) -> model::Visual {
        let Visual {
            global,
            map,
            quality,
            headlight,
        } = self;
        model::Visual {
            fovy: single(global.fovy),
            azimuth: single(global.azimuth),
            elevation: single(global.elevation),
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
