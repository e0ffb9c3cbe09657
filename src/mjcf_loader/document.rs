//! The typed document: every element with its defaults applied, references still by name, angles still as written. Here
//! are the tables of bodies and their elements, and the document as a whole.

use std::collections::BTreeMap;

use crate::math::Vec3;
use crate::model::{self, CamLight, GeomType, Options, Statistic};

use super::actuator::Actuator;
use super::attachment::{AttachedKeyframe, CopyCount, KeyframeValues, MissingReference};
use super::attribute::Sign::{Any, NonNegative, Positive};
use super::attribute::{AttributeKind, FLAG, INTS, TEXT, int, real, reals, some};
use super::custom::{Key, Numeric, Text, Tuple};
use super::flex::{Flex, FlexComp};
use super::joint::Joint;
use super::mesh::{HField, Mesh};
use super::relation::{Equality, Exclude, Pair, Tendon};
use super::sensor::Sensor;
use super::skin::Skin;
use super::surface::{Material, Texture};
use super::table::{Table, table};
use super::words::{
    CAM_LIGHT, FLUID, GREY, MAX_BITS, MAX_GROUP, MIN_BITS, MIN_GROUP, SHAPES, SITE_SHAPES, SOLIMP, SOLREF,
};

use super::settings::Visual;
pub(super) use super::settings::{Compiler, LengthRange, Size};
pub(super) use super::words::{AutoBool, Frame, Orientation};

table! {
    /// `<geom>`.
    element Geom {
        also within: Option<usize> = None;
        also left_out: bool = false;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "type" kind: GeomType = GeomType::Sphere, SHAPES, "Shape.";
        "size" size: Vec3 = [0.0; 3], some(1, 3, NonNegative), "Size, m: radius, half lengths.";
        "contype" contype: u32 = 1, int(MIN_BITS, MAX_BITS), "Bits that meet `conaffinity` of others.";
        "conaffinity" conaffinity: u32 = 1, int(MIN_BITS, MAX_BITS), "Bits that meet `contype` of others.";
        "condim" condim: usize = 3, int(1, 6), "Dimension of its contacts: 1, 3, 4 or 6.";
        "priority" priority: i32 = 0, int(i32::MIN as i64, i32::MAX as i64), "Priority where contact parameters are mixed.";
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group.";
        "friction" friction: [f64; 3] = [1.0, 0.005, 0.0001], some(1, 3, NonNegative), "Sliding, torsional and rolling friction.";
        "solmix" solmix: f64 = 1.0, real(NonNegative), "Weight where contact parameters are mixed.";
        "solref" solref: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of contacts.";
        "solimp" solimp: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of contacts.";
        "margin" margin: f64 = 0.0, real(NonNegative), "Distance at which contacts are found, m.";
        "gap" gap: f64 = 0.0, real(NonNegative), "Part of the margin in which contacts exert no force, m.";
        "mass" mass: Option<f64> = None, real(NonNegative), "Mass, kg; else by density.";
        "shellinertia" shell: bool = false, FLAG, "Whether only the surface has mass; `density` is then in kg/m^2.";
        "density" density: f64 = 1000.0, real(NonNegative), "Density, kg/m^3.";
        "fromto" fromto: Option<[f64; 6]> = None, reals(6, Any), "Both ends of an elongated shape, m, in place of pose and length.";
        "fluidshape" ellipsoid: bool = false, FLUID, "Whether a medium acts on it as on an ellipsoid; without such geoms it acts on the body as on a box.";
        "fluidcoef" fluidcoef: [f64; 5] = [0.5, 0.25, 1.5, 1.0, 1.0], some(1, 5, Any), "Coefficients of blunt, slender and angular drag, of Kutta's lift and of Magnus's.";
        "rgba" rgba: [f64; 4] = GREY, reals(4, Any), "Colour and opacity.";
        "material" material: Option<String> = None, TEXT, "Material.";
        "mesh" mesh: Option<String> = None, TEXT, "Mesh; a primitive shape is fitted to it.";
        "hfield" hfield: Option<String> = None, TEXT, "Height field.";
        "fitscale" fitscale: f64 = 1.0, real(Positive), "Factor on the size of a shape that is fitted to a mesh.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        with frame: Frame;
    }
}

table! {
    /// `<site>`.
    element Site {
        also within: Option<usize> = None;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "type" kind: GeomType = GeomType::Sphere, SITE_SHAPES, "Shape.";
        "size" size: Vec3 = [0.005; 3], some(1, 3, NonNegative), "Size, m: radius, half lengths.";
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group.";
        "fromto" fromto: Option<[f64; 6]> = None, reals(6, Any), "Both ends of an elongated shape, m, in place of pose and length.";
        "rgba" rgba: [f64; 4] = GREY, reals(4, Any), "Colour and opacity.";
        "material" material: Option<String> = None, TEXT, "Material.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        with frame: Frame;
    }
}

