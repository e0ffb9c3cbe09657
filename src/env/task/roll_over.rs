//! Rolling over.

use super::pose::free_address;
use super::scene::{TaskScene, TaskView};
use super::standup::{REST, control_cost, first, reached, shaken_start};
use super::starts::relax;
use super::{Goal, StepReward, Task, TaskSizes, body};
use crate::config::{Compat, Config, StartingPosition};
use crate::env::EnvError;
use crate::model::Model;
use crate::physics::State;

const PURPOSE: &str = "behavior roll_over";
/// Share of the way from one side to the other that counts as rolled over.
const ROLLED: f64 = 0.8;
/// Half of the square root of 2.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Height of the base before MIMo settles, m.
const HEIGHT: f64 = 0.1;

/// MIMo lies on his back (or on his belly) and rolls over.
///
/// The achieved goal is 0 in his initial position and 1 on the other side: with the angle `a` of the x axis of hip and chest above the
/// horizon, the mean of `1/2 + a/180` degrees, or 1 minus that. The desired goal is 0.8. The reward is the achieved goal minus the cost
/// of the controls, the only term. Under `compat: reference` only the hip counts, as in the Python code.
#[derive(Clone, Debug, Default)]
pub(super) struct RollOver {
    base: usize,
    /// The bodies that have to roll over.
    trunk: Vec<usize>,
    supine: bool,
    reference: bool,
}

impl RollOver {
    /// Returns how far MIMo has rolled, 0 to 1.
    fn rolled(&self, state: &State) -> f64 {
        let angle = |&b: &usize| {
            let m = &state.xmat[b];
            pxfm::f_atan2(-m[6], (m[7] * m[7] + m[8] * m[8]).sqrt()).to_degrees()
        };
        let part = |b: &usize| (angle(b) + 90.0) / 180.0;
        let mean = self.trunk.iter().map(part).sum::<f64>() / self.trunk.len().max(1) as f64;
        if self.supine { mean } else { 1.0 - mean }
    }
}

impl Task for RollOver {
    fn name(&self) -> &str {
        "roll_over"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.base = free_address(model, body(model, "mimo_location", PURPOSE)?, PURPOSE)?;
        self.reference = config.compat == Compat::Reference;
        let trunk: &[&str] = if self.reference {
            &["hip"]
        } else {
            &["hip", "upper_body"]
        };
        self.trunk = trunk
            .iter()
            .map(|name| body(model, name, PURPOSE))
            .collect::<Result<_, _>>()?;
        self.supine = config.roll_over.starting_position == StartingPosition::Supine;
        Ok(TaskSizes {
            goal: 1,
            terms: 1,
            observation: 0,
        })
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let side = if self.supine { HALF } else { -HALF };
        let quat = [0.0, side, 0.0, HALF];
        let mut qpos = scene.model.qpos0.clone();
        qpos[self.base..self.base + 3].copy_from_slice(&[0.0, 0.0, HEIGHT]);
        qpos[self.base + 3..self.base + 7].copy_from_slice(&quat);
        let still = vec![0.0; scene.model.nv];
        scene.place(&qpos, &still)?;
        relax(scene, REST)
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        shaken_start(scene, self.base)
    }

    fn begin(&mut self, _scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        desired.fill(ROLLED);
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        achieved.fill(self.rolled(view.state));
        terms.fill(control_cost(view, self.reference));
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        StepReward {
            reward: first(goal.achieved) - first(goal.terms),
            is_success: reached(goal),
            is_failure: false,
        }
    }
}
