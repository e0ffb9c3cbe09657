//! Runs that are interrupted.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::*;

/// Starts the program, waits for a file to be written, sends the signal, and returns the exit code and what was
/// said.
fn interrupt(dir: &Path, arguments: &[&str], until: &Path, signal: &str) -> (Option<i32>, String) {
    let (before, started) = (std::fs::read(until).ok(), Instant::now());
    let mut child = with_signals(&program(dir, arguments))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    while std::fs::read(until).ok() == before && started.elapsed() < Duration::from_secs(120) {
        assert!(child.try_wait().expect("a status").is_none(), "it ended");
        std::thread::sleep(Duration::from_millis(20));
    }
    // the shell's own: a small system has no program `kill`
    let sent = Command::new("sh")
        .args(["-c", &format!("kill {signal} {}", child.id())])
        .status();
    assert!(sent.expect("the signal is sent").success());
    let out = child.wait_with_output().expect("it ends");
    (out.status.code(), text(&out))
}

/// The program as `nohup` would start it, which ignores hangups, with other signals as they are by default.
fn with_signals(program: &Command) -> Command {
    let mut command = Command::new("env");
    command
        .args(["--default-signal=INT,TERM", "--ignore-signal=HUP", "--"])
        .arg(program.get_program());
    command.args(program.get_args());
    if let Some(dir) = program.get_current_dir() {
        command.current_dir(dir);
    }
    command
}

#[test]
fn an_interrupted_training_keeps_every_step() {
    let folder = Folder::new("interrupt");
    let config = short_config(&folder);
    let run = folder.path().join("run");
    let log = run.join("logs/training.pkl");
    let arguments = [
        "train",
        "--config",
        &config,
        "--train-for",
        "100000000",
        "--resume",
        "--quiet",
    ];
    let mut before = 0;
    for signal in ["-INT", "-TERM"] {
        let (code, said) = interrupt(folder.path(), &arguments, &log, signal);
        assert_eq!(code, Some(130), "{said}");
        let records = read_training(&run).expect("a whole log");
        let steps: u64 = records.iter().map(|r| r.steps).sum();
        let told = format!("interrupted: {} records, {steps} of 100000000 steps", records.len());
        assert!(said.contains(&told) && said.contains("--resume"), "{told}: {said}");
        assert!(steps >= before);
        before = steps;
    }
}

#[test]
fn an_interrupted_evaluation_leaves_whole_files_only() {
    let folder = Folder::new("interrupt_evaluation");
    let config = short_config(&folder);
    let first = folder.path().join("run/videos/evaluation_0.avi");
    let arguments = [
        "evaluate",
        "--config",
        &config,
        "--episodes",
        "100000",
        "--quiet",
        "--jobs",
        "2",
    ];
    let (code, said) = interrupt(folder.path(), &arguments, &first, "-INT");
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("of 100000 episodes; their logs are complete"), "{said}");
    let files = contents(&folder.path().join("run"));
    let names = files.iter().map(|(path, _)| path.display().to_string());
    let unfinished: Vec<String> = names.filter(|n| n.contains(".tmp")).collect();
    assert!(unfinished.is_empty(), "{unfinished:?}");
}
