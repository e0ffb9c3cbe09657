//! States set by a program.

use super::{EnvError, ManualControl, Observation};
use crate::physics::EngineError;

impl<'a> ManualControl<'a> {
    /// Starts an episode from given positions (nq) and velocities (nv) instead of the settled state, without start actions. The task
    /// chooses a goal. MIMo keeps his age regardless of [`Config::age_schedule`](crate::Config::age_schedule), because the positions are those of his
    /// body.
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, or a state from which the simulation diverges. The episode is then over.
    pub fn reset_to(self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'a>, EnvError> {
        let env = self.env;
        env.end_episode();
        env.play().scene.place(qpos, qvel)?;
        env.begin_episode()?;
        Ok(env.observation())
    }

    /// Moves the scene to positions (nq) and velocities (nv) in the middle of an episode, and computes everything there. Time, counters,
    /// information, locks, muscle activations and the start of the solver remain.
    ///
    /// # Errors
    /// As [`ManualControl::reset_to`]. Vectors of wrong length or with numbers that are not finite change nothing.
    pub fn set_state(mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'a>, EnvError> {
        self.set_position(qpos, qvel)?;
        let env = self.env;
        env.senses.forget_picture();
        // the positions are set already, so what was computed belongs to another state
        if let Err(e) = env.physics.forward() {
            env.episode.ready = false;
            return Err(e.into());
        }
        env.sense()?;
        env.judge();
        Ok(env.observation())
    }

    /// Recomputes poses, contacts, forces and senses from the current state, after [`Env::restore`](crate::env::Env::restore) or
    /// changes through [`Env::state_mut`](crate::env::Env::state_mut), and returns the observation.
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
    /// assert_eq!(other.by_hand().refresh()?, env.by_hand().refresh()?);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// A state of wrong lengths, with numbers that are not finite, or from which the simulation diverges, after which
    /// [`Env::reset`](crate::env::Env::reset) is needed; errors of the renderer.
    pub fn refresh(self) -> Result<Observation<'a>, EnvError> {
        let env = self.env;
        // the solver leaves its solution in the state as the start of the next one, so the original start is restored
        env.senses.forget_picture();
        let before = env.physics.state().clone();
        let posed = env.physics.forward();
        env.physics.state_mut().copy_dynamic_from(&before);
        if let Err(e) = posed {
            env.episode.ready = false;
            return Err(e.into());
        }
        let (rng, mut memory) = (env.rng.clone(), Vec::new());
        env.save_memory(&mut memory);
        let sensed = env.sense();
        // sensing again has moved delays and pain on; this takes it back
        env.load_memory(&memory)?;
        // and the noise is that of the next draw
        env.rng = rng;
        sensed?;
        let last = env.episode;
        env.judge();
        // `judge` is for the achieved goal; reward and end stay those of the step
        env.episode = last;
        Ok(env.observation())
    }

    /// Computes everything at positions (nq) and velocities (nv), without sensing it. Time, controls, locks and the start of the solver
    /// remain.
    ///
    /// # Errors
    /// Wrong lengths or numbers that are not finite, which change nothing; a state from which the simulation diverges.
    pub fn forward(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        self.set_position(qpos, qvel)?;
        self.env.senses.forget_picture();
        let forward = self.env.play().scene.forward();
        // a whole state was set, so an environment that diverged is usable again
        self.env.episode.ready = forward.is_ok();
        forward
    }

    /// Sets positions (nq) and velocities (nv) for the next physics step, without computing anything from them.
    ///
    /// # Errors
    /// Wrong lengths or numbers that are not finite, which change nothing.
    pub fn set_position(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.env.blueprint.model();
        check_vector("qpos", qpos, model.nq)?;
        check_vector("qvel", qvel, model.nv)?;
        self.env.physics.check_shape()?;
        let state = self.env.physics.state_mut();
        state.qpos.copy_from_slice(qpos);
        state.qvel.copy_from_slice(qvel);
        Ok(())
    }

    /// Shows the scene at positions (nq) and velocities (nv) as a step: computes poses, contacts and forces there, senses, calls
    /// [`ManualControl::track`], computes outcome and reward, and counts a step in the information. Nothing moves: neither the action nor time
    /// changes positions, and accelerations are those with which the scene would continue from there.
    ///
    /// # Errors
    /// As [`ManualControl::forward`] and [`ManualControl::observe`].
    pub fn show(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        self.env.senses.begin_step();
        self.forward(qpos, qvel)?;
        self.observe()?;
        self.env.finish_step();
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
