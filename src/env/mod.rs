//! The environment: Gymnasium's reset and step.

mod access;
mod action_delay;
mod age;
mod blueprint;
mod by_hand;
mod clock;
mod details;
mod engines;
pub(crate) mod error;
mod eyes;
mod fields;
pub(crate) mod info;
mod model_change;
mod notices;
pub(crate) mod observation;
mod other;
mod outcome;
mod physics;
mod pipeline;
#[cfg(feature = "rapier")]
mod rapier;
mod senses;
mod sensing;
#[cfg(feature = "serde")]
mod serial;
mod snapshot;
mod stage;
mod task;
mod viewer;

pub use blueprint::{Blueprint, BlueprintOptions};
pub use by_hand::Parts;
pub use details::{InfoDetails, PartNames, Regards};
internals!(use error::EnvError);
pub use eyes::draw_eyes;
internals!(use fields::{InfoField, InfoValue});
#[cfg(feature = "eval")]
pub(crate) use fields::{InfoSource, PARTS, STEPS};
#[cfg(feature = "eval")]
pub(crate) use info::SCORED_PARTS;
internals!(use info::Info);
pub use info::{BehaviorInfo, EYE_HAND_PAIRS, Measures, PerEyeAndHand, PerHand, TaskInfo};
pub use model_change::ModelChangeError;
internals!(use model_change::CHANGEABLE);
internals!(use observation::{Observation, Step});
#[cfg(feature = "eval")]
pub(crate) use outcome::reports_outcome;
pub use senses::Senses;
pub use sensing::SensesMut;
#[cfg(feature = "serde")]
internals!(use serial::Detailed);
pub use other::OtherInfant;
pub use snapshot::{Snapshot, SnapshotError};
internals!(use snapshot::SnapshotInfo);
internals!(use stage::{EnvProbe, EnvStage});
pub use task::{
    CloneTask, Goal, GoalError, Outcome, Task, TaskDocument, TaskEvent, TaskScene, TaskSizes, TaskView, Verdict,
};
#[cfg(feature = "eval")]
pub(crate) use viewer::room_camera;
pub use viewer::{ViewFrom, Viewer};

use std::sync::Arc;

use crate::actuation::{self, Actuation};
use crate::config::{Compat, Config};
use crate::mimo::{LockReport, LockTarget};
use crate::physics::EngineError;
use crate::spaces::NumpyRng;
use action_delay::ActionDelay;
use outcome::clear;
use physics::Physics;
use task::Goals;

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
///     assert!(step.observation.proprioception.iter().all(|v| v.is_finite()));
///     if step.truncated {
///         break;
///     }
/// }
/// assert_eq!(env.info().steps, 5);
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[doc(alias("Gymnasium", "gym"))]
pub struct Env {
    blueprint: Blueprint,
    physics: Physics,
    actuation: Arc<dyn Actuation>,
    action_delay: ActionDelay,
    senses: Senses,
    task: Box<dyn Task>,
    goals: Goals,
    info: Info,
    episode: Episode,
    rng: NumpyRng,
    /// Room for the random actions at the start of an episode.
    action: Vec<f32>,
    /// The action of the present step, as the task has changed it.
    applied: Vec<f32>,
    probe: Option<EnvProbe>,
}

/// A copy goes on with the same bits as the original. It shares the blueprint and has no probe.
impl Clone for Env {
    fn clone(&self) -> Self {
        Self {
            blueprint: self.blueprint.clone(),
            physics: self.physics.clone(),
            actuation: self.actuation.clone(),
            action_delay: self.action_delay.clone(),
            senses: self.senses.clone(),
            task: self.task.clone(),
            goals: self.goals.clone(),
            info: self.info.clone(),
            episode: self.episode,
            rng: self.rng.clone(),
            action: self.action.clone(),
            applied: self.applied.clone(),
            probe: None,
        }
    }
}

/// The scene of an environment and its task, to be used together.
struct Play<'a> {
    scene: TaskScene<'a>,
    task: &'a mut dyn Task,
    goals: &'a mut Goals,
    applied: &'a mut Vec<f32>,
}

