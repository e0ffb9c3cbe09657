//! `babybench view`

use std::error::Error;
use std::path::PathBuf;

use babybench::config::{Compat, Example};
use babybench::policy::{DEFAULT_LIMIT, Policy, PolicySource};
use babybench::{Blueprint, Env};
use clap::Args;

use super::Source;
use crate::arguments::{count, number};
use crate::interrupt::Interrupt;
use crate::print::say;
use crate::view::{Next, View};

/// Arguments of `view`.
#[derive(Args)]
pub struct ViewArgs {
    /// Configuration file (YAML), see configs/, or the name of an example. Without one, self-touch in the crib
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Use the MJCF and textures of this directory (babybench/*.xml, tex/*.png) instead of the embedded ones
    #[arg(long, value_name = "DIR", requires = "config")]
    assets: Option<PathBuf>,
    /// The policy that moves him: zero, random, a noise (held, ou, pink, oscillators), babbling, watching, a model (FILE.onnx, if this program is built with the
    /// feature onnx), or a command with its arguments, as for evaluate
    #[arg(long, default_value = "held")]
    policy: String,
    /// Random seed; that of the configuration by default
    #[arg(long, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: Option<u64>,
    /// Port of the page on this machine; any free port by default
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = port)]
    port: u16,
    /// Number of episodes; by default it continues until it is interrupted
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>)]
    episodes: Option<u64>,
}

/// Parses a port.
fn port(text: &str) -> Result<u16, String> {
    text.parse()
        .map_err(|_| "expected a port, 0 (any that is free) to 65535".to_owned())
}

impl ViewArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let blueprint = self.blueprint()?;
        let mut env = blueprint.env()?;
        let mut policy = PolicySource::new(&self.policy).open(DEFAULT_LIMIT)?;
        let config = blueprint.config();
        let title = format!(
            "{} in {}, moved by {}",
            config.behavior.name(),
            config.scene,
            self.policy
        );
        let mut view = View::open(self.port, &title).map_err(|e| format!("--port {}: {e}", self.port))?;
        say!("{}", view.url())?;
        say!("open it in a browser of this machine; Ctrl-C ends it")?;

        let (mut action, mut episode) = (Vec::new(), 0);
        env.reset(self.seed)?;
        policy.begin(&mut env, episode)?;
        while !interrupt.wanted() && self.episodes.is_none_or(|most| episode < most) {
            let over = match view.attend(&mut env) {
                Next::Wait => continue,
                Next::Reset => true,
                Next::Step => step(&mut env, &mut view, &mut *policy, &mut action)?,
            };
            if over {
                episode += 1;
                env.reset(None)?;
                policy.begin(&mut env, episode)?;
                view.restarted(&mut env);
            }
        }
        Ok(())
    }

    fn blueprint(&self) -> Result<Blueprint, Box<dyn Error>> {
        let Some(config) = &self.config else {
            return Ok(Blueprint::new(Example::SELF_TOUCH.config()?)?);
        };
        let source = Source {
            config: config.clone(),
            assets: self.assets.clone(),
            compat: None,
        };
        source.blueprint(Compat::Api)
    }
}

/// Takes a step and returns whether it ends the episode.
fn step(
    env: &mut Env,
    view: &mut View,
    policy: &mut dyn Policy,
    action: &mut Vec<f32>,
) -> Result<bool, Box<dyn Error>> {
    if view.moves() {
        policy.act(env, action)?;
    } else {
        action.clear();
        action.resize(env.action_space().len(), 0.0);
    }
    let step = env.step(action)?;
    let over = step.terminated || step.truncated;
    let seconds = env.blueprint().dt();
    view.stepped(env, seconds);
    Ok(over)
}
