//! Models that are made of others, cables, sites that are held together, and friction of what turns, each beside MuJoCo 3.3.0: compiled arrays
//! and steps.

use conformance::mujoco::{MUJOCO, needed};
use conformance::worlds::{Outcome, compare_all};
use testkit::harness::Trial;
use testkit::trials;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: composed_models_are_those_of_mujoco]
}

fn composed_models_are_those_of_mujoco() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/composed").into();
    let worlds = compare_all(needed(), &[folder]).expect("documents");
    assert_eq!(worlds.len(), 22, "documents that MuJoCo takes");
    for world in worlds {
        match world.outcome {
            Outcome::Both(figures) => assert!(figures.agrees(), "{}: {:?}", world.path, figures.farthest_array),
            Outcome::Refused(why) | Outcome::OursAlone(why) => panic!("{}: {why}", world.path),
            Outcome::NoDocument | Outcome::Fell => {}
        }
    }
}
