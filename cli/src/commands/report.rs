//! `babybench report`

use std::error::Error;
use std::path::PathBuf;

use crate::report::Report;
use clap::Args;

use crate::print::{note, say};

/// Arguments of `report`.
#[derive(Args)]
pub struct ReportArgs {
    /// Folder of a run: its save_dir, with logs of training or evaluation
    #[arg(value_name = "SAVE_DIR")]
    save_dir: PathBuf,
    /// Folder of another training, such as one with random actions, whose learning curve is drawn next to the run's
    #[arg(long, value_name = "SAVE_DIR")]
    baseline: Option<PathBuf>,
    /// Page to write; report.html in the folder of the run by default
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl ReportArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let report = match &self.baseline {
            Some(baseline) => Report::with_baseline(&self.save_dir, baseline)?,
            None => Report::new(&self.save_dir)?,
        };
        let out = self.out.clone().unwrap_or_else(|| self.save_dir.join("report.html"));
        report.write(&out)?;
        for notice in &report.notices {
            note!("note: {notice}");
        }
        let size = report.html.len().div_ceil(1000);
        say!(
            "{}: {size} kB; open it in a browser, it needs no other file",
            out.display()
        )?;
        Ok(())
    }
}
