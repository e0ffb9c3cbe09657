//! Training logs that are resumed: their files are those of one run, and lines that are there are kept only if they are the log's.

use std::path::Path;

use crate::common::*;
use babybench::config::{Behavior, Compat, Scene};
use babybench::env::{BehaviorInfo, Info, Outcome, PartNames, PerHand, TaskInfo};
use babybench::eval::{MAX_EPISODES, Score};
use babybench::formats::pickle::{self, Value};
use babybench::runs::logs::training_path;
use babybench::runs::{TrainingLog, read_training};
use babybench::{Blueprint, Config};

const _: () = assert!(TrainingLog::RECENT > MAX_EPISODES, "scores look at no more");

fn config(folder: &Folder, behavior: Behavior) -> Config {
    Config {
        save_dir: folder.path().display().to_string(),
        save_logs_every: u64::MAX >> 1,
        ..free(behavior, Scene::Base)
    }
}

/// The record of an episode by its number.
fn touched(k: u64) -> (u64, BehaviorInfo) {
    let list = |n: u64| (0..n).map(|i| (3 + (7 * k + i) % 33) as usize).collect();
    let touches = PerHand {
        right_hand: list(k % 4),
        left_hand: list(k % 3),
    };
    (k + 1, BehaviorInfo::SelfTouch { touches })
}

fn push(log: &mut TrainingLog, episodes: std::ops::Range<u64>) {
    for (steps, behavior) in episodes.map(touched) {
        log.end_episode(steps, &behavior).expect("the log can be written");
    }
}

/// Returns the training log of a folder and the lines beside it.
fn files(folder: &Path) -> [Vec<u8>; 2] {
    let path = training_path(folder);
    [path.clone(), path.with_extension("jsonl")].map(|path| std::fs::read(path).expect("a file"))
}

fn names() -> Option<PartNames> {
    let blueprint = Blueprint::new(free(Behavior::SelfTouch, Scene::Base)).expect("a scene");
    Some(PartNames::new(blueprint.model()))
}

/// Returns the files of a run of `episodes` episodes.
fn whole(episodes: u64, names: Option<PartNames>) -> [Vec<u8>; 2] {
    let folder = Folder::new("whole");
    let log = TrainingLog::create(&config(&folder, Behavior::SelfTouch)).expect("a log");
    let mut log = log.with_names(names);
    push(&mut log, 0..episodes);
    log.save().expect("the log can be written");
    files(folder.path())
}

#[test]
fn a_resumed_log_is_that_of_one_run() {
    let (folder, names) = (Folder::new("pieces"), names());
    let config = config(&folder, Behavior::SelfTouch);
    for (piece, episodes) in [0..1, 1..1, 1..900, 900..1001, 1001..12_000].into_iter().enumerate() {
        let log = match piece {
            0 => TrainingLog::create(&config),
            _ => TrainingLog::resume(&config),
        };
        let mut log = log.expect("a log").with_names(names.clone());
        let middle = (episodes.start + episodes.end) / 2;
        push(&mut log, episodes.start..middle);
        log.save().expect("the log can be written");
        push(&mut log, middle..episodes.end);
        log.save().expect("the log can be written");
        log.save().expect("the log can be written");
        assert!(
            files(folder.path()) == whole(episodes.end, names.clone()),
            "{episodes:?}"
        );
    }
    let log = TrainingLog::resume(&config).expect("a log");
    let expected: Vec<Info> = (0..12_000)
        .map(|k| {
            let (steps, behavior) = touched(k);
            Info {
                steps,
                behavior,
                ..Info::default()
            }
        })
        .collect();
    let (totals, recent) = (log.totals(), log.recent());
    assert_eq!(
        (totals.records, totals.steps, totals.tasks),
        (12_000, 12_000 * 12_001 / 2, 0)
    );
    assert_eq!((recent.total, recent.records.len()), (12_000, TrainingLog::RECENT));
    assert!(log.records() == expected && expected.ends_with(&recent.records));
    assert!(read_training(folder.path()).expect("a log") == expected);
    assert_eq!(
        Score::new(&recent.records, Compat::Api),
        Score::new(&expected, Compat::Api)
    );
    let mut log = log.clone();
    push(&mut log, 12_000..12_001);
    assert_eq!(log.records().len(), 12_001);
}

