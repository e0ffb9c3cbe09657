//! The typed document: every element with its defaults applied, references still by name, angles still as written.

use crate::math::Vec3;
use crate::model::{GeomType, JointType, Options, Statistic, Visual};

use super::relation::{Actuator, Equality, Exclude, Pair, Sensor, Tendon};
use super::schema::Element;
use super::surface::{Material, Texture};

pub(super) const SHAPES: &[GeomType] = &[
    GeomType::Plane,
    GeomType::Sphere,
    GeomType::Capsule,
    GeomType::Ellipsoid,
    GeomType::Cylinder,
    GeomType::Box,
];
const JOINT_TYPES: &[JointType] = &[JointType::Free, JointType::Slide, JointType::Hinge];
pub(super) const SOLREF: [f64; 2] = [0.02, 1.0];
pub(super) const SOLIMP: [f64; 5] = [0.9, 0.95, 0.001, 0.5, 2.0];
const GREY: [f64; 4] = [0.5, 0.5, 0.5, 1.0];

/// A switch that may follow from whether a range is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tri {
    No,
    Yes,
    Auto,
}

pub(super) const TRIS: &[Tri] = &[Tri::No, Tri::Yes, Tri::Auto];

/// An orientation as written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Orientation {
    Quat([f64; 4]),
    AxisAngle([f64; 4]),
    XyAxes([f64; 6]),
    ZAxis([f64; 3]),
    Euler([f64; 3]),
}

/// A pose as written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub pos: Vec3,
    pub orientation: Orientation,
}

impl Frame {
    pub const IDENTITY: Frame = Frame {
        pos: [0.0; 3],
        orientation: Orientation::Quat([1.0, 0.0, 0.0, 0.0]),
    };

    pub fn apply(&mut self, e: &Element) {
        e.fill("pos", &mut self.pos);
        let written = e
            .array("quat")
            .map(Orientation::Quat)
            .or_else(|| e.array("axisangle").map(Orientation::AxisAngle))
            .or_else(|| e.array("xyaxes").map(Orientation::XyAxes))
            .or_else(|| e.array("zaxis").map(Orientation::ZAxis))
            .or_else(|| e.array("euler").map(Orientation::Euler));
        self.orientation = match (written, self.orientation) {
            // a default class that turns by other means wins over a quaternion, as in MuJoCo
            (Some(Orientation::Quat(_)), inherited) if !matches!(inherited, Orientation::Quat(_)) => inherited,
            (written, inherited) => written.unwrap_or(inherited),
        };
    }
}

#[derive(Clone)]
pub(super) struct Joint {
    pub at: usize,
    pub name: String,
    pub kind: JointType,
    pub group: usize,
    pub pos: Vec3,
    pub axis: Vec3,
    pub limited: Tri,
    pub range: [f64; 2],
    pub margin: f64,
    pub stiffness: f64,
    pub damping: f64,
    pub armature: f64,
    pub frictionloss: f64,
    pub reference: f64,
    pub springref: f64,
    pub solref_limit: [f64; 2],
    pub solimp_limit: [f64; 5],
    pub solref_friction: [f64; 2],
    pub solimp_friction: [f64; 5],
}

impl Default for Joint {
    fn default() -> Self {
        Joint {
            at: 0,
            name: String::new(),
            kind: JointType::Hinge,
            group: 0,
            pos: [0.0; 3],
            axis: [0.0, 0.0, 1.0],
            limited: Tri::Auto,
            range: [0.0; 2],
            margin: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            armature: 0.0,
            frictionloss: 0.0,
            reference: 0.0,
            springref: 0.0,
            solref_limit: SOLREF,
            solimp_limit: SOLIMP,
            solref_friction: SOLREF,
            solimp_friction: SOLIMP,
        }
    }
}

