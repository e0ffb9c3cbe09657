//! The command line where users go wrong: what it says, and what it leaves behind.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use std::path::Path;

use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::runs::logs::evaluation_path;
use babybench::runs::{
    EvaluationLog, SceneFileError, SceneFileStatus, keep_scene, read_config, read_scene, read_training, start_training,
};
use babybench::{Blueprint, Config, make_env};
use common::*;
use program::*;

/// Checks that the program fails without a panic and says all of `parts`.
fn refused(dir: &Path, arguments: &[&str], parts: &[&str]) {
    let out = babybench(dir, arguments);
    let said = text(&out);
    assert!(!out.status.success(), "{arguments:?} succeeds: {said}");
    assert!(
        out.stdout.is_empty() || arguments[0] == "evaluate",
        "{arguments:?}: {said}"
    );
    assert!(!said.contains("panicked"), "{arguments:?}: {said}");
    for part in parts {
        assert!(said.contains(part), "{arguments:?}: no {part:?} in {said}");
    }
}

/// Returns every file in a folder, with its contents.
fn contents(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut out = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                out.push((path.clone(), std::fs::read(&path).expect("a file")));
            }
        }
    }
    out.sort();
    out
}

#[test]
fn many_environments_at_once_say_how_fast_they_are() {
    let folder = Folder::new("many");
    let config = short_config(&folder);
    let run = |rest: &[&str]| {
        let out = babybench(
            folder.path(),
            &[&["run", "--config", &config, "--quiet"], rest].concat(),
        );
        (out.status.success(), text(&out))
    };
    let (done, said) = run(&["--envs", "3", "--threads", "2", "--episodes", "2", "--seed", "4"]);
    assert!(done, "{said}");
    for part in [
        "episode 0, environment 0: {",
        "episode 1, environment 2: {",
        "60 steps of 3 environments",
    ] {
        assert!(said.contains(part), "no {part:?} in {said}");
    }
    let lines: Vec<&str> = said.lines().filter(|l| !l.starts_with("peak memory")).collect();
    let speed = lines
        .last()
        .and_then(|l| l.strip_prefix("environment steps per second: "));
    assert!(speed.is_some_and(|v| v.parse::<u64>().is_ok_and(|v| v > 0)), "{said}");
    // the first environment is the one that runs alone
    let (_, alone) = run(&["--seed", "4"]);
    let info = |said: &str, start: &str| {
        let line = said.lines().find_map(|l| l.strip_prefix(start)).map(str::to_string);
        line.unwrap_or_else(|| panic!("no {start:?} in {said}"))
    };
    assert_eq!(info(&said, "episode 0, environment 0: "), info(&alone, "episode 0: "));

    let (_, said) = run(&["--envs", "2", "--threads", "1000"]);
    assert_eq!(said.matches("instead of 1000 threads").count(), 1, "{said}");
    refused(
        folder.path(),
        &["run", "--config", &config, "--envs", "1000000000"],
        &["1000000000 environments would take", "TiB of memory", "use at most"],
    );
    refused(
        folder.path(),
        &["run", "--config", &config, "--threads", "2"],
        &["--envs"],
    );
}

/// A noise moves him in a vector as alone, and far enough to touch himself.
#[test]
fn babbling_in_many_environments_is_that_of_one() {
    let folder = Folder::new("babbling");
    let touched = |name: &str, rest: &[&str]| {
        let keys = format!(
            "behavior: self_touch\nscene: crib\nvision_active: false\ntouch_active: false\nmax_episode_steps: 400\nsave_dir: {name}\n"
        );
        let config = folder.file(&format!("{name}.yml"), keys).display().to_string();
        let train = ["train", "--config", &config, "--train-for", "800", "--quiet", "--noise"];
        let out = babybench(folder.path(), &[&train[..], rest].concat());
        assert!(out.status.success(), "{}", text(&out));
        let records = read_training(folder.path().join(name)).expect("a log");
        let touches = records.iter().filter_map(|record| record.behavior.touches());
        touches.map(|hands| hands.map(<[usize]>::to_vec)).collect::<Vec<_>>()
    };
    let alone = touched("alone", &["held"]);
    assert_eq!(alone.len(), 2);
    assert!(alone.iter().all(|hands| !hands.concat().is_empty()), "{alone:?}");
    assert_eq!(touched("vector", &["held", "--envs", "1"]), alone);
    assert_ne!(touched("pink", &["pink"]), alone);
}

