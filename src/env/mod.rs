//! The environment: Gymnasium's reset and step.

mod access;
mod behavior;
mod blueprint;
mod details;
mod error;
mod eyes;
mod rng;
mod snapshot;
mod spaces;

pub use behavior::{BehaviorInfo, Info};
pub use blueprint::Blueprint;
pub use details::{Details, PartNames};
pub use error::EnvError;
pub use rng::NumpyRng;
pub use snapshot::{Snapshot, SnapshotError};
pub use spaces::{BoxSpace, Dtype, ObservationSpace};

use crate::actuation::{self, Actuation};
use crate::config::{Behavior, Compat, Config};
use crate::env::behavior::Watcher;
use crate::eval::logs::{LogError, TrainingLog};
use crate::mimo::{LockReport, LockTarget, lock, lock_of, unlock};
use crate::physics::{Engine, EngineError, Params, Stage, State};
use crate::render::Painter;
use crate::sensors::{EYES, Proprioception, Touch, Vestibular, Vision};

/// Steps with random actions at the start of an episode of `self_touch` and `hand_regard`.
const START_ACTIONS: usize = 10;

/// What MIMo senses. The vectors belong to the environment and change with the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation<'a> {
    /// Proprioception; [`Env::proprioception`] tells what stands where.
    pub observation: &'a [f64],
    /// What the skin feels, N, if `touch_active`; [`Env::touch`] tells what stands where.
    pub touch: Option<&'a [f32]>,
    /// What the left eye sees, (H, W, 3) bytes from the top, if `vision_active`.
    pub eye_left: Option<&'a [u8]>,
    /// What the right eye sees.
    pub eye_right: Option<&'a [u8]>,
    /// Linear acceleration (m/s^2) and angular velocity (rad/s) of the head, if `vestibular_active`.
    pub vestibular: Option<&'a [f64]>,
}

/// What a step returns, in Gymnasium's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// The observation.
    pub observation: Observation<'a>,
    /// Always 0: there is no extrinsic reward.
    pub reward: f64,
    /// Always false.
    pub terminated: bool,
    /// Whether the episode has reached `max_episode_steps`.
    pub truncated: bool,
    /// The information.
    pub info: &'a Info,
}

/// A BabyBench environment.
///
/// ```
/// use babybench::{Config, Env};
///
/// let mut env = Env::new(Config { max_episode_steps: 5, ..Config::default() })?;
/// let mut action = Vec::new();
/// env.reset(Some(7))?;
/// loop {
///     env.sample_action(&mut action);
///     let step = env.step(&action)?;
///     assert!(step.observation.observation.iter().all(|v| v.is_finite()));
///     if step.truncated {
///         break;
///     }
/// }
/// assert_eq!(env.info().steps, 5);
/// # Ok::<(), babybench::EnvError>(())
/// ```
pub struct Env {
    blueprint: Blueprint,
    engine: Box<dyn Engine>,
    state: State,
    /// Parameters after a reset: the blueprint's, with what [`Env::lock`] and [`Env::unlock`] changed.
    base: Params,
    fingerprint: u64,
    actuation: Box<dyn Actuation>,
    proprioception: Proprioception,
    touch: Option<Touch>,
    vision: Option<Vision>,
    vestibular: Option<Vestibular>,
    watcher: Watcher,
    rng: NumpyRng,
    info: Info,
    /// Episodes go there as they end.
    training: Option<TrainingLog>,
    /// Information goes on from episode to episode.
    accumulate: bool,
    steps: u64,
    ready: bool,
    proprioception_values: Vec<f64>,
    vestibular_values: Vec<f64>,
    eye_values: [Vec<u8>; 2],
    /// Whether [`Env::draw_eyes`] draws what the eyes see, instead of each step.
    vision_deferred: bool,
    /// For [`Env::render`], made when it is first needed.
    painter: Option<Painter>,
    picture: Vec<u8>,
    action: Vec<f32>,
}

impl std::fmt::Debug for Env {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Env")
            .field("config", self.config())
            .field("info", &self.info)
            .finish_non_exhaustive()
    }
}

