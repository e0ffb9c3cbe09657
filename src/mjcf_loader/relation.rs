//! The part of the typed document that refers to bodies, joints, geoms and sites: contact, equalities, tendons,
//! actuators, sensors.

use crate::math::Vec3;
use crate::model::{BiasType, SensorType};

use super::document::{SOLIMP, SOLREF, TRIS, Tri};
use super::schema::Element;

#[derive(Clone)]
pub(super) struct Pair {
    pub at: usize,
    pub name: String,
    pub geom1: String,
    pub geom2: String,
    pub condim: usize,
    pub friction: [f64; 5],
    pub solref: [f64; 2],
    pub solreffriction: [f64; 2],
    pub solimp: [f64; 5],
    pub margin: f64,
    pub gap: f64,
}

impl Default for Pair {
    fn default() -> Self {
        Pair {
            at: 0,
            name: String::new(),
            geom1: String::new(),
            geom2: String::new(),
            condim: 3,
            friction: [1.0, 1.0, 0.005, 0.0001, 0.0001],
            solref: SOLREF,
            solreffriction: [0.0; 2],
            solimp: SOLIMP,
            margin: 0.0,
            gap: 0.0,
        }
    }
}

impl Pair {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_text("geom1", &mut self.geom1);
        e.set_text("geom2", &mut self.geom2);
        e.set_int("condim", &mut self.condim);
        e.fill("friction", &mut self.friction);
        e.fill("solref", &mut self.solref);
        e.fill("solreffriction", &mut self.solreffriction);
        e.fill("solimp", &mut self.solimp);
        e.set_real("margin", &mut self.margin);
        e.set_real("gap", &mut self.gap);
    }
}

pub(super) struct Exclude {
    pub at: usize,
    pub name: String,
    pub body1: String,
    pub body2: String,
}

/// What an equality holds, by name.
#[derive(Clone)]
pub(super) enum Held {
    Joint {
        joint1: String,
        joint2: Option<String>,
        polycoef: [f64; 5],
    },
    Weld {
        body1: String,
        body2: Option<String>,
        relpose: [f64; 7],
        anchor: Vec3,
        torquescale: f64,
    },
}

#[derive(Clone)]
pub(super) struct Equality {
    pub at: usize,
    pub name: String,
    pub held: Held,
    pub active: bool,
    pub solref: [f64; 2],
    pub solimp: [f64; 5],
}

impl Default for Equality {
    fn default() -> Self {
        let held = Held::Joint {
            joint1: String::new(),
            joint2: None,
            polycoef: [0.0; 5],
        };
        Equality {
            at: 0,
            name: String::new(),
            held,
            active: true,
            solref: SOLREF,
            solimp: SOLIMP,
        }
    }
}

impl Equality {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_flag("active", &mut self.active);
        e.fill("solref", &mut self.solref);
        e.fill("solimp", &mut self.solimp);
        let owned = |name: &str| e.text(name).map(str::to_owned);
        match e.name {
            "joint" => {
                let mut polycoef = [0.0, 1.0, 0.0, 0.0, 0.0];
                e.fill("polycoef", &mut polycoef);
                self.held = Held::Joint {
                    joint1: owned("joint1").unwrap_or_default(),
                    joint2: owned("joint2"),
                    polycoef,
                };
            }
            "weld" => {
                self.held = Held::Weld {
                    body1: owned("body1").unwrap_or_default(),
                    body2: owned("body2"),
                    // A zero quaternion asks for the relative pose at `qpos0`.
                    relpose: e.array("relpose").unwrap_or([0.0; 7]),
                    anchor: e.array("anchor").unwrap_or([0.0; 3]),
                    torquescale: e.array("torquescale").map_or(1.0, |[scale]| scale),
                }
            }
            _ => {}
        }
    }
}

#[derive(Clone)]
pub(super) struct Tendon {
    pub at: usize,
    pub name: String,
    pub limited: Tri,
    pub range: [f64; 2],
    pub margin: f64,
    pub solref_limit: [f64; 2],
    pub solimp_limit: [f64; 5],
    /// Place, joint, coefficient.
    pub wrap: Vec<(usize, String, f64)>,
}

impl Default for Tendon {
    fn default() -> Self {
        Tendon {
            at: 0,
            name: String::new(),
            limited: Tri::Auto,
            range: [0.0; 2],
            margin: 0.0,
            solref_limit: SOLREF,
            solimp_limit: SOLIMP,
            wrap: Vec::new(),
        }
    }
}

impl Tendon {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_word("limited", TRIS, &mut self.limited);
        e.fill("range", &mut self.range);
        e.set_real("margin", &mut self.margin);
        e.fill("solreflimit", &mut self.solref_limit);
        e.fill("solimplimit", &mut self.solimp_limit);
        for joint in &e.children {
            let coef = joint.array("coef").map_or(0.0, |[coef]| coef);
            self.wrap
                .push((joint.at, joint.text("joint").unwrap_or_default().to_owned(), coef));
        }
    }
}

/// Motors and position servos share one default per class, as in the reference: a `motor` default reaches servos too.
#[derive(Clone)]
pub(super) struct Actuator {
    pub at: usize,
    pub name: String,
    pub joint: String,
    pub gear: f64,
    pub ctrllimited: Tri,
    pub ctrlrange: [f64; 2],
    pub forcelimited: Tri,
    pub forcerange: [f64; 2],
    pub gain: f64,
    pub biastype: BiasType,
    pub biasprm: [f64; 3],
    pub user: Vec<f64>,
}

impl Default for Actuator {
    fn default() -> Self {
        Actuator {
            at: 0,
            name: String::new(),
            joint: String::new(),
            gear: 1.0,
            ctrllimited: Tri::Auto,
            ctrlrange: [0.0; 2],
            forcelimited: Tri::Auto,
            forcerange: [0.0; 2],
            gain: 1.0,
            biastype: BiasType::None,
            biasprm: [0.0; 3],
            user: Vec::new(),
        }
    }
}

impl Actuator {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_text("joint", &mut self.joint);
        e.set_real("gear", &mut self.gear);
        e.set_word("ctrllimited", TRIS, &mut self.ctrllimited);
        e.fill("ctrlrange", &mut self.ctrlrange);
        e.set_word("forcelimited", TRIS, &mut self.forcelimited);
        e.fill("forcerange", &mut self.forcerange);
        if let Some(user) = e.reals("user") {
            self.user = user.to_vec();
        }
        if e.name == "position" {
            e.set_real("kp", &mut self.gain);
            self.biastype = BiasType::Affine;
            self.biasprm[1] = -self.gain;
            if let Some([kv]) = e.array("kv") {
                self.biasprm[2] = -kv;
            }
        } else {
            // Bias parameters of a servo default stay, unused without a bias type.
            self.gain = 1.0;
            self.biastype = BiasType::None;
        }
    }
}

pub(super) struct Sensor {
    pub at: usize,
    pub name: String,
    pub kind: SensorType,
    pub site: String,
}
