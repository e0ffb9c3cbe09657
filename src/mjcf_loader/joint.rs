//! Tables of joints.

use super::attachment::KeyframeValues;
use super::attribute::Sign::{Any, NonNegative};
use super::attribute::{AttributeKind, FLAG, RANGE, TEXT, int, real, reals, some};
use super::table::table;
use super::words::{AutoBool, JOINTS, MAX_GROUP, MIN_GROUP, SOLIMP, SOLREF, TRI};
use crate::math::Vec3;
use crate::model::JointType;

table! {
    /// `<joint>`.
    element Joint {
        also within: Option<usize> = None;
        also align: AutoBool = AutoBool::Auto;
        also states: KeyframeValues = KeyframeValues::new();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "type" kind: JointType = JointType::Hinge, JOINTS, "AttributeKind of motion.";
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group.";
        "pos" pos: Vec3 = [0.0; 3], reals(3, Any), "Anchor in the body, m.";
        "axis" axis: Vec3 = [0.0, 0.0, 1.0], reals(3, Any), "Axis in the body.";
        "limited" limited: AutoBool = AutoBool::Auto, TRI, "Whether the limit is enforced.";
        "range" range: [f64; 2] = [0.0; 2], RANGE, "Lower and upper limit, angle or m.";
        "margin" margin: f64 = 0.0, real(NonNegative), "Distance to the limit at which it becomes active.";
        "actuatorfrclimited" actuatorfrclimited: AutoBool = AutoBool::Auto, TRI, "Whether `actuatorfrcrange` is enforced.";
        "actuatorgravcomp" actuatorgravcomp: bool = false, FLAG, "Whether its actuators hold up the weight that `gravcomp` compensates.";
        "actuatorfrcrange" actuatorfrcrange: [f64; 2] = [0.0; 2], RANGE, "Range of the force of all actuators on the joint, N m or N.";
        "springdamper" springdamper: [f64; 2] = [0.0; 2], reals(2, NonNegative), "Time constant, s, and damping ratio of the joint alone, from which stiffness and damping follow in place of those given.";
        "stiffness" stiffness: f64 = 0.0, real(NonNegative), "Stiffness of the spring, N m/rad or N/m.";
        "damping" damping: f64 = 0.0, real(NonNegative), "Damping, N m s/rad or N s/m.";
        "armature" armature: f64 = 0.0, real(NonNegative), "Inertia of the rotor, kg m^2 or kg.";
        "frictionloss" frictionloss: f64 = 0.0, real(NonNegative), "Dry friction, N m or N.";
        "ref" reference: f64 = 0.0, real(Any), "Coordinate of the pose as written, angle or m.";
        "springref" springref: f64 = 0.0, real(Any), "Coordinate at which the spring rests, angle or m.";
        "solreflimit" solref_limit: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of the limit.";
        "solimplimit" solimp_limit: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of the limit.";
        "solreffriction" solref_friction: [f64; 2] = SOLREF, some(1, 2, Any), "`solref` of dry friction.";
        "solimpfriction" solimp_friction: [f64; 5] = SOLIMP, some(1, 5, Any), "`solimp` of dry friction.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
    }
}

table! {
    /// `<freejoint>`. It has no defaults: only `<joint type="free">` has a class.
    element FreeJoint {
        "name" name: String = String::new(), TEXT, own, "Name.";
        "group" group: i32 = 0, int(MIN_GROUP, MAX_GROUP), "Visual group.";
        "align" align: AutoBool = AutoBool::Auto, TRI, "Whether the frame of the body is moved into its centre of mass and along its principal axes, where no other bodies are in it; `auto`: as `alignfree` of the compiler.";
    }
}
