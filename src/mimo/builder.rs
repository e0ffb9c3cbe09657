//! A scene of the library with custom bodies.

use quick_xml::escape::escape;

use crate::config::{Config, Scene};
use crate::math::Vec3;

/// Adds custom bodies to a scene of the library, without writing files.
///
/// Additions are [MJCF](https://mujoco.readthedocs.io/en/3.3.0/XMLreference.html): elements of the world (bodies, geoms, sites, cameras, lights, frames) and whole sections (assets, defaults, contacts, equalities, actuators, sensors,
/// keyframes). They become [`Config::scene_extra`], so everything that takes a configuration accepts them.
///
/// ```
/// use babybench::config::Scene;
/// use babybench::mimo::SceneBuilder;
/// use babybench::{Blueprint, Config};
///
/// let scene = SceneBuilder::new(Scene::Crib)
///     .body("ball", [0.2, 0.1, 0.4], "<freejoint/><geom size='0.04' mass='0.03' material='red'/>")
///     .with("<asset><material name='red' rgba='1 0.2 0.2 1'/></asset>");
/// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
/// let blueprint = Blueprint::new(scene.config(config.clone()))?;
/// assert!(blueprint.model().body("ball").is_some());
///
/// // errors name a place: each fragment begins on a line of its own
/// let error = Blueprint::new(scene.with("<geom colour='0.1'/>").config(config)).unwrap_err();
/// assert!(error.to_string().contains("scene_extra:3:"), "{error}");
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneBuilder {
    scene: Scene,
    extra: String,
}

impl SceneBuilder {
    /// Starts with a scene of the library. Nothing can be added to a custom document: [`Config::validate`] refuses it.
    pub fn new(scene: Scene) -> Self {
        Self {
            scene,
            extra: String::new(),
        }
    }

    /// Adds elements of the world or whole sections.
    #[must_use]
    pub fn with(mut self, mjcf: &str) -> Self {
        if !self.extra.is_empty() {
            self.extra.push('\n');
        }
        self.extra.push_str(mjcf.trim_end());
        self
    }

    /// Adds a body with a name and its contents (joints, geoms, bodies) at a position (m).
    #[must_use]
    pub fn body(self, name: &str, pos: Vec3, content: &str) -> Self {
        let [x, y, z] = pos;
        self.with(&format!(
            "<body name=\"{}\" pos=\"{x:?} {y:?} {z:?}\">{content}</body>",
            escape(name)
        ))
    }

    /// Returns the additions as a value of the key `scene_extra`.
    pub fn extra(&self) -> &str {
        &self.extra
    }

    /// Returns a configuration with the scene.
    pub fn config(&self, config: Config) -> Config {
        Config {
            scene: self.scene.clone(),
            scene_extra: self.extra.clone(),
            ..config
        }
    }
}
