//! Comparison of a document that both sides accept.

use babybench::Model;
use babybench::physics::{Engine, State};
use fastrand::Rng;
use serde::{Deserialize, Serialize};

use crate::differential::compare::Sides;
use crate::differential::slack::Slack;
use crate::live::one_step::TIGHT;
use crate::live::speed::{copy_motion, cpu_time, quartiles};
use crate::loading::other_names;
use crate::measure::{Summary, max_abs, or_nan, relative};

/// Episodes from which states are taken, and states of each, one every other step.
const EPISODES: u64 = 4;
const STATES: usize = 50;

/// Steps between new random controls.
const HELD: usize = 10;

/// Steps of a rollout.
const ROLLOUT: usize = 100;

/// Distance between the starts of MuJoCo's two rollouts.
const APART: f64 = 1e-10;

/// Batches of steps whose CPU times are compared, and steps of a batch.
const BATCHES: usize = 12;
const BATCH: usize = 25;

/// Times that MuJoCo is stepped from nearly the same state where the sides differ.
const NUDGES: usize = 8;

/// Error of the acceleration above which MuJoCo's own spread is measured.
pub const LARGE: f64 = 1e-6;

/// The distance of a rollout from MuJoCo's.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Rollout {
    /// Largest difference of the coordinates after the last step.
    #[serde(deserialize_with = "or_nan")]
    pub ours: f64,
    /// The same for MuJoCo from a start 1e-10 away.
    #[serde(deserialize_with = "or_nan")]
    pub floor: f64,
}

/// Figures of a document.
#[derive(Deserialize, Serialize)]
pub struct Figures {
    /// Degrees of freedom.
    pub nv: usize,
    /// The largest difference of a compiled array, in units of its limit.
    #[serde(deserialize_with = "or_nan")]
    pub arrays: f64,
    /// The array with that difference, and its place.
    pub farthest_array: String,
    /// States compared.
    pub states: usize,
    /// Contacts on average.
    #[serde(deserialize_with = "or_nan")]
    pub contacts: f64,
    /// States in which the numbers of contacts differ.
    pub other_contacts: usize,
    /// Relative errors of the acceleration.
    pub qacc: Summary,
    /// The largest of them that neither the cost at which solvers stop ([`Slack`]) nor a spread of MuJoCo's own explains.
    #[serde(deserialize_with = "or_nan")]
    pub unexplained: f64,
    /// A rollout; `None` where one side diverges.
    pub rollout: Option<Rollout>,
    /// CPU time of a step over MuJoCo's: median over batches.
    #[serde(deserialize_with = "or_nan")]
    pub cpu: f64,
    /// The error of our step, if it failed.
    pub failure: Option<String>,
}

impl Figures {
    /// Returns whether both sides agree about the document.
    pub fn agrees(&self) -> bool {
        self.arrays <= 1.0 && self.other_contacts == 0 && self.unexplained <= LARGE && self.failure.is_none()
    }
}

/// Draws controls in their ranges.
fn controls(model: &Model, rng: &mut Rng, ctrl: &mut [f64]) {
    for ((ctrl, [low, high]), limited) in ctrl
        .iter_mut()
        .zip(&model.actuator_ctrlrange)
        .zip(&model.actuator_ctrllimited)
    {
        let [low, high] = if *limited { [*low, *high] } else { [-1.0, 1.0] };
        *ctrl = low + (high - low) * rng.f64();
    }
}

/// Measures everything.
pub fn figures(sides: &mut Sides) -> Figures {
    let model = sides.model.clone();
    let worst = sides.arrays().into_iter().map(|m| (m.error / m.limit, m.place));
    let none = match other_names(&model, sides.simulation()) {
        Some(names) => (f64::INFINITY, names),
        None => (0.0, String::new()),
    };
    let (arrays, farthest_array) = worst.fold(none, |worst, next| if next.0 > worst.0 { next } else { worst });
    let mut out = Figures {
        nv: model.nv,
        arrays,
        farthest_array,
        states: 0,
        contacts: 0.0,
        other_contacts: 0,
        qacc: Summary::new([]),
        unexplained: 0.0,
        rollout: None,
        cpu: f64::NAN,
        failure: None,
    };
    // models with different elements have different states
    if model.nv == 0 || out.arrays.is_infinite() {
        return out;
    }
    let (mut errors, mut start) = (Vec::new(), None);
    for seed in 0..EPISODES {
        episode(sides, seed, &mut |sides, state| {
            start.get_or_insert_with(|| state.clone());
            step(sides, state, &mut out, &mut errors);
        });
    }
    out.contacts /= out.states.max(1) as f64;
    out.qacc = Summary::new(errors);
    if let Some(start) = start {
        out.rollout = rollout(sides, &start);
        out.cpu = cpu(sides, &start);
    }
    out
}

