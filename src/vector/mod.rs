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
//!     assert_eq!(batch.observation.proprioception.len(), 4 * batch.row(0).proprioception.len());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every environment goes its own way: what it returns has the same bits as if it were alone, whatever the number of
//! threads and the batch. With the feature `parallel`, threads step them; without, the caller does.

mod batch;
mod error;
mod memory;
mod options;
mod pool;
mod rows;
mod seeds;
mod single;
mod slot;

pub use batch::{Batch, Failure, Finals};
pub use error::VectorError;
pub use options::{AutoresetMode, ClippedThreads, ThreadLimit, VectorOptions};
pub use rows::{Buffers, Infos};
pub use seeds::Seeds;

use crate::config::RendererKind;
use crate::env::{Blueprint, Env, EnvError};
use crate::spaces::{BoxSpace, ObservationSpace};
use pool::Pool;
use rows::{InfoRows, Layout, Rows, Target};
use slot::{Slot, Task};

/// Many environments, stepped together or as they come.
///
/// [`VectorEnv::step`] steps all of them and waits for all. [`VectorEnv::send`] and [`VectorEnv::recv`] do it in two
/// halves, and whoever is ready first is returned first, so that a slow environment does not hold the others:
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
pub struct VectorEnv {
    /// The environments; those in flight are with the pool.
    slots: Vec<Option<Box<Slot>>>,
    pool: Pool,
    in_flight: usize,
    threads: usize,
    clipped: Option<ClippedThreads>,
    autoreset: AutoresetMode,
    /// Whether the eyes of all environments are drawn together.
    deferred: bool,
    layout: Layout,
    action_space: BoxSpace,
    observation_space: Vec<ObservationSpace>,
    ids: Vec<usize>,
    rows: Rows,
    infos: InfoRows,
    finals: Option<Ends>,
    failures: Vec<Failure>,
}

/// The ends of episodes, with [`AutoresetMode::SameStep`].
struct Ends {
    ended: Vec<bool>,
    rows: Rows,
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
    /// Makes `n` environments of one blueprint.
    ///
    /// # Errors
    /// None or more than memory holds; what [`Blueprint::env`] says; the system gives no threads.
    pub fn new(blueprint: &Blueprint, n: usize, options: VectorOptions) -> Result<Self, VectorError> {
        Self::build(n, |_| blueprint, options)
    }

    /// Makes one environment of each blueprint. Scenes, behaviors and seeds may differ, the spaces may not.
    ///
    /// # Errors
    /// As [`VectorEnv::new`]; spaces that differ.
    pub fn from_blueprints(blueprints: &[Blueprint], options: VectorOptions) -> Result<Self, VectorError> {
        Self::build(blueprints.len(), |env| &blueprints[env], options)
    }

