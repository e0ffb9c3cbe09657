//! Goals and outcomes.

use thiserror::Error;

use super::{Task, TaskSizes};

/// The inputs of a reward: a row of goals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal<'a> {
    /// The achieved goal.
    pub achieved: &'a [f64],
    /// The desired goal.
    pub desired: &'a [f64],
    /// Further inputs of the reward besides the goals, such as the cost of the action.
    pub terms: &'a [f64],
}

/// The outcome of a step of a task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Whether the goal is reached.
    pub is_success: bool,
    /// Whether it is out of reach.
    pub is_failure: bool,
}

/// Goals or terms with a wrong shape.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{what} has {found} values but the task {task:?} needs {rows} rows of {expected}")]
pub struct GoalError {
    /// The array.
    pub what: &'static str,
    /// Its length.
    pub found: usize,
    /// The task.
    pub task: String,
    /// Number of rows that `out` has.
    pub rows: usize,
    /// Length of a row.
    pub expected: usize,
}

/// The goals of an environment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Goals {
    pub achieved: Vec<f64>,
    pub desired: Vec<f64>,
    pub terms: Vec<f64>,
}

impl Goals {
    pub fn new(sizes: TaskSizes) -> Self {
        Self {
            achieved: vec![0.0; sizes.goal],
            desired: vec![0.0; sizes.goal],
            terms: vec![0.0; sizes.terms],
        }
    }

    pub fn row(&self) -> Goal<'_> {
        Goal {
            achieved: &self.achieved,
            desired: &self.desired,
            terms: &self.terms,
        }
    }
}

/// Computes the reward of each row of goals: see [`Blueprint::compute_reward`](crate::Blueprint::compute_reward).
pub(crate) fn rewards(task: &dyn Task, sizes: TaskSizes, all: Goal<'_>, out: &mut [f64]) -> Result<(), GoalError> {
    let rows = out.len();
    let check = |what, values: &[f64], expected: usize| {
        let found = values.len();
        if found == rows * expected {
            Ok(())
        } else {
            Err(GoalError {
                what,
                found,
                task: task.name().to_string(),
                rows,
                expected,
            })
        }
    };
    check("achieved", all.achieved, sizes.goal)?;
    check("desired", all.desired, sizes.goal)?;
    check("terms", all.terms, sizes.terms)?;
    for (row, out) in out.iter_mut().enumerate() {
        let of = |len: usize| row * len..(row + 1) * len;
        let goal = Goal {
            achieved: &all.achieved[of(sizes.goal)],
            desired: &all.desired[of(sizes.goal)],
            terms: &all.terms[of(sizes.terms)],
        };
        *out = task.judge(goal).reward;
    }
    Ok(())
}
