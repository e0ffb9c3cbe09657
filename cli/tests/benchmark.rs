//! Records, measures, benchmarks and submissions, from the command line.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use babybench::formats::npz::Npz;
use common::*;
use program::*;
use serde_json::Value;

/// Runs the program, which does what it is told, and returns what it said.
fn succeed(arguments: &[&str]) -> String {
    let out = babybench(&std::env::temp_dir(), arguments);
    assert!(out.status.success(), "{arguments:?}: {}", text(&out));
    String::from_utf8(out.stdout).expect("text")
}

/// Runs the program, which refuses, and returns what it said.
fn fail(arguments: &[&str]) -> String {
    let out = babybench(&std::env::temp_dir(), arguments);
    assert!(!out.status.success(), "{arguments:?}: {}", text(&out));
    text(&out)
}

/// A configuration of self-touch in short episodes.
fn config(folder: &Folder) -> String {
    let save_dir = folder.path().join("run").display().to_string();
    let text = format!(
        "behavior: self_touch\nscene: crib\nvision_active: False\nmax_episode_steps: 60\nsave_dir: {save_dir}\n"
    );
    folder.file("config.yml", text).display().to_string()
}

#[test]
fn runs_are_recorded_repeated_and_measured() {
    let folder = Folder::new("cli_record");
    let (config, record) = (config(&folder), folder.path().join("record").display().to_string());
    let out = succeed(&[
        "run",
        "--config",
        &config,
        "--noise",
        "held:0.1",
        "--episodes",
        "2",
        "--record",
        &record,
        "--quiet",
    ]);
    assert!(out.contains("babybench measure"), "{out}");
    let npz = Npz::open(folder.path().join("record/episode_1.npz")).expect("an archive");
    assert_eq!(npz.get_f64("time").expect("time").shape, [60]);
    let out = succeed(&["replay", "--recording", &record]);
    assert!(out.contains("episode 0: the same bits in all 60 steps"), "{out}");
    assert!(out.contains("episode 1: the same bits"), "{out}");
    let out = succeed(&["measure", &record]);
    assert!(
        out.contains("2 episodes, 120 steps") && out.contains("symmetry"),
        "{out}"
    );
    let json: Value = serde_json::from_str(&succeed(&["measure", &record, "--json", "--episode", "0"])).expect("JSON");
    assert_eq!(json["steps"], 60);
    // bands within what 100 frames a second show, and windows that fit 0.3 s
    let seen = [
        "measure",
        &record,
        "--movement",
        "--fps",
        "100",
        "--band",
        "1,50",
        "--window",
        "16",
    ];
    let out = succeed(&seen);
    assert!(
        out.contains("100 frames a second, band 1 to 50 Hz, window 16 frames"),
        "{out}"
    );
    assert!(out.contains("right_hand_speed") && out.contains("m/s"), "{out}");
    let json: Value = serde_json::from_str(&succeed(
        &[&seen[..], &["--json", "--jitter", "2", "--frame", "hip"]].concat(),
    ))
    .expect("JSON");
    assert_eq!(json["options"]["frame"], "hip");
    assert!(json["values"]["exponent"].is_number(), "{json}");
    let error = fail(&["measure", &record, "--movement", "--band", "1,20"]);
    assert!(
        error.contains("band is 1,20, expected two frequencies above 0"),
        "{error}"
    );
    let error = fail(&["measure", &record, "--fps", "25"]);
    assert!(error.contains("--movement"), "{error}");
    let error = fail(&["run", "--config", &config, "--record", &record, "--quiet"]);
    assert!(error.contains("this folder already has a record"), "{error}");
}

