//! One document and its states on both sides.

use std::sync::Arc;

use babybench::Model;
use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::{LoadError, load_str};
use babybench::model::{IntegratorType, SolverType};
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};

use super::dice::numbers;
use super::matrix::scaled_condition;
use super::measured::{Measured, QACC, QPOS, QVEL, activations, advanced, measure};
use super::state::Recipe;
use crate::loading::{SINGULAR, deliberate, distances};
use crate::measure::{max_abs, relative};
use crate::mujoco::{Contact, Mujoco, Simulation};

/// Scaled condition of the inertia above which MuJoCo's own accelerations are noise.
const CONDITION: f64 = 1e8;

/// Regularisation of a constraint row below which they are also noise.
const REGULARISATION: f64 = 1e-13;

/// A row of the Jacobian with no larger entry than this is rounding error: its constraint moves nothing. MuJoCo leaves out only rows of
/// zeros.
const RATE: f64 = 1e-12;

/// Largest position and velocity from which MuJoCo continues.
const MAX_VALUE: f64 = 1e10;

/// Times that MuJoCo is stepped from nearly the same state where the sides differ.
const NUDGES: u64 = 8;

/// Last bits by which positions and velocities then change. One is enough, except where a solver stops at its limit of iterations, far
/// from the minimum: there it is the difference between the rows of both sides, which each iteration amplifies.
const BITS: [i32; 2] = [1, 512];

/// Result of giving a document to both sides.
pub enum Taken {
    /// Neither side loads it, and why ours does not.
    Refused(String),
    /// Ours refuses what MuJoCo loads, deliberately.
    Stricter(&'static str),
    /// Only one side loads it.
    ByOne(Measured),
    /// Both load it.
    Both(Box<Sides>),
}

/// Result of a step from one state on both sides.
pub enum Stepped {
    /// MuJoCo gives up or warns, for example about numbers that are not finite, or would in the next step.
    Diverged,
    /// MuJoCo's own numbers are noise there: an inertia that is nearly singular, or almost no regularisation.
    Noise,
    /// The quantities of both sides.
    Compared {
        /// All quantities.
        measured: Vec<Measured>,
        /// The cause of a difference between the sides.
        why: Why,
        /// Contacts.
        contacts: usize,
        /// Constraint rows.
        rows: usize,
    },
}

/// The cause of a difference.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Why {
    /// Not a behavior of MuJoCo itself.
    Ours,
    /// MuJoCo itself jumps as far when the last bits of positions and velocities change.
    Jump,
    /// Conjugate gradients end at their limit of iterations, before the minimum, from the same rows: rounding errors have grown in each.
    Cut,
}

/// A document that both sides have loaded.
pub struct Sides {
    /// Our model.
    pub model: Arc<Model>,
    engine: SoftEngine,
    simulation: Simulation,
    condition: f64,
}

impl Sides {
    /// Loads a document with both sides.
    pub fn load(api: &'static Mujoco, text: &str) -> Taken {
        let ours = our_model(text);
        let theirs = Simulation::new(api, "m.xml", &[("m.xml", text.as_bytes())]);
        match (ours, theirs) {
            (Err(e), Err(_)) => Taken::Refused(e.to_string()),
            // what MuJoCo's own solver cannot handle while it compiles
            (Ok(_), Err(e)) if e.contains("engine error") => Taken::Refused(e),
            (Ok(_), Err(e)) => Taken::ByOne(Measured::new(
                "taken",
                1.0,
                0.0,
                format!("MuJoCo refuses: {}", e.trim()),
            )),
            (Err(e), Ok(simulation)) => match deliberate(&e) {
                Some(reason) if reason != SINGULAR || !sound(simulation) => Taken::Stricter(reason),
                _ => Taken::ByOne(Measured::new("taken", 1.0, 0.0, format!("ours refuses: {e}"))),
            },
            (Ok(model), Ok(simulation)) => Taken::Both(Box::new(Self::new(Arc::new(model), simulation))),
        }
    }

    /// Compares both sides.
    pub fn new(model: Arc<Model>, mut simulation: Simulation) -> Self {
        let condition = match simulation.try_forward() {
            Ok(()) => scaled_condition(&simulation.full_inertia(), model.nv),
            Err(_) => f64::INFINITY,
        };
        let options = SoftOptions {
            double_weld_torque: true,
            ..SoftOptions::default()
        };
        let engine = SoftEngine::new(model.clone(), options);
        Self {
            model,
            engine,
            simulation,
            condition,
        }
    }

    /// Returns MuJoCo's side.
    pub fn simulation(&mut self) -> &mut Simulation {
        &mut self.simulation
    }

    /// Returns our side.
    pub fn engine(&mut self) -> &mut SoftEngine {
        &mut self.engine
    }

    /// Returns a state of ours at `qpos0`.
    pub fn new_state(&self) -> State {
        self.engine.new_state()
    }

