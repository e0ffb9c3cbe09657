//! Single steps from states that MuJoCo visited.

use babybench::physics::{Engine, State};

use super::episode::Episode;
use super::speed::copy_motion;
use super::{Case, parallel};
use crate::measure::{Summary, max_abs, relative};
use crate::mujoco::{Contact, Mujoco, Simulation};

/// States of an episode.
const STATES: usize = 200;

/// Number of states between two comparisons of MuJoCo with itself.
const FLOOR_EVERY: usize = 10;

/// Errors of the acceleration above this are examined.
pub const LARGE: f64 = 1e-4;

/// Number of attempts to make MuJoCo jump.
const NUDGES: u64 = 32;

/// Newton's tolerances of the converged MuJoCo, which stops where rounding ends its progress.
pub const TIGHT: (f64, f64, usize) = (1e-18, 1e-6, 200);

/// Builds an engine for a scene.
pub type Maker<'a> = &'a (dyn Fn(&Case) -> Box<dyn Engine> + Sync);

/// Errors of single steps of a scene.
#[derive(Default)]
pub struct OneStep {
    /// Acceleration, relative to its largest value.
    pub qacc: Vec<f64>,
    /// Velocity after the step, m/s or rad/s.
    pub qvel: Vec<f64>,
    /// Positions after the step, m or rad.
    pub qpos: Vec<f64>,
    /// Force of each contact, relative to itself, where geoms and number agree.
    pub force: Vec<f64>,
    /// Distance of each contact, m.
    pub dist: Vec<f64>,
    /// The acceleration of MuJoCo with its own tolerance against its converged one: where its solver stops.
    pub floor: Vec<f64>,
    /// The same for the force of each contact.
    pub force_floor: Vec<f64>,
    /// Errors of the acceleration above [`LARGE`], each with the largest distance of MuJoCo from itself when the last bits of
    /// the positions change: there the contact geometry jumps within its tolerance.
    pub large: Vec<(f64, f64)>,
    /// Number of contacts seen.
    pub contacts: usize,
    /// States whose contacts differ in number, geoms or order.
    pub mismatches: Vec<String>,
    /// States that the engine did not step, and why.
    pub failures: Vec<String>,
    /// The states of the largest errors of the acceleration, the worst first.
    pub worst: Vec<(f64, String)>,
}

impl OneStep {
    fn append(&mut self, mut other: Self) {
        self.qacc.append(&mut other.qacc);
        self.qvel.append(&mut other.qvel);
        self.qpos.append(&mut other.qpos);
        self.force.append(&mut other.force);
        self.dist.append(&mut other.dist);
        self.floor.append(&mut other.floor);
        self.force_floor.append(&mut other.force_floor);
        self.large.append(&mut other.large);
        self.contacts += other.contacts;
        self.mismatches.append(&mut other.mismatches);
        self.failures.append(&mut other.failures);
        self.worst.append(&mut other.worst);
        self.worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        self.worst.truncate(5);
    }

    /// Summarises the errors of the acceleration.
    pub fn qacc(&self) -> Summary {
        Summary::new(self.qacc.iter().copied())
    }

    /// Returns the largest error of the acceleration that no jump of MuJoCo's own explains.
    ///
    /// A jump explains an error if it is at least a third as large, when the last bits of the positions change.
    pub fn unexplained(&self) -> f64 {
        let jumps = |error: &f64| self.large.iter().any(|(e, own)| e == error && *error <= 3.0 * own);
        self.qacc.iter().filter(|e| !jumps(e)).fold(0.0, |a: f64, &b| a.max(b))
    }

    /// Summarises the errors of the contact forces.
    pub fn force(&self) -> Summary {
        Summary::new(self.force.iter().copied())
    }

    /// Summarises the errors of MuJoCo's acceleration against its own converged one.
    pub fn floor(&self) -> Summary {
        Summary::new(self.floor.iter().copied())
    }
}

/// Tolerances of the solvers of both sides: Newton's, the line search's, most iterations.
pub type Tolerance = Option<(f64, f64, usize)>;

