//! Tables of actuators. All elements fill one struct, so that they share one default per class, as in MuJoCo: a `motor`
//! default reaches servos too, and what a `position` default decides stays for a `general` actuator.

use std::f64::consts::PI;

use crate::model::{BiasType, DynType, GainType};

use super::attribute::Sign::{Any, NonNegative};
use super::attribute::{FLAG, Kind, TEXT, int, real, reals, some};
use super::schema::Element;
use super::table::{Table, table};
use super::words::{BIASES, DYNAMICS, GAINS, TRI, Tri};

/// Parameters that an element may write, as many as MuJoCo has room for.
const PARAMETERS: usize = 10;

table! {
    /// Attributes of all actuators, and what the others decide.
    element Actuator {
        also control: Control = Control::initial();
        also activation: Activation = Activation::initial();
        also law: Law = Law::initial();
        also inheritrange: f64 = 0.0;
        "name" name: String = String::new(), TEXT, own, "Name.";
        "joint" joint: Option<String> = None, TEXT, own, transmission, "Joint that it drives.";
        "jointinparent" jointinparent: Option<String> = None, TEXT, own, transmission, "Joint that it drives, in place of `joint`: the same for the joints that actuators may have here.";
        "tendon" tendon: Option<String> = None, TEXT, own, transmission, "Tendon that it pulls, in place of `joint`.";
        "forcelimited" forcelimited: Tri = Tri::Auto, TRI, "Whether `forcerange` is enforced.";
        "ctrlrange" ctrlrange: [f64; 2] = [0.0; 2], reals(2, Any), "Range of the control.";
        "forcerange" forcerange: [f64; 2] = [0.0; 2], reals(2, Any), "Range of the force.";
        "lengthrange" lengthrange: [f64; 2] = [0.0; 2], reals(2, Any), own, "Shortest and longest length. Kept, and used by muscles alone.";
        "gear" gear: f64 = 1.0, real(Any), "Ratio of the force on the joint or the tendon to the actuator's force.";
        "user" user: Vec<f64> = Vec::new(), Kind::User, "Numbers for programs.";
        check "group", int(i32::MIN as i64, i32::MAX as i64), "Group. Ignored: groups are for viewers.";
    }
}

table! {
    /// The attribute of all actuators but dampers.
    group Control {
        "ctrllimited" limited: Tri = Tri::Auto, TRI, "Whether `ctrlrange` is enforced.";
    }
}

table! {
    /// The attribute of actuators whose activation may be limited.
    group Activation {
        "actrange" range: [f64; 2] = [0.0; 2], reals(2, Any), "Range of the activation.";
    }
}

table! {
    /// Attributes of `<general>` beyond those of other actuators.
    group Law {
        "dyntype" dyntype: DynType = DynType::None, DYNAMICS, "How the activation follows the control: not at all, as its integral, or filtered, where `filterexact` is integrated exactly.";
        "gaintype" gaintype: GainType = GainType::Fixed, GAINS, "Whether the gain is a constant, or affine in length and velocity.";
        "biastype" biastype: BiasType = BiasType::None, BIASES, "Whether there is a bias, affine in length and velocity.";
        "dynprm" dynprm: [f64; 3] = [1.0, 0.0, 0.0], some(1, PARAMETERS, Any), "Time constant of a filter, s. Others, which muscles alone use, are ignored.";
        "gainprm" gainprm: [f64; 3] = [1.0, 0.0, 0.0], some(1, PARAMETERS, Any), "Gain: constant, by length, by velocity. Others, which muscles alone use, are ignored.";
        "biasprm" biasprm: [f64; 3] = [0.0; 3], some(1, PARAMETERS, Any), "Bias: constant, by length, by velocity; a third that is positive where the second is minus the gain is a damping ratio. Others, which muscles alone use, are ignored.";
        "actlimited" actlimited: Tri = Tri::Auto, TRI, "Whether `actrange` is enforced.";
        "actearly" actearly: bool = false, FLAG, "Whether the force follows from the activation at the end of the step.";
        "actdim" actdim: i32 = -1, int(i32::MIN as i64, i32::MAX as i64), "Number of activations, which follows from `dyntype`: another is an error.";
    }
}

table! {
    /// Attributes of `<position>` and `<intvelocity>`.
    group Servo {
        "kp" kp: Option<f64> = None, real(NonNegative), "Gain of the position error; 1 if no default gives another.";
        "kv" kv: Option<f64> = None, real(NonNegative), "Damping; 0 if no default gives another.";
        "dampratio" dampratio: Option<f64> = None, real(NonNegative), "Damping in place of `kv`, as the damping ratio at `qpos0` of what it acts on alone.";
        "inheritrange" inheritrange: Option<f64> = None, real(Any), "Width of the range of the position that is asked for, relative to that of the joint or the tendon, where positive.";
    }
}

table! {
    /// The filter of `<position>`.
    group Filter {
        "timeconst" timeconst: Option<f64> = None, real(NonNegative), "Time constant of an exact filter of the control, s; 0 for no filter.";
    }
}