    /// Compares the compiled arrays. Those that need the inverse of the inertia may differ as much as its condition explains.
    pub fn arrays(&self) -> Vec<Measured> {
        let all = distances(&self.model, &self.simulation).into_iter();
        let measured = all.filter_map(|distance| {
            let mut limit = distance.limit;
            // springs and dampers may follow from inverse weights
            if distance.name.ends_with("invweight0")
                || ["jnt_stiffness", "dof_damping", "actuator_acc0"].contains(&distance.name)
            {
                if self.condition > CONDITION {
                    return None;
                }
                limit = limit.max(1e-13 * self.condition);
            }
            Some(Measured::new(distance.name, distance.error, limit, distance.place))
        });
        measured.collect()
    }

    /// Steps both sides from a random state.
    pub fn step(&mut self, recipe: &Recipe) -> Stepped {
        let mut state = self.engine.new_state();
        recipe.fill(&self.model, &mut state);
        self.step_from(&state)
    }

    /// Steps both sides from a state.
    pub fn step_from(&mut self, start: &State) -> Stepped {
        // Where a step evaluates several states, what is computed shows at its start: later ones have the rounding errors of the
        // first, as much greater as the forces are stiff.
        let first = (self.model.opt.integrator == IntegratorType::Rk4).then(|| {
            let mut state = self.copy(start);
            self.engine.forward(&mut state).is_ok().then_some(state)
        });
        let first = first.flatten();
        let mut state = self.copy(start);
        let ours = self.engine.step(&mut state);
        let Some(computed) = self.advance(start, first.as_ref()) else {
            return Stepped::Diverged;
        };
        let theirs = &self.simulation;
        let condition = scaled_condition(&theirs.full_inertia(), self.model.nv);
        if condition > CONDITION || self.condition > CONDITION || self.has_noisy_rows(&state) {
            return Stepped::Noise;
        }
        let (contacts, rows) = (theirs.ncon(), theirs.nefc());
        if let Err(e) = ours {
            // MuJoCo checks these at the start of the next step
            let beyond = |values: &[f64]| values.iter().any(|v| v.abs() > 1e10);
            if beyond(theirs.qpos()) || beyond(theirs.qvel()) {
                return Stepped::Diverged;
            }
            let measured = vec![Measured::new("steps", 1.0, 0.0, format!("ours fails: {e}"))];
            return Stepped::Compared {
                why: if self.is_cut(&measured) { Why::Cut } else { Why::Ours },
                measured,
                contacts,
                rows,
            };
        }
        let measured = self.measured(computed, &state);
        let mut why = Why::Ours;
        let wrong: Vec<Measured> = measured.iter().filter(|m| !m.agrees()).cloned().collect();
        if !wrong.is_empty() {
            if self.jumps(start, &wrong) {
                why = Why::Jump;
            } else if self.is_cut(&wrong) {
                why = Why::Cut;
            }
        }
        Stepped::Compared {
            measured,
            why,
            contacts,
            rows,
        }
    }

    /// Returns a copy of a state, for our engine.
    fn copy(&self, of: &State) -> State {
        let mut state = self.engine.new_state();
        state.copy_dynamic_from(of);
        state
    }

    /// Steps MuJoCo from a state, and measures its results against ours, if given; `None` if it diverges.
    fn advance(&mut self, start: &State, first: Option<&State>) -> Option<Option<Vec<Measured>>> {
        let mut computed = None;
        if let Some(first) = first {
            self.simulation.reset();
            self.simulation.set_state(&self.model, start);
            if self.simulation.try_forward().is_ok() {
                computed = Some(measure(&self.model, first, &self.simulation));
            }
        }
        self.step_mujoco(start).then_some(computed)
    }

    /// Returns whether rows on either side have almost no regularisation, or a Jacobian of rounding errors.
    fn has_noisy_rows(&self, state: &State) -> bool {
        let rounding = |rate: f64| rate > 0.0 && rate < RATE;
        let ours = (0..state.efc_rows().count()).filter_map(|row| self.engine.efc_j(state, row));
        self.simulation.efc_R().iter().any(|&r| r < REGULARISATION)
            || self.simulation.efc_rates().into_iter().any(rounding)
            || ours.map(|row| max_abs(&row, &vec![0.0; row.len()])).any(rounding)
    }

    /// Measures a step of both sides: the quantities at its start, if given, and its result.
    fn measured(&self, computed: Option<Vec<Measured>>, state: &State) -> Vec<Measured> {
        let Some(mut measured) = computed else {
            return measure(&self.model, state, &self.simulation);
        };
        if measured.iter().all(Measured::agrees) {
            measured.extend(advanced(state, &self.simulation, 1e-6));
            measured.push(activations(state, &self.simulation));
        }
        measured
    }

