//! A viewer of a running environment: a page on this machine from which users turn the view, pull bodies, pause and change the speed.
//!
//! The page is small. When a browser asks for a picture, it also sends the visitor's actions, and the environment's own renderer draws
//! the picture here. Without requests nothing is drawn. The server listens on the loopback interface only, at an address that cannot be
//! guessed.

mod orbit;
mod server;
mod spring;
mod stage;

use std::io;
use std::time::{Duration, Instant};

use babybench::Env;

use server::{Ask, Server};
use stage::Stage;

/// The longest wait of [`View::attend`].
const AT_MOST: Duration = Duration::from_millis(50);
/// Longest delay that a late viewer makes up for: after a longer one it would race.
const LATE: Duration = Duration::from_millis(100);
/// Time after its last request in which a page counts as open. Hidden tabs send no requests.
const LOOKS: Duration = Duration::from_secs(2);
/// Shortest time between pictures while steps are due.
const PICTURE: Duration = Duration::from_millis(16);

/// The next thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// A step, and then [`View::stepped`].
    Step,
    /// A new episode, and then [`View::restarted`].
    Reset,
    /// Nothing: time is paused, or the next step is not due.
    Wait,
}

/// A viewer of one environment after another, in real time unless users choose otherwise.
///
/// A program asks [`View::attend`] what to do, does it, and says so.
pub struct View {
    server: Server,
    stage: Stage,
    /// The time at which the next step is due.
    due: Instant,
    /// The time at which the last picture was finished, and its duration.
    drawn: (Instant, Duration),
    waiting: Option<Ask>,
    /// The time of the last request.
    asked: Option<Instant>,
}

impl View {
    /// Opens a viewer at a port of this machine; 0 is any free port. The title is shown above the picture.
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

    /// Returns whether the policy may move the environment; otherwise actions are 0 and users can pull the bodies.
    pub fn moves(&self) -> bool {
        self.stage.moves
    }

    /// Returns whether a page is open. A program that only shows its work need not call [`View::attend`] while none is.
    pub fn watched(&mut self) -> bool {
        if self.waiting.is_none() {
            self.waiting = self.server.ask(Duration::ZERO);
        }
        self.waiting.is_some() || self.asked.is_some_and(|asked| asked.elapsed() < LOOKS)
    }

    /// Answers requests for pictures, carries out the visitors' actions, and returns what the program does next, after at most a twentieth of a
    /// second (plus the time of a picture).
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

    /// Reports a step of `seconds` simulated seconds.
    pub fn stepped(&mut self, env: &mut Env, seconds: f64) {
        let now = Instant::now();
        let lasts = Duration::from_secs_f64((seconds / self.stage.speed).clamp(0.0, 3600.0));
        self.due = (self.due + lasts).max(now.checked_sub(LATE).unwrap_or(now));
        self.stage.spring.pull(env, seconds);
    }

    /// Reports the start of an episode.
    pub fn restarted(&mut self, env: &mut Env) {
        self.stage.spring.let_go(env);
        self.due = Instant::now();
    }

    fn answer(&mut self, env: &mut Env, ask: Ask) {
        let started = Instant::now();
        let was = self.stage.paused;
        let answer = self.stage.answer(env, &ask.words);
        if was && !self.stage.paused || self.stage.single {
            // the pause is over
            self.due = Instant::now();
        }
        self.drawn = (Instant::now(), started.elapsed());
        self.asked = Some(started);
        // a browser that has gone away misses it
        let _ = ask.reply.send(answer);
    }
}
