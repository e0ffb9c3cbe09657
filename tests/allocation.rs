//! Invariant 4: a step allocates nothing after warm-up.
#![allow(unsafe_code)] // a global allocator cannot be written without

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use common::*;

/// The system's allocator, counting what is asked of it.
struct Counting;

static CALLS: AtomicUsize = AtomicUsize::new(0);
static BYTES: AtomicUsize = AtomicUsize::new(0);

fn count(size: usize) {
    CALLS.fetch_add(1, Relaxed);
    BYTES.fetch_add(size, Relaxed);
}

// SAFETY: everything is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const WARM_UP: usize = 200;
const COUNTED: usize = 300;
/// At the end of the counted steps even vectors that grow to a new maximum have to be large enough.
const STRICT: usize = 100;

#[test]
fn invariant_4_a_step_allocates_nothing_after_warm_up() {
    let mut failed = Vec::new();
    for (name, _) in EXAMPLES {
        let mut env = env(example(name));
        env.reset(Some(0)).expect("no divergence");
        random_steps(&mut env, WARM_UP);
        let mut action = Vec::new();
        env.sample_action(&mut action);
        // step, calls, bytes
        let mut seen: Vec<(usize, usize, usize)> = Vec::with_capacity(COUNTED);
        let (mut contacts, mut rows) = (0, 0);
        for k in 0..COUNTED {
            env.sample_action(&mut action);
            let (calls, bytes) = (CALLS.load(Relaxed), BYTES.load(Relaxed));
            let failed = env.step(&action).is_err();
            let (calls, bytes) = (CALLS.load(Relaxed) - calls, BYTES.load(Relaxed) - bytes);
            assert!(!failed, "{name}: step {k} failed");
            if calls > 0 {
                seen.push((k, calls, bytes));
            }
            contacts = contacts.max(env.state().contacts.len());
            rows = rows.max(env.state().efc.nefc());
        }
        let calls = CALLS.load(Relaxed);
        env.reset(Some(1)).expect("no divergence");
        let reset = CALLS.load(Relaxed) - calls;
        let late = seen.iter().filter(|s| s.0 >= COUNTED - STRICT).count();
        println!(
            "{name:18} {} of {COUNTED} steps allocate ({late} of the last {STRICT}): {} calls, {} bytes; up to {contacts} \
             contacts, {rows} rows; a reset takes {reset} calls",
            seen.len(),
            seen.iter().map(|s| s.1).sum::<usize>(),
            seen.iter().map(|s| s.2).sum::<usize>(),
        );
        for (k, calls, bytes) in seen.iter().take(10) {
            println!("{:18}   step {k} after warm-up: {calls} calls, {bytes} bytes", "");
        }
        if late > 0 {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "steps allocate in {failed:?}");
}
