//! Invariant 4: a step allocates nothing after warm-up.

#[path = "common/allocations.rs"]
mod allocations;
mod common;

use babybench::Config;
use babybench::config::Example;
use common::*;

const WARM_UP: usize = 200;
/// Number of times that the steps are counted anew until none allocates: the view of a heap of toys may reach new maxima for a while.
const AGAIN: usize = 4;
const COUNTED: usize = 300;
/// At the end of the counted steps even vectors that grow to a new maximum have to be large enough.
const STRICT: usize = 100;

#[test]
fn invariant_4_a_step_allocates_nothing_after_warm_up() {
    let mut failed = Vec::new();
    let tasks = Example::TASKS.map(|task| (task.name, task.config().expect("valid")));
    let examples = EXAMPLES.map(|(name, _)| (name, example(name)));
    let two_threads = Config {
        vision_threads: 2,
        ..infant()
    };
    let infants = [("infant", infant()), ("infant, 2 threads", two_threads)];
    for (name, config) in examples.into_iter().chain(tasks).chain(infants) {
        let mut env = env(config);
        env.reset(Some(0)).expect("no divergence");
        random_steps(&mut env, WARM_UP);
        let mut action = Vec::new();
        env.sample_action(&mut action);
        // step, calls, bytes
        let mut seen: Vec<(usize, usize, usize)> = Vec::with_capacity(COUNTED);
        let (mut contacts, mut rows, mut late) = (0, 0, COUNTED);
        for _ in 0..AGAIN {
            seen.clear();
            for k in 0..COUNTED {
                env.sample_action(&mut action);
                let before = allocations::of_all_threads();
                let failed = env.step(&action).is_err();
                let after = allocations::of_all_threads();
                let (calls, bytes) = (after[0] - before[0], after[1] - before[1]);
                assert!(!failed, "{name}: step {k} failed");
                if calls > 0 {
                    seen.push((k, calls, bytes));
                }
                contacts = contacts.max(env.state().contact.len());
                rows = rows.max(env.state().nefc());
            }
            late = seen.iter().filter(|s| s.0 >= COUNTED - STRICT).count();
            if late == 0 {
                break;
            }
        }
        let [calls, _] = allocations::of_all_threads();
        env.reset(Some(1)).expect("no divergence");
        let reset = allocations::of_all_threads()[0] - calls;
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
