//! Prints checksums of episodes, to be compared with those of another target, profile or number of threads.
//!
//! ```sh
//! cargo run --release --example checksum               # optionally the number of threads, and the longest episode
//! cargo run --release --example checksum vector 2      # vectors of environments, stepped by two threads
//! cargo run --release --example checksum snapshot      # snapshots, their bytes and what follows them
//! cargo build --release --example checksum_wasm --target wasm32-unknown-unknown
//! node examples/checksum/run.mjs target/wasm32-unknown-unknown/release/examples/checksum_wasm.wasm   # or: ... vector, ... snapshot
//! ```

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

mod episode;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    if arguments.next_if(|a| a == "snapshot").is_some() {
        for (index, (name, _)) in episode::CONFIGURATIONS.iter().enumerate() {
            println!("{name} snapshot {:016x}", episode::snapshot_checksum(index));
        }
        return Ok(());
    }
    let vector = arguments.next_if(|a| a == "vector").is_some();
    let threads: usize = arguments.next().map_or(Ok(1), |n| n.parse())?;
    let longest: usize = arguments.next().map_or(Ok(usize::MAX), |n| n.parse())?;
    if vector {
        for (index, (name, _)) in episode::CONFIGURATIONS.iter().enumerate() {
            let (steps, threads) = (episode::VECTOR_STEPS, threads.max(1));
            println!(
                "{name} {steps} {:016x}",
                episode::vector_checksum(index, steps, threads)
            );
        }
        return Ok(());
    }
    let lengths: Vec<usize> = episode::STEPS.into_iter().filter(|&steps| steps <= longest).collect();
    let jobs = |job: usize| (job / lengths.len(), lengths[job % lengths.len()]);
    let total = episode::CONFIGURATIONS.len() * lengths.len();
    let (next, sums) = (AtomicUsize::new(0), Mutex::new(vec![0; total]));
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(|| {
                loop {
                    let job = next.fetch_add(1, Ordering::Relaxed);
                    if job >= total {
                        break;
                    }
                    let (index, steps) = jobs(job);
                    let sum = episode::checksum(index, steps);
                    if let Ok(mut sums) = sums.lock() {
                        sums[job] = sum;
                    }
                }
            });
        }
    });
    for (job, sum) in sums.into_inner()?.into_iter().enumerate() {
        let (index, steps) = jobs(job);
        println!("{} {steps} {sum:016x}", episode::CONFIGURATIONS[index].0);
    }
    Ok(())
}
