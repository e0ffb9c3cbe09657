//! Catching a ball.

use super::pose::free_address;
use super::scene::{TaskScene, TaskView};
use super::tracking::HeadTracking;
use super::{Goal, Task, TaskSizes, body};
use crate::config::{Compat, Config};
use crate::env::EnvError;
use crate::math::{Vec3, add, norm, sub};
use crate::model::Model;
use crate::physics::{FreeBody, State};
use crate::sensors::touch::MIN_FORCE;

const PURPOSE: &str = "behavior catch";
/// Greatest shift of the ball at the start of an episode, m.
const SHIFT: Vec3 = [0.01, 0.01, 0.08];
/// Radius of the ball, m: from, to.
const RADIUS: [f64; 2] = [0.005, 0.025];
/// Mass of the ball, kg: from, to.
const MASS: [f64; 2] = [0.05, 0.5];
/// Greatest error of the point that the eyes follow, in each direction, m.
const ERROR: f64 = 0.005;
/// Physics steps in which the arm settles, without gravity.
const SETTLING: u32 = 50;
/// Steps in a row with contact that count as caught.
const HELD: usize = 100;
/// Depth below the hand, and distance from it, at which the ball is lost, m.
const LOST: [f64; 2] = [0.1, 0.5];
/// Reward of success, and of failure with another sign.
const BONUS: f64 = 100.0;
/// Weight of the cost of an action.
const COST: f64 = 40.0;
/// Steps between two changes of the factors on actions: from, to.
const JITTER_PERIOD: [f64; 2] = [10.0, 51.0];
/// Factors on actions: from, to.
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
/// Goals are empty. The reward is 1 for contact with the ball, minus 40 times the cost of the actuation model (if
/// `action_penalty`), 100 on success and -100 on failure: the ball lies 10 cm below the hand or 50 cm from it. Terms: contact,
/// cost, success, failure. The radius of the ball is the last entry of proprioception.
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
    reference: bool,
    memory: Vec<f64>,
}

/// Places in the memory: number of steps; error of the point that the eyes follow; steps until factors change; whether there was
/// contact in each of the last steps; factors on actions.
const STEPS: usize = 0;
const OFFSET: usize = 1;
const PERIOD: usize = 4;
const PAST: usize = 5;
const FACTORS: usize = PAST + HELD;

impl Catch {
    /// Returns where in the memory the contact of the present step stands.
    fn now(&self) -> usize {
        PAST + self.memory[STEPS].max(0.0) as usize % HELD
    }

    fn in_contact(&self, state: &State) -> bool {
        state.contact.iter().any(|c| {
            let [a, b] = c.geom;
            let pair = a == self.geom && self.own[b] || b == self.geom && self.own[a];
            pair && c.force[0].abs() >= MIN_FORCE
        })
    }

    fn change_factors(&mut self, scene: &mut TaskScene<'_>) {
        if self.memory[PERIOD] > 0.0 {
            self.memory[PERIOD] -= 1.0;
            return;
        }
        self.memory[PERIOD] = scene.rng.uniform_in(JITTER_PERIOD[0], JITTER_PERIOD[1]).floor();
        for factor in &mut self.memory[FACTORS..] {
            *factor = scene.rng.uniform_in(JITTER[0], JITTER[1]);
        }
    }

    /// Draws the ball of an episode: place, size, mass, and the error of the eyes.
    fn throw(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
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
            for k in 0..3 {
                self.memory[OFFSET + k] = scene.rng.uniform_in(-ERROR, ERROR);
            }
        }
        Ok(())
    }
}

impl Task for Catch {
    fn name(&self) -> &str {
        "catch"
    }

    fn touch_spacing(&self) -> &[(&'static str, f64)] {
        TOUCH
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<(), EnvError> {
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
        self.head = HeadTracking::new(model, false, PURPOSE)?;
        (self.jitter, self.inaccurate) = (config.jitter, config.position_inaccurate);
        self.penalty = config.action_penalty;
        self.memory = vec![0.0; FACTORS + if self.jitter { 2 * model.nu() } else { 0 }];
        self.memory[FACTORS..].fill(1.0);
        Ok(())
    }

    fn sizes(&self) -> TaskSizes {
        TaskSizes {
            goal: 0,
            terms: 4,
            observation: 1,
        }
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
        let gravity = std::mem::take(&mut scene.state.params.gravity);
        scene.reset_actuators();
        let settled = scene.relax(SETTLING);
        scene.state.params.gravity = gravity;
        settled?;
        if !self.reference {
            self.memory[PERIOD] = 0.0;
        }
        self.after_step(scene)?;
        scene.forward()
    }

    fn begin(&mut self, _scene: &mut TaskScene<'_>, _desired: &mut [f64]) {
        self.memory[STEPS] = 0.0;
        if !self.reference {
            self.memory[PAST..FACTORS].fill(0.0);
        }
    }

    fn before_step(&mut self, action: &mut [f32]) {
        for (a, factor) in action.iter_mut().zip(&self.memory[FACTORS..]) {
            *a = ((f64::from(*a) * factor) as f32).clamp(0.0, 1.0);
        }
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        self.memory[STEPS] += 1.0;
        let now = self.now();
        self.memory[now] = f64::from(u8::from(self.in_contact(scene.state)));
        let error = std::array::from_fn(|k| self.memory[OFFSET + k]);
        let point = add(scene.state.xpos[self.target], error);
        self.head.look_at(scene, point);
        if self.jitter {
            self.change_factors(scene);
        }
        Ok(())
    }

    fn observe(&self, state: &State, out: &mut [f64]) {
        out.fill(state.params.geom_size[self.geom][0]);
    }

    fn achieve(&mut self, view: &TaskView<'_>, _desired: &[f64], _achieved: &mut [f64], terms: &mut [f64]) {
        let held = self.memory[PAST..FACTORS].iter().all(|contact| *contact > 0.0);
        let cost = if self.penalty {
            view.actuation.cost(view.model, view.state)
        } else {
            0.0
        };
        let (ball, hand) = (view.state.xpos[self.target], view.state.xpos[self.hand]);
        let lost = ball[2] < hand[2] - LOST[0] || norm(sub(ball, hand)) > LOST[1];
        let flag = |on: bool| f64::from(u8::from(on));
        terms.copy_from_slice(&[self.memory[self.now()], cost, flag(held), flag(lost)]);
    }

    fn success(&self, goal: Goal<'_>) -> bool {
        goal.terms.get(2).is_some_and(|held| *held > 0.0)
    }

    fn failure(&self, goal: Goal<'_>) -> bool {
        goal.terms.get(3).is_some_and(|lost| *lost > 0.0)
    }

    fn reward(&self, goal: Goal<'_>) -> f64 {
        let &[contact, cost, held, lost] = goal.terms else {
            return 0.0;
        };
        contact - COST * cost - BONUS * lost + BONUS * held
    }

    fn memory(&self) -> &[f64] {
        &self.memory
    }

    fn memory_mut(&mut self) -> &mut [f64] {
        &mut self.memory
    }
}
