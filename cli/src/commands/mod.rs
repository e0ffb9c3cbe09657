//! The subcommands; each reads its arguments and calls the library.

mod benchmark;
mod body;
mod doctor;
mod evaluate;
mod inspect;
mod keys;
mod many;
mod measure;
mod pack;
mod protocol;
mod record;
mod render;
mod replay;
mod report;
mod run;
mod scene;
mod score;
mod senses;
mod simulate;
mod sources;
mod test_installation;
mod train;
mod view;

use std::error::Error;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use babybench::assets::{AssetSource, DirAssets};
use babybench::config::{Compat, Config, ConfigError, ConfigReader, Example, RendererKind};
use babybench::env::BlueprintOptions;
use babybench::formats::npz::Npz;
use babybench::mimo::embedded;
use babybench::runs::{Recording, ReplayError};
use babybench::{Blueprint, Env};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use crate::print::note;

/// BabyBench in Rust: the infant model MIMo, its scenes and senses
#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// A command with its arguments.
#[derive(Subcommand)]
pub enum Command {
    /// Run episodes with random actions and print information and timings
    Run(run::Run),
    /// Print what a configuration contains: sizes, joints, actuators, action and observation space
    Inspect(inspect::Inspect),
    /// Draw the scene, or the view of an eye
    Render(render::Render),
    /// Write a custom scene to start from, or check one
    Scene(scene::Scene),
    /// Simulate any MJCF model, with or without an infant, and write arrays or a video
    Simulate(simulate::Simulate),
    /// Show MIMo alive in a browser: turn the camera, pull him, pause, go step by step
    View(view::ViewArgs),
    /// Replay a recording (.npz) from its start with its actions
    Replay(replay::ReplayArgs),
    /// Run a benchmark: configurations, policies and seeds of a plan, on all cores, with means and intervals
    Benchmark(benchmark::BenchmarkArgs),
    /// Run an experiment with infants, and print what MIMo does beside published numbers: list, show, run
    Protocol(protocol::ProtocolArgs),
    /// Measure what the hands touched, and how MIMo moved, in a record
    Measure(measure::MeasureArgs),
    /// Record what MIMo would feel and see in a motion: joint angles over time, from a video or a motion capture
    Senses(senses::Senses),
    /// Check that everything works on this machine, and write a scene, a log and a short video
    TestInstallation(test_installation::TestInstallation),
    /// Print versions, processor, adapters, threads and optional parts, and check in seconds that results are the tested ones
    Doctor(doctor::Doctor),
    /// Train with the random policy: log episodes with random actions in the configuration's save_dir
    Train(train::Train),
    /// Print the score of a training log and its parts
    Score(score::ScoreArgs),
    /// Write a page about a run: score, learning curve, touched parts or hands in view, key frames of the video
    Report(report::ReportArgs),
    /// Check a run and pack it as a submission to the BabyBench competition
    Pack(pack::PackArgs),
    /// Run evaluation episodes of a policy, with logs and videos in the configuration's save_dir
    Evaluate(evaluate::Evaluate),
}

/// The ingredients of an environment.
#[derive(Args)]
struct Source {
    /// Configuration file (YAML), see configs/; or the name of an example: self_touch, hand_regard, test_installation, reach, ...
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// Use the MJCF and textures of this directory (babybench/*.xml, tex/*.png) instead of the embedded ones
    #[arg(long, value_name = "DIR")]
    assets: Option<PathBuf>,
    /// Follow the API page (api) or the Python code (reference) where they disagree; overrides the configuration
    #[arg(long, value_name = "WHICH", value_parser = parse_compat)]
    compat: Option<Compat>,
}

/// Reads a configuration whose missing keys have the values of `base`: a file, or the example of that name if there is no such file.
fn read_over(base: Config, path: &Path) -> Result<Config, ConfigError> {
    let reader = ConfigReader::over(base);
    let mut examples = Example::ALL.into_iter().chain(Example::TASKS);
    match examples.find(|example| path == Path::new(example.name)) {
        Some(example) if !path.exists() => reader.read_text(example.yaml, example.name),
        _ => reader.read_file(path),
    }
}

fn parse_compat(text: &str) -> Result<Compat, String> {
    Compat::from_name(text).ok_or_else(|| format!("expected one of {}", Compat::NAMES.join(", ")))
}

impl Source {
    /// Builds the environment's blueprint. `compat` is the default for configurations without the key.
    fn blueprint(&self, compat: Compat) -> Result<Blueprint, Box<dyn Error>> {
        self.blueprint_with(compat, None)
    }

