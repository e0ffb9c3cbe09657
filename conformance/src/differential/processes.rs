//! Random documents in processes of their own, so that one at which MuJoCo falls ends no others.
//!
//! A process writes the number of each document before it starts with it, and what it counted as JSON at the end. Where it is killed by
//! an invalid access to memory, which safe Rust does not make, the last number is the document at which MuJoCo fell; those before and behind it run
//! again in other processes.

use std::io::Write;
use std::ops::Range;
use std::process::{Command, Output, Stdio};

use super::language::Language;
use super::state::hash;
use super::table::Tally;
use super::{batches, one};
use crate::live::parallel;
use crate::mujoco::Mujoco;

/// Documents of a process.
const DOCUMENTS: u64 = 500;

/// What counts as a document at which MuJoCo fell.
const FELL: &str = "documents at which MuJoCo falls (invalid access to memory)";

/// Word at the beginning of a line with the number of a document.
const AT: &str = "at ";

/// Compares documents `0..count` of a seed, as many processes at once as there are cores. `child` makes the command that runs
/// [`in_child`] for a range.
///
/// # Errors
/// A process cannot be started, or ends in another way than by MuJoCo's fault.
pub fn run(count: u64, seed: u64, child: impl Fn(&Range<u64>) -> Command + Sync) -> Result<Tally, String> {
    let parts = parallel(
        &batches(count, DOCUMENTS),
        || (),
        |(), range| all_of(range.clone(), seed, &child),
    );
    Ok(Tally::of(parts.into_iter().collect::<Result<_, _>>()?))
}

/// Compares the documents of a range, and steps over those at which MuJoCo falls.
fn all_of(range: Range<u64>, seed: u64, child: &(impl Fn(&Range<u64>) -> Command + Sync)) -> Result<Tally, String> {
    if range.is_empty() {
        return Ok(Tally::default());
    }
    let output = child(&range)
        .stderr(Stdio::piped())
        .output()
        .map_err(|e| format!("a process for documents {range:?} of seed {seed}: {e}"))?;
    let said = String::from_utf8_lossy(&output.stdout);
    // between them are MuJoCo's own words
    let last = said.lines().rev().find_map(|line| line.strip_prefix(AT)?.parse().ok());
    let result = said.lines().rev().find(|line| line.starts_with('{'));
    match (result, last) {
        (Some(text), _) if output.status.success() => {
            serde_json::from_str(text).map_err(|e| format!("documents {range:?} of seed {seed}: {e}"))
        }
        (_, Some(k)) if fell(&output) => {
            eprintln!("MuJoCo falls at document {k} of seed {seed}");
            let mut tally = all_of(range.start..k, seed, child)?;
            tally.append(all_of(k + 1..range.end, seed, child)?);
            tally.count("documents");
            tally.count(FELL);
            Ok(tally)
        }
        _ => Err(format!(
            "documents {range:?} of seed {seed}: {} at {last:?}: {}",
            output.status,
            String::from_utf8_lossy(&output.stderr)
        )),
    }
}

/// Tells whether a process ended by an invalid access to memory, or because its allocator found what such an access had destroyed.
fn fell(output: &Output) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        const SIGABRT: i32 = 6;
        const SIGBUS: i32 = 7;
        const SIGSEGV: i32 = 11;
        // Rust aborts where a thread runs out of stack, which would be ours
        let ours = String::from_utf8_lossy(&output.stderr).contains("has overflowed its stack");
        matches!(output.status.signal(), Some(SIGABRT | SIGBUS | SIGSEGV)) && !ours
    }
    #[cfg(not(unix))]
    {
        const STATUS_ACCESS_VIOLATION: u32 = 0xC000_0005;
        const STATUS_HEAP_CORRUPTION: u32 = 0xC000_0374;
        let code = output.status.code().map(|code| code as u32);
        matches!(code, Some(STATUS_ACCESS_VIOLATION | STATUS_HEAP_CORRUPTION))
    }
}

/// Compares the documents of a range in this process, and tells the one that started it.
///
/// # Errors
/// Attributes without a rule, a closed output.
pub fn in_child(api: &'static Mujoco, seed: u64, range: Range<u64>) -> Result<(), String> {
    let language = Language::new()?;
    let mut tally = Tally::default();
    let say = |line: String| {
        let mut out = std::io::stdout().lock();
        writeln!(out, "{line}")
            .and_then(|()| out.flush())
            .map_err(|e| e.to_string())
    };
    for k in range {
        say(format!("{AT}{k}"))?;
        one(api, &language, hash(seed, &k.to_string()), &mut tally);
    }
    say(serde_json::to_string(&tally).map_err(|e| e.to_string())?)
}
