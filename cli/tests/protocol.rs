//! Protocols, from the command line.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use common::*;
use program::*;
use serde_json::Value;

/// Runs the program in a folder, which does what it is told, and returns what it said.
fn succeed(folder: &Folder, arguments: &[&str]) -> String {
    let out = babybench(folder.path(), arguments);
    assert!(out.status.success(), "{arguments:?}: {}", text(&out));
    String::from_utf8(out.stdout).expect("text")
}

#[test]
fn protocols_are_listed_and_shown() {
    let folder = Folder::new("cli_protocols");
    let list = succeed(&folder, &["protocol", "list"]);
    for name in [
        "pull_to_sit",
        "supported_sit",
        "kick",
        "self_touch",
        "roll_over",
        "mobile",
    ] {
        assert!(list.lines().any(|line| line.starts_with(name)), "{list}");
        let shown = succeed(&folder, &["protocol", "show", name]);
        for part in ["phases:", "measures:", "published:", "strength: infant", "not found"] {
            assert!(shown.contains(part), "{part}: {shown}");
        }
    }
    let shown = succeed(&folder, &["protocol", "show", "supported_sit"]);
    assert!(
        shown.contains("6 +- 1.1 months (s)") && shown.contains("WHO 2006"),
        "{shown}"
    );
}

#[test]
fn a_protocol_is_run_changed_and_not_run_again() {
    let folder = Folder::new("cli_protocol_run");
    let run = [
        "protocol",
        "run",
        "pull_to_sit",
        "--policy",
        "zero",
        "--ages",
        "0,6",
        "--length",
        "0.1",
        "--quiet",
    ];
    let printed = succeed(&folder, &run);
    for part in [
        "# Pull to sit",
        "differs by",
        "3.5 months (s; Denver II",
        "results/protocol/pull_to_sit: protocol.md",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    for word in ["pass", "fail"] {
        assert!(!printed.contains(word), "a difference judges nothing: {printed}");
    }
    let own = folder.path().join("results/protocol/pull_to_sit");
    let read = |name: &str| std::fs::read_to_string(own.join(name)).expect("a file");
    assert_eq!(printed.lines().next(), read("protocol.md").lines().next());
    assert!(read("figure.svg").contains("lag at 45 degrees"));
    let manifest: Value = serde_json::from_str(&read("manifest.json")).expect("JSON");
    assert_eq!(manifest["plan"]["policies"][0], "zero");
    let before = read("protocol.json");
    assert_eq!(succeed(&folder, &run), printed, "with the runs that are there");
    assert_eq!(read("protocol.json"), before);
    // a neck by volume is strong from birth on
    let lag = |json: &str| {
        let json: Value = serde_json::from_str(json).expect("JSON");
        json["runs"][0]["values"]["controller"]["pull"]["at_45"]
            .as_f64()
            .expect("a lag")
    };
    let other = [
        &run[..],
        &["--strength", "volume", "--springs", "fixed", "--out", "volume"],
    ]
    .concat();
    let printed = succeed(&folder, &other);
    assert!(
        printed.contains("Changed keys: `strength: volume, springs: fixed`"),
        "{printed}"
    );
    let volume = std::fs::read_to_string(folder.path().join("volume/protocol.json")).expect("a file");
    assert!(lag(&before) > 45.0 && lag(&volume) < 10.0);
    let weak = [&run[..], &["--set", "strength_neck=0.5", "--out", "weak"]].concat();
    assert!(succeed(&folder, &weak).contains("strength_neck: 0.5"));
}

#[test]
fn wrong_arguments_say_what_is_expected() {
    let folder = Folder::new("cli_protocol_wrong");
    for (arguments, code, part) in [
        (&["show", "kik"][..], 1, "did you mean \"kick\"?"),
        (&["show", "none.yml"], 1, "none.yml: "),
        (&["run", "kick", "--length", "2"], 1, "length is 2"),
        (&["run", "kick", "--length", "x"], 2, "--length"),
        (
            &["run", "kick", "--ages", "1,30"],
            2,
            "expected an age in months, 0 to 24",
        ),
        (&["run", "kick", "--seeds", "0"], 2, "whole number of at least 1"),
        (&["run", "kick", "--set", "strength"], 2, "expected KEY=VALUE"),
        (
            &["run", "kick", "--set", "strengths=infant"],
            1,
            "did you mean `strength`",
        ),
        (&["run", "kick", "--set", "compat=reference"], 1, "compat"),
        (
            &["run", "kick", "--strength", "giant"],
            2,
            "possible values: volume, infant",
        ),
        (&[], 2, "Usage"),
    ] {
        let arguments = [&["protocol"][..], arguments].concat();
        let out = babybench(folder.path(), &arguments);
        let said = text(&out);
        assert_eq!(out.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
    assert!(
        std::fs::read_dir(folder.path()).expect("a folder").next().is_none(),
        "nothing is written"
    );
}