    /// Builds the environment's blueprint with a renderer other than the configured one.
    fn blueprint_with(&self, compat: Compat, renderer: Option<RendererKind>) -> Result<Blueprint, Box<dyn Error>> {
        let mut config = self.read(compat)?;
        config.renderer = renderer.unwrap_or(config.renderer);
        self.build(config)
    }

    /// Reads the configuration. `compat` is the default for configurations without the key.
    fn read(&self, compat: Compat) -> Result<Config, Box<dyn Error>> {
        let base = Config {
            compat,
            ..Config::default()
        };
        let mut config = read_over(base, &self.config)?;
        if let Some(compat) = self.compat {
            config.compat = compat;
        }
        Ok(config)
    }

    /// Builds the blueprint of a configuration.
    fn build(&self, config: Config) -> Result<Blueprint, Box<dyn Error>> {
        let blueprint = self.build_from_assets(config)?;
        for notice in blueprint.notices() {
            note!("note: {notice}");
        }
        Ok(blueprint)
    }

    fn build_from_assets(&self, config: Config) -> Result<Blueprint, Box<dyn Error>> {
        let Some(dir) = &self.assets else {
            return Ok(Blueprint::new(config)?);
        };
        let options = BlueprintOptions {
            assets: self.assets()?,
            ..BlueprintOptions::default()
        };
        let built = Blueprint::with(config, options);
        // an unreadable texture is an error of the folder, whenever it is drawn
        let checked = built.and_then(|blueprint| blueprint.scenery().map(|_| blueprint));
        Ok(checked.map_err(|e| format!("--assets {}: {e}", dir.display()))?)
    }

    /// Returns the assets of the blueprint.
    fn assets(&self) -> Result<Arc<dyn AssetSource>, Box<dyn Error>> {
        Ok(match &self.assets {
            Some(dir) => Arc::new(
                DirAssets::new(dir)
                    .map_err(|e| format!("--assets: {e}; give a folder with babybench/*.xml and tex/*.png"))?,
            ),
            None => Arc::new(embedded()),
        })
    }
}

/// Reads a recording for an environment.
fn read_recording(path: &Path, env: &Env) -> Result<Recording, Box<dyn Error>> {
    match Recording::read(&Npz::open(path)?, env) {
        // these name the file
        Err(ReplayError::Npz(e)) => Err(e.into()),
        Err(e) => Err(format!("{}: {e}; was it recorded with another configuration?", path.display()).into()),
        Ok(recording) => Ok(recording),
    }
}

/// Creates a progress bar over steps.
fn progress_bar(steps: u64, quiet: bool) -> Result<ProgressBar, Box<dyn Error>> {
    let bar = if quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new(steps)
    };
    bar.set_style(ProgressStyle::with_template(
        "{bar:40} {pos}/{len} steps, {per_sec}, {eta} left",
    )?);
    Ok(bar)
}

/// Reads the arguments of a command line. `program` replaces the first one in usage texts.
pub fn parse(
    arguments: impl IntoIterator<Item = OsString>,
    program: Option<&'static str>,
) -> Result<Command, clap::Error> {
    let mut cli = Cli::command();
    if let Some(program) = program {
        cli = cli.bin_name(program);
    }
    let matches = cli.try_get_matches_from_mut(arguments)?;
    let read = Cli::from_arg_matches(&matches).map_err(|e| e.format(&mut cli))?;
    Ok(read.command)
}

impl Command {
    /// Runs the command.
    pub fn run(self) -> Result<(), Box<dyn Error>> {
        match self {
            Self::Run(c) => c.run(),
            Self::Inspect(c) => c.run(),
            Self::Render(c) => c.run(),
            Self::Scene(c) => c.run(),
            Self::Simulate(c) => c.run(),
            Self::View(c) => c.run(),
            Self::Replay(c) => c.run(),
            Self::Benchmark(c) => c.run(),
            Self::Protocol(c) => c.run(),
            Self::Measure(c) => c.run(),
            Self::Senses(c) => c.run(),
            Self::TestInstallation(c) => c.run(),
            Self::Doctor(c) => c.run(),
            Self::Train(c) => c.run(),
            Self::Score(c) => c.run(),
            Self::Report(c) => c.run(),
            Self::Pack(c) => c.run(),
            Self::Evaluate(c) => c.run(),
        }
    }
}
