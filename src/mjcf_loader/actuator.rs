//! Tables of actuators. All elements fill one struct, so that they share one default per class, as in MuJoCo: a `motor`
//! default reaches servos too, and what a `position` default decides stays for a `general` actuator.

use std::f64::consts::PI;

use crate::model::{BiasType, DynType, GainType};

use super::attachment::KeyframeValues;
use super::attribute::Sign::{Any, NonNegative};
use super::attribute::{AttributeKind, FLAG, RANGE, TEXT, int, real, reals, some};
use super::error::UNREAD;
use super::schema::Element;
use super::table::{Table, table};
use super::words::{AutoBool, BIASES, DYNAMICS, GAINS, TRI};

/// Maximum number of parameters of an element, as in MuJoCo.
const PARAMETERS: usize = 10;

/// Returns parameters that are 0 except for the first.
const fn first(value: f64) -> [f64; PARAMETERS] {
    let mut all = [0.0; PARAMETERS];
    all[0] = value;
    all
}

table! {
    /// Attributes of all actuators, and fields that other attributes set.
    element Actuator {
        also control: Control = Control::initial();
        also activation: Activation = Activation::initial();
        also law: Law = Law::initial();
        also target: Target = Target::initial();
        also at_site: AtSite = AtSite::initial();
        also on_body: OnBody = OnBody::initial();
        also inheritrange: f64 = 0.0;
        also states: KeyframeValues = KeyframeValues::new();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "forcelimited" forcelimited: AutoBool = AutoBool::Auto, TRI, "Whether `forcerange` is enforced.";
        "ctrlrange" ctrlrange: [f64; 2] = [0.0; 2], RANGE, "Range of the control.";
        "forcerange" forcerange: [f64; 2] = [0.0; 2], RANGE, "Range of the force.";
        "user" user: Vec<f64> = Vec::new(), AttributeKind::User, "Numbers for programs.";
        "group" group: i32 = 0, int(i32::MIN as i64, i32::MAX as i64), "Group, which `actuatorgroupdisable` may name.";
    }
}

table! {
    /// Attributes of all actuators except adhesion: their transmission.
    group Target {
        "joint" joint: Option<String> = None, TEXT, own, transmission, "Joint that it drives.";
        "jointinparent" jointinparent: Option<String> = None, TEXT, own, transmission, "Joint that it drives, in place of `joint`: the same for the joints that actuators may have here.";
        "tendon" tendon: Option<String> = None, TEXT, own, transmission, "Tendon that it pulls, in place of `joint`.";
        "cranksite" cranksite: Option<String> = None, TEXT, own, transmission, "Site at the end of the crank of a slider-crank, in place of `joint`.";
        "slidersite" slidersite: Option<String> = None, TEXT, own, "Site of the slider of a slider-crank, which moves along its z axis.";
        "cranklength" cranklength: f64 = 0.0, real(Any), "Length of the rod between both sites of a slider-crank, m.";
        "lengthrange" lengthrange: [f64; 2] = [0.0; 2], reals(2, Any), own, "Shortest and longest length, for muscles; where the second is not the greater, both are found by simulation.";
        "gear" gear: [f64; 6] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], some(1, 6, Any), "Ratio of the force on the joint or the tendon to the actuator's force; for a site force and torque in its frame, or in that of `refsite`.";
    }
}

table! {
    /// Attributes of actuators that may act on a site.
    group AtSite {
        "site" site: Option<String> = None, TEXT, own, transmission, "Site that it pushes and turns, in place of `joint`.";
        "refsite" refsite: Option<String> = None, TEXT, own, "Site in whose frame it does so, on the body of which it acts in the opposite direction.";
    }
}

table! {
    /// The attribute of actuators that may press contacts together.
    group OnBody {
        "body" body: Option<String> = None, TEXT, own, transmission, "Body whose contacts it presses together, in place of `joint`.";
    }
}

table! {
    /// The attribute of `<adhesion>`.
    group Adhesion {
        "gain" gain: Option<f64> = None, real(NonNegative), "Force of adhesion at a control of 1, N; 1 if no default gives another.";
    }
}

table! {
    /// The attribute of all actuators except dampers.
    group Control {
        "ctrllimited" limited: AutoBool = AutoBool::Auto, TRI, "Whether `ctrlrange` is enforced.";
    }
}

table! {
    /// The attribute of actuators whose activation may be limited.
    group Activation {
        "actrange" range: [f64; 2] = [0.0; 2], RANGE, "Range of the activation.";
    }
}

