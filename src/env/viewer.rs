//! Pictures of environments for people.

use crate::env::{Blueprint, Env, EnvError, missing_camera};
use crate::render::{Poses, RenderRequest, Renderer, View};

/// A renderer of environments of one blueprint from the cameras of their scene, for people to look at.
///
/// ```
/// use babybench::env::Viewer;
/// use babybench::{Config, Env};
///
/// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
/// env.reset(Some(0))?;
/// let mut viewer = Viewer::new(env.blueprint())?;
/// let rgb = viewer.draw(&env, "closeup", 32, 24)?;
/// assert_eq!(rgb.len(), 3 * 32 * 24);
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[derive(Debug)]
pub struct Viewer {
    renderer: Renderer,
    rgb: Vec<u8>,
}

impl Viewer {
    /// Creates a viewer with the renderer that the blueprint's configuration asks for.
    ///
    /// # Errors
    /// As [`Blueprint::renderer`].
    pub fn new(blueprint: &Blueprint) -> Result<Self, EnvError> {
        Ok(Self {
            renderer: blueprint.renderer()?,
            rgb: Vec::new(),
        })
    }

    /// Draws the room from the camera `corner`, `render_size` by `render_size` pixels: Gymnasium's `render`.
    ///
    /// # Errors
    /// As [`Viewer::draw`].
    pub fn render(&mut self, env: &Env) -> Result<&[u8], EnvError> {
        let size = env.config().render_size as usize;
        self.draw(env, "corner", size, size)
    }

    /// Draws an environment from a camera of its scene: `corner`, `top`, `side1`, `side2`, `closeup`, `eye_left` or
    /// `eye_right`. Returns red, green and blue of each pixel, rows from the top. Like the eyes, the picture shows the
    /// start of the last physics step.
    ///
    /// # Errors
    /// A camera that does not exist, a size that is not allowed, a GPU that fails.
    pub fn draw(&mut self, env: &Env, camera: &str, width: usize, height: usize) -> Result<&[u8], EnvError> {
        let camera = env
            .model()
            .camera(camera)
            .ok_or_else(|| missing_camera(camera, "rendering"))?;
        let view = View { camera, width, height };
        view.check()?;
        self.rgb.resize(view.rgb_len(), 0);
        let poses = Poses::from(env.state());
        self.renderer
            .rgb(&[RenderRequest { poses, view }], [&mut self.rgb[..]])?;
        Ok(&self.rgb)
    }
}
