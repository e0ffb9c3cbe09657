//! Learns to reach with the cross-entropy method: the torques of the arm are a linear function of its position and velocity and of the
//! ball's position, and the functions that bring the fingers closest to the ball are kept. Takes a minute or two on two cores.
//!
//! ```sh
//! cargo run --release --features parallel --example reach
//! ```

use babybench::config::Behavior;
use babybench::spaces::NumpyRng;
use babybench::vector::VectorError;
use babybench::{AutoresetMode, Blueprint, Config, VectorEnv, VectorOptions};

/// Steps of an episode, of 10 ms each.
const STEPS: usize = 200;
/// Number of generations.
const GENERATIONS: usize = 30;
/// Number of policies tried in each generation.
const POPULATION: usize = 48;
/// Number of the best of them, from which the next generation is drawn.
const ELITE: usize = 8;
/// Episodes in which a policy of a generation is tried, the same for all.
const TRIALS: usize = 3;
/// Number of episodes in the comparison with random actions; each runs in all environments.
const ROUNDS: u64 = 4;
/// Inputs of a torque: a constant, the way from the fingers to the ball, angles and velocities of the arm.
const INPUTS: usize = 1 + 3 + JOINTS + JOINTS;
/// Joints of the arm, which are also the actuators.
const JOINTS: usize = 8;

/// The outcome of an episode.
#[derive(Clone, Copy, Default)]
struct Outcome {
    /// Step of the first success, if there was one.
    success: Option<usize>,
    /// Least distance of the fingers from the ball, m.
    nearest: f64,
}

impl Outcome {
    /// Early successes are best, then small distances.
    fn fitness(self) -> f64 {
        match self.success {
            Some(step) => 1.0 + (STEPS - step) as f64 / STEPS as f64,
            None => -self.nearest,
        }
    }
}

/// The environments and where the arm is in their observations.
struct Arena {
    envs: VectorEnv,
    angles: [usize; JOINTS],
    velocities: [usize; JOINTS],
}

impl Arena {
    fn new() -> Result<Self, Box<dyn std::error::Error>> {
        let blueprint = Blueprint::new(Config::of(Behavior::Reach))?;
        let env = blueprint.env()?;
        let model = env.model();
        let place = |component| -> Result<[usize; JOINTS], &str> {
            let of = |&joint: &usize| {
                let name = &model.jnt_name[joint];
                env.senses()
                    .proprioception()
                    .find(model, component, name)
                    .map(|range| range.start)
            };
            let found: Vec<usize> = model.actuator_trnid.iter().filter_map(of).collect();
            found.try_into().map_err(|_| "the arm has eight joints")
        };
        let options = VectorOptions {
            autoreset: AutoresetMode::Disabled,
            ..VectorOptions::default()
        };
        use babybench::sensors::ProprioceptionComponent::{Angles, Velocities};
        Ok(Self {
            angles: place(Angles)?,
            velocities: place(Velocities)?,
            envs: VectorEnv::new(&blueprint, POPULATION, options)?,
        })
    }

    /// Runs an episode in each environment, with a policy for each or with random actions.
    fn episodes(&mut self, policies: Option<&[Vec<f64>]>, seeds: &[u64]) -> Result<Vec<Outcome>, VectorError> {
        let nearest = f64::INFINITY;
        let mut outcomes = vec![Outcome { nearest, success: None }; POPULATION];
        let mut actions = Vec::new();
        let seeds: Vec<Option<u64>> = seeds.iter().map(|seed| Some(*seed)).collect();
        self.envs.reset(&seeds[..])?;
        for step in 0..STEPS {
            match policies {
                Some(policies) => self.decide(policies, &mut actions),
                None => self.envs.sample_actions(&mut actions)?,
            }
            let batch = self.envs.step(&actions)?;
            for (row, outcome) in outcomes.iter_mut().enumerate() {
                let goals = batch.row(row).and_then(|o| o.achieved_goal.zip(o.desired_goal));
                let (fingers, ball) = goals.unwrap_or_default();
                let square: f64 = fingers.iter().zip(ball).map(|(a, b)| (a - b).powi(2)).sum();
                outcome.nearest = outcome.nearest.min(square.sqrt());
                if batch.terminated[row] {
                    outcome.success.get_or_insert(step);
                }
            }
        }
        Ok(outcomes)
    }

