//! Whoever reads an observation reads it after its transforms: recordings, other programs, networks.

use babybench::Env;
use babybench::runs::{Recording, replay, replay_with_images};
use babybench::spaces::Values;

use crate::common::*;

/// Steps of a recording.
const STEPS: usize = 12;

/// An environment of an infant right after a seeded reset, and a recording that starts there.
fn recorded() -> (Env, Recording) {
    let mut env = env(infant());
    env.reset(Some(5)).expect("no divergence");
    let (qpos0, qvel0) = (env.state().qpos.clone(), env.state().qvel.clone());
    let (mut action, mut actions) = (Vec::new(), Vec::new());
    for _ in 0..STEPS {
        env.sample_action(&mut action);
        actions.extend_from_slice(&action);
    }
    let recording = Recording {
        qpos0,
        qvel0,
        activity0: Vec::new(),
        actions,
        len: STEPS,
        qpos: Vec::new(),
        qvel: Vec::new(),
        qacc: Vec::new(),
        activity: Vec::new(),
        episodes: Vec::new(),
    };
    (env, recording)
}

/// All that a replay keeps of what was observed, as text, and the rows to replay it one step at a time.
fn by_hand(env: &mut Env, recording: &mut Recording) -> [String; 6] {
    env.reset(Some(5)).expect("no divergence");
    env.by_hand()
        .reset_to(&recording.qpos0, &recording.qvel0)
        .expect("no divergence");
    let (mut body, mut pooled, mut pain, mut balance) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut eyes, mut grey) = (Vec::new(), Vec::new());
    for action in recording.actions.chunks_exact(recording.actions.len() / STEPS) {
        let seen = env.step(action).expect("no divergence").observation;
        body.extend_from_slice(seen.proprioception);
        pooled.extend_from_slice(seen.touch_pooled.expect("pooled touch"));
        pain.extend_from_slice(seen.pain.expect("pain"));
        balance.extend_from_slice(seen.vestibular.expect("balance"));
        eyes.extend_from_slice(seen.eye_left.expect("an eye"));
        grey.extend_from_slice(seen.eye_right_gray.expect("a grey image"));
        let state = env.state();
        recording.qpos.extend_from_slice(&state.qpos);
        recording.qvel.extend_from_slice(&state.qvel);
        recording.qacc.extend_from_slice(&state.qacc);
    }
    assert!(pain.iter().any(|v| *v > 0.0), "something hurts");
    [
        format!("{body:?}"),
        format!("{pooled:?}"),
        format!("{pain:?}"),
        format!("{balance:?}"),
        format!("{eyes:?}"),
        format!("{grey:?}"),
    ]
}

#[test]
fn a_replay_keeps_senses_after_their_transforms() {
    let (mut env, mut recording) = recorded();
    let expect = by_hand(&mut env, &mut recording);
    // noise comes from the generator, which a replay does not seed
    env.reset(Some(5)).expect("no divergence");
    let found = replay_with_images(&mut env, &recording, false, Some(1)).expect("a replay");
    let sense = |key: &str| match found.sense(key).expect(key) {
        Values::F64(values) => format!("{values:?}"),
        Values::F32(values) => format!("{values:?}"),
        Values::U8(values) => format!("{values:?}"),
        Values::I32(values) => format!("{values:?}"),
    };
    let found = [
        format!("{:?}", found.observation),
        sense("touch_pooled"),
        sense("pain"),
        sense("vestibular"),
        sense("eye_left"),
        sense("eye_right_gray"),
    ];
    for (k, (expect, found)) in expect.iter().zip(&found).enumerate() {
        assert!(expect == found, "sense {k}");
    }
}

