//! Episodes of policies, side by side.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use babybench::{Blueprint, Env, EnvError};

use crate::linear::Design;
use crate::plans::Plan;

/// The result of an episode.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// The sum of rewards.
    pub reward: f64,
    /// The fitness of a candidate: the sum of rewards, and for some tasks the smallest distance.
    pub worth: f64,
    pub steps: u64,
    pub success: bool,
}

/// An episode to be run: a policy, a seed, and the number that is 1 in the desired goal, if it is not random.
pub struct Episode<'a> {
    pub weights: &'a [f64],
    pub seed: u64,
    pub goal: Option<usize>,
}

/// The environments of the threads.
pub struct Arena {
    envs: Vec<Env>,
}

impl Arena {
    /// Makes an environment for each thread.
    pub fn new(blueprint: &Blueprint, threads: usize) -> Result<Self, EnvError> {
        let envs = (0..threads.max(1)).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
        Ok(Self { envs })
    }

    /// Returns one of the environments.
    pub fn env(&mut self) -> &mut Env {
        &mut self.envs[0]
    }

    /// Runs episodes on all threads. The results do not depend on the number of threads.
    pub fn run(&mut self, plan: &Plan, episodes: &[Episode<'_>]) -> Result<Vec<Outcome>, EnvError> {
        let (next, done) = (
            AtomicUsize::new(0),
            Mutex::new(vec![Outcome::default(); episodes.len()]),
        );
        let work = |env: &mut Env| -> Result<(), EnvError> {
            while let Some((k, episode)) = take(&next, episodes) {
                let outcome = run(env, plan, episode)?;
                done.lock().unwrap_or_else(|e| e.into_inner())[k] = outcome;
            }
            Ok(())
        };
        std::thread::scope(|scope| {
            let work = &work;
            let threads: Vec<_> = self.envs.iter_mut().map(|env| scope.spawn(move || work(env))).collect();
            let mut joined = threads.into_iter().map(|t| t.join());
            joined.try_for_each(|result| result.unwrap_or_else(|e| std::panic::resume_unwind(e)))
        })?;
        Ok(done.into_inner().unwrap_or_else(|e| e.into_inner()))
    }
}

fn take<'e, 'w>(next: &AtomicUsize, episodes: &'e [Episode<'w>]) -> Option<(usize, &'e Episode<'w>)> {
    let k = next.fetch_add(1, Ordering::Relaxed);
    Some((k, episodes.get(k)?))
}

fn run(env: &mut Env, plan: &Plan, episode: &Episode<'_>) -> Result<Outcome, EnvError> {
    env.reset(Some(episode.seed))?;
    if let Some(goal) = episode.goal {
        let desired: Vec<f64> = (0..env.goal().desired.len())
            .map(|k| f64::from(u8::from(k == goal)))
            .collect();
        env.by_hand().set_goal(&desired)?;
    }
    let design: &Design = &plan.design;
    let space = env.action_space().clone();
    let (mut action, mut outcome, mut nearest) = (Vec::new(), Outcome::default(), f64::INFINITY);
    loop {
        design.act(episode.weights, &env.observation(), &space, &mut action);
        let step = env.step(&action)?;
        outcome.reward += step.reward;
        outcome.steps += 1;
        let task = step.info.behavior.task();
        outcome.success |= task.is_some_and(|task| task.outcome.is_success);
        let over = step.terminated || step.truncated;
        if let Some(distance) = plan.distance(env) {
            nearest = nearest.min(distance);
        }
        if over {
            break;
        }
    }
    let missed = if nearest.is_finite() && !outcome.success {
        nearest
    } else {
        0.0
    };
    outcome.worth = outcome.reward - plan.shaping * missed;
    Ok(outcome)
}