    /// Computes the actions of the policies.
    fn decide(&self, policies: &[Vec<f64>], actions: &mut Vec<f32>) {
        let batch = self.envs.batch();
        actions.clear();
        for (row, weights) in policies.iter().enumerate() {
            let Some(o) = batch.row(row) else { continue };
            let (fingers, ball) = o.achieved_goal.zip(o.desired_goal).unwrap_or_default();
            let way = ball.iter().zip(fingers).map(|(b, f)| 5.0 * (b - f));
            let angles = self.angles.iter().map(|&k| o.proprioception[k]);
            let velocities = self.velocities.iter().map(|&k| 0.1 * o.proprioception[k]);
            let inputs: Vec<f64> = std::iter::once(1.0)
                .chain(way)
                .chain(angles)
                .chain(velocities)
                .collect();
            actions.extend(weights.chunks_exact(INPUTS).map(|w| {
                let sum: f64 = w.iter().zip(&inputs).map(|(w, x)| w * x).sum();
                (0.3 * sum) as f32
            }));
        }
    }

    /// Prints how often he reaches the ball in separate episodes.
    fn compare(&mut self, what: &str, policy: Option<&[f64]>) -> Result<(), VectorError> {
        let policies = policy.map(|policy| vec![policy.to_vec(); POPULATION]);
        let (mut reached, mut steps) = (0, 0);
        for round in 0..ROUNDS {
            let seeds: Vec<u64> = (0..POPULATION as u64).map(|k| 1_000_000 + round * 1000 + k).collect();
            for outcome in self.episodes(policies.as_deref(), &seeds)? {
                reached += outcome.success.map_or(0, |_| 1);
                steps += outcome.success.unwrap_or(STEPS);
            }
        }
        let episodes = ROUNDS as usize * POPULATION;
        let seconds = 0.01 * steps as f64 / episodes as f64;
        println!("{what}: the ball is reached in {reached} of {episodes} episodes, after {seconds:.2} s on average");
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arena = Arena::new()?;
    arena.compare("random actions", None)?;
    let mut rng = NumpyRng::seed(0);
    let mut normal = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0; // nearly
    let (mut mean, mut deviation) = (vec![0.0; JOINTS * INPUTS], vec![1.0; JOINTS * INPUTS]);
    for generation in 0..GENERATIONS {
        let draw = |_| {
            mean.iter()
                .zip(&deviation)
                .map(|(m, d): (&f64, &f64)| m + d * normal())
                .collect()
        };
        let policies: Vec<Vec<f64>> = (0..POPULATION).map(draw).collect();
        let (mut fitness, mut reached) = (vec![0.0_f64; POPULATION], 0);
        for trial in 0..TRIALS {
            let seed = (generation * TRIALS + trial) as u64;
            for (sum, outcome) in fitness
                .iter_mut()
                .zip(arena.episodes(Some(&policies), &[seed; POPULATION])?)
            {
                *sum += outcome.fitness();
                reached += outcome.success.map_or(0, |_| 1);
            }
        }
        let mut order: Vec<usize> = (0..POPULATION).collect();
        order.sort_by(|a, b| fitness[*b].total_cmp(&fitness[*a]));
        let best = || order[..ELITE].iter().map(|&k| &policies[k]);
        for (i, (mean, deviation)) in mean.iter_mut().zip(&mut deviation).enumerate() {
            let m = best().map(|p| p[i]).sum::<f64>() / ELITE as f64;
            let variance = best().map(|p| (p[i] - m).powi(2)).sum::<f64>() / ELITE as f64;
            *mean += 0.7 * (m - *mean);
            *deviation = (0.4 * *deviation + 0.6 * variance.sqrt()).max(0.05);
        }
        println!(
            "generation {generation:2}: {reached} of {} episodes reach the ball",
            POPULATION * TRIALS
        );
    }
    arena.compare("learned policy", Some(&mean))?;
    Ok(())
}
