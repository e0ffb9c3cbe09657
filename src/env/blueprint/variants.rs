//! Blueprints that differ in one thing: actuation model, face, numbers of the model.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::bodies::BodyCache;
use super::settled::task_model;
use super::surface::SkinAndScenery;
use super::{Blueprint, SharedTables};
use crate::config::{ActuationModel, Config, FacialExpression};
use crate::env::EnvError;
use crate::env::engines::Engines;
use crate::mimo::scene_assets;
use crate::model::Model;
use crate::physics::{Params, Shared};
use crate::render::RendererPool;

impl Blueprint {
    /// Returns the same blueprint with another actuation model, settled again, on the same compiled scene if the actuators are the same.
    ///
    /// `spring_damper` and `muscle` share the scene's motors. Changes to and from `positional`, whose actuators are servos, compile the
    /// scene again. Everything that is not an actuator keeps its number.
    ///
    /// # Errors
    /// As [`Blueprint::with`].
    pub fn with_actuation(&self, actuation_model: ActuationModel) -> Result<Self, EnvError> {
        let config = Config {
            actuation_model,
            ..Config::clone(&self.config)
        };
        let servos = |a| a == ActuationModel::Positional;
        let model = if servos(self.config.actuation_model) == servos(actuation_model) {
            self.model.clone()
        } else {
            Arc::new(task_model(&config, &*self.task, &*self.surface.given)?)
        };
        let surface = SkinAndScenery {
            // the actuators of a custom scene are among them
            assets: scene_assets(&config, self.surface.given.clone())?,
            ..self.surface.clone()
        };
        Ok(Self::settled(config, self.task.clone_task(), model, surface)?.keeping_bodies())
    }

    /// Returns a blueprint of the same configuration in which MIMo makes another face. Snapshots of both are exchangeable.
    ///
    /// # Errors
    /// As [`Blueprint::with`]; assets without the texture of the face, `tex_head_NAME`. Without the feature `faces`, the assets must have
    /// the pictures of all faces but the default one, as `tex/face_NAME.png`.
    pub fn with_facial_expression(&self, facial_expression: FacialExpression) -> Result<Self, EnvError> {
        let config = Config {
            facial_expression,
            ..Config::clone(&self.config)
        };
        let made = task_model(&config, &*self.task, &*self.surface.given)?;
        // only pictures differ: changes by a program remain
        let model = self.model.edited(|arrays| arrays.materials.clone_from(&made.materials));
        let blueprint = Self {
            config: Arc::new(config),
            // other bodies have the other face
            bodies: BodyCache::default(),
            ..self.clone()
        };
        blueprint.with_look(model)
    }

    /// Returns the same blueprint with a model of another look.
    pub(crate) fn with_look(&self, model: Model) -> Result<Self, EnvError> {
        let blueprint = Self {
            model: Arc::new(model),
            surface: SkinAndScenery {
                scenery: Arc::default(),
                painting: RendererPool::default(),
                gpu: Arc::default(),
                ..self.surface.clone()
            },
            ..self.clone()
        };
        if blueprint.config.vision_active {
            blueprint.scenery()?;
        }
        Ok(blueprint)
    }

    /// Returns the same blueprint with a model that a program has changed, without settling again. `changes` are the arrays that differ
    /// from those of the scene.
    pub(crate) fn with_model(
        &self,
        model: Arc<Model>,
        params: Shared<Params>,
        changes: &BTreeMap<&'static str, &[f64]>,
    ) -> Result<Self, EnvError> {
        Ok(Self {
            engines: Arc::new(Engines::new(&self.config, &model)?),
            tables: SharedTables::new(&self.config, &model)?,
            model,
            params,
            identity: Arc::new(self.origin.identity.with_changes(changes)),
            ..self.clone()
        })
    }

    /// Returns the same blueprint with a model in which slots stand for other bodies. Snapshots of both are exchangeable.
    #[cfg(feature = "rapier")]
    pub(crate) fn with_slots(&self, model: Model, adopt: impl FnOnce(&Model, &mut Params)) -> Result<Self, EnvError> {
        let model = Arc::new(model);
        let mut params = self.params.clone();
        adopt(&model, &mut params);
        let blueprint = Self {
            engines: Arc::new(Engines::new(&self.config, &model)?),
            tables: SharedTables::new(&self.config, &model)?,
            model,
            params,
            surface: SkinAndScenery {
                scenery: Arc::default(),
                painting: RendererPool::default(),
                gpu: Arc::default(),
                ..self.surface.clone()
            },
            ..self.clone()
        };
        if blueprint.config.vision_active {
            blueprint.scenery()?;
        }
        Ok(blueprint)
    }
}
