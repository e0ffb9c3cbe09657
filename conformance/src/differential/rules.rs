//! How the values of every attribute are drawn. A line for each attribute of the loader's tables: a test fails where one is
//! missing, and where one changes physics and is never drawn.

use super::dice::{Dice, numbers};

/// How an attribute gets its values.
#[derive(Clone, Copy)]
pub enum How {
    /// It changes no physics: names, colours, sizes of what is only drawn.
    Nothing,
    /// By the place of the element in the document, as with references. Here are values that fit the document of
    /// [`super::single`]; where there are none, all words of the attribute do.
    Placed(&'static [&'static str]),
    /// Any of its words, with a probability.
    Word(f64),
    /// Drawn, with a probability.
    Drawn(f64, fn(&mut Dice) -> String),
}

use How::{Drawn, Nothing, Placed, Word};

/// How one attribute gets its values.
pub type Rule = (&'static str, How);

/// Attributes of which an element may have one at most.
pub const RIVALS: [&[&str]; 9] = [
    &["quat", "axisangle", "xyaxes", "zaxis", "euler", "fromto"],
    &["pos", "fromto"],
    &["diaginertia", "fullinertia"],
    &["joint", "jointinparent", "tendon", "site", "cranksite", "body"],
    &["kv", "dampratio"],
    &["ctrlrange", "inheritrange"],
    &["actrange", "inheritrange"],
    &["geom1", "body1"],
    &["geom2", "body2"],
];

const CLASS: &[Rule] = &[("class", Placed(&["stiff"]))];

const FRAME: &[Rule] = &[
    ("quat", Drawn(0.15, Dice::quat)),
    (
        "axisangle",
        Drawn(0.1, |d| format!("{} {}", numbers(&d.vector(3, 1.0)), d.coordinate(3.0))),
    ),
    ("xyaxes", Drawn(0.1, |d| numbers(&d.vector(6, 1.0)))),
    ("zaxis", Drawn(0.1, |d| numbers(&d.vector(3, 1.0)))),
    (
        "euler",
        Drawn(0.1, |d| {
            [d.coordinate(3.0), d.coordinate(3.0), d.coordinate(3.0)].join(" ")
        }),
    ),
    ("pos", Drawn(0.6, |d| d.reals(3, 0.3))),
];

const LOOKS: &[Rule] = &[("rgba", Nothing), ("material", Nothing), ("user", Nothing)];

const COMPILER: &[Rule] = &[
    ("angle", Placed(&[])),
    (
        "eulerseq",
        Drawn(0.3, |d| {
            (0..3).map(|_| d.pick(&['x', 'y', 'z', 'X', 'Y', 'Z'])).collect()
        }),
    ),
    ("inertiafromgeom", Drawn(0.2, |d| d.pick(&["true", "auto"]).to_owned())),
    ("autolimits", Placed(&[])),
    (
        "inertiagrouprange",
        Drawn(0.06, |d| d.pick(&["0 5", "0 2", "0 4", "-1 3", "2 2"]).to_owned()),
    ),
    ("balanceinertia", Word(0.2)),
    ("boundmass", Drawn(0.1, |d| d.log(0.05, 20.0))),
    ("boundinertia", Drawn(0.1, |d| d.log(1e-4, 0.05))),
    ("settotalmass", Drawn(0.15, |d| d.log(0.5, 50.0))),
    ("texturedir", Nothing),
    ("strippath", Nothing),
    ("assetdir", Nothing),
    ("meshdir", Nothing),
    ("fitaabb", Word(0.2)),
    ("usethread", Nothing),
    ("fusestatic", Nothing),
    ("discardvisual", Nothing),
    ("alignfree", Nothing),
    ("coordinate", Nothing),
];

const OPTION: &[Rule] = &[
    ("timestep", Drawn(1.0, |d| d.log(0.0005, 0.02))),
    ("gravity", Drawn(0.5, |d| d.reals(3, 10.0))),
    ("iterations", Placed(&["0", "1", "2", "7"])),
    ("tolerance", Placed(&["0", "1e-3", "1e-13"])),
    ("ls_iterations", Placed(&["0", "1", "2", "3", "5", "13"])),
    ("ls_tolerance", Placed(&["0", "1e-6", "0.5"])),
    ("impratio", Drawn(0.4, |d| d.log(0.1, 20.0))),
    (
        "ccd_iterations",
        Drawn(0.05, |d| d.pick(&["1", "4", "20", "200"]).to_owned()),
    ),
    ("ccd_tolerance", Drawn(0.1, |d| d.log(1e-10, 1e-4))),
    ("integrator", Word(0.3)),
    ("density", Drawn(0.08, |d| d.log(0.5, 2000.0))),
    ("viscosity", Drawn(0.08, |d| d.log(1e-3, 2.0))),
    ("wind", Drawn(0.08, |d| d.reals(3, 3.0))),
    (
        "noslip_iterations",
        Drawn(0.12, |d| d.pick(&["1", "2", "3", "5", "20"]).to_owned()),
    ),
    ("noslip_tolerance", Drawn(0.12, |d| d.log(1e-12, 1e-4))),
    ("apirate", Nothing),
    ("magnetic", Nothing),
    ("o_margin", Nothing),
    ("o_solref", Nothing),
    ("o_solimp", Nothing),
    ("o_friction", Nothing),
    ("sdf_iterations", Nothing),
    ("sdf_initpoints", Nothing),
    ("cone", Word(0.7)),
    ("jacobian", Word(0.3)),
    ("solver", Word(0.15)),
];

const FLAG: &[Rule] = &[
    ("constraint", Word(0.04)),
    ("equality", Word(0.08)),
    ("frictionloss", Word(0.08)),
    ("limit", Word(0.08)),
    ("contact", Word(0.04)),
    ("passive", Word(0.1)),
    ("gravity", Word(0.1)),
    ("clampctrl", Word(0.2)),
    ("warmstart", Word(0.2)),
    ("filterparent", Word(0.2)),
    ("actuation", Word(0.1)),
    ("refsafe", Word(0.1)),
    ("sensor", Word(0.05)),
    ("eulerdamp", Word(0.2)),
    ("midphase", Word(0.1)),
    ("autoreset", Nothing),
    ("energy", Nothing),
    ("fwdinv", Nothing),
    ("invdiscrete", Nothing),
    ("nativeccd", Word(0.02)),
    ("override", Nothing),
    ("multiccd", Word(0.02)),
    ("island", Nothing),
];

const STATISTIC: &[Rule] = &[
    ("meaninertia", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("meanmass", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("meansize", Drawn(0.3, |d| d.log(0.1, 1.0))),
    ("extent", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("center", Drawn(0.3, |d| d.reals(3, 1.0))),
];

const JOINT: &[Rule] = &[
    ("name", Placed(&[])),
    ("type", Placed(&[])),
    ("group", Nothing),
    ("pos", Drawn(0.5, |d| d.reals(3, 0.1))),
    ("axis", Drawn(0.9, Dice::axis)),
    ("limited", Placed(&[])),
    ("range", Drawn(0.4, Dice::limits)),
    ("margin", Drawn(0.2, |d| d.log(0.001, 0.3))),
    ("actuatorfrclimited", Placed(&[])),
    ("actuatorgravcomp", Word(0.05)),
    ("actuatorfrcrange", Drawn(0.15, |d| d.range(2.0))),
    (
        "springdamper",
        Drawn(0.08, |d| format!("{} {}", d.log(0.01, 1.0), d.log(0.1, 3.0))),
    ),
    ("stiffness", Drawn(0.3, |d| d.log(0.01, 50.0))),
    ("damping", Drawn(0.3, |d| d.log(0.001, 5.0))),
    ("armature", Drawn(0.3, |d| d.log(0.0001, 0.5))),
    ("frictionloss", Drawn(0.25, |d| d.log(0.001, 5.0))),
    ("ref", Drawn(0.3, |d| d.coordinate(1.0))),
    ("springref", Drawn(0.3, |d| d.coordinate(1.0))),
    ("solreflimit", Drawn(0.15, Dice::solref)),
    ("solimplimit", Drawn(0.15, Dice::solimp)),
    ("solreffriction", Drawn(0.15, Dice::solref)),
    ("solimpfriction", Drawn(0.15, Dice::solimp)),
    ("user", Nothing),
];

const GEOM: &[Rule] = &[
    ("name", Placed(&[])),
    ("type", Placed(&[])),
    ("size", Placed(&["0.06", "0.08 0.11", "0.07 0.09 0.12"])),
    ("fromto", Placed(&["0 0 -0.1 0.1 0 0.2"])),
    (
        "contype",
        Drawn(0.05, |d| d.pick(&["0", "1", "2", "3", "2147483647"]).to_owned()),
    ),
    ("conaffinity", Drawn(0.05, |d| d.pick(&["0", "1", "2", "3"]).to_owned())),
    ("condim", Drawn(0.3, |d| d.pick(&["1", "3", "4", "6"]).to_owned())),
    ("priority", Drawn(0.15, |d| d.rng.i32(-2..=2).to_string())),
    ("friction", Drawn(0.3, |d| d.friction(1))),
    ("solmix", Drawn(0.15, |d| d.pick(&["0", "1", "0.3", "2.5"]).to_owned())),
    ("solref", Drawn(0.15, Dice::solref)),
    ("solimp", Drawn(0.15, Dice::solimp)),
    ("margin", Drawn(0.2, |d| d.log(0.001, 0.1))),
    ("gap", Drawn(0.1, |d| d.log(0.001, 0.05))),
    ("mass", Drawn(0.12, |d| d.log(0.01, 5.0))),
    ("density", Drawn(0.12, |d| d.log(100.0, 5000.0))),
    ("group", Drawn(0.15, |d| d.rng.usize(0..=5).to_string())),
    ("fluidshape", Word(0.15)),
    (
        "fluidcoef",
        Drawn(0.1, |d| {
            let n = d.rng.usize(1..=5);
            d.reals(n, 1.5)
        }),
    ),
    ("mesh", Placed(&["boulder"])),
    ("hfield", Placed(&[])),
    ("fitscale", Drawn(0.2, |d| d.log(0.5, 2.0))),
];

const HFIELD: &[Rule] = &[
    ("name", Nothing),
    ("file", Nothing),
    ("content_type", Nothing),
    ("nrow", Placed(&[])),
    ("ncol", Placed(&[])),
    ("size", Placed(&["0.2 0.1 0.1 0.03"])),
    ("elevation", Placed(&["5 4 3 2 1 0 3 3 3 1 2 1"])),
];

const MESH: &[Rule] = &[
    ("name", Nothing),
    ("file", Nothing),
    ("content_type", Nothing),
    ("vertex", Placed(&[])),
    ("normal", Nothing),
    ("texcoord", Nothing),
    // the triangles of the hull stand for those that are not given; their order, and with it the last digits of sums in single
    // precision, is not MuJoCo's
    ("face", Placed(&[])),
    ("refpos", Drawn(0.3, |d| d.reals(3, 0.1))),
    ("refquat", Drawn(0.3, Dice::quat)),
    (
        "scale",
        Drawn(0.3, |d| [d.log(0.5, 2.0), d.log(0.5, 2.0), d.log(0.5, 2.0)].join(" ")),
    ),
    ("smoothnormal", Nothing),
    ("maxhullvert", Nothing),
    (
        "inertia",
        Drawn(0.4, |d| d.pick(&["legacy", "exact", "shell"]).to_owned()),
    ),
];

const SITE: &[Rule] = &[
    ("name", Placed(&[])),
    ("type", Nothing),
    ("group", Nothing),
    ("size", Nothing),
    ("fromto", Placed(&[])),
];

const INERTIAL: &[Rule] = &[
    ("mass", Drawn(1.0, |d| d.log(0.05, 5.0))),
    ("fullinertia", Drawn(0.5, Dice::full_inertia)),
    ("diaginertia", Drawn(0.5, Dice::diagonal_inertia)),
];

const PAIR: &[Rule] = &[
    ("name", Nothing),
    ("geom1", Placed(&["ball"])),
    ("geom2", Placed(&["ball"])),
    ("condim", Drawn(0.5, |d| d.pick(&["1", "3", "4", "6"]).to_owned())),
    ("friction", Drawn(0.5, |d| d.friction(2))),
    ("solref", Drawn(0.3, Dice::solref)),
    ("solreffriction", Drawn(0.3, Dice::solref)),
    ("solimp", Drawn(0.3, Dice::solimp)),
    ("margin", Drawn(0.4, |d| d.log(0.001, 0.2))),
    ("gap", Drawn(0.2, |d| d.log(0.001, 0.05))),
];

const EXCLUDE: &[Rule] = &[
    ("name", Nothing),
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
];

const EQUALITY: &[Rule] = &[
    ("name", Nothing),
    ("active", Word(0.15)),
    ("solref", Drawn(0.3, Dice::solref)),
    ("solimp", Drawn(0.3, Dice::solimp)),
];

const JOINT_EQUALITY: &[Rule] = &[
    ("joint1", Placed(&["slider", "upper"])),
    ("joint2", Placed(&["slider", "lower"])),
    (
        "polycoef",
        Drawn(0.7, |d| {
            let n = d.rng.usize(1..=5);
            d.reals(n, 1.0)
        }),
    ),
];

const TENDON_EQUALITY: &[Rule] = &[
    ("tendon1", Placed(&["third"])),
    ("tendon2", Placed(&["third"])),
    (
        "polycoef",
        Drawn(0.7, |d| {
            let n = d.rng.usize(1..=5);
            d.reals(n, 1.0)
        }),
    ),
];

const CONNECT: &[Rule] = &[
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
    ("anchor", Drawn(1.0, |d| d.reals(3, 0.2))),
];

const WELD: &[Rule] = &[
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
    ("relpose", Drawn(0.3, |d| format!("{} {}", d.reals(3, 0.3), d.quat()))),
    ("anchor", Drawn(0.3, |d| d.reals(3, 0.2))),
    ("torquescale", Drawn(0.3, |d| d.log(0.05, 5.0))),
];

const TENDON: &[Rule] = &[
    ("name", Placed(&[])),
    ("limited", Placed(&[])),
    ("range", Drawn(0.5, |d| d.range(0.5))),
    ("margin", Drawn(0.3, |d| d.log(0.001, 0.3))),
    ("solreflimit", Drawn(0.3, Dice::solref)),
    ("solimplimit", Drawn(0.3, Dice::solimp)),
    (
        "springlength",
        Drawn(0.3, |d| {
            let mut ends = [d.uniform(0.0, 0.3), d.uniform(0.0, 0.3)];
            ends.sort_by(f64::total_cmp);
            let n = d.rng.usize(1..=2);
            numbers(&ends[..n])
        }),
    ),
    ("frictionloss", Drawn(0.3, |d| d.log(0.001, 5.0))),
    ("solreffriction", Drawn(0.15, Dice::solref)),
    ("solimpfriction", Drawn(0.15, Dice::solimp)),
    ("stiffness", Drawn(0.5, |d| d.log(0.1, 50.0))),
    ("damping", Drawn(0.4, |d| d.log(0.01, 5.0))),
    ("user", Nothing),
    ("group", Nothing),
];

const SPATIAL: &[Rule] = &[("width", Nothing), ("rgba", Nothing), ("material", Nothing)];

const WRAP: &[Rule] = &[
    ("joint", Placed(&["slider", "lower"])),
    ("coef", Drawn(1.0, |d| d.reals(1, 2.0))),
];
const WRAP_SITE: &[Rule] = &[("site", Placed(&["tip"]))];
const WRAP_GEOM: &[Rule] = &[
    ("geom", Placed(&["hand", "ball"])),
    ("sidesite", Placed(&["skin", "corner", "inner"])),
];
const PULLEY: &[Rule] = &[("divisor", Drawn(1.0, |d| d.log(0.3, 4.0)))];

const ACTUATOR: &[Rule] = &[
    ("name", Placed(&[])),
    ("forcelimited", Placed(&[])),
    ("ctrlrange", Drawn(0.5, |d| d.range(1.0))),
    ("forcerange", Drawn(0.4, |d| d.range(2.0))),
    ("user", Nothing),
    ("group", Nothing),
];

const TARGET: &[Rule] = &[
    ("joint", Placed(&["slider", "lower", "swing", "ball"])),
    ("jointinparent", Placed(&["slider", "lower", "swing", "ball"])),
    ("tendon", Placed(&["pull", "loose", "string"])),
    ("cranksite", Placed(&[])),
    ("slidersite", Placed(&[])),
    ("cranklength", Placed(&[])),
    (
        "gear",
        Drawn(0.5, |d| {
            let n = d.pick(&[1, 1, 1, 3, 6]);
            d.reals(n, 5.0)
        }),
    ),
    ("lengthrange", Drawn(0.1, |d| d.range(1.0))),
];
/// Those of an actuator on sites, whose documents are those of the element `general`.
const AT_SITE: &[Rule] = &[("site", Placed(&["tip"])), ("refsite", Placed(&[]))];
const ON_BODY: &[Rule] = &[("body", Placed(&["hand", "ball"]))];
const ADHESION: &[Rule] = &[
    ("gain", Drawn(0.8, |d| d.log(0.5, 50.0))),
    (
        "ctrlrange",
        Drawn(1.0, |d| format!("{} {}", d.log(0.01, 0.3), d.log(0.5, 2.0))),
    ),
];
/// Targets of which the motors of the document of [`super::single`] have one each.
const SLIDER_CRANK: &[Rule] = &[
    ("cranksite", Placed(&["tip"])),
    ("slidersite", Placed(&["skin", "ground"])),
    ("cranklength", Placed(&["0.3", "2"])),
    ("refsite", Placed(&["tip", "inner"])),
];

const CONTROL: &[Rule] = &[("ctrllimited", Placed(&[]))];

const ACTIVATION: &[Rule] = &[("actrange", Drawn(0.3, |d| d.range(1.0)))];

const LAW: &[Rule] = &[
    ("dyntype", Word(0.6)),
    ("gaintype", Word(0.5)),
    ("biastype", Word(0.5)),
    (
        "dynprm",
        Drawn(0.5, |d| {
            if d.chance(0.05) {
                "0".to_owned()
            } else {
                format!("{} {}", d.log(0.001, 1.0), d.reals(2, 1.0))
            }
        }),
    ),
    ("gainprm", Drawn(0.6, |d| parameters(d, 5.0))),
    ("biasprm", Drawn(0.5, |d| parameters(d, 5.0))),
    ("actlimited", Placed(&[])),
    ("actearly", Word(0.3)),
    ("actdim", Placed(&["1", "2"])),
];

const SERVO: &[Rule] = &[
    ("kp", Drawn(0.7, |d| d.log(0.1, 100.0))),
    ("kv", Drawn(0.5, |d| d.log(0.01, 5.0))),
    ("dampratio", Drawn(0.2, |d| d.log(0.1, 2.0))),
    ("inheritrange", Drawn(0.08, |d| d.log(0.3, 1.5))),
];

const FILTER: &[Rule] = &[("timeconst", Drawn(0.3, timeconst))];

const SPEED: &[Rule] = &[("kv", Drawn(0.8, |d| d.log(0.01, 5.0)))];

const CYLINDER: &[Rule] = &[
    ("timeconst", Drawn(0.6, timeconst)),
    ("area", Drawn(0.5, |d| d.log(0.1, 5.0))),
    ("diameter", Drawn(0.3, |d| d.log(0.1, 3.0))),
    ("bias", Drawn(0.4, |d| d.reals(3, 2.0))),
];

const MUSCLE: &[Rule] = &[
    (
        "timeconst",
        Drawn(0.4, |d| format!("{} {}", d.log(0.001, 0.3), d.log(0.001, 0.3))),
    ),
    ("tausmooth", Drawn(0.3, |d| d.log(0.01, 2.0))),
    (
        "range",
        Drawn(0.4, |d| format!("{} {}", d.log(0.3, 0.9), d.log(0.95, 1.5))),
    ),
    ("force", Drawn(0.4, |d| d.log(0.1, 20.0))),
    ("scale", Drawn(0.3, |d| d.log(1.0, 300.0))),
    ("lmin", Drawn(0.3, |d| d.log(0.2, 0.9))),
    ("lmax", Drawn(0.3, |d| d.log(1.1, 2.0))),
    ("vmax", Drawn(0.3, |d| d.log(0.3, 5.0))),
    ("fpmax", Drawn(0.3, |d| d.log(0.3, 3.0))),
    ("fvmax", Drawn(0.3, |d| d.log(0.9, 2.0))),
];

/// Settings of the simulations that find the lengths of muscles. MuJoCo hangs in simulations that diverge, so muscles of random documents
/// have lengths, and these are taken.
const LENGTH_RANGE: &[Rule] = &[
    (
        "mode",
        Drawn(0.5, |d| d.pick(&["none", "muscle", "muscleuser"]).to_owned()),
    ),
    ("useexisting", Drawn(0.3, |_| "true".to_owned())),
    ("uselimit", Word(0.3)),
    ("accel", Drawn(0.3, |d| d.log(1.0, 50.0))),
    ("maxforce", Drawn(0.3, |d| d.log(0.001, 0.01))),
    ("timeconst", Drawn(0.3, |d| d.log(0.1, 3.0))),
    ("timestep", Drawn(0.3, |d| d.pick(&["0", "0.004", "0.02"]).to_owned())),
    ("inttotal", Drawn(0.3, |d| d.pick(&["0.3", "3"]).to_owned())),
    ("interval", Drawn(0.3, |d| d.pick(&["1", "20"]).to_owned())),
    ("tolrange", Drawn(0.3, |d| d.pick(&["-1", "0.1"]).to_owned())),
];

/// Writes one to ten parameters of an actuator, of which three have a meaning.
fn parameters(d: &mut Dice, size: f64) -> String {
    let n = d.pick(&[1, 2, 3, 3, 3, 10]);
    d.reals(n, size)
}

/// Writes the time constant of a filter, at times none.
fn timeconst(d: &mut Dice) -> String {
    if d.chance(0.1) {
        "0".to_owned()
    } else {
        d.log(0.001, 1.0)
    }
}

const SENSOR: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Drawn(0.3, |d| d.log(1e-4, 5.0))),
];
/// Sensors whose values have no cutoff, and the clock, which stands at 0 where it is compared.
const UNIT_SENSOR: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Nothing),
];
const ON_SITE: &[Rule] = &[("site", Placed(&["tip"]))];
const OF_JOINT: &[Rule] = &[("joint", Placed(&["slider"]))];
const OF_BALL: &[Rule] = &[("joint", Placed(&["swing"]))];
const OF_LIMIT: &[Rule] = &[("joint", Placed(&["lower"]))];
const OF_TENDON: &[Rule] = &[("tendon", Placed(&["pull", "string"]))];
const OF_ACTUATOR: &[Rule] = &[("actuator", Placed(&["hold"]))];
const OF_SUBTREE: &[Rule] = &[("body", Placed(&["hand"]))];
const OF_FRAME: &[Rule] = &[("objtype", Placed(&["xbody"])), ("objname", Placed(&["hand"]))];
const IN_FRAME: &[Rule] = &[("reftype", Placed(&["xbody"])), ("refname", Placed(&["child"]))];

