//! The table of reflexes, and all of their constants that are not geometry, with sources.

use super::sources::{Mark, SourcedConstant};
use crate::config::Reflex;

/// A reflex at the ages of infants.
pub(crate) struct ReflexRow {
    reflex: Reflex,
    /// Time from stimulus to response, ms, with its mark and source.
    pub delay: f64,
    delay_mark: Mark,
    delay_source: &'static str,
    /// Age until which it is full, and age from which it is gone, months; `None` if it stays.
    ages: Option<[f64; 2]>,
    ages_source: &'static str,
}

/// The gain of the vestibulo-ocular reflex, eye over head.
const VOR_GAIN: f64 = 1.03;

const TABLES: &str = "tables of infants' reflexes; the straight line between the ages is our choice";
const OURS: &str = "ours";

/// Every reflex, in the order of [`Reflex::ALL`].
const ROWS: [ReflexRow; Reflex::ALL.len()] = [
    row(
        Reflex::PalmarGrasp,
        100.0,
        (Mark::Unsourced, OURS),
        Some([2.0, 5.0]),
        "to 4 to 6 months (Futagi 2012, doi:10.1155/2012/191562)",
    ),
    row(
        Reflex::PlantarGrasp,
        100.0,
        (Mark::Unsourced, OURS),
        Some([6.0, 10.0]),
        TABLES,
    ),
    row(
        Reflex::Rooting,
        300.0,
        (Mark::Unsourced, OURS),
        Some([2.0, 4.0]),
        TABLES,
    ),
    row(
        Reflex::Moro,
        120.0,
        (
            Mark::Seen,
            "117 and 129 ms (Ronnqvist 1995), with the 60 ms to notice the drop",
        ),
        Some([3.0, 5.0]),
        TABLES,
    ),
    row(
        Reflex::Atnr,
        200.0,
        (Mark::Unsourced, OURS),
        Some([2.0, 5.0]),
        "12 infants (Coryell 1979, doi:10.1093/ptj/59.6.747), to 4 to 7 months",
    ),
    row(
        Reflex::Stepping,
        100.0,
        (Mark::Unsourced, OURS),
        Some([1.5, 2.5]),
        TABLES,
    ),
    row(Reflex::Vor, 10.0, (Mark::Unsourced, OURS), None, OURS),
    row(
        Reflex::Stretch,
        17.0,
        (Mark::Seen, "H-reflex of the triceps at term (Hakamada 1988)"),
        None,
        OURS,
    ),
];

const fn row(
    reflex: Reflex,
    delay: f64,
    (delay_mark, delay_source): (Mark, &'static str),
    ages: Option<[f64; 2]>,
    ages_source: &'static str,
) -> ReflexRow {
    ReflexRow {
        reflex,
        delay,
        delay_mark,
        delay_source,
        ages,
        ages_source,
    }
}

/// Returns the row of a reflex.
pub(crate) fn of(reflex: Reflex) -> &'static ReflexRow {
    &ROWS[reflex as usize]
}

/// Returns the gain of a reflex at an age, months. Without an age, reflexes that infants lose have their full gain.
pub(crate) fn gain(reflex: Reflex, age: Option<f64>) -> f64 {
    let full = if reflex == Reflex::Vor { VOR_GAIN } else { 1.0 };
    match (of(reflex).ages, age) {
        (Some([last, gone]), Some(age)) => full * ((gone - age) / (gone - last)).clamp(0.0, 1.0),
        _ => full,
    }
}

/// Returns a value that is linear between ages, months; without an age, the last one.
pub(crate) fn at_age<const N: usize>(ages: &[f64; N], values: &[f64; N], age: Option<f64>) -> f64 {
    let Some(age) = age else { return values[N - 1] };
    let after = ages.iter().position(|&at| at > age).unwrap_or(N);
    if after == 0 || after == N {
        return values[after.min(N - 1)];
    }
    let share = (age - ages[after - 1]) / (ages[after] - ages[after - 1]);
    values[after - 1] + share * (values[after] - values[after - 1])
}

/// Time constant of the canals, s, at ages in months.
pub(crate) const CANAL_AGES: [f64; 2] = [0.0, 2.0];
pub(crate) const CANAL_TIMES: [f64; 2] = [0.9, 2.0];

/// Velocity of a joint at which the stretch reflex begins, and the further velocity at which it is full, rad/s.
pub(crate) const STRETCH: [f64; 2] = [0.2, 2.0];
/// Share of a motor's strength in the full stretch reflex, at ages in months.
pub(crate) const STRETCH_AGES: [f64; 2] = [0.0, 12.0];
pub(crate) const STRETCH_SHARES: [f64; 2] = [0.1, 0.04];