table! {
    /// Attributes of `<general>` beyond those of other actuators.
    group Law {
        "dyntype" dyntype: DynType = DynType::None, DYNAMICS, "How the activation follows the control: not at all, as its integral, filtered, where `filterexact` is integrated exactly, or as that of a muscle.";
        "gaintype" gaintype: GainType = GainType::Fixed, GAINS, "Whether the gain is a constant, affine in length and velocity, or the active force of a muscle.";
        "biastype" biastype: BiasType = BiasType::None, BIASES, "Whether there is a bias: affine in length and velocity, or the passive force of a muscle.";
        "dynprm" dynprm: [f64; PARAMETERS] = first(1.0), some(1, PARAMETERS, Any), "Time constant of a filter, s; of a muscle `timeconst` and `tausmooth`.";
        "gainprm" gainprm: [f64; PARAMETERS] = first(1.0), some(1, PARAMETERS, Any), "Gain: constant, by length, by velocity; of a muscle `range`, `force`, `scale`, `lmin`, `lmax`, `vmax`, `fpmax`, `fvmax`.";
        "biasprm" biasprm: [f64; PARAMETERS] = first(0.0), some(1, PARAMETERS, Any), "Bias: constant, by length, by velocity; a third that is positive where the second is minus the gain is a damping ratio; of a muscle as the gain.";
        "actlimited" actlimited: AutoBool = AutoBool::Auto, TRI, "Whether `actrange` is enforced.";
        "actearly" actearly: bool = false, FLAG, "Whether the force follows from the activation at the end of the step.";
        "actdim" actdim: i32 = -1, int(i32::MIN as i64, i32::MAX as i64), "Number of activations, which follows from `dyntype`: another is an error.";
    }
}

