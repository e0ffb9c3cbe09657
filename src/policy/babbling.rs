//! Goal babbling: an infant that learns to touch itself by trying movements, remembering the resulting touches, and repeating movements that lead to
//! rare ones.
//!
//! The idea is that of M. Rolf, J. J. Steil and M. Gienger, "Goal babbling permits direct learning of inverse kinematics" (2010), and of
//! A. Baranes and P.-Y. Oudeyer, "Active learning of inverse models with intrinsically motivated goal exploration in robots" (2013):
//! goals are chosen among possible sensations, and the movements that came near them are varied. There is no network and no gradient. The
//! memory is a list, and the outcome of a movement is predicted from its nearest experiences.

mod arms;
mod memory;

use arms::Arms;
use memory::{BestMovements, Movement, MovementMemory, MovementOutcome};

use super::{Policy, PolicyError};
use crate::env::Env;
use crate::sensors::ProprioceptionComponent;
use crate::spaces::NumpyRng;

/// Durations of a new movement, s; one is drawn at random. At his strength, MIMo's reaches take 0.1 to 0.4 s.
const DURATIONS: [f64; 3] = [0.1, 0.2, 0.4];
/// Shares of the decisions that repeat the most promising movement, vary it, and combine arms of two movements; the rest is random.
const AGAIN: f64 = 0.4;
const VARIED: f64 = 0.2;
const COMBINED: f64 = 0.2;
/// Standard deviations of variations, in half ranges of an action; one is drawn at random.
const VARIATIONS: [f64; 4] = [0.05, 0.1, 0.2, 0.4];
/// Share of variations with another duration, and the spread of the logarithm of that duration.
const RETIMED: f64 = 0.3;
const RETIMING: f64 = 0.3;
/// Bounds of a movement's duration, s.
const SHORTEST: f64 = 0.05;
const LONGEST: f64 = 1.0;
/// Weight of the last episode in the running frequency of each touch.
const FORGETTING: f64 = 0.05;

/// A policy that learns to touch its body while it acts, using only its skin and its joints; `babbling` on the command line.
///
/// An action is held for a while, a *movement*. At its end the policy knows which parts of the body each palm has felt, and remembers
/// that together with the posture in which the movement began. It then prefers the movement that promises most touches which
/// this episode has not had, rare ones above all, as foreseen from the experiences in similar postures (Gaussian kernel regression over joint
/// angles, 0.2 rad wide); it repeats it, varies it, takes one arm's part from another movement, or tries something random. After
/// [`Policy::settle`] it only repeats.
///
/// ```
/// use babybench::policy::{BabblingPolicy, Policy};
/// use babybench::{Config, Env};
///
/// let config = Config { behavior: babybench::config::Behavior::SelfTouch, vision_active: false, ..Config::default() };
/// let mut env = Env::new(config)?;
/// let (mut policy, mut action) = (BabblingPolicy::new(), Vec::new());
/// env.reset(Some(0))?;
/// policy.begin(&mut env, 0)?;
/// for _ in 0..200 {
///     policy.act(&mut env, &mut action)?;
///     env.step(&action)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct BabblingPolicy {
    learner: Option<BabblingLearner>,
    settled: bool,
}

impl BabblingPolicy {
    /// Makes an untrained policy.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the number of movements in its memory.
    pub fn movements(&self) -> usize {
        self.learner.as_ref().map_or(0, |learner| learner.memory.len())
    }
}

/// The policy's knowledge of one body, and its current movement.
#[derive(Clone, Debug)]
struct BabblingLearner {
    arms: Arms,
    memory: MovementMemory,
    rng: NumpyRng,
    /// For each pair of a palm and a geom, its recent frequency in episodes.
    shares: Vec<f64>,
    /// The pairs that this episode has had.
    touched: Vec<bool>,
    running: Option<CurrentMovement>,
    dt: f64,
}

/// The current movement.
#[derive(Clone, Debug)]
struct CurrentMovement {
    movement: Movement,
    /// The movement of the memory that is repeated; `None` for a new one.
    again: Option<usize>,
    posture: Vec<f32>,
    felt: Vec<u32>,
    left: u32,
}

