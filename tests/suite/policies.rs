//! Policies of evaluations: other programs, and ONNX models.

use std::ops::ControlFlow;
use std::time::Duration;

use crate::common::*;
use babybench::Blueprint;
use babybench::config::{Behavior, BodyParts, Config, Scene};
use babybench::env::Info;
use babybench::eval::{EpisodeError, Plan, run_episodes};
use babybench::policy::PolicySource;
use babybench::runs::EvaluationLog;
use babybench::runs::logs::evaluation_path;
use babybench::spaces::Noise;

/// Steps of an episode.
const DURATION: u64 = 6;

/// Six actions, and every sense small: 47 angles, 6 numbers of balance, eyes of 8 x 8 pixels.
fn small(folder: &Folder, vision: bool) -> Blueprint {
    let config = Config {
        save_dir: folder.text(),
        vision_active: vision,
        vision_resolution: 8,
        proprio_velocity: false,
        proprio_torque: false,
        proprio_limits: false,
        proprio_actuation: false,
        act: BodyParts {
            eyes: true,
            ..BodyParts::all(false)
        },
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    let blueprint = blueprint(config);
    let env = blueprint.env().expect("an environment");
    assert_eq!(env.action_space().len(), 6);
    blueprint
}

/// Evaluates the policy of a name in two episodes; commands have little time.
fn evaluate(blueprint: &Blueprint, policy: &str, jobs: usize) -> Result<Vec<Info>, EpisodeError> {
    let plan = Plan {
        episodes: 2,
        duration: DURATION,
        render: false,
        fps: 60,
        jobs,
    };
    let (source, limit) = (
        PolicySource::new(policy),
        Duration::from_secs(if policy.starts_with("sleep") { 1 } else { 60 }),
    );
    run_episodes(blueprint, &plan, &|| source.open(limit), &|| ControlFlow::Continue(()))
}

fn refused(blueprint: &Blueprint, policy: &str, parts: &[&str]) {
    let error = evaluate(blueprint, policy, 2).expect_err(policy).to_string();
    println!("{error}");
    for part in parts {
        assert!(error.contains(part), "{policy}: {error}: no {part:?}");
    }
}

fn logs(folder: &Folder) -> [EvaluationLog; 2] {
    [0, 1].map(|k| EvaluationLog::read(evaluation_path(folder.path(), k)).expect("a log"))
}

#[test]
fn a_policy_has_a_name() {
    for (text, source) in [
        ("random", PolicySource::Random),
        (" zero ", PolicySource::Zero),
        ("white", PolicySource::Random),
        ("pink", PolicySource::Noise(Noise::Pink)),
        (" held:0.1 ", PolicySource::Noise(Noise::Held { seconds: 0.1 })),
        ("held:never", PolicySource::Command("held:never".into())),
        ("a/c.ONNX", PolicySource::Onnx("a/c.ONNX".into())),
        ("'a b/c.onnx'", PolicySource::Onnx("a b/c.onnx".into())),
        (
            "python3 run.py c.onnx",
            PolicySource::Command("python3 run.py c.onnx".into()),
        ),
        (
            "python3 policy.py --fast",
            PolicySource::Command("python3 policy.py --fast".into()),
        ),
    ] {
        assert_eq!(PolicySource::new(text), source);
    }
    let folder = Folder::new("a b");
    let model = folder.file("c d.onnx", "");
    assert_eq!(
        PolicySource::new(&model.display().to_string()),
        PolicySource::Onnx(model)
    );
}

#[test]
fn noises_move_him_each_in_its_way_whatever_the_number_of_jobs() {
    let folder = Folder::new("noises");
    let blueprint = small(&folder, false);
    let mut all = Vec::new();
    for noise in ["random", "held:0.05", "ou", "pink", "oscillators"] {
        evaluate(&blueprint, noise, 1).expect("episodes");
        let alone = logs(&folder);
        evaluate(&blueprint, noise, 2).expect("episodes");
        assert_eq!(alone, logs(&folder), "{noise}");
        assert_ne!(alone[0].qpos, alone[1].qpos, "{noise}: both episodes are alike");
        all.push(alone);
    }
    for (k, one) in all.iter().enumerate() {
        assert!(
            all[..k].iter().all(|other| other != one),
            "noise {k} moves him as another does"
        );
    }
}

#[cfg(unix)]
mod commands;

#[cfg(feature = "onnx")]
mod onnx;
