//! The environment: Gymnasium's reset and step.

mod behavior;
mod blueprint;
mod error;
mod rng;
mod spaces;

use std::sync::Arc;

pub use behavior::{BehaviorInfo, Info};
pub use blueprint::Blueprint;
pub use error::EnvError;
pub use rng::NumpyRng;
pub use spaces::{BoxSpace, Dtype, ObservationSpace};

use crate::actuation::{self, Actuation};
use crate::config::{Behavior, Compat, Config};
use crate::env::behavior::Watcher;
use crate::model::Model;
use crate::physics::{Engine, Probe, SoftEngine, Stage, State};
use crate::sensors::{Proprioception, Vestibular};

/// Steps with random actions at the start of an episode of `self_touch` and `hand_regard`.
const START_ACTIONS: usize = 10;

/// What MIMo senses. The vectors belong to the environment and change with the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation<'a> {
    /// Proprioception; [`Env::proprioception`] tells what stands where.
    pub observation: &'a [f64],
    /// Linear acceleration (m/s^2) and angular velocity (rad/s) of the head, if `vestibular_active`.
    pub vestibular: Option<&'a [f64]>,
}

/// What a step returns, in Gymnasium's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// The observation.
    pub observation: Observation<'a>,
    /// Always 0: there is no extrinsic reward.
    pub reward: f64,
    /// Always false.
    pub terminated: bool,
    /// Whether the episode has reached `max_episode_steps`.
    pub truncated: bool,
    /// The information.
    pub info: &'a Info,
}

/// A BabyBench environment.
///
/// ```
/// use babybench::{Config, Env};
///
/// let mut env = Env::new(Config { max_episode_steps: 5, ..Config::default() })?;
/// let mut action = Vec::new();
/// env.reset(Some(7))?;
/// loop {
///     env.sample_action(&mut action);
///     let step = env.step(&action)?;
///     assert!(step.observation.observation.iter().all(|v| v.is_finite()));
///     if step.truncated {
///         break;
///     }
/// }
/// assert_eq!(env.info().steps, 5);
/// # Ok::<(), babybench::EnvError>(())
/// ```
pub struct Env {
    blueprint: Blueprint,
    engine: SoftEngine,
    state: State,
    actuation: Box<dyn Actuation>,
    proprioception: Proprioception,
    vestibular: Option<Vestibular>,
    watcher: Watcher,
    rng: NumpyRng,
    info: Info,
    steps: u64,
    ready: bool,
    proprioception_values: Vec<f64>,
    vestibular_values: Vec<f64>,
    action: Vec<f32>,
}

