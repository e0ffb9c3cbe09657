//! Recordings: archives of arrays that are replayed for a few steps.
#![no_main]

#[path = "common/archive.rs"]
mod archive;
#[path = "common/env.rs"]
mod env;

use std::cell::RefCell;

use babybench::formats::npz::Npz;
use babybench::runs::{Recording, replay};
use babybench::{Env, Limits};
use libfuzzer_sys::fuzz_target;

thread_local! {
    static MIMO: RefCell<Env> = RefCell::new(env::mimo());
    static SMALL: RefCell<Env> = RefCell::new(env::small());
}

/// Longer recordings are only read, because their cost hides that of others.
const LONG: usize = 2;

/// Reads an archive as a recording of an environment, and perhaps replays it.
fn check(env: &mut Env, npz: &Npz, replayed: bool, one_step: bool) {
    let Ok(recording) = Recording::read(npz, env) else {
        return;
    };
    if replayed
        && recording.len <= LONG
        && let Ok(replayed) = replay(env, &recording, one_step)
    {
        assert_eq!(replayed.qpos.len(), recording.len * env.model().nq);
        assert!(replayed.qpos.iter().all(|v| v.is_finite()), "a position is not finite");
    }
}

fuzz_target!(|data: &[u8]| {
    let limits = Limits {
        npz_array_bytes: 1 << 20,
        ..Limits::default()
    };
    let read = |bytes: Vec<u8>| Npz::from_bytes_with(bytes, "f.npz", &limits);
    let one_step = data.len() % 2 == 0;
    // the first byte tells whether the rest is an archive or what its arrays hold
    match data.split_first() {
        Some((0, rest)) => MIMO.with_borrow_mut(|env| {
            let npz = read(archive::from(rest, env)).expect("an archive");
            check(env, &npz, env::goes_on(data), one_step);
        }),
        Some((1, rest)) => SMALL.with_borrow_mut(|env| {
            let npz = read(archive::from(rest, env)).expect("an archive");
            check(env, &npz, true, one_step);
        }),
        _ => {
            let Ok(npz) = read(data.to_vec()) else { return };
            SMALL.with_borrow_mut(|env| check(env, &npz, true, one_step));
            MIMO.with_borrow_mut(|env| check(env, &npz, env::goes_on(data), one_step));
        }
    }
});
