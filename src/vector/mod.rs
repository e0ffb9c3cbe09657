//! Vectors of environments: many at once, on all cores.
//!
//! ```
//! use babybench::{Blueprint, Config, VectorEnv, VectorOptions};
//!
//! let config = Config { vision_active: false, touch_active: false, max_episode_steps: 3, ..Config::default() };
//! let mut envs = VectorEnv::new(&Blueprint::new(config)?, 4, VectorOptions::default())?;
//! let mut actions = Vec::new();
//! envs.reset(7)?; // environment i is seeded with 7 + i
//! for _ in 0..5 {
//!     envs.sample_actions(&mut actions)?; // [4, 44]
//!     let batch = envs.step(&actions)?;
//!     assert!(batch.row(3).is_some_and(|observation| observation.vestibular.is_some()));
//!     assert_eq!(batch.observation.vestibular.map(<[f64]>::len), Some(4 * 6));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Environments are independent: each returns the bits that it returns alone, for any number of threads and any batch. With the
//! feature `parallel`, threads step them; without it, the caller does.

mod batch;
mod buffers;
mod error;
mod exchange;
mod infos;
mod layout;
mod look;
mod memory;
pub(crate) mod options;
mod rows;
mod seeds;
mod single;
mod slot;

pub use batch::{EnvFailure, EpisodeEndRows, VectorStep};
pub use buffers::Buffers;
pub use error::VectorError;
pub use infos::Infos;
pub use options::{AutoresetMode, ClippedThreads, ThreadLimit, VectorOptions};
pub use seeds::Seeds;

use crate::config::RendererKind;
use crate::env::{Blueprint, Env, EnvError, space_difference};
use crate::spaces::{BoxSpace, ObservationSpace};
use crate::threads::ThreadPool;
use infos::InfoRows;
use layout::RowLayout;
use memory::MemoryEstimate;
use rows::VectorRows;
use slot::Slot;

/// Many environments, stepped together or in the order in which they finish.
///
/// [`VectorEnv::step`] steps all of them and waits for all. [`VectorEnv::send`] and [`VectorEnv::recv`] are its two halves. The first
/// environment that is ready returns first, so a slow one does not hold up the others:
///
/// ```
/// use babybench::{Blueprint, Config, VectorEnv, VectorOptions};
///
/// let config = Config { vision_active: false, touch_active: false, ..Config::default() };
/// let mut envs = VectorEnv::new(&Blueprint::new(config)?, 4, VectorOptions::default())?;
/// let mut actions = Vec::new();
/// envs.reset(0)?;
/// envs.sample_actions(&mut actions)?;
/// envs.send(&actions, &[0, 1, 2, 3])?;
/// for _ in 0..10 {
///     let batch = envs.recv(2)?; // any two
///     let ids = [batch.ids[0], batch.ids[1]];
///     envs.send(&vec![0.1; 2 * 44], &ids)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias("AsyncVectorEnv", "EnvPool"))]
pub struct VectorEnv {
    /// The environments; those in flight are with the pool.
    slots: Vec<Option<Box<Slot>>>,
    pool: ThreadPool<Slot>,
    in_flight: usize,
    /// Number of calls of `send`, to detect an environment that is named twice.
    sends: u64,
    threads: usize,
    clipped: Option<ClippedThreads>,
    autoreset: AutoresetMode,
    /// Whether the eyes of all environments are drawn together.
    deferred: bool,
    /// Whether the eyes of environments are drawn on request.
    lazy: bool,
    /// Whether the rows are still without pictures.
    unseen: bool,
    layout: RowLayout,
    action_space: BoxSpace,
    observation_space: Vec<ObservationSpace>,
    ids: Vec<usize>,
    rows: VectorRows,
    infos: InfoRows,
    finals: Option<EpisodeEnds>,
    failures: Vec<EnvFailure>,
}

/// The ends of episodes, with [`AutoresetMode::SameStep`].
struct EpisodeEnds {
    ended: Vec<bool>,
    rows: VectorRows,
    infos: InfoRows,
}

impl std::fmt::Debug for VectorEnv {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VectorEnv")
            .field("len", &self.len())
            .field("in_flight", &self.in_flight)
            .field("threads", &self.threads)
            .finish_non_exhaustive()
    }
}

impl VectorEnv {
    /// Makes `n` environments of one blueprint. With [`body_random`](crate::config::IndividualOptions::random) each has another infant of the
    /// population: environment i that of [`Blueprint::with_body_number`], i after the blueprint's.
    ///
    /// # Errors
    /// No environments, or more than memory holds; errors of [`Blueprint::env`]; a thread that the system cannot start; infants whose
    /// spaces differ, as those of touch do without [`touch_grows`](crate::Config::touch_grows).
    pub fn new(blueprint: &Blueprint, n: usize, options: VectorOptions) -> Result<Self, VectorError> {
        if blueprint.config().individual.random == 0.0 {
            return Self::build(n, |_| blueprint, options);
        }
        // before any infant is compiled
        Self::check_memory(blueprint, n, options)?;
        let first = blueprint.config().individual.number;
        let infant = |(env, number)| blueprint.with_body_number(number).map_err(of(env));
        let infants = (0..n).zip(first..).map(infant).collect::<Result<Vec<_>, _>>()?;
        Self::from_blueprints(&infants, options)
    }

    /// Makes one environment of each blueprint. Scenes, behaviors and seeds may differ, but the spaces may not.
    ///
    /// # Errors
    /// As [`VectorEnv::new`]; spaces that differ.
    pub fn from_blueprints(blueprints: &[Blueprint], options: VectorOptions) -> Result<Self, VectorError> {
        Self::build(blueprints.len(), |env| &blueprints[env], options)
    }

