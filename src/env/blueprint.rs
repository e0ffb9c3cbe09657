//! Blueprints: everything that environments of one configuration share.

mod bodies;
mod options;
mod settled;
mod surface;
mod variants;

pub use options::BlueprintOptions;

use std::sync::Arc;

use super::engines::Engines;
use super::paths::Paths;
use super::pipeline::effective;
use super::snapshot::Identity;
use super::task::{TaskSizes, of_config, rewards};
use super::{Env, EnvError, Goal, GoalError, Task};
use crate::actuation::{self, Actuation, ReflexTables, Reflexes};
use crate::assets::AssetSource;
use crate::config::{Config, EngineKind, RendererKind};
use crate::mimo::scene_assets;
use crate::model::Model;
use crate::physics::{Engine, Params, Shared, State};
use crate::render::{RenderError, RendererPool, Scenery};
use crate::sensors::transform::Sense;
use crate::sensors::{Proprioception, SkinLayout, Vestibular};
use bodies::BodyCache;
use settled::{SettledScene, make_skin, task_model};
use surface::SkinAndScenery;

/// A configuration, its compiled model and its settled initial state. Made once; environments from it are cheap.
///
/// ```
/// use babybench::{Blueprint, Config};
///
/// let blueprint = Blueprint::new(Config::default())?;
/// let mut environments: Vec<_> = (0..3).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
/// for (seed, env) in environments.iter_mut().enumerate() {
///     env.reset(Some(seed as u64))?;
/// }
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blueprint {
    config: Arc<Config>,
    /// The task, bound to the model.
    task: Arc<dyn Task>,
    sizes: TaskSizes,
    model: Arc<Model>,
    engines: Arc<Engines>,
    tables: SharedTables,
    paths: Option<Arc<Paths>>,
    init_qpos: Arc<Vec<f64>>,
    init_qvel: Arc<Vec<f64>>,
    params: Shared<Params>,
    /// The identity that a snapshot must match.
    identity: Arc<Identity>,
    /// Identity, model and parameters from before a program changed the model.
    origin: Arc<UnchangedModel>,
    surface: SkinAndScenery,
    bodies: BodyCache,
}

/// Constant tables derived from configuration and model. Environments share them, because copies would compete for the caches.
#[derive(Clone)]
pub(super) struct SharedTables {
    pub actuation: Arc<dyn Actuation>,
    pub proprioception: Arc<Proprioception>,
    pub vestibular: Option<Arc<Vestibular>>,
    pub reflexes: Option<Arc<ReflexTables>>,
}

impl std::fmt::Debug for SharedTables {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tables").finish_non_exhaustive()
    }
}

impl SharedTables {
    fn new(config: &Config, model: &Model) -> Result<Self, EnvError> {
        let actuation: Arc<dyn Actuation> = actuation::build(model, config)?.into();
        let proprioception = Proprioception::new(model, config, actuation.observation_len());
        let reflexes = ReflexTables::new(config, model, &*actuation)?.map(Arc::new);
        Ok(Self {
            reflexes,
            actuation,
            proprioception: proprioception.into(),
            vestibular: config.vestibular_active.then(|| Vestibular::new(model).into()),
        })
    }
}

/// The state of a blueprint before its model was changed.
#[derive(Debug)]
struct UnchangedModel {
    model: Arc<Model>,
    params: Shared<Params>,
    identity: Arc<Identity>,
}

