//! The supported MJCF: the elements that each element may contain, and the tables of its attributes. Anything else is an error.

use crate::model::{Flags, Options, SensorType, Statistic};

use super::actuator::{
    Activation, Actuator, Adhesion, AtSite, Control, Cylinder, Filter, Law, Muscle, OnBody, Servo, Speed, Target,
};
use super::attribute::{Attr, Groups, TEXT};
use super::composite::{self, Composite, CompositeJoint, CompositeSkin};
use super::custom::{Key, Numeric, Text, Tuple, TupleElement};
use super::document::{
    Attach, Body, BodyFrame, Camera, Compiler, Geom, Inertial, Light, ModelAsset, Replicate, Site, Size,
};
use super::flex::{Elasticity, Flex, FlexComp, FlexCompEdge, FlexContact, FlexEdge, Pin};
use super::joint::{FreeJoint, Joint};
use super::mesh::{HField, Mesh};
use super::relation::{
    Ends, Equality, Exclude, FlexEquality, JointEquality, Pair, Pulley, Tendon, TendonEquality, TendonGeom,
    TendonJoint, TendonLooks, TendonSite, WeldEquality,
};
use super::schema::{self, Rule};
use super::sensor;
use super::settings::{Global, Headlight, LengthRange, Map, Quality, Rgba, Root, Scale};
use super::skin::{Bone, Skin};
use super::surface::{Layer, Material, Texture};
use super::table::Table;

const fn rule(name: &'static str, tables: &'static [Groups], children: &'static [&'static Rule]) -> Rule {
    Rule { name, tables, children }
}

/// The default class of an element, which the reader looks up before it reads the rest.
const CLASS: Groups = &[&[Attr::new("class", TEXT, "Default class.", no_default).own()]];
/// The name of a section of default classes.
const CLASS_NAME: Groups = &[&[Attr::new(
    "class",
    TEXT,
    "Name of the class; \"main\" at the top.",
    no_default,
)]];
fn no_default(_name: &str) -> String {
    String::new()
}

static LENGTHRANGE: Rule = rule("lengthrange", &[LengthRange::ATTRIBUTES], &[]);
static COMPILER: Rule = rule("compiler", &[Compiler::ATTRIBUTES], &[&LENGTHRANGE]);
static FLAG: Rule = rule("flag", &[Flags::ATTRIBUTES], &[]);
static OPTION: Rule = rule("option", &[Options::ATTRIBUTES], &[&FLAG]);
static SIZE: Rule = rule("size", &[Size::ATTRIBUTES], &[]);
static GLOBAL: Rule = rule("global", &[Global::ATTRIBUTES], &[]);
static MAP: Rule = rule("map", &[Map::ATTRIBUTES], &[]);
static QUALITY: Rule = rule("quality", &[Quality::ATTRIBUTES], &[]);
static HEADLIGHT: Rule = rule("headlight", &[Headlight::ATTRIBUTES], &[]);
static RGBA: Rule = rule("rgba", &[Rgba::ATTRIBUTES], &[]);
static SCALE: Rule = rule("scale", &[Scale::ATTRIBUTES], &[]);
static VISUAL: Rule = rule("visual", &[], &[&GLOBAL, &MAP, &QUALITY, &HEADLIGHT, &SCALE, &RGBA]);
static STATISTIC: Rule = rule("statistic", &[Statistic::ATTRIBUTES], &[]);

static DEFAULT_EQUALITY: Rule = rule("equality", &[Equality::ATTRIBUTES], &[]);
static DEFAULT_TENDON: Rule = rule("tendon", &[Tendon::ATTRIBUTES, TendonLooks::ATTRIBUTES], &[]);
static DEFAULT: Rule = rule(
    schema::DEFAULT,
    &[CLASS_NAME],
    &[
        &DEFAULT,
        &JOINT,
        &GEOM,
        &SITE,
        &CAMERA,
        &LIGHT,
        &PAIR,
        &DEFAULT_EQUALITY,
        &DEFAULT_TENDON,
        &GENERAL,
        &MOTOR,
        &POSITION,
        &VELOCITY,
        &INTVELOCITY,
        &DAMPER,
        &CYLINDER,
        &MUSCLE,
        &ADHESION,
        &MATERIAL,
        &MESH,
    ],
);

