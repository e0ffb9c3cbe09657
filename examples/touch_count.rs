//! Computes the reward of the starter kit's self-touch example: the number of touch sensors that feel a force.
//!
//! ```sh
//! cargo run --release --example touch_count
//! ```

use babybench::{Config, Env};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../configs/config_selftouch.yml");
    let config = Config::from_yaml(text, "config_selftouch.yml")?;
    let mut env = Env::new(Config {
        max_episode_steps: 500,
        ..config
    })?;
    let mut action = Vec::new();
    for episode in 0..5 {
        env.reset(None)?;
        let (mut sum, mut best) = (0, 0);
        loop {
            env.sample_action(&mut action); // an agent would choose its action here, and learn after the step
            let step = env.step(&action)?;
            let touch = step.observation.touch.unwrap_or_default();
            let reward = touch.iter().filter(|force| force.abs() > 1e-6).count();
            (sum, best) = (sum + reward, best.max(reward));
            if step.truncated {
                break;
            }
        }
        println!(
            "episode {episode}: {:.1} values per step, at most {best}; {}",
            sum as f64 / 500.0,
            env.info().to_json()
        );
    }
    Ok(())
}
