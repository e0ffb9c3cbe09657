//! Options, files and folders that are refused.

use super::*;

#[test]
fn wrong_options_say_what_is_expected() {
    let folder = Folder::new("options");
    let config = short_config(&folder);
    for (command, option, values, part) in [
        ("run", "--episodes", ["0", "-1", "many"], "whole number of at least 1"),
        ("run", "--steps", ["0", "-1", "1.5"], "whole number of at least 1"),
        (
            "run",
            "--seed",
            ["-1", "x", "99999999999999999999"],
            "whole number of at least 0",
        ),
        ("run", "--envs", ["0", "-1", "x"], "whole number of at least 1"),
        ("run", "--threads", ["0", "-1", "x"], "whole number of at least 1"),
        ("train", "--envs", ["0", "-1", "x"], "whole number of at least 1"),
        ("train", "--train-for", ["0", "-5", ""], "whole number of at least 1"),
        (
            "evaluate",
            "--episodes",
            ["0", "-1", "1e3"],
            "whole number of at least 1",
        ),
        ("evaluate", "--duration", ["0", "-1", "x"], "whole number of at least 1"),
        ("evaluate", "--jobs", ["0", "-1", "x"], "whole number of at least 1"),
        ("evaluate", "--fps", ["0", "-1", "1001"], "from 1 to 1000"),
        ("evaluate", "--policy-timeout", ["0", "-1", "inf"], "expected seconds"),
        ("render", "--size", ["0", "-4", "big"], "whole number of at least 1"),
        ("render", "--out", ["a.jpg", "a", "png"], "ends in .png, or in .svg"),
        ("inspect", "--touch", ["a.jpg", "a", "png"], "ends in .png"),
        (
            "replay",
            "--images-every",
            ["0", "-1", "x"],
            "whole number of at least 1",
        ),
    ] {
        for value in values {
            refused(
                folder.path(),
                &[command, "--config", &config, option, value],
                &[option, value, part],
            );
        }
    }
    refused(
        folder.path(),
        &["render", "--config", &config, "--camera", "eye", "--out", "a.png"],
        &["closeup, eye_left"],
    );
    refused(
        folder.path(),
        &["render", "--config", &config, "--size", "5000", "--out", "a.png"],
        &["1 to 4096"],
    );
    assert_eq!(contents(folder.path()).len(), 1, "nothing but the configuration");
}

#[test]
fn wrong_files_say_which_and_what_to_do() {
    let folder = Folder::new("files");
    let config = short_config(&folder);
    let dir = folder.path();
    folder.file("empty.yml", "save_dir: ''\n");
    let before = contents(dir);
    let config = ["--config", &config];
    let with = |command: &'static str, rest: &[&'static str]| [&[command][..], &config[..], rest].concat();
    refused(
        dir,
        &["run", "--config", "no.yml"],
        &["no.yml", "hint: check the spelling"],
    );
    refused(
        dir,
        &["run", "--config", "empty.yml"],
        &["empty.yml:1:11", "at least one character"],
    );
    refused(
        dir,
        &with("run", &["--assets", "none"]),
        &["--assets", "none", "babybench/*.xml"],
    );
    refused(
        dir,
        &with("render", &["--out", "none/a.png"]),
        &["none/a.png", "hint: check the spelling"],
    );
    assert_eq!(contents(dir), before, "nothing is left behind");
}

#[test]
fn wrong_recordings_and_folders_say_what_to_do() {
    let folder = Folder::new("recordings");
    let config = short_config(&folder);
    let dir = folder.path();
    folder.file("file", "neither a picture nor a recording");
    let blocked = Config {
        save_dir: "file".to_string(),
        ..short()
    };
    let blocked = folder.file("blocked.yml", blocked.to_yaml()).display().to_string();
    let before = contents(dir);
    let config = ["--config", &config];
    let with = |command: &'static str, rest: &[&'static str]| [&[command][..], &config[..], rest].concat();
    let state = ["--out", "a.png", "--state", "file"];
    refused(
        dir,
        &with("render", &state),
        &["file: not a readable npz", "truncated or of another format"],
    );
    refused(
        dir,
        &with("replay", &["--recording", "file", "--out", "r"]),
        &["file: not a readable npz"],
    );
    refused(
        dir,
        &with("replay", &["--recording", "no.npz", "--out", "r"]),
        &["no.npz", "hint:"],
    );
    for command in ["train", "evaluate"] {
        let parts = ["file", "hint: there is a file where a folder is needed"];
        refused(dir, &[command, "--config", &blocked], &parts);
    }
    for command in ["score", "report"] {
        refused(dir, &[command, "file"], &["this is a file", "save_dir"]);
    }
    assert_eq!(contents(dir), before, "nothing is left behind");
}
