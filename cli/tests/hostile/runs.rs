//! Folders of runs, and the sound parts of cases.

use crate::bytes::{dict, list, pickle};
use crate::case::{Case, Content};

/// A configuration in which everything is quick.
pub const QUICK: &str = "behavior: self_touch\nscene: base\ntouch_active: false\nvision_active: false\nsave_dir: run\nmax_episode_steps: 3\n";

/// A training log of two episodes.
pub fn training() -> Vec<u8> {
    let record = |right: &[u8], left: &[u8]| {
        dict(&[
            ("right_hand_touches", &list(&[right])),
            ("left_hand_touches", &list(&[left])),
            ("steps", b"K\x0a"),
        ])
    };
    pickle(&list(&[&record(b"K\x05", b"K\x06"), &record(b"K\x07", b"K\x08")]))
}

/// Adds a sound training log.
pub fn run(case: Case) -> Case {
    case.file("run/logs/training.pkl", training())
}

/// A command with the quick configuration.
pub fn quick(name: impl Into<String>, call: &str) -> Case {
    Case::new(name, call).file("c.yml", QUICK)
}

pub fn cases() -> Vec<Case> {
    let base = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/></worldbody></mujoco>";
    let named = |name: &str, call: &str| Case::new(format!("run: {name}"), call);
    vec![
        named("folder that is not there", "score run"),
        named("report of a folder that is not there", "report run"),
        named("empty folder", "report run").file("run/a", ""),
        named("file for a folder", "score run").file("run", ""),
        named("report of a file", "report run").file("run", ""),
        named("name that is too long", &format!("score {}", "a".repeat(300))),
        named("path that is too long", &format!("report {}", "a/".repeat(2100))),
        named("evaluation as baseline", "report run --baseline other").file("run/logs/training.pkl", training()),
        named("page into a folder that is not there", "report run --out a/b.html")
            .file("run/logs/training.pkl", training()),
        named("page over a folder", "report run --out run").file("run/logs/training.pkl", training()),
        run(named("scene without MIMo", "score run")).file("run/scene.xml", base),
        run(named("report of a scene without MIMo", "report run")).file("run/scene.xml", base),
        run(named("configuration in the comment that is none", "report run"))
            .file("run/scene.xml", format!("<!--\nscene: \u{1b}[2Jbeach\n-->{base}")),
        run(named(
            "training into another run",
            "train --config c.yml --train-for 3 --quiet",
        ))
        .file(
            "c.yml",
            "behavior: none\nsave_dir: run\ntouch_active: false\nvision_active: false",
        ),
        run(quick(
            "run: resuming a scene without MIMo",
            "train --config c.yml --train-for 30 --resume --quiet",
        ))
        .file("run/scene.xml", base),
        run(quick(
            "run: evaluating a scene without MIMo",
            "evaluate --config c.yml --episodes 1 --duration 2 --no-render --quiet",
        ))
        .file("run/scene.xml", base),
        quick(
            "run: logs that are a file",
            "train --config c.yml --train-for 3 --quiet",
        )
        .file("run/logs", ""),
        quick(
            "run: scene that is a folder",
            "train --config c.yml --train-for 3 --quiet",
        )
        .file("run/scene.xml", Content::Folder),
        quick(
            "run: log that is a folder",
            "train --config c.yml --train-for 3 --quiet",
        )
        .file("run/logs/training.pkl", Content::Folder),
        quick(
            "run: resuming a log that is damaged",
            "train --config c.yml --train-for 3 --resume --quiet",
        )
        .file("run/logs/training.pkl", "\u{80}"),
        quick(
            "run: resuming a log of 1.2 MB of zeros",
            "train --config c.yml --train-for 3 --resume --quiet",
        )
        .file("run/logs/training.pkl", Content::Zeros(1_200_000)),
        quick(
            "run: save_dir that leads through a file",
            "train --config d.yml --train-for 3 --quiet",
        )
        .file("d.yml", QUICK.replace("save_dir: run", "save_dir: c.yml/run")),
        quick(
            "run: save_dir with a name that is too long",
            "train --config d.yml --train-for 3 --quiet",
        )
        .file(
            "d.yml",
            QUICK.replace("save_dir: run", &format!("save_dir: {}", "a".repeat(300))),
        ),
        quick(
            "run: save_dir that begins with a hyphen",
            "train --config d.yml --train-for 6 --quiet",
        )
        .file("d.yml", QUICK.replace("save_dir: run", "save_dir: -dash")),
    ]
}
