//! Policies that are ONNX models.

use babybench::Env;
use babybench::policy::{OnnxPolicy, Policy, PolicyError};
use babybench::spaces::NumpyRng;

use super::*;

fn model(name: &str) -> String {
    format!("{}/tests/data/policies/{name}.onnx", env!("CARGO_MANIFEST_DIR"))
}

/// Actions of a model along an episode with random actions, each beside the expected one.
fn compare(name: &str, vision: bool, tolerance: f32, expected: &dyn Fn(&Env) -> Vec<f32>) {
    let folder = Folder::new(name);
    let mut env = small(&folder, vision).env().expect("an environment");
    let mut policy = OnnxPolicy::open(model(name)).expect("a model");
    let mut action = Vec::new();
    env.reset(Some(0)).expect("no divergence");
    policy.begin(&mut env, 0).expect("a fitting model");
    let (mut different, mut told) = (0.0_f32, false);
    for _ in 0..10 {
        policy.act(&mut env, &mut action).expect("an action");
        let wanted = expected(&env);
        assert_eq!(action.len(), wanted.len());
        for (k, (a, b)) in action.iter().zip(&wanted).enumerate() {
            assert!((a - b).abs() <= tolerance, "{name}: number {k} is {a}, not {b}");
            different = different.max((a - b).abs());
        }
        told |= wanted.iter().any(|w| *w != wanted[0]);
        random_steps(&mut env, 3);
    }
    assert!(told, "{name}: no action tells anything");
    println!("{name}: actions differ by {different:.1e} at most");
}

#[test]
fn a_network_computes_what_its_weights_say() {
    compare("network", false, 1e-6, &|env| {
        let o = env.observation();
        let all: Vec<f64> = [o.proprioception, o.vestibular.expect("balance")].concat();
        let weight = |i: usize, j: usize| ((7 * i + 3 * j) % 11) as f64 / 64.0 - 5.0 / 64.0;
        let sum = |j: usize| -> f64 { all.iter().enumerate().map(|(i, x)| x * weight(i, j)).sum() };
        (0..6).map(|j| (sum(j) + j as f64 / 16.0).tanh() as f32).collect()
    });
}

#[test]
fn images_go_in_as_bytes_or_floats_in_either_order() {
    compare("eyes", true, 1e-6, &|env| {
        let o = env.observation();
        let mean = |image: &[u8], c: usize| {
            image.iter().skip(c).step_by(3).map(|&v| f64::from(v)).sum::<f64>() / (64.0 * 255.0)
        };
        let eyes = [o.eye_left.expect("an image"), o.eye_right.expect("an image")];
        eyes.iter()
            .flat_map(|eye| (0..3).map(|c| mean(eye, c) as f32))
            .collect()
    });
}

#[test]
fn one_input_gets_all_senses_in_alphabetical_order() {
    compare("flat", true, 1e-6, &|env| {
        let o = env.observation();
        let (left, right) = (o.eye_left.expect("an image"), o.eye_right.expect("an image"));
        let balance = o.vestibular.expect("balance");
        let chosen = [
            f64::from(left[5]),
            f64::from(right[7]),
            o.proprioception[0],
            o.proprioception[46],
            balance[0],
            balance[5],
        ];
        chosen.iter().map(|x| (x / 255.0) as f32).collect()
    });
}

#[test]
fn actions_are_clipped() {
    compare("large", false, 0.0, &|env| {
        let space = env.action_space();
        (0..6)
            .map(|k| if k % 2 == 0 { space.high()[k] } else { space.low()[k] })
            .collect()
    });
}

#[test]
fn models_are_policies_of_evaluations() {
    let folder = Folder::new("models");
    let blueprint = small(&folder, false);
    let infos = evaluate(&blueprint, &model("network"), 1).expect("episodes");
    let one = logs(&folder);
    assert_eq!(evaluate(&blueprint, &model("network"), 2).expect("episodes"), infos);
    assert_eq!(one, logs(&folder));
    evaluate(&blueprint, "zero", 1).expect("episodes");
    assert_ne!(one, logs(&folder));
}

#[test]
fn misfits_say_what_is_expected() {
    let folder = Folder::new("misfits");
    let blueprint = small(&folder, false);
    let refused = |name: &str, parts: &[&str]| refused(&blueprint, &model(name), parts);
    refused("no_such_model", &["no_such_model.onnx", "cannot load"]);
    refused("wrong_name", &["\"obs\"", "\"observation\", \"vestibular\""]);
    refused("wrong_shape", &["\"observation\"", "[1, 48]", "[1, 47] or [47]"]);
    refused("wrong_action", &["\"action\" has 5 numbers", "6 numbers"]);
    refused("not_finite", &["\"action\" is not finite: number 0 is -inf"]);
    refused("whole_numbers", &["whole numbers", "(f32)"]);
    refused(
        "takes_whole_numbers",
        &["\"observation\" has the type tensor(i32) but must be f32"],
    );
    refused("eyes", &["\"eye_left\"", "not an active sense"]);
    refused(
        "flat",
        &[
            "[437]",
            "[1, 53] or [53]",
            "all active senses",
            "observation, vestibular",
        ],
    );
    let text = folder.file("text.onnx", "this is not a model");
    super::refused(&blueprint, &text.display().to_string(), &["text.onnx", "cannot load"]);
    let folder = Folder::new("misfits_vision");
    let mut config = small(&folder, true).config().clone();
    config.vision_resolution = 16;
    let blueprint = Blueprint::new(config).expect("a scene");
    super::refused(
        &blueprint,
        &model("eyes"),
        &[
            "[batch, 3, 8, 8]",
            "[1, 16, 16, 3] or [16, 16, 3] or [1, 3, 16, 16] or [3, 16, 16]",
        ],
    );
}

#[test]
fn damaged_models_never_panic() {
    let folder = Folder::new("damaged");
    let mut env = small(&folder, true).env().expect("an environment");
    env.reset(Some(0)).expect("no divergence");
    let mut rng = NumpyRng::seed(9);
    let (mut acted, n) = (0, 600);
    for name in ["network", "eyes", "flat"] {
        let whole = std::fs::read(model(name)).expect("a model");
        for _ in 0..n / 3 {
            let mut bytes = whole.clone();
            for _ in 0..1 + (rng.uniform() * 4.0) as usize {
                let at = (rng.uniform() * bytes.len() as f64) as usize;
                bytes[at] = (rng.uniform() * 256.0) as u8;
            }
            if rng.uniform() < 0.2 {
                bytes.truncate((rng.uniform() * bytes.len() as f64) as usize);
            }
            let path = folder.file("damaged.onnx", bytes);
            let mut action = Vec::new();
            let done = OnnxPolicy::open(&path).and_then(|mut p| p.act(&mut env, &mut action));
            match done {
                Ok(()) => acted += 1,
                Err(e) => assert!(matches!(e, PolicyError::Onnx { .. }), "{e}"),
            }
        }
    }
    println!("{acted} of {n} damaged models still act");
}
