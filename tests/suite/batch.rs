//! Many states of one model, stepped together.

use babybench::Config;
use babybench::config::{Behavior, Scene};
use babybench::physics::{Batch, BatchError, BatchPart, Engine, EngineError, SoftEngine, SoftOptions, State};

use crate::allocations;
use crate::common::*;

const COUNT: usize = 7;
const STEPS: usize = 60;

/// A state of MIMo in the crib, with contacts.
fn start() -> (Batch, SoftEngine, State) {
    let config = Config {
        vision_active: false,
        touch_active: false,
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    let mut env = env(config);
    env.reset(Some(0)).expect("no divergence");
    let (model, state) = (env.model().clone(), env.state().clone());
    let batch = Batch::new(model.clone(), SoftOptions::default(), COUNT);
    (batch, SoftEngine::new(model, SoftOptions::default()), state)
}

fn control(index: usize, step: usize, state: &mut State) {
    let phase = (index + 1) as f64 * 0.1 + step as f64 * 0.05;
    for (k, ctrl) in state.ctrl.iter_mut().enumerate() {
        *ctrl = 0.5 * (phase * (1.0 + k as f64 / 10.0)).sin();
    }
}

/// Steps a batch in a number of threads. Returns the first error.
fn rollout(
    batch: &mut Batch,
    steps: usize,
    threads: usize,
    control: fn(usize, usize, &mut State),
) -> Result<(), BatchError> {
    std::thread::scope(|scope| {
        let parts: Vec<_> = batch.split(threads).collect();
        assert!(!parts.is_empty() && parts.len() <= threads);
        let spawn = |mut part: BatchPart<'_>| part.rollout(steps, control);
        let handles: Vec<_> = parts.into_iter().map(|part| scope.spawn(move || spawn(part))).collect();
        let results: Vec<_> = handles
            .into_iter()
            .map(|handle| handle.join().expect("no panic"))
            .collect();
        results.into_iter().collect()
    })
}

fn bits(state: &State) -> Vec<u64> {
    state
        .qpos
        .iter()
        .chain(&state.qvel)
        .chain(&state.qacc)
        .map(|v| v.to_bits())
        .collect()
}

#[test]
fn every_state_has_the_bits_that_it_has_alone_in_any_number_of_threads() {
    let (mut batch, mut engine, from) = start();
    let alone: Vec<Vec<u64>> = (0..COUNT)
        .map(|index| {
            let mut state = engine.new_state();
            state.copy_dynamic_from(&from);
            for step in 0..STEPS {
                control(index, step, &mut state);
                engine.step(&mut state).expect("no divergence");
            }
            bits(&state)
        })
        .collect();
    assert_ne!(alone[0], alone[1]);
    for threads in [1, 2, 3, 100] {
        batch.fork(&from);
        rollout(&mut batch, STEPS, threads, control).expect("no divergence");
        let together: Vec<_> = batch.states().iter().map(bits).collect();
        assert!(together == alone, "{threads} threads");
    }
    // step by step, and on from a copy
    batch.fork(&from);
    for step in 0..STEPS {
        for (index, state) in batch.states_mut().iter_mut().enumerate() {
            control(index, step, state);
        }
        batch.step().expect("no divergence");
    }
    assert!(batch.states().iter().map(bits).eq(alone));
    batch.copy(3, 5);
    batch.rollout(1, |_, _, _| {}).expect("no divergence");
    assert_eq!(bits(&batch.states()[3]), bits(&batch.states()[5]));
}

#[test]
fn a_state_that_fails_does_not_hold_up_the_others() {
    let (mut batch, _, from) = start();
    for threads in [1, 2] {
        batch.fork(&from);
        let before = batch.states()[0].step;
        batch.states_mut()[2].ctrl[0] = f64::NAN;
        batch.states_mut()[4].qvel.pop();
        let error = rollout(&mut batch, 3, threads, |_, _, _| {}).expect_err("not finite");
        assert_eq!(error.index, 2);
        assert!(matches!(error.source, EngineError::NotFinite { .. }), "{error}");
        let steps: Vec<u64> = batch.states().iter().map(|state| state.step - before).collect();
        assert_eq!(steps, [3, 3, 0, 3, 0, 3, 3]);
        batch.states_mut()[4].qvel.push(0.0);
    }
    let none = Batch::new(batch.model().clone(), SoftOptions::default(), 0).step();
    assert_eq!(none, Ok(()));
}

#[test]
fn a_rollout_allocates_nothing_after_the_first() {
    let (mut batch, _, from) = start();
    batch.fork(&from);
    batch.rollout(STEPS, control).expect("no divergence");
    let before = allocations::of_this_thread();
    batch.fork(&from);
    batch.rollout(STEPS, control).expect("no divergence");
    assert_eq!(allocations::of_this_thread(), before);
}