    fn build<'b>(
        n: usize,
        blueprint: impl Fn(usize) -> &'b Blueprint,
        options: VectorOptions,
    ) -> Result<Self, VectorError> {
        if n == 0 {
            return Err(VectorError::NoEnvironments);
        }
        let make = |env: usize| -> Result<Env, VectorError> { blueprint(env).env().map_err(of(env)) };
        let first = make(0)?;
        let mode = options.autoreset;
        let each = memory::estimate(&first, &Layout::new([&first]), mode);
        memory::check(n, each, options.max_memory)?;
        let mut envs = vec![first];
        for env in 1..n {
            let made = make(env)?;
            check_spaces(env, &envs[0], &made)?;
            envs.push(made);
        }
        let deferred = envs
            .iter()
            .all(|e| e.vision().is_some() && e.config().renderer == RendererKind::Wgpu);
        let layout = Layout::new(&envs);
        let (action_space, observation_space) = (envs[0].action_space().clone(), envs[0].observation_space());
        let slots = envs.into_iter().enumerate().map(|(index, mut env)| {
            env.defer_vision(deferred);
            Some(Box::new(Slot::new(index, env, mode)))
        });
        let (threads, clipped) = options::threads(options.threads, n);
        Ok(Self {
            slots: slots.collect(),
            pool: Pool::new(threads, n)?,
            in_flight: 0,
            threads,
            clipped,
            autoreset: mode,
            deferred,
            layout,
            action_space,
            observation_space,
            ids: (0..n).collect(),
            rows: Rows::new(n, layout),
            infos: InfoRows::new(n, layout),
            finals: (mode == AutoresetMode::SameStep).then(|| Ends {
                ended: vec![false; n],
                rows: Rows::new(n, layout),
                infos: InfoRows::new(n, layout),
            }),
            failures: Vec::with_capacity(n),
        })
    }

    /// Returns the number of environments.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Returns whether there are no environments, which is never.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Returns the number of threads that step environments.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Returns why there are fewer threads than asked for, if there are.
    pub fn clipped_threads(&self) -> Option<ClippedThreads> {
        self.clipped
    }

    /// Returns when an episode follows another.
    pub fn autoreset(&self) -> AutoresetMode {
        self.autoreset
    }

    /// Returns the number of environments that were sent and have not been received.
    pub fn in_flight(&self) -> usize {
        self.in_flight
    }

    /// Starts an episode in all environments. With one seed, environment i gets `seed + i`.
    ///
    /// # Errors
    /// Environments in flight; a list of seeds of another length; a scene that diverges at once, after all have been
    /// reset.
    pub fn reset<'s>(&mut self, seeds: impl Into<Seeds<'s>>) -> Result<Batch<'_>, VectorError> {
        self.reset_some(None, seeds.into())?;
        Ok(self.batch())
    }

    /// Starts an episode in the environments that the mask marks. Returns the rows of all; those of the others stay.
    ///
    /// # Errors
    /// As [`VectorEnv::reset`]; a mask of another length.
    pub fn reset_where<'s>(&mut self, mask: &[bool], seeds: impl Into<Seeds<'s>>) -> Result<Batch<'_>, VectorError> {
        self.reset_some(Some(mask), seeds.into())?;
        Ok(self.batch())
    }

    fn reset_some(&mut self, mask: Option<&[bool]>, seeds: Seeds<'_>) -> Result<(), VectorError> {
        self.check_home()?;
        let n = self.len();
        if let Some(mask) = mask {
            check_length("mask", mask.len(), [n, 1])?;
        }
        if let Seeds::Each(list) = seeds {
            check_length("seeds", list.len(), [n, 1])?;
        }
        let marked = |env: usize| mask.is_none_or(|mask| mask[env]);
        let slots = self.slots.iter_mut().enumerate().filter(|(env, _)| marked(*env));
        let slots = slots.filter_map(|(env, place)| {
            let mut slot = place.take()?;
            slot.task = Task::Reset(seeds.of(env));
            Some(slot)
        });
        self.pool.submit(slots, true);
        self.in_flight = (0..n).filter(|env| marked(*env)).count();
        self.collect_into_rows()?;
        match self.failures.is_empty() {
            true => Ok(()),
            false => {
                let Failure { env, error } = self.failures.remove(0);
                Err(of(env)(error))
            }
        }
    }

    /// Applies an action in each environment ((N, len), environment after environment) and waits for all of them.
    ///
    /// # Errors
    /// Actions of wrong shape or with numbers that are not finite, environments in flight or without a reset, which leave
    /// everything untouched; an environment that panicked, after all have been stepped. One that diverges is not an error
    /// but among [`Batch::failures`].
    pub fn step(&mut self, actions: &[f32]) -> Result<Batch<'_>, VectorError> {
        self.submit_all(actions)?;
        self.collect_into_rows()?;
        Ok(self.batch())
    }

    /// Applies an action in each environment and writes what it returns into memory of the caller's; what
    /// [`VectorEnv::infos`], [`VectorEnv::finals`] and [`VectorEnv::failures`] return belongs to the same step.
    ///
    /// ```
    /// use babybench::vector::Buffers;
    /// use babybench::{Blueprint, Config, VectorEnv, VectorOptions};
    ///
    /// let config = Config { vision_active: false, touch_active: false, ..Config::default() };
    /// let mut envs = VectorEnv::new(&Blueprint::new(config)?, 2, VectorOptions::default())?;
    /// envs.reset(0)?;
    /// let mut balance = vec![0.0; 2 * 6];
    /// envs.step_into(&[0.1; 2 * 44], Buffers { vestibular: Some(&mut balance), ..Buffers::default() })?;
    /// assert!(balance.iter().any(|v| *v != 0.0) && envs.infos().steps == [1, 1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`VectorEnv::step`]; memory of another shape.
    pub fn step_into(&mut self, actions: &[f32], buffers: Buffers<'_>) -> Result<(), VectorError> {
        buffers.check(self.len(), &self.layout)?;
        self.submit_all(actions)?;
        self.collect(&mut Target::from(buffers))
    }

    fn submit_all(&mut self, actions: &[f32]) -> Result<(), VectorError> {
        self.check_home()?;
        self.set_actions(actions, None)?;
        self.in_flight = self.slots.len();
        self.pool.submit(self.slots.iter_mut().filter_map(Option::take), true);
        Ok(())
    }

    /// Hands environments an action each ([ids, len]) and returns at once. Without threads they are stepped by
    /// [`VectorEnv::recv`].
    ///
    /// # Errors
    /// As [`VectorEnv::step`]; an environment that does not exist or is in flight. Nothing is sent then.
    pub fn send(&mut self, actions: &[f32], ids: &[usize]) -> Result<(), VectorError> {
        let envs = self.len();
        if let Some(&env) = ids.iter().find(|&&env| env >= envs) {
            return Err(VectorError::Unknown { env, envs });
        }
        self.set_actions(actions, Some(ids))?;
        let slots = ids.iter().filter_map(|&env| self.slots[env].take());
        self.pool.submit(slots, false);
        self.in_flight += ids.len();
        Ok(())
    }

    /// Waits for `n` environments that were sent, whichever are ready first, and returns a row for each.
    ///
    /// # Errors
    /// More environments than are in flight, or none; an environment that panicked, which is not in flight any more.
    pub fn recv(&mut self, n: usize) -> Result<Batch<'_>, VectorError> {
        let mut rows = std::mem::take(&mut self.rows);
        let received = self.receive(n, &mut rows.target());
        self.rows = rows;
        received?;
        Ok(self.batch())
    }

    fn receive(&mut self, n: usize, out: &mut Target<'_>) -> Result<(), VectorError> {
        if n == 0 || n > self.in_flight {
            let (wanted, in_flight) = (n, self.in_flight);
            return Err(VectorError::NotSent { wanted, in_flight });
        }
        self.pool.wait_for(n);
        if let Some(slot) = self.pool.take_panicked() {
            self.in_flight -= 1;
            let env = slot.index;
            let error = panicked(&slot);
            self.slots[env] = Some(slot);
            return error.map_or(Ok(()), Err);
        }
        self.begin_batch();
        for _ in 0..n {
            if let Some(slot) = self.pool.take() {
                self.in_flight -= 1;
                let env = slot.index;
                self.ids.push(env);
                self.slots[env] = Some(slot);
            }
        }
        self.draw_eyes()?;
        for row in 0..self.ids.len() {
            self.write(row, self.ids[row], out);
        }
        self.failures.sort_by_key(|f| f.env);
        Ok(())
    }

    /// Seeds the generators of [`VectorEnv::sample_actions`] and of start actions: environment i gets `seed + i`. Under
    /// `compat: reference` no reset does, as with [`Env::reset`].
    ///
    /// # Errors
    /// Environments in flight.
    pub fn seed_action_spaces(&mut self, seed: u64) -> Result<(), VectorError> {
        self.check_home()?;
        for (env, slot) in (0..).zip(self.slots.iter_mut().flatten()) {
            slot.env.seed_action_space(seed.wrapping_add(env));
        }
        Ok(())
    }

    /// Fills `actions` with a random action of each environment, (N, len), from their own generators.
    ///
    /// # Errors
    /// Environments in flight.
    pub fn sample_actions(&mut self, actions: &mut Vec<f32>) -> Result<(), VectorError> {
        self.check_home()?;
        actions.clear();
        for slot in self.slots.iter_mut().flatten() {
            let Slot { env, action, .. } = &mut **slot;
            env.sample_action(action);
            actions.extend_from_slice(action);
        }
        Ok(())
    }

    /// Checks actions and hands them out: to the environments `ids`, or to all.
    fn set_actions(&mut self, actions: &[f32], ids: Option<&[usize]>) -> Result<(), VectorError> {
        let (n, len) = (ids.map_or(self.len(), <[usize]>::len), self.layout.action);
        check_length("actions", actions.len(), [n, len])?;
        let env_of = |row: usize| ids.map_or(row, |ids| ids[row]);
        let rows = || actions.chunks_exact(len.max(1)).enumerate();
        for (row, action) in rows() {
            let env = env_of(row);
            let slot = self.slots[env].as_ref().ok_or(VectorError::InFlight { env })?;
            if !slot.can_step() {
                return Err(VectorError::NotReset { env });
            }
            if !action.iter().all(|v| v.is_finite()) {
                slot.env.check_action(action).map_err(of(env))?;
            }
        }
        if let Some(ids) = ids {
            // an environment that is named twice would be in flight the second time
            let twice = (1..ids.len()).find(|&k| ids[..k].contains(&ids[k]));
            if let Some(k) = twice {
                return Err(VectorError::InFlight { env: ids[k] });
            }
        }
        for (row, action) in rows() {
            if let Some(slot) = &mut self.slots[env_of(row)] {
                slot.task = Task::Step;
                slot.action.clear();
                slot.action.extend_from_slice(action);
            }
        }
        Ok(())
    }

    /// Checks that no environment is in flight.
    fn check_home(&self) -> Result<(), VectorError> {
        if self.in_flight == 0 {
            return Ok(());
        }
        let env = self.slots.iter().position(Option::is_none).unwrap_or(0);
        Err(VectorError::InFlight { env })
    }

    fn collect_into_rows(&mut self) -> Result<(), VectorError> {
        let mut rows = std::mem::take(&mut self.rows);
        let collected = self.collect(&mut rows.target());
        self.rows = rows;
        collected
    }

    /// Waits for all environments in flight, helping to run them, and writes a row for each environment.
    fn collect(&mut self, out: &mut Target<'_>) -> Result<(), VectorError> {
        self.begin_batch();
        let n = self.len();
        self.ids.extend(0..n);
        let all = self.in_flight == n;
        while let Some(slot) = self.pool.next(self.in_flight) {
            let env = slot.index;
            self.in_flight -= 1;
            self.slots[env] = Some(slot);
            if all && !self.deferred {
                // while its numbers are still near
                self.write(env, env, out);
            }
        }
        self.draw_eyes()?;
        if !all || self.deferred {
            for env in 0..n {
                self.write(env, env, out);
            }
        }
        self.failures.sort_by_key(|f| f.env);
        let error = self.slots.iter().flatten().find_map(|slot| panicked(slot));
        error.map_or(Ok(()), Err)
    }

    fn begin_batch(&mut self) {
        self.ids.clear();
        self.failures.clear();
    }

    /// Draws the eyes of all environments of the batch together, if each does not draw its own.
    fn draw_eyes(&mut self) -> Result<(), VectorError> {
        if !self.deferred {
            return Ok(());
        }
        let ids = &self.ids;
        let slots = self.slots.iter_mut().flatten();
        let envs = slots.filter(|slot| slot.env.ready() && ids.contains(&slot.index));
        let first = ids.first().copied().unwrap_or_default();
        Env::draw_eyes(envs.map(|slot| &mut slot.env)).map_err(of(first))
    }

    /// Writes what came of an environment.
    fn write(&mut self, row: usize, env: usize, out: &mut Target<'_>) {
        let Some(slot) = &mut self.slots[env] else { return };
        out.write(row, &slot.env);
        out.write_flags(row, slot.reward, slot.terminated, slot.truncated);
        self.infos.write(row, slot.env.info());
        if let (Some(ends), Some(last)) = (&mut self.finals, &slot.last) {
            ends.ended[row] = slot.ended;
            if slot.ended {
                ends.rows.target().write_whole(row, &last.observation());
                ends.infos.write(row, &last.info);
            }
        }
        if let Some(error) = slot.failure.take() {
            self.failures.push(Failure { env, error });
        }
    }

    /// Returns the rows of the last step, reset or [`VectorEnv::recv`].
    pub fn batch(&self) -> Batch<'_> {
        let n = self.ids.len();
        Batch {
            ids: &self.ids,
            observation: self.rows.observation(n),
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
    pub fn finals(&self) -> Option<Finals<'_>> {
        let n = self.ids.len();
        self.finals.as_ref().map(|ends| Finals {
            ended: &ends.ended[..n],
            observation: ends.rows.observation(n),
            infos: ends.infos.infos(n),
        })
    }

    /// Returns the environments that could not go on in the last step.
    pub fn failures(&self) -> &[Failure] {
        &self.failures
    }
}

