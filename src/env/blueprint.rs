//! The part that all environments of one configuration share.

use std::sync::{Arc, OnceLock};

use crate::actuation;
use crate::assets::AssetSource;
use crate::config::{ActuationModel, Compat, Config, EngineKind, Part, RendererKind};
use crate::env::snapshot::fingerprint;
use crate::env::task::{TaskScene, of_config};
use crate::env::{Env, EnvError, Task};
use crate::mimo::{build_scene, embedded, lock};
use crate::model::Model;
use crate::physics::{Engine, Params, SoftModel, SoftOptions};
#[cfg(feature = "rapier")]
use crate::physics::{RapierModel, RapierOptions};
use crate::render::{RenderError, Renderer, SharedGpu, Visual, open_gpu};
use crate::sensors::SkinLayout;
use crate::spaces::NumpyRng;

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
    /// The task, which knows the model.
    task: Box<dyn Task>,
    model: Arc<Model>,
    engines: Engines,
    init_qpos: Arc<Vec<f64>>,
    init_qvel: Arc<Vec<f64>>,
    params: Arc<Params>,
    /// The assets, if they stay at hand.
    assets: Option<Assets>,
    /// What a snapshot must fit.
    fingerprint: u64,
    skin: Option<Arc<SkinLayout>>,
    /// The look of the scene; where the assets stay at hand it is made when it is first needed.
    visual: Arc<OnceLock<Arc<Visual>>>,
    /// The renderer on a GPU, opened when it is first needed.
    gpu: Arc<OnceLock<SharedGpu>>,
}

/// Assets that stay at hand.
#[derive(Clone)]
struct Assets(Arc<dyn AssetSource + Send + Sync>);

impl std::fmt::Debug for Assets {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Assets")
    }
}

