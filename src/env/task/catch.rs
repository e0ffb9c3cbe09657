//! Catching a ball.

use super::pose::free_address;
use super::scene::{TaskScene, TaskView};
use super::starts::relax;
use super::tracking::{ForgottenJoints, HeadTracking};
use super::{Goal, StepReward, Task, TaskDocument, TaskSizes, body, spacing};
use crate::config::{Compat, Config};
use crate::env::EnvError;
use crate::math::{Vec3, add, norm, sub};
use crate::mimo::CHEST;
use crate::model::Model;
use crate::physics::{FreeBody, State};
use crate::sensors::touch::MIN_FORCE;

const PURPOSE: &str = "behavior catch";
/// Greatest shift of the ball at the start of an episode, m.
const SHIFT: Vec3 = [0.01, 0.01, 0.08];
/// Range of the ball's radius, m.
const RADIUS: [f64; 2] = [0.005, 0.025];
/// Range of the ball's mass, kg.
const MASS: [f64; 2] = [0.05, 0.5];
/// Greatest error of the point that the eyes follow, in each direction, m.
const ERROR: f64 = 0.005;
/// Physics steps in which the arm settles, without gravity.
const SETTLING: u32 = 50;
/// Steps in a row with contact that count as caught.
const HELD: usize = 100;
/// Depth below the hand, and distance from it, at which the ball is lost, m.
const LOST: [f64; 2] = [0.1, 0.5];
/// Reward of success; its negative for failure.
const BONUS: f64 = 100.0;
/// Weight of the cost of an action.
const COST: f64 = 40.0;
/// Range of the number of steps between two changes of the factors on actions.
const JITTER_PERIOD: [f64; 2] = [10.0, 51.0];
/// Range of the factors on actions.
const JITTER: [f64; 2] = [0.8, 1.2];

/// Bodies with touch sensors and the distances between them, m.
const TOUCH: &[(&str, f64)] = &[
    ("right_upper_arm", 0.024),
    ("right_lower_arm", 0.024),
    ("right_hand", 0.007),
    ("right_ffdistal", 0.002),
    ("right_mfdistal", 0.002),
    ("right_rfdistal", 0.002),
    ("right_lfdistal", 0.002),
    ("right_thdistal", 0.002),
    ("right_ffmiddle", 0.004),
    ("right_mfmiddle", 0.004),
    ("right_rfmiddle", 0.004),
    ("right_lfmiddle", 0.004),
    ("right_thhub", 0.004),
    ("right_ffknuckle", 0.004),
    ("right_mfknuckle", 0.004),
    ("right_rfknuckle", 0.004),
    ("right_lfknuckle", 0.004),
    ("right_thbase", 0.004),
    ("right_lfmetacarpal", 0.007),
];

/// MIMo holds his right hand out, a ball of random size and mass falls into it, and he holds it for a hundred steps.
///
/// Goals are empty. The reward is 1 for contact with the ball, minus 40 times the cost of the actuation model (if `action_penalty`), 100
/// on success and -100 on failure: the ball is 10 cm below the hand or 50 cm from it. Terms: contact, cost, success, failure. The radius
/// of the ball is the last entry of proprioception.
///
/// MIMo 3 moves his arm, too. Without contact his reward is 0.5 m minus the distance of the ball from his hand, from -0.5 to 0.5, and the
/// distance is a fifth term. Under `compat: reference` his actions cost nothing.
///
/// Under `compat: reference` the ball starts in one place, contacts of the last episode count for success, and muscles are not
/// updated while the arm settles.
#[derive(Clone, Debug, Default)]
pub(super) struct Catch {
    target: usize,
    hand: usize,
    ball: usize,
    geom: usize,
    /// Whether the geoms (ngeom) belong to the hand and the arm.
    own: Vec<bool>,
    head: HeadTracking,
    jitter: bool,
    inaccurate: bool,
    penalty: bool,
    /// Whether MIMo is version 3.
    third: bool,
    reference: bool,
    memory: CatchMemory,
}

