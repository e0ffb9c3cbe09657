//! Policies that are other programs.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, TrySendError, sync_channel};
use std::time::{Duration, Instant};

use super::protocol::{ObservationMessage, parse};
use super::{EvaluationStep, Policy, PolicyError};
use crate::env::Env;
use crate::json;
use crate::limits::Limits;
use crate::text::quoted;

/// The default time limit of a command for an action.
pub const DEFAULT_LIMIT: Duration = Duration::from_secs(60);
/// The time a command has to exit after the end of its input.
const FAREWELL: Duration = Duration::from_secs(1);

/// The fault of an answer that was not requested, or that comes with another one.
const UNASKED: &str = "more lines came than observations went, so that its answers no longer belong to them";

/// A policy in another program, in any language: a line of JSON with the observation goes to its standard input, a line
/// with a JSON list of numbers, the action, comes back from its standard output. Its standard error is passed through.
///
/// The line is an object with the number of the `episode` in the evaluation and of the `step` in it (both from 0), and the keys of the
/// observation ([`ObservationEntry`](crate::sensors::ObservationEntry)): `observation`, `touch` and all others but images are flat lists of
/// numbers, `eye_left` and `eye_right` are objects `{"shape": [height, width, 3], "data": "..."}` with the bytes of the image in base64
/// (red, green, blue of each pixel, rows from the top), and what else `vision_outputs` asks for, such as `eye_left_depth`, are objects
/// `{"shape": [height, width], "dtype": "float32", "data": "..."}`, the lowest byte of a number first. At step 0 of an episode there is
/// also `action_space`, an object with the lists `low` and `high`. Numbers that are not finite, which JSON cannot say, are `null`. The
/// input ends when there are no more episodes. In Python:
/// ```python
/// import base64, json, sys
/// import numpy as np
///
/// for line in sys.stdin:
///     obs = json.loads(line)
///     if obs["step"] == 0:
///         low, high = obs["action_space"]["low"], obs["action_space"]["high"]
///     for key, image in obs.items():
///         if key.startswith("eye_"):
///             data = np.frombuffer(base64.b64decode(image["data"]), image.get("dtype", "uint8"))
///             obs[key] = data.reshape(image["shape"])
///     action = [0.0] * len(low)  # here goes the policy
///     print(json.dumps(action), flush=True)
/// ```
pub struct CommandPolicy {
    command: String,
    child: Child,
    /// Lines for the thread that writes: a program that reads nothing would block it.
    observations: Option<SyncSender<Vec<u8>>>,
    /// Answers from the thread that reads, which waits until one is taken.
    answers: Receiver<std::io::Result<CommandReply>>,
    limit: Duration,
    now: EvaluationStep,
}

/// A line that a command wrote.
#[derive(Debug)]
struct CommandReply {
    line: Vec<u8>,
    /// Description of the fault, independent of its content.
    fault: Option<String>,
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
    /// Starts a command: a program and its arguments, separated by spaces. Quotes keep arguments with spaces together, and
    /// `\` escapes the character after it (except on Windows, where it separates folders). There is no shell:
    /// no other character is special.
    ///
    /// # Errors
    /// A quote that is not closed; a program that cannot be started.
    pub fn start(command: &str) -> Result<Self, PolicyError> {
        Self::start_with(command, &Limits::DEFAULT)
    }

