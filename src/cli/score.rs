//! `babybench score`

use std::error::Error;
use std::path::PathBuf;

use babybench::Config;
use babybench::config::Behavior;
use babybench::eval::{ScoreParts, Touchables, eval_logs, read_scene};
use babybench::mimo::{build_model, embedded};
use clap::Args;

use super::print::{note, say};

/// Arguments of `score`.
#[derive(Args)]
pub struct ScoreArgs {
    /// Folder of a training run: its save_dir, with logs/training.pkl.
    #[arg(value_name = "SAVE_DIR")]
    save_dir: PathBuf,
    /// Print one line of JSON.
    #[arg(long)]
    json: bool,
}

impl ScoreArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        if self.save_dir.is_file() {
            let file = self.save_dir.display();
            return Err(format!(
                "{file}: this is a file; give the folder of a run, its save_dir, with logs/training.pkl"
            )
            .into());
        }
        let score = eval_logs(&self.save_dir)?;
        let skin = match score.parts {
            // names of parts are those of the run's scene; folders of the Python kit hold one that need not load here
            ScoreParts::SelfTouch(_) => match read_scene(&self.save_dir) {
                Ok(model) => Touchables::new(&model),
                Err(e) => {
                    if self.save_dir.join("scene.xml").exists() {
                        note!(
                            "note: names are those of MIMo v1 in this program, as the run's scene does not load: {e}"
                        );
                    }
                    let behavior = Behavior::SelfTouch;
                    let config = Config {
                        behavior,
                        ..Config::default()
                    };
                    Touchables::new(&build_model(&config, &embedded())?)
                }
            },
            ScoreParts::HandRegard(_) => None,
        };
        match self.json {
            true => say!("{}", score.to_json(skin.as_ref()))?,
            false => say!("{}", score.to_text(skin.as_ref()).trim_end())?,
        }
        Ok(())
    }
}
