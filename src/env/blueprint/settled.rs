//! Scenes compiled for their task, with their skin, and settled.

use crate::actuation::Actuation;
use crate::assets::AssetSource;
use crate::config::{Compat, Config, Part};
use crate::env::engines::{EngineSource, Engines};
use crate::env::paths::Paths;
use crate::env::task::TaskScene;
use crate::env::{EnvError, Task};
use crate::mimo::{build_scene, lock};
use crate::model::Model;
use crate::physics::{Params, Shared};
use crate::sensors::SkinLayout;
use crate::spaces::NumpyRng;

/// Compiles the scene of a task.
pub fn task_model(config: &Config, task: &dyn Task, assets: &dyn AssetSource) -> Result<Model, EnvError> {
    let document = task.document(config);
    Ok(build_scene(&document.xml, document.version, config, assets)?)
}

/// Places the sensors of the skin.
pub fn make_skin(
    model: &Model,
    config: &Config,
    task: &dyn Task,
    assets: &dyn AssetSource,
) -> Result<SkinLayout, EnvError> {
    let layout = |model: &Model| match &task.document(config).touch_spacing[..] {
        [] => SkinLayout::new(model, config),
        own => SkinLayout::with_spacing(model, |body| {
            let found = own.iter().find(|(name, _)| *name == body);
            found.map(|(_, distance)| distance * config.touch_scale)
        }),
    };
    if !config.touch_grows {
        return Ok(layout(model)?);
    }
    // placed on the original body and then moved, so that every age has the same number of sensors
    let mut original = config.clone();
    original.age = None;
    let original_model = task_model(&original, task, assets)?;
    Ok(layout(&original_model)?.scaled(&original_model, model))
}

/// A scene at rest.
pub struct SettledScene {
    pub qpos: Vec<f64>,
    pub qvel: Vec<f64>,
    pub params: Shared<Params>,
}

impl SettledScene {
    /// Settles the scene as the task does, with the locks of the configuration. Under `compat: reference`, locks apply only after the first reset.
    pub fn new(
        config: &Config,
        task: &dyn Task,
        engines: &Engines,
        actuation: &dyn Actuation,
        model: &Model,
        paths: Option<&Paths>,
    ) -> Result<Self, EnvError> {
        let mut state = engines.reader().new_state();
        if let Some(paths) = paths {
            // where they start, and stay while everything else settles
            paths.place(&mut state);
        }
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
            // a generator of its own, because all environments share the settled state
            rng: &mut NumpyRng::seed(config.seed),
            engine: EngineSource::Shared(engines),
            last_call: None,
            base: &mut params,
            actuation,
            paths: None,
            delay: None,
            reflexes: None,
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