table! {
    /// Attributes of `<position>` and `<intvelocity>`.
    group Servo {
        "kp" kp: Option<f64> = None, real(NonNegative), "Gain of the position error; 1 if no default gives another.";
        "kv" kv: Option<f64> = None, real(NonNegative), "Damping; 0 for that of a default, or none.";
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

table! {
    /// Attributes of `<muscle>`.
    group Muscle {
        "timeconst" timeconst: Option<[f64; 2]> = None, reals(2, Any), "Time constants of activation and deactivation, s; 0.01 and 0.04 if no default gives others.";
        "tausmooth" tausmooth: Option<f64> = None, real(NonNegative), own, "Width of the transition between them, in differences of control and activation.";
        "range" range: Option<[f64; 2]> = None, reals(2, Any), "What the ends of `lengthrange` are in optimal lengths; 0.75 and 1.05 if no default gives others.";
        "force" force: Option<f64> = None, real(Any), "Isometric force, N; negative for that which `scale` gives.";
        "scale" scale: Option<f64> = None, real(Any), "Isometric force times the acceleration per unit force at `qpos0`; 200 if no default gives another.";
        "lmin" lmin: Option<f64> = None, real(Any), "Shortest length with an active force, optimal lengths; 0.5 if no default gives another.";
        "lmax" lmax: Option<f64> = None, real(Any), "Longest length with an active force, optimal lengths; 1.6 if no default gives another.";
        "vmax" vmax: Option<f64> = None, real(Any), "Speed at which an unloaded muscle shortens, optimal lengths/s; 1.5 if no default gives another.";
        "fpmax" fpmax: Option<f64> = None, real(Any), "Passive force at `lmax`, isometric forces; 1.3 if no default gives another.";
        "fvmax" fvmax: Option<f64> = None, real(Any), "Active force when stretched fastest, isometric forces; 1.2 if no default gives another.";
    }
}

const TWO_DAMPINGS: &str = "kv and dampratio are two ways to say the same: give one of them";
const TWO_CTRL_RANGES: &str = "ctrlrange and inheritrange are two ways to say the same: give one of them";
const TWO_ACT_RANGES: &str = "actrange and inheritrange are two ways to say the same: give one of them";
const NEGATIVE_SMOOTHING: &str =
    "a muscle's tausmooth, which it may have from dynprm of a default class, must be 0 or more";
const NEGATIVE_ADHESION: &str = "the ctrlrange of adhesion must not be negative";
const REPULSION: &str = "the gain of adhesion, which it may have from gainprm of a default class, must not be negative";
const NO_CRANK: &str = "slidersite and cranklength are for slider-cranks: give cranksite, too";
const NO_SITE: &str = "refsite needs the attribute site";
const NEGATIVE_DAMPING: &str = "the ctrlrange of a damper must not be negative";

/// Checks that the attributes of an actuator name exactly one target.
fn check_target(e: &Element) -> Result<(), &'static str> {
    let given = |names: &[&str]| e.values().any(|(name, _)| names.contains(&name));
    let elsewhere = given(&["joint", "jointinparent", "tendon", "site", "body"]);
    if elsewhere && given(&["slidersite", "cranklength"]) {
        return Err(NO_CRANK);
    }
    if given(&["joint", "jointinparent", "tendon", "cranksite", "body"]) && given(&["refsite"]) {
        return Err(NO_SITE);
    }
    Ok(())
}

impl Actuator {
    /// Reads an actuator.
    ///
    /// # Errors
    /// Its attributes contradict each other.
    pub fn drive(&mut self, e: &Element) -> Result<(), &'static str> {
        self.apply(e);
        self.control.apply(e);
        self.activation.apply(e);
        self.target.apply(e);
        self.at_site.apply(e);
        self.on_body.apply(e);
        check_target(e)?;
        // the elements below have these attributes of `general` under other names
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
                self.law.biasprm = first(0.0);
                self.law.biasprm[2] = -kv;
                self.decide(DynType::None, GainType::Fixed, BiasType::Affine);
            }
            "damper" => {
                self.law.gainprm = first(0.0);
                self.law.gainprm[2] = -Speed::read(e).kv.unwrap_or(0.0);
                self.control.limited = AutoBool::Yes;
                self.decide(DynType::None, GainType::Affine, BiasType::None);
                if self.ctrlrange.iter().any(|&end| end < 0.0) {
                    return Err(NEGATIVE_DAMPING);
                }
            }
            "cylinder" => self.cylinder(e),
            "adhesion" => {
                self.law.gainprm[0] = Adhesion::read(e).gain.unwrap_or(self.law.gainprm[0]);
                // not by `decide`, because the dyntype of a default class stays
                (self.law.gaintype, self.law.biastype) = (GainType::Fixed, BiasType::None);
                self.control.limited = AutoBool::Yes;
                if self.law.gainprm[0] < 0.0 {
                    return Err(REPULSION);
                }
                if self.ctrlrange.iter().any(|&end| end < 0.0) {
                    return Err(NEGATIVE_ADHESION);
                }
            }
            "muscle" => {
                self.muscle(&Muscle::read(e));
                if self.law.dynprm[2] < 0.0 {
                    return Err(NEGATIVE_SMOOTHING);
                }
            }
            "general" => {}
            _ => return Err(UNREAD),
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
        // zeros keep the value of a default, as in MuJoCo 3.3.0
        let [kv, dampratio] = [servo.kv, servo.dampratio].map(|given| given.filter(|value| *value != 0.0));
        match (kv, dampratio) {
            (Some(_), Some(_)) => return Err(TWO_DAMPINGS),
            (Some(kv), None) => self.law.biasprm[2] = -kv,
            // a positive number is the damping ratio until the inertia is known
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
                self.law.actlimited = AutoBool::Yes;
            }
        }
        Ok(())
    }

    fn cylinder(&mut self, e: &Element) {
        let cylinder = Cylinder::read(e);
        let area = cylinder.diameter.map(|diameter| PI / 4.0 * diameter * diameter);
        self.law.dynprm[0] = cylinder.timeconst.unwrap_or(self.law.dynprm[0]);
        self.law.gainprm[0] = area.or(cylinder.area).unwrap_or(self.law.gainprm[0]);
        if let Some(bias) = cylinder.bias {
            self.law.biasprm[..3].copy_from_slice(&bias);
        }
        self.decide(DynType::Filter, GainType::Fixed, BiasType::Affine);
    }

    /// Fills parameters that neither the element nor a default gives with a muscle's own values. A parameter with the value of other actuators counts
    /// as not given.
    fn muscle(&mut self, muscle: &Muscle) {
        const TIMES: [f64; 2] = [0.01, 0.04];
        const FORCES: [f64; 9] = [0.75, 1.05, -1.0, 200.0, 0.5, 1.6, 1.5, 1.3, 1.2];
        let Muscle {
            range,
            force,
            scale,
            lmin,
            lmax,
            vmax,
            fpmax,
            fvmax,
            ..
        } = *muscle;
        let ends = |pair: Option<[f64; 2]>| [pair.map(|pair| pair[0]), pair.map(|pair| pair[1])];
        let [low, high] = ends(range);
        let forces = [low, high, force, scale, lmin, lmax, vmax, fpmax, fvmax];
        let law = &mut self.law;
        fill(&mut law.dynprm, &TIMES, &ends(muscle.timeconst));
        fill(&mut law.gainprm, &FORCES, &forces);
        law.dynprm[2] = muscle.tausmooth.unwrap_or(law.dynprm[2]);
        law.biasprm[..9].copy_from_slice(&law.gainprm[..9]);
        self.decide(DynType::Muscle, GainType::Muscle, BiasType::Muscle);
    }
}

/// Fills parameters with `own` where they have the values of an unset actuator, then with the given ones.
fn fill(parameters: &mut [f64; PARAMETERS], own: &[f64], given: &[Option<f64>]) {
    let untouched = first(1.0);
    for (k, (own, given)) in own.iter().zip(given).enumerate() {
        if parameters[k] == untouched[k] {
            parameters[k] = *own;
        }
        parameters[k] = given.unwrap_or(parameters[k]);
    }
}
