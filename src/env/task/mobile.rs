//! The mobile paradigm: a mobile that one of the limbs moves, in phases.

use super::scene::{TaskScene, TaskView};
use super::starts::random_start;
use super::{Goal, StepReward, Task, TaskEvent, TaskSizes, body};
use crate::config::{Config, Limb};
use crate::env::{BehaviorInfo, EnvError, Info};
use crate::math::*;
use crate::model::Model;
use crate::physics::State;

const PURPOSE: &str = "behavior mobile";
/// The names of the measures.
pub(super) const NAMES: &[&str] = &[
    "phase",
    "mobile_movement_baseline",
    "mobile_movement_reinforcement",
    "mobile_movement_extinction",
    "right_foot_movements_baseline",
    "right_foot_movements_reinforcement",
    "right_foot_movements_extinction",
    "left_foot_movements_baseline",
    "left_foot_movements_reinforcement",
    "left_foot_movements_extinction",
    "right_hand_movements_baseline",
    "right_hand_movements_reinforcement",
    "right_hand_movements_extinction",
    "left_hand_movements_baseline",
    "left_hand_movements_reinforcement",
    "left_hand_movements_extinction",
    "baseline_ratio",
];
/// Phases: before the mobile is tied, while it is tied, and afterwards.
const PHASES: usize = 3;
/// The phase in which the mobile is tied.
const REINFORCEMENT: usize = 1;
/// The limbs; the ribbon is tied to one of them.
const LIMBS: usize = Limb::ALL.len();
/// A movement begins when the end of a limb is faster than this, in the frame of the hip, m/s.
const BEGINS: f64 = 0.2;
/// A movement ends when the end of the limb is slower than this, m/s, or turns back.
const ENDS: f64 = 0.1;
/// Ratio of the rates of movements, tied over baseline, from which he has learned.
const LEARNED: f64 = 1.5;
/// Physics steps in which the ribbon reaches its limb and comes to rest.
const REST: u32 = 400;

/// MIMo moves a mobile with one of his limbs, after Rovee and Rovee (1969).
///
/// A ribbon leads from a limb to a hook on a spring. In the first phase (baseline) the hook hangs beside the mobile. In the second
/// (conjugate reinforcement) the mobile is tied to the hook and moves as much as the limb does. In the third (extinction) it is untied.
/// Success is a rate of movements of that limb in the second phase that is 1.5 times that of the first. The reward is 0 or, with
/// `mobile_reward`, the movement of the mobile in the step, m. Terms: that movement, and the ratio of the rates.
#[derive(Clone, Debug, Default)]
pub(super) struct Mobile {
    hip: usize,
    limbs: [usize; LIMBS],
    /// The index of the limb with the ribbon.
    limb: usize,
    /// The bodies that hang from the mobile.
    pendants: Vec<usize>,
    /// The constraints that hold the cuff, for each limb.
    tethers: [usize; LIMBS],
    tie: usize,
    /// Indices of mobile and hook in `qpos`.
    heights: [usize; 2],
    /// Steps at which the second and the third phase start.
    starts: [u64; 2],
    /// Time of a step, s.
    dt: f64,
    rewarded: bool,
    memory: MobileMemory,
}

/// The task's memory from step to step.
#[derive(Clone, Debug, Default)]
struct MobileMemory {
    steps: u64,
    /// Movement of the mobile in the last step, m.
    moved: f64,
    /// Path of the mobile in each phase, m.
    path: [f64; PHASES],
    /// Number of movements of each limb in each phase.
    movements: [[f64; PHASES]; LIMBS],
    /// Velocity of each limb at the beginning of its movement, m/s; 0 while it is at rest.
    moving: [Vec3; LIMBS],
    /// Last positions of the ends of the limbs, in the frame of the hip, m.
    ends: [Vec3; LIMBS],
    /// Last positions of the pendants, m.
    hung: Vec<Vec3>,
}

impl MobileMemory {
    fn save(&self, out: &mut Vec<f64>) {
        out.extend([self.steps as f64, self.moved]);
        out.extend_from_slice(&self.path);
        out.extend(self.movements.as_flattened());
        out.extend(self.moving.as_flattened());
        out.extend(self.ends.as_flattened());
        out.extend(self.hung.as_flattened());
    }

