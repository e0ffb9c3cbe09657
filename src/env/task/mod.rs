//! Tasks of environments.
//!
//! A [`Task`] is a value: which scene, where episodes start, what is counted or rewarded, when an episode succeeds or fails. BabyBench's
//! behaviors are tasks, and so are MIMo's tasks with goals; [`BlueprintOptions`](crate::env::BlueprintOptions) take any other.

mod catch;
mod free_play;
mod goal;
mod hand_regard;
mod pose;
mod reach;
mod roll_over;
mod scene;
mod self_body;
mod self_touch;
mod standup;
mod tracking;

use std::fmt::Debug;

pub use goal::{Goal, GoalError, Outcome};
pub(super) use goal::{Goals, rewards};
pub use scene::{TaskScene, TaskView};

use crate::config::{Behavior, Config};
use crate::env::{EnvError, Info};
use crate::mimo::{Version, scene_xml};
use crate::model::Model;
use crate::physics::State;

/// Random actions, of one physics step each, at the start of an episode of `self_touch` and `hand_regard`.
const START_ACTIONS: usize = 10;

/// How many numbers a task hands out in each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TaskSizes {
    /// Length of the achieved and of the desired goal.
    pub goal: usize,
    /// Length of what the reward depends on beside goals.
    pub terms: usize,
    /// Length of what is appended to proprioception.
    pub observation: usize,
}

/// The task of an environment: its scene, the start of its episodes, goals, reward, success and failure.
///
/// An environment holds one, made by cloning that of its blueprint, and calls it in this order: [`Task::bind`] and [`Task::settle`] once,
/// while the blueprint is made; [`Task::reset`] and [`Task::begin`] at the start of an episode; in each step [`Task::before_step`],
/// the physics, [`Task::after_step`], the senses, [`Task::achieve`], and then [`Task::success`], [`Task::failure`] and
/// [`Task::reward`], which are functions of goals and terms alone.
///
/// A user-defined task, `examples/own_task.rs`:
///
#[cfg_attr(
    feature = "eval",
    doc = concat!("```\n", include_str!("../../../examples/own_task.rs"), "```")
)]
pub trait Task: CloneTask + Debug + Send + Sync {
    /// Returns the name, for errors and reports.
    fn name(&self) -> &str;

    /// Returns the version of MIMo in the document.
    fn version(&self, config: &Config) -> Version {
        Version::of(config.behavior)
    }

    /// Returns the MJCF document of the scene. It lies in the folder `babybench` of the assets, and includes files from there.
    fn document(&self, config: &Config) -> String {
        scene_xml(config)
    }

    /// Returns the bodies with touch sensors and the distances between those, m, at `touch_scale: 1`; nothing for MIMo's own table
    /// with the keys `touch_...`. Observations are ordered by body id regardless of this order.
    fn touch_spacing(&self) -> &[(&'static str, f64)] {
        &[]
    }

    /// Finds what it needs in the compiled scene.
    ///
    /// # Errors
    /// [`EnvError::Missing`].
    fn bind(&mut self, config: &Config, model: &Model) -> Result<(), EnvError> {
        let _ = (config, model);
        Ok(())
    }

    /// Returns how many numbers it hands out.
    fn sizes(&self) -> TaskSizes {
        TaskSizes::default()
    }

    /// Brings a new scene to the state from which episodes start. What [`TaskScene::lock`] locks stays so at every reset.
    ///
    /// By default 100 physics steps pass with the action 0, from `qpos0`.
    ///
    /// # Errors
    /// The simulation diverged.
    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.settle()
    }

    /// Brings the scene to the start of an episode: by default to the settled state.
    ///
    /// # Errors
    /// The simulation diverged.
    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.restart()
    }

    /// Starts an episode in the scene as it is, after [`Task::reset`] or where a program has put it, and chooses the desired goal.
    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        let _ = (scene, desired);
    }

    /// Changes an action before it is applied.
    fn before_step(&mut self, action: &mut [f32]) {
        let _ = action;
    }

    /// Looks at the scene, and perhaps changes it, after the physics steps of a step.
    ///
    /// # Errors
    /// Whatever it does to the scene.
    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let _ = scene;
        Ok(())
    }

    /// Writes what is appended to proprioception.
    fn observe(&self, state: &State, out: &mut [f64]) {
        let _ = (state, out);
    }

    /// Writes the achieved goal, and what else the reward depends on.
    fn achieve(&mut self, view: &TaskView<'_>, desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        let _ = (view, desired, achieved, terms);
    }

    /// Returns whether the goal is reached.
    fn success(&self, goal: Goal<'_>) -> bool {
        let _ = goal;
        false
    }

    /// Returns whether the goal is out of reach.
    fn failure(&self, goal: Goal<'_>) -> bool {
        let _ = goal;
        false
    }

    /// Returns the reward: a function of goals and terms, so that a program can ask what another goal would have earned.
    fn reward(&self, goal: Goal<'_>) -> f64 {
        let _ = goal;
        0.0
    }

    /// Returns whether success, failure and return are part of the information: [`BehaviorInfo::Task`](crate::env::BehaviorInfo::Task).
    fn reports_outcome(&self) -> bool {
        true
    }

    /// Counts what a step brought, in the information.
    fn count(&self, state: &State, info: &mut Info) {
        let _ = (state, info);
    }

    /// Resets the counters for a new episode and reserves their capacity.
    fn clear(&self, info: &mut Info) {
        let _ = info;
    }

    /// Brings the details of the information up to date; without a state, poses are not known.
    fn describe(&self, state: Option<&State>, info: &mut Info) {
        let _ = (state, info);
    }

    /// Returns what it remembers from step to step, beside goals, as numbers: snapshots hold them. The length never changes.
    fn memory(&self) -> &[f64] {
        &[]
    }

    /// Returns what it remembers, to be overwritten with numbers that [`Task::memory`] once had, or that someone made up.
    fn memory_mut(&mut self) -> &mut [f64] {
        &mut []
    }
}

/// Makes tasks behind a pointer cloneable; every [`Task`] that is [`Clone`] has it.
pub trait CloneTask {
    /// Returns a copy.
    fn clone_task(&self) -> Box<dyn Task>;
}

impl<T: Task + Clone + 'static> CloneTask for T {
    fn clone_task(&self) -> Box<dyn Task> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Task> {
    fn clone(&self) -> Self {
        self.clone_task()
    }
}

/// Returns the task of a configuration.
pub(super) fn of_config(config: &Config) -> Box<dyn Task> {
    match config.behavior {
        Behavior::None => Box::new(free_play::FreePlay),
        Behavior::SelfTouch => Box::new(self_touch::SelfTouch::default()),
        Behavior::HandRegard => Box::new(hand_regard::HandRegard::default()),
        Behavior::Reach => Box::new(reach::Reach::default()),
        Behavior::Standup => Box::new(standup::Standup::default()),
        Behavior::SelfBody => Box::new(self_body::SelfBody::default()),
        Behavior::Catch => Box::new(catch::Catch::default()),
        Behavior::RollOver => Box::new(roll_over::RollOver::default()),
    }
}

/// Finds a body that a task needs.
fn body(model: &Model, name: &str, purpose: &'static str) -> Result<usize, EnvError> {
    let missing = || EnvError::Missing {
        what: "body",
        name: name.to_string(),
        purpose,
    };
    model.body(name).ok_or_else(missing)
}
