//! A pool of threads that runs jobs, first come, first served. Without threads the caller runs them.
//!
//! Not a general pool (rayon's, say): the caller has to get back whichever job is done first, jobs own their inputs and
//! results so that nothing is borrowed across threads, and a step allocates nothing.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// Whether this build has threads.
pub const PARALLEL: bool = cfg!(all(feature = "parallel", not(target_arch = "wasm32")));

/// A unit of work with its inputs and results.
pub trait Job: Send + 'static {
    /// Runs the job. A panic must be caught and kept for the caller.
    fn run(&mut self);
}

/// A queue of jobs to run, a queue of finished jobs, and the threads between them.
///
/// Jobs move through the queues by value, in boxes, so that nothing is allocated and nothing is shared. When the caller helps,
/// the last thread rests. A waiting thread spins for a moment before it goes to sleep, as waking up takes longer than many
/// jobs do.
pub struct ThreadPool<J: Job> {
    shared: Arc<Shared<J>>,
    workers: Vec<JoinHandle<()>>,
}

struct Shared<J> {
    queues: Mutex<Queues<J>>,
    /// Signals the threads that there are jobs.
    work: Condvar,
    /// Signals the last thread, which is left asleep while the caller helps.
    spare: Condvar,
    /// Signals the caller that the jobs it waits for are finished.
    ready: Condvar,
    /// Numbers of batches submitted and of jobs finished; both change under the lock.
    handed: AtomicUsize,
    finished: AtomicUsize,
    /// Number of spins before a thread, or the caller, goes to sleep.
    patience: u32,
}

/// Spins before going to sleep, about 30 us.
const PATIENCE: u32 = 1000;
/// Spins where jobs are short and come one by one, about 0.3 ms: sleeping and waking up would cost more than it saves.
const LONG_PATIENCE: u32 = 10 * PATIENCE;

struct Queues<J> {
    jobs: VecDeque<Box<J>>,
    done: VecDeque<Box<J>>,
    /// Number of threads.
    threads: usize,
    /// Number of threads that may take jobs; these are the first ones.
    active: usize,
    /// Number of finished jobs that the caller waits for, if it does.
    wanted: Option<usize>,
    stop: bool,
}

impl<J> Shared<J> {
    fn lock(&self) -> MutexGuard<'_, Queues<J>> {
        // jobs run, and panic, without the lock
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Spins, without the lock, until a count has grown by `by` or the number of spins is used up.
    fn look_out(&self, queues: MutexGuard<'_, Queues<J>>, count: &AtomicUsize, by: usize) {
        let start = count.load(Ordering::Relaxed);
        drop(queues);
        for _ in 0..self.patience {
            if count.load(Ordering::Relaxed).wrapping_sub(start) >= by {
                return;
            }
            std::hint::spin_loop();
        }
    }

    /// Blocks a thread without work until there are jobs.
    fn idle<'a>(&'a self, mut queues: MutexGuard<'a, Queues<J>>, index: usize) -> MutexGuard<'a, Queues<J>> {
        if index < queues.active {
            // read under the lock that `submit` counts under: a batch that comes before `wait` is seen below, or the
            // condition variable is signalled after it
            let before = self.handed.load(Ordering::Relaxed);
            self.look_out(queues, &self.handed, 1);
            queues = self.lock();
            if self.handed.load(Ordering::Relaxed) != before {
                return queues;
            }
        }
        // a condition variable of its own, so that waking the others does not wake the thread that rests
        let bell = if index + 1 == queues.threads {
            &self.spare
        } else {
            &self.work
        };
        bell.wait(queues).unwrap_or_else(PoisonError::into_inner)
    }
}

