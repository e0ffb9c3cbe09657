//! The ingredients of a blueprint.

use std::sync::Arc;

use crate::assets::AssetSource;
use crate::env::Task;
use crate::mimo::embedded;

/// The task and the assets that a blueprint is built from, besides its configuration.
///
/// ```
/// use babybench::assets::{MemoryAssets, Overlay};
/// use babybench::config::Scene;
/// use babybench::env::BlueprintOptions;
/// use babybench::mimo::embedded;
/// use babybench::{Blueprint, Config};
///
/// // custom files over the embedded ones
/// let mut own = MemoryAssets::new();
/// let wall = "<geom name='wall' type='box' size='.05 1 .5' pos='2 0 .5'/>";
/// own.insert("babybench/crib.xml", format!("<mujocoinclude><worldbody>{wall}</worldbody></mujocoinclude>"))?;
/// let options = BlueprintOptions::default().with_assets(Overlay::new(embedded()).with(own));
/// let config = Config { scene: Scene::Crib, touch_active: false, vision_active: false, ..Config::default() };
/// let blueprint = Blueprint::with(config, options)?;
/// assert!(blueprint.model().geom_name.iter().any(|name| name == "wall"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct BlueprintOptions {
    /// The task; `None` for that of the key `behavior`, which is otherwise ignored.
    pub task: Option<Box<dyn Task>>,
    /// The source of documents and textures, laid out like the embedded ones, which are the default. A custom scene
    /// ([`Scene::File`](crate::config::Scene::File)) is searched for here first; the source may then have only the scene's own files.
    pub assets: Arc<dyn AssetSource>,
}

impl Default for BlueprintOptions {
    fn default() -> Self {
        Self {
            task: None,
            assets: Arc::new(embedded()),
        }
    }
}

impl BlueprintOptions {
    /// Sets the task.
    #[must_use]
    pub fn with_task(mut self, task: impl Task + 'static) -> Self {
        self.task = Some(Box::new(task));
        self
    }

    /// Sets the source of documents and textures.
    #[must_use]
    pub fn with_assets(mut self, assets: impl AssetSource + 'static) -> Self {
        self.assets = Arc::new(assets);
        self
    }
}

impl std::fmt::Debug for BlueprintOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BlueprintOptions")
            .field("task", &self.task)
            .finish_non_exhaustive()
    }
}
