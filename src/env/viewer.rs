//! Pictures of environments for display.

use super::{Blueprint, Env, EnvError, missing_camera, pipeline};
use crate::math::Vec3;
use crate::model::Model;
use crate::render::{FreeCamera, Poses, RenderRequest, Renderer, View};
use crate::sensors::transform::{Signal, Transform};
use crate::sensors::{EYES, EyeImages};
use crate::spaces::NumpyRng;

/// The camera of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewFrom<'a> {
    /// A camera of the scene, by name: `corner`, `top`, `side1`, `side2`, `closeup`, `eye_left` or `eye_right`.
    Camera(&'a str),
    /// A camera at any pose.
    Free(FreeCamera),
}

impl<'a> ViewFrom<'a> {
    /// Returns a camera of the scene, or, if the scene has none of that name, a free camera that looks at MIMo from that camera's place
    /// in the room. Scenes of tasks only have eyes.
    pub fn room(env: &Env, name: &'a str) -> Self {
        match room_camera(env.model(), &env.state().xpos, name) {
            Some(camera) => Self::Free(camera),
            None => Self::Camera(name),
        }
    }
}

/// Returns the place of a camera of the room, for scenes that lack it.
pub(crate) fn room_camera(model: &Model, xpos: &[Vec3], name: &str) -> Option<FreeCamera> {
    let (distance, azimuth, elevation) = match name {
        "corner" => (1.8, 135.0, -25.0),
        "top" => (1.8, 90.0, -90.0),
        "side1" => (1.8, 180.0, -5.0),
        "side2" => (1.8, -90.0, -5.0),
        "closeup" => (1.0, 150.0, -30.0),
        _ => return None,
    };
    if model.camera(name).is_some() {
        return None;
    }
    Some(FreeCamera {
        lookat: *xpos.get(model.body("hip")?)?,
        distance,
        azimuth,
        elevation,
    })
}

impl<'a> From<&'a str> for ViewFrom<'a> {
    fn from(name: &'a str) -> Self {
        Self::Camera(name)
    }
}

impl From<FreeCamera> for ViewFrom<'_> {
    fn from(camera: FreeCamera) -> Self {
        Self::Free(camera)
    }
}

/// A renderer that draws environments of one blueprint from the cameras of their scene, for display.
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
pub struct Viewer {
    renderer: Renderer,
    rgb: Vec<u8>,
    rgba: Vec<u8>,
    /// The transforms of the eyes' images, made on first use.
    optics: Option<[Vec<Box<dyn Transform>>; 2]>,
}

impl std::fmt::Debug for Viewer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Viewer")
            .field("renderer", &self.renderer)
            .finish_non_exhaustive()
    }
}

impl Viewer {
    /// Creates a viewer with the renderer that the blueprint's configuration selects.
    ///
    /// # Errors
    /// As [`Blueprint::renderer`].
    pub fn new(blueprint: &Blueprint) -> Result<Self, EnvError> {
        Ok(Self {
            renderer: blueprint.renderer()?,
            rgb: Vec::new(),
            rgba: Vec::new(),
            optics: None,
        })
    }

    /// Draws the room from the camera `corner`, or from the place that [`ViewFrom::room`] gives, with `render_size` by `render_size` pixels:
    /// Gymnasium's `render`.
    ///
    /// # Errors
    /// As [`Viewer::draw`].
    pub fn render(&mut self, env: &Env) -> Result<&[u8], EnvError> {
        let size = env.config().render_size as usize;
        self.draw(env, ViewFrom::room(env, "corner"), size, size)
    }

    /// Draws an environment from a camera of its scene, by name, or from a [`FreeCamera`]. Returns red, green and blue of
    /// each pixel, rows from the top. Like the eyes, the picture shows the start of the last physics step.
    ///
    /// # Errors
    /// A camera that does not exist or has no valid pose, a size that is not allowed, a GPU that fails.
    pub fn draw<'c>(
        &mut self,
        env: &Env,
        from: impl Into<ViewFrom<'c>>,
        width: usize,
        height: usize,
    ) -> Result<&[u8], EnvError> {
        env.physics.check_shape()?;
        let mut poses = Poses::from(env.state());
        let camera = match from.into() {
            ViewFrom::Camera(name) => {
                let camera = env.model().camera(name);
                camera.ok_or_else(|| missing_camera(name, "rendering"))?
            }
            ViewFrom::Free(camera) => {
                poses.free = Some(camera.pose()?);
                View::FREE
            }
        };
        let view = View { camera, width, height };
        view.check()?;
        self.rgb.resize(view.rgb_len(), 0);
        self.renderer
            .rgb(&[RenderRequest { poses, view }], [&mut self.rgb[..]])?;
        Ok(&self.rgb)
    }

    /// Draws like [`Viewer::draw`]. Returns red, green, blue and 255 of each pixel, as canvases take them.
    ///
    /// # Errors
    /// As [`Viewer::draw`].
    pub fn draw_rgba<'c>(
        &mut self,
        env: &Env,
        from: impl Into<ViewFrom<'c>>,
        width: usize,
        height: usize,
    ) -> Result<&[u8], EnvError> {
        self.draw(env, from, width, height)?;
        self.rgba.clear();
        let pixels = self.rgb.as_chunks::<3>().0;
        self.rgba.extend(pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]));
        Ok(&self.rgba)
    }

    /// Draws the current view of both eyes, with the acuity and the foveation of the configuration. Noise and delay belong to the
    /// observation, which does not change. Returns the left and then the right picture, of the sizes of the observation: red, green, blue
    /// and 255 of each pixel.
    ///
    /// ```
    /// use babybench::env::Viewer;
    /// use babybench::{Config, Env};
    ///
    /// let config = Config { touch_active: false, vision_resolution: 16, ..Config::default() };
    /// let mut env = Env::new(config)?;
    /// env.reset(Some(0))?;
    /// let mut viewer = Viewer::new(env.blueprint())?;
    /// let pictures = viewer.eyes_rgba(&env)?;
    /// assert_eq!(pictures.len(), 2 * 4 * 16 * 16);
    /// let left = pictures.as_chunks::<4>().0.iter().flat_map(|&[r, g, b, _]| [r, g, b]);
    /// assert!(left.take(3 * 16 * 16).eq(env.observation().eye_left.unwrap_or_default().iter().copied()));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Viewer::draw`].
    pub fn eyes_rgba(&mut self, env: &Env) -> Result<&[u8], EnvError> {
        let sizes = env.config().eye_sizes();
        // taken out, because drawing borrows the viewer
        let optics = self.optics.take();
        let mut optics =
            optics.unwrap_or_else(|| [0, 1].map(|eye| pipeline::optics(env.model(), env.config(), eye, sizes[eye])));
        let mut rgba = std::mem::take(&mut self.rgba);
        rgba.clear();
        for ((eye, [width, height]), transforms) in EYES.into_iter().zip(sizes).zip(&mut optics) {
            self.draw(env, eye, width, height)?;
            let rgb = std::mem::take(&mut self.rgb);
            let mut images = EyeImages {
                rgb,
                ..EyeImages::default()
            };
            for transform in transforms {
                let signal = Signal::Eye {
                    images: &mut images,
                    height,
                    width,
                };
                transform.apply(signal, &mut NumpyRng::seed(0)); // neither acuity nor foveation uses it
            }
            self.rgb = images.rgb;
            let pixels = self.rgb.as_chunks::<3>().0;
            rgba.extend(pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]));
        }
        self.optics = Some(optics);
        self.rgba = rgba;
        Ok(&self.rgba)
    }
}
