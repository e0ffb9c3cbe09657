//! A WebAssembly module without imports: `run.mjs` requests a line, or writes a snapshot into its memory, and reads the result.
#![cfg(target_arch = "wasm32")]

use std::sync::{Mutex, MutexGuard, PoisonError};

use jobs::{Job, KINDS, Kind};

mod cases;
mod jobs;
mod sums;

/// The text for the caller, and the buffer in which the caller writes a snapshot.
static BYTES: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn bytes() -> MutexGuard<'static, Vec<u8>> {
    BYTES.lock().unwrap_or_else(PoisonError::into_inner)
}

fn answer(text: Result<String, String>) -> usize {
    let text = text.unwrap_or_else(|error| format!("FAILED: {error}"));
    *bytes() = text.into_bytes();
    bytes().len()
}

/// Allocates a buffer for a snapshot and returns its address; for the length of an answer, returns the answer's address.
#[unsafe(no_mangle)]
pub extern "C" fn memory_of(length: usize) -> *mut u8 {
    let mut bytes = bytes();
    bytes.resize(length, 0);
    bytes.as_mut_ptr()
}

/// Computes a line of a kind, a number in the order of `jobs.rs`, and returns its length: 0 after the last one.
#[unsafe(no_mangle)]
pub extern "C" fn line(kind: usize, index: usize) -> usize {
    let job = KINDS
        .get(kind)
        .and_then(|kind| Job::all(kind.1, usize::MAX).get(index).copied());
    job.map_or(0, |job| answer(job.line(7, None))) // seven threads, only one of which exists here
}

/// Returns the length of a configuration's name: 0 after the last one.
#[unsafe(no_mangle)]
pub extern "C" fn name(index: usize) -> usize {
    let job = Job::all(Kind::Snapshot, 0).get(index).copied();
    job.map_or(0, |job| answer(Ok(job.case.0.to_owned())))
}

/// Takes a snapshot of a configuration, and returns its length.
#[unsafe(no_mangle)]
pub extern "C" fn keep(index: usize) -> usize {
    let taken = Job::all(Kind::Snapshot, 0)
        .get(index)
        .map(|job| sums::snapshot(job.case));
    match taken {
        Some(Ok(snapshot)) => {
            *bytes() = snapshot;
            bytes().len()
        }
        _ => 0,
    }
}

/// Continues from the snapshot in memory, and returns the length of the line.
#[unsafe(no_mangle)]
pub extern "C" fn restore(index: usize) -> usize {
    let taken = std::mem::take(&mut *bytes());
    let job = Job::all(Kind::Snapshot, 0).get(index).copied();
    job.map_or(0, |job| answer(job.line(1, Some(taken))))
}