/// The task's memory from step to step.
#[derive(Clone, Debug)]
struct CatchMemory {
    /// Steps of the episode.
    steps: u64,
    /// Error of the point that the eyes follow, m.
    error: Vec3,
    /// Steps until the factors change.
    period: u64,
    /// Whether there was contact in each of the last steps. Step k is at index `k % HELD`.
    past: [bool; HELD],
    /// Factors on actions, if there is jitter.
    factors: Vec<f64>,
}

impl Default for CatchMemory {
    fn default() -> Self {
        Self {
            steps: 0,
            error: [0.0; 3],
            period: 0,
            past: [false; HELD],
            factors: Vec::new(),
        }
    }
}

impl CatchMemory {
    /// Returns the index of the current step's contact.
    fn now(&self) -> usize {
        (self.steps % HELD as u64) as usize
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.push(self.steps as f64);
        out.extend_from_slice(&self.error);
        out.push(self.period as f64);
        out.extend(self.past.map(flag));
        out.extend_from_slice(&self.factors);
    }

    /// Restores saved numbers. Numbers from an untrusted snapshot are clamped.
    fn load(&mut self, numbers: &[f64]) {
        let Some((&[steps, x, y, z, period], rest)) = numbers.split_first_chunk() else {
            return;
        };
        let Some((past, factors)) = rest.split_first_chunk::<HELD>() else {
            return;
        };
        // a cast of a float to an integer stays within its range
        (self.steps, self.error, self.period) = (steps as u64, [x, y, z], period as u64);
        self.past = past.map(|contact| contact > 0.0);
        for (own, factor) in self.factors.iter_mut().zip(factors) {
            *own = *factor;
        }
    }
}

fn flag(on: bool) -> f64 {
    f64::from(u8::from(on))
}

impl Catch {
    fn in_contact(&self, state: &State) -> bool {
        state.contact.iter().any(|c| {
            let [a, b] = c.geom;
            // geoms of a contact are ordered by type, so the ball may be either
            let pair = a == self.geom && self.own[b] || b == self.geom && self.own[a];
            pair && c.force[0].abs() >= MIN_FORCE
        })
    }

    fn change_factors(&mut self, scene: &mut TaskScene<'_>) {
        if self.memory.period > 0 {
            self.memory.period -= 1;
            return;
        }
        self.memory.period = scene.rng.uniform_in(JITTER_PERIOD[0], JITTER_PERIOD[1]) as u64;
        for factor in &mut self.memory.factors {
            *factor = scene.rng.uniform_in(JITTER[0], JITTER[1]);
        }
    }

    /// Draws the ball of an episode (place, size, mass) and the error of the eyes.
    fn throw(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        // drawn under `compat: reference`, too, which draws it and does not use it
        let shift = SHIFT.map(|most| scene.rng.uniform_in(-most, most));
        let radius = scene.rng.uniform_in(RADIUS[0], RADIUS[1]);
        let mass = scene.rng.uniform_in(MASS[0], MASS[1]);
        let model = scene.model;
        scene
            .state
            .set_free_body(model, self.target, FreeBody::sphere(mass, radius))?;
        if !self.reference {
            for (k, shift) in shift.into_iter().enumerate() {
                scene.state.qpos[self.ball + k] += shift;
            }
        }
        if self.inaccurate {
            self.memory.error = [(); 3].map(|()| scene.rng.uniform_in(-ERROR, ERROR));
        }
        Ok(())
    }
}

