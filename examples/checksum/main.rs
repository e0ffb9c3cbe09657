//! Prints checksums of what environments do, to be compared with those of another target, profile or number of threads.
//!
//! ```sh
//! cargo run --release --example checksum               # episodes of the examples; `babybench doctor` compares with these lines
//! cargo run --release --example checksum episode 2 100 # in two threads, up to 100 steps
//! cargo run --release --example checksum variant       # with --features rapier: tasks, actuation models, the other engine, ages; also with threads and steps
//! cargo run --release --example checksum vector 2      # vectors of environments, stepped by two threads
//! cargo run --release --example checksum picture       # pictures of rooms and eyes
//! cargo run --release --example checksum snapshot      # snapshots, their bytes and what follows them
//! cargo run --release --example checksum keep FOLDER   # writes these snapshots
//! cargo run --release --example checksum restore FOLDER # prints what `snapshot` prints, from snapshots that another target may have written
//! cargo build --release -p checksum-wasm --target wasm32-unknown-unknown   # with --features rapier: the other engine, too
//! node examples/checksum/run.mjs target/wasm32-unknown-unknown/release/checksum_wasm.wasm   # or: ... KIND, keep or restore
//! ```

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use jobs::{Job, KINDS, Kind};

mod cases;
mod jobs;
mod sums;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    if let Some(command) = arguments.next_if(|a| a == "keep" || a == "restore") {
        let folder = arguments.next().ok_or("a folder of snapshots is missing")?;
        return exchange(command == "keep", Path::new(&folder));
    }
    let named = |a: &String| KINDS.iter().find(|(name, _)| name == a);
    let kind = arguments.peek().and_then(named).map(|kind| kind.1);
    if kind.is_some() {
        arguments.next();
    }
    let kind = kind.unwrap_or(Kind::Episode);
    let threads: usize = arguments.next().map_or(Ok(1), |n| n.parse())?;
    let longest: usize = arguments.next().map_or(Ok(usize::MAX), |n| n.parse())?;
    // the threads of a vector are its own
    let at_once = if kind == Kind::Vector { 1 } else { threads };
    for line in lines(&Job::all(kind, longest), threads.max(1), at_once.max(1))? {
        println!("{line}");
    }
    Ok(())
}

/// Computes lines, several at a time.
fn lines(jobs: &[Job], threads: usize, at_once: usize) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let (next, lines) = (AtomicUsize::new(0), Mutex::new(vec![Ok(String::new()); jobs.len()]));
    std::thread::scope(|scope| {
        for _ in 0..at_once {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(at) else { break };
                    let line = job.line(threads, None);
                    if let Ok(mut lines) = lines.lock() {
                        lines[at] = line;
                    }
                }
            });
        }
    });
    Ok(lines.into_inner()?.into_iter().collect::<Result<_, _>>()?)
}

/// Writes the snapshots of all configurations to a folder, or continues from existing ones.
fn exchange(keep: bool, folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    for job in Job::all(Kind::Snapshot, 0) {
        let path = folder.join(job.case.0);
        if keep {
            std::fs::write(path, sums::snapshot(job.case)?)?;
        } else {
            println!("{}", job.line(1, Some(std::fs::read(path)?))?);
        }
    }
    Ok(())
}
