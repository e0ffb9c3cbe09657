//! What all environments of one configuration share.

use std::sync::{Arc, OnceLock};

use crate::actuation;
use crate::config::{ActuationModel, Compat, Config, Engine as EngineKind, Part};
use crate::env::{Env, EnvError};
use crate::mimo::{build_model, embedded, lock};
use crate::mjcf_loader::AssetSource;
use crate::model::Model;
use crate::physics::{Engine, Params, SoftEngine, SoftOptions};
use crate::render::Visual;
use crate::sensors::SkinLayout;

/// Physics steps in which the scene settles before it is used.
const SETTLING_STEPS: usize = 100;

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
    model: Arc<Model>,
    init_qpos: Arc<Vec<f64>>,
    init_qvel: Arc<Vec<f64>>,
    params: Arc<Params>,
    embedded: bool,
    skin: Option<Arc<SkinLayout>>,
    /// The look of the scene; of embedded assets it is made when it is first needed.
    visual: Arc<OnceLock<Arc<Visual>>>,
    warnings: Vec<String>,
}

impl Blueprint {
    /// From the embedded assets.
    ///
    /// # Errors
    /// As [`Blueprint::with_assets`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        let mut blueprint = Self::build(config, &embedded(), true)?;
        blueprint.embedded = true;
        Ok(blueprint)
    }

    /// From other assets, laid out like the embedded ones.
    ///
    /// Builds the scene, applies the locks (under `compat: reference` after settling) and lets the scene settle for 100
    /// steps from `qpos0` with the action 0.
    ///
    /// # Errors
    /// A configuration that is not allowed or not available, assets that do not load, a scene that diverges.
    pub fn with_assets(config: Config, assets: &dyn AssetSource) -> Result<Self, EnvError> {
        Self::build(config, assets, false)
    }

    fn build(config: Config, assets: &dyn AssetSource, lazy: bool) -> Result<Self, EnvError> {
        config.validate()?;
        if config.engine != EngineKind::Soft {
            let value = config.engine.name().to_string();
            return Err(EnvError::NotAvailable {
                key: "engine",
                value,
                available: &["soft"],
            });
        }
        let model = Arc::new(build_model(&config, assets)?);
        let skin = match config.touch_enabled() {
            true => Some(Arc::new(SkinLayout::new(&model, &config)?)),
            false => None,
        };
        let settled = Settled::new(&config, &model)?;
        let visual = OnceLock::new();
        if config.vision_active || !lazy {
            let _ = visual.set(Arc::new(Visual::new(&model, assets)?));
        }
        Ok(Self {
            config: Arc::new(config),
            model,
            init_qpos: Arc::new(settled.qpos),
            init_qvel: Arc::new(settled.qvel),
            params: Arc::new(settled.params),
            embedded: false,
            skin,
            visual: Arc::new(visual),
            warnings: Vec::new(),
        })
    }

    /// The same with another actuation model: settled anew, on the same compiled scene where the actuators are the same.
    ///
    /// `spring_damper` and `muscle` share the scene's motors. To and from `positional`, whose actuators are servos, a scene
    /// of the embedded assets is compiled again; all that is not an actuator keeps its number.
    ///
    /// # Errors
    /// As [`Blueprint::new`]; other actuators are needed and the scene is not from the embedded assets.
    pub fn with_actuation(&self, actuation_model: ActuationModel) -> Result<Self, EnvError> {
        let present = self.config.actuation_model;
        let config = Config {
            actuation_model,
            ..Config::clone(&self.config)
        };
        let servos = |a| a == ActuationModel::Positional;
        let model = if servos(present) == servos(actuation_model) {
            self.model.clone()
        } else if self.embedded {
            Arc::new(build_model(&config, &embedded())?)
        } else {
            let wanted = actuation_model;
            return Err(EnvError::OtherActuators { present, wanted });
        };
        let settled = Settled::new(&config, &model)?;
        Ok(Self {
            config: Arc::new(config),
            model,
            init_qpos: Arc::new(settled.qpos),
            init_qvel: Arc::new(settled.qvel),
            params: Arc::new(settled.params),
            ..self.clone()
        })
    }

    /// A new environment.
    ///
    /// # Errors
    /// Parts of the scene that the behavior needs are missing.
    pub fn env(&self) -> Result<Env, EnvError> {
        Env::from_blueprint(self)
    }

    /// The engine that the configuration asks for.
    pub fn engine(&self) -> SoftEngine {
        Self::engine_for(&self.config, &self.model)
    }

    fn engine_for(config: &Config, model: &Arc<Model>) -> SoftEngine {
        let double_weld_torque = config.compat == Compat::Reference;
        SoftEngine::new(
            model.clone(),
            SoftOptions {
                double_weld_torque,
                ..SoftOptions::default()
            },
        )
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Settled positions and velocities, shared.
    pub(crate) fn settled(&self) -> (Arc<Vec<f64>>, Arc<Vec<f64>>) {
        (self.init_qpos.clone(), self.init_qvel.clone())
    }

    /// Settled positions (nq), from which episodes start.
    pub fn init_qpos(&self) -> &[f64] {
        &self.init_qpos
    }

    /// Velocities (nv) after settling; not zero.
    pub fn init_qvel(&self) -> &[f64] {
        &self.init_qvel
    }

    /// Parameters after a reset: the model's, with the configured locks active and the changes of the actuation model.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Where the touch sensors are, if touch is active.
    pub fn skin(&self) -> Option<&Arc<SkinLayout>> {
        self.skin.as_ref()
    }

    /// The look of the scene, shared by its environments.
    ///
    /// # Errors
    /// Textures that cannot be read.
    pub fn visual(&self) -> Result<Arc<Visual>, EnvError> {
        if let Some(visual) = self.visual.get() {
            return Ok(visual.clone());
        }
        let made = Arc::new(Visual::new(&self.model, &embedded())?);
        Ok(self.visual.get_or_init(|| made).clone())
    }

    /// Parts of the configuration that are ignored, each naming its key.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// A scene after it came to rest.
struct Settled {
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    params: Params,
}

impl Settled {
    /// 100 steps from `qpos0` with the controls of the action 0, whose muscle forces are those at `qpos0` throughout.
    fn new(config: &Config, model: &Arc<Model>) -> Result<Self, EnvError> {
        let mut actuation = actuation::build(model, config)?;
        let mut engine = Blueprint::engine_for(config, model);
        let mut state = engine.new_state();
        actuation.prepare(model, &mut state.params);
        let mut params = state.params.clone();
        for part in Part::ALL {
            if config.lock.get(part) {
                lock(model, &mut params, part.into(), 0.0)?;
            }
        }
        if config.compat == Compat::Api {
            state.params.clone_from(&params);
        }
        // the step that the reference makes before it looks at its sensors: it leaves the warm start of the solver
        engine.step(&mut state)?;
        state.qpos.copy_from_slice(&model.qpos0);
        state.qvel.fill(0.0);
        engine.forward(&mut state)?;
        let zero = vec![0.0; actuation.action_space().len()];
        actuation.set_action(model, &mut state, &zero);
        for _ in 0..SETTLING_STEPS {
            engine.step(&mut state)?;
        }
        Ok(Self {
            qpos: state.qpos,
            qvel: state.qvel,
            params,
        })
    }
}