#[test]
fn lines_that_are_not_those_of_the_log_are_made_again() {
    let (folder, names) = (Folder::new("lines"), names());
    let config = config(&folder, Behavior::SelfTouch);
    let expected = whole(12, names.clone());
    let text = |lines: &[u8]| String::from_utf8(lines.to_vec()).expect("text");
    type Change = fn(String) -> String;
    let changes: [(&str, Change); 7] = [
        ("nothing", |_| String::new()),
        ("a run that was killed between the two files", |lines| {
            lines + "{\"steps\": 11}\n"
        }),
        ("cut", |lines| lines[..lines.len() - 5].to_string()),
        ("another first line", |lines| lines.replacen("1", "2", 1)),
        ("another last line", |lines| {
            lines.replace("\"steps\": 10}", "\"steps\": 11}")
        }),
        ("other names", |lines| lines.replace("_parts", "_names")),
        ("no end of a line", |lines| lines.trim_end().to_string()),
    ];
    for (what, change) in changes {
        for while_open in [false, true] {
            let log = TrainingLog::create(&config).expect("a log");
            let mut log = log.with_names(names.clone());
            push(&mut log, 0..10);
            log.save().expect("the log can be written");
            let [_, lines] = files(folder.path());
            let path = training_path(folder.path()).with_extension("jsonl");
            std::fs::write(path, change(text(&lines))).expect("a file");
            if !while_open {
                drop(log);
                log = TrainingLog::resume(&config).expect("a log").with_names(names.clone());
            }
            push(&mut log, 10..12);
            log.save().expect("the log can be written");
            assert!(files(folder.path()) == expected, "{what}, {while_open}");
        }
    }
    // a log of the kit has no lines beside it, and its bytes are those of Python
    let path = training_path(folder.path());
    std::fs::remove_file(path.with_extension("jsonl")).expect("a file");
    let log = TrainingLog::resume(&config).expect("a log").with_names(names);
    log.save().expect("the log can be written");
    assert!(files(folder.path()) == expected);
}

#[test]
fn logs_are_pickles_of_the_records_keys() {
    let task = TaskInfo {
        task: "reach".into(),
        outcome: Outcome {
            is_success: true,
            is_failure: false,
        },
        episode_return: -1.5,
        ..TaskInfo::default()
    };
    let int = |n: i64| Value::Int(n);
    let list = |numbers: [i64; 2]| Value::list(numbers.map(Value::Int));
    let geoms = [300, 70_000];
    let touches = PerHand {
        right_hand: geoms.map(|geom| geom as usize).to_vec(),
        left_hand: geoms.map(|geom| geom as usize / 2).to_vec(),
    };
    let counts = [1, 0, 1 << 40, 255].into();
    for (behavior, info, record) in [
        (Behavior::None, BehaviorInfo::None, vec![]),
        (
            Behavior::SelfTouch,
            BehaviorInfo::SelfTouch { touches },
            vec![
                ("right_hand_touches", list(geoms)),
                ("left_hand_touches", list(geoms.map(|g| g / 2))),
            ],
        ),
        (
            Behavior::HandRegard,
            BehaviorInfo::HandRegard { counts },
            vec![
                ("right_eye_right_hand", int(1)),
                ("right_eye_left_hand", int(0)),
                ("left_eye_right_hand", int(1 << 40)),
                ("left_eye_left_hand", int(255)),
            ],
        ),
        (
            Behavior::Reach,
            BehaviorInfo::Task(task),
            vec![
                ("task", Value::Text("reach".into())),
                ("is_success", Value::Bool(true)),
                ("is_failure", Value::Bool(false)),
                ("return", Value::Float(-1.5)),
            ],
        ),
    ] {
        let folder = Folder::new("keys");
        let mut log = TrainingLog::create(&config(&folder, behavior)).expect("a log");
        for _ in 0..1500 {
            log.end_episode(20, &info).expect("the log can be written");
        }
        log.save().expect("the log can be written");
        let record = Value::dict(record.into_iter().chain([("steps", int(20))]));
        let expected = pickle::to_bytes(&Value::list(vec![record; 1500])).expect("a pickle");
        assert!(files(folder.path())[0] == expected, "{behavior}");
        let (log, tasks) = (log.totals(), if behavior == Behavior::Reach { 1500 } else { 0 });
        assert_eq!(
            (log.tasks, log.successes, log.returns),
            (tasks, tasks, -1.5 * tasks as f64)
        );
        drop(TrainingLog::resume(&config(&folder, behavior)));
    }
}
