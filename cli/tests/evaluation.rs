//! Scenes written beside logs, evaluation episodes and the command line from a run to a result.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use babybench::config::{ActuationModel, Behavior, Compat, Config, Scene};
use babybench::eval::{EpisodeError, Evaluation, Film, FilmError, Plan, run_episodes};
use babybench::mimo::{build_model, embedded};
use babybench::policy::{Policy, PolicyError, RandomPolicy};
use babybench::runs::logs::evaluation_path;
use babybench::runs::{EvaluationLog, read_config, read_scene, read_training, write_scene};
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Env};
use common::*;
use program::*;
use serde_json::Value;

#[test]
fn a_written_scene_loads_to_the_same_model() {
    let folder = Folder::new("scene");
    for (behavior, scene) in MODELS {
        for actuation_model in [ActuationModel::SpringDamper, ActuationModel::Positional] {
            let config = Config {
                actuation_model,
                save_dir: "results/--odd -- \"name\"/é--->".to_string(),
                ..free(behavior, scene.clone())
            };
            let path = write_scene(&config, folder.path()).expect("the folder can be made");
            let model = read_scene(folder.path()).expect("the scene loads");
            let direct = build_model(&config, &embedded()).expect("the scene loads");
            assert!(model == direct, "{behavior} in {scene}, {actuation_model}");
            let xml = std::fs::read_to_string(path).expect("the scene");
            assert_eq!(read_config(&xml).expect("the configuration"), config);
        }
    }
    let missing = read_scene(Path::new("no/such/folder"))
        .expect_err("no folder")
        .to_string();
    assert!(missing.contains("no/such/folder"), "{missing}");
}

fn plan(episodes: u64, jobs: usize) -> Plan {
    Plan {
        episodes,
        duration: 25,
        render: false,
        fps: 60,
        jobs,
    }
}

fn crib(folder: &Folder) -> Blueprint {
    let save_dir = folder.text();
    blueprint(Config {
        save_dir,
        ..free(Behavior::SelfTouch, Scene::Crib)
    })
}

fn random() -> Result<Box<dyn Policy>, PolicyError> {
    Ok(Box::new(RandomPolicy))
}

#[test]
fn episodes_do_not_depend_on_the_number_of_jobs() {
    let folder = Folder::new("jobs");
    let blueprint = crib(&folder);
    let mut all = Vec::new();
    for jobs in [1, 3] {
        let infos = run_episodes(&blueprint, &plan(5, jobs), &random, &|| ControlFlow::Continue(())).expect("episodes");
        let logs = (0..5).map(|k| EvaluationLog::read(evaluation_path(folder.path(), k)).expect("a log"));
        let logs: Vec<EvaluationLog> = logs.collect();
        for (log, info) in logs.iter().zip(&infos) {
            let last = log.info.last().expect("a step");
            assert_eq!((last.steps, &last.behavior), (info.steps, &info.behavior));
        }
        assert_eq!(infos.len(), 5);
        all.push(logs);
    }
    assert_eq!(all[0], all[1]);
    assert_ne!(all[0][0], all[0][1], "episodes differ");
    let config = Config {
        compat: Compat::Reference,
        ..blueprint.config().clone()
    };
    let refused = run_episodes(&Blueprint::new(config).expect("a scene"), &plan(2, 2), &random, &|| {
        ControlFlow::Continue(())
    });
    assert!(matches!(refused, Err(EpisodeError::Jobs)));
}

/// Counts frames.
struct Count<'c>(&'c mut Vec<String>);

impl Film for Count<'_> {
    fn frame(&mut self, env: &Env) -> Result<(), FilmError> {
        self.0.push(env.info().steps.to_string());
        Ok(())
    }

    fn end(&mut self, path: &Path) -> Result<(), FilmError> {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        self.0.push(name);
        Ok(())
    }

    fn discard(&mut self) {
        self.0.clear();
    }
}

#[test]
fn films_get_a_frame_for_each_step() {
    let folder = Folder::new("film");
    let mut env = crib(&folder).env().expect("an environment");
    let mut frames = Vec::new();
    let mut evaluation = Evaluation::new(&env).with_film(Count(&mut frames));
    env.reset(Some(0)).expect("no divergence");
    for _ in 0..3 {
        random_steps(&mut env, 1);
        evaluation.eval_step(&env).expect("a frame");
    }
    evaluation.end(4).expect("a log");
    let empty = evaluation.end(5).expect_err("no steps").to_string();
    assert!(empty.contains("call eval_step"), "{empty}");
    drop(evaluation);
    assert_eq!(frames, ["1", "2", "3", "evaluation_4.avi"]);
}

