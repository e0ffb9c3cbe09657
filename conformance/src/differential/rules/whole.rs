//! Values of the settings of a whole document.

use super::How::{Drawn, Nothing, Placed, Word};
use super::Rule;

pub(super) const COMPILER: &[Rule] = &[
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
    // without effect beside actuators, sensors and the like, which these documents have; fused_bodies.rs has others
    ("fusestatic", Nothing),
    ("discardvisual", Word(0.08)),
    ("alignfree", Word(0.2)),
    ("coordinate", Nothing),
];

pub(super) const OPTION: &[Rule] = &[
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
    (
        "actuatorgroupdisable",
        Drawn(0.1, |d| d.pick(&["0", "1", "2 30", "1 2 1"]).to_owned()),
    ),
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

pub(super) const FLAG: &[Rule] = &[
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
    ("nativeccd", Word(0.1)),
    ("override", Nothing),
    ("multiccd", Word(0.05)),
    ("island", Word(0.05)),
];

pub(super) const STATISTIC: &[Rule] = &[
    ("meaninertia", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("meanmass", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("meansize", Drawn(0.3, |d| d.log(0.1, 1.0))),
    ("extent", Drawn(0.3, |d| d.log(0.1, 10.0))),
    ("center", Drawn(0.3, |d| d.reals(3, 1.0))),
];

/// Settings of the simulations that find the lengths of muscles. MuJoCo hangs in simulations that diverge, so muscles of random documents
/// have lengths, and these are taken.
pub(super) const LENGTH_RANGE: &[Rule] = &[
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