/// Says of which environment an error is.
fn of(env: usize) -> impl FnOnce(EnvError) -> VectorError {
    move |source| VectorError::Env {
        env,
        source: Box::new(source),
    }
}

fn panicked(slot: &Slot) -> Option<VectorError> {
    slot.panicked.as_ref().map(|message| VectorError::Panicked {
        env: slot.index,
        message: message.clone(),
    })
}

fn check_length(what: &'static str, found: usize, expected: [usize; 2]) -> Result<(), VectorError> {
    match found == expected[0] * expected[1] {
        true => Ok(()),
        false => Err(VectorError::Shape { what, expected, found }),
    }
}

/// Checks that an environment can share arrays with the first one.
fn check_spaces(env: usize, first: &Env, other: &Env) -> Result<(), VectorError> {
    let differ = |what: &str, expected: String, found: String| {
        let what = what.to_string();
        Err(VectorError::Spaces {
            env,
            what,
            expected,
            found,
        })
    };
    let (a, b) = (first.action_space(), other.action_space());
    if a.len() != b.len() {
        return differ("the action space", format!("[{}]", a.len()), format!("[{}]", b.len()));
    }
    if a != b {
        let bounds = |s: &BoxSpace| {
            s.low()
                .iter()
                .copied()
                .zip(s.high().iter().copied())
                .collect::<Vec<_>>()
        };
        let (a, b) = (bounds(a), bounds(b));
        let k = (0..a.len()).find(|&k| a[k] != b[k]).unwrap_or(0);
        let what = format!("the bounds of action[{k}]");
        return differ(&what, format!("{:?}", a[k]), format!("{:?}", b[k]));
    }
    let (a, b) = (first.observation_space(), other.observation_space());
    let describe = |s: Option<&ObservationSpace>| match s {
        Some(s) => format!("{:?} of {:?} in [{}, {}]", s.shape, s.dtype, s.low, s.high),
        None => "none".to_string(),
    };
    for key in a.iter().chain(&b).map(|s| s.key) {
        let [a, b] = [&a, &b].map(|spaces| spaces.iter().find(|s| s.key == key));
        if a != b {
            return differ(&format!("the observation {key:?}"), describe(a), describe(b));
        }
    }
    Ok(())
}