#[test]
fn many_environments_are_recorded_by_any_number_of_threads() {
    let mut found = Vec::new();
    for threads in ["1", "2"] {
        let folder = Folder::new("cli_record_many");
        let (config, record) = (config(&folder), folder.path().join("record").display().to_string());
        let many = ["--envs", "3", "--episodes", "2", "--threads", threads, "--seed", "4"];
        let out = succeed(&[&["run", "--config", &config, "--record", &record, "--quiet"][..], &many].concat());
        assert!(out.contains("babybench measure"), "{out}");
        let out = succeed(&["replay", "--recording", &record]);
        for episode in 0..6 {
            let said = format!("episode {episode}: the same bits in all 60 steps");
            assert!(out.contains(&said), "{out}");
        }
        let bytes =
            |k: usize| std::fs::read(folder.path().join(format!("record/episode_{k}.npz"))).expect("an archive");
        found.push([0, 1, 2, 3, 4, 5].map(bytes));
    }
    assert!(found[0] == found[1], "archives depend on the number of threads");
    assert!(found[0][0] != found[0][1] && found[0][0] != found[0][3]);
}

#[test]
fn evaluations_are_recorded_by_any_number_of_jobs() {
    let mut found = Vec::new();
    for jobs in ["1", "2"] {
        let folder = Folder::new("cli_record_jobs");
        let (config, record) = (config(&folder), folder.path().join("record").display().to_string());
        let args = [
            "evaluate",
            "--config",
            &config,
            "--policy",
            "held",
            "--episodes",
            "3",
            "--duration",
            "30",
        ];
        succeed(
            &[
                &args[..],
                &["--no-render", "--quiet", "--jobs", jobs, "--record", &record],
            ]
            .concat(),
        );
        let out = succeed(&["replay", "--recording", &record, "--episode", "2"]);
        assert!(out.contains("episode 2: the same bits in all 30 steps"), "{out}");
        let bytes =
            |k: usize| std::fs::read(folder.path().join(format!("record/episode_{k}.npz"))).expect("an archive");
        found.push([0, 1, 2].map(bytes));
    }
    assert!(found[0] == found[1], "archives depend on the number of jobs");
}

#[test]
fn benchmarks_resume_and_do_not_depend_on_jobs() {
    let folder = Folder::new("cli_benchmark");
    config(&folder);
    let plan = folder.path().join("plan.yml");
    let text = "name: Two noises\nconfigs: [config.yml]\nages: [none, 6]\npolicies: [held, pink]\nseeds: 2\nsteps: 130\nrecord: 1\n";
    std::fs::write(&plan, text).expect("a file");
    let plan = plan.display().to_string();
    let out = |name: &str| folder.path().join(name).display().to_string();
    let mut tables = Vec::new();
    for (name, jobs) in [("one", "1"), ("two", "2")] {
        let printed = succeed(&["benchmark", &plan, "--out", &out(name), "--jobs", jobs, "--quiet"]);
        assert!(
            printed.contains("# Two noises") && printed.contains("| `pink` | 6 |"),
            "{printed}"
        );
        let table = std::fs::read_to_string(folder.path().join(name).join("benchmark.md")).expect("a table");
        tables.push(table);
        let html = std::fs::read_to_string(folder.path().join(name).join("benchmark.html")).expect("a page");
        assert!(html.contains("<svg") && !html.contains("<script"));
    }
    assert_eq!(tables[0], tables[1]);
    let read = || std::fs::read_to_string(folder.path().join("one/benchmark.json")).expect("JSON");
    let before: Value = serde_json::from_str(&read()).expect("JSON");
    assert_eq!(before["rows"].as_array().map(Vec::len), Some(4));
    assert_eq!(before["runs"].as_array().map(Vec::len), Some(8));
    assert_eq!(before["runs"][0]["episodes"], 3);
    // what is there is not run again: times are those of before
    let gone = before["runs"][3]["name"].as_str().expect("a name");
    std::fs::remove_file(folder.path().join(format!("one/runs/{gone}.json"))).expect("a result");
    succeed(&["benchmark", &plan, "--out", &out("one"), "--quiet"]);
    let after: Value = serde_json::from_str(&read()).expect("JSON");
    for k in 0..8 {
        let of = |all: &Value| all["runs"][k].clone();
        if k != 3 {
            assert_eq!(of(&before), of(&after));
        }
        assert_eq!(of(&before)["measures"], of(&after)["measures"]);
    }
    std::fs::write(
        folder.path().join("bad.yml"),
        "configs: [config.yml]\npolicies: [held]\nsteps: none\n",
    )
    .expect("a file");
    let error = fail(&["benchmark", &out("bad.yml"), "--out", &out("bad")]);
    assert!(error.contains("bad.yml:3: `steps` is \"none\""), "{error}");
}