table! {
    /// The attribute of `<velocity>` and `<damper>`.
    group Speed {
        "kv" kv: Option<f64> = None, real(NonNegative), "Gain of the velocity error, or of damping.";
    }
}

table! {
    /// Attributes of `<cylinder>`.
    group Cylinder {
        "timeconst" timeconst: Option<f64> = None, real(Any), "Time constant of the filter of the control, s; 1 if no default gives another.";
        "area" area: Option<f64> = None, real(Any), "Area of the cylinder; 1 if no default gives another.";
        "diameter" diameter: Option<f64> = None, real(NonNegative), "Diameter of the cylinder, in place of `area`.";
        "bias" bias: Option<[f64; 3]> = None, reals(3, Any), "Bias: constant, by length, by velocity.";
    }
}

const TWO_DAMPINGS: &str = "kv and dampratio are two ways to say the same: give one of them";
const TWO_CTRL_RANGES: &str = "ctrlrange and inheritrange are two ways to say the same: give one of them";
const TWO_ACT_RANGES: &str = "actrange and inheritrange are two ways to say the same: give one of them";
const NEGATIVE_DAMPING: &str = "the ctrlrange of a damper must not be negative";

impl Actuator {
    /// Reads an actuator.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn drive(&mut self, e: &Element) -> Result<(), &'static str> {
        self.apply(e);
        self.control.apply(e);
        self.activation.apply(e);
        // what the elements below have in common with `general` they have by other names
        self.law.apply(e);
        match e.name {
            "motor" => {
                self.law.gainprm[0] = 1.0;
                self.decide(DynType::None, GainType::Fixed, BiasType::None);
            }
            "position" | "intvelocity" => self.servo(e)?,
            "velocity" => {
                let kv = Speed::read(e).kv.unwrap_or(self.law.gainprm[0]);
                self.law.gainprm[0] = kv;
                self.law.biasprm = [0.0, 0.0, -kv];
                self.decide(DynType::None, GainType::Fixed, BiasType::Affine);
            }
            "damper" => {
                self.law.gainprm = [0.0, 0.0, -Speed::read(e).kv.unwrap_or(0.0)];
                self.control.limited = Tri::Yes;
                self.decide(DynType::None, GainType::Affine, BiasType::None);
                if self.ctrlrange.iter().any(|&end| end < 0.0) {
                    return Err(NEGATIVE_DAMPING);
                }
            }
            "cylinder" => self.cylinder(e),
            _ => {}
        }
        Ok(())
    }

    fn decide(&mut self, dyntype: DynType, gaintype: GainType, biastype: BiasType) {
        (self.law.dyntype, self.law.gaintype, self.law.biastype) = (dyntype, gaintype, biastype);
    }

    fn servo(&mut self, e: &Element) -> Result<(), &'static str> {
        let servo = Servo::read(e);
        let kp = servo.kp.unwrap_or(self.law.gainprm[0]);
        self.law.gainprm[0] = kp;
        self.law.biasprm[1] = -kp;
        match (servo.kv, servo.dampratio) {
            (Some(_), Some(_)) => return Err(TWO_DAMPINGS),
            (Some(kv), None) => self.law.biasprm[2] = -kv,
            // a positive number stands for the ratio until the inertia is known
            (None, Some(ratio)) => self.law.biasprm[2] = ratio,
            (None, None) => {}
        }
        if let Some(timeconst) = Filter::read(e).timeconst {
            self.law.dynprm[0] = timeconst;
            self.law.dyntype = match timeconst {
                0.0 => DynType::None,
                _ => DynType::FilterExact,
            };
        }
        self.law.gaintype = GainType::Fixed;
        self.law.biastype = BiasType::Affine;
        self.inheritrange = servo.inheritrange.unwrap_or(self.inheritrange);
        let inherits = |range: [f64; 2]| self.inheritrange > 0.0 && range != [0.0; 2];
        match e.name {
            "position" if inherits(self.ctrlrange) => return Err(TWO_CTRL_RANGES),
            "position" => {}
            _ if inherits(self.activation.range) => return Err(TWO_ACT_RANGES),
            _ => {
                self.law.dyntype = DynType::Integrator;
                self.law.actlimited = Tri::Yes;
            }
        }
        Ok(())
    }

    fn cylinder(&mut self, e: &Element) {
        let cylinder = Cylinder::read(e);
        let area = cylinder.diameter.map(|diameter| PI / 4.0 * diameter * diameter);
        self.law.dynprm[0] = cylinder.timeconst.unwrap_or(self.law.dynprm[0]);
        self.law.gainprm[0] = area.or(cylinder.area).unwrap_or(self.law.gainprm[0]);
        self.law.biasprm = cylinder.bias.unwrap_or(self.law.biasprm);
        self.decide(DynType::Filter, GainType::Fixed, BiasType::Affine);
    }
}
