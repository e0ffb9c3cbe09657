//! Training in many environments at once, and the random policies to compare with.

use babybench::config::Compat;
use babybench::eval::Score;
use babybench::runs::RunVector;
use babybench::{Blueprint, Info, VectorOptions};

use crate::Error;
use crate::mind::{HOLD, Mind};
use crate::ppo::{Experience, rows};

/// The policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A random action in every step, as `babybench train` does.
    Random,
    /// A random action, held as long as the curious infant holds its own.
    Held,
    /// The policy that learns.
    Curious,
}

impl Kind {
    /// All kinds, the random ones first.
    pub const ALL: [Self; 3] = [Self::Random, Self::Held, Self::Curious];

    /// Returns the name of the kind.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Held => "random_held",
            Self::Curious => "curious",
        }
    }
}

/// The amount of training.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Number of environments.
    pub envs: usize,
    /// Number of threads that step them, 0 for one on each core. Results do not depend on it.
    pub threads: usize,
    /// Number of updates; between two, every environment runs an episode.
    pub updates: usize,
    /// Seed of everything random.
    pub seed: u64,
}

/// The results of a round of episodes, one in each environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round {
    /// Mean intrinsic reward of an episode.
    pub reward: f32,
    /// Mean number of parts that the palms touched in an episode, both together.
    pub parts: f64,
}

impl Round {
    /// Returns the mean of the last fifth of the rounds.
    pub fn end(rounds: &[Self]) -> Self {
        let last = &rounds[rounds.len() * 4 / 5..];
        let n = last.len().max(1) as f32;
        Self {
            reward: last.iter().map(|round| round.reward).sum::<f32>() / n,
            parts: last.iter().map(|round| round.parts).sum::<f64>() / f64::from(n),
        }
    }
}

/// An infant and its environments.
pub struct Training {
    envs: RunVector,
    mind: Mind,
    kind: Kind,
    updates: usize,
    experience: Experience,
    /// For each environment the touches of this episode.
    touched: Vec<Vec<bool>>,
}

impl Training {
    /// Makes environments that log into the configuration's `save_dir`, and a mind.
    ///
    /// # Errors
    /// As [`RunVector::start`]; errors of candle.
    pub fn new(blueprint: &Blueprint, kind: Kind, settings: Settings) -> Result<Self, Error> {
        let options = VectorOptions {
            threads: settings.threads,
            ..VectorOptions::default()
        };
        let mut envs = RunVector::start(blueprint, settings.envs, options, false)?;
        envs.vector_mut().seed_action_spaces(1000 * settings.seed)?;
        let mind = Mind::new(envs.env(0)?, settings.seed)?;
        Ok(Self {
            touched: vec![vec![false; mind.touch.len()]; settings.envs],
            experience: Experience::default(),
            updates: settings.updates,
            envs,
            mind,
            kind,
        })
    }

    /// Trains, and calls `say` after every round.
    ///
    /// # Errors
    /// As [`RunVector::step`]; a log that cannot be written; errors of candle.
    pub fn run(&mut self, mut say: impl FnMut(usize, Round)) -> Result<Vec<Round>, Error> {
        let mut rounds = Vec::new();
        for update in 0..self.updates {
            let round = self.round()?;
            say(update, round);
            rounds.push(round);
            if self.kind == Kind::Curious {
                self.learn()?;
            }
            self.mind.novelty.learn(&self.touched);
        }
        self.envs.finish_training()?;
        Ok(rounds)
    }

    /// Returns the score of the whole training, as `babybench score` computes it.
    ///
    /// # Errors
    /// A log without episodes.
    pub fn score(&self) -> Result<f64, Error> {
        Ok(Score::new(self.envs.log().records(), Compat::Api)?.value)
    }

    /// Returns the number of episodes so far.
    pub fn episodes(&self) -> &[Info] {
        self.envs.log().records()
    }

    /// Returns what has been learned.
    pub fn into_mind(self) -> Mind {
        self.mind
    }

