//! Values of actuators.

use super::super::dice::Dice;
use super::How::{Drawn, Nothing, Placed, Word};
use super::Rule;

pub(super) const ACTUATOR: &[Rule] = &[
    ("name", Placed(&[])),
    ("forcelimited", Placed(&[])),
    ("ctrlrange", Drawn(0.5, |d| d.bounds(1.0))),
    ("forcerange", Drawn(0.4, |d| d.bounds(2.0))),
    ("user", Nothing),
    (
        "group",
        Drawn(0.15, |d| d.pick(&["1", "2", "30", "31", "-1"]).to_owned()),
    ),
];

pub(super) const TARGET: &[Rule] = &[
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
pub(super) const AT_SITE: &[Rule] = &[("site", Placed(&["tip"])), ("refsite", Placed(&[]))];
pub(super) const ON_BODY: &[Rule] = &[("body", Placed(&["hand", "ball"]))];
pub(super) const ADHESION: &[Rule] = &[
    ("gain", Drawn(0.8, |d| d.log(0.5, 50.0))),
    (
        "ctrlrange",
        Drawn(1.0, |d| format!("{} {}", d.log(0.01, 0.3), d.log(0.5, 2.0))),
    ),
];
/// Targets, one for each of the motors of the document of [`super::single`].
pub(super) const SLIDER_CRANK: &[Rule] = &[
    ("cranksite", Placed(&["tip"])),
    ("slidersite", Placed(&["skin", "ground"])),
    ("cranklength", Placed(&["0.3", "2"])),
    ("refsite", Placed(&["tip", "inner"])),
];

pub(super) const CONTROL: &[Rule] = &[("ctrllimited", Placed(&[]))];

pub(super) const ACTIVATION: &[Rule] = &[("actrange", Drawn(0.3, |d| d.bounds(1.0)))];

pub(super) const LAW: &[Rule] = &[
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

pub(super) const SERVO: &[Rule] = &[
    ("kp", Drawn(0.7, |d| d.log(0.1, 100.0))),
    ("kv", Drawn(0.5, |d| d.log(0.01, 5.0))),
    ("dampratio", Drawn(0.2, |d| d.log(0.1, 2.0))),
    ("inheritrange", Drawn(0.08, |d| d.log(0.3, 1.5))),
];

pub(super) const FILTER: &[Rule] = &[("timeconst", Drawn(0.3, timeconst))];

pub(super) const SPEED: &[Rule] = &[("kv", Drawn(0.8, |d| d.log(0.01, 5.0)))];

pub(super) const CYLINDER: &[Rule] = &[
    ("timeconst", Drawn(0.6, timeconst)),
    ("area", Drawn(0.5, |d| d.log(0.1, 5.0))),
    ("diameter", Drawn(0.3, |d| d.log(0.1, 3.0))),
    ("bias", Drawn(0.4, |d| d.reals(3, 2.0))),
];

pub(super) const MUSCLE: &[Rule] = &[
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

/// Writes one to ten parameters of an actuator; three have a meaning.
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
