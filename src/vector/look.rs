//! Pictures of environments that draw them on request.

use super::exchange::panicked;
use super::slot::Command;
use super::{Buffers, VectorEnv, VectorError, VectorStep, of};
use crate::env::draw_eyes;

impl VectorEnv {
    /// Draws the pictures of the last batch that have not been drawn yet ([`Config::vision_lazy`](crate::Config::vision_lazy)), on all
    /// threads, and returns the batch with them. Otherwise the batch does not change. An episode that ended in
    /// [`AutoresetMode::SameStep`](super::AutoresetMode) has already drawn its last picture.
    ///
    /// ```
    /// use babybench::{Blueprint, Config, VectorEnv, VectorOptions};
    ///
    /// let config = Config { touch_active: false, vision_lazy: true, ..Config::default() };
    /// let mut envs = VectorEnv::new(&Blueprint::new(config)?, 2, VectorOptions::default())?;
    /// let mut actions = Vec::new();
    /// envs.reset(0)?;
    /// envs.sample_actions(&mut actions)?;
    /// assert!(envs.step(&actions)?.observation.eye_left.is_none());
    /// assert_eq!(envs.look()?.observation.eye_left.map(<[u8]>::len), Some(2 * 64 * 64 * 3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// An environment of the batch that has been sent again, or that panicked; errors of the renderer.
    pub fn look(&mut self) -> Result<VectorStep<'_>, VectorError> {
        let mut rows = std::mem::take(&mut self.rows);
        let looked = self.look_for(&mut rows.buffers());
        self.rows = rows;
        looked?;
        Ok(self.batch())
    }

    /// Draws as [`VectorEnv::look`] does, and writes the images into the caller's buffers, with a row for each environment of the last
    /// batch. Other buffers do not change.
    ///
    /// # Errors
    /// As [`VectorEnv::look`]; buffers of another shape.
    pub fn look_into(&mut self, mut buffers: Buffers<'_>) -> Result<(), VectorError> {
        buffers.check(self.ids.len(), &self.layout)?;
        self.look_for(&mut buffers)
    }

    /// Returns whether there are pictures for [`VectorEnv::look`] to draw.
    pub fn unseen(&self) -> bool {
        self.unseen
    }

    fn look_for(&mut self, out: &mut Buffers<'_>) -> Result<(), VectorError> {
        if !self.lazy {
            return Ok(());
        }
        // rows are in the order in which environments returned; the lowest number does not depend on the number of threads
        let away = self.ids.iter().filter(|&&env| self.slots[env].is_none()).min();
        if let Some(&env) = away {
            return Err(VectorError::InFlight { env });
        }
        if self.deferred {
            self.look_together()?;
        } else if self.in_flight == 0 {
            self.look_on_threads()?;
        } else {
            // environments in flight return through the same queue, so no others may use it now
            for &env in &self.ids {
                let Some(slot) = &mut self.slots[env] else { continue };
                slot.env.senses_mut().look().map_err(of(env))?;
            }
        }
        for (row, &env) in self.ids.iter().enumerate() {
            if let Some(slot) = &self.slots[env] {
                out.write_images(row, &slot.env);
            }
        }
        self.unseen = false;
        Ok(())
    }

    /// Draws the eyes of all environments with one renderer.
    fn look_together(&mut self) -> Result<(), VectorError> {
        let (ids, slots) = (&self.ids, self.slots.iter_mut().flatten());
        let envs = slots.filter(|slot| slot.env.ready() && ids.contains(&slot.index));
        let first = ids.first().copied().unwrap_or_default();
        draw_eyes(envs.map(|slot| &mut slot.env)).map_err(of(first))
    }

    /// Draws the eyes of each environment on the thread that steps it.
    fn look_on_threads(&mut self) -> Result<(), VectorError> {
        let slots = &mut self.slots;
        let waiting = self.ids.iter().filter_map(|&env| {
            let mut slot = slots[env].take()?;
            slot.order = Command::Look;
            Some(slot)
        });
        self.pool.submit(waiting, true);
        self.in_flight = self.ids.len();
        let mut first: Option<(usize, VectorError)> = None;
        while let Some(mut slot) = self.pool.next(self.in_flight) {
            self.in_flight -= 1;
            let env = slot.index;
            let failed = slot.failure.take().map(of(env));
            if let Some(error) = panicked(&slot).or(failed)
                && first.as_ref().is_none_or(|(known, _)| env < *known)
            {
                first = Some((env, error));
            }
            self.slots[env] = Some(slot);
        }
        first.map_or(Ok(()), |(_, error)| Err(error))
    }
}
