//! `babybench pack`

use std::error::Error;
use std::path::PathBuf;

use babybench::eval::{PackOptions, pack};
use clap::Args;

use crate::print::{note, say};

/// Arguments of `pack`.
#[derive(Args)]
pub struct PackArgs {
    /// Folder of a run: its save_dir, with logs/training.pkl and logs/evaluation_0.pkl to evaluation_9.pkl
    #[arg(value_name = "SAVE_DIR")]
    save_dir: PathBuf,
    /// The extended abstract, a PDF document of two pages
    #[arg(long = "abstract", value_name = "PDF")]
    extended_abstract: Option<PathBuf>,
    /// Include the videos of the evaluation
    #[arg(long)]
    videos: bool,
    /// The archive
    #[arg(long, value_name = "ZIP", default_value = "submission.zip")]
    out: PathBuf,
}

impl PackArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let options = PackOptions {
            extended_abstract: self.extended_abstract.clone(),
            videos: self.videos,
        };
        let packed = pack(&self.save_dir, &options, &self.out)?;
        for notice in &packed.notices {
            note!("note: {notice}");
        }
        for file in &packed.files {
            say!("  {file}")?;
        }
        say!("{}: {} files; {}", self.out.display(), packed.files.len(), packed.score)?;
        Ok(())
    }
}
