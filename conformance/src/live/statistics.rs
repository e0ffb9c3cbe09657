//! Statistics of long random rollouts, compared with those of MuJoCo with other seeds.

use babybench::mimo::MimoJoints;

use super::one_step::Maker;
use super::{Case, Drive, Motion, parallel};
use crate::mujoco::{Mujoco, Simulation};

/// Steps between two samples.
const EVERY: usize = 5;

/// Steps before the first sample.
const WARM_UP: usize = 100;

/// Names of the sampled quantities.
pub const QUANTITIES: [&str; 6] = [
    "contacts",
    "normal forces, total",
    "joint angles (of their range)",
    "joint velocities",
    "kinetic energy",
    "potential energy",
];

/// Samples of a run, by quantity.
type Samples = [Vec<f64>; QUANTITIES.len()];

/// Distances between distributions of a quantity: largest difference of the cumulative distribution functions
/// (Kolmogorov and Smirnov), of a run against all of MuJoCo's runs with other seeds.
pub struct Spread {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Distances of our runs.
    pub ours: Vec<f64>,
    /// Distances of MuJoCo's own runs.
    pub mujoco: Vec<f64>,
}

impl Spread {
    /// Returns whether our runs are on average no farther than MuJoCo's farthest.
    pub fn inside(&self) -> bool {
        let mean = self.ours.iter().sum::<f64>() / self.ours.len() as f64;
        mean <= self.mujoco.iter().fold(0.0, |a: f64, &b| a.max(b))
    }
}

/// The engine.
#[derive(Clone, Copy)]
enum Who {
    Ours,
    MuJoCo,
}

/// Runs both sides with `seeds` seeds for `steps` steps under held random controls.
///
/// # Errors
/// MuJoCo does not load the scene; the engine fails.
pub fn spreads(
    api: &'static Mujoco,
    case: &Case,
    make: Maker,
    seeds: u64,
    steps: usize,
) -> Result<Vec<Spread>, String> {
    let runs: Vec<(Who, u64)> = (0..seeds).flat_map(|s| [(Who::Ours, s), (Who::MuJoCo, s)]).collect();
    let all = parallel(
        &runs,
        || (case.simulation(api), make(case)),
        |(simulation, engine), (who, seed)| {
            let simulation = simulation.as_mut().map_err(|e| e.clone())?;
            match who {
                Who::Ours => run_ours(case, &mut **engine, simulation, *seed, steps),
                Who::MuJoCo => Ok(run_mujoco(case, simulation, *seed, steps)),
            }
        },
    );
    let all: Vec<Samples> = all.into_iter().collect::<Result<_, String>>()?;
    let (ours, mujoco): (Vec<_>, Vec<_>) = all.chunks_exact(2).map(|pair| (&pair[0], &pair[1])).unzip();
    let spread = |q: usize| {
        let against = |samples: &Samples, seed: usize| {
            let others = mujoco.iter().enumerate().filter(|(s, _)| *s != seed);
            let pool = others.flat_map(|(_, run)| run[q].iter().copied()).collect();
            distance(samples[q].clone(), pool)
        };
        Spread {
            quantity: QUANTITIES[q],
            ours: ours.iter().enumerate().map(|(s, run)| against(run, s)).collect(),
            mujoco: mujoco.iter().enumerate().map(|(s, run)| against(run, s)).collect(),
        }
    };
    Ok((0..QUANTITIES.len()).map(spread).collect())
}

/// Returns the largest difference between the cumulative distribution functions of two samples.
fn distance(mut a: Vec<f64>, mut b: Vec<f64>) -> f64 {
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let (mut i, mut k, mut worst) = (0, 0, 0.0_f64);
    while i < a.len() && k < b.len() {
        let x = a[i].min(b[k]);
        while i < a.len() && a[i] <= x {
            i += 1;
        }
        while k < b.len() && b[k] <= x {
            k += 1;
        }
        worst = worst.max((i as f64 / a.len() as f64 - k as f64 / b.len() as f64).abs());
    }
    worst
}

struct Sampler<'a> {
    case: &'a Case,
    joints: MimoJoints,
    samples: Samples,
}

impl<'a> Sampler<'a> {
    fn new(case: &'a Case) -> Self {
        Self {
            case,
            joints: MimoJoints::new(&case.model),
            samples: Default::default(),
        }
    }

    fn add(&mut self, qpos: &[f64], qvel: &[f64], contacts: usize, normal: f64) {
        self.samples[0].push(contacts as f64);
        self.samples[1].push(normal);
        for (k, &j) in self.joints.joint.iter().enumerate() {
            let [low, high] = self.case.model.jnt_range[j];
            self.samples[2].push((qpos[self.joints.qpos[k]] - low) / (high - low));
            self.samples[3].push(qvel[self.joints.dof[k]]);
        }
    }

    /// Samples the energies of some motions, which MuJoCo evaluates for both sides.
    fn energies(&mut self, evaluator: &mut Simulation, motions: &[[Vec<f64>; 2]]) {
        for [qpos, qvel] in motions {
            let [potential, kinetic] = evaluator.energy_at(qpos, qvel);
            self.samples[4].push(kinetic);
            self.samples[5].push(potential);
        }
    }
}

fn wanted(step: usize) -> bool {
    step >= WARM_UP && step.is_multiple_of(EVERY)
}

fn run_mujoco(case: &Case, simulation: &mut Simulation, seed: u64, steps: usize) -> Samples {
    let mut sampler = Sampler::new(case);
    let mut drive = Drive::new(&case.model, Motion::Hold, seed);
    let mut ctrl = vec![0.0; case.model.nu()];
    let mut motions = Vec::new();
    simulation.reset();
    simulation.set_params(&case.model, &case.params);
    for k in 0..steps {
        drive.set(k, &mut ctrl);
        simulation.set_ctrl(&ctrl);
        simulation.step();
        if wanted(k) {
            let normal = simulation.contacts().iter().map(|c| c.force[0]).sum();
            sampler.add(simulation.qpos(), simulation.qvel(), simulation.ncon(), normal);
            motions.push([simulation.qpos().to_vec(), simulation.qvel().to_vec()]);
        }
    }
    sampler.energies(simulation, &motions);
    sampler.samples
}

fn run_ours(
    case: &Case,
    engine: &mut dyn babybench::physics::Engine,
    evaluator: &mut Simulation,
    seed: u64,
    steps: usize,
) -> Result<Samples, String> {
    let mut sampler = Sampler::new(case);
    let mut drive = Drive::new(&case.model, Motion::Hold, seed);
    let mut state = engine.new_state();
    state.params.clone_from(&case.params);
    let mut motions = Vec::new();
    for k in 0..steps {
        drive.set(k, &mut state.ctrl);
        engine
            .step(&mut state)
            .map_err(|e| format!("{} seed {seed}: {e}", case.name))?;
        if wanted(k) {
            let normal = state.contact.iter().map(|c| c.force[0]).sum();
            sampler.add(&state.qpos, &state.qvel, state.contact.len(), normal);
            motions.push([state.qpos.clone(), state.qvel.clone()]);
        }
    }
    evaluator.set_params(&case.model, &case.params);
    sampler.energies(evaluator, &motions);
    Ok(sampler.samples)
}
