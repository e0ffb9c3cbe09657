//! Training logs: what is recorded, when it is saved, and that what is on disk can always be read.

mod folder;
mod own_task;

use crate::common::*;
use babybench::config::{Behavior, Compat, Config, Scene};
use babybench::env::BlueprintOptions;
use babybench::env::{BehaviorInfo, Info, InfoDetails, PartNames, Task};
use babybench::eval::{Score, ScoreError, TouchableGeoms, eval_logs};
use babybench::formats::pickle::{self, Value};
use babybench::runs::logs::{evaluation_path, read_records_with, training_path};
use babybench::runs::{EvaluationLog, LogError, RunEnv, TrainingLog, for_evaluation, read_training, start_training};
use babybench::{Blueprint, Env, Limits, make_env};

fn config(folder: &Folder, behavior: Behavior, compat: Compat) -> Config {
    Config {
        save_dir: folder.path().display().to_string(),
        compat,
        ..free(behavior, Scene::Crib)
    }
}

fn episode(env: &mut RunEnv, steps: usize) {
    env.reset(None).expect("no divergence");
    random_steps(env.env_mut(), steps);
}

fn steps(records: &[Info]) -> Vec<u64> {
    records.iter().map(|r| r.steps).collect()
}

#[test]
fn api_logs_episodes_and_saves_every_so_many() {
    let folder = Folder::new("api");
    let mut config = config(&folder, Behavior::SelfTouch, Compat::Api);
    config.save_logs_every = 2;
    let saved = || steps(&read_training(folder.path()).expect("a log"));
    let mut env = make_env(config, true).expect("the folder can be made");
    assert!(saved().is_empty());
    episode(&mut env, 3);
    episode(&mut env, 4);
    assert!(saved().is_empty(), "one episode has ended");
    episode(&mut env, 5);
    assert_eq!(saved(), [3, 4]);
    env.reset(None).expect("no divergence");
    env.reset(None).expect("no divergence"); // no step, no episode
    random_steps(env.env_mut(), 1);
    env.finish_training().expect("the log can be written");
    assert_eq!(saved(), [3, 4, 5, 1]);
    env.finish_training().expect("the log can be written");
    assert_eq!(saved(), [3, 4, 5, 1]);
    let lines = std::fs::read_to_string(training_path(folder.path()).with_extension("jsonl")).expect("lines beside");
    assert_eq!(lines.lines().count(), 4);
    assert!(lines.ends_with("\"steps\": 1}\n"));
    assert!(lines.lines().all(|l| l.contains("\"right_hand_parts\": [")));
}

#[test]
fn reference_logs_resets_and_saves_by_steps() {
    let folder = Folder::new("reference");
    let mut config = config(&folder, Behavior::HandRegard, Compat::Reference);
    config.save_logs_every = 3;
    let saved = || steps(&read_training(folder.path()).expect("a log"));
    let mut env = make_env(config, true).expect("the folder can be made");
    env.reset(None).expect("no divergence");
    assert_eq!(saved(), [0], "an empty record for the first reset");
    random_steps(env.env_mut(), 7);
    for _ in 0..4 {
        episode(&mut env, 7);
    }
    env.reset(None).expect("no divergence");
    assert_eq!(saved(), [0], "7 is no multiple of 3");
    random_steps(env.env_mut(), 6);
    env.reset(None).expect("no divergence");
    assert_eq!(saved(), [0, 7, 7, 7, 7, 7, 6]);
    random_steps(env.env_mut(), 2);
    env.finish_training().expect("the log can be written");
    assert_eq!(saved(), [0, 7, 7, 7, 7, 7, 6], "a running episode is never logged");
}

#[test]
fn training_goes_on_where_it_ended() {
    let folder = Folder::new("resume");
    for compat in [Compat::Api, Compat::Reference] {
        let blueprint = blueprint(config(&folder, Behavior::SelfTouch, compat));
        let mut expected = Vec::new();
        for run in 0..3 {
            let mut env = start_training(&blueprint, run > 0).expect("a log to go on with");
            if run == 0 && compat == Compat::Reference {
                expected.push(0);
            }
            for n in [2, 3] {
                episode(&mut env, n);
                expected.push(n as u64);
            }
            env.reset(None).expect("no divergence");
            env.finish_training().expect("the log can be written");
            assert_eq!(
                steps(&read_training(folder.path()).expect("a log")),
                expected,
                "{compat}"
            );
        }
        drop(std::fs::remove_dir_all(folder.path()));
    }
    let mut other = config(&folder, Behavior::SelfTouch, Compat::Api);
    let mut env = make_env(other.clone(), true).expect("the folder can be made");
    episode(&mut env, 1);
    env.finish_training().expect("the log can be written");
    other.behavior = Behavior::HandRegard;
    let error = TrainingLog::resume(&other).expect_err("another behavior").to_string();
    assert!(error.contains("its behavior is self_touch, not hand_regard"), "{error}");
}