/// The progress of an episode.
#[derive(Clone, Copy, Debug, Default)]
struct Episode {
    /// Number of steps done.
    steps: u64,
    /// Whether a step may follow: there was a reset, and nothing diverged since.
    ready: bool,
    /// Whether information goes on from episode to episode.
    accumulate: bool,
    /// Reward of the last step.
    reward: f64,
    /// Whether the last step ended the episode in success or failure.
    terminated: bool,
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
    /// Builds an environment from the embedded assets. Several environments of one configuration are cheaper from one [`Blueprint`].
    ///
    /// # Errors
    /// As [`Blueprint::new`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Blueprint::new(config)?.env()
    }

    fn from_blueprint(blueprint: &Blueprint) -> Result<Self, EnvError> {
        let (config, model) = (blueprint.config(), blueprint.model());
        let actuation: Arc<dyn Actuation> = actuation::build(model, config)?.into();
        let task = blueprint.task().clone_task();
        let mut info = Info::default();
        clear(&*task, &mut info);
        Ok(Self {
            physics: Physics::new(blueprint, &*actuation),
            action_delay: ActionDelay::new(blueprint, &*actuation),
            senses: Senses::new(blueprint, &*actuation, blueprint.task_sizes())?,
            goals: Goals::new(blueprint.task_sizes()),
            rng: NumpyRng::seed(config.seed),
            action: Vec::with_capacity(actuation.action_space().len()),
            applied: Vec::with_capacity(actuation.action_space().len()),
            episode: Episode::default(),
            probe: None,
            blueprint: blueprint.clone(),
            actuation,
            task,
            info,
        })
    }

    /// Starts an episode as the task says: for `self_touch` and `hand_regard` the settled state, then ten physics steps with random
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
        self.end_episode();
        let Play { mut scene, task, .. } = self.play();
        task.reset(&mut scene)?;
        self.begin_episode()?;
        Ok(self.observation())
    }

    /// Returns the scene and the task that plays in it.
    fn play(&mut self) -> Play<'_> {
        let (engine, state, base) = self.physics.parts();
        let scene = TaskScene {
            config: self.blueprint.config(),
            model: self.blueprint.model(),
            state,
            rng: &mut self.rng,
            engine,
            base,
            actuation: &*self.actuation,
            delay: Some(&mut self.action_delay),
            start: [self.blueprint.init_qpos(), self.blueprint.init_qvel()],
            action: &mut self.action,
        };
        Play {
            scene,
            task: &mut *self.task,
            goals: &mut self.goals,
            applied: &mut self.applied,
        }
    }

    /// Starts an episode from given positions (nq) and velocities (nv) instead of the settled state, without start actions. The task
    /// chooses a goal.
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, a state from which the simulation diverges; the episode is then over.
    pub fn reset_to(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        self.end_episode();
        self.play().scene.place(qpos, qvel)?;
        self.begin_episode()?;
        Ok(self.observation())
    }

    /// Puts the scene at positions (nq) and velocities (nv) in the middle of an episode, with everything computed there.
    /// Time, counters, information, locks, muscle activations and the start of the solver stay.
    ///
    /// # Errors
    /// As [`Env::reset_to`]; vectors of wrong length or with numbers that are not finite change nothing.
    pub fn set_state(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        self.set_position(qpos, qvel)?;
        if let Err(e) = self.physics.forward() {
            self.episode.ready = false;
            return Err(e.into());
        }
        self.sense()?;
        self.judge();
        Ok(self.observation())
    }

    /// Computes poses, contacts, forces and senses anew from the present state, after [`Env::restore`] or changes to
    /// [`Env::state_mut`], and returns the observation.
    ///
    /// The next step has the same bits as without it: time, the start of the solver, the random generator and what delays, pain and
    /// other transforms remember are left as they were. So are counters, reward and the end of the episode. After a step, poses and
    /// forces are those at the start of its last physics step; here they belong to the present positions. Noise is that of the next
    /// draw, and a delayed sense shows the moment that it would show one step later.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let snapshot = env.snapshot();
    /// let mut other = env.blueprint().env()?;
    /// other.restore(&snapshot)?;
    /// assert!(other.observation().touch.is_none()); // a snapshot does not hold it
    /// assert_eq!(other.refresh()?, env.refresh()?);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// A state of wrong lengths, with numbers that are not finite, or from which the simulation diverges, after which
    /// [`Env::reset`] is needed; as the renderer.
    pub fn refresh(&mut self) -> Result<Observation<'_>, EnvError> {
        // the solver leaves its solution in the state as the start of the next one: the state gets its own back
        let before = self.physics.state.clone();
        let posed = self.physics.forward();
        self.physics.state.copy_dynamic_from(&before);
        if let Err(e) = posed {
            self.episode.ready = false;
            return Err(e.into());
        }
        let (rng, mut memory) = (self.rng.clone(), Vec::new());
        self.save_memory(&mut memory);
        let sensed = self.sense();
        self.load_memory(&memory)?;
        self.rng = rng;
        sensed?;
        let last = self.episode;
        self.judge();
        self.episode = last;
        Ok(self.observation())
    }

    /// Sets positions (nq) and velocities (nv), of which nothing is computed yet.
    fn set_position(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        check_vector("qpos", qpos, model.nq)?;
        check_vector("qvel", qvel, model.nv)?;
        self.physics.check_shape()?;
        self.physics.state.qpos.copy_from_slice(qpos);
        self.physics.state.qvel.copy_from_slice(qvel);
        Ok(())
    }

    /// Locks a joint, or all joints of a part, at an angle in rad, from the next step on. Locks outlast resets; those that
    /// the configuration asks for can be moved and taken off too.
    ///
    /// ```
    /// use babybench::config::Part;
    /// use babybench::{Config, Env};
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
        self.physics.lock(self.blueprint.model(), target.into(), angle)
    }

    /// Unlocks a joint, or all joints of a part, from the next step on and for later episodes.
    ///
    /// # Errors
    /// No such joint, a joint that cannot be locked.
    pub fn unlock<'a>(&mut self, target: impl Into<LockTarget<'a>>) -> Result<LockReport, EnvError> {
        self.physics.unlock(self.blueprint.model(), target.into())
    }

    /// Returns whether a step may follow: there was a reset, and nothing diverged since.
    pub fn ready(&self) -> bool {
        self.episode.ready
    }

    /// Returns whether the episode has reached `max_episode_steps`.
    pub fn truncated(&self) -> bool {
        self.episode.steps >= self.blueprint.config().max_episode_steps
    }

    fn end_episode(&mut self) -> u64 {
        self.episode.ready = false;
        std::mem::take(&mut self.episode.steps)
    }

    /// Sets whether resets leave the counters and lists of the behavior as they are, instead of clearing them.
    pub fn accumulate_info(&mut self, on: bool) {
        self.episode.accumulate = on;
    }

    fn begin_episode(&mut self) -> Result<(), EnvError> {
        self.episode.steps = 0;
        self.info.steps = 0;
        if !self.episode.accumulate || self.info.behavior.task().is_some() {
            self.task.forget();
            clear(&*self.task, &mut self.info);
        }
        let Play {
            mut scene, task, goals, ..
        } = self.play();
        task.begin(&mut scene, &mut goals.desired);
        self.action_delay.rest();
        self.senses.reset(self.phase());
        self.episode.ready = true;
        self.sense()?;
        self.judge();
        (self.episode.reward, self.episode.terminated) = (0.0, false);
        Ok(())
    }

    /// Applies an action for `frame_skip` physics steps.
    ///
    /// Values out of the action space are clipped. Stepping on after truncation is allowed.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which leaves the state untouched; a simulation that
    /// diverged, after which [`Env::reset`] is needed.
    pub fn step(&mut self, action: &[f32]) -> Result<Step<'_>, EnvError> {
        if !self.episode.ready {
            return Err(EnvError::NotReset);
        }
        self.check_action(action)?;
        self.physics.check_shape()?;
        self.mark(Some(EnvStage::Actuation));
        let frame_skip = self.blueprint.config().frame_skip;
        self.senses.prepare();
        let Play {
            mut scene,
            task,
            applied,
            ..
        } = self.play();
        applied.clear();
        applied.extend_from_slice(action);
        task.before_step(applied);
        let stepped = scene
            .step(applied, frame_skip)
            .and_then(|()| task.after_step(&mut scene));
        if let Err(e) = stepped {
            self.episode.ready = false;
            return Err(e);
        }
        self.mark(Some(EnvStage::Senses));
        self.senses.advance();
        self.sense()?;
        self.judge();
        if let BehaviorInfo::Task(info) = &mut self.info.behavior {
            info.episode_return += self.episode.reward;
        }
        self.track();
        self.date_pictures();
        let steps = &mut self.episode.steps;
        self.info.steps = match self.blueprint.config().compat {
            Compat::Api => *steps + 1,
            Compat::Reference => *steps,
        };
        *steps += 1;
        let truncated = self.truncated();
        self.mark(None);
        Ok(Step {
            observation: self.observation(),
            reward: self.episode.reward,
            terminated: self.episode.terminated,
            truncated,
            info: &self.info,
        })
    }

    /// Checks the length of an action, and that it is finite.
    pub(crate) fn check_action(&self, action: &[f32]) -> Result<(), EnvError> {
        let expected = self.action_space().len();
        if action.len() != expected {
            return Err(EnvError::ActionLength {
                found: action.len(),
                expected,
            });
        }
        if let Some((index, &value)) = action.iter().enumerate().find(|(_, a)| !a.is_finite()) {
            let (driven, others) = (self.actuation.actuators(), self.actuation.others());
            let own = expected - others.len();
            let id = if index < own {
                driven.get(index % driven.len().max(1))
            } else {
                others.get(index - own)
            };
            let actuator = id.map(|&id| self.model().actuator_name[id].clone()).unwrap_or_default();
            return Err(EnvError::ActionNotFinite { index, actuator, value });
        }
        Ok(())
    }

    /// Counts what the behavior counts.
    fn track(&mut self) {
        self.task.count(&self.physics.state);
        self.task.inform(TaskEvent::Step(&self.physics.state), &mut self.info);
    }

    /// Notes how old the pictures are that the eyes show.
    fn date_pictures(&mut self) {
        let age = self.senses.vision_age();
        self.info.details.vision_age = age.map(|steps| steps as f64 * self.blueprint.dt());
    }

    /// Returns where in their periods the senses begin an episode that do not look in every step: a number from 0 to 1 that follows
    /// from the generator without drawing from it, so that environments with other seeds look in other steps.
    fn phase(&self) -> f64 {
        let word = self.rng.clone().word();
        (word >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn sense(&mut self) -> Result<(), EnvError> {
        self.physics.check_shape()?;
        let model = self.blueprint.model();
        let (state, task) = (&self.physics.state, &*self.task);
        let append = |out: &mut [f64]| task.observe(state, out);
        self.senses
            .observe(model, state, &*self.actuation, append, &mut self.rng)
    }

    /// Returns the observation of the last reset, step or [`Env::refresh`], all of it of one moment: after [`Env::restore`] it is without
    /// what a snapshot does not hold (touch, pain, images), and changes of [`Env::state_mut`] are not in it.
    pub fn observation(&self) -> Observation<'_> {
        fn goal(values: &[f64]) -> Option<&[f64]> {
            (!values.is_empty()).then_some(values)
        }
        Observation {
            achieved_goal: goal(&self.goals.achieved),
            desired_goal: goal(&self.goals.desired),
            ..self.senses.observation()
        }
    }

    /// Fills `action` with a random action, the same that Gymnasium's `action_space.sample()` draws from the same seed.
    pub fn sample_action(&mut self, action: &mut Vec<f32>) {
        self.actuation.action_space().sample(&mut self.rng, action);
    }

    /// Draws a seed from the generator of [`Env::sample_action`], so that what is made with it follows from the environment's seed.
    pub(crate) fn draw_seed(&mut self) -> u64 {
        self.rng.word()
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
