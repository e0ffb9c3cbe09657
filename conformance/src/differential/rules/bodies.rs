//! Values of bodies and what hangs on them, and of shapes.

use super::super::dice::{Dice, numbers};
use super::How::{Drawn, Nothing, Placed, Word};
use super::Rule;

pub(super) const CLASS: &[Rule] = &[("class", Placed(&["stiff"]))];

pub(super) const FRAME: &[Rule] = &[
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

pub(super) const LOOKS: &[Rule] = &[("rgba", Nothing), ("material", Nothing), ("user", Nothing)];

pub(super) const JOINT: &[Rule] = &[
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
    ("actuatorfrcrange", Drawn(0.15, |d| d.bounds(2.0))),
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

pub(super) const GEOM: &[Rule] = &[
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
    ("shellinertia", Word(0.08)),
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

pub(super) const HFIELD: &[Rule] = &[
    ("name", Nothing),
    ("file", Nothing),
    ("content_type", Nothing),
    ("nrow", Placed(&[])),
    ("ncol", Placed(&[])),
    ("size", Placed(&["0.2 0.1 0.1 0.03"])),
    ("elevation", Placed(&["5 4 3 2 1 0 3 3 3 1 2 1"])),
];

pub(super) const MESH: &[Rule] = &[
    ("name", Nothing),
    ("file", Nothing),
    ("content_type", Nothing),
    ("vertex", Placed(&[])),
    ("normal", Nothing),
    ("texcoord", Nothing),
    // without them those of the hull are meant
    ("face", Placed(&[])),
    ("refpos", Drawn(0.3, |d| d.reals(3, 0.1))),
    ("refquat", Drawn(0.3, Dice::quat)),
    (
        "scale",
        Drawn(0.3, |d| [d.log(0.5, 2.0), d.log(0.5, 2.0), d.log(0.5, 2.0)].join(" ")),
    ),
    ("smoothnormal", Nothing),
    ("maxhullvert", Drawn(0.2, |d| d.pick(&["4", "5", "7", "12"]).to_owned())),
    // convex is tried with a geom that touches: MuJoCo 3.3.0 crashes where none does, as there is no hull then
    (
        "inertia",
        Drawn(0.4, |d| d.pick(&["legacy", "exact", "shell"]).to_owned()),
    ),
];

pub(super) const SITE: &[Rule] = &[
    ("name", Placed(&[])),
    ("type", Nothing),
    ("group", Nothing),
    ("size", Nothing),
    ("fromto", Placed(&[])),
];

pub(super) const INERTIAL: &[Rule] = &[
    ("mass", Drawn(1.0, |d| d.log(0.05, 5.0))),
    ("fullinertia", Drawn(0.5, Dice::full_inertia)),
    ("diaginertia", Drawn(0.5, Dice::diagonal_inertia)),
];
