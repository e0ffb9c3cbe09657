//! What documents that both sides load must have in common.

use conformance::differential::compare::{Sides, Stepped};
use conformance::differential::state::Recipe;

/// Checks that all compiled arrays agree, and steps from 20 states; `what` is the document.
pub fn agrees(sides: &mut Sides, what: &str) {
    for measured in sides.arrays() {
        assert!(measured.agrees(), "{what}: {measured:?}");
    }
    for seed in 0..20 {
        let Stepped::Compared { measured, .. } = sides.step(&Recipe::new(seed)) else {
            panic!("{what}: state {seed} is not compared");
        };
        measured
            .iter()
            .for_each(|measured| assert!(measured.agrees(), "{what}: state {seed}, {measured:?}"));
    }
}
