//! Hands in view, counted in two ways: both are in logs, of one environment and of many, under both modes.

use crate::common::*;
use babybench::config::{Behavior, Compat, Config, Scene};
use babybench::env::{BehaviorInfo, EYE_HAND_PAIRS, PerEyeAndHand, RegardCounts};
use babybench::runs::logs::training_path;
use babybench::runs::{TrainingLog, make_env, read_training};
use babybench::{AutoresetMode, Blueprint, VectorEnv, VectorOptions};

fn config(folder: &Folder, compat: Compat) -> Config {
    Config {
        save_dir: folder.path().display().to_string(),
        compat,
        save_logs_every: 1,
        ..free(Behavior::HandRegard, Scene::Base)
    }
}

/// Reads the lines beside a training log.
fn lines(folder: &Folder) -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string(training_path(folder.path()).with_extension("jsonl")).expect("lines");
    text.lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

fn counts(line: &serde_json::Value, key: &str) -> [u64; 4] {
    EYE_HAND_PAIRS.map(|pair| {
        line[key][pair]
            .as_u64()
            .unwrap_or_else(|| panic!("{line} has no {key} of {pair}"))
    })
}

#[test]
fn training_logs_have_both_counters_under_both_modes() {
    for compat in [Compat::Api, Compat::Reference] {
        let folder = Folder::new("regards_training");
        let mut env = make_env(config(&folder, compat), true).expect("a folder");
        let mut expected = Vec::new();
        for steps in [30, 20] {
            env.reset(None).expect("no divergence");
            random_steps(env.env_mut(), steps);
            expected.push(env.env_mut().info().details.regards.expect("both counters"));
        }
        env.finish_training().expect("the log can be written");
        let found: Vec<_> = lines(&folder);
        let of_compat = |both: &RegardCounts| match compat {
            Compat::Api => both.page,
            Compat::Reference => both.kit,
        };
        for (line, both) in found.iter().rev().zip(expected.iter().rev()) {
            assert_eq!(counts(line, "page_regards"), both.page.to_array(), "{compat}");
            assert_eq!(counts(line, "kit_regards"), both.kit.to_array(), "{compat}");
            let own = EYE_HAND_PAIRS.map(|pair| line[pair].as_u64().expect("the kit's keys"));
            assert_eq!(own, of_compat(both).to_array(), "{compat}");
        }
        // the pickle is the kit's: it has one of them
        let kept = read_training(folder.path()).expect("a log");
        assert!(kept.iter().all(|info| info.details.regards.is_none()));
    }
}

#[test]
fn resumed_logs_keep_both_counters() {
    let folder = Folder::new("regards_resumed");
    let config = config(&folder, Compat::Api);
    let both = |k: u64| RegardCounts {
        page: [k, 0, 1, 2].into(),
        kit: [3, k, 4, 5].into(),
    };
    let push = |log: &mut TrainingLog, k: u64| {
        let counts: PerEyeAndHand<u64> = both(k).page;
        let mut info = babybench::Info {
            behavior: BehaviorInfo::HandRegard { counts },
            ..babybench::Info::default()
        };
        info.details.regards = Some(both(k));
        log.end_episode_of(10 + k, &info).expect("the log can be written");
    };
    let mut log = TrainingLog::create(&config).expect("a log");
    (0..3).for_each(|k| push(&mut log, k));
    drop(log);
    for (at, change) in [(3, false), (4, true)] {
        if change {
            // lines of other records are made anew, with what is known of both
            let path = training_path(folder.path()).with_extension("jsonl");
            let text = std::fs::read_to_string(&path).expect("lines");
            std::fs::write(&path, text.replacen("\"steps\": 10", "\"steps\": 11", 1)).expect("a file");
        }
        let mut log = TrainingLog::resume(&config).expect("a log");
        push(&mut log, at);
        let found = lines(&folder);
        assert_eq!(found.len() as u64, at + 1);
        for (k, line) in found.iter().enumerate() {
            assert_eq!(counts(line, "page_regards"), both(k as u64).page.to_array());
            assert_eq!(counts(line, "kit_regards"), both(k as u64).kit.to_array());
            assert_eq!(line["steps"], 10 + k);
        }
    }
}

#[test]
fn vectors_have_both_counters() {
    let folder = Folder::new("regards_vector");
    for compat in [Compat::Api, Compat::Reference] {
        let blueprint = Blueprint::new(config(&folder, compat)).expect("a scene");
        let options = VectorOptions {
            autoreset: AutoresetMode::Disabled,
            ..VectorOptions::default()
        };
        let mut envs = VectorEnv::new(&blueprint, 2, options).expect("a vector");
        envs.reset(Some(3)).expect("no divergence");
        let mut actions = Vec::new();
        for _ in 0..20 {
            envs.sample_actions(&mut actions).expect("all are here");
            let infos = envs.step(&actions).expect("valid actions").infos;
            let (page, kit) = (
                infos.page_regards.expect("the page's"),
                infos.kit_regards.expect("the kit's"),
            );
            let own = match compat {
                Compat::Api => page,
                Compat::Reference => kit,
            };
            assert_eq!((infos.regards, page.len(), kit.len()), (Some(own), 8, 8), "{compat}");
        }
    }
}