static TEXTURE: Rule = rule("texture", &[Texture::ATTRIBUTES], &[]);
static LAYER: Rule = rule("layer", &[Layer::ATTRIBUTES], &[]);
static MATERIAL: Rule = rule("material", &[CLASS, Material::ATTRIBUTES], &[&LAYER]);
static MESH: Rule = rule("mesh", &[CLASS, Mesh::ATTRIBUTES], &[]);
static HFIELD: Rule = rule("hfield", &[HField::ATTRIBUTES], &[]);
static BONE: Rule = rule("bone", &[Bone::ATTRIBUTES], &[]);
static SKIN: Rule = rule("skin", &[Skin::ATTRIBUTES], &[&BONE]);
static MODEL: Rule = rule("model", &[ModelAsset::ATTRIBUTES], &[]);
static ASSET: Rule = rule("asset", &[], &[&TEXTURE, &MATERIAL, &MESH, &HFIELD, &SKIN, &MODEL]);
static FLEX_CONTACT: Rule = rule("contact", &[FlexContact::ATTRIBUTES], &[]);
static FLEX_EDGE: Rule = rule("edge", &[FlexEdge::ATTRIBUTES], &[]);
static ELASTICITY: Rule = rule("elasticity", &[Elasticity::ATTRIBUTES], &[]);
static FLEX: Rule = rule("flex", &[Flex::ATTRIBUTES], &[&FLEX_CONTACT, &FLEX_EDGE, &ELASTICITY]);
static DEFORMABLE: Rule = rule("deformable", &[], &[&FLEX, &SKIN]);

static INERTIAL: Rule = rule("inertial", &[Inertial::ATTRIBUTES], &[]);
static JOINT: Rule = rule("joint", &[CLASS, Joint::ATTRIBUTES], &[]);
static FREEJOINT: Rule = rule("freejoint", &[FreeJoint::ATTRIBUTES], &[]);
static GEOM: Rule = rule("geom", &[CLASS, Geom::ATTRIBUTES], &[]);
static SITE: Rule = rule("site", &[CLASS, Site::ATTRIBUTES], &[]);
static CAMERA: Rule = rule("camera", &[CLASS, Camera::ATTRIBUTES], &[]);
static LIGHT: Rule = rule("light", &[CLASS, Light::ATTRIBUTES], &[]);
static BODY: Rule = rule(
    "body",
    &[Body::ATTRIBUTES],
    &[
        &BODY, &INERTIAL, &JOINT, &FREEJOINT, &GEOM, &SITE, &CAMERA, &LIGHT, &FRAME, &REPLICATE, &ATTACH, &COMPOSITE,
        &FLEXCOMP,
    ],
);
/// In the world it can hold only the elements of the world, which the reader checks.
static FRAME: Rule = rule(
    "frame",
    &[BodyFrame::ATTRIBUTES],
    &[
        &BODY, &INERTIAL, &JOINT, &FREEJOINT, &GEOM, &SITE, &CAMERA, &LIGHT, &FRAME, &REPLICATE, &ATTACH, &COMPOSITE,
        &FLEXCOMP,
    ],
);
static REPLICATE: Rule = rule(
    "replicate",
    &[Replicate::ATTRIBUTES],
    &[
        &BODY, &INERTIAL, &JOINT, &FREEJOINT, &GEOM, &SITE, &CAMERA, &LIGHT, &FRAME, &REPLICATE, &ATTACH, &COMPOSITE,
        &FLEXCOMP,
    ],
);
static COMPOSITE_JOINT: Rule = rule("joint", &[CompositeJoint::ATTRIBUTES, &[&composite::JOINT]], &[]);
static COMPOSITE_GEOM: Rule = rule("geom", &[&[&composite::GEOM]], &[]);
static COMPOSITE_SITE: Rule = rule("site", &[&[&composite::SITE]], &[]);
static COMPOSITE_SKIN: Rule = rule("skin", &[CompositeSkin::ATTRIBUTES], &[]);
static COMPOSITE: Rule = rule(
    "composite",
    &[Composite::ATTRIBUTES],
    &[&COMPOSITE_JOINT, &COMPOSITE_GEOM, &COMPOSITE_SITE, &COMPOSITE_SKIN],
);
static FLEXCOMP_EDGE: Rule = rule("edge", &[FlexCompEdge::ATTRIBUTES, FlexEdge::ATTRIBUTES], &[]);
static PIN: Rule = rule("pin", &[Pin::ATTRIBUTES], &[]);
static FLEXCOMP: Rule = rule(
    "flexcomp",
    &[FlexComp::ATTRIBUTES],
    &[&FLEXCOMP_EDGE, &ELASTICITY, &FLEX_CONTACT, &PIN],
);
static ATTACH: Rule = rule("attach", &[Attach::ATTRIBUTES], &[]);
static WORLDBODY: Rule = rule(
    "worldbody",
    &[],
    &[
        &BODY, &GEOM, &SITE, &CAMERA, &LIGHT, &FRAME, &REPLICATE, &ATTACH, &COMPOSITE, &FLEXCOMP,
    ],
);

