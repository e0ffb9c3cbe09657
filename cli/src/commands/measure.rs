//! `babybench measure`

use std::error::Error;
use std::io;
use std::path::PathBuf;

use babybench::env::EYE_HAND_PAIRS;
use babybench::eval::{HandMeasures, Measures};
use babybench::runs::Record;
use clap::Args;

use crate::arguments::number;
use crate::print::say;

/// Arguments of `measure`.
#[derive(Args)]
pub struct MeasureArgs {
    /// Folder of a record: --record of run and evaluate
    #[arg(value_name = "DIR")]
    record: PathBuf,
    /// Measure this episode only, instead of the means of all
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number::<u64>)]
    episode: Option<u64>,
    /// Print the measures as one line of JSON
    #[arg(long)]
    json: bool,
}

impl MeasureArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let record = Record::open(&self.record)?;
        let all = match self.episode {
            Some(episode) => vec![Measures::of_episode(&record, episode)?],
            None => Measures::of_record(&record)?,
        };
        let Some(measures) = Measures::mean(&all) else {
            return Err(format!("{}: the record has no steps", self.record.display()).into());
        };
        if self.json {
            say!("{}", measures.to_json())?;
            return Ok(());
        }
        Ok(print(&measures)?)
    }
}

/// Prints measures as a table.
fn print(measures: &Measures) -> io::Result<()> {
    say!(
        "{} episodes, {} steps, {:.1} s",
        measures.episodes,
        measures.steps,
        measures.seconds
    )?;
    if let Some(parts) = measures.parts_per_episode {
        say!("parts touched in an episode, by both palms: {parts:.1}")?;
    }
    say!(
        "{:24} {:>10} {:>10} {:>8}",
        "touches of the body",
        "per minute",
        "seconds",
        "time"
    )?;
    let line = |what: &str, per_minute: f64, duration: f64, share: f64| {
        say!("{what:24} {per_minute:>10.1} {duration:>10.2} {:>6.1} %", 100.0 * share)
    };
    let hands: [(&str, &HandMeasures); 2] = [("right hand", &measures.right_hand), ("left hand", &measures.left_hand)];
    for (name, hand) in hands {
        line(name, hand.per_minute, hand.duration, hand.share)?;
        for (region, found) in &hand.regions {
            line(&format!("  {region}"), found.per_minute, found.duration, found.share)?;
        }
    }
    say!(
        "hands touch each other: {:.1} % of the time",
        100.0 * measures.hand_to_hand
    )?;
    say!(
        "double touch, of a hand and the body: {:.1} % of the time",
        100.0 * measures.double_touch
    )?;
    say!("handedness, right less left: {:+.2}", measures.handedness)?;
    if let Some(smoothness) = measures.smoothness {
        say!("smoothness (minus log dimensionless jerk): {smoothness:.1}")?;
    }
    if let Some(symmetry) = measures.symmetry {
        say!("symmetry of right and left joints: {symmetry:+.2}")?;
    }
    for (what, shares) in [
        ("in view, by the counters", measures.regards),
        ("pixels within 15 degrees", measures.hands_seen),
    ] {
        if let Some(shares) = shares {
            for (pair, share) in EYE_HAND_PAIRS.iter().zip(shares.to_array()) {
                say!("{what}: {} {:.1} % of the time", pair.replace('_', " "), 100.0 * share)?;
            }
        }
    }
    Ok(())
}