impl Blueprint {
    /// Builds the scene from the embedded assets.
    ///
    /// # Errors
    /// As [`Blueprint::with_assets`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Self::with_kept_assets(config, Arc::new(embedded()))
    }

    /// Builds the scene from other assets, as [`Blueprint::with_assets`] does, and keeps them: textures are decoded when something
    /// is first drawn, and [`Blueprint::with_actuation`] reads what it needs.
    ///
    /// # Errors
    /// As [`Blueprint::with_assets`]; textures that cannot be read are an error when something is drawn.
    pub fn with_kept_assets(config: Config, assets: Arc<dyn AssetSource + Send + Sync>) -> Result<Self, EnvError> {
        let task = of_config(&config);
        Self::with_task_and_assets(config, task, assets)
    }

    /// Builds the scene of a task of a program's own, from the embedded assets. The key `behavior` is not used.
    ///
    /// ```
    /// use babybench::env::{Goal, Task};
    /// use babybench::{Blueprint, Config};
    ///
    /// #[derive(Clone, Debug)]
    /// struct Wait;
    ///
    /// impl Task for Wait {
    ///     fn name(&self) -> &str {
    ///         "wait"
    ///     }
    ///     fn reward(&self, _goal: Goal<'_>) -> f64 {
    ///         1.0
    ///     }
    /// }
    ///
    /// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    /// let mut env = Blueprint::with_task(config, Wait)?.env()?;
    /// env.reset(Some(0))?;
    /// assert_eq!(env.step(&vec![0.0; env.action_space().len()])?.reward, 1.0);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Blueprint::new`]; whatever the task refuses.
    pub fn with_task(config: Config, task: impl Task + 'static) -> Result<Self, EnvError> {
        Self::with_task_and_assets(config, Box::new(task), Arc::new(embedded()))
    }

    /// Builds the scene of a task from assets, which stay at hand.
    ///
    /// # Errors
    /// As [`Blueprint::with_task`].
    pub fn with_task_and_assets(
        config: Config,
        task: Box<dyn Task>,
        assets: Arc<dyn AssetSource + Send + Sync>,
    ) -> Result<Self, EnvError> {
        let mut blueprint = Self::build(config, task, &*assets, true)?;
        blueprint.assets = Some(Assets(assets));
        Ok(blueprint)
    }

    /// Builds the scene from other assets, laid out like the embedded ones.
    ///
    /// Builds the scene, applies the locks (under `compat: reference` after settling) and lets the task settle the scene: for BabyBench's
    /// behaviors 100 steps from `qpos0` with the action 0.
    ///
    /// # Errors
    /// A configuration that is not allowed, assets that do not load, a scene that the engine cannot simulate or that diverges.
    pub fn with_assets(config: Config, assets: &dyn AssetSource) -> Result<Self, EnvError> {
        let task = of_config(&config);
        Self::build(config, task, assets, false)
    }

    fn build(config: Config, mut task: Box<dyn Task>, assets: &dyn AssetSource, lazy: bool) -> Result<Self, EnvError> {
        config.validate()?;
        if config.renderer == RendererKind::Wgpu && cfg!(not(feature = "wgpu")) {
            return Err(RenderError::NoWgpu.into());
        }
        if config.engine == EngineKind::Rapier && cfg!(not(feature = "rapier")) {
            return Err(EnvError::NoRapier);
        }
        let model = Arc::new(task_model(&config, &*task, assets)?);
        let skin = match config.touch_enabled() {
            true => Some(Arc::new(make_skin(&model, &config, &*task, assets)?)),
            false => None,
        };
        let engines = Engines::new(&config, &model)?;
        task.bind(&config, &model)?;
        let settled = Settled::new(&config, &*task, &engines, &model)?;
        let visual = OnceLock::new();
        if config.vision_active || !lazy {
            let _ = visual.set(Arc::new(Visual::new(&model, assets)?));
        }
        Ok(Self {
            fingerprint: fingerprint(&model, &config),
            config: Arc::new(config),
            task,
            model,
            engines,
            init_qpos: Arc::new(settled.qpos),
            init_qvel: Arc::new(settled.qvel),
            params: Arc::new(settled.params),
            assets: None,
            skin,
            visual: Arc::new(visual),
            gpu: Arc::default(),
        })
    }

    /// Returns the same blueprint with another actuation model: settled anew, on the same compiled scene where the actuators are the same.
    ///
    /// `spring_damper` and `muscle` share the scene's motors. To and from `positional`, whose actuators are servos, a scene
    /// whose assets are at hand is compiled again; all that is not an actuator keeps its number.
    ///
    /// # Errors
    /// As [`Blueprint::new`]; other actuators are needed and the assets of the scene were lent ([`Blueprint::with_assets`]).
    pub fn with_actuation(&self, actuation_model: ActuationModel) -> Result<Self, EnvError> {
        let present = self.config.actuation_model;
        let config = Config {
            actuation_model,
            ..Config::clone(&self.config)
        };
        let servos = |a| a == ActuationModel::Positional;
        let model = if servos(present) == servos(actuation_model) {
            self.model.clone()
        } else if let Some(Assets(assets)) = &self.assets {
            Arc::new(task_model(&config, &*self.task, &**assets)?)
        } else {
            let wanted = actuation_model;
            return Err(EnvError::OtherActuators { present, wanted });
        };
        let engines = Engines::new(&config, &model)?;
        let mut task = self.task.clone();
        task.bind(&config, &model)?;
        let settled = Settled::new(&config, &*task, &engines, &model)?;
        Ok(Self {
            fingerprint: fingerprint(&model, &config),
            config: Arc::new(config),
            task,
            model,
            engines,
            init_qpos: Arc::new(settled.qpos),
            init_qvel: Arc::new(settled.qvel),
            params: Arc::new(settled.params),
            ..self.clone()
        })
    }

    /// Returns a blueprint of the same configuration with MIMo at another age, months; `None` for the original proportions.
    ///
    /// Names and ids stay. So do the spaces, but for the length of touch, which follows the size of the body unless
    /// [`Config::touch_grows`].
    ///
    /// # Errors
    /// As [`Blueprint::new`]; the assets of the scene were lent ([`Blueprint::with_assets`]).
    pub fn with_age(&self, age: Option<f64>) -> Result<Self, EnvError> {
        let Some(Assets(assets)) = &self.assets else {
            return Err(EnvError::OtherBody);
        };
        let mut config = Config::clone(&self.config);
        config.age = age;
        Self::with_task_and_assets(config, self.task.clone(), assets.clone())
    }

    /// Returns the task, which environments copy.
    pub fn task(&self) -> &dyn Task {
        &*self.task
    }

    /// Creates an environment.
    ///
    /// # Errors
    /// Parts of the scene that the behavior needs are missing.
    pub fn env(&self) -> Result<Env, EnvError> {
        Env::from_blueprint(self)
    }

    /// Creates an engine of the kind that the configuration asks for.
    pub fn engine(&self) -> Box<dyn Engine> {
        self.engines.make()
    }

    /// Returns the configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Returns the compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Returns what a snapshot must fit to be restored.
    pub(super) fn fingerprint(&self) -> u64 {
        self.fingerprint
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
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Returns where the touch sensors are, if touch is active.
    pub fn skin(&self) -> Option<&Arc<SkinLayout>> {
        self.skin.as_ref()
    }

    /// Returns the look of the scene, which its environments share.
    ///
    /// # Errors
    /// Textures that cannot be read.
    pub fn visual(&self) -> Result<Arc<Visual>, EnvError> {
        if let Some(visual) = self.visual.get() {
            return Ok(visual.clone());
        }
        let made = Arc::new(match &self.assets {
            Some(Assets(assets)) => Visual::new(&self.model, &**assets)?,
            None => Visual::new(&self.model, &embedded())?,
        });
        Ok(self.visual.get_or_init(|| made).clone())
    }

    /// Creates the renderer that the configuration asks for. On a GPU, environments of a blueprint share one.
    ///
    /// # Errors
    /// Textures that cannot be read; for `renderer: wgpu` no graphics adapter, a build without it, a browser.
    pub fn renderer(&self) -> Result<Renderer, EnvError> {
        match self.config.renderer {
            RendererKind::Cpu => Ok(Renderer::cpu(self.visual()?)),
            RendererKind::Wgpu => Ok(Renderer::gpu(self.gpu()?)),
        }
    }

    /// Returns the renderer on a GPU that environments of this blueprint share, opened when it is first asked for. It is there
    /// whatever renderer the configuration asks for.
    ///
    /// # Errors
    /// Textures that cannot be read, no graphics adapter, a build without `wgpu`, a browser.
    pub fn gpu(&self) -> Result<SharedGpu, EnvError> {
        if let Some(gpu) = self.gpu.get() {
            return Ok(gpu.clone());
        }
        let opened = open_gpu(self.visual()?)?;
        Ok(self.gpu.get_or_init(|| opened).clone())
    }
}

