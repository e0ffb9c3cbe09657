//! `babybench score`

use std::error::Error;
use std::path::PathBuf;

use babybench::Config;
use babybench::config::Behavior;
use babybench::eval::{Score, ScoreParts, TouchableGeoms, eval_logs};
use babybench::mimo::{build_model, embedded};
use babybench::runs::{read_scene, read_training, scene_compat};
use clap::Args;

use crate::arguments::count;
use crate::print::{note, say};

/// Arguments of `score`.
#[derive(Args)]
pub struct ScoreArgs {
    /// Folder of a training run: its save_dir, with logs/training.pkl
    #[arg(value_name = "SAVE_DIR")]
    save_dir: PathBuf,
    /// Also print the score after each of these numbers of steps, as in 10000,100000, of the episodes that had ended by then
    #[arg(long, value_name = "STEPS", value_delimiter = ',', value_parser = count::<u64>, conflicts_with = "json")]
    at: Vec<u64>,
    /// Print the score as one line of JSON
    #[arg(long)]
    json: bool,
}

impl ScoreArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        if self.save_dir.is_file() {
            let file = self.save_dir.display();
            return Err(format!(
                "{file}: this is a file; give the folder of a run (its save_dir), which contains logs/training.pkl"
            )
            .into());
        }
        let mut score = eval_logs(&self.save_dir)?;
        let skin = match score.parts {
            // names of parts come from the run's scene, which need not load here if the folder is the Python kit's
            ScoreParts::SelfTouch { .. } => match read_scene(&self.save_dir) {
                Ok(model) => {
                    let skin = TouchableGeoms::new(&model);
                    if let Some(skin) = &skin {
                        score = within_reach(score, skin);
                    }
                    skin
                }
                Err(e) => {
                    if self.save_dir.join("scene.xml").exists() {
                        note!(
                            "note: names come from the built-in MIMo v1, because the run's scene cannot be loaded: {e}"
                        );
                    }
                    let behavior = Behavior::SelfTouch;
                    let config = Config {
                        behavior,
                        ..Config::default()
                    };
                    TouchableGeoms::new(&build_model(&config, &embedded())?)
                }
            },
            ScoreParts::HandRegard { .. } => None,
        };
        if self.json {
            say!("{}", score.to_json(skin.as_ref()))?;
        } else {
            say!("{}", score.to_text(skin.as_ref()).trim_end())?;
        }
        self.print_marks()
    }

    /// Prints the scores after numbers of steps.
    fn print_marks(&self) -> Result<(), Box<dyn Error>> {
        if self.at.is_empty() {
            return Ok(());
        }
        let compat = scene_compat(&self.save_dir);
        let records = read_training(&self.save_dir)?;
        for &steps in &self.at {
            match Score::after(&records, steps, compat) {
                Ok(score) => say!("  after {steps} steps: {:.4}, {} episodes", score.value, score.episodes)?,
                Err(e) => say!("  after {steps} steps: {e}")?,
            }
        }
        Ok(())
    }
}

/// Returns the score without geoms that no hand can reach in the scene of the run, and prints a note about them.
fn within_reach(score: Score, skin: &TouchableGeoms) -> Score {
    let parts = |score: &Score| match &score.parts {
        ScoreParts::SelfTouch { touched } => touched.each_ref().iter().map(|t| t.len()).sum(),
        ScoreParts::HandRegard { .. } => 0_usize,
    };
    let all = parts(&score);
    let reached = score.within_reach(skin);
    let beyond = all - parts(&reached);
    if beyond > 0 {
        note!("note: {beyond} touches of geoms do not count, because no hand can reach them in the run's scene");
    }
    reached
}
