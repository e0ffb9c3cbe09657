//! The command line as a program.
#![allow(dead_code)] // each test binary uses its part

use std::path::Path;
use std::process::{Command, Output};

use babybench::Config;
use babybench::config::{Behavior, Scene};

use crate::common::{Folder, free};

/// Returns the program, to be started in a folder.
pub fn program(dir: &Path, arguments: &[&str]) -> Command {
    std::fs::create_dir_all(dir).expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_babybench"));
    command.args(arguments).current_dir(dir);
    command
}

/// Runs the program in a folder.
pub fn babybench(dir: &Path, arguments: &[&str]) -> Output {
    program(dir, arguments).output().expect("the program runs")
}

/// Returns what a program said.
pub fn text(out: &Output) -> String {
    String::from_utf8_lossy(&[&out.stdout[..], &out.stderr[..]].concat()).into_owned()
}

/// Returns a configuration of self-touch in the crib with episodes of 10 steps, into the folder `run`.
pub fn short() -> Config {
    Config {
        save_dir: "run".to_string(),
        max_episode_steps: 10,
        save_logs_every: 1,
        ..free(Behavior::SelfTouch, Scene::Crib)
    }
}

/// Writes [`short`] as a file and returns its path.
pub fn short_config(folder: &Folder) -> String {
    folder.file("short.yml", short().to_yaml()).display().to_string()
}
