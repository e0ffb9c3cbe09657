//! Values on the command line.

use crate::case::Case;
use crate::runs::quick;

/// Command lines after `--config c.yml`, by command.
const CALLS: &[(&str, &str)] = &[
    ("run", "--steps 18446744073709551616"),
    ("run", "--steps 1e3"),
    ("run", "--episodes 99999999999999999999"),
    ("run", "--seed 18446744073709551616"),
    ("run", "--envs 2 --threads 0"),
    ("run", "--threads 4"),
    ("run", "--assets"),
    ("run", "--compat maybe"),
    ("run", "--unknown"),
    ("run", "extra"),
    ("train", "--train-for 0"),
    ("train", "--train-for -1"),
    ("evaluate", "--jobs 0"),
    ("evaluate", "--fps 0"),
    ("evaluate", "--fps 4294967296"),
    ("evaluate", "--policy-timeout nan"),
    ("evaluate", "--policy-timeout 1e300"),
    ("evaluate", "--duration 0"),
    ("render", "--size 4097 --out a.png"),
    ("render", "--size 18446744073709551616 --out a.png"),
    ("render", "--size 8 --camera nose --out a.png"),
    ("render", "--size 8 --out a.gif"),
    ("render", "--size 8 --out .png"),
    ("replay", "--recording r.npz"),
    ("replay", "--recording r.npz --out o --images-every 0"),
    ("inspect", "--touch a.png --step 3"),
    ("inspect", "--touch a.png"),
    ("inspect", "--mjcf"),
    ("score", "run"),
];

pub fn cases() -> Vec<Case> {
    let calls = CALLS.iter().map(|(command, rest)| {
        quick(
            format!("arguments: {command} {rest}"),
            &format!("{command} --config c.yml {rest}"),
        )
    });
    let alone = |name: &str, call: &str| Case::new(format!("arguments: {name}"), call);
    let made = [
        alone("unknown command", "dance"),
        alone("no configuration", "run"),
        alone("configuration that is not there", "run --config none.yml"),
        alone("configuration of no name", "run --config").argument(""),
        alone("escape sequences", "run --config").argument("\u{1b}[2J.yml"),
        alone("command with escape sequences", "\u{1b}[2J"),
        alone("long command", &"x".repeat(1000)),
        alone("long name", "run --config").argument("c".repeat(1000)),
        alone("option twice", "run --config c.yml --config d.yml"),
        quick(
            "arguments: more jobs than anyone has",
            "evaluate --config c.yml --episodes 2 --duration 2 --no-render --quiet --jobs 18446744073709551615",
        ),
    ];
    calls.chain(made).collect()
}
