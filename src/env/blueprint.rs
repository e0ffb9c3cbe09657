//! What all environments of one configuration share.

use std::sync::Arc;

use crate::actuation;
use crate::config::{Compat, Config, Engine as EngineKind, Part};
use crate::env::{Env, EnvError};
use crate::mimo::{build_model, embedded, lock_group};
use crate::mjcf_loader::AssetSource;
use crate::model::Model;
use crate::physics::{Engine, Params, SoftEngine, SoftOptions};

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
    warnings: Vec<String>,
}

impl Blueprint {
    /// From the embedded assets.
    ///
    /// # Errors
    /// As [`Blueprint::with_assets`].
    pub fn new(config: Config) -> Result<Self, EnvError> {
        Self::with_assets(config, &embedded())
    }

    /// From other assets, laid out like the embedded ones.
    ///
    /// Builds the scene, applies the locks (under `compat: reference` after settling) and lets the scene settle for 100
    /// steps from `qpos0` with the action 0.
    ///
    /// # Errors
    /// A configuration that is not allowed or not available, assets that do not load, a scene that diverges.
    pub fn with_assets(config: Config, assets: &dyn AssetSource) -> Result<Self, EnvError> {
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
        let mut locked = Params::new(&model);
        for part in Part::ALL {
            if config.lock.get(part) {
                lock_group(&model, &mut locked, part);
            }
        }
        let mut actuation = actuation::build(&model, &config).ok_or_else(|| EnvError::NotAvailable {
            key: "actuation_model",
            value: config.actuation_model.name().to_string(),
            available: actuation::AVAILABLE,
        })?;

        let mut engine = Self::engine_for(&config, &model);
        let mut state = engine.new_state();
        if config.compat == Compat::Api {
            state.params = locked.clone();
        }
        // the step that the reference makes before it looks at its sensors: it leaves the warm start of the solver
        engine.step(&mut state)?;
        state.qpos.copy_from_slice(&model.qpos0);
        state.qvel.fill(0.0);
        engine.forward(&mut state)?;
        let zero = vec![0.0; actuation.action_space().len()];
        actuation.set_action(&model, &mut state, &zero);
        for _ in 0..SETTLING_STEPS {
            engine.step(&mut state)?;
        }
        let mut warnings = Vec::new();
        for (on, key) in [
            (config.vision_active, "vision_active"),
            (config.touch_enabled(), "touch_active"),
        ] {
            if on {
                warnings.push(format!(
                    "{key}: this sense is not available; the environment runs without it"
                ));
            }
        }
        Ok(Self {
            config: Arc::new(config),
            model,
            init_qpos: Arc::new(state.qpos),
            init_qvel: Arc::new(state.qvel),
            params: Arc::new(locked),
            warnings,
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

    /// Settled positions (nq), from which episodes start.
    pub fn init_qpos(&self) -> &[f64] {
        &self.init_qpos
    }

    /// Velocities (nv) after settling; not zero.
    pub fn init_qvel(&self) -> &[f64] {
        &self.init_qvel
    }

    /// Parameters after a reset: the model's, with the configured locks active.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Parts of the configuration that are ignored, each naming its key.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}