impl Env {
    /// From the embedded assets. Several environments of one configuration are cheaper from one [`Blueprint`].
    ///
    /// # Errors
    /// As [`Blueprint::new`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Blueprint::new(config)?.env()
    }

    fn from_blueprint(blueprint: &Blueprint) -> Result<Self, EnvError> {
        let (config, model) = (blueprint.config(), blueprint.model());
        let engine = blueprint.engine();
        let mut state = engine.new_state();
        state.params.clone_from(blueprint.params());
        let actuation = actuation::build(model, config)?;
        let proprioception = Proprioception::new(model, config, actuation.observation_len());
        let touch = blueprint.skin().map(|skin| Touch::configured(skin.clone(), config));
        let vestibular = config.vestibular_active.then(|| Vestibular::new(model));
        let vision = if config.vision_active {
            let eyes = Vision::with_painter(model, blueprint.painter()?, config.vision_resolution as usize);
            Some(eyes.ok_or_else(|| missing_camera(EYES[0], "vision_active"))?)
        } else {
            None
        };
        let pixels = vision.as_ref().map_or(0, Vision::len);
        let watcher = Watcher::new(model, config.behavior, config.compat)?;
        let mut info = Info::default();
        watcher.reset(&mut info);
        Ok(Self {
            proprioception_values: vec![0.0; proprioception.len()],
            vestibular_values: vec![0.0; vestibular.as_ref().map_or(0, Vestibular::len)],
            eye_values: [vec![0; pixels], vec![0; pixels]],
            vision_deferred: false,
            painter: None,
            picture: Vec::new(),
            watcher,
            rng: NumpyRng::seed(config.seed),
            action: Vec::with_capacity(actuation.action_space().len()),
            info,
            training: None,
            accumulate: false,
            steps: 0,
            ready: false,
            blueprint: blueprint.clone(),
            engine,
            state,
            base: blueprint.params().clone(),
            fingerprint: snapshot::fingerprint(model, config),
            actuation,
            proprioception,
            touch,
            vision,
            vestibular,
        })
    }

    /// Starts an episode: the settled state, then, for `self_touch` and `hand_regard`, ten physics steps with random
    /// actions. The information of a reset is empty.
    ///
    /// Under `compat: api` a seed reseeds every random choice. Under `compat: reference` it is ignored, as the start
    /// actions come from the generator of the action space: see [`Env::seed_action_space`].
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<Observation<'_>, EnvError> {
        if let (Some(seed), Compat::Api) = (seed, self.config().compat) {
            self.seed_action_space(seed);
        }
        let (qpos, qvel) = self.blueprint.settled();
        self.place(&qpos, &qvel)?;
        if self.blueprint.config().behavior != Behavior::None {
            for _ in 0..START_ACTIONS {
                self.actuation.action_space().sample(&mut self.rng, &mut self.action);
                self.actuation
                    .set_action(self.blueprint.model(), &mut self.state, &self.action);
                self.engine.step(&mut self.state)?;
            }
        }
        self.begin_episode()?;
        Ok(self.observation())
    }

    /// Starts an episode from given positions (nq) and velocities (nv) instead of the settled state, without start actions.
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, a state from which the simulation diverges; the episode is then over.
    pub fn reset_to(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        self.place(qpos, qvel)?;
        self.begin_episode()?;
        Ok(self.observation())
    }

    /// Forgets the past and computes everything at the given positions and velocities.
    fn place(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        for (what, found, expected) in [("qpos", qpos.len(), model.nq), ("qvel", qvel.len(), model.nv)] {
            if found != expected {
                return Err(EnvError::StateLength { what, found, expected });
            }
        }
        self.log_episode()?;
        let model = self.blueprint.model();
        self.ready = false;
        let s = &mut self.state;
        s.time = 0.0;
        s.step = 0;
        s.ctrl.fill(0.0);
        s.qfrc_applied.fill(0.0);
        s.qacc_warmstart.fill(0.0);
        s.params.clone_from(&self.base);
        if self.blueprint.config().compat == Compat::Reference {
            // the reference resets its actuators before it sets the state
            s.qpos.copy_from_slice(&model.qpos0);
            s.qvel.fill(0.0);
            self.actuation.reset(model, s);
        }
        s.qpos.copy_from_slice(qpos);
        s.qvel.copy_from_slice(qvel);
        if self.blueprint.config().compat == Compat::Api {
            self.actuation.reset(model, s);
        }
        self.engine.forward(s)?;
        Ok(())
    }

    /// Puts the scene at positions (nq) and velocities (nv) in the middle of an episode, with everything computed there.
    /// Time, counters, information, locks, muscle activities and the start of the solver stay.
    ///
    /// # Errors
    /// As [`Env::reset_to`]; vectors of wrong length or with numbers that are not finite change nothing.
    pub fn set_state(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        let model = self.blueprint.model();
        check_vector("qpos", qpos, model.nq)?;
        check_vector("qvel", qvel, model.nv)?;
        self.state.qpos.copy_from_slice(qpos);
        self.state.qvel.copy_from_slice(qvel);
        if let Err(e) = self.engine.forward(&mut self.state) {
            self.ready = false;
            return Err(e.into());
        }
        self.sense()?;
        Ok(self.observation())
    }

    /// Sets the activities of the muscles, in the order of the action, each clipped to [0, 1].
    ///
    /// # Errors
    /// A wrong length (models without muscles have none) or numbers that are not finite; nothing is changed then.
    pub fn set_activity(&mut self, activity: &[f64]) -> Result<(), EnvError> {
        check_vector("activity", activity, self.actuation.activity().len())?;
        self.actuation.set_activity(activity);
        Ok(())
    }

    /// Locks a joint, or all joints of a part, at an angle in rad, from the next step on. Locks outlast resets; those that
    /// the configuration asks for can be moved and taken off too.
    ///
    /// ```
    /// use babybench::config::{Config, Part};
    /// use babybench::Env;
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// env.lock(Part::Head, 0.0)?;
    /// let elbow = env.lock("robot:right_elbow", -1.2)?;
    /// assert!(elbow.held.is_empty() && elbow.beyond_limits.is_empty());
    /// env.unlock(Part::Head)?;
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// No such joint, a joint that cannot be locked, an angle that is not finite. Joints that the scene holds are not
    /// errors but in the report.
    pub fn lock<'a>(&mut self, target: impl Into<LockTarget<'a>>, angle: f64) -> Result<LockReport, EnvError> {
        let report = lock(self.blueprint.model(), &mut self.state.params, target.into(), angle)?;
        self.keep_locks(&report);
        Ok(report)
    }

    /// Takes the lock off a joint, or all joints of a part, from the next step on and for later episodes.
    ///
    /// # Errors
    /// No such joint, a joint that cannot be locked.
    pub fn unlock<'a>(&mut self, target: impl Into<LockTarget<'a>>) -> Result<LockReport, EnvError> {
        let report = unlock(self.blueprint.model(), &mut self.state.params, target.into())?;
        self.keep_locks(&report);
        Ok(report)
    }

    fn keep_locks(&mut self, report: &LockReport) {
        let (now, model) = (&self.state.params, self.blueprint.model());
        for e in report.changed.iter().filter_map(|&j| lock_of(model, j)) {
            self.base.eq_active[e.0] = now.eq_active[e.0];
            self.base.eq_offset[e.0] = now.eq_offset[e.0];
        }
    }

    /// Adds the episode that ends to the training log.
    fn log_episode(&mut self) -> Result<(), LogError> {
        let steps = std::mem::take(&mut self.steps);
        match &mut self.training {
            Some(log) => log.end_episode(steps, &self.info.behavior),
            None => Ok(()),
        }
    }

    /// Logs episodes from now on, or no longer; [`crate::make_env`] does it for training.
    pub fn log_training(&mut self, log: Option<TrainingLog>) {
        let names = (self.config().behavior == Behavior::SelfTouch).then(|| PartNames::new(self.model()));
        self.training = log.map(|log| log.with_names(names));
    }

    /// The episodes logged so far, if this environment logs.
    pub fn training_log(&self) -> Option<&TrainingLog> {
        self.training.as_ref()
    }

    /// Saves the training log, under `compat: api` with the running episode, which ends. Without a log, nothing happens.
    ///
    /// # Errors
    /// What the file system says.
    pub fn finish_training(&mut self) -> Result<(), EnvError> {
        if self.training.is_some() && self.config().compat == Compat::Api {
            self.ready = false;
            self.log_episode()?;
        }
        match &self.training {
            Some(log) => Ok(log.save()?),
            None => Ok(()),
        }
    }

    /// Whether resets leave the counters and lists of the behavior as they are, instead of clearing them.
    pub(crate) fn accumulate_info(&mut self, on: bool) {
        self.accumulate = on;
    }

    fn begin_episode(&mut self) -> Result<(), EnvError> {
        self.steps = 0;
        self.info.steps = 0;
        if !self.accumulate {
            self.watcher.reset(&mut self.info);
        }
        self.ready = true;
        self.sense()
    }

    /// Applies an action for `frame_skip` physics steps.
    ///
    /// Values out of the action space are clipped. Stepping on after truncation is allowed.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which leaves the state untouched; a simulation that
    /// diverged, after which [`Env::reset`] is needed.
    pub fn step(&mut self, action: &[f32]) -> Result<Step<'_>, EnvError> {
        if !self.ready {
            return Err(EnvError::NotReset);
        }
        self.check_action(action)?;
        let model = self.blueprint.model();
        self.actuation.set_action(model, &mut self.state, action);
        for k in 0..self.blueprint.config().frame_skip {
            if k > 0 {
                self.actuation.substep(model, &mut self.state);
            }
            if let Err(e) = self.engine.step(&mut self.state) {
                self.ready = false;
                return Err(e.into());
            }
        }
        self.engine.mark(Some(Stage::Senses));
        self.sense()?;
        self.watcher.update(&self.state, &mut self.info);
        self.info.steps = match self.blueprint.config().compat {
            Compat::Api => self.steps + 1,
            Compat::Reference => self.steps,
        };
        self.steps += 1;
        self.engine.mark(None);
        Ok(Step {
            observation: self.observation(),
            reward: 0.0,
            terminated: false,
            truncated: self.steps >= self.blueprint.config().max_episode_steps,
            info: &self.info,
        })
    }

    fn check_action(&self, action: &[f32]) -> Result<(), EnvError> {
        let expected = self.action_space().len();
        if action.len() != expected {
            return Err(EnvError::ActionLength {
                found: action.len(),
                expected,
            });
        }
        if let Some((index, &value)) = action.iter().enumerate().find(|(_, a)| !a.is_finite()) {
            let names = &self.model().actuator_name;
            let actuator = names.get(index % names.len().max(1)).cloned().unwrap_or_default();
            return Err(EnvError::ActionNotFinite { index, actuator, value });
        }
        Ok(())
    }

    fn sense(&mut self) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        self.proprioception
            .observe(model, &self.state, &*self.actuation, &mut self.proprioception_values);
        if let Some(t) = &mut self.touch {
            t.observe(model, &self.state);
        }
        if let Some(v) = &self.vestibular {
            v.observe(model, &self.state, &mut self.vestibular_values);
        }
        if let (Some(v), false) = (&mut self.vision, self.vision_deferred) {
            let [left, right] = &mut self.eye_values;
            v.observe(&self.state, [left, right])?;
        }
        Ok(())
    }

    /// The observation of the last reset or step.
    pub fn observation(&self) -> Observation<'_> {
        Observation {
            observation: &self.proprioception_values,
            touch: self.touch.as_ref().map(Touch::values),
            eye_left: self.vision.as_ref().map(|_| &self.eye_values[0][..]),
            eye_right: self.vision.as_ref().map(|_| &self.eye_values[1][..]),
            vestibular: self.vestibular.as_ref().map(|_| &self.vestibular_values[..]),
        }
    }

    /// Fills `action` with a random action, the same that Gymnasium's `action_space.sample()` draws from the same seed.
    pub fn sample_action(&mut self, action: &mut Vec<f32>) {
        self.actuation.action_space().sample(&mut self.rng, action);
    }

    /// Seeds the generator of [`Env::sample_action`] and of start actions.
    pub fn seed_action_space(&mut self, seed: u64) {
        self.rng = NumpyRng::seed(seed);
    }
}

fn check_vector(what: &'static str, values: &[f64], expected: usize) -> Result<(), EnvError> {
    let found = values.len();
    if found != expected {
        return Err(EnvError::StateLength { what, found, expected });
    }
    match values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        Some((index, &value)) => Err(EngineError::NotFinite { what, index, value }.into()),
        None => Ok(()),
    }
}

fn missing_camera(name: &str, purpose: &'static str) -> EnvError {
    EnvError::Missing {
        what: "camera",
        name: name.to_string(),
        purpose,
    }
}
