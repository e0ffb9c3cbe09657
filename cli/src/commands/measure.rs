//! `babybench measure`

use std::error::Error;
use std::io;
use std::path::PathBuf;

use babybench::env::EYE_HAND_PAIRS;
use babybench::eval::movement::{MeasureDescription, Movement, MovementFrame, MovementOptions};
use babybench::eval::{HandMeasures, Measures};
use babybench::runs::Record;
use clap::Args;
use clap::builder::PossibleValuesParser;

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
    /// Measure how the limbs and joints move, instead of touches
    #[arg(long)]
    movement: bool,
    /// Frames a second of the camera that sees the movement
    #[arg(long, requires = "movement", value_name = "HZ", value_parser = number::<f64>)]
    fps: Option<f64>,
    /// Band in which exponents are fitted, Hz
    #[arg(long, requires = "movement", value_name = "LOW,HIGH", value_delimiter = ',', num_args = 1, value_parser = number::<f64>)]
    band: Option<Vec<f64>>,
    /// Frames of a window of the spectrum, a power of two
    #[arg(long, requires = "movement", value_name = "N", value_parser = number::<usize>)]
    window: Option<usize>,
    /// Standard deviation of the camera's errors, mm
    #[arg(long, requires = "movement", value_name = "MM", value_parser = number::<f64>)]
    jitter: Option<f64>,
    /// Seed of the camera's errors
    #[arg(long, requires = "movement", value_name = "N", value_parser = number::<u64>)]
    seed: Option<u64>,
    /// The frame in which limbs move
    #[arg(long, requires = "movement", value_parser = PossibleValuesParser::new(MovementFrame::ALL.map(MovementFrame::name)))]
    frame: Option<String>,
}

impl MeasureArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let record = Record::open(&self.record)?;
        if self.movement {
            return self.movement(&record);
        }
        let all = match self.episode {
            Some(episode) => vec![Measures::of_episode(&record, episode)?],
            None => Measures::of_record(&record)?,
        };
        let measures = Measures::mean(&all).ok_or_else(|| self.empty())?;
        if self.json {
            say!("{}", measures.to_json())?;
            return Ok(());
        }
        Ok(print(&measures)?)
    }

    fn empty(&self) -> String {
        format!("{}: the record has no steps", self.record.display())
    }

    fn movement(&self, record: &Record) -> Result<(), Box<dyn Error>> {
        let options = self.options()?;
        let all = match self.episode {
            Some(episode) => vec![Movement::of_episode(record, episode, &options)?],
            None => Movement::of_record(record, &options)?,
        };
        let movement = Movement::mean(&all).ok_or_else(|| self.empty())?;
        if self.json {
            say!("{}", movement.to_json())?;
            return Ok(());
        }
        Ok(print_movement(&movement)?)
    }

    fn options(&self) -> Result<MovementOptions, Box<dyn Error>> {
        let mut options = MovementOptions::default();
        options.fps = self.fps.unwrap_or(options.fps);
        options.window = self.window.unwrap_or(options.window);
        options.jitter = self.jitter.unwrap_or(options.jitter);
        options.seed = self.seed.unwrap_or(options.seed);
        if let Some(band) = &self.band {
            let band = <[f64; 2]>::try_from(band.as_slice());
            options.band = band.map_err(|_| "--band: expected two frequencies, such as 0.1,5")?;
        }
        if let Some(name) = &self.frame {
            options.frame = MovementFrame::of(name).unwrap_or_default();
        }
        Ok(options)
    }
}

/// Prints measures of movement with their units.
fn print_movement(movement: &Movement) -> io::Result<()> {
    let o = &movement.options;
    say!(
        "{} episodes, {:.1} s; {} frames a second, band {} to {} Hz, window {} frames, errors of {} mm, frame of the {}",
        movement.episodes,
        movement.seconds,
        o.fps,
        o.band[0],
        o.band[1],
        o.window,
        o.jitter,
        o.frame.name()
    )?;
    for (name, value) in &movement.values {
        let unit = MeasureDescription::of(name).map_or("", |measure| measure.unit);
        say!("{name:36} {value:>10.3} {unit}")?;
    }
    for (episode, segment) in movement.leading.iter().enumerate() {
        say!("roll {}: {} first", episode + 1, segment.replace('_', " "))?;
    }
    Ok(())
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