    /// Starts a command as [`CommandPolicy::start`] does, whose answers have at most [`Limits::answer_bytes`].
    ///
    /// # Errors
    /// As [`CommandPolicy::start`].
    pub fn start_with(command: &str, limits: &Limits) -> Result<Self, PolicyError> {
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
            malformed("it is empty; a policy is random, zero, held, ou, pink, color:0.69, color_by_age, oscillators, babbling, watching, an .onnx file, or a command with its arguments")
        })?;
        let mut program = Command::new(name);
        program.args(arguments);
        Self::spawn_with(program, command, limits)
    }

    /// Starts a program, which errors call `name`.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn spawn(program: Command, name: &str) -> Result<Self, PolicyError> {
        Self::spawn_with(program, name, &Limits::DEFAULT)
    }

    /// Starts a program as [`CommandPolicy::spawn`] does, whose answers have at most [`Limits::answer_bytes`].
    ///
    /// # Errors
    /// As [`CommandPolicy::spawn`].
    pub fn spawn_with(mut program: Command, name: &str, limits: &Limits) -> Result<Self, PolicyError> {
        let failed = |source| PolicyError::Start {
            command: name.to_string(),
            source,
        };
        program.stdin(Stdio::piped()).stdout(Stdio::piped());
        // a group of its own, so that a program that does not end is killed with everything it started
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut program, 0);
        let mut child = program.spawn().map_err(failed)?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(failed(std::io::Error::other("no pipe")));
        };
        // a program that writes without being asked fills the pipe, not the memory
        let (observations, lines) = sync_channel(1);
        let (sender, answers) = sync_channel(1);
        let longest = limits.answer_bytes;
        std::thread::spawn(move || write_lines(input, &lines));
        std::thread::spawn(move || read_lines(output, longest, &sender));
        Ok(Self {
            command: name.to_string(),
            child,
            observations: Some(observations),
            answers,
            limit: DEFAULT_LIMIT,
            now: EvaluationStep { episode: 0, step: 0 },
        })
    }

    /// Sets the time limit for an action, [`DEFAULT_LIMIT`] if not called.
    #[must_use]
    pub fn with_limit(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    /// Sends a line to the command and returns its answer.
    fn ask(&mut self, line: Vec<u8>) -> Result<CommandReply, PolicyError> {
        // an answer that is there before the question belongs to no observation: taken for the answer, it would shift
        // all later ones
        match self.answers.try_recv() {
            Err(TryRecvError::Empty | TryRecvError::Disconnected) => {}
            Ok(Err(e)) => return Err(self.ended(e.to_string())),
            Ok(Ok(early)) => {
                let fault = Some(UNASKED.to_string());
                return Ok(CommandReply { fault, ..early });
            }
        }
        match self
            .observations
            .as_ref()
            .map(|observations| observations.try_send(line))
        {
            Some(Err(TrySendError::Full(_))) => return Err(self.timeout()),
            // if the command takes no more, it has ended, and so has its output
            Some(Ok(()) | Err(TrySendError::Disconnected(_))) | None => {}
        }
        match self.answers.recv_timeout(self.limit) {
            Ok(Ok(answer)) => Ok(answer),
            Ok(Err(e)) => Err(self.ended(e.to_string())),
            Err(RecvTimeoutError::Timeout) => Err(self.timeout()),
            Err(RecvTimeoutError::Disconnected) => {
                self.observations = None;
                let status = match wait(&mut self.child, FAREWELL) {
                    Some(status) => status.to_string(),
                    None => "it closed its output".to_string(),
                };
                Err(self.ended(status))
            }
        }
    }

    fn ended(&self, status: String) -> PolicyError {
        let (command, when) = (self.command.clone(), self.now);
        PolicyError::Ended { command, status, when }
    }

    fn timeout(&self) -> PolicyError {
        PolicyError::Timeout {
            command: self.command.clone(),
            seconds: self.limit.as_secs_f64(),
            when: self.now,
        }
    }
}

/// Splits a command into a program and its arguments; returns `None` if a quote is not closed.
pub(super) fn words(command: &str) -> Option<Vec<String>> {
    if cfg!(windows) {
        shlex::split(&command.replace('\\', r"\\"))
    } else {
        shlex::split(command)
    }
}

/// Passes lines on until they end or the receiver is gone.
fn write_lines(mut input: ChildStdin, lines: &Receiver<Vec<u8>>) {
    for line in lines {
        if input.write_all(&line).and_then(|()| input.flush()).is_err() {
            return;
        }
    }
}

