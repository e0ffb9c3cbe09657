//! Lengths of trunk and legs as in infants, within the stature that the authors' formulas give.

use super::body::HEAD_RADIUS;
use super::leg_lengths::leg;
use super::lengths::Lengths;
use crate::config::Proportions;
use crate::mimo::sources::{Mark, SourcedConstant};

/// Ages of [`CROWN_RUMP`], months.
const AGES: [f64; 4] = [0.0, 6.0, 12.0, 24.0];

/// Crown-rump length over length. The values at birth and 24 months are those of Dutch infants (NL4); those at 6 and 12 months lie between them.
const CROWN_RUMP: [f64; 4] = [0.692, 0.66, 0.64, 0.604];

/// Factors on the lengths of trunk and legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Factor on heights in the trunk.
    pub trunk: f64,
    /// Factor on the length from the hip to the ankle.
    pub leg: f64,
}

impl Stretch {
    /// Returns the factors at an age: the crown-rump length becomes that of infants, and the stature stays. `trunk` is the factor on heights
    /// in the trunk, relative to its breadth, by which the stature is counted.
    ///
    /// The numbers are those of [`super::body`]: heights of the original body over hip breadth, head circumference and legs.
    pub fn of(proportions: Proportions, age: f64, now: &Lengths, base: &Lengths, trunk: f64) -> Self {
        if proportions == Proportions::Mimo {
            return Self { trunk, leg: 1.0 };
        }
        let breadth = now.hip_breadth / base.hip_breadth;
        let head = 2.0 * HEAD_RADIUS * now.head_circumference / base.head_circumference;
        let [thigh, calf, foot] = leg(now, base);
        let leg = thigh + calf;
        // the hip's joint is 7 mm above that of the legs, the trunk's geoms end 48 mm times the breadth below it
        let stature = 0.298 * (breadth * trunk) + head + 0.007 + leg + foot;
        let sitting = crown_rump(age) * stature;
        let trunk = (sitting - head - 0.048 * breadth) / 0.293;
        Self {
            trunk: trunk / breadth,
            leg: (stature - 0.298 * trunk - head - 0.007 - foot) / leg,
        }
    }
}

/// Returns the crown-rump length over length at an age, linear between the ages of the table.
fn crown_rump(age: f64) -> f64 {
    let k = AGES.partition_point(|a| *a <= age).clamp(1, AGES.len() - 1);
    let share = (age - AGES[k - 1]) / (AGES[k] - AGES[k - 1]);
    CROWN_RUMP[k - 1] + share * (CROWN_RUMP[k] - CROWN_RUMP[k - 1])
}

/// Lists the constants of proportions.
pub(super) fn constants() -> [SourcedConstant; 2] {
    let constant = |ages: &[f64], values: &[f64], mark, source| SourcedConstant {
        name: "crown-rump length over length".to_string(),
        values: values.to_vec(),
        ages: ages.to_vec(),
        unit: "1",
        source,
        mark,
    };
    [
        constant(
            &[AGES[0], AGES[3]],
            &[CROWN_RUMP[0], CROWN_RUMP[3]],
            Mark::Seen,
            "Dutch infants (NL4)",
        ),
        constant(
            &AGES[1..3],
            &CROWN_RUMP[1..3],
            Mark::Unsourced,
            "between birth and 24 months",
        ),
    ]
}
