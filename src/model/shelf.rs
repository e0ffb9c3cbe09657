//! Tools that remember nothing from one use to the next, and can therefore serve many users in turn.

use std::sync::{Mutex, PoisonError};

/// The tools that nobody uses at the moment. There are as many as were ever used at once, by as many threads, however many users
/// there are.
#[derive(Debug)]
pub struct Shelf<T> {
    idle: Mutex<Vec<T>>,
}

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self { idle: Mutex::default() }
    }
}

impl<T> Shelf<T> {
    /// Does some work with a tool, which `make` makes if none is idle. One with which the work panicked does not come back.
    pub fn lend<R>(&self, make: impl FnOnce() -> T, work: impl FnOnce(&mut T) -> R) -> R {
        let mut tool = self.take().unwrap_or_else(make);
        let result = work(&mut tool);
        self.put(tool);
        result
    }

    /// Takes an idle tool, if there is one.
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
        let (shelf, mut made) = (Shelf::default(), 0);
        let mut numbered = || {
            made += 1;
            made
        };
        for _ in 0..3 {
            assert_eq!(shelf.lend(&mut numbered, |tool| *tool), 1);
        }
        let pair = shelf.lend(&mut numbered, |outer| shelf.lend(|| 2, |inner| (*outer, *inner)));
        assert_eq!(pair, (1, 2));
        assert_eq!(shelf.lend(|| 3, |tool| *tool), 1, "the last one that came back");
    }

    #[test]
    fn a_tool_does_not_come_back_from_a_panic() {
        let shelf = Shelf::default();
        let work = || shelf.lend(|| 1, |_| panic!("at work"));
        let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
        assert!(caught.is_err());
        assert_eq!(shelf.lend(|| 2, |tool| *tool), 2);
    }
}
