//! ONNX models from bytes: what does not load or does not fit says so in an error, and what answers has a finite action.
#![no_main]

use babybench::Observation;
use babybench::policy::OnnxPolicy;
use babybench::sensors::EYES;
use babybench::spaces::{BoxSpace, Dtype, ObservationSpace};
use libfuzzer_sys::fuzz_target;

/// Operators whose output size or duration the model computes, which are not limited.
const GROW: [&str; 13] = [
    "ConstantOfShape",
    "ConvTranspose",
    "Expand",
    "EyeLike",
    "Loop",
    "OneHot",
    "Pad",
    "Range",
    "Resize",
    "Scan",
    "Tile",
    "TopK",
    "Upsample",
];

/// The observation: vectors of a few numbers, and eyes of two by two pixels.
fn spaces() -> Vec<ObservationSpace> {
    let space = |key, shape: &[usize], dtype, high| ObservationSpace {
        key,
        shape: shape.to_vec(),
        dtype,
        low: 0.0,
        high,
    };
    vec![
        space("observation", &[3], Dtype::F64, 1.0),
        space("touch", &[4], Dtype::F32, 1.0),
        space("vestibular", &[2], Dtype::F64, 1.0),
        space(EYES[0], &[2, 2, 3], Dtype::U8, 255.0),
        space(EYES[1], &[2, 2, 3], Dtype::U8, 255.0),
        space("eye_left_depth", &[2, 2], Dtype::F32, 1.0),
        space("eye_right_depth", &[2, 2], Dtype::F32, 1.0),
        space("achieved_goal", &[2], Dtype::F64, 1.0),
    ]
}

/// Returns whether bytes contain a text.
fn has(data: &[u8], text: &str) -> bool {
    data.windows(text.len()).any(|window| window == text.as_bytes())
}

fuzz_target!(
    // the runtime gives up on some models, which the library turns into an error; a panic that goes further ends the target
    init: std::panic::set_hook(Box::new(|_| {})),
    |data: &[u8]| {
        if GROW.iter().any(|operator| has(data, operator)) {
            return;
        }
        let (numbers, image) = ([0.25, -0.5, 1.0], [7; 12]);
        let (touch, depth) = ([0.0, 0.5, 1.0, 2.0], [0.1, 0.2, 0.3, 0.4]);
        let seen = Observation {
            proprioception: &numbers,
            touch: Some(&touch),
            vestibular: Some(&numbers[..2]),
            eye_left: Some(&image),
            eye_right: Some(&image),
            eye_left_depth: Some(&depth),
            eye_right_depth: Some(&depth),
            achieved_goal: Some(&numbers[1..]),
            ..Observation::default()
        };
        let said = |e: &dyn std::fmt::Display| {
            let said = e.to_string();
            assert!(said.starts_with("m.onnx: "), "{said}");
            assert!(said.len() < 4000 && !said.chars().any(char::is_control), "{} bytes: {said:?}", said.len());
        };
        let mut policy = match OnnxPolicy::from_bytes(data.to_vec(), "m.onnx") {
            Ok(policy) => policy,
            Err(e) => return said(&e),
        };
        if let Err(e) = policy.connect(&spaces()) {
            return said(&e);
        }
        let space = BoxSpace::new(vec![-1.0; 2], vec![1.0; 2]);
        let mut action = Vec::new();
        match policy.decide(&seen, &space, &mut action) {
            Ok(()) => assert!(action.len() == 2 && action.iter().all(|v| (-1.0..=1.0).contains(v)), "{action:?}"),
            Err(e) => said(&e),
        }
    }
);
