//! Rules for drawing the values of attributes, with a line for each attribute of the loader's tables. A test fails if one is missing, or
//! if one changes physics and is never drawn.

mod actuators;
mod bodies;
mod relations;
mod sensors;
mod whole;

use super::dice::Dice;
use actuators::*;
use bodies::*;
use relations::*;
use sensors::*;
use whole::*;

/// The source of an attribute's values.
#[derive(Clone, Copy)]
pub enum How {
    /// It does not change the physics: names, colours, sizes of drawn elements.
    Nothing,
    /// Values that depend on the element's place in the document, such as references. These values fit the document of [`super::single`]; if there
    /// are none, every word of the attribute fits.
    Placed(&'static [&'static str]),
    /// Any of its words, with a probability.
    Word(f64),
    /// Drawn, with a probability.
    Drawn(f64, fn(&mut Dice) -> String),
}

use How::{Drawn, Nothing, Placed, Word};

/// The source of one attribute's values.
pub type Rule = (&'static str, How);

/// Attributes that exclude each other.
pub const RIVALS: [&[&str]; 11] = [
    &["quat", "axisangle", "xyaxes", "zaxis", "euler", "fromto"],
    &["pos", "fromto"],
    &["diaginertia", "fullinertia"],
    &["joint", "jointinparent", "tendon", "site", "cranksite", "body"],
    &["kv", "dampratio"],
    &["ctrlrange", "inheritrange"],
    &["actrange", "inheritrange"],
    &["geom1", "body1"],
    &["geom2", "body2"],
    &["site1", "anchor"],
    &["site1", "relpose"],
];

/// Elements none of whose attributes changes physics.
pub const WITHOUT_PHYSICS: &[&str] = &[
    "mujoco",
    "size",
    "visual",
    "asset/texture",
    "asset/material",
    "asset/material/layer",
    "asset/skin",
    "asset/skin/bone",
    "deformable",
    "custom",
    "keyframe",
    "extension",
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
        &[&[("name", Placed(&[])), ("group", Nothing), ("align", Word(0.3))]],
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

/// Elements that are compared in `conformance/data/composed`, or, flexes, in `conformance/tests/conformance/flexes.rs`: they need other documents,
/// or represent whole bodies.
fn is_composed(path: &str) -> bool {
    let whole = ["attach", "composite", "flex", "flexcomp"];
    path == "asset/model" || path.split('/').any(|name| whole.contains(&name))
}

/// Returns whether an element, or its section, is marked as changing no physics, or is compared elsewhere.
pub fn is_without_physics(path: &str) -> bool {
    if is_composed(path) {
        return true;
    }
    let section = path.split('/').next().unwrap_or(path);
    WITHOUT_PHYSICS.contains(&path) || WITHOUT_PHYSICS.contains(&section)
}

/// Returns how an attribute gets its values; `None` where no line says so.
pub fn how(path: &str, attribute: &str) -> Option<How> {
    let (_, groups) = RULES.iter().find(|(other, _)| *other == path)?;
    let mut rules = groups.iter().flat_map(|group| group.iter());
    rules.find(|(name, _)| *name == attribute).map(|(_, how)| *how)
}
