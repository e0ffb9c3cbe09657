//! One input, and how it is given to the program.

use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::common::Folder;

/// Memory that the program may have, bytes.
const MEMORY: u64 = 1 << 30;
/// Processor time that it may take, seconds.
const SECONDS: u64 = 5;
/// How long it may wait for something, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Time from which a case is reported as slow while the answers are written anew.
const SLOW: Duration = Duration::from_secs(2);

/// What was said, without how long it took.
fn untimed(said: &str) -> String {
    let lines = said.lines().map(|line| match line.split_once(" us a step") {
        Some((before, _)) => before.rsplit_once(' ').map_or(before, |(text, _)| text),
        None => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A file of a case.
#[derive(Clone)]
pub enum Content {
    /// Contents.
    Bytes(Vec<u8>),
    /// A link to a place.
    Link(&'static str),
    /// A named pipe that nobody writes to.
    Pipe,
    /// A folder.
    Folder,
    /// A file of this many zeros, which takes no room on a disk.
    Zeros(u64),
}

impl<T: AsRef<[u8]>> From<T> for Content {
    fn from(bytes: T) -> Self {
        Self::Bytes(bytes.as_ref().to_vec())
    }
}

/// An input and a command line.
#[derive(Clone)]
pub struct Case {
    pub name: String,
    files: Vec<(String, Content)>,
    arguments: Vec<String>,
    assets: bool,
}

impl Case {
    /// A command line, its words separated by single spaces.
    pub fn new(name: impl Into<String>, arguments: &str) -> Self {
        Self {
            name: name.into(),
            files: Vec::new(),
            arguments: arguments.split(' ').map(str::to_string).collect(),
            assets: false,
        }
    }

    /// Adds an argument that may have spaces.
    pub fn argument(mut self, argument: impl Into<String>) -> Self {
        self.arguments.push(argument.into());
        self
    }

    /// Adds a file.
    pub fn file(mut self, path: &str, content: impl Into<Content>) -> Self {
        self.files.push((path.to_string(), content.into()));
        self
    }

    /// Adds the embedded assets as the folder `assets`, before the files.
    pub fn with_assets(mut self) -> Self {
        self.assets = true;
        self
    }

    fn prepare(&self, folder: &Folder) {
        std::fs::create_dir_all(folder.path()).expect("a folder");
        if self.assets {
            for (name, bytes) in babybench::mimo::embedded().0 {
                folder.file(&format!("assets/{name}"), bytes);
            }
        }
        for (name, content) in &self.files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            let _ = std::fs::remove_file(&path); // one of the assets
            match content {
                Content::Bytes(bytes) => drop(folder.file(name, bytes)),
                Content::Link(to) => std::os::unix::fs::symlink(to, &path).expect("a link"),
                Content::Pipe => {
                    let made = Command::new("mkfifo").arg(&path).status().expect("mkfifo runs");
                    assert!(made.success(), "{}", path.display());
                }
                Content::Folder => std::fs::create_dir_all(&path).expect("a folder"),
                Content::Zeros(n) => {
                    let file = std::fs::File::create(&path).expect("a file");
                    file.set_len(*n).expect("a length");
                }
            }
        }
    }

    /// Runs the program; returns its exit code and what it said: the errors, or, without any, the output.
    pub fn answer(&self) -> String {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let folder = Folder::new(&format!("hostile_{}", NEXT.fetch_add(1, Ordering::Relaxed)));
        self.prepare(&folder);
        let limits = [
            format!("--as={MEMORY}"),
            format!("--cpu={SECONDS}"),
            "--core=0".to_string(),
        ];
        let mut command = Command::new("prlimit");
        command.args(limits).arg("--").arg(env!("CARGO_BIN_EXE_babybench"));
        command.args(&self.arguments).current_dir(folder.path());
        let said = ["out", "err"].map(|name| folder.path().join(name));
        let file = |k: usize| std::fs::File::create(&said[k]).expect("a file");
        let mut child = command
            .env("RUST_BACKTRACE", "0")
            .env("MALLOC_ARENA_MAX", "2") // glibc reserves 64 MiB of the limit for each thread, of which there are as many as processors
            .stdin(Stdio::null())
            .stdout(file(0))
            .stderr(file(1))
            .spawn()
            .expect("prlimit runs");
        let started = Instant::now();
        let status = loop {
            match child.try_wait().expect("a status") {
                Some(status) => break status,
                None if started.elapsed() > PATIENCE => {
                    child.kill().expect("it ends");
                    child.wait().expect("it ends");
                    return "it waits for ever; ended by a signal\n".to_string();
                }
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        if std::env::var_os("UPDATE").is_some() && started.elapsed() > SLOW {
            println!("{}: {:?}", self.name, started.elapsed());
        }
        let [out, err] = said.map(|path| String::from_utf8_lossy(&std::fs::read(path).expect("a file")).into_owned());
        let code = match (status.code(), status.signal()) {
            (Some(code), _) => format!("exit {code}"),
            (None, signal) => format!("ended by the signal {}", signal.unwrap_or_default()),
        };
        let said = untimed(&if err.is_empty() { out } else { err });
        let _ = std::fs::remove_dir_all(folder.path());
        format!("{code}\n{}\n", said.trim_end()).replace(&folder.text(), "DIR")
    }
}