#[test]
fn evaluation_clears_counters_under_api_only() {
    let folder = Folder::new("accumulate");
    for (compat, expected) in [(Compat::Api, false), (Compat::Reference, true)] {
        let mut env = for_evaluation(&blueprint(config(&folder, Behavior::SelfTouch, compat))).expect("an environment");
        env.reset(None).expect("no divergence");
        let touched = |env: &Env| env.info().behavior.touches().expect("self_touch").concat().len();
        for _ in 0..20 {
            random_steps(&mut env, 50);
            if touched(&env) > 0 {
                break;
            }
        }
        assert!(touched(&env) > 0, "a thousand random steps bring a touch");
        env.reset(None).expect("no divergence");
        assert_eq!(touched(&env) > 0, expected, "{compat}");
    }
    assert!(!folder.path().exists(), "an evaluation alone writes nothing");
}

#[test]
fn evaluation_logs_read_back() {
    let folder = Folder::new("evaluation");
    for behavior in [Behavior::None, Behavior::SelfTouch, Behavior::HandRegard] {
        let mut env = env(config(&folder, behavior, Compat::Api));
        env.reset(Some(0)).expect("no divergence");
        let mut log = EvaluationLog::default();
        for _ in 0..12 {
            random_steps(&mut env, 1);
            log.push(&env.state().qpos, env.info());
        }
        let path = log.write(folder.path(), 3).expect("the log can be written");
        assert_eq!(path, evaluation_path(folder.path(), 3));
        for info in &mut log.info {
            info.details = InfoDetails::default(); // pickles are the kit's, without details
        }
        assert_eq!(EvaluationLog::read(&path).expect("a log"), log);
        let npz = babybench::formats::npz::Npz::open(path.with_extension("npz")).expect("an archive beside");
        assert_eq!(npz.get_f64("qpos").expect("positions").data, log.qpos);
        assert_eq!(npz.get_i64("steps").expect("steps").data, (1..13).collect::<Vec<_>>());
    }
}

#[test]
fn scores_are_those_of_the_specification() {
    let touch = |right: &[usize], left: &[usize]| Info {
        steps: 1000,
        behavior: BehaviorInfo::SelfTouch {
            touches: babybench::env::PerHand {
                right_hand: right.to_vec(),
                left_hand: left.to_vec(),
            },
        },
        ..Info::default()
    };
    let records = [touch(&[1, 2, 3], &[9]), touch(&[5, 6], &[7]), touch(&[6], &[])];
    let score = Score::new(&records, Compat::Reference).expect("a score");
    assert_eq!((score.value, score.parts_per_episode), (3.0 / 68.0, Some(2.0)));
    assert!(
        score
            .to_text(None)
            .contains("2 episodes, 2000 steps count; 2.0 parts touched in an episode")
    );
    assert_eq!(
        Score::new(&records[..1], Compat::Reference).expect("a score").value,
        0.0
    );
    // of the kit's logs, which start with an empty record, both rules leave that out alone
    let all = Score::new(&records, Compat::Api).expect("a score");
    assert_eq!(
        (all.value, all.episodes, all.parts_per_episode),
        (7.0 / 68.0, 3, Some(8.0 / 3.0))
    );
    let mut kit = vec![Info {
        steps: 0,
        ..touch(&[], &[])
    }];
    kit.extend(records.clone());
    assert_eq!(Score::new(&kit, Compat::Reference), Ok(all.clone()));
    assert_eq!(Score::new(&kit, Compat::Api), Ok(all));
    let regard = |n, steps| Info {
        steps,
        behavior: BehaviorInfo::HandRegard {
            counts: [n, n, n, n].into(),
        },
        ..Info::default()
    };
    let score = Score::new(&[regard(100, 100), regard(3, 10), regard(1, 30)], Compat::Reference).expect("a score");
    assert_eq!((score.value, score.parts_per_episode), (0.1, None));
    assert_eq!(score.fractions(), Some([0.1; 4].into()));
    // of more than 10,001 records the last 10,000 count
    let mut many = vec![touch(&[1, 2], &[3]); 5];
    many.extend(vec![touch(&[7], &[]); 10_000]);
    let score = Score::new(&many, Compat::Reference).expect("a score");
    assert_eq!((score.value, score.episodes), (1.0 / 68.0, 10_000));
    let exactly = Score::new(&many[4..], Compat::Reference).expect("a score");
    assert_eq!((exactly.value, exactly.episodes), (1.0 / 68.0, 10_000));
}

