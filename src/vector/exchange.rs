//! Resets and steps: environments go to the pool with their commands, and return with their rows.
//!
//! An environment moves to a thread and back by value. An empty slot is in flight, so no call can reach it meanwhile, and no lock is held
//! while it steps.

use super::slot::{Command, Slot};
use super::{Buffers, EnvFailure, Seeds, VectorEnv, VectorError, VectorStep, of};
use crate::env::draw_eyes;
use crate::spaces::ActionNoise;

impl VectorEnv {
    /// Starts an episode in all environments. With one seed, environment i gets `seed + i`.
    ///
    /// # Errors
    /// Environments in flight; a list of seeds of another length; a scene that diverges immediately, after all have been reset.
    pub fn reset<'s>(&mut self, seeds: impl Into<Seeds<'s>>) -> Result<VectorStep<'_>, VectorError> {
        self.reset_some(None, seeds.into())?;
        Ok(self.batch())
    }

    /// Starts an episode in the environments that the mask marks. Returns the rows of all; the others' rows do not change.
    ///
    /// # Errors
    /// As [`VectorEnv::reset`]; a mask of another length.
    pub fn reset_where<'s>(
        &mut self,
        mask: &[bool],
        seeds: impl Into<Seeds<'s>>,
    ) -> Result<VectorStep<'_>, VectorError> {
        self.reset_some(Some(mask), seeds.into())?;
        Ok(self.batch())
    }

    /// Starts an episode in the environments that the mask marks, or in all, and writes the rows of all into the caller's buffers, as
    /// [`VectorEnv::step_into`] does.
    ///
    /// # Errors
    /// As [`VectorEnv::reset_where`]; memory of another shape.
    pub fn reset_into<'s>(
        &mut self,
        mask: Option<&[bool]>,
        seeds: impl Into<Seeds<'s>>,
        mut buffers: Buffers<'_>,
    ) -> Result<(), VectorError> {
        // before anything is submitted: buffers of a wrong shape leave all environments unchanged
        buffers.check(self.len(), &self.layout)?;
        self.submit_resets(mask, seeds.into())?;
        self.collect(&mut buffers)?;
        self.first_failure()
    }

    fn reset_some(&mut self, mask: Option<&[bool]>, seeds: Seeds<'_>) -> Result<(), VectorError> {
        self.submit_resets(mask, seeds)?;
        self.collect_into_rows()?;
        self.first_failure()
    }

    fn submit_resets(&mut self, mask: Option<&[bool]>, seeds: Seeds<'_>) -> Result<(), VectorError> {
        self.check_home()?;
        let n = self.len();
        if let Some(mask) = mask {
            check_length("mask", mask.len(), [n, 1])?;
        }
        if let Seeds::Each(list) = seeds {
            check_length("seeds", list.len(), [n, 1])?;
        }
        // checked above, so the mask has an entry for every environment
        let marked = |env: usize| mask.is_none_or(|mask| mask[env]);
        // lazily: the pool takes each slot as it passes it on, without a list in between
        let slots = self.slots.iter_mut().enumerate().filter(|(env, _)| marked(*env));
        let slots = slots.filter_map(|(env, place)| {
            let mut slot = place.take()?;
            slot.order = Command::Reset(seeds.of(env));
            Some(slot)
        });
        // the caller has nothing to do until all are back, so it runs jobs as well
        self.pool.submit(slots, true);
        self.in_flight = (0..n).filter(|env| marked(*env)).count();
        Ok(())
    }

    /// Returns the first failure as an error.
    fn first_failure(&mut self) -> Result<(), VectorError> {
        if self.failures.is_empty() {
            Ok(())
        } else {
            let EnvFailure { env, error } = self.failures.remove(0);
            Err(of(env)(error))
        }
    }

    /// Applies an action in each environment ((N, len), environment after environment) and waits for all of them.
    ///
    /// # Errors
    /// Actions of wrong shape or with numbers that are not finite, environments in flight or without a reset, which leave everything
    /// untouched; an environment that panicked, after all have been stepped. An environment that diverges is not an error but one of
    /// [`VectorStep::failures`].
    pub fn step(&mut self, actions: &[f32]) -> Result<VectorStep<'_>, VectorError> {
        self.submit_all(actions)?;
        self.collect_into_rows()?;
        Ok(self.batch())
    }

    /// Applies an action in each environment and writes the results into the caller's buffers. The results of [`VectorEnv::infos`],
    /// [`VectorEnv::finals`] and [`VectorEnv::failures`] belong to the same step.
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
    /// As [`VectorEnv::step`]; buffers of another shape.
    pub fn step_into(&mut self, actions: &[f32], mut buffers: Buffers<'_>) -> Result<(), VectorError> {
        buffers.check(self.len(), &self.layout)?;
        self.submit_all(actions)?;
        self.collect(&mut buffers)
    }

    fn submit_all(&mut self, actions: &[f32]) -> Result<(), VectorError> {
        // all checks precede sending, so an error leaves every environment unchanged
        self.check_home()?;
        self.set_actions(actions, None)?;
        self.in_flight = self.slots.len();
        self.pool.submit(self.slots.iter_mut().filter_map(Option::take), true);
        Ok(())
    }

    /// Sends an action to each of the environments ([ids, len]) and returns immediately. Without threads, [`VectorEnv::recv`] steps them.
    ///
    /// # Errors
    /// As [`VectorEnv::step`]; an environment that does not exist or is in flight. On errors nothing is sent.
    pub fn send(&mut self, actions: &[f32], ids: &[usize]) -> Result<(), VectorError> {
        let envs = self.len();
        if let Some(&env) = ids.iter().find(|&&env| env >= envs) {
            return Err(VectorError::Unknown { env, envs });
        }
        self.set_actions(actions, Some(ids))?;
        let slots = ids.iter().filter_map(|&env| self.slots[env].take());
        // the caller returns at once, so all threads are awake
        self.pool.submit(slots, false);
        self.in_flight += ids.len();
        Ok(())
    }

    /// Waits for the first `n` of the sent environments that are ready, and returns a row for each.
    ///
    /// # Errors
    /// More environments than are in flight, or none; an environment that panicked, which is then no longer in flight.
    pub fn recv(&mut self, n: usize) -> Result<VectorStep<'_>, VectorError> {
        // rows are written from slots, and `self` owns both
        let mut rows = std::mem::take(&mut self.rows);
        let received = self.receive(n, &mut rows.buffers());
        self.rows = rows;
        received?;
        Ok(self.batch())
    }

    /// Waits for `n` environments as [`VectorEnv::recv`] does and writes their rows into the caller's buffers of `n` rows. Returns the
    /// ids of the environments, (n).
    ///
    /// # Errors
    /// As [`VectorEnv::recv`]; buffers of another shape.
    pub fn recv_into(&mut self, n: usize, mut buffers: Buffers<'_>) -> Result<&[usize], VectorError> {
        self.check_sent(n)?;
        buffers.check(n, &self.layout)?;
        self.receive(n, &mut buffers)?;
        Ok(&self.ids)
    }

    fn receive(&mut self, n: usize, out: &mut Buffers<'_>) -> Result<(), VectorError> {
        self.check_sent(n)?;
        self.pool.wait_for(n);
        // the panic first, and alone: rows already finished stay in the queue for the next call
        if let Some(slot) = self.pool.take_where(|slot| slot.panicked.is_some()) {
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
        // in the order of environments, not of their return, so the result does not depend on the number of threads
        self.failures.sort_by_key(|f| f.env);
        Ok(())
    }

    /// Seeds the generators of [`VectorEnv::sample_actions`] and of start actions: environment i gets `seed + i`. Under
    /// `compat: reference` no reset does this, as with [`Env::reset`](crate::Env::reset).
    ///
    /// # Errors
    /// Environments in flight.
    pub fn seed_action_spaces(&mut self, seed: u64) -> Result<(), VectorError> {
        self.check_home()?;
        for (env, slot) in (0..).zip(self.slots.iter_mut().flatten()) {
            slot.env.by_hand().seed_action_space(seed.wrapping_add(env));
        }
        Ok(())
    }

    /// Fills `actions` with a random action for each environment, (N, len), from their own generators.
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

    /// Restarts the noise of each environment (where `mask` is true), with a seed drawn from that environment's generator of
    /// [`VectorEnv::sample_actions`].
    ///
    /// # Errors
    /// Environments in flight.
    pub fn start_noises(&mut self, noises: &mut [ActionNoise], mask: Option<&[bool]>) -> Result<(), VectorError> {
        self.check_home()?;
        for (i, (noise, slot)) in noises.iter_mut().zip(self.slots.iter_mut().flatten()).enumerate() {
            if mask.is_none_or(|mask| mask.get(i) == Some(&true)) {
                noise.reset(slot.env.draw_seed());
            }
        }
        Ok(())
    }

    /// Checks actions and assigns them to the environments `ids`, or to all.
    fn set_actions(&mut self, actions: &[f32], ids: Option<&[usize]>) -> Result<(), VectorError> {
        let (n, len) = (ids.map_or(self.len(), <[usize]>::len), self.layout.action);
        check_length("actions", actions.len(), [n, len])?;
        let env_of = |row: usize| ids.map_or(row, |ids| ids[row]);
        let rows = || actions.chunks_exact(len.max(1)).enumerate();
        self.sends += 1;
        for (row, action) in rows() {
            let env = env_of(row);
            // an environment named twice would be in flight the second time; a mark with the number of the call detects it without
            // clearing marks
            let home = self.slots[env].as_mut().filter(|slot| slot.named != self.sends);
            let slot = home.ok_or(VectorError::InFlight { env })?;
            slot.named = self.sends;
            if !slot.can_step() {
                return Err(VectorError::NotReset { env });
            }
            // the quick test for the common case; `check_action` returns the error
            if !action.iter().all(|v| v.is_finite()) {
                slot.env.check_action(action).map_err(of(env))?;
            }
        }
        for (row, action) in rows() {
            if let Some(slot) = &mut self.slots[env_of(row)] {
                slot.order = Command::Step;
                slot.action.clear();
                slot.action.extend_from_slice(action);
            }
        }
        Ok(())
    }

    /// Checks that enough environments are in flight to wait for.
    fn check_sent(&self, wanted: usize) -> Result<(), VectorError> {
        let in_flight = self.in_flight;
        if (1..=in_flight).contains(&wanted) {
            Ok(())
        } else {
            Err(VectorError::NotSent { wanted, in_flight })
        }
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
        // rows are filled from slots, which `self` owns as well: taking the rows avoids a double borrow
        let mut rows = std::mem::take(&mut self.rows);
        let collected = self.collect(&mut rows.buffers());
        self.rows = rows;
        collected
    }

    /// Waits for all environments in flight, helps to run them, and writes a row for each environment.
    fn collect(&mut self, out: &mut Buffers<'_>) -> Result<(), VectorError> {
        self.begin_batch();
        let n = self.len();
        self.ids.extend(0..n);
        let all = self.in_flight == n;
        while let Some(slot) = self.pool.next(self.in_flight) {
            let env = slot.index;
            self.in_flight -= 1;
            self.slots[env] = Some(slot);
            if all && !self.deferred {
                // immediately, while its numbers are in this core's cache and other threads still step
                self.write(env, env, out);
            }
        }
        self.draw_eyes()?;
        // a reset of some environments returns the rows of all, and images drawn together exist only now
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
        self.unseen = self.lazy;
    }

    /// Draws the eyes of all environments of the batch together, if each does not draw its own.
    fn draw_eyes(&mut self) -> Result<(), VectorError> {
        if !self.deferred || self.lazy {
            return Ok(());
        }
        let ids = &self.ids;
        let slots = self.slots.iter_mut().flatten();
        // a diverged environment has no picture to draw
        let envs = slots.filter(|slot| slot.env.ready() && ids.contains(&slot.index));
        let first = ids.first().copied().unwrap_or_default();
        draw_eyes(envs.map(|slot| &mut slot.env)).map_err(of(first))
    }

    /// Writes the results of an environment.
    fn write(&mut self, row: usize, env: usize, out: &mut Buffers<'_>) {
        let Some(slot) = &mut self.slots[env] else { return };
        out.write(row, &slot.env);
        out.write_flags(row, slot.reward, slot.terminated, slot.truncated);
        self.infos.write(row, slot.env.info(), slot.env.goal().terms);
        if let (Some(ends), Some(last)) = (&mut self.finals, &slot.last) {
            ends.ended[row] = slot.ended;
            // the rows of the others keep their contents, which are not read
            if slot.ended {
                ends.rows.buffers().write_whole(row, &last.observation());
                ends.infos.write(row, &last.info, &last.terms);
            }
        }
        if let Some(error) = slot.failure.take() {
            self.failures.push(EnvFailure { env, error });
        }
    }
}

pub(super) fn panicked(slot: &Slot) -> Option<VectorError> {
    slot.panicked.as_ref().map(|message| VectorError::Panicked {
        env: slot.index,
        message: message.clone(),
    })
}

fn check_length(what: &'static str, found: usize, expected: [usize; 2]) -> Result<(), VectorError> {
    if found == expected[0] * expected[1] {
        Ok(())
    } else {
        Err(VectorError::Shape { what, expected, found })
    }
}
