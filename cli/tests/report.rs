//! The page about a run: what is on it, for whole and for partial runs.

#[path = "../../tests/common/mod.rs"]
mod common;

use std::ops::ControlFlow;
use std::path::Path;

use babybench::Blueprint;
use babybench::config::{Behavior, Config, Scene};
use babybench::env::{BlueprintOptions, Task};
use babybench::eval::{Plan, run_episodes};
use babybench::policy::PolicySource;
use babybench::runs::logs::training_path;
use babybench::runs::start_training;
use babybench_cli::report::{Report, ReportError};
use common::*;

const BEHAVIORS: [Behavior; 2] = [Behavior::SelfTouch, Behavior::HandRegard];

/// A run of a behavior: `training` episodes, then `evaluation` ones.
fn run(folder: &Folder, behavior: Behavior, training: u64, evaluation: u64, render: bool) {
    let scene = match behavior {
        Behavior::HandRegard => Scene::Cubes,
        _ => Scene::Crib,
    };
    let config = Config {
        save_dir: folder.text(),
        max_episode_steps: 40,
        ..free(behavior, scene.clone())
    };
    let blueprint = blueprint(config);
    if training > 0 {
        let mut env = start_training(&blueprint, false).expect("a folder");
        for _ in 0..training {
            env.reset(None).expect("no divergence");
            held_steps(env.env_mut(), 40, 20);
        }
        env.finish_training().expect("a log");
    }
    let plan = Plan {
        episodes: evaluation,
        duration: if render { 12 } else { 30 },
        render,
        fps: 60,
        jobs: 1,
    };
    let limit = std::time::Duration::from_secs(1);
    run_episodes(&blueprint, &plan, &|| PolicySource::Random.open(limit), &|| {
        ControlFlow::Continue(())
    })
    .expect("episodes");
}

fn report(folder: &Folder) -> Report {
    let report = Report::new(folder.path()).expect("a report");
    println!("{} bytes, notices: {:?}", report.html.len(), report.notices);
    check_page(&report.html);
    report
}

/// The page is whole, needs nothing from outside, and runs nothing.
fn check_page(html: &str) {
    assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>"));
    let policy = "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\"";
    assert!(html.contains(policy), "nothing keeps the page from running scripts");
    for source in html.split(" src=\"").skip(1) {
        assert!(source.starts_with("data:image/"), "{}", &source[..40]);
    }
    // without the letters of the images, which may say anything
    let plain: String = html
        .split("data:image/")
        .enumerate()
        .map(|(k, part)| {
            if k == 0 {
                part
            } else {
                &part[part.find('"').expect("an end")..]
            }
        })
        .collect();
    let html = &plain;
    for outside in [
        "<script", "<link", "<iframe", "http:", "https:", "@import", "url(", " onload", "NaN", "inf\"",
    ] {
        assert!(!html.contains(outside), "the page has {outside}");
    }
    for tag in [
        "html", "head", "body", "main", "section", "figure", "table", "svg", "div", "p", "g", "details",
    ] {
        let (open, close) = (
            html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count(),
            format!("</{tag}>"),
        );
        assert_eq!(open, html.matches(&close).count(), "<{tag}>");
    }
}

fn count(report: &Report, what: &str) -> usize {
    report.html.matches(what).count()
}

#[test]
fn a_whole_run_has_everything() {
    for behavior in BEHAVIORS {
        let folder = Folder::new("report_whole");
        run(&folder, behavior, 4, 2, true);
        let report = report(&folder);
        assert_eq!(report.notices, [""; 0], "{behavior}");
        for title in [
            "Preliminary training score",
            "Learning curve",
            "Evaluation",
            "Configuration",
        ] {
            assert!(report.html.contains(title), "{behavior}: {title}");
        }
        assert_eq!(count(&report, "data:image/jpeg"), 8, "{behavior}: key frames");
        let (dolls, charts) = if behavior == Behavior::SelfTouch {
            (4, 1)
        } else {
            (0, 3)
        };
        assert_eq!(count(&report, "data:image/png"), dolls, "{behavior}");
        assert_eq!(count(&report, "<svg"), charts, "{behavior}");
    }
}

#[test]
fn partial_runs_have_what_there_is() {
    for behavior in BEHAVIORS {
        let folder = Folder::new("report_training");
        run(&folder, behavior, 3, 0, false);
        let training = report(&folder);
        assert!(
            training.notices.iter().any(|n| n.contains("No evaluation yet")),
            "{:?}",
            training.notices
        );
        assert!(training.html.contains("Learning curve") && !training.html.contains("<h2>Evaluation"));

        let folder = Folder::new("report_evaluation");
        run(&folder, behavior, 0, 2, false);
        let evaluation = report(&folder);
        for part in ["No training log", "No video"] {
            assert!(
                evaluation.notices.iter().any(|n| n.contains(part)),
                "{:?}",
                evaluation.notices
            );
        }
        assert!(evaluation.html.contains("<h2>Evaluation") && !evaluation.html.contains("Learning curve"));
        let about = if behavior == Behavior::SelfTouch {
            "What the hands touched"
        } else {
            "Where the eyes saw the hands"
        };
        assert!(evaluation.html.contains(about), "{about}");
    }
    // one episode has no score, and a video may be of another program
    let folder = Folder::new("report_video");
    run(&folder, Behavior::SelfTouch, 1, 0, false);
    run(&folder, Behavior::SelfTouch, 0, 1, false);
    for (video, part) in [
        ("RIFF----AVI nothing in it", "the video has no frames"),
        ("RIFF----AVI LIST", "the video has no frames"),
        ("RIFF", "not an .avi file"),
    ] {
        folder.file("videos/evaluation_0.avi", video);
        let notices = report(&folder).notices;
        assert!(notices.iter().any(|n| n.contains(part)), "{part}: {notices:?}");
    }
    // parts have names where the scene does not load
    folder.file("scene.xml", "<mujoco>");
    let report = report(&folder);
    let told = |n: &String| n.contains("cannot be loaded") && n.contains("scene.xml");
    assert!(report.notices.iter().any(told), "{:?}", report.notices);
}

