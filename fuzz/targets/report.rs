//! Logs from which a report is made: a folder with a training log and an evaluation log, which are separated by a zero byte, or records made
//! from numbers.
#![no_main]

#[path = "common/log.rs"]
mod log;

use std::path::PathBuf;
use std::sync::LazyLock;

use babybench::config::Compat;
use babybench::eval::Score;
use babybench::runs::logs::{evaluation_path, read_training, training_path};
use babybench_cli::report::Report;
use libfuzzer_sys::fuzz_target;

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let memory = PathBuf::from("/dev/shm");
    let parent = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let folder = parent.join(format!("babybench_fuzz_{}", std::process::id()));
    std::fs::create_dir_all(folder.join("logs")).expect("a folder");
    // without one, MIMo is built and drawn for each report, which hides the rest
    std::fs::write(folder.join("scene.xml"), "<mujoco/>").expect("a file");
    folder
});

fuzz_target!(|data: &[u8]| {
    let folder = &*FOLDER;
    let (training, evaluation) = match data.split_first() {
        Some((0, rest)) => (log::training(rest), Vec::new()),
        Some((1, rest)) => (Vec::new(), rest.to_vec()),
        _ => (data.to_vec(), Vec::new()),
    };
    std::fs::write(training_path(folder), &training).expect("a file");
    // most inputs have none: an empty file would be read, and refused, each time
    if evaluation.is_empty() {
        drop(std::fs::remove_file(evaluation_path(folder, 0)));
    } else {
        std::fs::write(evaluation_path(folder, 0), &evaluation).expect("a file");
    }
    if let Ok(records) = read_training(folder)
        && let Ok(score) = Score::new(&records, Compat::Api)
    {
        assert!((0.0..=1.0).contains(&score.value), "a score of {}", score.value);
        let _ = score.to_text(None);
    }
    match Report::new(folder) {
        Ok(report) => assert!(
            !report.html.contains("NaN") && !report.html.contains("<script"),
            "{}",
            report.html
        ),
        Err(e) => assert!(e.to_string().len() < 4000, "{e}"),
    }
});
