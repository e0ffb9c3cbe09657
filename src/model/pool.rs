//! Pools of reusable, stateless tools, so that many users can take turns.

use std::sync::{Mutex, PoisonError};

/// The idle tools. The pool grows to the largest number of tools in use at once; the number of users does not matter.
#[derive(Debug)]
pub struct Pool<T> {
    idle: Mutex<Vec<T>>,
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self { idle: Mutex::default() }
    }
}

impl<T> Pool<T> {
    /// Does some work with a tool, which `make` creates if none is idle. A tool is not returned if the work panics.
    pub fn lend<R>(&self, make: impl FnOnce() -> T, work: impl FnOnce(&mut T) -> R) -> R {
        let mut tool = self.take().unwrap_or_else(make);
        let result = work(&mut tool);
        self.put(tool);
        result
    }

    /// Removes and returns an idle tool, if there is one.
    pub fn take(&self) -> Option<T> {
        // the last one that came back: a thread that works again and again has its own, warm in the cache of its core
        self.lock().pop()
    }

    /// Brings a tool back.
    pub fn put(&self, tool: T) {
        self.lock().push(tool);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<T>> {
        // no work is done while it is held, so it cannot be left half changed
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tools_are_made_when_all_others_are_in_use() {
        let (pool, mut made) = (Pool::default(), 0);
        let mut numbered = || {
            made += 1;
            made
        };
        for _ in 0..3 {
            assert_eq!(pool.lend(&mut numbered, |tool| *tool), 1);
        }
        let pair = pool.lend(&mut numbered, |outer| pool.lend(|| 2, |inner| (*outer, *inner)));
        assert_eq!(pair, (1, 2));
        assert_eq!(pool.lend(|| 3, |tool| *tool), 1, "the last one that came back");
    }

    #[test]
    fn a_tool_does_not_come_back_from_a_panic() {
        let pool = Pool::default();
        let work = || pool.lend(|| 1, |_| panic!("at work"));
        let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
        assert!(caught.is_err());
        assert_eq!(pool.lend(|| 2, |tool| *tool), 2);
    }
}
