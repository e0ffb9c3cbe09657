//! Trains, scores and evaluates the random policy on both behaviors, as the starter kit's scripts do.
//!
//! ```sh
//! cargo run --release --example random_policy
//! ```

use babybench::eval::{Evaluation, TouchableGeoms};
use babybench::{Config, make_env};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (text, name) in [
        (include_str!("../configs/config_selftouch.yml"), "self_touch"),
        (include_str!("../configs/config_handregard.yml"), "hand_regard"),
    ] {
        let config = Config {
            save_dir: format!("results/random_{name}"),
            vision_active: false, // the random policy needs no images
            ..Config::from_yaml(text, name)?
        };

        // training: the environment logs each episode
        let mut action = Vec::new();
        let mut env = make_env(config.clone(), true)?;
        for _episode in 0..10 {
            env.reset(None)?;
            loop {
                env.sample_action(&mut action);
                if env.step(&action)?.truncated {
                    break;
                }
            }
        }
        env.finish_training()?;

        // evaluation: the score of the training log, then an episode on its own
        let mut env = make_env(config, false)?;
        let mut evaluation = Evaluation::new(&env);
        print!(
            "{}",
            evaluation
                .eval_logs()?
                .to_text(TouchableGeoms::new(env.model()).as_ref())
        );
        env.reset(None)?;
        for _step in 0..500 {
            env.sample_action(&mut action);
            env.step(&action)?;
            evaluation.eval_step(&env)?;
        }
        println!("evaluation episode: {}\n", evaluation.end(0)?.display());
    }
    Ok(())
}
