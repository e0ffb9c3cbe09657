//! `babybench doctor`

mod machine;
mod self_check;

use std::error::Error;

use clap::Args;

use crate::print::say;

/// Arguments of `doctor`.
#[derive(Args)]
pub struct Doctor {
    /// Describe the machine and the program only, without the self-check
    #[arg(long)]
    no_check: bool,
}

impl Doctor {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        for (what, value) in machine::facts() {
            say!("{what:<16} {value}")?;
        }
        if self.no_check {
            return Ok(());
        }
        let outcome = self_check::run()?;
        for difference in &outcome.differences {
            say!("{:<16} {difference}", "self-check")?;
        }
        if !outcome.differences.is_empty() {
            return Err(
                "this machine computes other numbers than the tested ones; please report it, with this output".into(),
            );
        }
        say!("{:<16} {outcome}", "self-check")?;
        Ok(())
    }
}