impl Joint {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_word("type", JOINT_TYPES, &mut self.kind);
        e.set_int("group", &mut self.group);
        e.fill("pos", &mut self.pos);
        e.fill("axis", &mut self.axis);
        e.set_word("limited", TRIS, &mut self.limited);
        e.fill("range", &mut self.range);
        e.set_real("margin", &mut self.margin);
        e.set_real("stiffness", &mut self.stiffness);
        e.set_real("damping", &mut self.damping);
        e.set_real("armature", &mut self.armature);
        e.set_real("frictionloss", &mut self.frictionloss);
        e.set_real("ref", &mut self.reference);
        e.set_real("springref", &mut self.springref);
        e.fill("solreflimit", &mut self.solref_limit);
        e.fill("solimplimit", &mut self.solimp_limit);
        e.fill("solreffriction", &mut self.solref_friction);
        e.fill("solimpfriction", &mut self.solimp_friction);
    }
}

#[derive(Clone)]
pub(super) struct Geom {
    pub at: usize,
    pub name: String,
    pub kind: GeomType,
    pub size: Vec3,
    pub contype: u32,
    pub conaffinity: u32,
    pub condim: usize,
    pub priority: i32,
    pub group: usize,
    pub friction: [f64; 3],
    pub solmix: f64,
    pub solref: [f64; 2],
    pub solimp: [f64; 5],
    pub margin: f64,
    pub gap: f64,
    pub mass: Option<f64>,
    pub density: f64,
    pub frame: Frame,
    pub fromto: Option<[f64; 6]>,
    pub rgba: [f64; 4],
    pub material: Option<String>,
}

impl Default for Geom {
    fn default() -> Self {
        Geom {
            at: 0,
            name: String::new(),
            kind: GeomType::Sphere,
            size: [0.0; 3],
            contype: 1,
            conaffinity: 1,
            condim: 3,
            priority: 0,
            group: 0,
            friction: [1.0, 0.005, 0.0001],
            solmix: 1.0,
            solref: SOLREF,
            solimp: SOLIMP,
            margin: 0.0,
            gap: 0.0,
            mass: None,
            density: 1000.0,
            frame: Frame::IDENTITY,
            fromto: None,
            rgba: GREY,
            material: None,
        }
    }
}

impl Geom {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_word("type", SHAPES, &mut self.kind);
        e.fill("size", &mut self.size);
        e.set_int("contype", &mut self.contype);
        e.set_int("conaffinity", &mut self.conaffinity);
        e.set_int("condim", &mut self.condim);
        e.set_int("priority", &mut self.priority);
        e.set_int("group", &mut self.group);
        e.fill("friction", &mut self.friction);
        e.set_real("solmix", &mut self.solmix);
        e.fill("solref", &mut self.solref);
        e.fill("solimp", &mut self.solimp);
        e.set_real("margin", &mut self.margin);
        e.set_real("gap", &mut self.gap);
        self.mass = e.array("mass").map(|[mass]| mass).or(self.mass);
        e.set_real("density", &mut self.density);
        self.frame.apply(e);
        self.fromto = e.array("fromto").or(self.fromto);
        e.fill("rgba", &mut self.rgba);
        e.set_optional_text("material", &mut self.material);
    }
}

#[derive(Clone)]
pub(super) struct Site {
    pub at: usize,
    pub name: String,
    pub kind: GeomType,
    pub size: Vec3,
    pub group: usize,
    pub frame: Frame,
    pub fromto: Option<[f64; 6]>,
    pub rgba: [f64; 4],
    pub material: Option<String>,
}

impl Default for Site {
    fn default() -> Self {
        Site {
            at: 0,
            name: String::new(),
            kind: GeomType::Sphere,
            size: [0.005; 3],
            group: 0,
            frame: Frame::IDENTITY,
            fromto: None,
            rgba: GREY,
            material: None,
        }
    }
}

impl Site {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        // Sites have no planes, so their words start one later.
        e.set_word("type", &SHAPES[1..], &mut self.kind);
        e.fill("size", &mut self.size);
        e.set_int("group", &mut self.group);
        self.frame.apply(e);
        self.fromto = e.array("fromto").or(self.fromto);
        e.fill("rgba", &mut self.rgba);
        e.set_optional_text("material", &mut self.material);
    }
}