impl Blueprint {
    /// Builds the scene and the task of a configuration from the embedded assets.
    ///
    /// # Errors
    /// As [`Blueprint::with`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Self::with(config, BlueprintOptions::default())
    }

    /// Builds a scene with a user-defined task, from other assets, or both.
    ///
    /// Compiles the document of the task, applies the locks (under `compat: reference` after settling) and lets the task settle the
    /// scene. BabyBench's behaviors settle for 100 steps from `qpos0` with the action 0. The blueprint keeps the assets. Textures are
    /// decoded when something is first drawn, or immediately with `vision_active`.
    ///
    /// ```
    /// use babybench::env::{BlueprintOptions, Goal, Task, StepReward};
    /// use babybench::{Blueprint, Config};
    ///
    /// #[derive(Clone, Debug)]
    /// struct Wait;
    ///
    /// impl Task for Wait {
    ///     fn name(&self) -> &str {
    ///         "wait"
    ///     }
    ///     fn judge(&self, _goal: Goal<'_>) -> StepReward {
    ///         StepReward { reward: 1.0, ..StepReward::default() }
    ///     }
    /// }
    ///
    /// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    /// let mut env = Blueprint::with(config, BlueprintOptions::default().with_task(Wait))?.env()?;
    /// env.reset(Some(0))?;
    /// assert_eq!(env.step(&vec![0.0; env.action_space().len()])?.reward, 1.0);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// An invalid configuration, assets that do not load, a scene that the engine cannot simulate or that diverges, and errors of the
    /// task.
    pub fn with(config: Config, options: BlueprintOptions) -> Result<Self, EnvError> {
        Self::made(config, options, None)
    }

    /// Builds a scene; `like` is the look of another with the same assets.
    fn made(mut config: Config, options: BlueprintOptions, like: Option<&Scenery>) -> Result<Self, EnvError> {
        // MIMo begins at the first age of his schedule
        config.age = config.age.or(config.age_schedule.at(0, config.age_grid));
        // fields of a configuration are public, and what follows relies on their bounds
        config.validate()?;
        if config.renderer == RendererKind::Wgpu && cfg!(not(feature = "wgpu")) {
            return Err(RenderError::NoWgpu.into());
        }
        if config.engine == EngineKind::Rapier && cfg!(not(feature = "rapier")) {
            return Err(EnvError::NoRapier);
        }
        let given = options.assets;
        // the task chooses the document, so it comes before the model
        let task = options.task.unwrap_or_else(|| of_config(&config));
        let model = Arc::new(task_model(&config, &*task, &*given)?);
        let skin = if config.touch_enabled() {
            Some(Arc::new(make_skin(&model, &config, &*task, &*given)?))
        } else {
            None
        };
        let surface = SkinAndScenery {
            assets: scene_assets(&config, given.clone())?,
            given,
            skin,
            scenery: Arc::default(),
            painting: RendererPool::default(),
            gpu: Arc::default(),
        };
        let blueprint = Self::settled(config, task, model, surface)?;
        // a texture that cannot be read is then an error here and not in the first step
        if blueprint.config.vision_active {
            blueprint.make_scenery(like)?;
        }
        Ok(blueprint.keeping_bodies())
    }

    /// Binds the task to a model and lets it settle the scene.
    fn settled(
        config: Config,
        mut task: Box<dyn Task>,
        model: Arc<Model>,
        surface: SkinAndScenery,
    ) -> Result<Self, EnvError> {
        let engines = Arc::new(Engines::new(&config, &model)?);
        // once for all environments, which copy a task that knows its scene
        let sizes = task.bind(&config, &model)?;
        let paths = Paths::new(&config.mocap_motion, &model)?.map(Arc::new);
        let tables = SharedTables::new(&config, &model)?;
        let settled = SettledScene::new(&config, &*task, &engines, &*tables.actuation, &model, paths.as_deref())?;
        let identity = Arc::new(Identity::new(&model, &config));
        let params = settled.params;
        // changes are listed relative to it, even after several
        let origin = UnchangedModel {
            model: model.clone(),
            params: params.clone(),
            identity: identity.clone(),
        };
        Ok(Self {
            identity,
            origin: Arc::new(origin),
            config: Arc::new(config),
            task: task.into(),
            sizes,
            model,
            engines,
            tables,
            paths,
            init_qpos: Arc::new(settled.qpos),
            init_qvel: Arc::new(settled.qvel),
            params,
            surface,
            bodies: BodyCache::default(),
        })
    }

    /// Returns the model and the parameters before a program changed the model.
    pub(super) fn origin(&self) -> (&Model, &Params) {
        (&self.origin.model, &self.origin.params)
    }

    /// Returns the assets of the scene; see [`scene_assets`].
    pub fn assets(&self) -> &dyn AssetSource {
        &*self.surface.assets
    }

    /// Returns the task, which environments copy.
    pub fn task(&self) -> &dyn Task {
        &*self.task
    }

    /// Returns the actuation model.
    pub fn actuation(&self) -> &dyn Actuation {
        &*self.tables.actuation
    }

    /// Computes the reward of each row of goals, one for each entry of `out`, like Gymnasium-Robotics' `compute_reward`. The program
    /// chooses the desired goals. `terms` ([`Goal::terms`]) are those of the steps in which the goals were achieved. For the goals of a
    /// step it is the reward of that step, to the bit.
    ///
    /// ```
    /// use babybench::config::Behavior;
    /// use babybench::{Env, env::Goal};
    /// use babybench::Config;
    ///
    /// let mut env = Env::new(Config::of(Behavior::Standup))?;
    /// env.reset(Some(0))?;
    /// let reward = env.step(&vec![0.5; env.action_space().len()])?.reward;
    /// let mut found = [0.0];
    /// env.blueprint().compute_reward(env.goal(), &mut found)?;
    /// assert_eq!(found, [reward]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Arrays without a row of the task's length for each reward.
    pub fn compute_reward(&self, goals: Goal<'_>, out: &mut [f64]) -> Result<(), GoalError> {
        rewards(&*self.task, self.sizes, goals, out)
    }

    /// Returns the tables that all its environments share.
    pub(super) fn tables(&self) -> &SharedTables {
        &self.tables
    }

    /// Returns how many numbers the task produces in each step.
    pub(super) fn task_sizes(&self) -> TaskSizes {
        self.sizes
    }

    /// Creates an environment.
    ///
    /// # Errors
    /// The scene lacks parts that the behavior needs.
    pub fn env(&self) -> Result<Env, EnvError> {
        Env::from_blueprint(self)
    }

    /// Returns the delay of actions, in steps of the environment.
    pub fn action_delay(&self) -> usize {
        let steps = self
            .config
            .delays
            .steps(self.config.delays.motor, self.config.frame_skip);
        effective(&self.config, steps)
    }

    /// Returns the delay of a sense, in steps of the environment.
    pub fn sense_delay(&self, sense: Sense) -> usize {
        effective(&self.config, sense.delay(&self.config))
    }

    /// Creates an engine of the kind that the configuration selects.
    pub fn engine(&self) -> Box<dyn Engine> {
        self.engines.make()
    }

    /// Creates the state of a new environment.
    pub(super) fn new_state(&self) -> State {
        let mut state = self.engines.reader().new_state();
        self.actuation().prepare(&self.model, &mut state);
        // shared from the start, because copies into an own allocation would stay unshared
        state.params = self.params.clone();
        state
    }

    /// Creates the reflexes of a new environment, if it has any.
    pub(super) fn new_reflexes(&self) -> Option<Reflexes> {
        let tables = self.tables.reflexes.clone()?;
        Some(Reflexes::new(tables, self.actuation()))
    }

    /// Returns the engines of this blueprint's environments.
    pub(super) fn engines(&self) -> &Arc<Engines> {
        &self.engines
    }

    /// Returns the configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Returns the time between two steps of an environment, s: the model's timestep times `frame_skip`.
    pub fn dt(&self) -> f64 {
        self.model.opt.timestep * f64::from(self.config.frame_skip)
    }

    /// Returns the compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Returns the paths of bodies that the engine does not move.
    pub(super) fn paths(&self) -> Option<&Paths> {
        self.paths.as_deref()
    }

    /// Returns the identity that a snapshot must match.
    pub(super) fn identity(&self) -> &Identity {
        &self.identity
    }

    /// Returns the settled positions (nq), from which episodes start.
    pub fn init_qpos(&self) -> &[f64] {
        &self.init_qpos
    }

    /// Returns the velocities (nv) after settling, which are not zero.
    pub fn init_qvel(&self) -> &[f64] {
        &self.init_qvel
    }

    /// Returns the parameters after a reset: the model's, with the configured locks active and the changes of the actuation model.
    pub fn params(&self) -> &Shared<Params> {
        &self.params
    }

    /// Returns the positions of the touch sensors, if touch is active.
    pub fn skin(&self) -> Option<&Arc<SkinLayout>> {
        self.surface.skin.as_ref()
    }
}