    /// Restores saved numbers. Numbers from an untrusted snapshot are clamped.
    fn load(&mut self, numbers: &[f64]) {
        let mut numbers = numbers.iter().copied();
        let mut next = || numbers.next().unwrap_or_default();
        // a cast of a float to an integer stays within its range
        (self.steps, self.moved) = (next() as u64, next());
        self.path.iter_mut().for_each(|v| *v = next());
        self.movements.as_flattened_mut().iter_mut().for_each(|v| *v = next());
        self.moving.as_flattened_mut().iter_mut().for_each(|v| *v = next());
        self.ends.as_flattened_mut().iter_mut().for_each(|v| *v = next());
        self.hung.as_flattened_mut().iter_mut().for_each(|v| *v = next());
    }
}

impl Mobile {
    /// Returns the phase of a step.
    fn phase(&self, step: u64) -> usize {
        self.starts.iter().filter(|start| step >= **start).count()
    }

    /// Returns the number of steps of a phase so far.
    fn lasted(&self, phase: usize) -> u64 {
        let bounds = [0, self.starts[0], self.starts[1], u64::MAX];
        self.memory.steps.min(bounds[phase + 1]).saturating_sub(bounds[phase])
    }

    /// Computes the ratio of the rates of movements of the limb with the ribbon, tied over baseline; 0 while either phase has no movements.
    fn ratio(&self) -> f64 {
        let rate = |phase: usize| match self.lasted(phase) {
            0 => 0.0,
            steps => self.memory.movements[self.limb][phase] / steps as f64,
        };
        let before = rate(0);
        if before > 0.0 {
            rate(REINFORCEMENT) / before
        } else {
            0.0
        }
    }

    /// Returns the position of the end of a limb in the frame of the hip.
    fn end(&self, state: &State, limb: usize) -> Vec3 {
        let way = sub(state.xpos[self.limbs[limb]], state.xpos[self.hip]);
        let frame = &state.xmat[self.hip];
        std::array::from_fn(|k| dot(way, column(frame, k)))
    }

    /// Ties the mobile to the hook at their current heights, or unties it, when a phase starts.
    fn change_phase(&self, scene: &mut TaskScene<'_>) {
        let tied = self.phase(self.memory.steps) == REINFORCEMENT;
        let state = &mut *scene.state;
        // tied where both are now, so that nothing jerks
        if tied && !state.params.eq_active[self.tie] {
            let [mobile, hook] = self.heights.map(|q| state.qpos[q] - scene.model.qpos0[q]);
            state.params.eq_offset[self.tie] = mobile - hook;
        }
        state.params.eq_active[self.tie] = tied;
    }

    /// Counts the movements in a step of a phase.
    fn count(&mut self, state: &State, phase: usize) {
        let mut sum = 0.0;
        for (before, &pendant) in self.memory.hung.iter_mut().zip(&self.pendants) {
            let now = state.xipos[pendant];
            sum += norm(sub(now, *before));
            *before = now;
        }
        self.memory.moved = sum / self.pendants.len().max(1) as f64;
        self.memory.path[phase] += self.memory.moved;
        for limb in 0..LIMBS {
            let now = self.end(state, limb);
            let velocity = scale(sub(now, self.memory.ends[limb]), 1.0 / self.dt);
            self.memory.ends[limb] = now;
            let (speed, moving) = (norm(velocity), &mut self.memory.moving[limb]);
            if speed < ENDS || dot(velocity, *moving) < 0.0 {
                *moving = [0.0; 3];
            }
            // two thresholds: a limb that trembles around one would count again and again
            if *moving == [0.0; 3] && speed > BEGINS {
                *moving = velocity;
                self.memory.movements[limb][phase] += 1.0;
            }
        }
    }
}

/// Finds an equality that the task needs.
fn equality(model: &Model, name: &str) -> Result<usize, EnvError> {
    let missing = || EnvError::Missing {
        what: "equality",
        name: name.to_string(),
        purpose: PURPOSE,
    };
    model.equality(name).ok_or_else(missing)
}