/// Angle of the neck at which the tonic neck reflex begins, and the further angle at which it is full, rad: 30 and 40 degrees.
pub(crate) const ATNR: [f64; 2] = [0.523_598_775_598_298_8, 0.698_131_700_797_731_8];
/// Gains of its arms, at ages in months; that of the legs is 1.
pub(crate) const ATNR_ARM_AGES: [f64; 2] = [0.0, 1.4];
pub(crate) const ATNR_ARM_GAINS: [f64; 2] = [0.7, 1.0];
/// Share of a motor's strength in the full tonic neck reflex.
pub(crate) const ATNR_EFFORT: f64 = 0.2;
/// Its time constants, rising and falling, s.
pub(crate) const ATNR_TIMES: [f64; 2] = [0.3, 0.3];

/// Pressure in the palm at which the grasp begins, and the further pressure at which it is full, N.
pub(crate) const PALMAR: [f64; 2] = [0.05, 0.5];
/// Pressure behind the toes at which their grasp begins, and the further pressure at which it is full, N.
pub(crate) const PLANTAR: [f64; 2] = [0.1, 1.0];
/// Point on the sole beyond which pressure elicits it, as a fraction of the distance from the ankle to the toes.
pub(crate) const BALL: f64 = 0.5;
/// Share of the range of fingers and toes to which they bend.
pub(crate) const BEND: f64 = 0.8;
/// Time constants of the grasps, rising and falling, s.
pub(crate) const GRASP_TIMES: [f64; 2] = [0.1, 0.5];

/// Force beside the mouth at which rooting begins, and the further force at which it is full, N.
pub(crate) const ROOTING: [f64; 2] = [0.02, 0.2];
/// Largest distance from the mouth at which touches elicit it, in radii of the head.
pub(crate) const BESIDE_MOUTH: f64 = 0.6;
/// Share of the force of MIMo's own hands.
pub(crate) const OWN_TOUCH: f64 = 0.33;
/// Angle to which the head turns, rad: 30 degrees.
pub(crate) const ROOTING_TURN: f64 = 0.523_598_775_598_298_8;
/// Share of the neck's strength.
pub(crate) const ROOTING_EFFORT: f64 = 0.5;
/// Time constants of rooting, rising and falling, s.
pub(crate) const ROOTING_TIMES: [f64; 2] = [0.2, 0.6];

/// Share of the weight on the soles at which stepping begins, and the further share at which it is full.
pub(crate) const STEPPING: [f64; 2] = [0.05, 0.05];
/// Cosine of the greatest tilt of the trunk: 30 degrees.
pub(crate) const UPRIGHT: f64 = 0.866_025_403_784_438_6;
/// Duration of a step of each leg, s.
pub(crate) const STEP_CYCLE: f64 = 1.5;
/// Share of the strength of hips and knees.
pub(crate) const STEPPING_EFFORT: f64 = 0.4;
/// Time constants of stepping, rising and falling, s.
pub(crate) const STEPPING_TIMES: [f64; 2] = [0.2, 1.0];

/// Weight of the head, over that at rest, below which it drops.
pub(crate) const MORO_WEIGHT: f64 = 0.5;
/// Time after which a drop is noticed, ms.
pub(crate) const MORO_NOTICE: f64 = 60.0;
/// Velocity of the head backwards that counts as a drop, rad/s.
pub(crate) const MORO_TILT: f64 = 2.0;
/// Duration of the spread arms, s.
pub(crate) const MORO_SPREAD: f64 = 1.0;
/// Duration of the embrace, s.
pub(crate) const MORO_CLOSE: f64 = 1.4;
/// Pause before the next, s.
pub(crate) const MORO_PAUSE: f64 = 2.0;
/// Share of a motor's strength.
pub(crate) const MORO_EFFORT: f64 = 0.6;
/// Share of drops in which the left arm is later, and its lag, s.
pub(crate) const MORO_LATE: [f64; 2] = [0.82, 0.012];

