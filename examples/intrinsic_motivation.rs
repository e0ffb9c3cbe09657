//! Wraps the environment to add an intrinsic reward: how badly the next observation was predicted.
//!
//! ```sh
//! cargo run --release --example intrinsic_motivation
//! ```

use babybench::{Config, Env, EnvError};

/// A forward model that predicts each value of the observation from its last two, with one learned weight per value,
/// and rewards surprise.
struct Curious {
    env: Env,
    weights: Vec<f64>,
    last: [Vec<f64>; 2],
}

impl Curious {
    fn new(env: Env) -> Self {
        let (weights, last) = (Vec::new(), [Vec::new(), Vec::new()]);
        Self { env, weights, last }
    }

    fn reset(&mut self) -> Result<(), EnvError> {
        let now = self.env.reset(None)?.proprioception.to_vec();
        self.weights.resize(now.len(), 0.0);
        self.last = [now.clone(), now];
        Ok(())
    }

    /// Steps the environment, and returns the reward and whether the episode is over.
    fn step(&mut self, action: &[f32]) -> Result<(f64, bool), EnvError> {
        let step = self.env.step(action)?;
        let (now, truncated) = (step.observation.proprioception, step.truncated);
        let [before, last] = &mut self.last;
        let mut surprise = 0.0;
        for i in 0..now.len() {
            let trend = last[i] - before[i];
            let error = now[i] - last[i] - self.weights[i] * trend;
            surprise += error.abs().min(1.0);
            self.weights[i] += 0.1 * error * trend / (1e-6 + trend * trend);
        }
        std::mem::swap(before, last);
        last.copy_from_slice(now);
        Ok((surprise / now.len() as f64, truncated))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../configs/config_selftouch.yml");
    let config = Config::from_yaml(text, "config_selftouch.yml")?;
    let mut curious = Curious::new(Env::new(Config {
        max_episode_steps: 500,
        ..config
    })?);
    let mut action = Vec::new();
    for episode in 0..5 {
        curious.reset()?;
        let mut sum = 0.0;
        loop {
            curious.env.sample_action(&mut action); // an agent would choose its action here, and learn after the step
            let (reward, truncated) = curious.step(&action)?;
            sum += reward;
            if truncated {
                break;
            }
        }
        println!("episode {episode}: mean surprise {:.4}", sum / 500.0);
    }
    Ok(())
}
