//! Tables of sensors: attributes of all sensors, and the objects of each kind.

use crate::model::{DataType, ObjType, SensorType};

use super::attribute::Sign::NonNegative;
use super::attribute::{AttributeKind, Groups, Keywords, TEXT, int, real, words};
use super::error::UNREAD;
use super::schema::Element;
use super::table::{Table, table};

/// A kind of object that has a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameObject {
    Body,
    XBody,
    Geom,
    Site,
    Camera,
}

const FRAMES: Keywords<FrameObject> = words! {
    "body" => FrameObject::Body,
    "xbody" => FrameObject::XBody,
    "geom" => FrameObject::Geom,
    "site" => FrameObject::Site,
    "camera" => FrameObject::Camera,
};

table! {
    /// Attributes of all sensors.
    element Sensor {
        also kind: SensorType = SensorType::Clock;
        also object: Object = Object::Nothing;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "cutoff" cutoff: f64 = 0.0, real(NonNegative), "Bound of the values; 0 for none.";
        "noise" noise: f64 = 0.0, real(NonNegative), "Standard deviation of noise, for programs: sensors are exact.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
    }
}

table! {
    /// The site of a sensor on a site.
    group OnSite {
        "site" site: String = String::new(), TEXT, required, "Site that it sits on.";
    }
}

table! {
    /// The joint of a sensor of a joint.
    group OfJoint {
        "joint" joint: String = String::new(), TEXT, required, "Joint that it measures.";
    }
}

table! {
    /// The tendon of a sensor of a tendon.
    group OfTendon {
        "tendon" tendon: String = String::new(), TEXT, required, "Tendon that it measures.";
    }
}

table! {
    /// The actuator of a sensor of an actuator.
    group OfActuator {
        "actuator" actuator: String = String::new(), TEXT, required, "Actuator that it measures.";
    }
}

table! {
    /// The body of a sensor that covers a body and those below it.
    group OfSubtree {
        "body" body: String = String::new(), TEXT, required, "Body that it measures, with all below it.";
    }
}

table! {
    /// The object of a frame sensor, and its reference.
    group OfFrame {
        "objtype" objtype: FrameObject = FrameObject::Body, FRAMES, required, "AttributeKind of the object; `body` for the frame of its centre of mass, `xbody` for its own.";
        "objname" objname: String = String::new(), TEXT, required, "Name of the object.";
    }
}

table! {
    /// The frame in which a frame sensor measures.
    group InFrame {
        "reftype" reftype: Option<FrameObject> = None, FRAMES, "AttributeKind of the object in whose frame it measures; else in that of the world.";
        "refname" refname: Option<String> = None, TEXT, "Name of that object.";
    }
}

table! {
    /// The site and the camera of a `camprojection` sensor.
    group InPicture {
        "site" site: String = String::new(), TEXT, required, "Site that is seen.";
        "camera" camera: String = String::new(), TEXT, required, "Camera that sees it.";
    }
}

table! {
    /// The geoms, or bodies, of a sensor between geoms.
    group Between {
        "geom1" geom1: Option<String> = None, TEXT, first, "First geom.";
        "body1" body1: Option<String> = None, TEXT, first, "Body whose geoms are the first.";
        "geom2" geom2: Option<String> = None, TEXT, second, "Second geom.";
        "body2" body2: Option<String> = None, TEXT, second, "Body whose geoms are the second.";
    }
}

/// Greatest number of values of a sensor that a program fills.
const MAX_USER: i64 = 1000;

/// Stages of a step, by MuJoCo's numbers.
const STAGES: Keywords<usize> = words! { "none" => 0, "pos" => 1, "vel" => 2, "acc" => 3 };

const DATA: Keywords<DataType> = words! {
    "real" => DataType::Real,
    "positive" => DataType::Positive,
    "axis" => DataType::Axis,
    "quaternion" => DataType::Quaternion,
};

/// Kinds of objects that a user-defined sensor may name.
const OBJECTS: Keywords<ObjType> = words! {
    "body" => ObjType::Body,
    "xbody" => ObjType::XBody,
    "joint" => ObjType::Joint,
    "geom" => ObjType::Geom,
    "site" => ObjType::Site,
    "camera" => ObjType::Camera,
    "tendon" => ObjType::Tendon,
    "actuator" => ObjType::Actuator,
};

