//! Runs documents in separate processes, so that a document that crashes MuJoCo does not stop the run.
//!
//! A process writes the number of each document before it runs it, and the result as JSON afterwards. If an invalid memory access
//! kills the process, which safe Rust never causes, the last number is the document at which MuJoCo crashed. Another process
//! continues with the next document.

use std::io::Write;
use std::ops::Range;
use std::process::{Command, Output, Stdio};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::live::parallel;

/// Word at the beginning of a line with the number of a document.
const AT: &str = "at ";

/// Word at the beginning of a line with a result.
const DONE: &str = "done ";

/// A document in another process.
#[derive(Debug, PartialEq)]
pub enum Ran<T> {
    /// The result.
    Done(T),
    /// MuJoCo crashed on it.
    Fell,
}

/// Runs documents `0..count`, `length` per process, with one process per core at a time. `child` makes the command that calls
/// [`in_child`] for a range.
///
/// # Errors
/// A process cannot be started, or ends for a reason other than MuJoCo's fault.
pub fn run<T: DeserializeOwned + Send>(
    count: u64,
    length: u64,
    child: impl Fn(&Range<u64>) -> Command + Sync,
) -> Result<Vec<Ran<T>>, String> {
    let parts = parallel(&ranges(count, length), || (), |(), range| all_of(range.clone(), &child));
    let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(parts.into_iter().flatten().collect())
}

/// Splits documents `0..count` into ranges.
pub fn ranges(count: u64, length: u64) -> Vec<Range<u64>> {
    let starts = (0..count).step_by(length as usize);
    starts.map(|k| k..count.min(k + length)).collect()
}

/// Runs the documents of a range, and continues after those on which MuJoCo crashes.
fn all_of<T: DeserializeOwned>(
    mut range: Range<u64>,
    child: &(impl Fn(&Range<u64>) -> Command + Sync),
) -> Result<Vec<Ran<T>>, String> {
    let mut all = Vec::new();
    while !range.is_empty() {
        let output = child(&range)
            .stderr(Stdio::piped())
            .output()
            .map_err(|e| format!("a process for documents {range:?}: {e}"))?;
        let said = String::from_utf8_lossy(&output.stdout);
        // between these lines are MuJoCo's own words
        let done = said.lines().filter_map(|line| line.strip_prefix(DONE));
        let done: Vec<T> = done
            .map(serde_json::from_str)
            .collect::<Result<_, _>>()
            .map_err(|e| format!("documents {range:?}: {e}"))?;
        let behind = range.start + done.len() as u64;
        all.extend(done.into_iter().map(Ran::Done));
        let at = said.lines().rev().find_map(|line| line.strip_prefix(AT)?.parse().ok());
        if output.status.success() && behind == range.end {
            break;
        }
        if at != Some(behind) || !fell(&output) {
            let words = String::from_utf8_lossy(&output.stderr);
            return Err(format!("documents {range:?}: {} at {at:?}: {words}", output.status));
        }
        eprintln!("MuJoCo falls at document {behind}");
        all.push(Ran::Fell);
        range.start = behind + 1;
    }
    Ok(all)
}

/// Returns whether a process ended by an invalid access to memory, or because its allocator detected one.
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

/// Runs the documents of a range in this process, and reports to its parent.
///
/// # Errors
/// A closed output.
pub fn in_child<T: Serialize>(range: Range<u64>, mut one: impl FnMut(u64) -> T) -> Result<(), String> {
    let say = |line: String| {
        let mut out = std::io::stdout().lock();
        writeln!(out, "{line}")
            .and_then(|()| out.flush())
            .map_err(|e| e.to_string())
    };
    for k in range {
        say(format!("{AT}{k}"))?;
        let done = serde_json::to_string(&one(k)).map_err(|e| e.to_string())?;
        say(format!("{DONE}{done}"))?;
    }
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A process that answers ten times the number of each document, and ends at the third one as `end` specifies.
    fn child(range: &Range<u64>, end: &str) -> Command {
        let one = |k: u64| match k {
            3 => format!("echo at 3; {end};"),
            k => format!("echo at {k}; echo words of others; echo done {};", 10 * k),
        };
        let mut command = Command::new("sh");
        command.args(["-c", &range.clone().map(one).collect::<String>()]);
        command
    }

    #[test]
    fn a_process_that_falls_ends_no_other_document() {
        let ran = run::<u64>(8, 5, |range| child(range, "kill -SEGV $$")).expect("all run");
        let expected = (0..8).map(|k| if k == 3 { Ran::Fell } else { Ran::Done(10 * k) });
        assert_eq!(ran, expected.collect::<Vec<_>>());
    }

    #[test]
    fn what_is_not_a_fall_is_an_error() {
        for end in [
            "exit 1",
            "exit 0",
            "kill -KILL $$",
            "echo has overflowed its stack >&2; kill -ABRT $$",
        ] {
            let error = run::<u64>(8, 5, |range| child(range, end)).expect_err(end);
            assert!(error.starts_with("documents 0..5: "), "{error}");
        }
    }
}
