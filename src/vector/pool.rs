//! Threads that run environments, first come, first served. Without threads the caller runs them.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use crate::vector::options::PARALLEL;
use crate::vector::slot::Slot;

/// A queue of environments to run, one of those that have run, and the threads between them.
///
/// Environments move through the queues by value, in boxes, so that no step allocates and nothing is shared. A vector
/// of one thread has none beside the caller's. Otherwise there are as many as asked for; when the caller helps, the last of
/// them rests. Whoever has to wait looks out for a moment before it goes to sleep, as waking up takes longer than many a step.
pub(super) struct Pool {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

struct Shared {
    queues: Mutex<Queues>,
    /// Tells the threads that there is something to do.
    work: Condvar,
    /// Tells the last thread, which is left asleep while the caller helps.
    spare: Condvar,
    /// Tells the caller that what it waits for has been done.
    ready: Condvar,
    /// Counts what was handed over, and what has run; both change under the lock.
    handed: AtomicUsize,
    finished: AtomicUsize,
    /// How often a thread looks out before it sleeps.
    patience: u32,
}

/// Looks that a thread takes before it sleeps: some 30 us.
const PATIENCE: u32 = 1000;

#[derive(Default)]
struct Queues {
    tasks: VecDeque<Box<Slot>>,
    done: VecDeque<Box<Slot>>,
    /// Number of threads.
    threads: usize,
    /// Number of threads that may take tasks, the first ones.
    active: usize,
    /// Number of finished environments that the caller waits for, if it does.
    wanted: Option<usize>,
    stop: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queues> {
        // environments panic in `Slot::run`, never under the lock
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks out, without the lock, for a count to move on by `by` from where it stands; for a moment.
    fn look_out(&self, queues: MutexGuard<'_, Queues>, count: &AtomicUsize, by: usize) {
        let start = count.load(Ordering::Relaxed);
        drop(queues);
        for _ in 0..self.patience {
            if count.load(Ordering::Relaxed).wrapping_sub(start) >= by {
                return;
            }
            std::hint::spin_loop();
        }
    }

    /// Waits for something to do, for a thread that has found nothing.
    fn idle<'a>(&'a self, mut queues: MutexGuard<'a, Queues>, index: usize) -> MutexGuard<'a, Queues> {
        if index < queues.active {
            let before = self.handed.load(Ordering::Relaxed);
            self.look_out(queues, &self.handed, 1);
            queues = self.lock();
            if self.handed.load(Ordering::Relaxed) != before {
                return queues;
            }
        }
        let bell = if index + 1 == queues.threads {
            &self.spare
        } else {
            &self.work
        };
        bell.wait(queues).unwrap_or_else(PoisonError::into_inner)
    }
}

impl Pool {
    /// Starts the threads for `envs` environments.
    pub fn new(threads: usize, envs: usize) -> std::io::Result<Self> {
        let threads = if PARALLEL && threads > 1 { threads } else { 0 };
        let queues = Queues {
            tasks: VecDeque::with_capacity(envs),
            done: VecDeque::with_capacity(envs),
            threads,
            ..Queues::default()
        };
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let shared = Arc::new(Shared {
            queues: Mutex::new(queues),
            work: Condvar::new(),
            spare: Condvar::new(),
            ready: Condvar::new(),
            handed: AtomicUsize::new(0),
            finished: AtomicUsize::new(0),
            // without a core for each, whoever looks out keeps another from working
            patience: if threads > cores { 0 } else { PATIENCE },
        });
        let mut pool = Self {
            shared,
            workers: Vec::new(),
        };
        for index in 0..threads {
            let shared = pool.shared.clone();
            let thread = std::thread::Builder::new().name(format!("babybench {index}"));
            pool.workers.push(thread.spawn(move || work(&shared, index))?);
        }
        Ok(pool)
    }

    /// Hands environments over. With `help`, the caller is one of the threads ([`Pool::next`]), and the last of the others
    /// rests.
    pub fn submit(&self, slots: impl Iterator<Item = Box<Slot>>, help: bool) {
        let mut queues = self.shared.lock();
        queues.tasks.extend(slots);
        queues.active = queues.threads.saturating_sub(usize::from(help));
        self.shared.handed.fetch_add(1, Ordering::Relaxed);
        drop(queues);
        if !self.workers.is_empty() {
            self.shared.work.notify_all();
        }
        if !self.workers.is_empty() && !help {
            self.shared.spare.notify_one();
        }
    }