#[test]
fn one_step_at_a_time_actions_are_as_late_and_senses_as_old() {
    let (mut env, mut recording) = recorded();
    by_hand(&mut env, &mut recording);
    let run = |env: &mut Env, one_step: bool| {
        env.reset(Some(5)).expect("no divergence");
        replay(env, &recording, one_step).expect("a replay")
    };
    let (whole, steps) = (run(&mut env, false), run(&mut env, true));
    assert_eq!(whole.ctrl, steps.ctrl);
    for (a, b) in whole.observation.iter().zip(&steps.observation) {
        assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{a} and {b}");
    }
}

/// An infant with six actions, whose eyes have 8 x 8 pixels.
#[cfg(any(feature = "onnx", all(feature = "eval", unix)))]
fn small(folder: &Folder) -> Env {
    use babybench::config::{BodyParts, Config};

    env(Config {
        save_dir: folder.text(),
        vision_resolution: 8,
        act: BodyParts {
            eyes: true,
            ..BodyParts::all(false)
        },
        ..infant()
    })
}

#[cfg(all(feature = "eval", unix))]
#[test]
fn other_programs_are_told_senses_after_their_transforms() {
    use babybench::policy::{CommandPolicy, Policy};
    use serde_json::Value;

    let folder = Folder::new("line of an infant");
    let mut env = small(&folder);
    let heard = folder.path().join("heard");
    let text = format!(
        "while read -r line; do printf '%s\\n' \"$line\" >> '{}'; echo '[0,0,0,0,0,0]'; done",
        heard.display()
    );
    let program = folder.file("heard.sh", text);
    let mut policy = CommandPolicy::start(&format!("sh '{}'", program.display())).expect("a program");
    let mut action = Vec::new();
    env.reset(Some(2)).expect("no divergence");
    policy.begin(&mut env, 0).expect("a fitting program");
    for _ in 0..6 {
        policy.act(&mut env, &mut action).expect("an action");
        let lines = std::fs::read_to_string(&heard).expect("what was told");
        let told: Value = serde_json::from_str(lines.lines().last().expect("a line")).expect("JSON");
        let seen = env.observation();
        let numbers = |key: &str| -> Vec<f64> { serde_json::from_value(told[key].clone()).expect(key) };
        assert_eq!(numbers("observation"), seen.proprioception);
        assert_eq!(Some(&numbers("touch_pooled")[..]), seen.touch_pooled);
        assert_eq!(Some(&numbers("vestibular")[..]), seen.vestibular);
        let singles = |key: &str| -> Vec<f32> { numbers(key).iter().map(|v| *v as f32).collect() };
        assert_eq!(Some(&singles("pain")[..]), seen.pain);
        assert_eq!(Some(&singles("touch")[..]), seen.touch);
        env.step(&action).expect("no divergence");
    }
}

#[cfg(feature = "onnx")]
#[test]
fn networks_see_images_after_their_transforms() {
    use babybench::policy::{OnnxPolicy, Policy};

    let folder = Folder::new("network of an infant");
    let mut env = small(&folder);
    // its actions are the means of the colours of both eyes
    let model = format!("{}/tests/data/policies/eyes.onnx", env!("CARGO_MANIFEST_DIR"));
    let mut policy = OnnxPolicy::open(model).expect("a model");
    let mut action = Vec::new();
    env.reset(Some(2)).expect("no divergence");
    policy.begin(&mut env, 0).expect("a fitting model");
    for step in 0..6 {
        policy.act(&mut env, &mut action).expect("an action");
        let seen = env.observation();
        let mean = |image: &[u8], c: usize| {
            image.iter().skip(c).step_by(3).map(|&v| f64::from(v)).sum::<f64>() / (64.0 * 255.0)
        };
        let eyes = [seen.eye_left.expect("an eye"), seen.eye_right.expect("an eye")];
        for (k, a) in action.iter().enumerate() {
            let expect = mean(eyes[k / 3], k % 3) as f32;
            assert!(
                (a - expect).abs() < 1e-6,
                "action {k} of step {step}: {a}, not {expect}"
            );
        }
        env.step(&action).expect("no divergence");
    }
}
