//! Values for one thread at a time. Other threads get an error immediately: a thread that waited would hold Python's lock, which the
//! first thread may need.

use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// A value for one thread at a time, until it is closed.
pub struct Guarded<T> {
    /// `None` once it is closed.
    inner: Mutex<Option<Box<T>>>,
    /// Name for Python's users.
    name: &'static str,
    /// Advice for other threads.
    remedy: &'static str,
}

impl<T> Guarded<T> {
    /// Guards a value, which messages call `name`.
    pub fn new(value: T, name: &'static str, remedy: &'static str) -> Self {
        Self {
            inner: Mutex::new(Some(Box::new(value))),
            name,
            remedy,
        }
    }

    /// Locks the value for exclusive use.
    pub fn guard(&self) -> PyResult<Guard<'_, T>> {
        let name = self.name;
        match self.inner.try_lock() {
            Ok(guard) => Ok(Guard { guard, name }),
            Err(TryLockError::WouldBlock) => {
                let text = format!("another thread is using the {name}: {}", self.remedy);
                Err(PyRuntimeError::new_err(text))
            }
            Err(TryLockError::Poisoned(_)) => {
                let text = format!("the {name} is broken: make another");
                Err(PyRuntimeError::new_err(text))
            }
        }
    }

    /// Abandons the value without dropping it.
    pub fn forget(&mut self) {
        if let Ok(inner) = self.inner.get_mut() {
            std::mem::forget(inner.take());
        }
    }
}

/// A value in use.
pub struct Guard<'a, T> {
    guard: MutexGuard<'a, Option<Box<T>>>,
    name: &'static str,
}

impl<T> Guard<'_, T> {
    /// Returns the value, if it is not closed.
    pub fn open(&mut self) -> PyResult<&mut T> {
        let name = self.name;
        let closed = || PyRuntimeError::new_err(format!("the {name} is closed: make another"));
        self.guard.as_deref_mut().ok_or_else(closed)
    }

    /// Drops the value, if that has not happened before.
    pub fn close(mut self) {
        self.guard.take();
    }

    /// Returns whether the value was dropped.
    pub fn closed(&self) -> bool {
        self.guard.is_none()
    }
}