#[test]
fn a_training_in_many_environments_is_one_log_whatever_the_threads() {
    let log = |name: &str, rest: &[&str]| {
        let folder = Folder::new(name);
        let config = short_config(&folder);
        let train = ["train", "--config", &config, "--train-for", "47", "--quiet"];
        let out = babybench(folder.path(), &[&train[..], rest].concat());
        assert!(out.status.success(), "{}", text(&out));
        let logs = folder.path().join("run/logs");
        let files = ["training.pkl", "training.jsonl"].map(|f| std::fs::read(logs.join(f)).expect("a log"));
        let steps: Vec<u64> = read_training(folder.path().join("run"))
            .expect("a log")
            .iter()
            .map(|r| r.steps)
            .collect();
        (files, steps)
    };
    let alone = log("train_alone", &[]);
    assert_eq!(alone.1, [10, 10, 10, 10, 7]);
    assert!(
        log("train_one", &["--envs", "1"]) == alone,
        "one environment in a vector"
    );
    let one = log("train_three", &["--envs", "3", "--threads", "1"]);
    assert_eq!(one.1, [10, 10, 10, 6, 6, 5]);
    assert!(
        log("train_threads", &["--envs", "3", "--threads", "2"]) == one,
        "two threads"
    );
    for compat in ["api", "reference"] {
        let rest = ["--compat", compat];
        let one = log("train_compat", &rest);
        assert!(
            log("train_compat", &[&rest[..], &["--envs", "1"]].concat()) == one,
            "{compat}"
        );
    }
}

#[test]
fn an_evaluation_alone_has_its_scene() {
    let folder = Folder::new("alone");
    let config = short_config(&folder);
    let run = folder.path().join("run");
    let evaluate = |config: &str| -> Vec<String> {
        let rest = ["--episodes", "1", "--duration", "2", "--no-render", "--quiet"];
        [&["evaluate", "--config", config][..], &rest]
            .concat()
            .iter()
            .map(|s| s.to_string())
            .collect()
    };
    let call = |arguments: &[String]| {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let out = babybench(folder.path(), &arguments);
        assert!(out.status.success(), "{arguments:?}: {}", text(&out));
        text(&out)
    };
    call(&evaluate(&config));
    let scene = std::fs::read_to_string(run.join("scene.xml")).expect("the scene");
    assert_eq!(read_config(&scene).expect("the configuration"), short());
    assert!(read_scene(&run).is_ok_and(|m| m == **blueprint(short()).model()));
    assert_eq!(EvaluationLog::read(evaluation_path(&run, 0)).expect("a log").len(), 2);
    // the scene of a training is not touched, and nothing is mixed with what belongs to another scene or behavior
    let train = ["train", "--config", &config, "--train-for", "30", "--quiet"];
    assert!(babybench(folder.path(), &train).status.success());
    let other = |name: &str, change: fn(&mut Config)| {
        let mut config = short();
        change(&mut config);
        folder.file(name, config.to_yaml()).display().to_string()
    };
    let base = other("base.yml", |c| c.scene = Scene::Base);
    let none = other("none.yml", |c| c.behavior = Behavior::None);
    let before = contents(&run);
    let own = "save_dir";
    let refuse = |arguments: &[String], parts: &[&str]| {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        refused(folder.path(), &arguments, parts);
        assert_eq!(contents(&run), before, "{arguments:?} changed the run");
    };
    refuse(
        &evaluate(&base),
        &["scene.xml", "the scene crib with MIMo v1", "the scene base", own],
    );
    refuse(&evaluate(&none), &["training.pkl", "behavior self_touch", own]);
    let train = |config: &str| ["train", "--config", config].map(String::from).to_vec();
    refuse(&train(&none), &["training.pkl", "a run with behavior self_touch", own]);
    refuse(
        &[&train(&base)[..], &["--resume".to_string()]].concat(),
        &["the scene crib", own],
    );
    call(&evaluate(&config));
    let after = std::fs::read_to_string(run.join("scene.xml")).expect("the scene");
    assert_eq!(after, scene, "the training's");
    // one that does not load, as the kit's, stays too
    folder.file("run/scene.xml", "<mujoco><include file=\"/kit/mimo.xml\"/></mujoco>");
    assert!(call(&evaluate(&config)).contains("is left unchanged"));
    let after = std::fs::read_to_string(run.join("scene.xml")).expect("the scene");
    assert!(after.contains("/kit/mimo.xml"));
}