static PAIR: Rule = rule("pair", &[CLASS, Pair::ATTRIBUTES], &[]);
static EXCLUDE: Rule = rule("exclude", &[Exclude::ATTRIBUTES], &[]);
static CONTACT: Rule = rule("contact", &[], &[&PAIR, &EXCLUDE]);

static EQUALITY_JOINT: Rule = rule("joint", &[CLASS, JointEquality::ATTRIBUTES, Equality::ATTRIBUTES], &[]);
static EQUALITY_CONNECT: Rule = rule("connect", &[CLASS, Ends::ATTRIBUTES, Equality::ATTRIBUTES], &[]);
static EQUALITY_WELD: Rule = rule("weld", &[CLASS, WeldEquality::ATTRIBUTES, Equality::ATTRIBUTES], &[]);
static EQUALITY_TENDON: Rule = rule(
    "tendon",
    &[CLASS, TendonEquality::ATTRIBUTES, Equality::ATTRIBUTES],
    &[],
);
static EQUALITY_FLEX: Rule = rule("flex", &[CLASS, FlexEquality::ATTRIBUTES, Equality::ATTRIBUTES], &[]);
static EQUALITY: Rule = rule(
    "equality",
    &[],
    &[
        &EQUALITY_CONNECT,
        &EQUALITY_JOINT,
        &EQUALITY_TENDON,
        &EQUALITY_WELD,
        &EQUALITY_FLEX,
    ],
);

static TENDON_JOINT: Rule = rule("joint", &[TendonJoint::ATTRIBUTES], &[]);
static TENDON_SITE: Rule = rule("site", &[TendonSite::ATTRIBUTES], &[]);
static TENDON_GEOM: Rule = rule("geom", &[TendonGeom::ATTRIBUTES], &[]);
static PULLEY: Rule = rule("pulley", &[Pulley::ATTRIBUTES], &[]);
static FIXED: Rule = rule("fixed", &[CLASS, Tendon::ATTRIBUTES], &[&TENDON_JOINT]);
static SPATIAL: Rule = rule(
    "spatial",
    &[CLASS, Tendon::ATTRIBUTES, TendonLooks::ATTRIBUTES],
    &[&TENDON_SITE, &TENDON_GEOM, &PULLEY],
);
static TENDON: Rule = rule("tendon", &[], &[&FIXED, &SPATIAL]);