#[derive(Clone)]
pub(super) struct Camera {
    pub at: usize,
    pub name: String,
    pub targets: bool,
    pub target: Option<String>,
    pub frame: Frame,
    pub fovy: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Camera {
            at: 0,
            name: String::new(),
            targets: false,
            target: None,
            frame: Frame::IDENTITY,
            fovy: 45.0,
        }
    }
}

impl Camera {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_word("mode", &[false, true], &mut self.targets);
        e.set_optional_text("target", &mut self.target);
        self.frame.apply(e);
        e.set_real("fovy", &mut self.fovy);
    }
}

#[derive(Clone)]
pub(super) struct Light {
    pub at: usize,
    pub name: String,
    pub directional: bool,
    pub castshadow: bool,
    pub pos: Vec3,
    pub dir: Vec3,
    pub ambient: [f64; 3],
    pub diffuse: [f64; 3],
    pub specular: [f64; 3],
    pub attenuation: [f64; 3],
    pub cutoff: f64,
    pub exponent: f64,
}

impl Default for Light {
    fn default() -> Self {
        Light {
            at: 0,
            name: String::new(),
            directional: false,
            castshadow: true,
            pos: [0.0; 3],
            dir: [0.0, 0.0, -1.0],
            ambient: [0.0; 3],
            diffuse: [0.7; 3],
            specular: [0.3; 3],
            attenuation: [1.0, 0.0, 0.0],
            cutoff: 45.0,
            exponent: 10.0,
        }
    }
}

impl Light {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_flag("directional", &mut self.directional);
        e.set_flag("castshadow", &mut self.castshadow);
        e.fill("pos", &mut self.pos);
        e.fill("dir", &mut self.dir);
        e.fill("ambient", &mut self.ambient);
        e.fill("diffuse", &mut self.diffuse);
        e.fill("specular", &mut self.specular);
        e.fill("attenuation", &mut self.attenuation);
        e.set_real("cutoff", &mut self.cutoff);
        e.set_real("exponent", &mut self.exponent);
    }
}

/// Explicit inertia of a body.
pub(super) struct Inertial {
    pub at: usize,
    pub frame: Frame,
    pub mass: f64,
    pub diaginertia: Vec3,
    pub fullinertia: Option<[f64; 6]>,
}

/// A body with what hangs on it; children follow their parents in the list of bodies.
pub(super) struct Body {
    pub at: usize,
    pub name: String,
    pub parent: usize,
    pub frame: Frame,
    pub inertial: Option<Inertial>,
    pub joints: Vec<Joint>,
    pub geoms: Vec<Geom>,
    pub sites: Vec<Site>,
    pub cameras: Vec<Camera>,
    pub lights: Vec<Light>,
}

impl Body {
    pub fn new(at: usize, name: String, parent: usize) -> Body {
        Body {
            at,
            name,
            parent,
            frame: Frame::IDENTITY,
            inertial: None,
            joints: Vec::new(),
            geoms: Vec::new(),
            sites: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
        }
    }
}

/// `<compiler>`.
pub(super) struct Compiler {
    pub degree: bool,
    pub eulerseq: [u8; 3],
    pub inertiafromgeom: Tri,
    pub autolimits: bool,
    pub texturedir: String,
}

/// Everything a document says.
pub(super) struct Document {
    pub model: String,
    pub compiler: Compiler,
    pub option: Options,
    pub visual: Visual,
    pub statistic: Statistic,
    pub nuser_actuator: Option<usize>,
    pub textures: Vec<Texture>,
    pub materials: Vec<Material>,
    pub bodies: Vec<Body>,
    pub pairs: Vec<Pair>,
    pub excludes: Vec<Exclude>,
    pub equalities: Vec<Equality>,
    pub tendons: Vec<Tendon>,
    pub actuators: Vec<Actuator>,
    pub sensors: Vec<Sensor>,
}