impl Task for Catch {
    fn name(&self) -> &str {
        "catch"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn document(&self, config: &Config) -> TaskDocument {
        TaskDocument {
            touch_spacing: spacing(TOUCH),
            ..TaskDocument::of(config)
        }
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.target = body(model, "target", PURPOSE)?;
        self.hand = body(model, "right_hand", PURPOSE)?;
        self.ball = free_address(model, self.target, PURPOSE)?;
        self.geom = model.body_geomadr[self.target];
        let skin = TOUCH
            .iter()
            .map(|(name, _)| body(model, name, PURPOSE))
            .collect::<Result<Vec<_>, _>>()?;
        self.own = model.geom_bodyid.iter().map(|b| skin.contains(b)).collect();
        self.reference = config.compat == Compat::Reference;
        self.head = HeadTracking::new(model, ForgottenJoints::None, PURPOSE)?;
        (self.jitter, self.inaccurate) = (config.catch.jitter, config.catch.position_inaccurate);
        self.third = config.mimo_version == CHEST;
        // MIMo 3's Python code computes the penalty and does not use it
        self.penalty = config.catch.action_penalty && !(self.third && self.reference);
        self.memory.factors = vec![1.0; if self.jitter { 2 * model.nu() } else { 0 }];
        Ok(TaskSizes {
            goal: 0,
            terms: if self.third { 5 } else { 4 },
            observation: 1,
        })
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.steps(1)?;
        scene.restart()
    }

    /// Draws the place of the ball, its radius, its mass and, if the eyes are inaccurate, their error; then the arm settles.
    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.restart()?;
        self.throw(scene)?;
        scene.forward()?;
        // the ball floats while the arm settles
        let gravity = std::mem::take(&mut scene.state.params.gravity);
        scene.actuation.reset(scene.model, scene.state);
        let settled = relax(scene, SETTLING);
        scene.state.params.gravity = gravity;
        settled?;
        if !self.reference {
            self.memory.period = 0;
        }
        // the head turns to the ball before the first observation
        self.after_step(scene)?;
        scene.forward()
    }

    fn begin(&mut self, _scene: &mut TaskScene<'_>, _desired: &mut [f64]) {
        self.memory.steps = 0;
        if !self.reference {
            self.memory.past = [false; HELD];
        }
    }

    fn before_step(&mut self, action: &mut [f32]) {
        for (a, factor) in action.iter_mut().zip(&self.memory.factors) {
            *a = ((f64::from(*a) * factor) as f32).clamp(0.0, 1.0);
        }
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        self.memory.steps = self.memory.steps.saturating_add(1);
        let now = self.memory.now();
        self.memory.past[now] = self.in_contact(scene.state);
        let point = add(scene.state.xpos[self.target], self.memory.error);
        self.head.look_at(scene, point);
        if self.jitter {
            self.change_factors(scene);
        }
        Ok(())
    }

    fn observe(&self, state: &State, out: &mut [f64]) {
        out.fill(state.params.geom_size[self.geom][0]);
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], _achieved: &mut [f64], terms: &mut [f64]) {
        let held = self.memory.past.iter().all(|contact| *contact);
        let cost = if self.penalty {
            view.actuation.cost(view.model, view.state)
        } else {
            0.0
        };
        let (ball, hand) = (view.state.xpos[self.target], view.state.xpos[self.hand]);
        let distance = norm(sub(ball, hand));
        // below the hand or far from it: he can no longer catch it
        let lost = ball[2] < hand[2] - LOST[0] || distance > LOST[1];
        let contact = self.memory.past[self.memory.now()];
        let found = [flag(contact), cost, flag(held), flag(lost), distance];
        terms.copy_from_slice(&found[..terms.len()]);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let (&[contact, cost, held, lost], distance) = (match goal.terms {
            [terms @ .., distance] if self.third => (terms, Some(distance)),
            terms => (terms, None),
        }) else {
            return StepReward::default();
        };
        let near = match distance {
            Some(distance) if contact == 0.0 => (LOST[1] - distance).clamp(-LOST[1], LOST[1]),
            _ => contact,
        };
        StepReward {
            reward: near - COST * cost - BONUS * lost + BONUS * held,
            is_success: held > 0.0,
            is_failure: lost > 0.0,
        }
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.memory.save(out);
    }

    fn load(&mut self, numbers: &[f64]) {
        self.memory.load(numbers);
    }
}
