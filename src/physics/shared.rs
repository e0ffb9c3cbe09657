//! Values that many states share until one of them changes its own.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use crate::table::Row;

/// A value that copies share until one of them is written to, which then gets its own: [`State::params`](crate::State::params).
///
/// It is read and written like the value itself. A value of one's own stays one's own: copies into it ([`Clone::clone_from`]) keep its memory, so that
/// repeated writes allocate once.
#[derive(Default)]
pub struct Shared<T>(Arc<T>);

impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;

    #[inline]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Clone> DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}

impl<T: Clone> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    fn clone_from(&mut self, other: &Self) {
        if Arc::ptr_eq(&self.0, &other.0) {
            return;
        }
        match Arc::get_mut(&mut self.0) {
            Some(own) => own.clone_from(&other.0),
            None => self.0 = other.0.clone(),
        }
    }
}

impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl<T: fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: Row + Clone> Row for Shared<T> {
    fn numbers<'a>(&'a self, out: &mut Vec<&'a [f64]>) {
        self.0.numbers(out);
    }

    fn numbers_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [f64]>) {
        Arc::make_mut(&mut self.0).numbers_mut(out);
    }

    fn flags<'a>(&'a self, out: &mut Vec<&'a [bool]>) {
        self.0.flags(out);
    }

    fn flags_mut<'a>(&'a mut self, out: &mut Vec<&'a mut [bool]>) {
        Arc::make_mut(&mut self.0).flags_mut(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(shared: &Shared<Vec<f64>>) -> *const f64 {
        shared.as_ptr()
    }

    #[test]
    fn copies_share_until_one_is_written_to() {
        let first = Shared::from(vec![1.0, 2.0]);
        let mut second = first.clone();
        assert_eq!(place(&first), place(&second));
        second[0] = 3.0;
        assert_ne!(place(&first), place(&second));
        assert_eq!((&*first, &*second), (&vec![1.0, 2.0], &vec![3.0, 2.0]));
        assert!(first != second);
    }

    #[test]
    fn a_value_of_ones_own_keeps_its_memory() {
        let first = Shared::from(vec![1.0, 2.0]);
        let mut own = Shared::from(vec![0.0, 0.0]);
        let before = place(&own);
        own.clone_from(&first);
        assert!(place(&own) == before && own == first);
        let mut shared = first.clone();
        let other = Shared::from(vec![4.0]);
        shared.clone_from(&other);
        assert_eq!(place(&shared), place(&other));
        own.clone_from(&own.clone());
        assert_eq!(*own, [1.0, 2.0]);
    }
}