#[test]
fn scenes_are_kept_or_refused() {
    let folder = Folder::new("kept");
    let config = |scene: Scene, actuation_model: ActuationModel| Config {
        save_dir: folder.text(),
        actuation_model,
        ..free(Behavior::SelfTouch, scene)
    };
    let make = |scene, actuation| blueprint(config(scene, actuation));
    let keep = |blueprint: &Blueprint| keep_scene(blueprint);
    let motors = make(Scene::Crib, ActuationModel::SpringDamper);
    assert!(matches!(keep(&motors), Ok(SceneFileStatus::Written)));
    assert!(matches!(keep(&motors), Ok(SceneFileStatus::Same)));
    assert!(matches!(
        keep(&make(Scene::Crib, ActuationModel::Muscle)),
        Ok(SceneFileStatus::Same)
    ));
    let servos = make(Scene::Crib, ActuationModel::Positional);
    assert!(matches!(keep(&servos), Ok(SceneFileStatus::Similar)));
    let cubes = make(Scene::Cubes, ActuationModel::SpringDamper);
    assert!(matches!(keep(&cubes), Err(SceneFileError::Different { .. })));
    start_training(&motors, false).expect("a training");
    let resumed = start_training(&cubes, true);
    let error = resumed.expect_err("another scene");
    assert!(error.to_string().contains("the scene crib with MIMo v1"), "{error}");
    folder.file("scene.xml", "<mujoco>");
    assert!(matches!(keep(&motors), Ok(SceneFileStatus::Foreign(_))));
}

/// Ctrl-C.
#[test]
fn a_second_training_is_refused_while_the_first_goes_on() {
    let folder = Folder::new("two_trainings");
    let config = short_config(&folder);
    let first = make_env(
        Config {
            save_dir: folder.path().join("run").display().to_string(),
            ..short()
        },
        true,
    )
    .expect("a training");
    let train = ["train", "--config", &config, "--train-for", "20", "--quiet"];
    let owner = format!("process {} trains into this folder", std::process::id());
    refused(folder.path(), &train, &[&owner, "choose another save_dir"]);
    drop(first);
    assert!(works(folder.path(), &train).contains("20 steps"));
}

#[cfg(target_os = "linux")]
#[path = "command_line/interrupts.rs"]
mod interrupts;
#[path = "command_line/refused.rs"]
mod refused;

/// Runs the program in a folder, checks that it succeeds, and returns what it says.
fn works(dir: &Path, arguments: &[&str]) -> String {
    let out = babybench(dir, arguments);
    assert!(out.status.success(), "{arguments:?}: {}", text(&out));
    String::from_utf8_lossy(&out.stdout).into_owned()
}

#[test]
fn all_behaviors_and_actuation_models_run_from_the_command_line() {
    let folder = Folder::new("configurations");
    for &behavior in Behavior::ALL {
        for &kind in ActuationModel::ALL {
            let config = Config {
                actuation_model: kind,
                touch_active: behavior == Behavior::SelfBody, // it is about touch
                scene: match behavior {
                    // what they are about is in their scenes
                    Behavior::Mobile | Behavior::Play => Config::of(behavior).scene,
                    _ => Scene::Base,
                },
                ..free(behavior, Scene::Base)
            };
            if config.validate().is_err() {
                // tasks have no servos
                assert_eq!(kind, ActuationModel::Positional, "{behavior}");
                continue;
            }
            let path = folder.file(&format!("{behavior}_{kind}.yml"), config.to_yaml());
            let file = path.to_str().expect("a path of ours");
            let ran = works(folder.path(), &["run", "--quiet", "--steps", "5", "--config", file]);
            assert!(ran.contains("\"steps\": 5"), "{ran}");
            let inspected = works(folder.path(), &["inspect", "--config", file]);
            let env = env(config);
            for name in env.blueprint().actuation().action_names(env.model()) {
                assert!(inspected.contains(&name), "{name} is not explained");
            }
            for entry in env
                .senses()
                .proprioception()
                .entries(env.model(), env.blueprint().actuation())
            {
                let line = format!(
                    "{:4}..{:4} {:10} {}",
                    entry.range.start,
                    entry.range.end,
                    entry.component.name(),
                    entry.name
                );
                assert!(inspected.contains(&line), "{line:?} is not in the output");
            }
        }
    }
}

#[test]
fn examples_have_names() {
    let folder = Folder::new("example_names");
    for name in ["self_touch", "reach"] {
        let out = babybench(folder.path(), &["inspect", "--config", name]);
        assert!(out.status.success(), "{name}: {}", text(&out));
    }
    refused(folder.path(), &["inspect", "--config", "self_tuch"], &["self_tuch"]);
    // a file of that name comes first
    std::fs::write(folder.path().join("reach"), "behaviour: none").expect("a file");
    refused(folder.path(), &["inspect", "--config", "reach"], &["behaviour"]);
}