impl Policy for BabblingPolicy {
    fn begin(&mut self, env: &mut Env, _episode: u64) -> Result<(), PolicyError> {
        match &mut self.learner {
            Some(learner) if learner.arms.fits(env) => learner.end_episode(),
            Some(_) => return Err(PolicyError::Other("this policy has learned with another body".into())),
            learner => *learner = Some(BabblingLearner::new(env)?),
        }
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if self.learner.is_none() {
            self.begin(env, 0)?;
        }
        let Some(learner) = &mut self.learner else {
            return Ok(());
        };
        learner.feel(env);
        if learner.running.as_ref().is_none_or(|running| running.left == 0) {
            learner.remember(self.settled);
            learner.decide(env, self.settled);
        }
        action.clear();
        if let Some(running) = &mut learner.running {
            running.left = running.left.saturating_sub(1);
            action.extend_from_slice(&running.movement.action);
        }
        Ok(())
    }

    fn settle(&mut self) {
        self.settled = true;
    }
}

impl BabblingLearner {
    fn new(env: &mut Env) -> Result<Self, PolicyError> {
        let arms = Arms::new(env)?;
        let pairs = arms.pairs();
        Ok(Self {
            memory: MovementMemory::default(),
            rng: NumpyRng::seed(env.draw_seed()),
            shares: vec![0.0; pairs],
            touched: vec![false; pairs],
            running: None,
            dt: env.blueprint().dt(),
            arms,
        })
    }

    /// Updates the frequencies of touches, and drops the movement that the end of the episode interrupted.
    fn end_episode(&mut self) {
        for (share, touched) in self.shares.iter_mut().zip(&mut self.touched) {
            *share += FORGETTING * (f64::from(u8::from(*touched)) - *share);
            *touched = false;
        }
        self.running = None;
    }

    /// Records what the palms feel now, as part of the current movement.
    fn feel(&mut self, env: &Env) {
        if let Some(running) = &mut self.running {
            self.arms.feel(env, |pair| {
                if !running.felt.contains(&pair) {
                    running.felt.push(pair);
                }
            });
        }
    }

    /// Ends the movement.
    fn remember(&mut self, settled: bool) {
        let Some(running) = self.running.take() else {
            return;
        };
        for &pair in &running.felt {
            self.touched[pair as usize] = true;
        }
        if settled {
            return;
        }
        let nothing = running.felt.is_empty();
        let outcome = MovementOutcome {
            posture: running.posture,
            felt: running.felt,
        };
        match running.again {
            Some(index) => self.memory.add_outcome(index, outcome),
            // what leads nowhere is not worth a place
            None if nothing => {}
            None => self.memory.add(running.movement, outcome, &mut self.rng),
        }
    }

    /// Starts a movement.
    fn decide(&mut self, env: &Env, settled: bool) {
        let posture = posture(env);
        let chance = if settled { 0.0 } else { self.rng.uniform() };
        let mut choice = if chance < AGAIN + VARIED + COMBINED {
            self.best(&posture, settled)
        } else {
            BestMovements::default()
        };
        if settled && choice.both.is_none() {
            // everything known was touched: start again
            self.touched.fill(false);
            choice = self.best(&posture, settled);
        }
        let mut again = None;
        let movement = match choice.both {
            None if settled => Movement::rest(self.arms.action_len(), self.steps(DURATIONS[0])),
            None => self.random(),
            Some(best) if chance < AGAIN => {
                again = Some(best);
                self.memory.movement(best).clone()
            }
            Some(best) if chance < AGAIN + VARIED => self.varied(best),
            Some(best) => self.combined(&choice, best),
        };
        self.running = Some(CurrentMovement {
            left: movement.steps,
            movement,
            again,
            posture,
            felt: Vec::new(),
        });
    }

    fn best(&self, posture: &[f32], settled: bool) -> BestMovements {
        let worth = self.shares.iter().zip(&self.touched).map(|(share, touched)| match () {
            () if *touched => 0.0,
            () if settled => 1.0,
            // a touch that no episode has had counts 25 times as much as one that all have
            () => pxfm::f_pow(share + 0.01, -0.7),
        });
        // once for all experiences; a million steps leave tens of thousands
        let worth: Vec<f64> = worth.collect();
        self.memory
            .best(posture, |pair| (self.arms.hand_of(pair), worth[pair as usize]))
    }