impl<J: Job> ThreadPool<J> {
    /// Starts threads for at most `jobs` jobs at a time. A build without threads starts none.
    ///
    /// # Errors
    /// The system gives no more threads.
    pub fn new(threads: usize, jobs: usize) -> std::io::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        // with more threads than cores, a spinning thread would starve a worker
        Self::start(threads, jobs, if threads > cores { 0 } else { PATIENCE })
    }

    /// Starts a thread for one job at a time, next to a caller that does another. Both stay awake from one job to the next if jobs follow each other
    /// closely.
    ///
    /// # Errors
    /// As [`ThreadPool::new`].
    pub fn of_one() -> std::io::Result<Self> {
        Self::start(1, 1, LONG_PATIENCE)
    }

    fn start(threads: usize, jobs: usize, patience: u32) -> std::io::Result<Self> {
        let threads = if PARALLEL { threads } else { 0 };
        let queues = Queues {
            // room for all jobs at once, so that no step allocates
            jobs: VecDeque::with_capacity(jobs),
            done: VecDeque::with_capacity(jobs),
            threads,
            active: 0,
            wanted: None,
            stop: false,
        };
        let shared = Arc::new(Shared {
            queues: Mutex::new(queues),
            work: Condvar::new(),
            spare: Condvar::new(),
            ready: Condvar::new(),
            handed: AtomicUsize::new(0),
            finished: AtomicUsize::new(0),
            patience,
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

    /// Wakes a thread that [`ThreadPool::of_one`] started, because a job is about to come.
    pub fn wake(&self) {
        self.shared.spare.notify_one();
    }

    /// Submits jobs. With `help`, the caller is one of the threads ([`ThreadPool::next`]), and the last of the others rests.
    pub fn submit(&self, jobs: impl Iterator<Item = Box<J>>, help: bool) {
        let mut queues = self.shared.lock();
        queues.jobs.extend(jobs);
        queues.active = queues.threads.saturating_sub(usize::from(help));
        // relaxed, as the lock orders it; a spinning thread only needs to know when to take the lock
        self.shared.handed.fetch_add(1, Ordering::Relaxed);
        drop(queues);
        if !self.workers.is_empty() {
            self.shared.work.notify_all();
        }
        if !self.workers.is_empty() && !help {
            self.shared.spare.notify_one();
        }
    }

    /// Returns the next finished job; the caller helps to run them. `None` if no job is under way.
    pub fn next(&self, under_way: usize) -> Option<Box<J>> {
        let mut queues = self.shared.lock();
        loop {
            if let Some(job) = queues.done.pop_front() {
                return Some(job);
            }
            if let Some(mut job) = queues.jobs.pop_front() {
                drop(queues);
                job.run();
                return Some(job);
            }
            if under_way == 0 {
                return None;
            }
            queues = self.wait(queues, 1);
        }
    }

    /// Returns the next finished job. At least one must be under way. The caller helps.
    pub fn wait_next(&self) -> Box<J> {
        loop {
            // empty-handed only if nothing were under way
            if let Some(job) = self.next(1) {
                return job;
            }
        }
    }

    /// Waits until `wanted` jobs, which must be under way, are finished. Without threads the caller runs them, in order.
    pub fn wait_for(&self, wanted: usize) {
        let mut queues = self.shared.lock();
        while queues.done.len() < wanted {
            if !self.workers.is_empty() {
                queues = self.wait(queues, wanted);
                continue;
            }
            let Some(mut job) = queues.jobs.pop_front() else {
                return;
            };
            drop(queues);
            job.run();
            queues = self.shared.lock();
            queues.done.push_back(job);
        }
    }

    /// Returns the first finished job of a kind, if there is one.
    pub fn take_where(&self, kind: impl FnMut(&Box<J>) -> bool) -> Option<Box<J>> {
        let mut queues = self.shared.lock();
        let at = queues.done.iter().position(kind)?;
        queues.done.remove(at)
    }

    /// Returns the oldest finished job, if there is one.
    pub fn take(&self) -> Option<Box<J>> {
        self.shared.lock().done.pop_front()
    }

    /// Waits for the threads until `wanted` jobs are finished; may return early.
    fn wait<'a>(&'a self, queues: MutexGuard<'a, Queues<J>>, wanted: usize) -> MutexGuard<'a, Queues<J>> {
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

/// Ends the threads, each after its current job.
impl<J: Job> Drop for ThreadPool<J> {
    fn drop(&mut self) {
        let mut queues = self.shared.lock();
        queues.stop = true;
        // jobs that have not begun are dropped unrun: their results will never be requested
        queues.jobs.clear();
        self.shared.handed.fetch_add(1, Ordering::Relaxed);
        drop(queues);
        self.shared.work.notify_all();
        self.shared.spare.notify_one();
        for worker in self.workers.drain(..) {
            // it cannot have panicked: a job keeps its panic
            let _ = worker.join();
        }
    }
}

/// Runs a thread of the pool until there is no more work.
fn work<J: Job>(shared: &Shared<J>, index: usize) {
    let mut queues = shared.lock();
    while !queues.stop {
        let job = if index < queues.active {
            queues.jobs.pop_front()
        } else {
            None
        };
        let Some(mut job) = job else {
            queues = shared.idle(queues, index);
            continue;
        };
        drop(queues);
        job.run();
        queues = shared.lock();
        queues.done.push_back(job);
        shared.finished.fetch_add(1, Ordering::Relaxed);
        // one signal for a whole batch: waking the caller for each job would cost more than most jobs
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
        struct EmptyJob;
        impl Job for EmptyJob {
            fn run(&mut self) {}
        }
        let pool = ThreadPool::<EmptyJob>::new(3, 4).expect("threads");
        assert_eq!(pool.workers.len(), if PARALLEL { 3 } else { 0 });
        // each thread holds what it shares with the pool as long as it lives
        let alive = Arc::downgrade(&pool.shared);
        assert_eq!(alive.strong_count(), 1 + pool.workers.len());
        drop(pool);
        assert_eq!(alive.strong_count(), 0);
    }
}
