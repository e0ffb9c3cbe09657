//! Jobs in threads, with results in the order of the jobs.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Runs all jobs in threads, and returns the existing results, in the order of the jobs, with the first error. After an error no job is
/// started.
pub(super) fn side_by_side<J: Sync, R: Send, E: Send>(
    all: &[J],
    threads: usize,
    run: impl Fn(&J) -> Result<R, E> + Sync,
) -> (Vec<R>, Result<(), E>) {
    let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let found: Mutex<Vec<Option<R>>> = Mutex::new(all.iter().map(|_| None).collect());
    let work = || -> Result<(), E> {
        while !failed.load(Ordering::Relaxed) {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = all.get(number) else {
                break;
            };
            let result = run(job);
            failed.fetch_or(result.is_err(), Ordering::Relaxed);
            let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
            found[number] = Some(result?);
        }
        Ok(())
    };
    let results: Vec<Result<(), E>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..threads.clamp(1, all.len().max(1)))
            .map(|_| scope.spawn(work))
            .collect();
        // a panic in a run reaches the caller, as without threads
        let join = |t: std::thread::ScopedJoinHandle<'_, _>| t.join().unwrap_or_else(|e| std::panic::resume_unwind(e));
        threads.into_iter().map(join).collect()
    });
    let runs = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    (runs.into_iter().flatten().collect(), results.into_iter().collect())
}
