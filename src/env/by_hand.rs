//! Resets and steps that a program composes itself.

use super::outcome::clear;
use super::task::ActionTiming;
use super::{Env, EnvError, EnvProbe, EnvStage, Observation, Snapshot, Task, check_vector};
use crate::math::{Quat, Vec3};
use crate::physics::Probe;
use crate::spaces::NumpyRng;

/// The parts of resets and steps of an environment, one by one: [`Env::by_hand`].
///
/// An [`Env::step`] without delays, noise or a task with a reward is:
///
/// ```
/// use babybench::{Config, Env};
///
/// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
/// let (mut whole, mut env) = (Env::new(config.clone())?, Env::new(config)?);
/// whole.reset(Some(0))?;
/// env.reset(Some(0))?;
/// let action = vec![0.2; env.action_space().len()];
/// let frame_skip = env.config().frame_skip;
/// let mut parts = env.by_hand();
/// parts.set_action(&action)?;
/// for k in 0..frame_skip {
///     if k > 0 {
///         parts.substep();
///     }
///     parts.physics_step()?;
/// }
/// parts.observe()?;
/// parts.track();
/// assert_eq!(env.observation(), whole.step(&action)?.observation);
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[derive(Debug)]
pub struct ManualControl<'a> {
    pub(super) env: &'a mut Env,
}

impl Env {
    /// Returns the parts of resets and steps, for programs that combine them differently.
    pub fn by_hand(&mut self) -> ManualControl<'_> {
        ManualControl { env: self }
    }
}