/// Compiles the scene of a task.
fn task_model(config: &Config, task: &dyn Task, assets: &dyn AssetSource) -> Result<Model, EnvError> {
    Ok(build_scene(
        &task.document(config),
        task.version(config),
        config,
        assets,
    )?)
}

/// Places the sensors of the skin.
fn make_skin(
    model: &Model,
    config: &Config,
    task: &dyn Task,
    assets: &dyn AssetSource,
) -> Result<SkinLayout, EnvError> {
    let layout = |model: &Model| match task.touch_spacing() {
        [] => SkinLayout::new(model, config),
        own => SkinLayout::with_spacing(model, |body| {
            let found = own.iter().find(|(name, _)| *name == body);
            found.map(|(_, distance)| distance * config.touch_scale)
        }),
    };
    if !config.touch_grows {
        return Ok(layout(model)?);
    }
    let mut original = config.clone();
    original.age = None;
    let original_model = task_model(&original, task, assets)?;
    Ok(layout(&original_model)?.scaled(&original_model, model))
}

/// A maker of engines of one kind for one model.
#[derive(Clone, Debug)]
enum Engines {
    Soft(SoftModel),
    #[cfg(feature = "rapier")]
    Rapier(RapierModel),
}

impl Engines {
    fn new(config: &Config, model: &Arc<Model>) -> Result<Self, EnvError> {
        let (model, double_weld_torque) = (model.clone(), config.compat == Compat::Reference);
        Ok(match config.engine {
            EngineKind::Soft => {
                let options = SoftOptions {
                    double_weld_torque,
                    ..SoftOptions::default()
                };
                Self::Soft(SoftModel::new(model, options))
            }
            #[cfg(feature = "rapier")]
            EngineKind::Rapier => {
                let options = RapierOptions {
                    double_weld_torque,
                    ..RapierOptions::default()
                };
                Self::Rapier(RapierModel::new(model, options)?)
            }
            #[cfg(not(feature = "rapier"))]
            EngineKind::Rapier => return Err(EnvError::NoRapier),
        })
    }

    fn make(&self) -> Box<dyn Engine> {
        match self {
            Self::Soft(shared) => Box::new(shared.engine()),
            #[cfg(feature = "rapier")]
            Self::Rapier(shared) => Box::new(shared.engine()),
        }
    }
}

/// A scene after it came to rest.
struct Settled {
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    params: Params,
}

impl Settled {
    /// Lets a task settle the scene, with the locks of the configuration; under `compat: reference` they hold from the first
    /// reset on.
    fn new(config: &Config, task: &dyn Task, engines: &Engines, model: &Model) -> Result<Self, EnvError> {
        let actuation = actuation::build(model, config)?;
        let mut engine = engines.make();
        let mut state = engine.new_state();
        actuation.prepare(model, &mut state);
        let mut params = state.params.clone();
        for part in Part::ALL {
            if config.lock.get(part) {
                lock(model, &mut params, part.into(), 0.0)?;
            }
        }
        if config.compat == Compat::Api {
            state.params.clone_from(&params);
        }
        let still = vec![0.0; model.nv];
        task.settle(&mut TaskScene {
            config,
            model,
            state: &mut state,
            rng: &mut NumpyRng::seed(config.seed),
            engine: &mut *engine,
            base: &mut params,
            actuation: &*actuation,
            motor: None,
            start: [&model.qpos0, &still],
            action: &mut Vec::new(),
        })?;
        Ok(Self {
            qpos: state.qpos,
            qvel: state.qvel,
            params,
        })
    }
}