impl Env {
    /// From the embedded assets. Several environments of one configuration are cheaper from one [`Blueprint`].
    ///
    /// # Errors
    /// As [`Blueprint::new`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Blueprint::new(config)?.env()
    }

    fn from_blueprint(blueprint: &Blueprint) -> Result<Self, EnvError> {
        let (config, model) = (blueprint.config(), blueprint.model());
        let engine = blueprint.engine();
        let mut state = engine.new_state();
        state.params.clone_from(blueprint.params());
        let actuation = actuation::build(model, config).ok_or_else(|| EnvError::NotAvailable {
            key: "actuation_model",
            value: config.actuation_model.name().to_string(),
            available: actuation::AVAILABLE,
        })?;
        let proprioception = Proprioception::new(model, config, actuation.observation_len());
        let vestibular = config.vestibular_active.then(|| Vestibular::new(model));
        Ok(Self {
            proprioception_values: vec![0.0; proprioception.len()],
            vestibular_values: vec![0.0; vestibular.as_ref().map_or(0, Vestibular::len)],
            watcher: Watcher::new(model, config.behavior, config.compat)?,
            rng: NumpyRng::seed(config.seed),
            action: Vec::with_capacity(actuation.action_space().len()),
            info: Info::default(),
            steps: 0,
            ready: false,
            blueprint: blueprint.clone(),
            engine,
            state,
            actuation,
            proprioception,
            vestibular,
        })
    }

    /// Starts an episode: the settled state, then, for `self_touch` and `hand_regard`, ten physics steps with random
    /// actions. The information of a reset is empty.
    ///
    /// Under `compat: api` a seed reseeds every random choice. Under `compat: reference` it is ignored, as the start
    /// actions come from the generator of the action space: see [`Env::seed_action_space`].
    ///
    /// # Errors
    /// The simulation diverged.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<Observation<'_>, EnvError> {
        if let (Some(seed), Compat::Api) = (seed, self.config().compat) {
            self.seed_action_space(seed);
        }
        let settled = self.blueprint.clone();
        self.place(settled.init_qpos(), settled.init_qvel())?;
        if self.blueprint.config().behavior != Behavior::None {
            for _ in 0..START_ACTIONS {
                self.actuation.action_space().sample(&mut self.rng, &mut self.action);
                self.actuation
                    .set_action(self.blueprint.model(), &mut self.state, &self.action);
                self.engine.step(&mut self.state)?;
            }
        }
        self.begin_episode();
        Ok(self.observation())
    }

    /// Starts an episode from given positions (nq) and velocities (nv) instead of the settled state, without start actions.
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, a state from which the simulation diverges; the episode is then over.
    pub fn reset_to(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, EnvError> {
        self.place(qpos, qvel)?;
        self.begin_episode();
        Ok(self.observation())
    }

    /// Forgets the past and computes everything at the given positions and velocities.
    fn place(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), EnvError> {
        let model = self.blueprint.model();
        for (what, found, expected) in [("qpos", qpos.len(), model.nq), ("qvel", qvel.len(), model.nv)] {
            if found != expected {
                return Err(EnvError::StateLength { what, found, expected });
            }
        }
        self.ready = false;
        let s = &mut self.state;
        s.time = 0.0;
        s.step = 0;
        s.ctrl.fill(0.0);
        s.qfrc_applied.fill(0.0);
        s.qacc_warmstart.fill(0.0);
        s.params.clone_from(self.blueprint.params());
        self.actuation.reset(model, s);
        s.qpos.copy_from_slice(qpos);
        s.qvel.copy_from_slice(qvel);
        self.engine.forward(s)?;
        Ok(())
    }

    fn begin_episode(&mut self) {
        self.steps = 0;
        self.info.steps = 0;
        self.watcher.reset(&mut self.info.behavior);
        self.ready = true;
        self.sense();
    }

    /// Applies an action for `frame_skip` physics steps.
    ///
    /// Values out of the action space are clipped. Stepping on after truncation is allowed.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which leaves the state untouched; a simulation that
    /// diverged, after which [`Env::reset`] is needed.
    pub fn step(&mut self, action: &[f32]) -> Result<Step<'_>, EnvError> {
        if !self.ready {
            return Err(EnvError::NotReset);
        }
        self.check_action(action)?;
        let model = self.blueprint.model();
        self.actuation.set_action(model, &mut self.state, action);
        for k in 0..self.blueprint.config().frame_skip {
            if k > 0 {
                self.actuation.substep(model, &mut self.state);
            }
            if let Err(e) = self.engine.step(&mut self.state) {
                self.ready = false;
                return Err(e.into());
            }
        }
        self.engine.mark(Some(Stage::Senses));
        self.sense();
        self.watcher.update(&self.state, &mut self.info.behavior);
        self.info.steps = match self.blueprint.config().compat {
            Compat::Api => self.steps + 1,
            Compat::Reference => self.steps,
        };
        self.steps += 1;
        self.engine.mark(None);
        Ok(Step {
            observation: self.observation(),
            reward: 0.0,
            terminated: false,
            truncated: self.steps >= self.blueprint.config().max_episode_steps,
            info: &self.info,
        })
    }

    fn check_action(&self, action: &[f32]) -> Result<(), EnvError> {
        let expected = self.action_space().len();
        if action.len() != expected {
            return Err(EnvError::ActionLength {
                found: action.len(),
                expected,
            });
        }
        if let Some((index, &value)) = action.iter().enumerate().find(|(_, a)| !a.is_finite()) {
            let names = &self.model().actuator_name;
            let actuator = names.get(index % names.len().max(1)).cloned().unwrap_or_default();
            return Err(EnvError::ActionNotFinite { index, actuator, value });
        }
        Ok(())
    }

    fn sense(&mut self) {
        let model = self.blueprint.model();
        self.proprioception
            .observe(model, &self.state, &*self.actuation, &mut self.proprioception_values);
        if let Some(v) = &self.vestibular {
            v.observe(model, &self.state, &mut self.vestibular_values);
        }
    }

    /// The observation of the last reset or step.
    pub fn observation(&self) -> Observation<'_> {
        Observation {
            observation: &self.proprioception_values,
            vestibular: self.vestibular.as_ref().map(|_| &self.vestibular_values[..]),
        }
    }

    /// Fills `action` with a random action, the same that Gymnasium's `action_space.sample()` draws from the same seed.
    pub fn sample_action(&mut self, action: &mut Vec<f32>) {
        self.actuation.action_space().sample(&mut self.rng, action);
    }

    /// Seeds the generator of [`Env::sample_action`] and of start actions.
    pub fn seed_action_space(&mut self, seed: u64) {
        self.rng = NumpyRng::seed(seed);
    }

    /// Bounds of actions.
    pub fn action_space(&self) -> &BoxSpace {
        self.actuation.action_space()
    }

    /// Keys, shapes, types and bounds of the observation.
    pub fn observation_space(&self) -> Vec<ObservationSpace> {
        let vector = |key, len| ObservationSpace {
            key,
            shape: vec![len],
            dtype: Dtype::F64,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
        let mut spaces = vec![vector("observation", self.proprioception.len())];
        if let Some(v) = &self.vestibular {
            spaces.push(vector("vestibular", v.len()));
        }
        spaces
    }

    /// The information of the last step.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        self.blueprint.config()
    }

    /// What this environment was made from.
    pub fn blueprint(&self) -> &Blueprint {
        &self.blueprint
    }

    /// The compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        self.blueprint.model()
    }

    /// The state of the scene.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state of the scene, to change positions, velocities, warm start, applied forces or parameters. Quantities that
    /// follow from them are brought up to date by the next step.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// The physics engine, with the live scene in Rapier.
    pub fn engine(&self) -> &SoftEngine {
        &self.engine
    }

    /// The physics engine, to run queries on the live scene.
    pub fn engine_mut(&mut self) -> &mut SoftEngine {
        &mut self.engine
    }

    /// Installs or removes a probe that is told when each stage of a step begins and when the step is done.
    pub fn set_probe(&mut self, probe: Option<Probe>) {
        self.engine.set_probe(probe);
    }

    /// The proprioceptive sense: names and ranges of its values.
    pub fn proprioception(&self) -> &Proprioception {
        &self.proprioception
    }

    /// The vestibular sense, if it is active.
    pub fn vestibular(&self) -> Option<&Vestibular> {
        self.vestibular.as_ref()
    }

    /// The actuation model.
    pub fn actuation(&self) -> &dyn Actuation {
        &*self.actuation
    }
}