/// Lets MuJoCo move under random controls, and passes on the states that it visits.
fn episode(sides: &mut Sides, seed: u64, see: &mut dyn FnMut(&mut Sides, &State)) {
    let model = sides.model.clone();
    let mut rng = Rng::with_seed(seed);
    let mut state = sides.new_state();
    state.qvel.iter_mut().for_each(|v| *v = 2.0 * rng.f64() - 1.0);
    for k in 0..2 * STATES {
        if k.is_multiple_of(HELD) {
            controls(&model, &mut rng, &mut state.ctrl);
        }
        if k % 2 == 1 {
            see(sides, &state);
        }
        if !sides.step_mujoco(&state) {
            return;
        }
        copy_motion(sides.simulation(), &mut state);
    }
}

fn step(sides: &mut Sides, start: &State, out: &mut Figures, errors: &mut Vec<f64>) {
    if !sides.step_mujoco(start) {
        return;
    }
    let (qacc, contacts) = (sides.simulation().qacc().to_vec(), sides.simulation().ncon());
    let mut state = sides.new_state();
    state.copy_dynamic_from(start);
    out.states += 1;
    out.contacts += contacts as f64;
    if let Err(e) = sides.engine().step(&mut state) {
        out.failure.get_or_insert(e.to_string());
        return;
    }
    let error = relative(&state.qacc, &qacc);
    errors.push(error);
    let same = state.contact.len() + state.flex_contact.len() == contacts;
    if same && error <= LARGE {
        return;
    }
    // a solver that stops at a small cost leaves more undone than there is of an acceleration that is nearly zero
    let slack = Slack::new(&sides.model.clone(), sides.simulation());
    if same && slack.accelerations(&state.qacc, &qacc).is_some() {
        return;
    }
    let (own, others) = spread(sides, start, &qacc, contacts);
    out.other_contacts += usize::from(!same && !others);
    if error.is_nan() || error > 3.0 * own {
        out.unexplained = out.unexplained.max(error);
    }
}

/// Returns how far MuJoCo is from itself when the last bits of the positions change and when its solver iterates to convergence, which no
/// tolerance can demand where forces are huge. Also returns whether the contacts differ then.
fn spread(sides: &mut Sides, start: &State, qacc: &[f64], contacts: usize) -> (f64, bool) {
    let (mut own, mut others, mut rng) = (0.0_f64, false, Rng::with_seed(1));
    for _ in 0..NUDGES {
        let mut nudged = start.clone();
        nudged
            .qpos
            .iter_mut()
            .for_each(|v| *v *= 1.0 + f64::EPSILON * f64::from(rng.i8(-1..=1)));
        if sides.step_mujoco(&nudged) {
            own = own.max(relative(sides.simulation().qacc(), qacc));
            others |= sides.simulation().ncon() != contacts;
        }
    }
    let (tight, ls_tight, iterations) = TIGHT;
    let before = sides.simulation().set_tolerance(tight, ls_tight, iterations);
    if sides.step_mujoco(start) {
        own = own.max(relative(sides.simulation().qacc(), qacc));
    }
    let (tolerance, ls_tolerance, iterations) = before;
    sides.simulation().set_tolerance(tolerance, ls_tolerance, iterations);
    (own, others)
}

/// Rolls MuJoCo out; returns the coordinates at the end.
fn path(sides: &mut Sides, start: &State) -> Option<Vec<f64>> {
    let mut going = sides.step_mujoco(start);
    for _ in 1..ROLLOUT {
        going &= sides.simulation().try_step().is_ok() && sides.simulation().warnings() == 0;
    }
    going.then(|| sides.simulation().qpos().to_vec())
}

fn rollout(sides: &mut Sides, start: &State) -> Option<Rollout> {
    let theirs = path(sides, start)?;
    let mut apart = start.clone();
    let mut rng = Rng::with_seed(2);
    apart
        .qpos
        .iter_mut()
        .for_each(|v| *v += if rng.bool() { APART } else { -APART });
    let other = path(sides, &apart)?;
    let mut state = start.clone();
    for _ in 0..ROLLOUT {
        sides.engine().step(&mut state).ok()?;
    }
    Some(Rollout {
        ours: max_abs(&state.qpos, &theirs),
        floor: max_abs(&other, &theirs),
    })
}

/// Measures CPU times of alternating steps, on the same states, with the model's sensors.
fn cpu(sides: &mut Sides, start: &State) -> f64 {
    let mut ratios = Vec::new();
    let mut state = start.clone();
    for batch in 0..=BATCHES {
        if !sides.step_mujoco(&state) {
            break;
        }
        let begin = cpu_time();
        let stepped = (0..BATCH).all(|_| sides.simulation().try_step().is_ok());
        let theirs = cpu_time() - begin;
        let mut ours = state.clone();
        let begin = cpu_time();
        let going =
            sides.engine().step(&mut ours).is_ok() && (1..=BATCH).all(|_| sides.engine().step(&mut ours).is_ok());
        let time = cpu_time() - begin;
        if !stepped || !going {
            break;
        }
        if batch > 0 {
            ratios.push(time / theirs * BATCH as f64 / (BATCH + 1) as f64);
        }
        copy_motion(sides.simulation(), &mut state);
    }
    if ratios.is_empty() {
        f64::NAN
    } else {
        quartiles(ratios)[1]
    }
}
