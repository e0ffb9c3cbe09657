//! Play: toys that are touched, held and moved.

use super::scene::{TaskScene, TaskView};
use super::starts::random_start;
use super::{Goal, StepReward, Task, TaskEvent, TaskSizes};
use crate::config::Config;
use crate::env::{BehaviorInfo, EnvError, Info};
use crate::math::*;
use crate::mimo::MimoBodies;
use crate::model::{JointType, Model};
use crate::physics::State;

/// The names of the measures.
pub(super) const NAMES: &[&str] = &[
    "toys",
    "toys_touched",
    "toys_held",
    "toys_moved",
    "holding_time",
    "toys_path",
];
/// Distance from its start at which a touched toy counts as moved, m.
const MOVED: f64 = 0.05;

/// MIMo plays: he touches, holds and moves toys, which are all free bodies that are not his.
///
/// A toy is held in a step if it touches one of his hands at the end of the step, and nothing that is not his. Success is to have touched
/// all toys. The reward is 0 or, with `play_reward`, 1 for each toy that is first touched in the step. Terms: the number of those toys,
/// and the share of toys touched so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Play {
    toys: Vec<usize>,
    /// The owner of each geom (ngeom).
    owner: Vec<GeomOwner>,
    /// Time of a step, s.
    dt: f64,
    rewarded: bool,
    memory: PlayMemory,
    /// Contacts of each toy in a step.
    seen: Vec<ToyContacts>,
}

/// The owner of a geom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum GeomOwner {
    #[default]
    World,
    Mimo,
    /// A hand or its fingers.
    Hand,
    /// A toy, by its index in the list.
    Toy(usize),
}

/// The kinds of things that a toy touches.
#[derive(Clone, Copy, Debug, Default)]
struct ToyContacts {
    mimo: bool,
    hand: bool,
    other: bool,
}

/// A toy in an episode.
#[derive(Clone, Copy, Debug, Default)]
struct ToyMemory {
    touched: bool,
    held: bool,
    moved: bool,
    /// Position at the start, m.
    start: Vec3,
    /// Position after the last step, m.
    last: Vec3,
}

/// The task's memory from step to step.
#[derive(Clone, Debug, Default)]
struct PlayMemory {
    toys: Vec<ToyMemory>,
    /// Steps in which a toy was held.
    holding: f64,
    /// Path of the toys since they were touched, m.
    path: f64,
    /// Toys that were touched for the first time in the last step.
    new: f64,
}

impl PlayMemory {
    fn number(&self, which: impl Fn(&ToyMemory) -> bool) -> f64 {
        self.toys.iter().filter(|toy| which(toy)).count() as f64
    }
}

impl Play {
    /// Collects the contacts of each toy.
    fn look(&mut self, state: &State) {
        self.seen.fill(ToyContacts::default());
        for contact in &state.contact {
            let [a, b] = contact.geom.map(|geom| self.owner[geom]);
            for (own, other) in [(a, b), (b, a)] {
                let GeomOwner::Toy(toy) = own else { continue };
                let seen = &mut self.seen[toy];
                match other {
                    GeomOwner::Hand => (seen.hand, seen.mimo) = (true, true),
                    GeomOwner::Mimo => seen.mimo = true,
                    // what lies on something is not held
                    GeomOwner::World | GeomOwner::Toy(_) => seen.other = true,
                }
            }
        }
    }

    /// Returns whether there are toys and all were touched.
    fn share(&self) -> f64 {
        let toys = self.memory.toys.len();
        if toys == 0 {
            return 0.0;
        }
        self.memory.number(|toy| toy.touched) / toys as f64
    }
}

