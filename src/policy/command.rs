//! Policies that are other programs.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::protocol::{Line, parse};
use super::{Moment, Policy, PolicyError};
use crate::env::Env;
use crate::json;

/// Longest answer of a command, bytes.
const MAX_LINE: u64 = 1 << 20;
/// The default time limit of a command for an action.
pub const DEFAULT_LIMIT: Duration = Duration::from_secs(60);
/// The time a command has to exit after the end of its input.
const FAREWELL: Duration = Duration::from_secs(1);

/// A policy in another program, in any language: a line of JSON with the observation goes to its standard input, a line
/// with a JSON list of numbers, the action, comes back from its standard output. Its standard error is passed through.
///
/// The line is an object with the number of the `episode` and of the `step` in it (both from 0), and the keys of the
/// active senses: `observation`, `touch` and `vestibular` are lists of numbers, `eye_left` and `eye_right` are objects
/// `{"shape": [height, width, 3], "data": "..."}` with the bytes of the image in base64 (red, green, blue of each
/// pixel, rows from the top). At step 0 of an episode there is also `action_space`, an object with the lists `low` and
/// `high`. Numbers that are not finite, which JSON cannot say, are `null`. The input ends when there are no more
/// episodes. In Python:
/// ```python
/// import base64, json, sys
/// import numpy as np
///
/// for line in sys.stdin:
///     obs = json.loads(line)
///     if obs["step"] == 0:
///         low, high = obs["action_space"]["low"], obs["action_space"]["high"]
///     for eye in ("eye_left", "eye_right"):
///         if eye in obs:
///             image = np.frombuffer(base64.b64decode(obs[eye]["data"]), np.uint8)
///             obs[eye] = image.reshape(obs[eye]["shape"])
///     action = [0.0] * len(low)  # here goes the policy
///     print(json.dumps(action), flush=True)
/// ```
pub struct CommandPolicy {
    command: String,
    child: Child,
    /// Lines for the thread that writes: a program that reads nothing would block it.
    observations: Option<Sender<Vec<u8>>>,
    /// Answers from the thread that reads.
    answers: Receiver<std::io::Result<Vec<u8>>>,
    limit: Duration,
    now: Moment,
}

impl std::fmt::Debug for CommandPolicy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CommandPolicy")
            .field("command", &self.command)
            .field("limit", &self.limit)
            .finish_non_exhaustive()
    }
}

impl CommandPolicy {
    /// Starts a command: a program and its arguments, separated by spaces. Quotes keep words with spaces together, and
    /// `\` escapes the character after it (except on Windows, where it separates folders). There is no shell:
    /// no other character is special.
    ///
    /// # Errors
    /// A quote that is not closed; a program that cannot be started.
    pub fn start(command: &str) -> Result<Self, PolicyError> {
        let malformed = |reason| PolicyError::Words {
            command: command.to_string(),
            reason,
        };
        let words = words(command).ok_or_else(|| {
            malformed(
                "a quote is not closed, or a backslash is the last character; quotes come in pairs, as in \
                 \"python3 'my policy.py'\"",
            )
        })?;
        let (name, arguments) = words.split_first().ok_or_else(|| {
            malformed("it is empty; a policy is random, zero, an .onnx file, or a command with its arguments")
        })?;
        let mut program = Command::new(name);
        program.args(arguments);
        Self::spawn(program, command)
    }

