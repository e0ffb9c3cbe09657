//! A policy that learns to look at its hands, using its eyes and its joints.
//!
//! A hand is what moves in sight when that hand is moved, and does not when the other one is (J. S. Watson, "The development and
//! generalization of contingency awareness in early infancy", 1966; P. Fitzpatrick and G. Metta, "Grounding vision through
//! experimental manipulation", 2003). The infant takes a posture, moves the right wrist, then the left one, and finds where the
//! pictures changed with each. Postures that bring such a place to the middle of both eyes are varied; in the end the best one is taken
//! and held, with small movements.

mod archive;
mod limbs;
mod sight;

use archive::{Trial, TrialArchive};
use limbs::{DrivenJoints, HANDS};
use sight::ImageChanges;

use super::{Policy, PolicyError};
use crate::env::Env;
use crate::spaces::NumpyRng;

/// Time to take a posture, s.
const SETTLING: f64 = 0.5;
/// Time for moving each wrist, s.
const MOVING: f64 = 0.25;
/// All trials use random postures until a hand has been seen; afterwards, one in this many does.
const RANDOM: f64 = 0.1;

/// A policy that learns to look at its hands while it acts, using only its eyes and its joints; `watching` on the command line.
///
/// ```
/// use babybench::policy::{Policy, WatchingPolicy};
/// use babybench::{Config, Env};
///
/// let mut env = Env::new(Config { behavior: babybench::config::Behavior::HandRegard, ..Config::default() })?;
/// let (mut policy, mut action) = (WatchingPolicy::new(), Vec::new());
/// env.reset(Some(0))?;
/// policy.begin(&mut env, 0)?;
/// for _ in 0..10 {
///     policy.act(&mut env, &mut action)?;
///     env.step(&action)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct WatchingPolicy {
    learner: Option<WatchingLearner>,
    settled: bool,
}

impl WatchingPolicy {
    /// Makes an untrained policy.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the visibility of both hands in the best posture so far, 0 to 1.
    pub fn best(&self) -> f64 {
        let trial = self.learner.as_ref().and_then(|learner| learner.archive.best());
        trial.map_or(0.0, |trial| 0.5 * trial.seen.iter().sum::<f64>())
    }
}

/// The policy's knowledge of one body, and its current activity.
#[derive(Clone, Debug)]
struct WatchingLearner {
    limbs: DrivenJoints,
    sight: ImageChanges,
    archive: TrialArchive,
    rng: NumpyRng,
    /// The posture that is tried: an angle for each number of an action, rad.
    posture: Vec<f64>,
    /// Steps of the trial so far.
    step: u64,
    /// Steps of its parts: taking the posture, moving a wrist.
    lengths: [u64; 2],
    dt: f64,
}

impl Policy for WatchingPolicy {
    fn begin(&mut self, env: &mut Env, _episode: u64) -> Result<(), PolicyError> {
        match &mut self.learner {
            Some(learner) if learner.limbs.fits(env) => learner.start(self.settled),
            Some(_) => return Err(PolicyError::Other("this policy has learned with another body".into())),
            learner => {
                let mut new = WatchingLearner::new(env)?;
                new.start(self.settled);
                *learner = Some(new);
            }
        }
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if self.learner.is_none() {
            self.begin(env, 0)?;
        }
        if let Some(learner) = &mut self.learner {
            learner.act(env, self.settled, action);
        }
        Ok(())
    }

    fn settle(&mut self) {
        self.settled = true;
    }
}

impl WatchingLearner {
    fn new(env: &mut Env) -> Result<Self, PolicyError> {
        let (limbs, dt) = (DrivenJoints::new(env)?, env.blueprint().dt());
        let steps = |seconds: f64| ((seconds / dt).round() as u64).max(2);
        Ok(Self {
            sight: ImageChanges::new(env)?,
            archive: TrialArchive::default(),
            rng: NumpyRng::seed(env.draw_seed()),
            posture: Vec::new(),
            step: 0,
            lengths: [steps(SETTLING), steps(MOVING)],
            dt,
            limbs,
        })
    }

    /// Starts a trial.
    fn start(&mut self, settled: bool) {
        self.step = 0;
        self.sight.forget();
        let Self {
            archive, rng, limbs, ..
        } = self;
        self.posture = match archive.best() {
            Some(best) if settled => best.posture.clone(),
            _ => archive.propose(limbs, rng, RANDOM),
        };
    }

    fn act(&mut self, env: &Env, settled: bool, action: &mut Vec<f32>) {
        let [settling, moving] = self.lengths;
        // the hand whose movement the present picture shows
        let shown = self.step.checked_sub(settling + 1).map(|n| (n / moving) as usize);
        if let Some(hand) = shown.filter(|hand| *hand < HANDS && !settled) {
            self.sight.see(env, hand, self.limbs.gaze(env));
        } else if !settled && self.step == settling {
            self.sight.look(env);
        }
        if self.step > settling + HANDS as u64 * moving {
            if settled {
                self.step = settling;
            } else {
                let seen = self.sight.found();
                let posture = std::mem::take(&mut self.posture);
                self.archive.add(Trial::new(posture, seen));
                self.start(settled);
            }
        }
        let hand = self.step.checked_sub(settling).map(|n| (n / moving) as usize);
        let time = self.dt * (self.step % moving) as f64;
        self.limbs.drive(env, &self.posture, hand, time, action);
        self.step += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Behavior, Config};

    fn cubes() -> Env {
        let text = include_str!("../../configs/config_handregard.yml");
        let config = Config::from_yaml(text, "config_handregard.yml").unwrap();
        let (vision_rate, vision_resolution) = (Some(30.0), 32);
        Env::new(Config {
            vision_rate,
            vision_resolution,
            ..config
        })
        .unwrap()
    }

    fn run(env: &mut Env, policy: &mut WatchingPolicy, steps: usize) -> Vec<f32> {
        let (mut action, mut all) = (Vec::new(), Vec::new());
        env.reset(None).unwrap();
        policy.begin(env, 0).unwrap();
        for _ in 0..steps {
            policy.act(env, &mut action).unwrap();
            all.extend_from_slice(&action);
            env.step(&action).unwrap();
        }
        all
    }

    #[test]
    fn the_same_seed_gives_the_same_actions_within_bounds() {
        let actions = || run(&mut cubes(), &mut WatchingPolicy::new(), 450);
        let all = actions();
        assert!(all.iter().all(|v| v.abs() <= 1.0) && all.iter().any(|v| *v != 0.0));
        assert_eq!(all, actions());
    }

    #[test]
    fn what_it_has_learned_it_takes_and_holds() {
        let (mut env, mut policy) = (cubes(), WatchingPolicy::new());
        run(&mut env, &mut policy, 10);
        let learner = policy.learner.as_mut().unwrap();
        let wanted: Vec<f64> = learner.limbs.random(&mut learner.rng);
        learner.archive.add(Trial::new(wanted.clone(), [0.5, 0.5]));
        policy.settle();
        run(&mut env, &mut policy, 400);
        let learner = policy.learner.as_ref().unwrap();
        assert_eq!((&learner.posture, policy.best()), (&wanted, 0.5));
    }

    #[test]
    fn without_eyes_it_says_what_to_do() {
        let config = Config {
            behavior: Behavior::HandRegard,
            vision_active: false,
            ..Config::default()
        };
        let error = WatchingPolicy::new()
            .begin(&mut Env::new(config).unwrap(), 0)
            .unwrap_err();
        assert!(error.to_string().contains("vision_active: true"), "{error}");
    }
}
