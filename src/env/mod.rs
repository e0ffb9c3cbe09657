//! The environment: Gymnasium's reset and step.

mod access;
mod action_delay;
mod blueprint;
mod by_hand;
mod changeable;
mod checksum;
mod clock;
mod details;
mod engines;
mod episode;
pub(crate) mod error;
mod eyes;
mod fields;
mod growing;
#[cfg(feature = "rapier")]
mod infant;
pub(crate) mod info;
mod mimo_mut;
mod model_change;
mod notices;
pub(crate) mod observation;
mod outcome;
mod paths;
mod per_hand;
mod physics;
mod pipeline;
mod placed;
#[cfg(feature = "rapier")]
mod rapier;
mod second_infant;
mod senses;
mod sensing;
#[cfg(feature = "eval")]
mod serial;
mod snapshot;
mod stage;
mod task;
mod viewer;
mod workspace;

pub use blueprint::{Blueprint, BlueprintOptions};
pub use by_hand::ManualControl;
pub use changeable::{CHANGEABLE, ModelChangeError};
pub use checksum::Checksum;
pub use details::{InfoDetails, PartNames, ReflexShares, RegardCounts};
pub use error::EnvError;
pub use eyes::draw_eyes;
pub use fields::{InfoField, InfoValue};
#[cfg(feature = "eval")]
pub(crate) use fields::{InfoSource, PARTS, STEPS};
#[cfg(feature = "rapier")]
pub use infant::{Infant, InfantError, InfantSnapshot};
pub use info::Info;
#[cfg(feature = "eval")]
pub(crate) use info::SCORED_PARTS;
pub use info::{BehaviorInfo, Measures, TaskInfo};
pub use mimo_mut::MimoMut;
pub use model_change::ModelMut;
pub use observation::{Observation, Step};
#[cfg(feature = "eval")]
pub(crate) use outcome::reports_outcome;
pub use paths::PathError;
pub use per_hand::{EYE_HAND_PAIRS, PerEyeAndHand, PerHand};
pub use second_infant::SecondInfant;
pub use senses::Senses;
pub use sensing::SensesMut;
#[cfg(feature = "eval")]
pub use serial::InfoWithDetails;
pub use snapshot::SnapshotInfo;
pub use snapshot::{Snapshot, SnapshotError};
pub use stage::{EnvProbe, EnvStage};
pub use task::{
    CloneTask, Goal, GoalError, Outcome, StepReward, Task, TaskDocument, TaskEvent, TaskScene, TaskSizes, TaskView,
};
#[cfg(feature = "eval")]
pub(crate) use viewer::room_camera;
pub use viewer::{ViewFrom, Viewer};

pub(crate) use growing::space_difference;
pub(crate) use physics::ScratchUse;

use crate::actuation::Reflexes;
use crate::config::Config;
use crate::model::Model;
use crate::physics::State;
use crate::spaces::NumpyRng;
use action_delay::ActionDelay;
use episode::Episode;
use outcome::clear;
use physics::Physics;
use placed::check_vector;
use task::{ActionTiming, Goals, StagedTask};

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
    action_delay: ActionDelay,
    reflexes: Option<Reflexes>,
    senses: Senses,
    task: Box<dyn Task>,
    goals: Goals,
    info: Info,
    episode: Episode,
    rng: NumpyRng,
    /// A buffer for the random actions at the start of an episode.
    action: Vec<f32>,
    /// The action of the current step, after the task's changes.
    applied: Vec<f32>,
    probe: Option<EnvProbe>,
}

/// A copy continues with the same bits as the original. It shares the blueprint and has no probe.
impl Clone for Env {
    fn clone(&self) -> Self {
        Self {
            blueprint: self.blueprint.clone(),
            physics: self.physics.clone(),
            action_delay: self.action_delay.clone(),
            reflexes: self.reflexes.clone(),
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

impl std::fmt::Debug for Env {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Env")
            .field("config", self.config())
            .field("info", &self.info)
            .finish_non_exhaustive()
    }
}

impl Env {
    /// Builds an environment from the embedded assets. It is cheaper to make several environments of one configuration from one [`Blueprint`].
    ///
    /// # Errors
    /// As [`Blueprint::new`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Blueprint::new(config)?.env()
    }

    fn from_blueprint(blueprint: &Blueprint) -> Result<Self, EnvError> {
        let config = blueprint.config();
        let actuation = blueprint.actuation();
        let task = blueprint.task().clone_task();
        let mut info = Info::default();
        clear(&*task, &mut info);
        Ok(Self {
            physics: Physics::new(blueprint.engines().clone(), blueprint.new_state()),
            action_delay: ActionDelay::new(config, actuation.action_space(), blueprint.action_delay()),
            reflexes: blueprint.new_reflexes(),
            senses: Senses::new(blueprint, blueprint.task_sizes())?,
            goals: Goals::new(blueprint.task_sizes()),
            rng: NumpyRng::seed(config.seed),
            action: Vec::with_capacity(actuation.action_space().len()),
            applied: Vec::with_capacity(actuation.action_space().len()),
            episode: Episode::default(),
            probe: None,
            blueprint: blueprint.clone(),
            task,
            info,
        })
    }

    /// Applies an action for `frame_skip` physics steps.
    ///
    /// Values outside the action space are clipped. Steps after truncation are allowed.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which leaves the state untouched. A simulation that diverged, after
    /// which [`Env::reset`] is needed.
    pub fn step(&mut self, action: &[f32]) -> Result<Step<'_>, EnvError> {
        self.watched_step(action, &mut |_| {})
    }

