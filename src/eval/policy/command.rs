//! Policies that are other programs.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Moment, Policy, PolicyError};
use crate::env::{Env, Observation};

/// Longest answer of a command, bytes.
const MAX_LINE: u64 = 1 << 20;
/// How long a command may take for an action.
pub const DEFAULT_LIMIT: Duration = Duration::from_secs(60);
/// How long a command may take to end when its input has ended.
const FAREWELL: Duration = Duration::from_secs(1);

/// Actions of another program, in any language: a line of JSON with the observation goes to its standard input, a line
/// with a JSON list of numbers, the action, comes from its standard output. What it writes to its standard error is shown.
///
/// The line is an object with the number of the `episode` and of the `step` in it (both from 0), and the keys of the
/// active senses: `observation`, `touch` and `vestibular` are lists of numbers, `eye_left` and `eye_right` are objects
/// `{"shape": [height, width, 3], "data": "..."}` with the bytes of the image in base64 (red, green, blue of each pixel,
/// rows from the top). At step 0 of an episode there is also `action_space`, an object with the lists `low` and `high`.
/// The input ends when there are no more episodes. In Python:
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
    /// To the thread that writes, as a program that reads nothing would block it.
    observations: Option<Sender<Vec<u8>>>,
    /// From the thread that reads.
    answers: Receiver<std::io::Result<Vec<u8>>>,
    limit: Duration,
    line: String,
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
    /// Starts a command: a program and its arguments, separated by spaces. Quotes keep words with spaces together, and `\`
    /// takes the meaning from the character after it (except on Windows, where it separates folders). There is no shell:
    /// nothing else has a meaning.
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
                "a quote is not closed, or a backslash ends it; quotes come in pairs, as in \"python3 'my policy.py'\"",
            )
        })?;
        let (name, arguments) = words.split_first().ok_or_else(|| {
            malformed(
                "it is empty; a policy is random, zero, a file that ends in .onnx, or a command with its arguments",
            )
        })?;
        let mut program = Command::new(name);
        program.args(arguments);
        Self::spawn(program, command)
    }

    /// Starts a program; `name` is what errors call it.
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
            line: String::new(),
            now: Moment { episode: 0, step: 0 },
        })
    }

    /// With another limit of the time for an action than [`DEFAULT_LIMIT`].
    #[must_use]
    pub fn with_limit(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    /// The line that tells the present observation.
    fn tell(&mut self, env: &Env) {
        let Observation {
            observation,
            touch,
            eye_left,
            eye_right,
            vestibular,
        } = env.observation();
        let Moment { episode, step } = self.now;
        let line = &mut self.line;
        line.clear();
        // writing to a string cannot fail
        let _ = write!(line, "{{\"episode\": {episode}, \"step\": {step}");
        if step == 0 {
            let (low, high) = (env.action_space().low(), env.action_space().high());
            let _ = write!(line, ", \"action_space\": {{\"low\": {low:?}, \"high\": {high:?}}}");
        }
        let _ = write!(line, ", \"observation\": {observation:?}");
        if let Some(touch) = touch {
            let _ = write!(line, ", \"touch\": {touch:?}");
        }
        let shape = env.vision().map_or([0; 3], |v| v.shape());
        for (key, image) in [("eye_left", eye_left), ("eye_right", eye_right)] {
            if let Some(image) = image {
                let _ = write!(line, ", \"{key}\": {{\"shape\": {shape:?}, \"data\": \"");
                STANDARD.encode_string(image, line);
                line.push_str("\"}");
            }
        }
        if let Some(vestibular) = vestibular {
            let _ = write!(line, ", \"vestibular\": {vestibular:?}");
        }
        line.push_str("}\n");
    }

    /// The command's answer to the line.
    fn ask(&mut self) -> Result<Vec<u8>, PolicyError> {
        let when = self.now;
        if let Some(observations) = &self.observations {
            // if the command takes no more, it has ended, and so has its output
            let _ = observations.send(self.line.as_bytes().to_vec());
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

/// A command as a program and its arguments; `None` if a quote is not closed.
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

/// A JSON list of finite numbers.
fn parse(answer: &str, expected: usize, action: &mut Vec<f32>) -> Result<(), String> {
    let inside = answer.strip_prefix('[').and_then(|l| l.strip_suffix(']'));
    let inside = inside.ok_or("it is not a list in brackets")?.trim();
    action.clear();
    for number in inside.split(',').map(str::trim).filter(|_| !inside.is_empty()) {
        let value: f32 = number
            .parse()
            .map_err(|_| format!("{:?} is not a number", start(number)))?;
        if !value.is_finite() {
            return Err(format!("number {} is {value}", action.len()));
        }
        action.push(value);
    }
    match action.len() {
        n if n == expected => Ok(()),
        n => Err(format!("it has {n} numbers")),
    }
}

/// The start of a text, to be shown.
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
        self.tell(env);
        let answer = self.ask()?;
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

    #[test]
    fn answers_are_lists_of_finite_numbers() {
        let mut action = Vec::new();
        assert_eq!(parse("[1, -2.5e-1,3]", 3, &mut action), Ok(()));
        assert_eq!(action, [1.0, -0.25, 3.0]);
        assert_eq!(parse("[]", 0, &mut action), Ok(()));
        for (answer, part) in [
            ("1, 2", "brackets"),
            ("", "brackets"),
            ("[1, 2", "brackets"),
            ("[1]", "it has 1 numbers"),
            ("[]", "it has 0 numbers"),
            ("[1,]", "is not a number"),
            ("[1, NaN]", "number 1 is NaN"),
            ("[[1, 2]]", "is not a number"),
            ("[1, 1e99]", "number 1 is inf"),
        ] {
            let error = parse(answer, 2, &mut action).expect_err(answer);
            assert!(error.contains(part), "{answer}: {error}");
        }
    }
}
