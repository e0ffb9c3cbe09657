//! The simulation, for a task to inspect and modify.

use super::Goals;
use crate::actuation::{Actuation, Reflexes};
use crate::config::{Compat, Config};
use crate::env::action_delay::ActionDelay;
use crate::env::engines::EngineSource;
use crate::env::paths::Paths;
use crate::env::physics::{EngineCall, LastEngineCall};
use crate::env::{Env, EnvError, Task, check_vector};
use crate::mimo::CHEST;
use crate::mimo::{LockTarget, held_posture, lock};
use crate::model::Model;
use crate::physics::{Engine, EngineError, Params, Shared, State};
use crate::sensors::Touch;
use crate::spaces::NumpyRng;

/// When an action is passed to the delay before the actuators.
#[derive(Clone, Copy)]
pub(crate) enum ActionTiming {
    InStep,
    /// At once, unless `compat: reference` also delays actions of resets.
    InReset,
}

/// Physics steps in which a scene settles before it is used.
const SETTLING_STEPS: u32 = 100;

/// The simulation of an environment, for its task to inspect and modify between physics steps.
pub struct TaskScene<'a> {
    /// The configuration.
    pub config: &'a Config,
    /// The compiled scene.
    pub model: &'a Model,
    /// The state of the scene.
    pub state: &'a mut State,
    /// The generator of the environment's random choices.
    pub rng: &'a mut NumpyRng,
    pub(crate) engine: EngineSource<'a>,
    /// The record of engine calls, if they are recorded.
    pub(crate) last_call: Option<&'a mut LastEngineCall>,
    /// Parameters after a reset.
    pub(crate) base: &'a mut Shared<Params>,
    pub(crate) actuation: &'a dyn Actuation,
    /// Paths of bodies that the engine does not move; empty while the scene settles.
    pub(crate) paths: Option<&'a Paths>,
    /// The delay before the actuators; none while the scene settles.
    pub(crate) delay: Option<&'a mut ActionDelay>,
    /// Loops between the action and the actuators; none without reflexes and while the scene settles.
    pub(crate) reflexes: Option<&'a mut Reflexes>,
    /// The start of episodes: positions and velocities.
    pub(crate) start: [&'a [f64]; 2],
    /// A buffer for a random action.
    pub(crate) action: &'a mut Vec<f32>,
}

impl std::fmt::Debug for TaskScene<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TaskScene")
            .field("config", self.config)
            .finish_non_exhaustive()
    }
}

/// The parts of an environment that a task may read after a step.
#[derive(Clone, Copy)]
pub struct TaskView<'a> {
    /// The compiled scene.
    pub model: &'a Model,
    /// The state of the scene.
    pub state: &'a State,
    /// The sense of touch, if it is active, before transforms.
    pub touch: Option<&'a Touch>,
    /// The actuation model.
    pub actuation: &'a dyn Actuation,
}

impl std::fmt::Debug for TaskView<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("TaskView")
    }
}

/// The scene of an environment together with its task.
pub(crate) struct StagedTask<'a> {
    pub scene: TaskScene<'a>,
    pub task: &'a mut dyn Task,
    pub goals: &'a mut Goals,
    pub applied: &'a mut Vec<f32>,
}

impl Env {
    /// Returns the scene together with its task.
    pub(crate) fn play(&mut self) -> StagedTask<'_> {
        let (engine, state, last_call, base) = self.physics.parts();
        let scene = TaskScene {
            config: self.blueprint.config(),
            model: self.blueprint.model(),
            state,
            rng: &mut self.rng,
            engine,
            last_call,
            base,
            actuation: self.blueprint.actuation(),
            paths: self.blueprint.paths(),
            delay: Some(&mut self.action_delay),
            reflexes: self.reflexes.as_mut(),
            start: [self.blueprint.init_qpos(), self.blueprint.init_qvel()],
            action: &mut self.action,
        };
        StagedTask {
            scene,
            task: &mut *self.task,
            goals: &mut self.goals,
            applied: &mut self.applied,
        }
    }
}

impl<'a> TaskScene<'a> {
    /// Returns positions (nq) and velocities (nv) of the settled state; those of `qpos0` at rest while the scene settles.
    pub fn start(&self) -> [&'a [f64]; 2] {
        self.start
    }

