//! The program in Python that the documentation of policies shows.

use std::ops::ControlFlow;
use std::time::Duration;

use babybench::config::{Behavior, Config, Scene};
use babybench::eval::{Plan, run_episodes};
use babybench::policy::PolicySource;
use testkit::harness::Trial;
use testkit::trials;
use testkit::yardsticks::{PYTHON, python};

use crate::common::{Folder, blueprint, free};

pub fn trials() -> Vec<Trial> {
    trials![needs PYTHON: the_documented_program_works]
}

/// The program as it stands in the documentation.
fn documented() -> String {
    let source = include_str!("../../src/policy/command.rs");
    let (_, rest) = source.split_once("/// ```python\n").expect("an example");
    let (example, _) = rest.split_once("/// ```").expect("its end");
    let line = |l: &str| l.trim_start().strip_prefix("/// ").unwrap_or_default().to_string() + "\n";
    example.lines().map(line).collect()
}

/// Its actions are zeros, as those of the policy `zero`.
fn the_documented_program_works() {
    let folder = Folder::new("python");
    let program = documented();
    assert!(program.lines().count() > 5, "{program}");
    let path = folder.file("policy.py", program);
    let blueprint = blueprint(Config {
        save_dir: folder.text(),
        vision_active: true,
        vision_resolution: 8,
        ..free(Behavior::SelfTouch, Scene::Crib)
    });
    let plan = Plan {
        episodes: 2,
        duration: 6,
        render: false,
        fps: 60,
        jobs: 1,
    };
    let evaluate = |policy: &str| {
        let source = PolicySource::new(policy);
        let open = || source.open(Duration::from_secs(60));
        run_episodes(&blueprint, &plan, &open, &|| ControlFlow::Continue(())).expect("episodes")
    };
    let python = python().expect("needed");
    let infos = evaluate(&format!("{} {}", python.display(), path.display()));
    assert_eq!(evaluate("zero"), infos);
}