table! {
    /// `<camera>`.
    element Camera {
        also within: Option<usize> = None;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "mode" mode: CamLight = CamLight::Fixed, CAM_LIGHT, "How it is placed and aimed.";
        "target" target: Option<String> = None, TEXT, own, "Body that it looks at in modes `targetbody` and `targetbodycom`.";
        "orthographic" orthographic: bool = false, FLAG, "Whether its rays are parallel; `fovy` is then the height of the picture, m. Asking for its picture is an error.";
        "resolution" resolution: [f64; 2] = [1.0; 2], INTS, "Width and height of the picture, pixels, for `camprojection` alone: pictures have the size that the caller asks for.";
        "fovy" fovy: f64 = 45.0, real(Positive), "Vertical field of view, degrees; else by sensor and focal length.";
        "sensorsize" sensorsize: [f64; 2] = [0.0; 2], reals(2, Any), "Width and height of the sensor, m, with `resolution` and a focal length, in place of `fovy`.";
        "focal" focal: [f64; 2] = [0.0; 2], reals(2, Any), "Focal lengths along both sides of the sensor, m.";
        "focalpixel" focalpixel: [f64; 2] = [0.0; 2], reals(2, Any), "Focal lengths in pixels, in place of `focal`.";
        "principal" principal: [f64; 2] = [0.0; 2], reals(2, Any), "Where the axis of the lens meets the sensor, from its centre, m.";
        "principalpixel" principalpixel: [f64; 2] = [0.0; 2], reals(2, Any), "The same in pixels, in place of `principal`.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        check "ipd", real(Any), "Distance of a person's eyes for stereoscopic pictures, m. Ignored: pictures are not stereoscopic.";
        with frame: Frame;
    }
}

table! {
    /// `<light>`.
    element Light {
        also within: Option<usize> = None;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "mode" mode: CamLight = CamLight::Fixed, CAM_LIGHT, "How it is placed and aimed.";
        "target" target: Option<String> = None, TEXT, own, "Body that it shines at in modes `targetbody` and `targetbodycom`.";
        "directional" directional: bool = false, FLAG, "Whether its rays are parallel.";
        "active" active: bool = true, FLAG, "Whether it is on.";
        "castshadow" castshadow: bool = true, FLAG, "Whether it casts shadows, which are not drawn.";
        "pos" pos: Vec3 = [0.0; 3], reals(3, Any), "Position in the body, m.";
        "dir" dir: Vec3 = [0.0, 0.0, -1.0], reals(3, Any), "Direction in the body.";
        "ambient" ambient: [f64; 3] = [0.0; 3], reals(3, Any), "Ambient colour.";
        "diffuse" diffuse: [f64; 3] = [0.7; 3], reals(3, Any), "Diffuse colour.";
        "specular" specular: [f64; 3] = [0.3; 3], reals(3, Any), "Colour of highlights.";
        "attenuation" attenuation: [f64; 3] = [1.0, 0.0, 0.0], reals(3, NonNegative), "Constant, linear and quadratic attenuation.";
        "cutoff" cutoff: f64 = 45.0, real(NonNegative), "Cutoff angle of a spot light, degrees.";
        "exponent" exponent: f64 = 10.0, real(NonNegative), "Softness of a spot light.";
        check "bulbradius", real(Any), "Radius of the bulb for soft shadows, m. Ignored: shadows are not drawn.";
    }
}

table! {
    /// `<inertial>`: explicit inertia of a body.
    element Inertial {
        set "pos" => frame.pos, reals(3, Any), required, "Centre of mass in the body, m.";
        "mass" mass: f64 = 0.0, real(NonNegative), required, "Mass, kg.";
        "diaginertia" diaginertia: Vec3 = [0.0; 3], reals(3, NonNegative), inertia, "Principal moments of inertia, kg m^2.";
        "fullinertia" fullinertia: Option<[f64; 6]> = None, reals(6, Any), inertia, "Inertia matrix, kg m^2: xx yy zz xy xz yz.";
        with frame: Frame;
    }
}

table! {
    /// `<body>` with its elements; children follow their parents in the list of bodies.
    element Body {
        also parent: usize = 0;
        also within: Option<usize> = None;
        also inertial: Option<Inertial> = None;
        also joints: Vec<Joint> = Vec::new();
        also geoms: Vec<Geom> = Vec::new();
        also sites: Vec<Site> = Vec::new();
        also cameras: Vec<Camera> = Vec::new();
        also lights: Vec<Light> = Vec::new();
        also states: KeyframeValues = KeyframeValues::new();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        "mocap" mocap: bool = false, FLAG, "Whether a program moves it, by `mocap_pos` and `mocap_quat` of the state.";
        "gravcomp" gravcomp: f64 = 0.0, real(Any), "Part of its weight that is compensated.";
        check "childclass", TEXT, "Default class of the elements in it that name none.";
        with frame: Frame;
    }
}

table! {
    /// `<frame>` in a body: the pose of all elements in it, except for an `inertial`. Inner frames follow outer ones.
    element BodyFrame {
        also within: Option<usize> = None;
        also copy: Option<ReplicaIndex> = None;
        "name" name: String = String::new(), TEXT, own, "Name.";
        check "childclass", TEXT, "Default class of the elements in it that name none.";
        with frame: Frame;
    }
}