impl Task for Play {
    fn name(&self) -> &str {
        "play"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        let mimo = MimoBodies::of(model);
        let hip = model.body(crate::mimo::ROOT);
        let carries_mimo = |body: usize| hip.is_some_and(|hip| model.in_subtree(hip, body));
        let free = |&j: &usize| model.jnt_type[j] == JointType::Free && !carries_mimo(model.jnt_bodyid[j]);
        self.toys = (0..model.njnt()).filter(free).map(|j| model.jnt_bodyid[j]).collect();
        if self.toys.is_empty() {
            return Err(EnvError::Missing {
                what: "body with a free joint",
                name: "a toy".to_string(),
                purpose: "behavior play",
            });
        }
        let hands = ["right_hand", "left_hand"].map(|name| model.body(name));
        let owner = |&body: &usize| {
            let toy = self.toys.iter().position(|&toy| model.in_subtree(body, toy));
            match toy {
                Some(toy) => GeomOwner::Toy(toy),
                None if hands.iter().flatten().any(|&hand| model.in_subtree(body, hand)) => GeomOwner::Hand,
                None if mimo.contains(body) => GeomOwner::Mimo,
                None => GeomOwner::World,
            }
        };
        self.owner = model.geom_bodyid.iter().map(owner).collect();
        self.dt = model.opt.timestep * f64::from(config.frame_skip);
        self.rewarded = config.play.reward;
        self.memory.toys = vec![ToyMemory::default(); self.toys.len()];
        self.seen = vec![ToyContacts::default(); self.toys.len()];
        Ok(TaskSizes {
            goal: 0,
            terms: 2,
            observation: 0,
        })
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        random_start(scene, |_| Ok(()))
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, _desired: &mut [f64]) {
        (self.memory.holding, self.memory.path, self.memory.new) = (0.0, 0.0, 0.0);
        for (toy, &body) in self.memory.toys.iter_mut().zip(&self.toys) {
            let place = scene.state.xipos[body];
            *toy = ToyMemory {
                start: place,
                last: place,
                ..ToyMemory::default()
            };
        }
    }

    fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        self.look(scene.state);
        let (mut new, mut holding) = (0.0, false);
        for (k, toy) in self.memory.toys.iter_mut().enumerate() {
            let (seen, place) = (self.seen[k], scene.state.xipos[self.toys[k]]);
            if seen.mimo && !toy.touched {
                toy.touched = true;
                new += 1.0;
            }
            if seen.hand && !seen.other {
                toy.held = true;
                holding = true;
            }
            // toys that roll by themselves do not count
            if toy.touched {
                self.memory.path += norm(sub(place, toy.last));
                toy.moved |= norm(sub(place, toy.start)) > MOVED;
            }
            toy.last = place;
        }
        self.memory.new = new;
        self.memory.holding += f64::from(u8::from(holding));
        Ok(())
    }

    fn achieve(&self, _view: &TaskView<'_>, _desired: &[f64], _achieved: &mut [f64], terms: &mut [f64]) {
        terms.copy_from_slice(&[self.memory.new, self.share()]);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let &[new, share] = goal.terms else {
            return StepReward::default();
        };
        StepReward {
            reward: if self.rewarded { new } else { 0.0 },
            is_success: share >= 1.0,
            is_failure: false,
        }
    }

    fn inform(&self, event: TaskEvent<'_>, info: &mut Info) {
        let BehaviorInfo::Task(task) = &mut info.behavior else {
            return;
        };
        let (toys, memory) = (self.toys.len() as f64, &self.memory);
        let values = match event {
            // the memory is still that of the last episode
            TaskEvent::Start => [toys, 0.0, 0.0, 0.0, 0.0, 0.0],
            TaskEvent::Step(_) | TaskEvent::Restored => [
                toys,
                memory.number(|toy| toy.touched),
                memory.number(|toy| toy.held),
                memory.number(|toy| toy.moved),
                memory.holding * self.dt,
                memory.path,
            ],
        };
        task.measures.set(NAMES, values);
    }

    fn save(&self, out: &mut Vec<f64>) {
        let memory = &self.memory;
        out.extend([memory.holding, memory.path, memory.new]);
        for toy in &memory.toys {
            out.extend([toy.touched, toy.held, toy.moved].map(|on| f64::from(u8::from(on))));
            out.extend_from_slice(&toy.start);
            out.extend_from_slice(&toy.last);
        }
    }

    /// Restores saved numbers. Numbers from an untrusted snapshot are clamped.
    fn load(&mut self, numbers: &[f64]) {
        let mut numbers = numbers.iter().copied();
        let mut next = || numbers.next().unwrap_or_default();
        let memory = &mut self.memory;
        (memory.holding, memory.path, memory.new) = (next(), next(), next());
        for toy in &mut memory.toys {
            (toy.touched, toy.held, toy.moved) = (next() > 0.0, next() > 0.0, next() > 0.0);
            toy.start = std::array::from_fn(|_| next());
            toy.last = std::array::from_fn(|_| next());
        }
    }
}
