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

thread_local! { static ENV: RefCell<Env> = RefCell::new(env::env()); }

fuzz_target!(|data: &[u8]| {
    ENV.with_borrow_mut(|env| {
        let limits = Limits { npz_array_bytes: 1 << 20, ..Limits::default() };
        // the first byte tells whether the rest is an archive or what its arrays hold
        let (bytes, small) = match data.split_first() {
            Some((0, rest)) => (archive::from(rest, env), true),
            _ => (data.to_vec(), false),
        };
        let Ok(npz) = Npz::from_bytes_with(bytes, "f.npz", &limits) else { return };
        let Ok(recording) = Recording::read(&npz, env) else { return };
        if small && recording.len <= 2 {
            if let Ok(replayed) = replay(env, &recording, data.len() % 2 == 0) {
                assert_eq!(replayed.qpos.len(), recording.len * env.model().nq);
                assert!(replayed.qpos.iter().all(|v| v.is_finite()), "a position is not finite");
            }
        }
    });
});
