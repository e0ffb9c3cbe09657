//! Logs that are missing, damaged, or lead elsewhere.

use super::*;

#[test]
fn bad_logs_say_what_to_do() {
    let folder = Folder::new("bad");
    let error = |what: &str| {
        let error = eval_logs(folder.path()).expect_err(what).to_string();
        println!("{error}");
        error
    };
    assert!(error("no log").contains("train into this save_dir first"));
    let path = training_path(folder.path());
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    std::fs::write(&path, b"hello").expect("a file");
    assert!(error("text").contains("not a pickle"));
    TrainingLog::create(&config(&folder, Behavior::SelfTouch, Compat::Api)).expect("a log");
    assert!(error("no records").contains("train for at least two episodes"));
    let mut env = make_env(config(&folder, Behavior::SelfTouch, Compat::Api), true).expect("an environment");
    episode(&mut env, 2);
    env.finish_training().expect("the log can be written");
    let whole = std::fs::read(&path).expect("a log");
    for n in 0..whole.len() {
        std::fs::write(&path, &whole[..n]).expect("a file");
        assert!(
            matches!(read_training(folder.path()), Err(LogError::Pickle { .. })),
            "{n} bytes"
        );
    }
    let mut log = EvaluationLog::default();
    log.push(&[0.0], &Info::default());
    let evaluation = log.write(folder.path(), 0).expect("a log");
    std::fs::copy(&evaluation, &path).expect("a file");
    assert!(error("an evaluation's").contains("log of an evaluation episode"));
    let none = [Info {
        steps: 5,
        behavior: BehaviorInfo::None,
        ..Info::default()
    }];
    assert_eq!(Score::new(&none, Compat::Api), Err(ScoreError::NoBehavior));
    assert_eq!(Score::new(&[], Compat::Api), Err(ScoreError::Empty));
    let regard = |steps| Info {
        steps,
        behavior: BehaviorInfo::HandRegard {
            counts: [0, 0, 0, 0].into(),
        },
        ..Info::default()
    };
    assert_eq!(
        Score::new(&[regard(5)], Compat::Reference),
        Err(ScoreError::NoSteps { records: 1 })
    );
    assert_eq!(
        Score::new(&[regard(5), regard(0)], Compat::Reference),
        Err(ScoreError::NoSteps { records: 2 })
    );
}

#[test]
fn limits_of_logs_are_the_callers() {
    let folder = Folder::new("limits");
    let mut env = make_env(config(&folder, Behavior::SelfTouch, Compat::Api), true).expect("the folder can be made");
    env.reset(None).expect("no divergence");
    held_steps(env.env_mut(), 3000, 30);
    env.finish_training().expect("the log can be written");
    let path = training_path(folder.path());
    let touched = env.info().behavior.touches().expect("self_touch").map(<[_]>::len);
    assert!(touched.iter().any(|&n| n > 0), "nothing was touched");
    let told = |limits: &Limits| read_records_with(&path, limits).expect_err("a limit").to_string();
    let few = told(&Limits {
        record_touches: 0,
        ..Limits::default()
    });
    assert!(few.contains("is not a list of at most 0 geom ids"), "{few}");
    let short = told(&Limits {
        pickle_bytes: 10,
        ..Limits::default()
    });
    assert!(short.contains("more than 10 bytes"), "{short}");
    assert_eq!(read_records_with(&path, &Limits::default()).expect("a log").len(), 1);
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder_of_a_run() {
    use std::os::unix::fs::symlink;
    let (ours, theirs) = (Folder::new("links_ours"), Folder::new("links_theirs"));
    let train = |folder: &Folder| {
        let config = config(folder, Behavior::SelfTouch, Compat::Api);
        let mut log = TrainingLog::create(&config).expect("a log");
        log.end_episode(3, &BehaviorInfo::default()).expect("a record");
        log.save().expect("the log can be written");
        config
    };
    let config = train(&ours);
    train(&theirs);
    let (mine, others) = (training_path(ours.path()), training_path(theirs.path()));
    let out = |result: Result<(), LogError>| matches!(result, Err(LogError::Outside { .. }));
    // within the folder a link may lead where it wants
    let moved = ours.path().join("moved.pkl");
    std::fs::rename(&mine, &moved).expect("it can be moved");
    symlink(&moved, &mine).expect("a link");
    assert_eq!(read_training(ours.path()).expect("a log").len(), 1);
    // a file of another folder
    std::fs::remove_file(&mine).expect("a link");
    symlink(&others, &mine).expect("a link");
    assert!(out(read_training(ours.path()).map(drop)));
    assert!(out(TrainingLog::resume(&config).map(drop)));
    std::fs::remove_file(&mine).expect("a link");
    std::fs::rename(&moved, &mine).expect("it can be moved");
    // the lines beside it
    let (lines, their_lines) = (mine.with_extension("jsonl"), others.with_extension("jsonl"));
    std::fs::remove_file(&lines).expect("the lines");
    symlink(&their_lines, &lines).expect("a link");
    assert!(out(TrainingLog::resume(&config).map(drop)));
    // the whole folder: nothing is written there either
    std::fs::remove_dir_all(ours.path().join("logs")).expect("the logs");
    symlink(theirs.path().join("logs"), ours.path().join("logs")).expect("a link");
    assert!(out(read_training(ours.path()).map(drop)));
    assert!(out(TrainingLog::create(&config).map(drop)));
    assert_eq!(read_training(theirs.path()).expect("a log").len(), 1);
}

#[test]
fn a_log_of_which_only_the_lines_are_left_is_not_replaced_in_silence() {
    let folder = Folder::new("lost");
    let config = config(&folder, Behavior::SelfTouch, Compat::Api);
    let mut log = TrainingLog::create(&config).expect("a log");
    let path = training_path(folder.path());
    log.end_episode(3, &BehaviorInfo::default()).expect("a record");
    log.save().expect("the log can be written");
    drop(log);
    std::fs::remove_file(&path).expect("the log");
    let error = TrainingLog::resume(&config)
        .expect_err("records would be lost")
        .to_string();
    assert!(
        error.contains(
            "training.pkl: no training log of BabyBench: it is missing, but training.jsonl beside it has records"
        ),
        "{error}"
    );
    std::fs::remove_file(path.with_extension("jsonl")).expect("the lines");
    assert_eq!(TrainingLog::resume(&config).expect("a new log").totals().records, 0);
}