#[test]
fn each_hand_can_reach_31_parts() {
    for scene in [Scene::Base, Scene::Crib, Scene::Cubes] {
        let blueprint = Blueprint::new(free(Behavior::SelfTouch, scene)).expect("a scene");
        let skin = TouchableGeoms::new(blueprint.model()).expect("MIMo");
        assert_eq!([0, 1].map(|hand| skin.reachable(hand).len()), [31, 31]);
        assert_eq!(&*skin.name(13), "right_hand 1/2");
        assert_eq!(&*skin.name(3), "hip");
    }
}

#[test]
fn gaze_angles_agree_with_the_counters() {
    let folder = Folder::new("gaze");
    for compat in [Compat::Api, Compat::Reference] {
        let mut env = env(config(&folder, Behavior::HandRegard, compat));
        env.reset(Some(0)).expect("no divergence");
        let mut expected = [0; 4];
        for _ in 0..200 {
            random_steps(&mut env, 1);
            let angles = env.info().details.gaze_angles.expect("hand_regard").to_array();
            assert!(angles.iter().all(|a| (0.0..=std::f64::consts::PI).contains(a)));
            for (count, angle) in expected.iter_mut().zip(angles) {
                *count += u64::from(angle < 15_f64.to_radians());
            }
        }
        assert_eq!(env.info().behavior.regards(), Some(expected), "{compat}");
    }
}

#[test]
fn details_name_what_is_touched() {
    let folder = Folder::new("details");
    let mut env = env(config(&folder, Behavior::SelfTouch, Compat::Api));
    env.reset(Some(0)).expect("no divergence");
    let start = env.snapshot();
    let names = PartNames::new(env.model());
    let check = |env: &Env| {
        let parts = env.info().details.touched_parts.clone().expect("self_touch");
        let geoms = env.info().behavior.touches().expect("self_touch");
        let named = geoms.map(|list| list.iter().map(|&g| names.get(g)).collect::<Vec<_>>());
        assert_eq!([&parts.right_hand, &parts.left_hand], named.each_ref());
        parts.right_hand.len() + parts.left_hand.len()
    };
    let mut most = 0;
    for _ in 0..30 {
        held_steps(&mut env, 60, 30);
        most = check(&env);
        if most >= 2 {
            break;
        }
    }
    assert!(most >= 2, "random actions touch something");
    let end = env.snapshot();
    let json = env.info().to_detailed_json();
    assert!(
        json.contains("_parts\": [\"") && !env.info().to_json().contains("_parts"),
        "{json}"
    );
    env.restore(&start).expect("a snapshot");
    assert_eq!(check(&env), 0);
    env.restore(&end).expect("a snapshot");
    assert_eq!(check(&env), most);
    env.reset(Some(1)).expect("no divergence");
    assert_eq!(check(&env), 0);
}

#[test]
fn details_are_beside_the_pickles() {
    let folder = Folder::new("beside");
    let mut env = env(config(&folder, Behavior::HandRegard, Compat::Api));
    env.reset(Some(0)).expect("no divergence");
    assert_eq!(env.info().details.gaze_angles, None);
    let mut log = EvaluationLog::default();
    let mut angles = Vec::new();
    for _ in 0..5 {
        random_steps(&mut env, 1);
        angles.extend(env.info().details.gaze_angles.expect("hand_regard").to_array());
        log.push(&env.state().qpos, env.info());
    }
    let path = log.write(folder.path(), 0).expect("the log can be written");
    let npz = babybench::formats::npz::Npz::open(path.with_extension("npz")).expect("an archive beside");
    assert_eq!(npz.get_f64("gaze_angles").expect("angles").data, angles);
    let lines = std::fs::read_to_string(path.with_extension("jsonl")).expect("lines beside");
    assert_eq!(lines.lines().count(), 5);
    assert!(
        lines
            .lines()
            .all(|l| l.contains("\"gaze_angles\": {\"right_eye_right_hand\": "))
    );
    let read = EvaluationLog::read(&path).expect("a log");
    assert!(
        read.info.iter().all(|i| i.details.gaze_angles.is_none()),
        "pickles are the kit's"
    );
}
