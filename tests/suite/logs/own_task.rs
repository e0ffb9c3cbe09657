//! Logs of custom tasks.

use super::*;

/// A task of a program's own that does nothing.
#[derive(Clone, Debug)]
struct Wait(&'static str);

impl Task for Wait {
    fn name(&self) -> &str {
        self.0
    }
}

#[test]
fn a_task_of_ones_own_is_known_by_its_name() {
    let folder = Folder::new("own task");
    let of = |name| {
        Blueprint::with(
            config(&folder, Behavior::None, Compat::Api),
            BlueprintOptions::default().with_task(Wait(name)),
        )
        .expect("a scene")
    };
    let mut env = start_training(&of("wait"), false).expect("the folder can be made");
    for n in 1..=3 {
        episode(&mut env, n);
    }
    let info = env.info();
    let name = info.behavior.task().map(|info| &*info.task);
    assert_eq!((info.behavior.name(), name), ("wait", Some("wait")));
    let line = info.to_json();
    assert!(line.starts_with("{\"task\": \"wait\", \"is_success\": false"), "{line}");
    let read: Info = serde_json::from_str(&line).expect("information");
    assert_eq!(read.behavior, info.behavior);
    env.finish_training().expect("the log can be written");
    drop(env);

    let names = || -> Vec<String> {
        let records = read_training(folder.path()).expect("a log");
        records.iter().map(|r| r.behavior.name().to_string()).collect()
    };
    assert_eq!(names(), ["wait"; 3]);
    let lines = std::fs::read_to_string(training_path(folder.path()).with_extension("jsonl")).expect("lines");
    assert_eq!(lines.matches("{\"task\": \"wait\", ").count(), 3, "{lines}");
    let refused = start_training(&of("run"), true).expect_err("another task").to_string();
    assert!(refused.contains("its task is wait, not run"), "{refused}");
    let mut env = start_training(&of("wait"), true).expect("its own log");
    episode(&mut env, 2);
    env.finish_training().expect("the log can be written");
    assert_eq!(names(), ["wait"; 4]);
}

#[test]
fn a_log_holds_one_task_whose_name_can_be_shown() {
    let folder = Folder::new("names of tasks");
    let path = training_path(folder.path());
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("it can be made");
    let task = |name: &str| {
        let keys = [("is_success", Value::Bool(false)), ("is_failure", Value::Bool(false))];
        let numbers = [("return", Value::Float(0.5)), ("steps", Value::Int(1))];
        Value::dict(
            [("task", Value::Text(name.into()))]
                .into_iter()
                .chain(keys)
                .chain(numbers),
        )
    };
    let read = |names: [&str; 2]| {
        let log = Value::list(names.map(task));
        std::fs::write(&path, pickle::to_bytes(&log).expect("a pickle")).expect("a file");
        read_training(folder.path())
    };
    assert_eq!(read(["wait", "wait"]).expect("a log").len(), 2);
    let error = read(["wait", "run"]).expect_err("two tasks").to_string();
    assert!(
        error.contains("record 1 has a different behavior from record 0"),
        "{error}"
    );
    for name in ["\u{1b}[2J", "a\nb", &"long".repeat(51)] {
        let error = read([name, name]).expect_err(name).to_string();
        assert!(error.contains("`task` is not the name of a task"), "{error}");
    }
}
