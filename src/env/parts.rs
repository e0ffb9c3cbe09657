//! The parts of a reset and of a step, one by one, for environments that put them together in another way.

use super::check_vector;
use super::outcome::clear;
use crate::env::{Env, EnvError};

impl Env {
    /// Forgets the past as MuJoCo's `mj_resetData` does: time and controls are 0, positions are `qpos0`, velocities are 0 and the
    /// actuators rest. Nothing is computed there: [`Env::forward`] does that. Delays and pain forget the past. Counters and
    /// information stay.
    ///
    /// Under `compat: reference` a reset of the environment is this, [`Env::forward`] at the settled state, and the start actions.
    pub fn reset_data(&mut self) {
        let (mut scene, _) = self.play();
        scene.forget();
        scene.reset_actuators();
        self.motor.rest();
        self.senses.reset();
    }

    /// Computes everything at positions (nq) and velocities (nv), without sensing it. Time, controls, locks and the start of the
    /// solver stay.
    ///
    /// # Errors
    /// Wrong lengths or numbers that are not finite, which change nothing; a state from which the simulation diverges.
    pub fn forward(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        self.set_position(qpos, qvel)?;
        let forward = self.physics.engine.forward(&mut self.physics.state);
        self.episode.ready = forward.is_ok();
        Ok(forward?)
    }

    /// Sets positions (nq) and velocities (nv) for the next physics step, without computing anything there.
    ///
    /// # Errors
    /// Wrong lengths or numbers that are not finite, which change nothing.
    pub fn set_position(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        check_vector("qpos", qpos, model.nq)?;
        check_vector("qvel", qvel, model.nv)?;
        self.physics.check_shape()?;
        self.physics.state.qpos.copy_from_slice(qpos);
        self.physics.state.qvel.copy_from_slice(qvel);
        Ok(())
    }

    /// Gives an action, clipped to the action space, to the actuators, or to the delay on their way.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which changes nothing.
    pub fn set_action(&mut self, action: &[f32]) -> Result<(), EnvError> {
        self.check_action(action)?;
        self.physics.check_shape()?;
        let model = self.blueprint.model();
        let action = self.motor.pass(action);
        self.actuation.set_action(model, &mut self.physics.state, action);
        Ok(())
    }

    /// Updates the actuators, as before each physics step of a step but the first.
    pub fn substep(&mut self) {
        if self.physics.check_shape().is_err() {
            return; // the physics step that follows says so
        }
        let model = self.blueprint.model();
        self.actuation.substep(model, &mut self.physics.state);
    }

    /// Advances by one physics step, without sensing.
    ///
    /// # Errors
    /// A simulation that diverged.
    pub fn physics_step(&mut self) -> Result<(), EnvError> {
        let stepped = self.physics.engine.step(&mut self.physics.state);
        self.episode.ready &= stepped.is_ok();
        Ok(stepped?)
    }

    /// Senses the state: computes [`Env::observation`] anew. Noise is drawn anew, and delays take it for a further step.
    ///
    /// # Errors
    /// As the renderer.
    pub fn observe(&mut self) -> Result<(), EnvError> {
        self.sense()
    }

    /// Counts what the behavior counts, in [`Env::info`].
    pub fn track(&mut self) {
        if self.physics.check_shape().is_err() {
            return; // the next step says so
        }
        self.task.count(&self.physics.state, &mut self.info);
        self.task.describe(Some(&self.physics.state), &mut self.info);
    }

    /// Clears what the behavior has counted.
    pub fn clear_info(&mut self) {
        clear(&*self.task, self.blueprint.config(), &mut self.info);
    }
}