const IN_PICTURE: &[Rule] = &[("site", Placed(&["tip"])), ("camera", Placed(&["still"]))];
const BETWEEN: &[Rule] = &[
    ("geom1", Placed(&["ball"])),
    ("body1", Placed(&["mid"])),
    ("geom2", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
];
const REACH: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Drawn(0.9, |d| d.log(0.05, 5.0))),
];
const OF_USER: &[Rule] = &[
    ("dim", Placed(&["1", "4"])),
    ("needstage", Nothing),
    ("datatype", Nothing),
    ("objtype", Nothing),
    ("objname", Nothing),
];

/// Elements none of whose attributes changes physics.
pub const WITHOUT_PHYSICS: &[&str] = &[
    "mujoco",
    "size",
    "visual",
    "asset/texture",
    "asset/material",
    "asset/skin",
    "asset/skin/bone",
    "deformable",
    "custom",
    "keyframe",
    "worldbody/body/camera",
    "worldbody/body/light",
];

/// The attributes of each element that changes physics, by its path.
pub const RULES: &[(&str, &[&[Rule]])] = &[
    ("compiler", &[COMPILER]),
    ("compiler/lengthrange", &[LENGTH_RANGE]),
    ("option", &[OPTION]),
    ("option/flag", &[FLAG]),
    ("statistic", &[STATISTIC]),
    ("default", &[&[("class", Nothing)]]),
    ("asset", &[]),
    ("asset/mesh", &[CLASS, MESH]),
    ("asset/hfield", &[HFIELD]),
    ("worldbody", &[]),
    (
        "worldbody/body",
        &[
            &[
                ("name", Placed(&["named"])),
                ("childclass", Placed(&["stiff"])),
                ("user", Nothing),
                ("mocap", Placed(&[])),
                ("gravcomp", Drawn(0.05, |d| d.log(0.1, 2.0))),
            ],
            FRAME,
        ],
    ),
    (
        "worldbody/body/frame",
        &[&[("name", Nothing), ("childclass", Placed(&["stiff"]))], FRAME],
    ),
    (
        "worldbody/body/frame/replicate",
        &[&[
            ("count", Drawn(1.0, |d| d.rng.usize(1..4).to_string())),
            ("sep", Drawn(0.3, |_| "_".to_owned())),
            ("offset", Drawn(0.8, |d| d.reals(3, 0.4))),
            (
                "euler",
                Drawn(0.5, |d| {
                    [d.coordinate(3.0), d.coordinate(3.0), d.coordinate(3.0)].join(" ")
                }),
            ),
            ("childclass", Placed(&["stiff"])),
        ]],
    ),
    ("worldbody/body/inertial", &[INERTIAL, FRAME]),
    ("worldbody/body/joint", &[CLASS, JOINT]),
    (
        "worldbody/body/freejoint",
        &[&[("name", Placed(&[])), ("group", Nothing), ("align", Nothing)]],
    ),
    ("worldbody/body/geom", &[CLASS, GEOM, FRAME, LOOKS]),
    ("worldbody/body/site", &[CLASS, SITE, FRAME, LOOKS]),
    ("contact", &[]),
    ("contact/pair", &[CLASS, PAIR]),
    ("contact/exclude", &[EXCLUDE]),
    ("equality", &[]),
    ("equality/joint", &[CLASS, JOINT_EQUALITY, EQUALITY]),
    ("equality/tendon", &[CLASS, TENDON_EQUALITY, EQUALITY]),
    ("equality/connect", &[CLASS, CONNECT, EQUALITY]),
    ("equality/weld", &[CLASS, WELD, EQUALITY]),
    ("tendon", &[]),
    ("tendon/fixed", &[CLASS, TENDON]),
    ("tendon/fixed/joint", &[WRAP]),
    ("tendon/spatial", &[CLASS, TENDON, SPATIAL]),
    ("tendon/spatial/site", &[WRAP_SITE]),
    ("tendon/spatial/geom", &[WRAP_GEOM]),
    ("tendon/spatial/pulley", &[PULLEY]),
    ("actuator", &[]),
    (
        "actuator/general",
        &[CLASS, ACTUATOR, TARGET, AT_SITE, ON_BODY, CONTROL, ACTIVATION, LAW],
    ),
    (
        "actuator/motor",
        &[CLASS, SLIDER_CRANK, ACTUATOR, TARGET, AT_SITE, CONTROL],
    ),
    (
        "actuator/position",
        &[CLASS, ACTUATOR, TARGET, AT_SITE, CONTROL, SERVO, FILTER],
    ),
    ("actuator/velocity", &[CLASS, ACTUATOR, TARGET, AT_SITE, CONTROL, SPEED]),
    (
        "actuator/intvelocity",
        &[CLASS, ACTUATOR, TARGET, AT_SITE, CONTROL, ACTIVATION, SERVO],
    ),
    ("actuator/damper", &[CLASS, ACTUATOR, TARGET, AT_SITE, SPEED]),
    (
        "actuator/cylinder",
        &[CLASS, ACTUATOR, TARGET, AT_SITE, CONTROL, CYLINDER],
    ),
    ("actuator/muscle", &[CLASS, ACTUATOR, TARGET, CONTROL, MUSCLE]),
    ("actuator/adhesion", &[CLASS, ADHESION, ACTUATOR, ON_BODY]),
    ("sensor", &[]),
    ("sensor/touch", &[ON_SITE, SENSOR]),
    ("sensor/accelerometer", &[ON_SITE, SENSOR]),
    ("sensor/velocimeter", &[ON_SITE, SENSOR]),
    ("sensor/gyro", &[ON_SITE, SENSOR]),
    ("sensor/force", &[ON_SITE, SENSOR]),
    ("sensor/torque", &[ON_SITE, SENSOR]),
    ("sensor/magnetometer", &[ON_SITE, SENSOR]),
    ("sensor/rangefinder", &[ON_SITE, SENSOR]),
    ("sensor/jointpos", &[OF_JOINT, SENSOR]),
    ("sensor/jointvel", &[OF_JOINT, SENSOR]),
    ("sensor/jointactuatorfrc", &[OF_JOINT, SENSOR]),
    ("sensor/ballquat", &[OF_BALL, UNIT_SENSOR]),
    ("sensor/ballangvel", &[OF_BALL, SENSOR]),
    ("sensor/jointlimitpos", &[OF_LIMIT, SENSOR]),
    ("sensor/jointlimitvel", &[OF_LIMIT, SENSOR]),
    ("sensor/jointlimitfrc", &[OF_LIMIT, SENSOR]),
    ("sensor/tendonpos", &[OF_TENDON, SENSOR]),
    ("sensor/tendonvel", &[OF_TENDON, SENSOR]),
    ("sensor/tendonlimitpos", &[OF_TENDON, SENSOR]),
    ("sensor/tendonlimitvel", &[OF_TENDON, SENSOR]),
    ("sensor/tendonlimitfrc", &[OF_TENDON, SENSOR]),
    ("sensor/actuatorpos", &[OF_ACTUATOR, SENSOR]),
    ("sensor/actuatorvel", &[OF_ACTUATOR, SENSOR]),
    ("sensor/actuatorfrc", &[OF_ACTUATOR, SENSOR]),
    ("sensor/framepos", &[OF_FRAME, IN_FRAME, SENSOR]),
    ("sensor/framelinvel", &[OF_FRAME, IN_FRAME, SENSOR]),
    ("sensor/frameangvel", &[OF_FRAME, IN_FRAME, SENSOR]),
    ("sensor/framequat", &[OF_FRAME, IN_FRAME, UNIT_SENSOR]),
    ("sensor/framexaxis", &[OF_FRAME, IN_FRAME, UNIT_SENSOR]),
    ("sensor/frameyaxis", &[OF_FRAME, IN_FRAME, UNIT_SENSOR]),
    ("sensor/framezaxis", &[OF_FRAME, IN_FRAME, UNIT_SENSOR]),
    ("sensor/framelinacc", &[OF_FRAME, SENSOR]),
    ("sensor/frameangacc", &[OF_FRAME, SENSOR]),
    ("sensor/subtreecom", &[OF_SUBTREE, SENSOR]),
    ("sensor/subtreelinvel", &[OF_SUBTREE, SENSOR]),
    ("sensor/subtreeangmom", &[OF_SUBTREE, SENSOR]),
    ("sensor/camprojection", &[IN_PICTURE, SENSOR]),
    ("sensor/distance", &[BETWEEN, REACH]),
    ("sensor/normal", &[BETWEEN, REACH]),
    ("sensor/fromto", &[BETWEEN, REACH]),
    ("sensor/e_potential", &[SENSOR]),
    ("sensor/e_kinetic", &[SENSOR]),
    ("sensor/clock", &[UNIT_SENSOR]),
    ("sensor/user", &[OF_USER, UNIT_SENSOR]),
];

/// Tells whether an element, or the section that it stands in, is said to change no physics.
pub fn is_without_physics(path: &str) -> bool {
    let section = path.split('/').next().unwrap_or(path);
    WITHOUT_PHYSICS.contains(&path) || WITHOUT_PHYSICS.contains(&section)
}

/// Returns how an attribute gets its values; `None` where no line says so.
pub fn how(path: &str, attribute: &str) -> Option<How> {
    let (_, groups) = RULES.iter().find(|(other, _)| *other == path)?;
    let mut rules = groups.iter().flat_map(|group| group.iter());
    rules.find(|(name, _)| *name == attribute).map(|(_, how)| *how)
}