/// Lists the constants of reflexes.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let mut all = Vec::new();
    for row in &ROWS {
        all.push(constant(
            format!("reflex {}, delay", row.reflex),
            &[row.delay],
            "ms",
            row.delay_source,
            row.delay_mark,
        ));
        if let Some(ages) = row.ages {
            let name = format!("reflex {}, full until, gone from", row.reflex);
            all.push(constant(name, &ages, "months", row.ages_source, Mark::Seen));
        }
    }
    let named =
        |name: &str, values: &[f64], unit, source, mark| constant(format!("reflex {name}"), values, unit, source, mark);
    let (seen, unsourced) = (Mark::Seen, Mark::Unsourced);
    all.extend([
        named("vor, gain", &[VOR_GAIN], "1", "1.03 +- 0.014 in the dark at 1 to 4 months (Finocchio 1991)", seen),
        SourcedConstant {
            ages: CANAL_AGES.to_vec(),
            ..named(
                "vor, time constant of the canals",
                &CANAL_TIMES,
                "s",
                "at birth: eyes lead by 20 degrees at 0.5 Hz (Weissman 1989, doi:10.1212/wnl.39.4.534); at 2 months ours",
                seen,
            )
        },
        named("stretch, begins at, full after", &STRETCH, "rad/s", OURS, unsourced),
        SourcedConstant {
            ages: STRETCH_AGES.to_vec(),
            ..named(
                "stretch, share of the strength",
                &STRETCH_SHARES,
                "1",
                "H-reflex 70 % of M at term, 30 % at 12 months (Hakamada 1988); the size is our choice",
                seen,
            )
        },
        named("atnr, begins at, full after", &ATNR, "rad", "turns of 70 degrees work better than of 30; ours", unsourced),
        SourcedConstant {
            ages: ATNR_ARM_AGES.to_vec(),
            ..named("atnr, gain of the arms", &ATNR_ARM_GAINS, "1", "arms most at 6 weeks (Coryell 1979); at birth ours", seen)
        },
        named("atnr, share of the strength", &[ATNR_EFFORT], "1", OURS, unsourced),
        named("atnr, time constants", &ATNR_TIMES, "s", OURS, unsourced),
        named("moro, weight of a dropping head over that at rest", &[MORO_WEIGHT], "1", OURS, unsourced),
        named("moro, time to notice the drop", &[MORO_NOTICE], "ms", OURS, unsourced),
        named("moro, tilt of a dropping head", &[MORO_TILT], "rad/s", OURS, unsourced),
        named(
            "moro, arms spread, close",
            &[MORO_SPREAD, MORO_CLOSE],
            "s",
            "embrace at 0.91 to 1.04 s, end at 2.34 to 2.59 s (Bijesh 2013)",
            seen,
        ),
        named("moro, pause", &[MORO_PAUSE], "s", OURS, unsourced),
        named("moro, share of the strength", &[MORO_EFFORT], "1", OURS, unsourced),
        named("moro, the right arm first: share of drops, lead in s", &MORO_LATE, "1, s", "Ronnqvist 1995", seen),
    ]);
    all.extend([
        named("palmar_grasp, begins at, full after", &PALMAR, "N", OURS, unsourced),
        named("plantar_grasp, begins at, full after", &PLANTAR, "N", OURS, unsourced),
        named(
            "plantar_grasp, ball of the foot over its length",
            &[BALL],
            "1",
            OURS,
            unsourced,
        ),
        named("grasps, share of the range", &[BEND], "1", OURS, unsourced),
        named("grasps, time constants", &GRASP_TIMES, "s", OURS, unsourced),
        named("rooting, begins at, full after", &ROOTING, "N", OURS, unsourced),
        named(
            "rooting, distance from the mouth over the head's radius",
            &[BESIDE_MOUTH],
            "1",
            OURS,
            unsourced,
        ),
        named(
            "rooting, share of the force of own hands",
            &[OWN_TOUCH],
            "1",
            "self-touch elicits it less (Rochat and Hespos 1997); the share is our choice",
            seen,
        ),
        named("rooting, turn of the head", &[ROOTING_TURN], "rad", OURS, unsourced),
        named(
            "rooting, share of the strength",
            &[ROOTING_EFFORT],
            "1",
            OURS,
            unsourced,
        ),
        named("rooting, time constants", &ROOTING_TIMES, "s", OURS, unsourced),
        named(
            "stepping, begins at, full after",
            &STEPPING,
            "of the weight",
            OURS,
            unsourced,
        ),
        named(
            "stepping, cosine of the greatest tilt",
            &[UPRIGHT],
            "1",
            OURS,
            unsourced,
        ),
        named("stepping, cycle", &[STEP_CYCLE], "s", OURS, unsourced),
        named(
            "stepping, share of the strength",
            &[STEPPING_EFFORT],
            "1",
            OURS,
            unsourced,
        ),
        named("stepping, time constants", &STEPPING_TIMES, "s", OURS, unsourced),
    ]);
    all
}

fn constant(name: String, values: &[f64], unit: &'static str, source: &'static str, mark: Mark) -> SourcedConstant {
    SourcedConstant {
        name,
        values: values.to_vec(),
        ages: Vec::new(),
        unit,
        source,
        mark,
    }
}