impl<'a> ManualControl<'a> {
    /// Starts an episode as [`Env::reset`] does, with the given start actions, shape (n, len), instead of random ones: each is applied for
    /// one physics step, in every behavior.
    ///
    /// ```
    /// use babybench::config::Behavior;
    /// use babybench::{Config, Env};
    ///
    /// let behavior = Behavior::SelfTouch;
    /// let config = Config { behavior, vision_active: false, ..Config::default() };
    /// let (mut one, mut other) = (Env::new(config.clone())?, Env::new(config)?);
    /// let (mut actions, mut action) = (Vec::new(), Vec::new());
    /// other.by_hand().seed_action_space(7);
    /// for _ in 0..10 {
    ///     other.sample_action(&mut action);
    ///     actions.extend_from_slice(&action);
    /// }
    /// assert_eq!(one.reset(Some(7))?, other.by_hand().reset_with(&actions)?);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// Actions of wrong length or with numbers that are not finite, which change nothing; the simulation diverged.
    pub fn reset_with(self, start_actions: &[f32]) -> Result<Observation<'a>, EnvError> {
        let env = self.env;
        let len = env.action_space().len();
        let (actions, rest) = start_actions.split_at(start_actions.len() - start_actions.len() % len.max(1));
        // the remainder is refused as the short action that it is
        if !rest.is_empty() {
            env.check_action(rest)?;
        }
        let actions = actions.chunks_exact(len.max(1));
        // all are checked before the first acts, so that a bad one changes nothing
        actions.clone().try_for_each(|action| env.check_action(action))?;
        env.grow()?;
        env.end_episode();
        let mut scene = env.play().scene;
        scene.restart()?;
        for action in actions {
            scene.act(action, 1)?;
        }
        env.begin_episode()?;
        Ok(env.observation())
    }

    /// Restores a snapshot like [`Env::restore`], and computes what it does not hold like [`ManualControl::refresh`]: poses, contacts,
    /// touch, pain and images. The rest of the observation remains the original's, so a policy that reads it continues with the same bits.
    /// After [`ManualControl::refresh`] alone the observation is that of the current state, with another acceleration of the head.
    ///
    /// # Errors
    /// Those of [`Env::restore`], which change nothing; those of [`ManualControl::refresh`].
    pub fn resume(self, snapshot: &Snapshot) -> Result<Observation<'a>, EnvError> {
        let env = self.env;
        env.restore(snapshot)?;
        env.by_hand().refresh()?;
        // the values sensed now replace those of the snapshot
        // a picture that is still to be drawn stays so
        let picture = env.senses.picture;
        env.restore(snapshot)?;
        (env.senses.known, env.senses.picture) = (true, picture);
        Ok(env.observation())
    }

    /// Ends the episode and returns how many steps it had. The next step needs a reset.
    pub fn end_episode(&mut self) -> u64 {
        self.env.end_episode()
    }

    /// Resets like MuJoCo's `mj_resetData`: time and controls are 0, positions are `qpos0`, velocities are 0 and the actuators are at rest. Derived
    /// quantities are not computed; [`ManualControl::forward`] does that. Delays and pain are cleared. Counters and information remain.
    ///
    /// Under `compat: reference` a reset of the environment consists of this, [`ManualControl::forward`] at the settled state, and the start
    /// actions.
    pub fn reset_data(&mut self) {
        self.env.senses.forget_picture();
        let mut scene = self.env.play().scene;
        scene.forget();
        // after `forget`, which sets all controls to 0: servos rest at their angles
        scene.actuation.reset(scene.model, scene.state);
        self.env.action_delay.rest();
        let phase = self.env.phase();
        self.env.senses.reset(phase);
    }

    /// Sets the activations ([`act`](crate::physics::State::act)). Those of MIMo's muscles are in the order of the action, each clipped
    /// to [0, 1].
    ///
    /// # Errors
    /// A wrong length (motors and servos have none) or numbers that are not finite, which change nothing.
    pub fn set_activity(&mut self, activity: &[f64]) -> Result<(), EnvError> {
        let state = self.env.physics.state_mut();
        check_vector("activity", activity, state.act.len())?;
        let muscles = !state.muscle_torque.is_empty();
        for (act, &new) in state.act.iter_mut().zip(activity) {
            *act = if muscles { new.clamp(0.0, 1.0) } else { new };
        }
        Ok(())
    }

    /// Passes an action, clipped to the action space, to the actuators, or to the delay before them.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which changes nothing.
    pub fn set_action(&mut self, action: &[f32]) -> Result<(), EnvError> {
        self.env.check_action(action)?;
        self.env.physics.check_shape()?;
        self.env.play().scene.set_action(action, ActionTiming::InStep);
        Ok(())
    }

    /// Updates the actuators, as happens before every physics step of a step except the first.
    pub fn substep(&mut self) {
        if self.env.physics.check_shape().is_err() {
            return; // the next physics step reports it
        }
        self.env.play().scene.substep();
    }

    /// Advances by one physics step, without sensing.
    ///
    /// # Errors
    /// A simulation that diverged.
    pub fn physics_step(&mut self) -> Result<(), EnvError> {
        self.env.senses.forget_picture();
        let stepped = self.env.play().scene.steps(1);
        // a step by hand never makes an environment ready that needs a reset
        self.env.episode.ready &= stepped.is_ok();
        stepped
    }

    /// Senses the state and recomputes [`Env::observation`]. Noise is drawn again, and delays count this as a further step.
    ///
    /// # Errors
    /// Those of the renderer.
    pub fn observe(&mut self) -> Result<(), EnvError> {
        self.env.senses.advance();
        self.env.sense()
    }

    /// Updates the behavior's counters in [`Env::info`].
    pub fn track(&mut self) {
        if self.env.physics.check_shape().is_err() {
            return; // the next step reports it
        }
        self.env.track();
    }

    /// Moves a body with `mocap="true"` to a position (world, m) and an orientation (w, x, y, z, of any nonzero length), from the next step. The body
    /// stays there until it is moved again or a reset returns it to its position in the document. Paths of
    /// [`Config::mocap_motion`](crate::Config::mocap_motion) take precedence: they set the poses of their bodies in every step.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let scene_extra = "<body name='hand' mocap='true' pos='.3 0 .3'><geom size='.03'/></body>".to_owned();
    /// let mut env = Env::new(Config { scene_extra, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let action = vec![0.0; env.action_space().len()];
    /// for k in 0..100 {
    ///     env.by_hand().set_mocap("hand", [0.3 - 0.002 * f64::from(k), 0.0, 0.3], [1.0, 0.0, 0.0, 0.0])?;
    ///     env.step(&action)?;
    /// }
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// A body that does not exist or numbers that are not finite, which change nothing.
    pub fn set_mocap(&mut self, body: &str, pos: Vec3, quat: Quat) -> Result<(), EnvError> {
        let env = &mut *self.env;
        let model = env.blueprint.model();
        let found = model.body(body).and_then(|id| model.body_mocapid[id]);
        let Some(k) = found else {
            return Err(EnvError::Missing {
                what: "body with mocap=\"true\"",
                name: body.to_string(),
                purpose: "set_mocap",
            });
        };
        check_vector("pos", &pos, pos.len())?;
        check_vector("quat", &quat, quat.len())?;
        env.physics.check_shape()?;
        let state = env.physics.state_mut();
        (state.mocap_pos[k], state.mocap_quat[k]) = (pos, quat);
        Ok(())
    }

    /// Returns whether a step may follow: the environment was reset and has not diverged since.
    pub fn ready(&self) -> bool {
        self.env.ready()
    }

    /// Sets whether resets keep the counters and lists of the behavior instead of clearing them.
    pub fn accumulate_info(&mut self, on: bool) {
        self.env.episode.accumulate = on;
    }

    /// Clears the behavior's counters.
    pub fn clear_info(&mut self) {
        let env = &mut *self.env;
        env.task.forget();
        clear(&*env.task, &mut env.info);
    }

    /// Returns the task.
    pub fn task(&self) -> &dyn Task {
        &*self.env.task
    }

    /// Sets the desired goal and recomputes reward and outcome.
    ///
    /// # Errors
    /// A wrong length or numbers that are not finite, which change nothing.
    pub fn set_goal(&mut self, desired: &[f64]) -> Result<(), EnvError> {
        check_vector("desired_goal", desired, self.env.goals.desired.len())?;
        self.env.physics.check_shape()?;
        self.env.goals.desired.copy_from_slice(desired);
        self.env.judge();
        Ok(())
    }

    /// Seeds the generator of [`Env::sample_action`] and of start actions.
    pub fn seed_action_space(&mut self, seed: u64) {
        self.env.rng = NumpyRng::seed(seed);
    }

    /// Moves the generator of random choices to its position after `drawn` numbers.
    #[cfg(all(feature = "eval", feature = "npz"))]
    pub fn draw_from(&mut self, drawn: u64) {
        self.env.rng = NumpyRng::at(self.env.rng.seed_value(), drawn);
    }

    /// Installs or removes a probe that is called when each stage of a step starts and when the step is done.
    pub fn set_probe(&mut self, probe: Option<EnvProbe>) {
        self.env
            .physics
            // a shared engine also steps other environments, whose stages are not for this probe
            .own_engine()
            .set_probe(probe.clone().map(|probe| -> Probe {
                Box::new(move |stage| {
                    // between the physics steps the actuation works
                    probe(Some(stage.map_or(EnvStage::Actuation, EnvStage::Physics)));
                })
            }));
        self.env.probe = probe;
    }
}