    /// Resets the scene: time, controls and the start of the solver are 0, the actuators rest, parameters are those of the
    /// blueprint; and computes everything at the settled state.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn restart(&mut self) -> Result<(), EnvError> {
        let [qpos, qvel] = self.start;
        self.place(qpos, qvel)
    }

    /// Resets the scene as [`TaskScene::restart`] does, and computes everything at positions (nq) and velocities (nv).
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, or a state from which the simulation diverges.
    pub fn place(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        check_vector("qpos", qpos, self.model.nq)?;
        check_vector("qvel", qvel, self.model.nv)?;
        self.forget();
        let reference = self.config.compat == Compat::Reference;
        if reference {
            // the reference resets its actuators before it sets the state
            self.actuation.reset(self.model, self.state);
        }
        self.state.qpos.copy_from_slice(qpos);
        self.state.qvel.copy_from_slice(qvel);
        if !reference {
            self.actuation.reset(self.model, self.state);
        }
        self.forward()
    }

    /// Resets the state to `qpos0` at rest without computing anything from it. Actuators do not change.
    pub(crate) fn forget(&mut self) {
        if let Some(delay) = &mut self.delay {
            delay.clear();
        }
        if let Some(reflexes) = &mut self.reflexes {
            reflexes.clear();
        }
        if self.engine.reader().check_shape(self.state).is_err() {
            // a program may have cleared a vector; a state to be reset need not be complete
            *self.state = self.engine.reader().new_state();
            self.actuation.prepare(self.model, self.state);
        }
        let s = &mut *self.state;
        s.time = 0.0;
        s.step = 0;
        s.ctrl.fill(0.0);
        s.qfrc_applied.fill(0.0);
        s.release_forces();
        s.qacc_warmstart.fill(0.0);
        s.params.clone_from(self.base);
        s.qpos.copy_from_slice(&self.model.qpos0);
        s.qvel.fill(0.0);
        s.rest_mocap(self.model);
        if let Some(paths) = self.paths {
            paths.place(s);
        }
    }

    /// Computes everything that follows from positions, velocities and controls.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn forward(&mut self) -> Result<(), EnvError> {
        if let Some(last_call) = &mut self.last_call {
            last_call.note(EngineCall::Forward, self.state);
        }
        Ok(self.engine.lend(|engine| engine.forward(self.state))?)
    }

    /// Passes an action, of the length of the action space, to the actuators, and takes physics steps.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn act(&mut self, action: &[f32], steps: u32) -> Result<(), EnvError> {
        self.set_action(action, ActionTiming::InReset);
        self.advance(steps)
    }

    /// Passes an action to the actuators, through the delay before them.
    pub(crate) fn set_action(&mut self, action: &[f32], passed: ActionTiming) {
        let action = match (&mut self.delay, passed) {
            (Some(delay), ActionTiming::InStep) => delay.pass(action, self.rng),
            (Some(delay), ActionTiming::InReset) => delay.pass_in_reset(action, self.rng),
            (None, _) => action,
        };
        match &mut self.reflexes {
            // reflexes pass it on with their commands in each physics step
            Some(reflexes) => reflexes.take_action(action),
            None => self.actuation.set_action(self.model, self.state, action),
        }
    }

    /// Updates the actuators before each physics step of an environment step but the first.
    pub(crate) fn substep(&mut self) {
        if self.reflexes.is_none() {
            self.actuation.substep(self.model, self.state);
        }
    }

    /// Takes physics steps, and updates the actuators before each one except the first. Under `compat: reference`, MIMo 3's actuators are also
    /// updated before the first one.
    pub(crate) fn advance(&mut self, steps: u32) -> Result<(), EnvError> {
        self.watched_advance(steps, &mut |_| {})
    }

    /// Takes physics steps like [`TaskScene::advance`], and shows the state after each to `watch`.
    pub(crate) fn watched_advance(&mut self, steps: u32, watch: &mut dyn FnMut(&State)) -> Result<(), EnvError> {
        let first = u32::from(self.config.mimo_version < CHEST || self.config.compat == Compat::Api);
        for k in 0..steps {
            if k >= first {
                self.substep();
            }
            self.steps(1)?;
            watch(self.state);
        }
        Ok(())
    }

    /// Passes the action 0 to the actuators once, and takes physics steps. As in the Python code, the actuators are not updated between
    /// them.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn rest(&mut self, steps: u32) -> Result<(), EnvError> {
        self.action.clear();
        self.action.resize(self.actuation.action_space().len(), 0.0);
        // taken out for the call, so that its space is used again
        let action = std::mem::take(self.action);
        self.set_action(&action, ActionTiming::InReset);
        *self.action = action;
        self.steps(steps)
    }

    /// Takes physics steps. Actuators are not updated.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn steps(&mut self, steps: u32) -> Result<(), EnvError> {
        let (state, paths, last_call) = (&mut *self.state, self.paths, &mut self.last_call);
        let (model, actuation) = (self.model, self.actuation);
        let (reflexes, rng) = (&mut self.reflexes, &mut *self.rng);
        let mut step = |engine: &mut dyn Engine| -> Result<(), EngineError> {
            if let Some(reflexes) = reflexes {
                reflexes.drive(model, state, actuation, rng);
            }
            if let Some(paths) = paths {
                paths.place(state);
            }
            if let Some(last_call) = last_call {
                last_call.note(EngineCall::Step, state);
            }
            engine.step(state)?;
            if let Some(reflexes) = reflexes {
                reflexes.sense(model, state);
            }
            Ok(())
        };
        // one engine for all steps: its memory is warm in the cache
        let stepped = self.engine.lend(|engine| (0..steps).try_for_each(|_| step(engine)));
        Ok(stepped?)
    }

    /// Locks a joint at an angle, rad, in every episode; with `now`, also at once.
    ///
    /// # Errors
    /// A joint that does not exist or cannot be locked.
    pub fn lock(&mut self, joint: &str, angle: f64, now: bool) -> Result<(), EnvError> {
        lock(self.model, self.base, LockTarget::Name(joint), angle)?;
        if now {
            lock(self.model, &mut self.state.params, LockTarget::Name(joint), angle)?;
        }
        Ok(())
    }

    /// Settles a scene for 100 steps from `qpos0` with the action 0. Muscles keep their initial pull throughout. A MIMo with an age starts in the
    /// posture in which the scene holds him. With proportions that differ from the original's, his legs would otherwise sink too deep into the floor
    /// on their way there.
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn settle(&mut self) -> Result<(), EnvError> {
        // the step that the reference makes before it reads its sensors: it leaves the warm start of the solver
        self.steps(1)?;
        match self.config.age {
            None => self.state.qpos.copy_from_slice(&self.model.qpos0),
            Some(_) => self.state.qpos.copy_from_slice(&held_posture(self.model)),
        }
        self.state.qvel.fill(0.0);
        self.forward()?;
        self.rest(SETTLING_STEPS)
    }
}
