//! `babybench scene`

mod check;
mod new;

use std::error::Error;

use clap::{Args, Subcommand};

/// Arguments of `scene`.
#[derive(Args)]
pub struct Scene {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write a room with MIMo and toys (room.xml) and its configuration (room.yml), both with comments
    New(new::New),
    /// Print the contents of a scene, what MIMo may touch, what overlaps at the start, and what is ignored
    Check(check::Check),
}

impl Scene {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        match &self.command {
            Command::New(c) => c.run(),
            Command::Check(c) => c.run(),
        }
    }
}
