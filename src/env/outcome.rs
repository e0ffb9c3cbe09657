//! The outcome of a step: reward, success, failure.

use super::task::{Goals, Task, TaskEvent, TaskView};
use super::{BehaviorInfo, Env, Info, Outcome, Step, TaskInfo};
use crate::config::Compat;

impl Env {
    /// Returns the results of the last step again. After a reset the reward is 0 and the episode is not over.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let reward = env.step(&vec![0.0; env.action_space().len()])?.reward;
    /// assert_eq!(env.last_step().reward, reward);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    pub fn last_step(&self) -> Step<'_> {
        Step {
            observation: self.observation(),
            reward: self.episode.reward,
            terminated: self.episode.terminated,
            truncated: self.truncated(),
            info: &self.info,
        }
    }

    /// Returns whether the episode is over: terminated or truncated.
    pub(crate) fn over(&self) -> bool {
        self.episode.terminated || self.truncated()
    }

    /// Returns whether the episode has reached `max_episode_steps`.
    fn truncated(&self) -> bool {
        self.episode.steps >= self.blueprint.config().max_episode_steps
    }

    /// Reads the achieved goal and computes the outcome and reward of the last step, and whether it ends the episode.
    pub(super) fn judge(&mut self) {
        let view = TaskView {
            model: self.blueprint.model(),
            state: self.physics.state(),
            touch: self.senses.touch.as_ref(),
            actuation: self.blueprint.actuation(),
        };
        let Goals {
            achieved,
            desired,
            terms,
        } = &mut self.goals;
        // after the senses, because touch may be part of the achieved goal
        self.task.achieve(&view, desired, achieved, terms);
        self.conclude();
    }

    /// Ends a step after sensing: outcome, counters, information, number of steps.
    pub(super) fn finish_step(&mut self) {
        self.judge();
        if let BehaviorInfo::Task(info) = &mut self.info.behavior {
            // before the task's report, which may replace these counters by its own
            info.episode_return += self.episode.reward;
        }
        self.track();
        self.count_reflexes();
        self.date_pictures();
        self.date_body();
        let steps = &mut self.episode.steps;
        self.info.steps = match self.blueprint.config().compat {
            Compat::Api => *steps + 1,
            Compat::Reference => *steps,
        };
        *steps += 1;
    }

    /// Computes the outcome and reward of the last step, and whether it ends the episode, from its goals.
    pub(super) fn conclude(&mut self) {
        let verdict = self.task.judge(self.goals.row());
        self.episode.reward = verdict.reward;
        if let BehaviorInfo::Task(info) = &mut self.info.behavior {
            info.outcome = Outcome {
                is_success: verdict.is_success,
                is_failure: verdict.is_failure,
            };
            let over = info.outcome.is_success || info.outcome.is_failure;
            self.episode.terminated = self.blueprint.config().done_active && over;
        }
    }
}

/// Returns whether a task reports success and failure instead of the counters of a behavior.
#[cfg(feature = "eval")]
pub(crate) fn reports_outcome(task: &dyn Task) -> bool {
    let mut info = Info::default();
    clear(task, &mut info);
    info.behavior.task().is_some()
}

/// Sets the counters to their values at the start of an episode.
pub(super) fn clear(task: &dyn Task, info: &mut Info) {
    if matches!(info.behavior, BehaviorInfo::None | BehaviorInfo::Task(_)) {
        let (name, measures) = match &mut info.behavior {
            BehaviorInfo::Task(last) if *last.task == *task.name() => {
                (last.task.clone(), std::mem::take(&mut last.measures))
            }
            _ => Default::default(),
        };
        info.behavior = BehaviorInfo::Task(TaskInfo {
            task: name,
            measures,
            ..TaskInfo::default()
        });
    }
    task.inform(TaskEvent::Start, info);
    // only if needed and missing, because a reset allocates nothing
    if let BehaviorInfo::Task(named) = &mut info.behavior
        && *named.task != *task.name()
    {
        named.task = task.name().into();
    }
}
