//! What chooses the actions of an evaluation.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use thiserror::Error;

use crate::env::Env;

/// Longest answer of a command, bytes.
const MAX_LINE: u64 = 1 << 20;

/// Why a policy has no action.
#[derive(Debug, Error)]
pub enum PolicyError {
    /// The command cannot be started.
    #[error("cannot start the policy {command:?}: {source}")]
    Start {
        /// The command.
        command: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The command does not take observations or give actions any more.
    #[error("the policy {command:?} does not answer: {reason}")]
    Silent {
        /// The command.
        command: String,
        /// What happened.
        reason: String,
    },
    /// The command's answer is not an action.
    #[error("the policy {command:?} answered {answer:?}, which is not a JSON list of {expected} numbers")]
    Answer {
        /// The command.
        command: String,
        /// The start of its answer.
        answer: String,
        /// Length of an action.
        expected: usize,
    },
}

/// Chooses actions.
pub trait Policy: Send {
    /// An episode begins; the environment has been reset.
    ///
    /// # Errors
    /// The policy cannot go on.
    fn begin(&mut self, env: &mut Env) -> Result<(), PolicyError> {
        let _ = env;
        Ok(())
    }

    /// The action for the environment's present observation.
    ///
    /// # Errors
    /// The policy cannot go on.
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError>;
}

/// Random actions, from the generator of the environment.
#[derive(Clone, Copy, Debug, Default)]
pub struct RandomPolicy;

impl Policy for RandomPolicy {
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        env.sample_action(action);
        Ok(())
    }
}

/// The action 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct ZeroPolicy;

impl Policy for ZeroPolicy {
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        action.clear();
        action.resize(env.action_space().len(), 0.0);
        Ok(())
    }
}

/// Actions of another program, in any language: a line of JSON with the observation goes to its standard input, a line
/// with a list of numbers, the action, comes from its standard output.
///
/// The line is `{"episode": 0, "step": 0, "observation": [...], "touch": [...], "vestibular": [...]}`, with the keys of
/// the active senses except vision; `step` is 0 at the start of an episode. In Python:
/// ```python
/// import json, sys
/// for line in sys.stdin:
///     obs = json.loads(line)
///     print(json.dumps([0.0] * N_ACTIONS), flush=True)
/// ```
pub struct CommandPolicy {
    command: String,
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    line: String,
    episodes: u64,
    steps: u64,
}

impl CommandPolicy {
    /// Starts a command: a program and its arguments, separated by spaces.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn start(command: &str) -> Result<Self, PolicyError> {
        let failed = |source| PolicyError::Start {
            command: command.to_string(),
            source,
        };
        let mut words = command.split_whitespace();
        let mut child = Command::new(words.next().unwrap_or_default())
            .args(words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let no_pipe = || failed(std::io::Error::other("no pipe"));
        let input = child.stdin.take().ok_or_else(no_pipe)?;
        let output = BufReader::new(child.stdout.take().ok_or_else(no_pipe)?);
        Ok(Self {
            command: command.to_string(),
            child,
            input: Some(input),
            output,
            line: String::new(),
            episodes: 0,
            steps: 0,
        })
    }

    fn silent(&self, reason: impl ToString) -> PolicyError {
        PolicyError::Silent {
            command: self.command.clone(),
            reason: reason.to_string(),
        }
    }
}

impl Policy for CommandPolicy {
    fn begin(&mut self, _: &mut Env) -> Result<(), PolicyError> {
        self.episodes += 1;
        self.steps = 0;
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        let observation = env.observation();
        self.line.clear();
        let (episode, step) = (self.episodes.saturating_sub(1), self.steps);
        // writing to a string cannot fail
        let _ = write!(self.line, "{{\"episode\": {episode}, \"step\": {step}");
        let _ = write!(self.line, ", \"observation\": {:?}", observation.observation);
        if let Some(touch) = observation.touch {
            let _ = write!(self.line, ", \"touch\": {touch:?}");
        }
        if let Some(vestibular) = observation.vestibular {
            let _ = write!(self.line, ", \"vestibular\": {vestibular:?}");
        }
        self.line.push_str("}\n");
        let sent = match &mut self.input {
            Some(input) => input.write_all(self.line.as_bytes()).and_then(|()| input.flush()),
            None => Ok(()),
        };
        sent.map_err(|e| self.silent(format!("it takes no observation: {e}")))?;
        self.line.clear();
        let read = (&mut self.output).take(MAX_LINE).read_line(&mut self.line);
        if read.map_err(|e| self.silent(e))? == 0 {
            return Err(self.silent("it ended"));
        }
        self.steps += 1;
        let numbers = self.line.trim().strip_prefix('[').and_then(|l| l.strip_suffix(']'));
        let numbers = numbers.map(|l| {
            l.split(',')
                .map(|n| n.trim().parse::<f32>())
                .collect::<Result<Vec<_>, _>>()
        });
        let expected = env.action_space().len();
        match numbers {
            Some(Ok(numbers)) if numbers.len() == expected => {
                action.clear();
                action.extend(numbers);
                Ok(())
            }
            _ => Err(PolicyError::Answer {
                command: self.command.clone(),
                answer: self.line.trim().chars().take(60).collect(),
                expected,
            }),
        }
    }
}

impl Drop for CommandPolicy {
    fn drop(&mut self) {
        // the end of its input tells the program to end
        self.input = None;
        for _ in 0..50 {
            if !matches!(self.child.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