    /// Refuses a number of environments that would not fit into memory, without creating them. Call it before creating lists of that length;
    /// [`VectorEnv::new`] and [`VectorEnv::from_blueprints`] do it themselves.
    ///
    /// # Errors
    /// None or more than memory holds; errors of [`Blueprint::env`].
    pub fn check_memory(blueprint: &Blueprint, n: usize, options: VectorOptions) -> Result<(), VectorError> {
        if n == 0 {
            return Err(VectorError::NoEnvironments);
        }
        let first = make(blueprint).map_err(of(0))?;
        MemoryEstimate::of(&first, &RowLayout::new([&first]), &options, n).check(n, options.max_memory)
    }

    fn build<'b>(
        n: usize,
        blueprint: impl Fn(usize) -> &'b Blueprint,
        options: VectorOptions,
    ) -> Result<Self, VectorError> {
        if n == 0 {
            return Err(VectorError::NoEnvironments);
        }
        let make = |env: usize| make(blueprint(env)).map_err(of(env));
        let first = make(0)?;
        let mode = options.autoreset;
        MemoryEstimate::of(&first, &RowLayout::new([&first]), &options, n).check(n, options.max_memory)?;
        let envs = alike(first, n, make)?;
        let deferred = envs.iter().all(on_gpu);
        let lazy = envs.iter().any(|env| env.senses().vision_is_lazy());
        let layout = RowLayout::new(&envs);
        let (action_space, observation_space) = (envs[0].action_space().clone(), envs[0].observation_space());
        let slots = envs.into_iter().enumerate().map(|(index, mut env)| {
            env.senses_mut().defer_vision(deferred);
            Some(Box::new(Slot::new(index, env, mode)))
        });
        let (threads, clipped) = options::threads(options.threads, n);
        Ok(Self {
            slots: slots.collect(),
            // a vector of one thread uses only the caller's
            pool: ThreadPool::new(if threads > 1 { threads } else { 0 }, n)?,
            in_flight: 0,
            sends: 0,
            threads,
            clipped,
            autoreset: mode,
            deferred,
            lazy,
            unseen: false,
            layout,
            action_space,
            observation_space,
            ids: (0..n).collect(),
            rows: VectorRows::new(n, layout),
            infos: InfoRows::new(n, layout),
            finals: (mode == AutoresetMode::SameStep).then(|| EpisodeEnds {
                ended: vec![false; n],
                rows: VectorRows::new(n, layout),
                infos: InfoRows::new(n, layout),
            }),
            failures: Vec::with_capacity(n),
        })
    }

    /// Returns the number of environments.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Always false: a vector holds at least one environment.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Returns the number of threads that step environments.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Returns the reason why there are fewer threads than requested, if there are.
    pub fn clipped_threads(&self) -> Option<ClippedThreads> {
        self.clipped
    }

    /// Returns when the next episode starts.
    pub fn autoreset(&self) -> AutoresetMode {
        self.autoreset
    }

    /// Returns the number of environments that were sent and have not been received.
    pub fn in_flight(&self) -> usize {
        self.in_flight
    }

    /// Returns the rows of the last step, reset or [`VectorEnv::recv`].
    pub fn batch(&self) -> VectorStep<'_> {
        let n = self.ids.len();
        VectorStep {
            ids: &self.ids,
            observation: self.rows.observation(n, !self.unseen),
            rewards: &self.rows.rewards()[..n],
            terminated: &self.rows.terminated()[..n],
            truncated: &self.rows.truncated()[..n],
            infos: self.infos(),
            finals: self.finals(),
            failures: &self.failures,
        }
    }

    /// Returns the information of the last step.
    pub fn infos(&self) -> Infos<'_> {
        self.infos.infos(self.ids.len())
    }

    /// Returns the ends of episodes in the last step, with [`AutoresetMode::SameStep`].
    pub fn finals(&self) -> Option<EpisodeEndRows<'_>> {
        let n = self.ids.len();
        self.finals.as_ref().map(|ends| EpisodeEndRows {
            ended: &ends.ended[..n],
            observation: ends.rows.observation(n, true),
            infos: ends.infos.infos(n),
        })
    }

    /// Returns the environments that could not continue in the last step.
    pub fn failures(&self) -> &[EnvFailure] {
        &self.failures
    }
}

/// Creates an environment for a vector.
fn make(blueprint: &Blueprint) -> Result<Env, EnvError> {
    let mut env = blueprint.env()?;
    env.senses_mut().set_vision_threads(1); // the vector has threads of its own
    // a GPU draws the eyes after all have stepped, so each environment keeps its poses until then
    if !on_gpu(&env) {
        env.share();
    }
    Ok(env)
}

/// Returns whether a GPU draws the eyes.
fn on_gpu(env: &Env) -> bool {
    env.senses().vision().is_some() && env.config().renderer == RendererKind::Wgpu
}

/// Creates the environments after the first. Their spaces must equal the first's.
fn alike(first: Env, n: usize, make: impl Fn(usize) -> Result<Env, VectorError>) -> Result<Vec<Env>, VectorError> {
    let spaces = first.observation_space();
    let mut envs = vec![first];
    for env in 1..n {
        let made = make(env)?;
        if let Some((what, expected, found)) = space_difference(envs[0].action_space(), &spaces, &made) {
            return Err(VectorError::Spaces {
                env,
                what,
                expected,
                found,
            });
        }
        envs.push(made);
    }
    Ok(envs)
}

/// Adds the number of the environment to an error.
fn of(env: usize) -> impl FnOnce(EnvError) -> VectorError {
    move |source| VectorError::Env {
        env,
        source: Box::new(source),
    }
}