    fn random(&mut self) -> Movement {
        let seconds = DURATIONS[self.rng.below(DURATIONS.len())];
        let mut action = Vec::new();
        self.arms.space().sample(&mut self.rng, &mut action);
        Movement {
            action,
            steps: self.steps(seconds),
        }
    }

    fn varied(&mut self, index: usize) -> Movement {
        let Movement { mut action, mut steps } = self.memory.movement(index).clone();
        let deviation = VARIATIONS[self.rng.below(VARIATIONS.len())];
        for (d, value) in action.iter_mut().enumerate() {
            *value = self.arms.clamp(
                d,
                f64::from(*value) + deviation * self.arms.half_range(d) * self.rng.normal(),
            );
        }
        if self.rng.uniform() < RETIMED {
            let time = f64::from(steps) * self.dt * pxfm::f_exp(RETIMING * self.rng.normal());
            steps = self.steps(time.clamp(SHORTEST, LONGEST));
        }
        Movement { action, steps }
    }

    /// Combines movements: each arm's part comes from the most promising movement for its palm, the rest from the better of the two.
    fn combined(&self, choice: &BestMovements, best: usize) -> Movement {
        let mut movement = self.memory.movement(choice.lead().unwrap_or(best)).clone();
        for (hand, index) in choice.hands.iter().enumerate() {
            let Some(index) = *index else { continue };
            let part = &self.memory.movement(index).action;
            for &d in self.arms.of_hand(hand) {
                movement.action[d] = part[d];
            }
        }
        movement
    }

    fn steps(&self, seconds: f64) -> u32 {
        ((seconds / self.dt).round() as u32).max(1)
    }
}

/// Returns the joint angles from proprioception, rad or m.
fn posture(env: &Env) -> Vec<f32> {
    let angles = env.senses().proprioception().range(ProprioceptionComponent::Angles);
    let all = env.observation().proprioception;
    let angles = angles.and_then(|range| all.get(range)).unwrap_or_default();
    angles.iter().map(|&angle| angle as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Behavior, Config};

    fn crib(seed: u64) -> Env {
        let text = include_str!("../../configs/config_selftouch.yml");
        let config = Config::from_yaml(text, "config_selftouch.yml").unwrap();
        Env::new(Config { seed, ..config }).unwrap()
    }

    fn run(env: &mut Env, policy: &mut BabblingPolicy, steps: usize, mut each: impl FnMut(&[f32])) {
        let mut action = Vec::new();
        env.reset(None).unwrap();
        policy.begin(env, 0).unwrap();
        for _ in 0..steps {
            policy.act(env, &mut action).unwrap();
            each(&action);
            env.step(&action).unwrap();
        }
    }

    #[test]
    fn it_remembers_what_its_palms_felt_and_settles_to_repeat_it() {
        let (mut env, mut policy) = (crib(0), BabblingPolicy::new());
        for _ in 0..5 {
            run(&mut env, &mut policy, 1000, |action| {
                assert!(action.iter().all(|v| v.abs() <= 1.0))
            });
        }
        let learned = policy.movements();
        assert!(learned > 20, "{learned}");
        policy.settle();
        let mut known = true;
        let memory = policy.learner.as_ref().unwrap().memory.clone();
        run(&mut env, &mut policy, 300, |action| {
            known &= (0..memory.len()).any(|k| memory.movement(k).action == action);
        });
        assert!(known, "a settled policy does nothing new");
        assert_eq!(policy.movements(), learned);
    }

    #[test]
    fn the_same_seed_gives_the_same_actions() {
        let actions = || {
            let (mut env, mut policy, mut all) = (crib(3), BabblingPolicy::new(), Vec::new());
            for _ in 0..2 {
                run(&mut env, &mut policy, 400, |action| {
                    all.extend(action.iter().map(|v| v.to_bits()))
                });
            }
            all
        };
        assert_eq!(actions(), actions());
    }

    #[test]
    fn without_a_skin_it_says_what_to_do() {
        let config = Config {
            touch_active: false,
            vision_active: false,
            behavior: Behavior::SelfTouch,
            ..Config::default()
        };
        let error = BabblingPolicy::new()
            .begin(&mut Env::new(config).unwrap(), 0)
            .unwrap_err();
        assert!(error.to_string().contains("touch_active: true"), "{error}");
    }
}
