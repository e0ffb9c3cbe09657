//! Pictures of environments that draw them when somebody asks for them.

use super::exchange::panicked;
use super::slot::Order;
use super::{Batch, Buffers, VectorEnv, VectorError, of};
use crate::env::draw_eyes;

impl VectorEnv {
    /// Draws what the eyes of the environments in the last batch see, on all threads, where that waits for somebody who asks
    /// ([`Config::vision_lazy`](crate::Config::vision_lazy)), and returns the batch with it. Otherwise the batch is as it was. An episode that
    /// has ended in [`AutoresetMode::SameStep`](super::AutoresetMode) has drawn its last picture.
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
    /// An environment of the batch that has been sent on; one that panicked; as the renderer.
    pub fn look(&mut self) -> Result<Batch<'_>, VectorError> {
        let mut rows = std::mem::take(&mut self.rows);
        let looked = self.look_for(&mut rows.buffers());
        self.rows = rows;
        looked?;
        Ok(self.batch())
    }

    /// Draws as [`VectorEnv::look`] does, and writes the images into the caller's memory, which has a row for each environment of the last
    /// batch. What else is in it stays as it is.
    ///
    /// # Errors
    /// As [`VectorEnv::look`]; memory of another shape.
    pub fn look_into(&mut self, mut buffers: Buffers<'_>) -> Result<(), VectorError> {
        buffers.check(self.ids.len(), &self.layout)?;
        self.look_for(&mut buffers)
    }

    /// Returns whether pictures wait for [`VectorEnv::look`].
    pub fn unseen(&self) -> bool {
        self.unseen
    }

    fn look_for(&mut self, out: &mut Buffers<'_>) -> Result<(), VectorError> {
        if !self.lazy {
            return Ok(());
        }
        // rows stand in the order in which environments came back: the lowest number is the same with any number of threads
        let away = self.ids.iter().filter(|&&env| self.slots[env].is_none()).min();
        if let Some(&env) = away {
            return Err(VectorError::InFlight { env });
        }
        if self.deferred {
            self.look_together()?;
        } else if self.in_flight == 0 {
            self.look_on_threads()?;
        } else {
            // those in flight come back through the same queue: it is not for others now
            for &env in &self.ids {
                let Some(slot) = &mut self.slots[env] else { continue };
                slot.env.look().map_err(of(env))?;
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

    /// Lets one renderer draw the eyes of all.
    fn look_together(&mut self) -> Result<(), VectorError> {
        let (ids, slots) = (&self.ids, self.slots.iter_mut().flatten());
        let envs = slots.filter(|slot| slot.env.ready() && ids.contains(&slot.index));
        let first = ids.first().copied().unwrap_or_default();
        draw_eyes(envs.map(|slot| &mut slot.env)).map_err(of(first))
    }

    /// Lets each environment draw its eyes, on the threads that step them.
    fn look_on_threads(&mut self) -> Result<(), VectorError> {
        let slots = &mut self.slots;
        let waiting = self.ids.iter().filter_map(|&env| {
            let mut slot = slots[env].take()?;
            slot.order = Order::Look;
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
