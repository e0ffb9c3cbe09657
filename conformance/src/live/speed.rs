//! CPU time of our step against MuJoCo's, on the same states, in one process, alternating.

use babybench::physics::{Engine, EngineError, State};
use rustix::time::{ClockId, clock_gettime};

use super::{Case, Drive, Motion};
use crate::mujoco::{Mujoco, Simulation};

/// Steps that one side takes before the other side's turn, so that caches are as warm as in a run.
const BATCH: usize = 25;

/// Steps before the measurement.
const SETTLING: usize = 100;

/// Costs of a scene under a motion.
pub struct Speed {
    /// Version and scene.
    pub case: String,
    /// The way MIMo was moved.
    pub motion: Motion,
    /// CPU time of our step over MuJoCo's: quartiles over batches.
    pub ratio: [f64; 3],
    /// Median CPU time of our step, us.
    pub ours: f64,
    /// Median CPU time of MuJoCo's step, us.
    pub mujoco: f64,
    /// Contacts on average.
    pub contacts: f64,
}

/// Returns the CPU time of this thread, s.
pub fn cpu_time() -> f64 {
    let t = clock_gettime(ClockId::ThreadCPUTime);
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

/// Returns the first quartile, the median and the third quartile.
pub fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|q| {
        values
            .get(values.len().saturating_sub(1) * q / 4)
            .copied()
            .unwrap_or(0.0)
    })
}

/// Measures `batches` batches. MuJoCo runs with the model's own options except for its sensors, which are off, so both sides do physics
/// only. Before each batch both are set to the same state. The order within a batch alternates.
///
/// # Errors
/// MuJoCo does not load the scene; the engine fails.
pub fn measure(
    api: &'static Mujoco,
    case: &Case,
    engine: &mut dyn Engine,
    motion: Motion,
    batches: usize,
) -> Result<Speed, String> {
    let mut simulation = case.simulation(api)?;
    simulation.disable_sensors(true);
    let mut state = engine.new_state();
    state.params.clone_from(&case.params);
    let mut drive = Drive::new(&case.model, motion, 1);
    (0..SETTLING).for_each(|_| simulation.step());
    let (mut ratios, mut us) = (Vec::new(), [Vec::new(), Vec::new()]);
    let mut contacts = 0;
    let mut ctrl = vec![vec![0.0; case.model.nu()]; BATCH];
    for batch in 0..batches + 1 {
        controls(&mut drive, batch, &mut ctrl);
        copy_motion(&simulation, &mut state);
        let ours = |state: &mut State, engine: &mut dyn Engine| -> Result<f64, EngineError> {
            let start = cpu_time();
            for c in &ctrl {
                state.ctrl.copy_from_slice(c);
                engine.step(state)?;
            }
            Ok(cpu_time() - start)
        };
        let theirs = |simulation: &mut Simulation| {
            let start = cpu_time();
            for c in &ctrl {
                simulation.set_ctrl(c);
                simulation.step();
            }
            cpu_time() - start
        };
        let (a, b) = if batch % 2 == 0 {
            let a = ours(&mut state, engine);
            (a, theirs(&mut simulation))
        } else {
            let b = theirs(&mut simulation);
            (ours(&mut state, engine), b)
        };
        let a = a.map_err(|e| format!("{} {}: {e}", case.name, motion.name()))?;
        if batch > 0 {
            ratios.push(a / b);
            us[0].push(1e6 * a / BATCH as f64);
            us[1].push(1e6 * b / BATCH as f64);
            contacts += simulation.ncon();
        }
    }
    let [ours, mujoco] = us.map(|us| quartiles(us)[1]);
    Ok(Speed {
        case: case.name.clone(),
        motion,
        ratio: quartiles(ratios),
        ours,
        mujoco,
        contacts: contacts as f64 / batches as f64,
    })
}

/// Creates the controls of a batch. Each continues from the previous one.
fn controls(drive: &mut Drive, batch: usize, ctrl: &mut [Vec<f64>]) {
    for k in 0..BATCH {
        if k > 0 {
            let (done, rest) = ctrl.split_at_mut(k);
            rest[0].copy_from_slice(&done[k - 1]);
        } else if let [first, .., last] = &mut *ctrl {
            first.copy_from_slice(last);
        }
        drive.set(batch * BATCH + k, &mut ctrl[k]);
    }
}

/// Copies positions, velocities, activations and warm start from MuJoCo to our engine.
pub fn copy_motion(simulation: &Simulation, state: &mut State) {
    state.qpos.copy_from_slice(simulation.qpos());
    state.qvel.copy_from_slice(simulation.qvel());
    // where MuJoCo has none, those of the state are MIMo's muscles'
    if !simulation.act().is_empty() {
        state.act.copy_from_slice(simulation.act());
    }
    state.qacc_warmstart.copy_from_slice(simulation.qacc_warmstart());
}
