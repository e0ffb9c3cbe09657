//! Tasks of environments.
//!
//! A [`Task`] is a value that defines the scene, the start of episodes, counters, reward, success and failure. BabyBench's behaviors are
//! tasks, and so are MIMo's tasks with goals. [`BlueprintOptions`](crate::env::BlueprintOptions) take any other.

mod catch;
mod free_play;
mod goal;
mod hand_regard;
mod mobile;
mod play;
mod pose;
mod reach;
mod roll_over;
mod scene;
mod self_body;
mod self_touch;
mod standup;
mod starts;
mod tracking;

use std::fmt::Debug;

pub use goal::{Goal, GoalError, Outcome};
pub(super) use goal::{Goals, rewards};
pub(crate) use scene::{ActionTiming, StagedTask};
pub use scene::{TaskScene, TaskView};

use super::{EnvError, Info};
use crate::config::{Behavior, Config};
use crate::mimo::{Version, scene_xml};
use crate::model::Model;
use crate::physics::State;

/// The number of values that a task returns in each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TaskSizes {
    /// Length of the achieved and of the desired goal.
    pub goal: usize,
    /// Length of the terms, on which the reward depends besides goals.
    pub terms: usize,
    /// Length of the values appended to proprioception.
    pub observation: usize,
}

/// The source of a task's scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskDocument {
    /// The MJCF document. It is in the folder `babybench` of the assets, and includes files from there.
    pub xml: String,
    /// The version of MIMo in it.
    pub version: Version,
    /// The bodies with touch sensors and the distances between sensors, m, at `touch_scale: 1`; none for MIMo's own table with the keys
    /// `touch_...`. Observations are ordered by body id regardless of this order.
    pub touch_spacing: Vec<(String, f64)>,
}

impl TaskDocument {
    /// Returns the document that a configuration selects.
    pub fn of(config: &Config) -> Self {
        Self {
            xml: scene_xml(config),
            version: Version::of(config.behavior),
            touch_spacing: Vec::new(),
        }
    }
}

/// Returns a table of touch sensors as [`TaskDocument::touch_spacing`] takes it.
fn spacing(table: &[(&str, f64)]) -> Vec<(String, f64)> {
    table
        .iter()
        .map(|(body, distance)| (body.to_string(), *distance))
        .collect()
}

/// The evaluation of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReward {
    /// The reward.
    pub reward: f64,
    /// Whether the goal is reached.
    pub is_success: bool,
    /// Whether it is out of reach.
    pub is_failure: bool,
}

/// The occasions on which a task updates the information.
#[derive(Clone, Copy, Debug)]
pub enum TaskEvent<'a> {
    /// An episode starts: counters are cleared, with space reserved for everything that may come.
    Start,
    /// A step has led to this state.
    Step(&'a State),
    /// A snapshot was restored: counters are known, poses are not.
    Restored,
}

/// The purpose of an environment: its scene, the start of its episodes, goals, reward, success and failure.
///
/// An environment holds a task, a clone of its blueprint's. It calls [`Task::document`], [`Task::bind`] and [`Task::settle`] once, while
/// the blueprint is made; [`Task::reset`] and [`Task::begin`] at the start of an episode; and in each step [`Task::before_step`], the
/// physics, [`Task::after_step`], the senses, [`Task::achieve`], and then [`Task::judge`], which is a function of goals and terms alone.
/// Every method except the name has a default.
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

    /// Returns the source of its scene; by default, the one that the configuration selects.
    fn document(&self, config: &Config) -> TaskDocument {
        TaskDocument::of(config)
    }

    /// Finds what it needs in the compiled scene, takes its options from the configuration, and returns how many numbers it produces in
    /// each step.
    ///
    /// # Errors
    /// [`EnvError::Missing`].
    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        let _ = (config, model);
        Ok(TaskSizes::default())
    }

    /// Moves a new scene to the state from which episodes start. Joints locked through [`TaskScene::lock`] stay locked at every reset.
    ///
    /// By default 100 physics steps pass with the action 0, from `qpos0`.
    ///
    /// # Errors
    /// The simulation diverged.
    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.settle()
    }

    /// Moves the scene to the start of an episode, by default the settled state.
    ///
    /// # Errors
    /// The simulation diverged.
    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.restart()
    }

    /// Starts an episode in the current scene, after [`Task::reset`] or after a program has set its state, and chooses the desired goal.
    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        let _ = (scene, desired);
    }

    /// Changes an action before it is applied.
    fn before_step(&mut self, action: &mut [f32]) {
        let _ = action;
    }

    /// Reads, and possibly changes, the scene after the physics steps of a step.
    ///
    /// # Errors
    /// Errors of its changes to the scene.
    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let _ = scene;
        Ok(())
    }

    /// Returns whether the environments of a vector may share scratch states, which is faster for many environments.
    ///
    /// A task may return true if it changes nothing but `qpos` and `qvel` between the last physics step, or [`TaskScene::forward`], of a
    /// reset or step and its end, and if its resets read nothing computed before the first of them. If a task that does otherwise returns
    /// true, poses and forces that are read between the steps of a vector are wrong. The default is false.
    fn only_moves(&self) -> bool {
        false
    }

    /// Writes the values appended to proprioception.
    fn observe(&self, state: &State, out: &mut [f64]) {
        let _ = (state, out);
    }

    /// Writes the achieved goal and the terms of the reward.
    fn achieve(&self, view: &TaskView<'_>, desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        let _ = (view, desired, achieved, terms);
    }

    /// Returns reward, success and failure as a function of goals and terms. Programs can therefore compute the reward of another goal.
    /// By default the reward is 0 and episodes do not end.
    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let _ = goal;
        StepReward::default()
    }

    /// Clears its counters when the information is cleared: at the start of an episode, unless counters continue.
    fn forget(&mut self) {}

    /// Updates its counters after a step that led to this state, except those that the information holds itself. [`Task::inform`] reports
    /// them and [`Task::save`] stores them.
    fn count(&mut self, state: &State) {
        let _ = state;
    }

    /// Updates the information. Success, failure and return ([`BehaviorInfo::Task`](crate::env::BehaviorInfo::Task)) exist from the start and follow
    /// from [`Task::judge`]. A task with other counters replaces them.
    fn inform(&self, event: TaskEvent<'_>, info: &mut Info) {
        let _ = (event, info);
    }

    /// Appends its memory from step to step, besides goals, as numbers for snapshots. Their count never changes.
    fn save(&self, out: &mut Vec<f64>) {
        let _ = out;
    }

    /// Restores what [`Task::save`] wrote. The numbers may come from an untrusted snapshot.
    fn load(&mut self, numbers: &[f64]) {
        let _ = numbers;
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
        Behavior::Mobile => Box::new(mobile::Mobile::default()),
        Behavior::Play => Box::new(play::Play::default()),
    }
}

/// Returns the names of the measures of one of the library's tasks; none for tasks without measures and for custom tasks.
pub(super) fn measures_of(task: &str) -> &'static [&'static str] {
    match Behavior::from_name(task) {
        Some(Behavior::Mobile) => mobile::NAMES,
        Some(Behavior::Play) => play::NAMES,
        _ => &[],
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