/// The copy of a `<replicate>` that a frame belongs to. The frame's pose is the step from the copy before.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReplicaIndex {
    /// Number of the copy, from 0 on.
    pub number: usize,
    /// Frame of the copy before, if there is one.
    pub previous: Option<usize>,
}

table! {
    /// `<replicate>` in a body: copies of its content, each placed relative to the one before. The number of the copy is appended to names.
    element Replicate {
        "count" count: i32 = 0, int(i32::MIN as i64, i32::MAX as i64), required, "Number of copies; none where it is not positive.";
        "sep" sep: String = String::new(), TEXT, "What stands between a name and the number of the copy.";
        "offset" offset: Vec3 = [0.0; 3], reals(3, Any), "Step from copy to copy, m, in the frame of the one before.";
        "euler" euler: Vec3 = [0.0; 3], reals(3, Any), "Turn from copy to copy as Euler angles.";
        check "childclass", TEXT, "Default class of the elements in it that name none.";
    }
}

table! {
    /// `<asset><model>`: another document, whose bodies `<attach>` copies.
    element ModelAsset {
        "name" name: String = String::new(), TEXT, "Name; else that which the model has itself.";
        check "file", TEXT, "File of the model, an MJCF document.";
        check "content_type", TEXT, "Format of the file, whatever its ending: `text/xml`.";
    }
}

table! {
    /// `<attach>` in a body: a body of another model, with everything below it and the elements that refer to nothing else.
    element Attach {
        "model" model: String = String::new(), TEXT, required, "Model of which the body is.";
        "body" body: String = String::new(), TEXT, required, "Body of that model.";
        "prefix" prefix: String = String::new(), TEXT, required, "What the names of all that comes with it begin with.";
    }
}

/// The content of a document.
pub(super) struct TypedDocument {
    pub model: String,
    /// Settings of the document and of the models that it names, in the order of the tree; none in a model.
    pub compilers: Vec<Compiler>,
    pub lengthrange: LengthRange,
    pub option: Options,
    pub visual: model::Visual,
    pub statistic: Statistic,
    pub size: Size,
    pub textures: Vec<Texture>,
    pub materials: Vec<Material>,
    pub meshes: Vec<Mesh>,
    pub hfields: Vec<HField>,
    pub skins: Vec<Skin>,
    pub flexes: Vec<Flex>,
    /// Flexes that the compiler makes, with their bodies.
    pub flexcomps: Vec<FlexComp>,
    /// Density by which the inertia of meshes is scaled while their axes are sought, kg/m^3.
    pub mesh_density: f64,
    pub bodies: Vec<Body>,
    /// Frames in the bodies, which elements name by their place here.
    pub frames: Vec<BodyFrame>,
    /// Number of elements that `<replicate>` copied, and of elements searched for references to copies.
    pub copies: usize,
    pub looks: usize,
    /// References to elements that `<attach>` did not copy.
    pub absent: Vec<MissingReference>,
    /// The number of elements copied from other models, here and within those models.
    pub copied: CopyCount,
    /// Other models, by name.
    pub models: BTreeMap<String, TypedDocument>,
    pub pairs: Vec<Pair>,
    pub excludes: Vec<Exclude>,
    pub equalities: Vec<Equality>,
    pub tendons: Vec<Tendon>,
    pub actuators: Vec<Actuator>,
    pub sensors: Vec<Sensor>,
    pub numerics: Vec<Numeric>,
    pub tuples: Vec<Tuple>,
    pub texts: Vec<Text>,
    pub keys: Vec<Key>,
    /// Keyframes that came with bodies of other models or with copies; they follow the document's own.
    pub moved_keys: Vec<AttachedKeyframe>,
}

impl TypedDocument {
    /// Returns an empty document with a name; `at` is its root.
    pub fn new(at: usize, model: String) -> Self {
        let world = Body {
            at,
            name: "world".to_owned(),
            ..Body::initial()
        };
        Self {
            model,
            compilers: Vec::new(),
            lengthrange: LengthRange::initial(),
            option: Options::initial(),
            visual: Visual::default().compiled(),
            statistic: Statistic::initial(),
            size: Size::initial(),
            textures: Vec::new(),
            materials: Vec::new(),
            meshes: Vec::new(),
            hfields: Vec::new(),
            skins: Vec::new(),
            flexes: Vec::new(),
            flexcomps: Vec::new(),
            mesh_density: Geom::initial().density,
            bodies: vec![world],
            frames: Vec::new(),
            copies: 0,
            looks: 0,
            absent: Vec::new(),
            copied: CopyCount::default(),
            models: BTreeMap::new(),
            pairs: Vec::new(),
            excludes: Vec::new(),
            equalities: Vec::new(),
            tendons: Vec::new(),
            actuators: Vec::new(),
            sensors: Vec::new(),
            numerics: Vec::new(),
            tuples: Vec::new(),
            texts: Vec::new(),
            keys: Vec::new(),
            moved_keys: Vec::new(),
        }
    }
}
