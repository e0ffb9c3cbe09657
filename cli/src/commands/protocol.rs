//! `babybench protocol`

use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Duration;

use babybench::config::{SpringModel, StrengthModel};
use babybench::eval::protocol::{Protocol, ProtocolError, ProtocolPlan};
use babybench::policy::DEFAULT_LIMIT;
use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand};

use super::progress_bar;
use crate::arguments::{age, count};
use crate::interrupt::{Interrupt, Interrupted};
use crate::print::say;

/// Arguments of `protocol`.
#[derive(Args)]
pub struct ProtocolArgs {
    #[command(subcommand)]
    command: ProtocolCommand,
}

#[derive(Subcommand)]
enum ProtocolCommand {
    /// List the protocols
    List,
    /// Describe a protocol: scene, phases, measures, published numbers with their sources
    Show {
        /// Name of a protocol (see list), or a document of your own that ends in .yml
        #[arg(value_name = "NAME")]
        name: String,
    },
    /// Run a protocol and write tables, a figure and a manifest, with published numbers beside
    Run(RunArgs),
}

/// Arguments of `protocol run`.
#[derive(Args)]
struct RunArgs {
    /// Name of a protocol (see list), or a document of your own that ends in .yml
    #[arg(value_name = "NAME")]
    name: String,
    /// Policy, as evaluate takes it: held, color:0.69, color_by_age, random, zero, FILE.onnx, a command; may be given several times
    #[arg(long, value_name = "POLICY", default_value = "held")]
    policy: Vec<String>,
    /// Ages in months, such as 1,3,6; those of the protocol by default
    #[arg(long, value_name = "MONTHS", value_delimiter = ',', num_args = 1, value_parser = age)]
    ages: Option<Vec<f64>>,
    /// Number of seeds: 0, 1, ...
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count::<u64>)]
    seeds: u64,
    /// Share of the protocol's length, above 0 and at most 1: of its trials if it has several, otherwise of its phases
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, allow_negative_numbers = true)]
    length: f64,
    /// What the strength of motors and muscles follows; the protocols of the library have infant
    #[arg(long, value_parser = PossibleValuesParser::new(StrengthModel::NAMES))]
    strength: Option<String>,
    /// What springs and dampers of joints follow; the protocols of the library have weight
    #[arg(long, value_parser = PossibleValuesParser::new(SpringModel::NAMES))]
    springs: Option<String>,
    /// Another value of a key of the configuration; may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = key)]
    set: Vec<String>,
    /// Folder for protocol.md, protocol.json, figure.svg, manifest.json and runs; results/protocol/NAME by default. Existing runs are not
    /// run again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of runs at a time; one for each core by default. Results do not depend on it
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    jobs: Option<usize>,
    /// Keep the records of all runs, for measure, replay and export. Those of 15 minutes take about 100 MB each
    #[arg(long)]
    keep_records: bool,
    /// Time limit of a command for an action, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_LIMIT.as_secs(), allow_negative_numbers = true, value_parser = count::<u64>)]
    policy_timeout: u64,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

/// Parses a key with its value and returns it as YAML.
fn key(text: &str) -> Result<String, String> {
    let parts = text.split_once('=').filter(|(key, _)| !key.trim().is_empty());
    let (key, value) = parts.ok_or("expected KEY=VALUE, such as strength_neck=0.5")?;
    Ok(format!("{}: {}\n", key.trim(), value.trim()))
}

impl ProtocolArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        match &self.command {
            ProtocolCommand::List => {
                for name in Protocol::names() {
                    let protocol = Protocol::named(name)?;
                    say!("{name:14} {}", protocol.title)?;
                }
                Ok(())
            }
            ProtocolCommand::Show { name } => {
                say!("{}", Protocol::named(name)?.to_text().trim_end())?;
                Ok(())
            }
            ProtocolCommand::Run(arguments) => arguments.run(),
        }
    }
}

impl RunArgs {
    fn plan(&self) -> ProtocolPlan {
        let mut keys = self.set.concat();
        for (key, value) in [("strength", &self.strength), ("springs", &self.springs)] {
            if let Some(value) = value {
                keys.push_str(&format!("{key}: {value}\n"));
            }
        }
        ProtocolPlan {
            policies: self.policy.clone(),
            ages: self.ages.clone(),
            seeds: self.seeds,
            length: self.length,
            keys,
            keep_records: self.keep_records,
            limit: Duration::from_secs(self.policy_timeout),
        }
    }

    fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let (protocol, plan) = (Protocol::named(&self.name)?, self.plan());
        plan.check()?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let bar = progress_bar(plan.total_steps(&protocol)?, self.quiet)?;
        let progress = || {
            bar.inc(1);
            if interrupt.wanted() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let own = PathBuf::from("results/protocol").join(&protocol.name);
        let out = self.out.clone().unwrap_or(own);
        let result = protocol.run(&plan, &out, self.jobs.unwrap_or(cores), &progress);
        bar.finish_and_clear();
        let result = match result {
            Err(e @ ProtocolError::Stopped { .. }) => return Err(Interrupted(e.to_string()).into()),
            result => result?,
        };
        result.write(&out)?;
        say!("{}", result.to_markdown().trim_end())?;
        say!(
            "\n{dir}: protocol.md, protocol.json, figure.svg, manifest.json",
            dir = out.display()
        )?;
        Ok(())
    }
}