    /// Runs an episode in each environment.
    fn round(&mut self) -> Result<Round, Error> {
        let n = self.envs.len();
        self.envs.start_episodes()?;
        self.experience.clear();
        self.touched.iter_mut().for_each(|touched| touched.fill(false));
        let steps = self.envs.env(0)?.config().max_episode_steps;
        let mut actions = Vec::new();
        for step in 0..steps {
            if step % HOLD == 0 {
                self.decide(&mut actions)?;
            } else if self.kind == Kind::Random {
                self.envs.vector_mut().sample_actions(&mut actions)?;
            }
            if let Some(failure) = self.envs.step(&actions)?.failures.first() {
                return Err(format!("environment {}: {}", failure.env, failure.error).into());
            }
            self.feel(step % HOLD == HOLD - 1 || step + 1 == steps)?;
        }
        self.wonder()?;
        let mut parts = 0;
        for env in 0..n {
            let touches = self.envs.env(env)?.info().behavior.touches();
            parts += touches.map_or(0, |[right, left]| right.len() + left.len());
        }
        Ok(Round {
            reward: self.experience.rewards.iter().sum::<f32>() / n as f32,
            parts: parts as f64 / n as f64,
        })
    }

    /// Decides the next actions of all environments.
    fn decide(&mut self, actions: &mut Vec<f32>) -> Result<(), Error> {
        let (n, len) = (self.envs.len(), self.mind.space.len());
        let start = self.experience.senses.len();
        for env in 0..n {
            self.mind
                .sense(self.envs.env(env)?, &self.touched[env], &mut self.experience.senses);
        }
        let decided = self.experience.actions.len();
        if self.kind == Kind::Curious {
            let senses = rows(&self.experience.senses[start..], n)?;
            let Mind { policy, noise, .. } = &mut self.mind;
            policy.decide(&senses, noise, &mut self.experience)?;
            let wanted = self.experience.actions[decided..].iter().enumerate();
            actions.clear();
            actions.extend(wanted.map(|(k, &v)| self.mind.space.clip(k % len, v)));
        } else {
            self.envs.vector_mut().sample_actions(actions)?;
            self.experience.actions.extend_from_slice(actions);
        }
        let decisions = self.experience.rewards.len() + n;
        self.experience.rewards.resize(decisions, 0.0);
        Ok(())
    }

    /// Rewards new touches, and keeps what is felt after the last step of a decision.
    fn feel(&mut self, last: bool) -> Result<(), Error> {
        let n = self.envs.len();
        let mind = &self.mind;
        let rewards = self.experience.rewards.iter_mut().rev().take(n).rev();
        let mut felt = vec![false; mind.touch.len()];
        for ((env, touched), reward) in self.touched.iter_mut().enumerate().zip(rewards) {
            let env = self.envs.env(env)?;
            felt.fill(false);
            mind.touch.feel(env, &mut felt);
            for (pair, felt) in felt.iter().enumerate() {
                if *felt && !touched[pair] {
                    touched[pair] = true;
                    *reward += mind.novelty.worth(pair);
                }
            }
            if last {
                mind.senses.feel(env, &mut self.experience.feelings);
            }
        }
        Ok(())
    }

    /// Adds surprise to the rewards.
    fn wonder(&mut self) -> Result<(), Error> {
        let Experience {
            senses,
            actions,
            rewards,
            feelings,
            ..
        } = &mut self.experience;
        let n = rewards.len();
        let inputs = candle_core::Tensor::cat(&[rows(senses, n)?, rows(actions, n)?], 1)?;
        let surprise = self.mind.foresight.surprise(&inputs, feelings)?;
        rewards.iter_mut().zip(surprise).for_each(|(reward, s)| *reward += s);
        Ok(())
    }

    fn learn(&mut self) -> Result<(), Error> {
        let envs = self.envs.len();
        let Mind {
            policy,
            foresight,
            noise,
            ..
        } = &mut self.mind;
        policy.learn(&self.experience, envs, noise, |batch| {
            let inputs = candle_core::Tensor::cat(&[&batch.senses, &batch.actions], 1)?;
            let feelings = batch.feelings.flatten_all()?.to_vec1::<f32>()?;
            foresight.learn(&inputs, &feelings)
        })
    }
}
