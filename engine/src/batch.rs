//! Batches on threads.

use mjcf_sim_physics::{Batch, BatchError, State};

/// Steps every state of a batch `steps` times, as [`Batch::rollout`] does, on at most `threads` threads and no more than the machine has
/// cores. It starts the threads and waits for them. They call `control` concurrently. The bits do not depend on the number of threads. In WebAssembly
/// the caller steps all states.
///
/// ```
/// use mjcf_sim::physics::{Batch, SoftOptions};
/// use mjcf_sim::{Simulation, rollout_on};
///
/// let arm = Simulation::from_text("<mujoco><worldbody><body><joint name='hinge'/><geom size='.1' pos='1 0 0'/></body></worldbody>
///   <actuator><motor joint='hinge'/></actuator></mujoco>")?;
/// let mut batch = Batch::new(arm.model().clone(), SoftOptions::default(), 64);
/// rollout_on(&mut batch, 4, 50, |index, _step, state| state.ctrl[0] = index as f64 / 31.5 - 1.0)?;
/// assert!(batch.states()[63].qpos[0] > batch.states()[0].qpos[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`Batch::rollout`].
///
/// # Panics
/// If `control` panics, or the operating system cannot start a thread.
pub fn rollout_on(
    batch: &mut Batch,
    threads: usize,
    steps: usize,
    control: impl Fn(usize, usize, &mut State) + Sync,
) -> Result<(), BatchError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.min(cores);
    if threads <= 1 || cfg!(target_arch = "wasm32") {
        return batch.rollout(steps, control);
    }
    let control = &control;
    std::thread::scope(|scope| {
        let running: Vec<_> = batch
            .split(threads)
            .map(|mut part| scope.spawn(move || part.rollout(steps, control)))
            .collect();
        let ended = |thread: std::thread::ScopedJoinHandle<'_, _>| {
            // a panic of `control` is the caller's
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        running.into_iter().try_for_each(ended)
    })
}
