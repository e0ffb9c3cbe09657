//! Snapshots from bytes. A restored environment continues, or an error says why it cannot.
#![no_main]

#[path = "common/env.rs"]
mod env;

use std::cell::RefCell;

use babybench::Env;
use babybench::env::Snapshot;
use libfuzzer_sys::fuzz_target;

thread_local! {
    static MIMO: RefCell<Env> = RefCell::new(env::mimo());
    static SMALL: RefCell<Env> = RefCell::new(env::small());
}

/// Bytes before those that the checksum covers; the last eight are the checksum itself.
const HEADER: usize = 32;

/// The checksum of a snapshot, eight bytes at a time.
fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mix = |h: u64, w: u64| (h ^ w).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let h = words
        .iter()
        .fold(bytes.len() as u64, |h, w| mix(h, u64::from_le_bytes(*w)));
    rest.iter().fold(h, |h, b| mix(h, u64::from(*b)))
}

/// Returns a snapshot with some bytes replaced. `data` lists the places and the new bytes.
fn changed(data: &[u8], snapshot: &Snapshot) -> Vec<u8> {
    let mut bytes = snapshot.as_bytes().to_vec();
    for change in data.chunks(10) {
        let [low, high, new @ ..] = change else { continue };
        let at = HEADER + usize::from(u16::from_le_bytes([*low, *high])) % (bytes.len() - HEADER);
        for (to, from) in bytes[at..].iter_mut().zip(new) {
            *to = *from;
        }
    }
    let sum = checksum(&bytes[HEADER..]);
    bytes[HEADER - 8..HEADER].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// Restores bytes, takes some steps, and restores the earlier state.
fn check(env: &mut Env, make: impl FnOnce(&Snapshot) -> Vec<u8>, steps: usize) {
    let before = env.snapshot();
    let Ok(snapshot) = Snapshot::from_bytes(make(&before)) else {
        return;
    };
    let _ = snapshot.info();
    if env.restore(&snapshot).is_err() {
        assert!(env.snapshot() == before, "a refused snapshot changed something");
        return;
    }
    let taken = env.snapshot();
    env.restore(&taken).expect("it was taken here");
    assert!(env.snapshot() == taken, "restored, it is another one");
    let action = vec![0.5; env.action_space().len()];
    for _ in 0..steps {
        let Ok(step) = env.step(&action) else { break };
        assert!(
            step.observation.proprioception.iter().all(|v| v.is_finite()),
            "not finite"
        );
    }
    env.restore(&before).expect("it was taken here");
    assert!(env.snapshot() == before, "it does not come back");
}

fuzz_target!(|data: &[u8]| {
    // the first byte tells whose snapshot is changed
    match data.split_first() {
        Some((0 | 1, rest)) => {
            let steps = usize::from(env::goes_on(data));
            MIMO.with_borrow_mut(|env| check(env, |own| changed(rest, own), steps));
        }
        Some((kind @ 2..=5, rest)) => {
            let steps = usize::from(*kind) - 2;
            SMALL.with_borrow_mut(|env| check(env, |own| changed(rest, own), steps));
        }
        _ => SMALL.with_borrow_mut(|env| check(env, |_| data.to_vec(), 1)),
    }
});
