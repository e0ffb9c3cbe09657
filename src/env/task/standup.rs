//! Standing up.

use super::pose::{Angles, free_address, set_angles};
use super::scene::{TaskScene, TaskView};
use super::starts::relax;
use super::{Goal, StepReward, Task, TaskSizes, body};
use crate::config::{Compat, Config};
use crate::env::EnvError;
use crate::model::Model;

const PURPOSE: &str = "behavior standup";
/// Height of the head that counts as standing, m.
const STANDING: f64 = 0.5;
/// Height of the head at which the reward is 0, m.
const SITTING: f64 = 0.2;
/// Weight of the cost of the controls.
pub(super) const COST: f64 = 0.01;
/// Greatest change of a joint angle at the start of an episode, rad.
pub(super) const NOISE: f64 = 0.01;
/// Physics steps without action at the start of an episode.
pub(super) const REST: u32 = 100;

/// Position and orientation of the base of the crouching MIMo.
const BASE: [f64; 7] = [
    -0.103287,
    0.00444494,
    0.0672742,
    0.965518,
    -0.00942109,
    -0.207444,
    0.157016,
];
/// Joint angles of the crouching MIMo.
const CROUCHING: &Angles = &[
    ("hip_lean1", -0.0134586),
    ("hip_rot1", -0.259285),
    ("hip_bend1", 0.407198),
    ("hip_lean2", -0.0565839),
    ("hip_rot2", -0.248653),
    ("hip_bend2", 0.38224),
    ("right_shoulder_horizontal", 1.59608),
    ("right_shoulder_ad_ab", 2.57899),
    ("right_shoulder_rotation", 0.259329),
    ("right_elbow", -0.188292),
    ("right_hand1", -0.429857),
    ("right_hand2", -0.99162),
    ("right_hand3", -0.0568468),
    ("right_fingers", -1.4206),
    ("right_hip1", -2.26831),
    ("right_hip2", -0.295142),
    ("right_hip3", -0.313409),
    ("right_knee", -2.53125),
    ("right_foot1", -0.109924),
    ("right_foot2", -0.0352949),
    ("right_foot3", 0.106372),
    ("right_toes", 0.0205777),
    ("left_shoulder_horizontal", 0.778157),
    ("left_shoulder_ad_ab", 2.9349),
    ("left_shoulder_rotation", 1.16941),
    ("left_elbow", -0.547872),
    ("left_hand1", -1.54373),
    ("left_hand2", -0.98379),
    ("left_hand3", 0.225526),
    ("left_fingers", -1.27117),
    ("left_hip1", -2.118),
    ("left_hip2", -0.233242),
    ("left_hip3", 0.369615),
    ("left_knee", -2.34683),
    ("left_foot1", -0.279261),
    ("left_foot2", -0.477783),
    ("left_foot3", 0.111583),
    ("left_toes", 0.0182025),
];

/// MIMo crouches at a railing that he holds, and raises his head.
///
/// The achieved goal is the height of the head, m; the desired goal is 0.5. The reward is the achieved goal minus 0.2 minus the cost of
/// the controls, which is the only term: see [`control_cost`].
#[derive(Clone, Debug, Default)]
pub(super) struct Standup {
    head: usize,
    base: usize,
    reference: bool,
}

impl Task for Standup {
    fn name(&self) -> &str {
        "standup"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.head = body(model, "head", PURPOSE)?;
        self.base = free_address(model, body(model, "mimo_location", PURPOSE)?, PURPOSE)?;
        self.reference = config.compat == Compat::Reference;
        Ok(TaskSizes {
            goal: 1,
            terms: 1,
            observation: 0,
        })
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let mut qpos = scene.model.qpos0.clone();
        qpos[self.base..self.base + 7].copy_from_slice(&BASE);
        set_angles(scene.model, CROUCHING, &mut qpos, PURPOSE)?;
        scene.state.qpos.copy_from_slice(&qpos);
        scene.steps(1)?;
        let still = vec![0.0; scene.model.nv];
        scene.place(&qpos, &still)
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        shaken_start(scene, self.base)
    }

    fn begin(&mut self, _scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        desired.fill(STANDING);
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        achieved.fill(view.state.xpos[self.head][2]);
        terms.fill(control_cost(view, self.reference));
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        StepReward {
            reward: first(goal.achieved) - SITTING - first(goal.terms),
            is_success: reached(goal),
            is_failure: false,
        }
    }
}

/// Returns whether a goal of one number is exceeded.
pub(super) fn reached(goal: Goal<'_>) -> bool {
    first(goal.achieved) >= first(goal.desired)
}

/// Returns the only number of a goal or of terms.
pub(super) fn first(values: &[f64]) -> f64 {
    values.first().copied().unwrap_or_default()
}

/// Starts an episode: the settled pose with every joint angle changed by up to 0.01 rad, at rest, then half a second without action.
///
/// Under `compat: reference` muscles are not updated during that time.
pub(super) fn shaken_start(scene: &mut TaskScene<'_>, base: usize) -> Result<(), EnvError> {
    scene.restart()?;
    for q in 0..scene.model.nq {
        // a shaken root would lift him from the floor or press him into it
        if !(base..base + 7).contains(&q) {
            let noise = scene.rng.uniform_in(-NOISE, NOISE);
            scene.state.qpos[q] += noise;
        }
    }
    scene.state.qvel.fill(0.0);
    scene.forward()?;
    relax(scene, REST)
}

/// Returns the cost of the controls: 0.01 times the sum of their squares. Controls of muscles are always 1, so for muscles it is the cost of the
/// actuation model, scaled to the same number of squares; under `compat: reference` it is constant.
pub(super) fn control_cost(view: &TaskView<'_>, reference: bool) -> f64 {
    let state = view.state;
    if state.muscle_torque.is_empty() || reference {
        return COST * state.ctrl.iter().map(|u| u * u).sum::<f64>();
    }
    let muscles = state.act.len() as f64;
    COST * muscles * muscles * view.actuation.cost(view.model, state)
}