/// Attributes of all actuators.
const DRIVE: Groups = Actuator::ATTRIBUTES;
/// Attributes of the transmission.
const TARGET: Groups = Target::ATTRIBUTES;
const SITE_TARGET: Groups = AtSite::ATTRIBUTES;
static GENERAL: Rule = rule(
    "general",
    &[
        CLASS,
        DRIVE,
        TARGET,
        SITE_TARGET,
        OnBody::ATTRIBUTES,
        Control::ATTRIBUTES,
        Activation::ATTRIBUTES,
        Law::ATTRIBUTES,
    ],
    &[],
);
static MOTOR: Rule = rule("motor", &[CLASS, DRIVE, TARGET, SITE_TARGET, Control::ATTRIBUTES], &[]);
static POSITION: Rule = rule(
    "position",
    &[
        CLASS,
        DRIVE,
        TARGET,
        SITE_TARGET,
        Control::ATTRIBUTES,
        Servo::ATTRIBUTES,
        Filter::ATTRIBUTES,
    ],
    &[],
);
static VELOCITY: Rule = rule(
    "velocity",
    &[
        CLASS,
        DRIVE,
        TARGET,
        SITE_TARGET,
        Control::ATTRIBUTES,
        Speed::ATTRIBUTES,
    ],
    &[],
);
static INTVELOCITY: Rule = rule(
    "intvelocity",
    &[
        CLASS,
        DRIVE,
        TARGET,
        SITE_TARGET,
        Control::ATTRIBUTES,
        Activation::ATTRIBUTES,
        Servo::ATTRIBUTES,
    ],
    &[],
);
static DAMPER: Rule = rule("damper", &[CLASS, DRIVE, TARGET, SITE_TARGET, Speed::ATTRIBUTES], &[]);
static CYLINDER: Rule = rule(
    "cylinder",
    &[
        CLASS,
        DRIVE,
        TARGET,
        SITE_TARGET,
        Control::ATTRIBUTES,
        Cylinder::ATTRIBUTES,
    ],
    &[],
);
static MUSCLE: Rule = rule(
    "muscle",
    &[CLASS, DRIVE, TARGET, Control::ATTRIBUTES, Muscle::ATTRIBUTES],
    &[],
);
static ADHESION: Rule = rule(
    "adhesion",
    &[CLASS, DRIVE, OnBody::ATTRIBUTES, Adhesion::ATTRIBUTES],
    &[],
);
static ACTUATOR: Rule = rule(
    "actuator",
    &[],
    &[
        &GENERAL,
        &MOTOR,
        &POSITION,
        &VELOCITY,
        &INTVELOCITY,
        &DAMPER,
        &CYLINDER,
        &MUSCLE,
        &ADHESION,
    ],
);

/// Defines the rule of every kind of sensor, and that of their section.
macro_rules! sensor_rules {
    ($($kind:ident),* $(,)?) => {
        static SENSOR: Rule = rule("sensor", &[], &[$({
            static RULE: Rule = rule(SensorType::$kind.name(), sensor::tables(SensorType::$kind), &[]);
            &RULE
        }),*]);
    };
}
sensor_rules!(
    Touch,
    Accelerometer,
    Velocimeter,
    Gyro,
    Force,
    Torque,
    Magnetometer,
    RangeFinder,
    CamProjection,
    JointPos,
    JointVel,
    TendonPos,
    TendonVel,
    ActuatorPos,
    ActuatorVel,
    ActuatorFrc,
    JointActFrc,
    BallQuat,
    BallAngVel,
    JointLimitPos,
    JointLimitVel,
    JointLimitFrc,
    TendonLimitPos,
    TendonLimitVel,
    TendonLimitFrc,
    FramePos,
    FrameQuat,
    FrameXAxis,
    FrameYAxis,
    FrameZAxis,
    FrameLinVel,
    FrameAngVel,
    FrameLinAcc,
    FrameAngAcc,
    SubtreeCom,
    SubtreeLinVel,
    SubtreeAngMom,
    GeomDist,
    GeomNormal,
    GeomFromTo,
    EPotential,
    EKinetic,
    Clock,
    User,
);

static NUMERIC: Rule = rule("numeric", &[Numeric::ATTRIBUTES], &[]);
static CUSTOM_TEXT: Rule = rule("text", &[Text::ATTRIBUTES], &[]);
static TUPLE_ELEMENT: Rule = rule("element", &[TupleElement::ATTRIBUTES], &[]);
static TUPLE: Rule = rule("tuple", &[Tuple::ATTRIBUTES], &[&TUPLE_ELEMENT]);
static CUSTOM: Rule = rule("custom", &[], &[&NUMERIC, &CUSTOM_TEXT, &TUPLE]);

/// Plugins, which are refused by name. A declaration without a use has no effect.
static EXTENSION: Rule = rule("extension", &[], &[]);

static KEY: Rule = rule("key", &[Key::ATTRIBUTES], &[]);
static KEYFRAME: Rule = rule("keyframe", &[], &[&KEY]);

/// The root.
pub(super) static MUJOCO: Rule = rule(
    "mujoco",
    &[Root::ATTRIBUTES],
    &[
        &COMPILER,
        &OPTION,
        &SIZE,
        &VISUAL,
        &STATISTIC,
        &DEFAULT,
        &ASSET,
        &WORLDBODY,
        &CONTACT,
        &EQUALITY,
        &TENDON,
        &ACTUATOR,
        &SENSOR,
        &CUSTOM,
        &KEYFRAME,
        &DEFORMABLE,
        &EXTENSION,
    ],
);