#[test]
fn the_installation_test_passes() {
    let folder = Folder::new("installation");
    let out = babybench(folder.path(), &["test-installation"]);
    println!("{}", text(&out));
    assert!(out.status.success());
    assert!(text(&out).contains("Installation test successful!"));
    let results = folder.path().join("results/test_installation");
    for file in ["scene.xml", "logs/training.pkl", "videos/test_installation.avi"] {
        assert!(results.join(file).metadata().is_ok_and(|m| m.len() > 0), "{file}");
    }
    let blocked = folder.path().join("file");
    std::fs::write(&blocked, "").expect("a file");
    let out = babybench(folder.path(), &["test-installation", "--save-dir", "file"]);
    assert!(!out.status.success());
    assert!(text(&out).contains("choose one with --save-dir"), "{}", text(&out));
}

#[test]
fn from_a_run_to_a_result() {
    let folder = Folder::new("story");
    let config = short_config(&folder);
    let run = |arguments: &[&str]| {
        let out = babybench(folder.path(), arguments);
        println!("{}", text(&out));
        assert!(out.status.success(), "{arguments:?}");
        text(&out)
    };
    run(&["train", "--config", &config, "--train-for", "200", "--quiet"]);
    assert_eq!(read_training(folder.path().join("run")).expect("a log").len(), 20);
    let more = run(&[
        "train",
        "--config",
        &config,
        "--train-for",
        "300",
        "--resume",
        "--quiet",
    ]);
    assert!(more.contains("resuming after 20 episodes, 200 steps"));
    assert_eq!(read_training(folder.path().join("run")).expect("a log").len(), 30);
    assert!(run(&["score", "run"]).contains("of which 31 can be reached"));
    let score = run(&["score", "run", "--json"]);
    assert!(score.starts_with("{\"behavior\": \"self_touch\", \"score\": "));
    assert!(serde_json::from_str::<Value>(&score).is_ok_and(|s| s["right_hand"]["parts"] == 34));
    let evaluate = [
        "evaluate",
        "--config",
        &config,
        "--episodes",
        "2",
        "--duration",
        "3",
        "--quiet",
    ];
    assert_eq!(episodes(&run(&evaluate)), 2);
    let steps = run(&["run", "--config", &config, "--episodes", "3", "--quiet"]);
    assert_eq!(episodes(&steps), 3);
    let written = run(&["report", "run"]);
    assert!(
        written.contains("run/report.html") && !written.contains("note:"),
        "{written}"
    );
    let page = std::fs::read_to_string(folder.path().join("run/report.html")).expect("a page");
    assert!(page.contains("Self-touch in the crib") && page.ends_with("</html>"));
    for k in 0..2 {
        assert_eq!(
            EvaluationLog::read(evaluation_path(folder.path().join("run"), k))
                .expect("a log")
                .len(),
            3
        );
        let video = folder.path().join(format!("run/videos/evaluation_{k}.avi"));
        assert!(video.metadata().is_ok_and(|m| m.len() > 10_000));
    }
    refuses_what_is_not_there(&folder, &config);
    let again = run(&["train", "--config", &config, "--train-for", "10", "--quiet"]);
    assert!(again.contains("replacing the training log of 30 records"), "{again}");
}

/// Reads the information of each episode in what a command prints, and returns how many there are.
fn episodes(said: &str) -> usize {
    let lines = said.lines().filter_map(|l| l.strip_prefix("episode "));
    lines
        .map(|line| {
            let (_, info) = line.split_once(": ").expect("an episode's information");
            let info: Value = serde_json::from_str(info).expect("JSON");
            assert!(info["steps"].is_u64(), "{info}");
        })
        .count()
}

/// Checks what is said about folders, files and programs that do not exist.
fn refuses_what_is_not_there(folder: &Folder, config: &str) {
    let refused = |arguments: &[&str], part: &str| {
        let out = babybench(folder.path(), arguments);
        assert!(!out.status.success(), "{arguments:?}");
        assert!(text(&out).contains(part), "{arguments:?}: {}", text(&out));
    };
    refused(&["score", "elsewhere"], "train into this save_dir first");
    refused(&["report", "elsewhere"], "no such folder");
    refused(
        &["report", "run", "--out", "no/such/folder/a.html"],
        "no/such/folder/a.html",
    );
    refused(
        &["evaluate", "--config", config, "--policy", "no-such-program"],
        "cannot start",
    );
    refused(
        &["evaluate", "--config", config, "--policy-timeout", "0"],
        "expected seconds",
    );
}

