//! The self-check: the bits of episodes, compared with a table.

use std::error::Error;
use std::fmt;
use std::time::{Duration, Instant};

use babybench::config::Example;
use babybench::env::Checksum;
use babybench::{Blueprint, Env};

/// Output of `examples/checksum`: in each line a configuration, random steps from seed 0, and the checksum after them.
const TABLE: &str = include_str!("checksums.txt");
/// Time limit of the check: a slow machine compares only the lines that it can compute in this time.
const LONGEST: Duration = Duration::from_secs(10);

/// The result of a self-check.
pub struct Outcome {
    /// Number of table lines that were compared.
    compared: usize,
    /// Number of table lines for configurations that the program has.
    lines: usize,
    /// Steps of all episodes.
    steps: usize,
    took: Duration,
    /// Descriptions of the lines that differ.
    pub differences: Vec<String>,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (compared, lines, steps) = (self.compared, self.lines, self.steps);
        let seconds = self.took.as_secs_f64();
        write!(
            f,
            "passed: {compared} of {lines} checksums of {steps} steps are the tested ones ({seconds:.1} s)"
        )?;
        if compared < lines {
            write!(f, "; the time limit of ten seconds left out the others")?;
        }
        Ok(())
    }
}

/// A line of the table.
struct Line {
    steps: usize,
    checksum: String,
}

/// Reads the lines about a configuration, in ascending order of steps.
fn lines_of(name: &str) -> Result<Vec<Line>, Box<dyn Error>> {
    let mut lines = Vec::new();
    for line in TABLE.lines() {
        let words: Vec<_> = line.split_whitespace().collect();
        let &[case, steps, checksum] = &words[..] else {
            return Err(format!("the table of checksums has an invalid line: {line}").into());
        };
        if case == name {
            let (steps, checksum) = (steps.parse()?, checksum.to_owned());
            lines.push(Line { steps, checksum });
        }
    }
    Ok(lines)
}

/// Runs episodes of the three examples of BabyBench and compares their checksums. The table also has a configuration that exists only as a file.
pub fn run() -> Result<Outcome, Box<dyn Error>> {
    let started = Instant::now();
    let mut outcome = Outcome {
        compared: 0,
        lines: 0,
        steps: 0,
        took: Duration::ZERO,
        differences: Vec::new(),
    };
    let mut episodes = Vec::new();
    for example in Example::ALL {
        let lines = lines_of(example.name)?;
        if lines.is_empty() {
            return Err(format!("the table of checksums has no line for {}", example.name).into());
        }
        outcome.lines += lines.len();
        let mut env = Blueprint::new(example.config()?)?.env()?;
        env.reset(Some(0))?;
        episodes.push((example.name, env, lines.into_iter().peekable(), 0));
    }
    // short episodes first, so that a slow machine tries every configuration
    while let Some((name, env, lines, taken)) = episodes
        .iter_mut()
        .filter_map(|episode| Some((episode.2.peek()?.steps, episode)))
        .min_by_key(|(steps, _)| *steps)
        .map(|(_, (name, env, lines, taken))| (name, env, lines, taken))
    {
        let Some(line) = lines.next() else { break };
        if !walk(env, line.steps - *taken, started)? {
            break;
        }
        outcome.steps += line.steps - *taken;
        *taken = line.steps;
        outcome.compared += 1;
        let found = Checksum::of(env).to_string();
        if found != line.checksum {
            let steps = line.steps;
            let difference = format!("FAILED: {name} after {steps} steps is {found}, not {}", line.checksum);
            outcome.differences.push(difference);
        }
    }
    outcome.took = started.elapsed();
    Ok(outcome)
}

/// Takes random steps and returns whether there was time for all of them.
fn walk(env: &mut Env, steps: usize, started: Instant) -> Result<bool, Box<dyn Error>> {
    let mut action = Vec::new();
    for _ in 0..steps {
        if started.elapsed() > LONGEST {
            return Ok(false);
        }
        env.sample_action(&mut action);
        env.step(&action)?;
    }
    Ok(true)
}