/// Passes lines on, each as soon as the previous one is taken, until the output ends.
fn read_lines(output: impl Read, longest: usize, lines: &SyncSender<std::io::Result<CommandReply>>) {
    let mut output = BufReader::new(output);
    loop {
        let mut line = Vec::new();
        // one byte more than allowed distinguishes a line that is too long from one that just fits
        let most = (longest as u64).saturating_add(1);
        let read = (&mut output).take(most).read_until(b'\n', &mut line);
        let last = matches!(read, Ok(0) | Err(_));
        let fault = if line.len() > longest {
            Some(format!("it has more than {longest} bytes"))
        } else {
            (!output.buffer().is_empty()).then(|| UNASKED.to_string())
        };
        if matches!(read, Ok(0)) || lines.send(read.map(|_| CommandReply { line, fault })).is_err() || last {
            return;
        }
    }
}

/// Reads the output of a program as answers of `expected` numbers and at most `longest` bytes, for fuzzing.
#[cfg(fuzzing)]
pub fn answers(output: &[u8], expected: usize, longest: usize) -> Vec<Result<Vec<f32>, String>> {
    let (sender, lines) = sync_channel(output.len() + 1);
    read_lines(output, longest, &sender);
    drop(sender);
    let read = |answer: CommandReply| {
        let mut action = Vec::new();
        let read = read_answer(&answer, expected, &mut action);
        read.map(|()| action)
    };
    lines.into_iter().filter_map(Result::ok).map(read).collect()
}

/// Reads an action from a line; the error describes the fault.
fn read_answer(answer: &CommandReply, expected: usize, action: &mut Vec<f32>) -> Result<(), String> {
    let text = String::from_utf8_lossy(&answer.line);
    let fault = answer.fault.clone();
    let read = fault.map_or_else(|| parse(text.trim(), expected, action), Err);
    read.map_err(|reason| quoted(&reason))
}

/// Waits for a program to end, at most for a while.
fn wait(child: &mut Child, most: Duration) -> Option<std::process::ExitStatus> {
    let started = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            // the standard library has no wait with a time limit
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
    fn begin(&mut self, _: &mut Env, episode: u64) -> Result<(), PolicyError> {
        self.now = EvaluationStep { episode, step: 0 };
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        env.senses_mut().look().map_err(|e| PolicyError::Other(Box::new(e)))?;
        let mut line = json::text(&ObservationMessage::new(env, self.now)).into_bytes();
        line.push(b'\n');
        let answer = self.ask(line)?;
        let expected = env.action_space().len();
        read_answer(&answer, expected, action).map_err(|reason| PolicyError::Answer {
            command: self.command.clone(),
            answer: start(String::from_utf8_lossy(&answer.line).trim()),
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
            kill_group(&self.child);
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// Kills a program that has not been waited for, and everything that it started in its process group.
#[cfg(unix)]
fn kill_group(child: &Child) {
    let group = i32::try_from(child.id()).ok().and_then(rustix::process::Pid::from_raw);
    if let Some(group) = group {
        // one that has just ended is not an error
        let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
    }
}

/// Elsewhere only the program itself can be killed.
#[cfg(not(unix))]
fn kill_group(_: &Child) {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the answers of a program that writes the given bytes at once.
    fn read(text: &[u8], longest: usize) -> Vec<CommandReply> {
        let (sender, answers) = sync_channel(100);
        read_lines(text, longest, &sender);
        drop(sender);
        answers.iter().map(|a| a.expect("no error")).collect()
    }

    #[test]
    fn more_than_one_line_at_a_time_is_a_fault() {
        let alone = read(b"[1]\n", 10);
        assert!(
            matches!(&alone[..], [CommandReply { line, fault: None }] if line == b"[1]\n"),
            "{alone:?}"
        );
        let twice = read(b"[1]\n[1]\n", 10);
        assert_eq!(twice.len(), 2);
        assert_eq!(twice[0].fault.as_deref(), Some(UNASKED));
        let long = read(&[b'1'; 100], 10);
        assert_eq!(long[0].fault.as_deref(), Some("it has more than 10 bytes"));
        assert_eq!(long[0].line.len(), 11);
    }

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
