//! Computes a simplified reward of the starter kit's hand-regard example: the contrast of the middle of an eye's image.
//!
//! ```sh
//! cargo run --release --example visual_saliency
//! ```

use babybench::{Config, Env};

/// Returns the mean difference between the brightness of a pixel and that of the image, near the centre.
fn saliency(image: &[u8], size: usize) -> f64 {
    let grey: Vec<f64> = image
        .chunks_exact(3)
        .map(|p| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]))
        .collect();
    let mean = grey.iter().sum::<f64>() / grey.len() as f64;
    let middle = size / 4..size - size / 4;
    let pixels = middle.clone().flat_map(|y| middle.clone().map(move |x| y * size + x));
    let sum: f64 = pixels.map(|k| (grey[k] - mean).abs()).sum();
    sum / (middle.len() * middle.len()) as f64
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../configs/config_handregard.yml");
    let config = Config::from_yaml(text, "config_handregard.yml")?;
    let size = config.vision_resolution as usize;
    let mut env = Env::new(Config {
        max_episode_steps: 100,
        ..config
    })?;
    let mut action = Vec::new();
    for episode in 0..3 {
        env.reset(None)?;
        let mut sum = 0.0;
        loop {
            env.sample_action(&mut action); // an agent would choose its action here, and learn after the step
            let step = env.step(&action)?;
            let eyes = [step.observation.eye_left, step.observation.eye_right];
            sum += eyes
                .into_iter()
                .flatten()
                .map(|image| saliency(image, size))
                .sum::<f64>()
                / 2.0;
            if step.truncated {
                break;
            }
        }
        println!(
            "episode {episode}: mean saliency {:.2}; {}",
            sum / 100.0,
            env.info().to_json()
        );
    }
    Ok(())
}