    /// Starts a program, which errors call `name`.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn spawn(mut program: Command, name: &str) -> Result<Self, PolicyError> {
        let failed = |source| PolicyError::Start {
            command: name.to_string(),
            source,
        };
        program.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = program.spawn().map_err(failed)?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(failed(std::io::Error::other("no pipe")));
        };
        let (observations, lines) = channel();
        let (sender, answers) = channel();
        std::thread::spawn(move || write_lines(input, &lines));
        std::thread::spawn(move || read_lines(output, &sender));
        Ok(Self {
            command: name.to_string(),
            child,
            observations: Some(observations),
            answers,
            limit: DEFAULT_LIMIT,
            now: Moment { episode: 0, step: 0 },
        })
    }

    /// Sets the time limit for an action, [`DEFAULT_LIMIT`] if not called.
    #[must_use]
    pub fn with_limit(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    /// Sends a line to the command and returns its answer.
    fn ask(&mut self, line: Vec<u8>) -> Result<Vec<u8>, PolicyError> {
        let when = self.now;
        if let Some(observations) = &self.observations {
            // if the command takes no more, it has ended, and so has its output
            let _ = observations.send(line);
        }
        let command = self.command.clone();
        match self.answers.recv_timeout(self.limit) {
            Ok(Ok(answer)) => Ok(answer),
            Ok(Err(e)) => Err(PolicyError::Ended {
                command,
                status: e.to_string(),
                when,
            }),
            Err(RecvTimeoutError::Timeout) => Err(PolicyError::Timeout {
                command,
                seconds: self.limit.as_secs_f64(),
                when,
            }),
            Err(RecvTimeoutError::Disconnected) => {
                self.observations = None;
                let status = match wait(&mut self.child, FAREWELL) {
                    Some(status) => status.to_string(),
                    None => "it closed its output".to_string(),
                };
                Err(PolicyError::Ended { command, status, when })
            }
        }
    }
}

/// Splits a command into a program and its arguments; returns `None` if a quote is not closed.
pub(super) fn words(command: &str) -> Option<Vec<String>> {
    match cfg!(windows) {
        true => shlex::split(&command.replace('\\', r"\\")),
        false => shlex::split(command),
    }
}

/// Passes lines on until there are no more or nobody takes them; the input then ends.
fn write_lines(mut input: ChildStdin, lines: &Receiver<Vec<u8>>) {
    for line in lines {
        if input.write_all(&line).and_then(|()| input.flush()).is_err() {
            return;
        }
    }
}

/// Passes lines on until the output ends.
fn read_lines(output: ChildStdout, lines: &Sender<std::io::Result<Vec<u8>>>) {
    let mut output = BufReader::new(output);
    loop {
        let mut line = Vec::new();
        let read = (&mut output).take(MAX_LINE).read_until(b'\n', &mut line);
        let last = matches!(read, Ok(0) | Err(_));
        if matches!(read, Ok(0)) || lines.send(read.map(|_| line)).is_err() || last {
            return;
        }
    }
}

/// Waits for a program to end, at most for a while.
fn wait(child: &mut Child, most: Duration) -> Option<std::process::ExitStatus> {
    let started = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) if started.elapsed() < most => std::thread::sleep(Duration::from_millis(10)),
            _ => return None,
        }
    }
}

/// Returns the start of a text, for an error message.
fn start(text: &str) -> String {
    text.chars().take(60).collect()
}

impl Policy for CommandPolicy {
    fn begin(&mut self, _: &mut Env) -> Result<(), PolicyError> {
        if self.now.step > 0 {
            self.now.episode += 1;
        }
        self.now.step = 0;
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        let mut line = json::text(&Line::new(env, self.now)).into_bytes();
        line.push(b'\n');
        let answer = self.ask(line)?;
        let answer = String::from_utf8_lossy(&answer);
        let expected = env.action_space().len();
        parse(answer.trim(), expected, action).map_err(|reason| PolicyError::Answer {
            command: self.command.clone(),
            answer: start(answer.trim()),
            reason,
            expected,
            when: self.now,
        })?;
        self.now.step += 1;
        Ok(())
    }
}

impl Drop for CommandPolicy {
    fn drop(&mut self) {
        // the end of its input tells the program to end
        self.observations = None;
        if wait(&mut self.child, FAREWELL).is_none() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_keep_words_together() {
        let split = |command| words(command).map(|w| w.join("|"));
        assert_eq!(
            split("python3 policy.py --fast").as_deref(),
            Some("python3|policy.py|--fast")
        );
        assert_eq!(
            split(r#" 'my policy' --name="a b" "it's" '' "#).as_deref(),
            Some("my policy|--name=a b|it's|")
        );
        assert_eq!(split("  ").as_deref(), Some(""));
        assert_eq!(split("python3 'my policy.py"), None);
        assert_eq!(split("say \"so"), None);
        let folders = if cfg!(windows) { r"a\b.exe|c" } else { "ab.exe|c" };
        assert_eq!(split(r"a\b.exe c").as_deref(), Some(folders));
    }
}
