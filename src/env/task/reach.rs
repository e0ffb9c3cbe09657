//! Reaching for a ball.

use super::pose::free_address;
use super::scene::{TaskScene, TaskView};
use super::starts::random_start;
use super::tracking::{ForgottenJoints, HeadTracking};
use super::{Goal, StepReward, Task, TaskSizes, body};
use crate::config::{Compat, Config};
use crate::env::EnvError;
use crate::math::{Vec3, norm, sub};
use crate::mimo::CHEST;
use crate::model::Model;

const PURPOSE: &str = "behavior reach";
/// Range of the ball's offset from its place at the start of an episode, by axis, m.
const BALL: [[f64; 2]; 3] = [[-0.1, 0.0], [-0.2, 0.1], [-0.1, 0.0]];
/// Displacement of the ball that counts as touched, m.
const MOVED: f64 = 0.01;
/// Reward of success.
const BONUS: f64 = 100.0;

/// MIMo hangs in the air and knocks a hovering ball away with the right hand. His eyes follow the ball.
///
/// The achieved goal is the position of the right fingers, the desired goal that of the ball at the start of the episode, world, m. The
/// reward is minus their distance, plus 100 on success: the ball has moved by more than 1 cm, which a term reports. Under
/// `compat: reference` goals are empty, and the distance is that to the moving ball.
#[derive(Clone, Debug, Default)]
pub(super) struct Reach {
    fingers: usize,
    target: usize,
    ball: usize,
    head: HeadTracking,
    has_goals: bool,
    /// Position of the ball at the start of the episode, m.
    first: Vec3,
}

/// Distance of the fingers, which the reference has instead of goals; whether the ball has moved.
type ReachTerms = [f64; 2];

impl Task for Reach {
    fn name(&self) -> &str {
        "reach"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.fingers = body(model, "right_fingers", PURPOSE)?;
        self.target = body(model, "target", PURPOSE)?;
        self.ball = free_address(model, self.target, PURPOSE)?;
        self.has_goals = config.compat == Compat::Api;
        let forgotten = match (config.compat, config.mimo_version) {
            (Compat::Api, _) => ForgottenJoints::None,
            (Compat::Reference, CHEST) => ForgottenJoints::RightEye,
            (Compat::Reference, _) => ForgottenJoints::LeftTorsion,
        };
        self.head = HeadTracking::new(model, forgotten, PURPOSE)?;
        Ok(TaskSizes {
            goal: if self.has_goals { 3 } else { 0 },
            terms: 2,
            observation: 0,
        })
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.steps(1)?;
        scene.restart()
    }

    /// Ten random actions move the arm. Then the ball is moved to a random position: x, y, z.
    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        random_start(scene, |scene| self.after_step(scene))?;
        let [start, _] = scene.start();
        for (k, [low, high]) in BALL.into_iter().enumerate() {
            scene.state.qpos[self.ball + k] = start[self.ball + k] + scene.rng.uniform_in(low, high);
        }
        // the random actions have set him and the ball in motion
        scene.state.qvel.fill(0.0);
        scene.forward()
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        // the task succeeds when the ball has moved from here
        self.first = scene.state.xpos[self.target];
        if self.has_goals {
            desired.copy_from_slice(&self.first);
        }
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let ball = scene.state.xpos[self.target];
        self.head.look_at(scene, ball);
        Ok(())
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        let (fingers, ball) = (view.state.xpos[self.fingers], view.state.xpos[self.target]);
        if self.has_goals {
            achieved.copy_from_slice(&fingers);
        }
        let moved = norm(sub(ball, self.first)) > MOVED;
        let found: ReachTerms = [norm(sub(fingers, ball)), f64::from(u8::from(moved))];
        terms.copy_from_slice(&found);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let is_success = goal.terms.get(1).is_some_and(|moved| *moved > 0.0);
        let distance = match (goal.achieved, goal.desired) {
            (&[x, y, z], &[u, v, w]) => norm(sub([x, y, z], [u, v, w])),
            _ => goal.terms.first().copied().unwrap_or_default(),
        };
        StepReward {
            reward: -distance + if is_success { BONUS } else { 0.0 },
            is_success,
            is_failure: false,
        }
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(&self.first);
    }

    fn load(&mut self, numbers: &[f64]) {
        if let &[x, y, z] = numbers {
            self.first = [x, y, z];
        }
    }
}