table! {
    /// Size and stage of a sensor that a program fills.
    group OfUser {
        "dim" dim: usize = 0, int(0, MAX_USER), required, "Number of its values.";
        "needstage" needstage: usize = 3, STAGES, "Stage of a step after which the program fills it, for the program.";
        "datatype" datatype: DataType = DataType::Real, DATA, "AttributeKind of its values, which says how a cutoff acts on them.";
        "objtype" objtype: Option<ObjType> = None, OBJECTS, "AttributeKind of an object that it is about, for the program.";
        "objname" objname: Option<String> = None, TEXT, "Name of that object.";
    }
}

/// Objects that a sensor refers to, by name.
#[derive(Clone)]
pub(super) enum Object {
    Nothing,
    Site(String),
    Joint(String),
    Tendon(String),
    Actuator(String),
    Subtree(String),
    Frame(OfFrame, InFrame),
    Picture(InPicture),
    Between(Between),
    User(OfUser),
}

/// Returns the tables of a kind of sensor, its own attributes first.
pub(super) const fn tables(kind: SensorType) -> &'static [Groups] {
    use SensorType::*;
    match kind {
        Touch | Accelerometer | Velocimeter | Gyro | Force | Torque | Magnetometer | RangeFinder => {
            &[OnSite::ATTRIBUTES, Sensor::ATTRIBUTES]
        }
        JointPos | JointVel | JointActFrc | BallQuat | BallAngVel | JointLimitPos | JointLimitVel | JointLimitFrc => {
            &[OfJoint::ATTRIBUTES, Sensor::ATTRIBUTES]
        }
        TendonPos | TendonVel | TendonLimitPos | TendonLimitVel | TendonLimitFrc => {
            &[OfTendon::ATTRIBUTES, Sensor::ATTRIBUTES]
        }
        ActuatorPos | ActuatorVel | ActuatorFrc => &[OfActuator::ATTRIBUTES, Sensor::ATTRIBUTES],
        FramePos | FrameQuat | FrameXAxis | FrameYAxis | FrameZAxis | FrameLinVel | FrameAngVel => {
            &[OfFrame::ATTRIBUTES, InFrame::ATTRIBUTES, Sensor::ATTRIBUTES]
        }
        FrameLinAcc | FrameAngAcc => &[OfFrame::ATTRIBUTES, Sensor::ATTRIBUTES],
        SubtreeCom | SubtreeLinVel | SubtreeAngMom => &[OfSubtree::ATTRIBUTES, Sensor::ATTRIBUTES],
        CamProjection => &[InPicture::ATTRIBUTES, Sensor::ATTRIBUTES],
        GeomDist | GeomNormal | GeomFromTo => &[Between::ATTRIBUTES, Sensor::ATTRIBUTES],
        User => &[OfUser::ATTRIBUTES, Sensor::ATTRIBUTES],
        EPotential | EKinetic | Clock => &[Sensor::ATTRIBUTES],
    }
}

impl Sensor {
    /// Reads a sensor of any kind with the objects that it refers to. An error describes the fault.
    pub fn of(e: &Element) -> Result<Self, &'static str> {
        let named = |attribute: &str| e.text(attribute).map(str::to_owned);
        let kind = SensorType::ALL.iter().find(|kind| kind.name() == e.name).copied();
        let kind = kind.ok_or(UNREAD)?;
        let object = match kind {
            SensorType::CamProjection => Some(Object::Picture(InPicture::read(e))),
            SensorType::User => Some(Object::User(OfUser::read(e))),
            SensorType::GeomDist | SensorType::GeomNormal | SensorType::GeomFromTo => {
                Some(Object::Between(Between::read(e)))
            }
            _ => None,
        };
        let object = if let Some(object) = object {
            object
        } else if let Some(site) = named("site") {
            Object::Site(site)
        } else if let Some(joint) = named("joint") {
            Object::Joint(joint)
        } else if let Some(tendon) = named("tendon") {
            Object::Tendon(tendon)
        } else if let Some(actuator) = named("actuator") {
            Object::Actuator(actuator)
        } else if let Some(body) = named("body") {
            Object::Subtree(body)
        } else if named("objname").is_some() {
            Object::Frame(OfFrame::read(e), InFrame::read(e))
        } else {
            Object::Nothing
        };
        Ok(Self {
            kind,
            object,
            ..Self::read(e)
        })
    }
}
