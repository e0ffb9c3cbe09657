//! A viewer of environments that live: a page on this machine, and the environment behind it, which people turn, pull, stop and hurry.
//!
//! The page is small: pictures are drawn here, by the environment's own renderer, when a browser asks for one, and what people do
//! comes with the question. Nobody asks: nothing is drawn. It listens on the loopback interface alone, at an address that cannot be guessed.

mod orbit;
mod server;
mod spring;
mod stage;

use std::io;
use std::time::{Duration, Instant};

use babybench::Env;

use server::{Ask, Server};
use stage::Stage;

/// How long [`View::attend`] waits at most.
const AT_MOST: Duration = Duration::from_millis(50);
/// Longest delay that a late viewer catches up with: after a longer one it would race.
const LATE: Duration = Duration::from_millis(100);
/// How long after its last question a page still looks: hidden tabs do not ask.
const LOOKS: Duration = Duration::from_secs(2);
/// Pictures do not follow each other faster while steps are due.
const PICTURE: Duration = Duration::from_millis(16);

/// The next thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// A step, and then [`View::stepped`].
    Step,
    /// A new episode, and then [`View::restarted`].
    Reset,
    /// Nothing: time stands, or it is not time yet.
    Wait,
}

/// A viewer of one environment after the other, in real time unless people say otherwise.
///
/// A program asks [`View::attend`] what to do, does it, and says so.
pub struct View {
    server: Server,
    stage: Stage,
    /// When the next step is due.
    due: Instant,
    /// When the last picture was finished, and how long it took.
    drawn: (Instant, Duration),
    waiting: Option<Ask>,
    /// When somebody last asked.
    asked: Option<Instant>,
}

impl View {
    /// Opens a viewer at a port of this machine; 0 is any that is free. The title stands above the picture.
    ///
    /// # Errors
    /// The port is taken.
    pub fn open(port: u16, title: &str) -> io::Result<Self> {
        let now = Instant::now();
        Ok(Self {
            server: Server::open(port)?,
            stage: Stage::new(title),
            due: now,
            drawn: (now, Duration::ZERO),
            waiting: None,
            asked: None,
        })
    }

    /// Returns the address of the page.
    pub fn url(&self) -> String {
        self.server.url()
    }

    /// Returns whether the policy may move the environment; actions are 0 otherwise, and it can be pulled about.
    pub fn moves(&self) -> bool {
        self.stage.moves
    }

    /// Returns whether somebody looks. A program that only lets people look over its shoulder need not [`View::attend`] otherwise.
    pub fn watched(&mut self) -> bool {
        if self.waiting.is_none() {
            self.waiting = self.server.ask(Duration::ZERO);
        }
        self.waiting.is_some() || self.asked.is_some_and(|asked| asked.elapsed() < LOOKS)
    }

    /// Shows the environment to those who ask, does what they want, and says what is next, after a twentieth of a second at most (and the time
    /// that a picture takes).
    pub fn attend(&mut self, env: &mut Env) -> Next {
        let until = Instant::now() + AT_MOST;
        loop {
            if std::mem::take(&mut self.stage.reset) {
                return Next::Reset;
            }
            let now = Instant::now();
            let stands = self.stage.paused && !self.stage.single;
            let due = !stands && now >= self.due;
            // late steps and pictures take turns
            let turn = !due || now >= self.drawn.0 + self.drawn.1.max(PICTURE);
            if turn && let Some(ask) = self.waiting.take().or_else(|| self.server.ask(Duration::ZERO)) {
                self.answer(env, ask);
                continue;
            }
            if due {
                self.stage.single = false;
                return Next::Step;
            }
            if now >= until {
                return Next::Wait;
            }
            let wait = if stands { until } else { until.min(self.due) };
            self.waiting = self.server.ask(wait.saturating_duration_since(now));
        }
    }

    /// Says that a step of `seconds` simulated seconds has been taken.
    pub fn stepped(&mut self, env: &mut Env, seconds: f64) {
        let now = Instant::now();
        let lasts = Duration::from_secs_f64((seconds / self.stage.speed).clamp(0.0, 3600.0));
        self.due = (self.due + lasts).max(now.checked_sub(LATE).unwrap_or(now));
        self.stage.spring.pull(env, seconds);
    }

    /// Says that an episode has begun.
    pub fn restarted(&mut self, env: &mut Env) {
        self.stage.spring.let_go(env);
        self.due = Instant::now();
    }

    fn answer(&mut self, env: &mut Env, ask: Ask) {
        let started = Instant::now();
        let was = self.stage.paused;
        let answer = self.stage.answer(env, &ask.words);
        if was && !self.stage.paused || self.stage.single {
            // the time that stood is over
            self.due = Instant::now();
        }
        self.drawn = (Instant::now(), started.elapsed());
        self.asked = Some(started);
        // a browser that has gone away misses it
        let _ = ask.reply.send(answer);
    }
}
