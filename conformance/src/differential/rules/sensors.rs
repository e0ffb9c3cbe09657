//! Values of sensors.

use super::How::{Drawn, Nothing, Placed};
use super::Rule;

pub(super) const SENSOR: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Drawn(0.3, |d| d.log(1e-4, 5.0))),
];
/// Sensors whose values have no cutoff, and the clock, which is 0 when compared.
pub(super) const UNIT_SENSOR: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Nothing),
];
pub(super) const ON_SITE: &[Rule] = &[("site", Placed(&["tip"]))];
pub(super) const OF_JOINT: &[Rule] = &[("joint", Placed(&["slider"]))];
pub(super) const OF_BALL: &[Rule] = &[("joint", Placed(&["swing"]))];
pub(super) const OF_LIMIT: &[Rule] = &[("joint", Placed(&["lower"]))];
pub(super) const OF_TENDON: &[Rule] = &[("tendon", Placed(&["pull", "string"]))];
pub(super) const OF_ACTUATOR: &[Rule] = &[("actuator", Placed(&["hold"]))];
pub(super) const OF_SUBTREE: &[Rule] = &[("body", Placed(&["hand"]))];
pub(super) const OF_FRAME: &[Rule] = &[("objtype", Placed(&["xbody"])), ("objname", Placed(&["hand"]))];
pub(super) const IN_FRAME: &[Rule] = &[("reftype", Placed(&["xbody"])), ("refname", Placed(&["child"]))];

pub(super) const IN_PICTURE: &[Rule] = &[("site", Placed(&["tip"])), ("camera", Placed(&["still"]))];
pub(super) const BETWEEN: &[Rule] = &[
    ("geom1", Placed(&["ball"])),
    ("body1", Placed(&["mid"])),
    ("geom2", Placed(&["ball"])),
    ("body2", Placed(&["ball"])),
];
pub(super) const REACH: &[Rule] = &[
    ("name", Nothing),
    ("user", Nothing),
    ("noise", Nothing),
    ("cutoff", Drawn(0.9, |d| d.log(0.05, 5.0))),
];
pub(super) const OF_USER: &[Rule] = &[
    ("dim", Placed(&["1", "4"])),
    ("needstage", Nothing),
    ("datatype", Nothing),
    ("objtype", Nothing),
    ("objname", Nothing),
];