/// Goal babbling learns from one episode for the next, in a training and in a benchmark, and then does what it has learned.
#[test]
fn a_policy_that_learns_is_trained_and_then_settles() {
    let folder = Folder::new("cli_babbling");
    let save_dir = folder.path().join("run").display().to_string();
    let keys = format!(
        "behavior: self_touch\nscene: crib\nvision_active: false\ntouch_scale: 3\nmax_episode_steps: 400\nsave_dir: {save_dir}\n"
    );
    let config = folder.file("config.yml", keys).display().to_string();
    let train = ["train", "--config", &config, "--train-for", "2000", "--quiet"];
    let score = |policy: &[&str]| {
        succeed(&[&train[..], policy].concat());
        succeed(&["score", &save_dir])
    };
    assert_ne!(score(&["--policy", "babbling"]), score(&["--policy", "held"]));
    let error = fail(&[&train[..], &["--policy", "babbling", "--envs", "2"]].concat());
    assert!(error.contains("--envs"), "{error}");
    // what it had learned is in no log: it does not go on without it
    let error = fail(&[&train[..], &["--policy", "babbling", "--resume"]].concat());
    assert!(
        error.contains("had learned") && error.contains("without --resume"),
        "{error}"
    );
    succeed(&[&train[..], &["--policy", "held", "--resume"]].concat());

    let plan = folder.path().join("plan.yml");
    let text = "configs: [config.yml]\npolicies: [babbling]\nseeds: 2\nsteps: 2000\nrecord: 0\nevaluate: 2\n";
    std::fs::write(&plan, text).expect("a file");
    let (plan, out) = (
        plan.display().to_string(),
        folder.path().join("out").display().to_string(),
    );
    let printed = succeed(&["benchmark", &plan, "--out", &out, "--jobs", "2", "--quiet"]);
    assert!(
        printed.contains("parts per episode, evaluated") && printed.contains("evaluate: 2"),
        "{printed}"
    );
    let json = std::fs::read_to_string(folder.path().join("out/benchmark.json")).expect("JSON");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    for run in json["runs"].as_array().expect("runs") {
        assert!(
            run["evaluated_parts"].as_f64().is_some_and(|parts| parts > 0.0),
            "{run}"
        );
        assert_eq!(
            run["episodes"], 5,
            "episodes of the evaluation are not those of the training"
        );
    }
}

#[test]
fn submissions_are_checked_and_packed() {
    let folder = Folder::new("cli_pack");
    let config = config(&folder);
    let save_dir = folder.path().join("run").display().to_string();
    let archive = folder.path().join("submission.zip").display().to_string();
    let error = fail(&["pack", &save_dir, "--out", &archive]);
    assert!(error.contains("training.pkl"), "{error}");
    succeed(&["train", "--config", &config, "--train-for", "120", "--quiet"]);
    let error = fail(&["pack", &save_dir, "--out", &archive]);
    assert!(error.contains("10 evaluation episodes"), "{error}");
    let args = [
        "evaluate",
        "--config",
        &config,
        "--episodes",
        "10",
        "--duration",
        "5",
        "--no-render",
        "--quiet",
    ];
    succeed(&args);
    let pdf = folder.path().join("abstract.txt");
    std::fs::write(&pdf, "not a document").expect("a file");
    let error = fail(&[
        "pack",
        &save_dir,
        "--out",
        &archive,
        "--abstract",
        &pdf.display().to_string(),
    ]);
    assert!(error.contains("not a PDF document"), "{error}");
    std::fs::write(&pdf, "%PDF-1.7\n").expect("a file");
    let out = succeed(&[
        "pack",
        &save_dir,
        "--out",
        &archive,
        "--abstract",
        &pdf.display().to_string(),
    ]);
    assert!(
        out.contains("12 files") && out.contains("logs/evaluation_9.pkl"),
        "{out}"
    );
    assert!(std::fs::read(&archive).expect("an archive").starts_with(b"PK"));
}
