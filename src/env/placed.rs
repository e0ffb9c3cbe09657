//! States set by a program.

use crate::env::{Env, EnvError, Observation};
use crate::physics::EngineError;

impl Env {
    /// Moves the scene to positions (nq) and velocities (nv) in the middle of an episode, and computes everything there. Time, counters,
    /// information, locks, muscle activations and the start of the solver remain.
    ///
    /// # Errors
    /// As [`Env::reset_to`]. Vectors of wrong length or with numbers that are not finite change nothing.
    pub fn set_state(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        self.set_position(qpos, qvel)?;
        self.senses.forget_picture();
        if let Err(e) = self.physics.forward() {
            self.episode.ready = false;
            return Err(e.into());
        }
        self.sense()?;
        self.judge();
        Ok(self.observation())
    }

    /// Recomputes poses, contacts, forces and senses from the current state, after [`Env::restore`] or changes through
    /// [`Env::state_mut`], and returns the observation.
    ///
    /// The next step has the same bits as without this call: time, the start of the solver, the random generator and the memory of
    /// delays, pain and other transforms do not change. Nor do counters, reward and the end of the episode. After a step, poses and
    /// forces are those at the start of its last physics step; here they belong to the current positions. Noise is that of the next draw,
    /// and a delayed sense shows the moment that it would show one step later.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let snapshot = env.snapshot();
    /// let mut other = env.blueprint().env()?;
    /// other.restore(&snapshot)?;
    /// assert!(other.observation().touch.is_none()); // a snapshot does not hold it
    /// assert_eq!(other.refresh()?, env.refresh()?);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// A state of wrong lengths, with numbers that are not finite, or from which the simulation diverges, after which [`Env::reset`] is
    /// needed; errors of the renderer.
    pub fn refresh(&mut self) -> Result<Observation<'_>, EnvError> {
        // the solver leaves its solution in the state as the start of the next one, so the original start is restored
        self.senses.forget_picture();
        let before = self.physics.state().clone();
        let posed = self.physics.forward();
        self.physics.state_mut().copy_dynamic_from(&before);
        if let Err(e) = posed {
            self.episode.ready = false;
            return Err(e.into());
        }
        let (rng, mut memory) = (self.rng.clone(), Vec::new());
        self.save_memory(&mut memory);
        let sensed = self.sense();
        self.load_memory(&memory)?;
        self.rng = rng;
        sensed?;
        let last = self.episode;
        self.judge();
        self.episode = last;
        Ok(self.observation())
    }

    /// Sets positions (nq) and velocities (nv) without computing anything from them.
    pub(super) fn set_position(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        check_vector("qpos", qpos, model.nq)?;
        check_vector("qvel", qvel, model.nv)?;
        self.physics.check_shape()?;
        let state = self.physics.state_mut();
        state.qpos.copy_from_slice(qpos);
        state.qvel.copy_from_slice(qvel);
        Ok(())
    }
}

pub(super) fn check_vector(what: &'static str, values: &[f64], expected: usize) -> Result<(), EnvError> {
    let found = values.len();
    if found != expected {
        return Err(EnvError::StateLength { what, found, expected });
    }
    match values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        Some((index, &value)) => Err(EngineError::NotFinite { what, index, value }.into()),
        None => Ok(()),
    }
}