/// Compares an engine with MuJoCo on about `states` states of a scene, in threads. `tolerance` replaces MuJoCo's own.
///
/// # Errors
/// MuJoCo does not load the scene.
pub fn one_step(
    api: &'static Mujoco,
    case: &Case,
    make: Maker,
    states: usize,
    tolerance: Tolerance,
) -> Result<OneStep, String> {
    let episodes = Episode::mixed(states.div_ceil(STATES));
    let parts = parallel(
        &episodes,
        || Pair::new(api, case, make, tolerance),
        |pair, episode| pair.as_mut().map(|p| p.run(*episode)).map_err(|e| e.clone()),
    );
    let mut all = OneStep::default();
    for part in parts {
        all.append(part?);
    }
    Ok(all)
}

/// Both sides.
struct Pair<'a> {
    case: &'a Case,
    engine: Box<dyn Engine>,
    state: State,
    simulation: Simulation,
    converged: Simulation,
    nudged: Simulation,
}

impl<'a> Pair<'a> {
    fn new(api: &'static Mujoco, case: &'a Case, make: Maker, tolerance: Tolerance) -> Result<Self, String> {
        let (mut simulation, mut converged) = (case.simulation(api)?, case.simulation(api)?);
        if let Some((t, ls, n)) = tolerance {
            simulation.set_tolerance(t, ls, n);
        }
        let mut nudged = case.simulation(api)?;
        if let Some((t, ls, n)) = tolerance {
            nudged.set_tolerance(t, ls, n);
        }
        let (t, ls, n) = TIGHT;
        converged.set_tolerance(t, ls, n);
        let engine = make(case);
        Ok(Self {
            case,
            state: engine.new_state(),
            engine,
            simulation,
            converged,
            nudged,
        })
    }

    fn run(&mut self, episode: Episode) -> OneStep {
        let mut out = OneStep::default();
        let (mut drive, params) = episode.start(self.case, &mut self.simulation);
        self.state.params.clone_from(&params);
        self.converged.set_params(&self.case.model, &params);
        let mut ctrl = vec![0.0; self.case.model.nu()];
        let mut start = self.engine.new_state();
        for k in 0..STATES {
            drive.set(k, &mut ctrl);
            self.simulation.set_ctrl(&ctrl);
            copy_motion(&self.simulation, &mut self.state);
            self.state.ctrl.copy_from_slice(&ctrl);
            if k.is_multiple_of(FLOOR_EVERY) {
                self.converged.set_state(&self.case.model, &self.state);
                self.converged.forward();
            }
            self.simulation.step();
            if k.is_multiple_of(FLOOR_EVERY) {
                self.compare_with_itself(&mut out);
            }
            let place = || {
                format!(
                    "{} {} seed {} step {k}",
                    self.case.name,
                    episode.motion.name(),
                    episode.seed
                )
            };
            start.copy_dynamic_from(&self.state);
            match self.engine.step(&mut self.state) {
                Err(e) => out.failures.push(format!("{}: {e}", place())),
                Ok(()) => self.compare(&mut out, &place(), &start),
            }
        }
        out
    }

    /// Measures how far MuJoCo's acceleration jumps when the last bits of `qpos` change.
    fn jump(&mut self, start: &State) -> f64 {
        let mut start = start.clone();
        let qpos = start.qpos.clone();
        let mut worst = 0.0_f64;
        for seed in 0..NUDGES {
            let mut rng = fastrand::Rng::with_seed(seed);
            for (q, at) in start.qpos.iter_mut().zip(&qpos) {
                *q = [*at, at.next_up(), at.next_down()][rng.usize(0..3)];
            }
            self.nudged.set_state(&self.case.model, &start);
            self.nudged.forward();
            worst = worst.max(relative(self.nudged.qacc(), self.simulation.qacc()));
        }
        worst
    }

    fn compare_with_itself(&self, out: &mut OneStep) {
        out.floor.push(relative(self.simulation.qacc(), self.converged.qacc()));
        let (a, b) = (self.simulation.contacts(), self.converged.contacts());
        out.force_floor
            .extend(a.iter().zip(&b).map(|(a, b)| relative(&a.force, &b.force)));
    }