/// Lists the bodies below the mobile that carry no other body.
fn hanging(model: &Model, mobile: usize) -> Vec<usize> {
    let carries = |body: usize| model.body_parentid.contains(&body);
    let below = |&b: &usize| b != mobile && model.in_subtree(b, mobile) && !carries(b);
    (0..model.nbody()).filter(below).collect()
}

impl Task for Mobile {
    fn name(&self) -> &str {
        "mobile"
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        for (k, limb) in Limb::ALL.iter().enumerate() {
            self.limbs[k] = body(model, limb.name(), PURPOSE)?;
            self.tethers[k] = equality(model, &format!("tether_{limb}"))?;
            if *limb == config.mobile.limb {
                self.limb = k;
            }
        }
        self.hip = body(model, "hip", PURPOSE)?;
        self.tie = equality(model, "tie")?;
        self.heights = [
            super::pose::address(model, "mobile_bounce", PURPOSE)?,
            super::pose::address(model, "hook", PURPOSE)?,
        ];
        self.pendants = hanging(model, body(model, "mobile", PURPOSE)?);
        let steps = config.max_episode_steps as f64;
        let [first, last] = [config.mobile.baseline, config.mobile.extinction];
        // rounded to whole steps
        self.starts = [(first * steps).round() as u64, ((1.0 - last) * steps).round() as u64];
        self.dt = model.opt.timestep * f64::from(config.frame_skip);
        self.rewarded = config.mobile.reward;
        self.memory.hung = vec![[0.0; 3]; self.pendants.len()];
        Ok(TaskSizes {
            goal: 0,
            terms: 2,
            observation: 0,
        })
    }

    /// Attaches the cuff to the limb, and waits until the ribbon is at rest.
    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        for (limb, &tether) in self.tethers.iter().enumerate() {
            // in the parameters of a reset, so that it holds in every episode
            scene.base.eq_active[tether] = limb == self.limb;
        }
        scene.state.params.eq_active.copy_from_slice(&scene.base.eq_active);
        scene.settle()?;
        scene.rest(REST)
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        random_start(scene, |_| Ok(()))
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, _desired: &mut [f64]) {
        // kept for its allocation, because a reset allocates nothing
        let hung = std::mem::take(&mut self.memory.hung);
        self.memory = MobileMemory {
            hung,
            ..MobileMemory::default()
        };
        for (place, &pendant) in self.memory.hung.iter_mut().zip(&self.pendants) {
            *place = scene.state.xipos[pendant];
        }
        self.memory.ends = std::array::from_fn(|limb| self.end(scene.state, limb));
        self.change_phase(scene);
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        let phase = self.phase(self.memory.steps);
        self.count(scene.state, phase);
        self.memory.steps = self.memory.steps.saturating_add(1);
        self.change_phase(scene);
        Ok(())
    }

    fn achieve(&self, _view: &TaskView<'_>, _desired: &[f64], _achieved: &mut [f64], terms: &mut [f64]) {
        terms.copy_from_slice(&[self.memory.moved, self.ratio()]);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let &[moved, ratio] = goal.terms else {
            return StepReward::default();
        };
        StepReward {
            reward: if self.rewarded { moved } else { 0.0 },
            is_success: ratio >= LEARNED,
            is_failure: false,
        }
    }

    fn inform(&self, event: TaskEvent<'_>, info: &mut Info) {
        let BehaviorInfo::Task(task) = &mut info.behavior else {
            return;
        };
        let values = match event {
            // the memory is still that of the last episode
            TaskEvent::Start => None,
            TaskEvent::Step(_) | TaskEvent::Restored => {
                let phase = self.phase(self.memory.steps.saturating_sub(1)) as f64;
                let counts = self.memory.movements.as_flattened().iter();
                let all = self.memory.path.iter().chain(counts).copied();
                Some(std::iter::once(phase).chain(all).chain([self.ratio()]))
            }
        };
        task.measures.set(NAMES, values.into_iter().flatten());
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.memory.save(out);
    }

    fn load(&mut self, numbers: &[f64]) {
        self.memory.load(numbers);
    }
}
