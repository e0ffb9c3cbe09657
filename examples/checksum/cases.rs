//! The configurations whose bits are compared.

use babybench::{Blueprint, Config, EnvError};

/// A configuration: its name, and its text in YAML.
pub type Case = (&'static str, &'static str);

/// The example configurations of BabyBench and of an infant of three months.
pub const EXAMPLES: [Case; 4] = [
    ("self_touch", include_str!("../../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../../configs/config_test_installation.yml"),
    ),
    ("infant", include_str!("../../configs/config_infant.yml")),
];

/// The tasks, and what the examples leave out: actuation models, the other engine, kinds of touch and vision, ages.
pub const VARIANTS: [Case; 11] = [
    ("reach", include_str!("../../configs/config_reach.yml")),
    ("standup", include_str!("../../configs/config_standup.yml")),
    ("selfbody", include_str!("../../configs/config_selfbody.yml")),
    ("catch", include_str!("../../configs/config_catch.yml")),
    ("roll_over", include_str!("../../configs/config_roll_over.yml")),
    (
        "muscle",
        "{behavior: self_touch, scene: crib, actuation_model: muscle, touch_function: force_vector, touch_response: spread_linear}",
    ),
    (
        "positional",
        "{behavior: hand_regard, scene: cubes, actuation_model: positional, touch_function: normal_force, touch_fingers: false, compat: reference}",
    ),
    (
        "rapier",
        "{engine: rapier, behavior: hand_regard, scene: cubes, touch_function: force_vector_global}",
    ),
    (
        "newborn",
        "{behavior: self_touch, scene: crib, age: 0, touch_grows: true, touch_pooled: true}",
    ),
    (
        "toddler",
        "{behavior: hand_regard, scene: cubes, age: 24, strength_age: 18, frame_skip: 3}",
    ),
    (
        "all_eyes",
        "{scene: cubes, touch_active: false, vision_resolution: 96, vision_outputs: [rgb, gray, depth, segmentation], vision_foveation: 10}",
    ),
];

/// Builds a blueprint of a case.
///
/// # Errors
/// As [`Blueprint::new`].
pub fn blueprint((name, text): Case, change: impl FnOnce(Config) -> Config) -> Result<Blueprint, EnvError> {
    Blueprint::new(change(Config::from_yaml(text, name)?))
}