    /// Returns the next environment that has run; the caller helps to run them. Nothing comes back if nothing is under way.
    pub fn next(&self, under_way: usize) -> Option<Box<Slot>> {
        let mut queues = self.shared.lock();
        loop {
            if let Some(slot) = queues.done.pop_front() {
                return Some(slot);
            }
            if let Some(mut slot) = queues.tasks.pop_front() {
                drop(queues);
                slot.run();
                return Some(slot);
            }
            if under_way == 0 {
                return None;
            }
            queues = self.wait(queues, 1);
        }
    }

    /// Waits until `wanted` environments have run, which must be under way. Without threads the caller runs them, in order.
    pub fn wait_for(&self, wanted: usize) {
        let mut queues = self.shared.lock();
        while queues.done.len() < wanted {
            if !self.workers.is_empty() {
                queues = self.wait(queues, wanted);
                continue;
            }
            let Some(mut slot) = queues.tasks.pop_front() else {
                return;
            };
            drop(queues);
            slot.run();
            queues = self.shared.lock();
            queues.done.push_back(slot);
        }
    }

    /// Returns the finished environment that panicked first, if one did.
    pub fn take_panicked(&self) -> Option<Box<Slot>> {
        let mut queues = self.shared.lock();
        let at = queues.done.iter().position(|slot| slot.panicked.is_some())?;
        queues.done.remove(at)
    }

    /// Returns a finished environment, the first first.
    pub fn take(&self) -> Option<Box<Slot>> {
        self.shared.lock().done.pop_front()
    }

    /// Waits for the threads until `wanted` environments have run, or for less.
    fn wait<'a>(&'a self, queues: MutexGuard<'a, Queues>, wanted: usize) -> MutexGuard<'a, Queues> {
        let missing = wanted.saturating_sub(queues.done.len());
        self.shared.look_out(queues, &self.shared.finished, missing);
        let mut queues = self.shared.lock();
        if queues.done.len() >= wanted {
            return queues;
        }
        queues.wanted = Some(wanted);
        let waited = self.shared.ready.wait(queues);
        let mut queues = waited.unwrap_or_else(PoisonError::into_inner);
        queues.wanted = None;
        queues
    }
}

/// Ends the threads, each when the environment in its hands has run.
impl Drop for Pool {
    fn drop(&mut self) {
        let mut queues = self.shared.lock();
        queues.stop = true;
        queues.tasks.clear();
        self.shared.handed.fetch_add(1, Ordering::Relaxed);
        drop(queues);
        self.shared.work.notify_all();
        self.shared.spare.notify_one();
        for worker in self.workers.drain(..) {
            // it cannot have panicked: what panics is caught in `Slot::run`
            let _ = worker.join();
        }
    }
}

/// Runs a thread of the pool until there is no more work.
fn work(shared: &Shared, index: usize) {
    let mut queues = shared.lock();
    while !queues.stop {
        let task = match index < queues.active {
            true => queues.tasks.pop_front(),
            false => None,
        };
        let Some(mut slot) = task else {
            queues = shared.idle(queues, index);
            continue;
        };
        drop(queues);
        slot.run();
        queues = shared.lock();
        queues.done.push_back(slot);
        shared.finished.fetch_add(1, Ordering::Relaxed);
        if queues.wanted.is_some_and(|wanted| queues.done.len() >= wanted) {
            shared.ready.notify_one();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_end_with_the_pool() {
        let pool = Pool::new(3, 4).expect("threads");
        assert_eq!(pool.workers.len(), if PARALLEL { 3 } else { 0 });
        // each thread holds what it shares with the pool as long as it lives
        let alive = Arc::downgrade(&pool.shared);
        assert_eq!(alive.strong_count(), 1 + pool.workers.len());
        drop(pool);
        assert_eq!(alive.strong_count(), 0);
    }
}
