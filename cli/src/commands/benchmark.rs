//! `babybench benchmark`

use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Duration;

use crate::report::benchmark_page;
use babybench::eval::{Benchmark, BenchmarkError, BenchmarkPlan};
use babybench::policy::DEFAULT_LIMIT;
use clap::Args;

use super::progress_bar;
use crate::arguments::count;
use crate::interrupt::{Interrupt, Interrupted};
use crate::print::say;

/// Arguments of `benchmark`.
#[derive(Args)]
pub struct BenchmarkArgs {
    /// The plan: a YAML file with configs, policies, and perhaps ages, seeds, steps; see docs/benchmark.yml
    #[arg(value_name = "FILE")]
    plan: PathBuf,
    /// Folder for benchmark.md, .html and .json, runs and records. Existing results are not run again
    #[arg(long, value_name = "DIR", default_value = "results/benchmark")]
    out: PathBuf,
    /// Number of runs at a time; one for each core by default. Results do not depend on it
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    jobs: Option<usize>,
    /// Time limit of a command for an action, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_LIMIT.as_secs(), allow_negative_numbers = true, value_parser = count::<u64>)]
    policy_timeout: u64,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

impl BenchmarkArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let plan = BenchmarkPlan::from_file(&self.plan)?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let bar = progress_bar(plan.total_steps(), self.quiet)?;
        let progress = || {
            bar.inc(1);
            if interrupt.wanted() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let (jobs, limit) = (self.jobs.unwrap_or(cores), Duration::from_secs(self.policy_timeout));
        let result = Benchmark::run(&plan, &self.out, jobs, limit, &progress);
        bar.finish_and_clear();
        let benchmark = match result {
            Err(e @ BenchmarkError::Stopped { .. }) => return Err(Interrupted(e.to_string()).into()),
            result => result?,
        };
        benchmark.write(&self.out)?;
        let page = self.out.join("benchmark.html");
        std::fs::write(&page, benchmark_page(&benchmark)).map_err(|e| format!("{}: {e}", page.display()))?;
        say!("{}", benchmark.to_markdown().trim_end())?;
        say!(
            "\n{dir}: benchmark.md, benchmark.html, benchmark.json",
            dir = self.out.display()
        )?;
        Ok(())
    }
}
