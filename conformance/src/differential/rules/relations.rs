//! Values of elements that refer to bodies, joints, geoms and sites.

use super::super::dice::{Dice, numbers};
use super::How::{Drawn, Nothing, Placed, Word};
use super::Rule;

pub(super) const PAIR: &[Rule] = &[
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

pub(super) const EXCLUDE: &[Rule] = &[
    ("name", Nothing),
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
];

pub(super) const EQUALITY: &[Rule] = &[
    ("name", Nothing),
    ("active", Word(0.15)),
    ("solref", Drawn(0.3, Dice::solref)),
    ("solimp", Drawn(0.3, Dice::solimp)),
];

pub(super) const JOINT_EQUALITY: &[Rule] = &[
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

pub(super) const TENDON_EQUALITY: &[Rule] = &[
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

pub(super) const CONNECT: &[Rule] = &[
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
    ("anchor", Drawn(1.0, |d| d.reals(3, 0.2))),
    ("site1", Placed(&["wrist"])),
    ("site2", Placed(&["ground"])),
];

pub(super) const WELD: &[Rule] = &[
    ("body1", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
    ("relpose", Drawn(0.3, |d| format!("{} {}", d.reals(3, 0.3), d.quat()))),
    ("anchor", Drawn(0.3, |d| d.reals(3, 0.2))),
    ("torquescale", Drawn(0.3, |d| d.log(0.05, 5.0))),
    ("site1", Placed(&["wrist"])),
    ("site2", Placed(&["ground"])),
];

pub(super) const TENDON: &[Rule] = &[
    ("name", Placed(&[])),
    ("limited", Placed(&[])),
    ("range", Drawn(0.5, |d| d.bounds(0.5))),
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

pub(super) const SPATIAL: &[Rule] = &[("width", Nothing), ("rgba", Nothing), ("material", Nothing)];

pub(super) const WRAP: &[Rule] = &[
    ("joint", Placed(&["slider", "lower"])),
    ("coef", Drawn(1.0, |d| d.reals(1, 2.0))),
];
pub(super) const WRAP_SITE: &[Rule] = &[("site", Placed(&["tip"]))];
pub(super) const WRAP_GEOM: &[Rule] = &[
    ("geom", Placed(&["hand", "ball"])),
    ("sidesite", Placed(&["skin", "corner", "inner"])),
];
pub(super) const PULLEY: &[Rule] = &[("divisor", Drawn(1.0, |d| d.log(0.3, 4.0)))];
