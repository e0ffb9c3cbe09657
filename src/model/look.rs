//! The look of a scene: textures, materials, lights, visual settings.

use crate::math::Vec3;

/// The layout of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureType {
    /// One image.
    Flat2d,
    /// Six images on a cube.
    Cube,
    /// Six images of the background.
    Skybox,
}

/// The procedure that paints a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Builtin {
    /// None: from files, or `rgb1`.
    None,
    /// From `rgb1` to `rgb2`.
    Gradient,
    /// Two by two squares of `rgb1` and `rgb2`.
    Checker,
    /// `rgb1`; the lower side `rgb2`.
    Flat,
}

/// The marks drawn over a procedural texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mark {
    /// None.
    None,
    /// The edges of each tile.
    Edge,
    /// A cross.
    Cross,
    /// Random dots.
    Random,
}

/// The recipe of a texture.
///
/// Pixels are decoded by the renderer; the model keeps the recipe.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name; may be empty (skybox).
    pub name: String,
    /// Layout.
    pub kind: TextureType,
    /// Procedure.
    pub builtin: Builtin,
    /// Marks.
    pub mark: Mark,
    /// First colour, 0..1.
    pub rgb1: [f64; 3],
    /// Second colour, 0..1.
    pub rgb2: [f64; 3],
    /// Colour of the marks, 0..1.
    pub markrgb: [f64; 3],
    /// Probability of a random dot.
    pub random: f64,
    /// Width of a procedural texture, pixels.
    pub width: usize,
    /// Height of a procedural texture, pixels.
    pub height: usize,
    /// Path of the single image file, in the asset source.
    pub file: Option<String>,
    /// Rows and columns of squares in that image, for a cube.
    pub gridsize: [usize; 2],
    /// The face of each square, row by row, by its index in `cube_files`; empty if not given.
    pub gridlayout: Vec<Option<usize>>,
    /// Whether images are mirrored from left to right, and from top to bottom.
    pub flip: [bool; 2],
    /// Numbers of a pixel (`tex_nchannel`): 3, or 4 with an opacity.
    pub channels: usize,
    /// Paths of the cube faces: right, left, up, down, front, back.
    pub cube_files: [Option<String>; 6],
}

/// A material: the look of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Index into [`crate::model::Arrays::textures`].
    pub texture: Option<usize>,
    /// Colour and opacity, 0..1.
    pub rgba: [f64; 4],
    /// Specular strength, 0..1.
    pub specular: f64,
    /// Shininess, 0..1.
    pub shininess: f64,
    /// Reflectance, 0..1.
    pub reflectance: f64,
    /// Emission, 0..1.
    pub emission: f64,
    /// Repetitions of a 2d texture.
    pub texrepeat: [f64; 2],
    /// Whether the texture repeats per unit length instead of per object.
    pub texuniform: bool,
}

/// The mode of a camera or a light: how it is placed and aimed (MuJoCo's `mjtCamLight`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CamLight {
    /// Moves and turns with its body.
    Fixed,
    /// Keeps its orientation in the world and its distance from the origin of its body.
    Track,
    /// Keeps its orientation in the world and its distance from the centre of mass of its body and those below it.
    TrackCom,
    /// Moves with its body and aims at the origin of the target.
    TargetBody,
    /// Moves with its body and aims at the centre of mass of the target and the bodies below it.
    TargetBodyCom,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name; may be empty.
    pub name: String,
    /// Body that carries it.
    pub bodyid: usize,
    /// Whether the light is directional: parallel, from far away.
    pub directional: bool,
    /// Whether it casts shadows.
    pub castshadow: bool,
    /// Whether it is on (`light_active`); pictures leave out lights that are off.
    pub active: bool,
    /// Position in the body, m.
    pub pos: Vec3,
    /// Unit direction in the body.
    pub dir: Vec3,
    /// How it is placed and aimed.
    pub mode: CamLight,
    /// Body at which it shines in modes that aim at one.
    pub targetbodyid: Option<usize>,
    /// Position at `qpos0` relative to the origin of its body, along the axes of the world, m.
    pub pos0: Vec3,
    /// Position at `qpos0` relative to the centre of mass of the target (or else of its body) and the bodies below, along the axes of the world, m.
    pub poscom0: Vec3,
    /// Unit direction at `qpos0` in the world.
    pub dir0: Vec3,
    /// Colours, 0..1.
    pub ambient: [f64; 3],
    /// Colours, 0..1.
    pub diffuse: [f64; 3],
    /// Colours, 0..1.
    pub specular: [f64; 3],
    /// Constant, linear and quadratic attenuation.
    pub attenuation: [f64; 3],
    /// Cutoff angle of a spot light, degrees.
    pub cutoff: f64,
    /// Softness of a spot light.
    pub exponent: f64,
}

/// The visual settings (`<visual>`) as MuJoCo stores them, in single precision where it does.
#[doc(alias = "mjVisual")]
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Vertical field of view of the free camera, degrees.
    pub fovy: f64,
    /// Initial direction of the free camera about the vertical axis, degrees; 0 is along x.
    pub azimuth: f64,
    /// Angle of that view above the horizon, degrees.
    pub elevation: f64,
    /// Near plane, times the extent.
    pub znear: f64,
    /// Far plane, times the extent.
    pub zfar: f64,
    /// Start of fog, times the extent.
    pub fogstart: f64,
    /// End of fog, times the extent.
    pub fogend: f64,
    /// Haze at the horizon, 0..1.
    pub haze: f64,
    /// Clip distance of shadows, times the extent.
    pub shadowclip: f64,
    /// Scale of drawn forces.
    pub force: f64,
    /// Size of the shadow map, pixels; 0 means no shadows.
    pub shadowsize: usize,
    /// Samples per pixel offscreen.
    pub offsamples: usize,
    /// Offscreen width, pixels.
    pub offwidth: usize,
    /// Offscreen height, pixels.
    pub offheight: usize,
    /// Whether the headlight is on.
    pub headlight_active: bool,
    /// Headlight colours, 0..1.
    pub headlight_ambient: [f64; 3],
    /// Headlight colours, 0..1.
    pub headlight_diffuse: [f64; 3],
    /// Headlight colours, 0..1.
    pub headlight_specular: [f64; 3],
}