#[test]
fn a_closed_pipe_ends_a_command_quietly() {
    let folder = Folder::new("pipe");
    let config = short_config(&folder);
    let picture = folder.path().join("picture.png").display().to_string();
    let train = ["train", "--config", &config, "--train-for", "30", "--quiet"];
    assert!(babybench(folder.path(), &train).status.success());
    let commands: [&[&str]; 9] = [
        &["test-installation"],
        &["run", "--config", &config, "--steps", "3", "--quiet"],
        &["run", "--config", &config, "--steps", "3"],
        &["inspect", "--config", &config],
        &["render", "--config", &config, "--size", "16", "--out", &picture],
        &["score", "run"],
        &["score", "run", "--json"],
        &[
            "evaluate",
            "--config",
            &config,
            "--episodes",
            "1",
            "--duration",
            "2",
            "--no-render",
            "--quiet",
        ],
        &["report", "run"],
    ];
    for arguments in commands.into_iter().chain([&train[..]]) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_babybench"))
            .args(arguments)
            .current_dir(folder.path())
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("the program runs");
        drop(child.stdout.take());
        let out = child.wait_with_output().expect("it ends");
        let said = text(&out);
        assert!(out.status.success(), "{arguments:?}: {said}");
        let plain = |l: &str| l.starts_with("warning:") || l.starts_with("note:");
        assert!(said.lines().all(plain), "{arguments:?}: {said}");
    }
}

/// Waits for what a program does, however slow the machine is.
fn wait_until(what: &str, done: impl Fn() -> bool) {
    let since = Instant::now();
    while !done() {
        assert!(since.elapsed() < Duration::from_secs(300), "never: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_killed_run_leaves_a_readable_log() {
    let folder = Folder::new("kill");
    let config = short_config(&folder);
    let mut rng = NumpyRng::seed(3);
    let path = folder.path().join("run/logs/training.pkl");
    let size = || std::fs::metadata(&path).map_or(0, |file| file.len());
    let (mut found, mut most) = (0, 0);
    for round in 0..20 {
        let before = size();
        let mut child = Command::new(env!("CARGO_BIN_EXE_babybench"))
            .args([
                "train",
                "--config",
                &config,
                "--train-for",
                "1000000",
                "--resume",
                "--quiet",
            ])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("the program runs");
        // one half is killed at some moment of its start, the other after it has written
        if round % 2 == 1 {
            wait_until("the log grows", || size() > before);
        }
        std::thread::sleep(Duration::from_millis((rng.uniform() * 200.0) as u64));
        child.kill().expect("it still runs");
        child.wait().expect("it ends");
        if path.exists() {
            let records = read_training(folder.path().join("run")).expect("a whole log");
            assert!(records.len() >= most, "episodes were lost");
            most = records.len();
            found += 1;
        }
    }
    println!("{found} of 20 killed runs had begun to log; {most} episodes in the end");
    assert!(found >= 10 && most >= 10);
}

#[test]
fn a_killed_evaluation_leaves_whole_logs_and_videos() {
    let folder = Folder::new("kill_evaluation");
    let config = short_config(&folder);
    let mut rng = NumpyRng::seed(4);
    let mut found = 0;
    let run = folder.path().join("run");
    for round in 0..8 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_babybench"))
            .args([
                "evaluate",
                "--config",
                &config,
                "--episodes",
                "1000",
                "--duration",
                "1",
                "--quiet",
            ])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("the program runs");
        if round == 0 {
            wait_until("an episode has ended", || evaluation_path(&run, 0).exists());
        }
        std::thread::sleep(Duration::from_millis((rng.uniform() * 600.0) as u64));
        child.kill().expect("it still runs");
        child.wait().expect("it ends");
        for k in 0..1000 {
            let path = evaluation_path(&run, k);
            if path.exists() {
                assert_eq!(EvaluationLog::read(&path).expect("a whole log").len(), 1);
                found += 1;
            }
            let video = run.join(format!("videos/evaluation_{k}.avi"));
            if video.exists() {
                let bytes = std::fs::read(&video).expect("a video");
                let size = u32::from_le_bytes(bytes[4..8].try_into().expect("a size"));
                assert_eq!(size as usize + 8, bytes.len(), "a whole video");
            }
        }
    }
    println!("{found} logs were whole");
    assert!(found > 0);
}
