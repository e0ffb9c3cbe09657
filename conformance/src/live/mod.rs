//! babybench and MuJoCo 3.3.0 side by side, from the same states with the same controls.

mod case;
mod drive;
mod episode;
pub mod one_step;
pub mod rollout;
pub mod speed;
pub mod statistics;

use std::sync::atomic::{AtomicUsize, Ordering};

pub use case::{Case, SUBJECTS, Subject, example_configs};
pub use drive::{Drive, Motion};
pub use episode::Episode;

/// Runs `work` on each item, with one thread per core. Each thread makes its own workspace.
pub fn parallel<T: Sync, W, R: Send>(
    items: &[T],
    workplace: impl Fn() -> W + Sync,
    work: impl Fn(&mut W, &T) -> R + Sync,
) -> Vec<R> {
    let threads = std::thread::available_parallelism()
        .map_or(1, |n| n.get())
        .min(items.len());
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut place = workplace();
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(k) else { return done };
            done.push((k, work(&mut place, item)));
        }
    };
    let mut all: Vec<(usize, R)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let join = |w: std::thread::ScopedJoinHandle<'_, Vec<(usize, R)>>| match w.join() {
            Ok(done) => done,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        workers.into_iter().flat_map(join).collect()
    });
    all.sort_by_key(|(k, _)| *k);
    all.into_iter().map(|(_, r)| r).collect()
}