    fn compare(&mut self, out: &mut OneStep, place: &str, start: &State) {
        let qacc = relative(&self.state.qacc, self.simulation.qacc());
        if qacc > LARGE {
            out.large.push((qacc, self.jump(start)));
        }
        let (ours, theirs) = (&self.state, &self.simulation);
        out.qacc.push(qacc);
        out.qvel.push(max_abs(&ours.qvel, theirs.qvel()));
        out.qpos.push(max_abs(&ours.qpos, theirs.qpos()));
        let contacts = theirs.contacts();
        let same = ours.contact.len() == contacts.len()
            && ours
                .contact
                .iter()
                .zip(&contacts)
                .all(|(a, b)| a.geom == b.geom && a.dim == b.dim);
        out.contacts += contacts.len();
        if same {
            for (a, b) in ours.contact.iter().zip(&contacts) {
                out.force.push(relative(&a.force, &b.force));
                out.dist.push((a.dist - b.dist).abs());
            }
        } else {
            out.mismatches.push(format!("{place}: {}", self.mismatch(&contacts)));
        }
        if out.worst.len() < 5 || out.worst.iter().any(|w| qacc > w.0) {
            out.worst.push((qacc, format!("{place}: {}", self.describe())));
            out.worst.sort_by(|a, b| b.0.total_cmp(&a.0));
            out.worst.truncate(5);
        }
    }

    /// Describes the first contact that differs.
    fn mismatch(&self, theirs: &[Contact]) -> String {
        let ours = &self.state.contact;
        let counts = format!("{} contacts, MuJoCo has {}", ours.len(), theirs.len());
        let name = |geom: [usize; 2]| {
            geom.map(|g| format!("{g} {:?}", self.case.model.geom_type[g]))
                .join(" - ")
        };
        let first = (0..ours.len().max(theirs.len())).find(|&k| {
            let (a, b) = (ours.get(k).map(|c| c.geom), theirs.get(k).map(|c| c.geom));
            a != b
        });
        let Some(k) = first else { return counts };
        let ours = ours.get(k).map(|c| format!("{} at {:e}", name(c.geom), c.dist));
        let theirs = theirs.get(k).map(|c| format!("{} at {:e}", name(c.geom), c.dist));
        format!("{counts}; number {k} is {ours:?}, MuJoCo's {theirs:?}")
    }

    /// Describes the contact whose place differs most; empty if none does.
    fn farthest_contact(&self) -> String {
        let theirs = self.simulation.contacts();
        let error = |a: &babybench::physics::Contact, b: &Contact| {
            let place = max_abs(&a.pos, &b.pos).max((a.dist - b.dist).abs());
            place.max(max_abs(&a.frame, &b.frame))
        };
        let pairs = self.state.contact.iter().zip(&theirs).filter(|(a, b)| a.geom == b.geom);
        let Some((a, b)) = pairs.max_by(|(a, b), (c, d)| error(a, b).total_cmp(&error(c, d))) else {
            return String::new();
        };
        if error(a, b) < 1e-14 {
            return String::new();
        }
        let pose = a.geom.map(|g| {
            let xpos = max_abs(&self.state.geom_xpos[g], &self.simulation.geom_xpos()[3 * g..][..3]);
            xpos.max(max_abs(
                &self.state.geom_xmat[g],
                &self.simulation.geom_xmat()[9 * g..][..9],
            ))
        });
        let kinds = a.geom.map(|g| format!("{:?}", self.case.model.geom_type[g]));
        let (dist, pos) = ((a.dist - b.dist).abs(), max_abs(&a.pos, &b.pos));
        let frame = max_abs(&a.frame, &b.frame);
        format!(
            " ({} of geoms {:?}: distance {:e} differs by {dist:.0e}, position by {pos:.0e}, frame by {frame:.0e}, poses of \
             the geoms by {:.0e} and {:.0e})",
            kinds.join("-"),
            a.geom,
            b.dist,
            pose[0],
            pose[1]
        )
    }

    fn describe(&self) -> String {
        let (ours, theirs) = (&self.state.qacc, self.simulation.qacc());
        let error = |d: &usize| (ours[*d] - theirs[*d]).abs();
        let Some(d) = (0..ours.len()).max_by(|a, b| error(a).total_cmp(&error(b))) else {
            return String::new();
        };
        format!(
            "dof {d} of {:?}: {:e} instead of {:e}; {} contacts{}, {} rows, Newton iterations {} and {}",
            self.case.model.jnt_name[self.case.model.dof_jntid[d]],
            ours[d],
            theirs[d],
            self.simulation.ncon(),
            self.farthest_contact(),
            self.simulation.nefc(),
            self.state.solver_iterations,
            self.simulation.solver_iterations(),
        )
    }
}