    /// Returns whether all differences follow from conjugate gradients that end at their limit of iterations.
    fn is_cut(&self, wrong: &[Measured]) -> bool {
        let opt = &self.model.opt;
        let follows = |m: &Measured| [QACC, QVEL, QPOS, "sensordata", "steps"].contains(&m.quantity);
        opt.solver == SolverType::Cg
            && self.simulation.solver_iterations() >= opt.iterations
            && wrong.iter().all(follows)
    }

    /// Steps MuJoCo from a state of ours. Returns whether it neither gave up nor warned, and would not at the start of the next step, where it checks
    /// positions and velocities.
    pub fn step_mujoco(&mut self, start: &State) -> bool {
        self.simulation.reset();
        self.simulation.set_state(&self.model, start);
        let stepped = self.simulation.try_step().is_ok() && self.simulation.warnings() == 0;
        let mut next = self.simulation.qpos().iter().chain(self.simulation.qvel());
        stepped && next.all(|v| v.abs() <= MAX_VALUE)
    }

    /// Returns whether MuJoCo is as far from itself, when the last bits of positions and velocities change, as ours is from it. Then the
    /// geometry of a contact jumps there, or the solver stops elsewhere.
    fn jumps(&mut self, start: &State, wrong: &[Measured]) -> bool {
        let qacc = self.simulation.qacc().to_vec();
        let contacts = self.simulation.contacts();
        let (qvel, qpos) = (self.simulation.qvel().to_vec(), self.simulation.qpos().to_vec());
        let (mut moved, mut farther, mut other) = (0.0_f64, 0.0_f64, false);
        let mut rng = fastrand::Rng::with_seed(1);
        let mut nudged = self.engine.new_state();
        let limit = self.simulation.solver_iterations() >= self.model.opt.iterations;
        for k in 0..if limit { 2 * NUDGES } else { NUDGES } {
            let most = BITS[usize::from(k >= NUDGES)];
            nudged.copy_dynamic_from(start);
            // a coordinate that is 0 is the difference of some that are not
            let bits = |v: &mut f64| *v += f64::EPSILON * v.abs().max(1.0) * f64::from(rng.i32(-most..=most));
            nudged.qpos.iter_mut().chain(&mut nudged.qvel).for_each(bits);
            if !self.step_mujoco(&nudged) {
                return true;
            }
            moved = moved.max(relative(self.simulation.qacc(), &qacc));
            farther = farther.max(relative(self.simulation.qvel(), &qvel));
            farther = farther.max(relative(self.simulation.qpos(), &qpos));
            let now = self.simulation.contacts();
            other |= now.len() != contacts.len() || contacts.iter().zip(&now).any(|(a, b)| differ(a, b));
        }
        wrong.iter().all(|m| match m.quantity {
            QACC => m.error <= 3.0 * moved,
            QVEL | QPOS => m.error <= 30.0 * farther,
            _ => other,
        })
    }
}

/// Returns whether MuJoCo's results from an inertia at `qpos0` are more than rounding errors.
fn sound(mut simulation: Simulation) -> bool {
    let nv = simulation.size("nv");
    let weights = simulation.model_array("dof_invweight0").unwrap_or_default();
    let proper = weights.iter().all(|w| w.is_finite() && *w > 0.0);
    proper && simulation.try_forward().is_ok() && scaled_condition(&simulation.full_inertia(), nv) <= CONDITION
}

/// Loads a document.
///
/// # Errors
/// Why ours refuses it.
pub fn our_model(text: &str) -> Result<Model, LoadError> {
    load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile)
}

/// Writes the state that a recipe sets for a model.
pub fn describe_state(model: &Arc<Model>, recipe: &Recipe) -> String {
    let mut state = SoftEngine::new(model.clone(), SoftOptions::default()).new_state();
    recipe.fill(model, &mut state);
    let parts = [
        ("qpos", &state.qpos[..]),
        ("qvel", &state.qvel),
        ("ctrl", &state.ctrl),
        ("act", &state.act),
        ("qfrc_applied", &state.qfrc_applied),
        ("xfrc_applied", state.xfrc_applied.as_flattened()),
        ("mocap_pos", state.mocap_pos.as_flattened()),
        ("mocap_quat", state.mocap_quat.as_flattened()),
        ("qacc_warmstart", &state.qacc_warmstart),
    ];
    let given = parts
        .into_iter()
        .filter(|(name, values)| *name == "qpos" || values.iter().any(|&v| v != 0.0));
    given
        .map(|(name, values)| format!("{name} {}", numbers(values)))
        .collect::<Vec<_>>()
        .join("; ")
}

/// Returns whether a contact moved.
fn differ(a: &Contact, b: &Contact) -> bool {
    a.geom != b.geom
        || a.flex != b.flex
        || (a.dist - b.dist).abs() > 1e-9
        || max_abs(&a.pos, &b.pos) > 1e-9
        || max_abs(&a.frame, &b.frame) > 1e-9
}