#[test]
fn a_folder_that_is_no_run_is_an_error() {
    let folder = Folder::new("report_foreign");
    let error = |what: &str| Report::new(folder.path()).expect_err(what).to_string();
    assert!(matches!(Report::new(folder.path()), Err(ReportError::Missing { .. })));
    assert!(error("no folder").contains("no such folder"));
    folder.file("notes.txt", "nothing of a run");
    println!("{}", error("no logs"));
    assert!(matches!(Report::new(folder.path()), Err(ReportError::NoRun { .. })));
    folder.file("logs/training.pkl", "no pickle");
    println!("{}", error("a broken log"));
    assert!(matches!(
        Report::new(folder.path()),
        Err(ReportError::Unreadable { .. })
    ));
    assert!(error("a broken log").contains("training.pkl"));
    let file = folder.file("file", "");
    assert!(matches!(Report::new(&file), Err(ReportError::Missing { .. })));
    let error = Report::new(&file).expect_err("a file").to_string();
    assert!(error.contains("this is a file, not a folder"), "{error}");
}

#[test]
fn damaged_logs_beside_whole_ones_are_told() {
    let folder = Folder::new("report_damaged");
    run(&folder, Behavior::SelfTouch, 2, 2, false);
    let path = training_path(folder.path());
    let whole = std::fs::read(&path).expect("a log");
    std::fs::write(&path, &whole[..whole.len() / 2]).expect("a file");
    let report = report(&folder);
    assert!(
        report.notices.iter().any(|n| n.contains("training.pkl")),
        "{:?}",
        report.notices
    );
    assert!(report.html.contains("<h2>Evaluation"));
}

#[test]
fn what_comes_from_files_is_escaped() {
    let folder = Folder::new("report_<b>&\"x");
    run(&folder, Behavior::SelfTouch, 2, 0, false);
    let report = report(&folder);
    assert!(
        report.html.contains("report_&lt;b&gt;&amp;"),
        "the folder's name is shown"
    );
    assert!(!report.html.contains("report_<b>"));
}

#[test]
fn logs_of_the_kit_have_a_report_too() {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../conformance/data/logs");
    for (log, about) in [
        ("self_touch_crib_random.pkl", "What the hands touched"),
        ("hand_regard_cubes_random.pkl", "right eye, right hand"),
    ] {
        let folder = Folder::new("report_kit");
        std::fs::create_dir_all(folder.path().join("logs")).expect("a folder");
        std::fs::copy(golden.join(log), training_path(folder.path())).expect("a copy");
        let report = report(&folder);
        assert!(
            report.html.contains(about) && report.html.contains("Learning curve"),
            "{log}"
        );
    }
}

#[test]
fn another_training_can_stand_beside_the_learning_curve() {
    let [own, random, other] = ["own", "random", "other"].map(Folder::new);
    run(&own, Behavior::SelfTouch, 6, 0, false);
    run(&random, Behavior::SelfTouch, 4, 0, false);
    run(&other, Behavior::HandRegard, 2, 0, false);
    assert!(!report(&own).html.contains("line base"));
    let page = Report::with_baseline(own.path(), random.path())
        .expect("two trainings")
        .html;
    check_page(&page);
    let name = random.path().file_name().expect("a name").to_string_lossy();
    assert!(page.contains(&format!("{name}: moving mean")), "the baseline is named");
    let path = page.split("line base\" d=\"").nth(1).and_then(|d| d.split('"').next());
    assert_eq!(path.map(|d| d.matches(['M', 'L']).count()), Some(4));
    let refused = |folder: &Folder| match Report::with_baseline(own.path(), folder.path()) {
        Err(e @ ReportError::Baseline { .. }) => e.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(refused(&other).contains("its behavior is hand_regard"));
    assert!(refused(&Folder::new("empty")).contains("a baseline is the save_dir of a training"));
}

/// A task of a program's own that does nothing.
#[derive(Clone, Debug)]
struct Wait;

impl Task for Wait {
    fn name(&self) -> &str {
        "wait"
    }
}

#[test]
fn a_page_is_named_after_a_task_of_ones_own() {
    let folder = Folder::new("report_own_task");
    let config = Config {
        save_dir: folder.text(),
        max_episode_steps: 3,
        ..free(Behavior::None, Scene::Base)
    };
    let blueprint = Blueprint::with(config, BlueprintOptions::default().with_task(Wait)).expect("embedded assets");
    let mut env = start_training(&blueprint, false).expect("a folder");
    env.reset(None).expect("no divergence");
    held_steps(env.env_mut(), 3, 3);
    env.finish_training().expect("a log");
    assert!(report(&folder).html.contains("<title>Task wait"), "the title");
}