    /// Applies an action like [`Env::step`], and shows the state after each physics step to `watch`.
    fn watched_step(&mut self, action: &[f32], watch: &mut dyn FnMut(&State)) -> Result<Step<'_>, EnvError> {
        // a diverged state has numbers that no later step may build on
        if !self.episode.ready {
            return Err(EnvError::NotReset);
        }
        // both checks come before anything changes: a refused step leaves the environment as it was
        self.check_action(action)?;
        self.physics.check_shape()?;
        self.mark(Some(EnvStage::Actuation));
        let frame_skip = self.blueprint.config().frame_skip;
        self.senses.begin_step();
        // the action is copied, because a task may change it and the caller's slice is read-only
        let StagedTask {
            mut scene,
            task,
            applied,
            ..
        } = self.play();
        applied.clear();
        applied.extend_from_slice(action);
        task.before_step(applied);
        scene.set_action(applied, ActionTiming::InStep);
        let stepped = scene
            .watched_advance(frame_skip, watch)
            .and_then(|()| task.after_step(&mut scene));
        // some of the physics steps are done, so neither a repetition nor the next step would be right
        if let Err(e) = stepped {
            self.episode.ready = false;
            return Err(e);
        }
        self.mark(Some(EnvStage::Senses));
        // clocks count this step before it is sensed, so a sense that is due looks at its end
        self.senses.advance();
        self.sense()?;
        self.finish_step();
        self.check_shared()?;
        self.mark(None);
        Ok(self.last_step())
    }

    /// Checks that an action has the right length and finite numbers.
    pub(crate) fn check_action(&self, action: &[f32]) -> Result<(), EnvError> {
        let expected = self.action_space().len();
        check_numbers(self.model(), action, expected, |index| {
            let actuation = self.blueprint.actuation();
            let (driven, extra) = (actuation.actuators(), actuation.extra_actuators());
            match index.checked_sub(expected - extra.len()) {
                // muscles have two numbers per actuator, one block after the other
                None => driven.get(index % driven.len().max(1)).copied(),
                Some(index) => extra.get(index).copied(),
            }
        })
    }

    /// Calls the probe, if there is one, when a stage starts, or with `None` when the step is done.
    #[inline]
    fn mark(&self, stage: Option<EnvStage>) {
        if let Some(probe) = &self.probe {
            probe(stage);
        }
    }

    /// Updates the behavior's counters.
    fn track(&mut self) {
        let state = self.physics.state();
        self.task.count(state);
        self.task.inform(TaskEvent::Step(state), &mut self.info);
    }

    /// Records how often each reflex has acted.
    fn count_reflexes(&mut self) {
        let reflexes = self.reflexes.as_ref();
        self.info.details.reflexes = reflexes.map(|r| ReflexShares::from_fn(|reflex| r.share(reflex)));
    }

    /// Records the age of the pictures of the eyes.
    fn date_pictures(&mut self) {
        let age = self.senses.vision_age();
        self.info.details.vision_age = age.map(|steps| steps as f64 * self.blueprint.dt());
    }

    /// Records the age of a MIMo who grows.
    fn date_body(&mut self) {
        self.info.details.age = self.config().age.filter(|_| self.grows());
    }

    fn sense(&mut self) -> Result<(), EnvError> {
        // parts of a step by hand come here without the check in `step`
        self.physics.check_shape()?;
        let model = self.blueprint.model();
        // a closure rather than a buffer: the task writes straight into the observation
        let (state, task) = (self.physics.state(), &*self.task);
        let append = |out: &mut [f64]| task.observe(state, out);
        self.senses.observe(
            model,
            state,
            self.blueprint.actuation(),
            append,
            self.reflexes.as_ref(),
            &mut self.rng,
        )
    }

    /// Returns the observation of the last reset, step or [`ManualControl::refresh`], all of one moment. After [`Env::restore`] it lacks
    /// what a snapshot does not hold (touch, pain, images). It includes neither changes through [`Env::state_mut`] nor images that
    /// [`SensesMut::look`] has not drawn yet.
    pub fn observation(&self) -> Observation<'_> {
        self.with_goals(self.senses.observation())
    }

    /// Adds the goals to the observation.
    fn with_goals<'a>(&'a self, sensed: Observation<'a>) -> Observation<'a> {
        fn goal(values: &[f64]) -> Option<&[f64]> {
            (!values.is_empty()).then_some(values)
        }
        Observation {
            achieved_goal: goal(&self.goals.achieved),
            desired_goal: goal(&self.goals.desired),
            ..sensed
        }
    }

    /// Fills `action` with a random action, the same that Gymnasium's `action_space.sample()` draws from the same seed.
    pub fn sample_action(&mut self, action: &mut Vec<f32>) {
        self.blueprint.actuation().action_space().sample(&mut self.rng, action);
    }

    /// Draws a seed from the generator of [`Env::sample_action`]. Whatever a program derives from it therefore follows from the environment's seed.
    pub(crate) fn draw_seed(&mut self) -> u64 {
        self.rng.word()
    }
}

/// Checks the length of an action and that its numbers are finite. `actuator` returns the actuator of a number, by id.
fn check_numbers(
    model: &Model,
    action: &[f32],
    expected: usize,
    actuator: impl Fn(usize) -> Option<usize>,
) -> Result<(), EnvError> {
    let found = action.len();
    if found != expected {
        return Err(EnvError::ActionLength { found, expected });
    }
    match action.iter().enumerate().find(|(_, a)| !a.is_finite()) {
        None => Ok(()),
        Some((index, &value)) => {
            let name = actuator(index).and_then(|id| model.actuator_name.get(id));
            let actuator = name.cloned().unwrap_or_default();
            Err(EnvError::ActionNotFinite { index, actuator, value })
        }
    }
}

fn missing_camera(name: &str, purpose: &'static str) -> EnvError {
    EnvError::Missing {
        what: "camera",
        name: name.to_string(),
        purpose,
    }
}
