//! Types of the elements of a model.

use crate::math::{QUAT_ID, Quat, Vec3};

/// The type of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointType {
    /// Six degrees of freedom; `qpos` is position (3) and quaternion (4), `qvel` linear velocity in the world frame (3)
    /// and angular velocity in the body frame (3).
    Free,
    /// Three rotations about an anchor; `qpos` is a quaternion (4), `qvel` the angular velocity in the body frame (3), rad/s.
    Ball,
    /// Translation along the axis, m.
    Slide,
    /// Rotation about the axis, rad.
    Hinge,
}

impl JointType {
    /// Returns the number of position coordinates.
    pub fn nq(self) -> usize {
        match self {
            Self::Free => 7,
            Self::Ball => 4,
            Self::Slide | Self::Hinge => 1,
        }
    }
    /// Returns where in `qpos` the quaternion is of a joint whose coordinates begin at `adr`, if it has one.
    pub(crate) fn quat(self, adr: usize) -> Option<usize> {
        match self {
            Self::Free => Some(adr + 3),
            Self::Ball => Some(adr),
            Self::Slide | Self::Hinge => None,
        }
    }

    /// Returns the number of degrees of freedom.
    pub fn nv(self) -> usize {
        match self {
            Self::Free => 6,
            Self::Ball => 3,
            Self::Slide | Self::Hinge => 1,
        }
    }
}

/// The shape of a geom or site, with the meaning of `size`.
///
/// The order is MuJoCo's, by which pairs are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GeomType {
    /// Infinite for collision; `size` is half width, half length, grid spacing.
    Plane,
    /// A height field; `size` is half width, half length, and half of a mean height over the base.
    HField,
    /// `size` is the radius.
    Sphere,
    /// `size` is radius, half length of the segment along z.
    Capsule,
    /// `size` is the semi-axes. Drawn and touch-sensed only: it takes part in no collision.
    Ellipsoid,
    /// `size` is radius, half height along z.
    Cylinder,
    /// `size` is the half lengths.
    Box,
    /// A triangle mesh, of which the convex hull touches; `size` is the largest distance from its centre along each axis.
    Mesh,
}

/// The known frame, if any, that the frame of something in a body coincides with.
///
/// MuJoCo copies such frames instead of composing them, which shows in the last bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SameFrame {
    /// A frame of its own.
    None,
    /// The body's frame.
    Body,
    /// The inertial frame.
    Inertia,
    /// The body's orientation.
    BodyRot,
    /// The orientation of the inertial frame.
    InertiaRot,
}

impl SameFrame {
    /// Compares a pose in a body with the body's own frame and its inertial frame, to within 1e-6 in each number.
    pub fn of(pos: Vec3, quat: Quat, ipos: Vec3, iquat: Quat) -> Self {
        let close = |a: &[f64], b: &[f64], sign: f64| a.iter().zip(b).all(|(x, y)| (x - sign * y).abs() < 1e-6);
        let same_quat = |other: Quat| close(&quat, &other, 1.0) || close(&quat, &other, -1.0);
        let (level, aligned) = (same_quat(QUAT_ID), same_quat(iquat));
        if level && close(&pos, &[0.0; 3], 1.0) {
            Self::Body
        } else if aligned && close(&pos, &ipos, 1.0) {
            Self::Inertia
        } else if level {
            Self::BodyRot
        } else if aligned {
            Self::InertiaRot
        } else {
            Self::None
        }
    }
}

/// An equality constraint, with what it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EqualityKind {
    /// `y - y0 = polycoef(x - x0)` with `y` the first joint and `x` the second; without a second joint `y - y0 = polycoef[0]`.
    Joint {
        /// The constrained joint.
        joint1: usize,
        /// The joint it follows.
        joint2: Option<usize>,
        /// Coefficients of the quartic polynomial.
        polycoef: [f64; 5],
    },
    /// `y - y0 = polycoef(x - x0)` with `y` the length of the first tendon and `x` that of the second, `y0` and `x0` those at
    /// `qpos0`; without a second tendon `y - y0 = polycoef[0]`.
    Tendon {
        /// The constrained tendon.
        tendon1: usize,
        /// The tendon it follows.
        tendon2: Option<usize>,
        /// Coefficients of the quartic polynomial.
        polycoef: [f64; 5],
    },
    /// A point of body 1 and a point of body 2 stay together.
    Connect {
        /// First body.
        body1: usize,
        /// Second body; the world by default.
        body2: usize,
        /// The point in body 1, m.
        anchor1: Vec3,
        /// The point in body 2, m: where the first one is at `qpos0`.
        anchor2: Vec3,
    },
    /// Body 1 keeps its pose relative to body 2.
    Weld {
        /// First body.
        body1: usize,
        /// Second body; the world by default.
        body2: usize,
        /// Point of the constraint in body 2, m.
        anchor: Vec3,
        /// Position of body 2 relative to body 1 at the anchor, in body 1, m (MuJoCo's `relpose`).
        relpos: Vec3,
        /// Orientation of body 2 relative to body 1.
        relquat: Quat,
        /// Weight of the rotational rows.
        torquescale: f64,
    },
}

/// What a tendon runs along (MuJoCo's `mjtWrap`). A fixed tendon has joints only, a spatial one everything else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrap {
    /// A joint of one coordinate, which counts times `coef` in the length.
    Joint {
        /// The joint.
        joint: usize,
        /// Length of the tendon per coordinate.
        coef: f64,
    },
    /// A pulley: what follows counts divided by `divisor` in the length.
    Pulley {
        /// The divisor, which is positive.
        divisor: f64,
    },
    /// A site, which the tendon passes through.
    Site {
        /// The site.
        site: usize,
    },
    /// A sphere between two sites, around which the tendon wraps where it is in the way.
    Sphere {
        /// The geom.
        geom: usize,
        /// The site on whose side the tendon stays; one inside of the sphere makes the tendon pass through it and touch it from inside.
        side: Option<usize>,
    },
    /// A cylinder without ends, likewise.
    Cylinder {
        /// The geom.
        geom: usize,
        /// The site on whose side the tendon stays.
        side: Option<usize>,
    },
}

impl Wrap {
    /// Returns the body of a site or a geom.
    pub(crate) fn body(&self, model: &super::Arrays) -> Option<usize> {
        match *self {
            Self::Site { site } => Some(model.site_bodyid[site]),
            Self::Sphere { geom, .. } | Self::Cylinder { geom, .. } => Some(model.geom_bodyid[geom]),
            Self::Joint { .. } | Self::Pulley { .. } => None,
        }
    }
}

/// What an actuator acts on: `actuator_trnid` is its id (MuJoCo's `mjtTrn`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TrnType {
    /// A joint.
    Joint,
    /// A joint, with forces in the frame of the parent: the same for joints of one coordinate.
    JointInParent,
    /// A slider-crank: two sites joined by a rod, of which the slider is the one that the actuator moves along its z axis.
    SliderCrank,
    /// A tendon.
    Tendon,
    /// A site, on which six gears make a wrench, in its frame or that of a reference site.
    Site,
    /// The contacts of a body, which the actuator presses together.
    Body,
}

/// The dynamics of an actuator's activation, from which the force follows in place of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DynType {
    /// No activation: the force follows from the control.
    None,
    /// The integral of the control over time, s.
    Integrator,
    /// A linear filter of the control with time constant `dynprm[0]`, s, integrated by Euler's method.
    Filter,
    /// The same filter, integrated exactly.
    FilterExact,
    /// A muscle's: a filter of the control, within 0 and 1, with time constants that depend on the activation: `dynprm` is that of
    /// activation and of deactivation, s, and the width of the transition between them.
    Muscle,
}

/// The type of an actuator's gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GainType {
    /// `gainprm[0]`.
    Fixed,
    /// `gainprm[0] + gainprm[1] length + gainprm[2] velocity` (damper).
    Affine,
    /// The active force of a muscle. `gainprm` is its working range in optimal lengths (2), isometric force, N, or negative for
    /// `scale` over `actuator_acc0`, `scale`, shortest and longest length with an active force, optimal lengths, greatest speed,
    /// optimal lengths/s, passive force at the longest length and active force when stretched fastest, isometric forces.
    Muscle,
}

/// The type of an actuator's bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BiasType {
    /// No bias (motor).
    None,
    /// `biasprm[0] + biasprm[1] length + biasprm[2] velocity` (position servo).
    Affine,
    /// The passive force of a muscle; `biasprm` is as `gainprm` of [`GainType::Muscle`].
    Muscle,
}

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
    /// The face of each square, row by row, by its place in `cube_files`; empty where nothing is said.
    pub gridlayout: Vec<Option<usize>>,
    /// Whether images are mirrored from left to right, and from top to bottom.
    pub flip: [bool; 2],
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
    /// Repeat per unit length instead of per object.
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
    /// Position in the body, m.
    pub pos: Vec3,
    /// Unit direction in the body.
    pub dir: Vec3,
    /// How it is placed and aimed.
    pub mode: CamLight,
    /// Body that it shines at in modes that aim at one.
    pub targetbodyid: Option<usize>,
    /// Position at `qpos0` relative to the origin of its body, along the axes of the world, m.
    pub pos0: Vec3,
    /// Position at `qpos0` relative to the centre of mass of the target, or else its body, and those below,
    /// along the axes of the world, m.
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

/// A state that a document names (`<keyframe><key>`).
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe {
    /// Name; may be empty.
    pub name: String,
    /// Time, s.
    pub time: f64,
    /// Positions (nq).
    pub qpos: Vec<f64>,
    /// Velocities (nv).
    pub qvel: Vec<f64>,
    /// Activations (na).
    pub act: Vec<f64>,
    /// Controls (nu).
    pub ctrl: Vec<f64>,
    /// Positions of mocap bodies (nmocap), m.
    pub mpos: Vec<Vec3>,
    /// Orientations of mocap bodies (nmocap).
    pub mquat: Vec<Quat>,
}

/// The shape of the friction cones of contacts (`<option cone>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ConeType {
    /// Pyramids: each contact has `2 (dim - 1)` edges, rows whose force is not negative. MuJoCo's default.
    #[default]
    Pyramidal,
    /// Elliptic cones: each contact has `dim` rows, the normal first.
    Elliptic,
}

/// The format of the constraint Jacobian in MuJoCo (`<option jacobian>`).
///
/// Ours has one format. What the choice still decides is which equalities without any effect MuJoCo keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum JacobianFormat {
    /// Dense matrices.
    Dense,
    /// Sparse matrices.
    Sparse,
    /// Sparse from 60 degrees of freedom on.
    #[default]
    Auto,
}

impl JacobianFormat {
    /// Tells whether MuJoCo stores the Jacobian of a model with `nv` degrees of freedom sparsely (`mj_isSparse`).
    pub fn is_sparse(self, nv: usize) -> bool {
        match self {
            Self::Dense => false,
            Self::Sparse => true,
            Self::Auto => nv >= 60,
        }
    }
}

/// The options of solver and integrator (`<option>`).
#[doc(alias = "mjOption")]
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Time step, s.
    pub timestep: f64,
    /// Gravity, m/s^2.
    pub gravity: Vec3,
    /// Greatest number of iterations of the solver per step.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub iterations: usize,
    /// Scaled improvement or gradient below which the solver stops.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub tolerance: f64,
    /// Greatest number of iterations of the solver against slip, which changes friction after the other; 0 for none.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub noslip_iterations: usize,
    /// Scaled improvement below which it stops.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub noslip_tolerance: f64,
    /// Greatest number of line-search iterations per Newton iteration.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub ls_iterations: usize,
    /// Line-search tolerance.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub ls_tolerance: f64,
    /// Ratio of frictional to normal constraint impedance.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub impratio: f64,
    /// Shape of the friction cones.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub cone: ConeType,
    /// Format of the constraint Jacobian in MuJoCo.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub jacobian: JacobianFormat,
    /// Greatest number of iterations of the convex collision routine.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub ccd_iterations: usize,
    /// Tolerance of the convex collision routine, m.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub ccd_tolerance: f64,
    /// Solver of constraints.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub solver: SolverType,
    /// Method of integration.
    pub integrator: IntegratorType,
    /// Density of the medium around bodies, kg/m^3; 0 for none.
    pub density: f64,
    /// Viscosity of the medium around bodies, Pa s; 0 for none.
    pub viscosity: f64,
    /// Velocity of the medium, m/s.
    pub wind: Vec3,
    /// Magnetic flux, which magnetometers read.
    pub magnetic: Vec3,
    /// Parts of the simulation that may be switched off.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub flags: Flags,
}

impl Options {
    /// Returns the least time constant that a `solref` may have, s: two time steps, unless the flag `refsafe` is off.
    pub(crate) fn least_timeconst(&self) -> f64 {
        if self.flags.refsafe { 2.0 * self.timestep } else { 0.0 }
    }
}

/// The solver of constraints (`<option solver>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SolverType {
    /// Newton's method on the accelerations, with exact line search.
    #[default]
    Newton,
    /// Conjugate gradients (Polak and Ribiere) on the accelerations, with exact line search.
    Cg,
    /// Projected Gauss-Seidel on the forces.
    Pgs,
}

/// The method of integration (`<option integrator>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum IntegratorType {
    /// Euler's semi-implicit method, with implicit joint damping.
    #[default]
    Euler,
    /// Euler's method, implicit in velocity: forces of the medium, of dampers, of actuators, of Coriolis.
    Implicit,
    /// The same without Coriolis forces.
    ImplicitFast,
    /// The fourth-order method of Runge and Kutta.
    Rk4,
}

/// The parts of a simulation that a document may switch off (`<option><flag>`); all but `multiccd` are on by
/// default.
#[doc(alias = "mjtDisableBit")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flags {
    /// All constraints.
    pub constraint: bool,
    /// Equalities.
    pub equality: bool,
    /// Dry friction.
    pub frictionloss: bool,
    /// Limits of joints and tendons.
    pub limit: bool,
    /// Contacts.
    pub contact: bool,
    /// Springs, dampers, the medium, compensated gravity.
    pub passive: bool,
    /// Gravity.
    pub gravity: bool,
    /// Clamping of controls to their range.
    pub clampctrl: bool,
    /// Start of the solver from the last acceleration.
    pub warmstart: bool,
    /// Geoms of a body pass through those of its parent.
    pub filterparent: bool,
    /// Actuators.
    pub actuation: bool,
    /// Time constants of at least two time steps.
    pub refsafe: bool,
    /// Sensors.
    pub sensor: bool,
    /// Contacts of two bodies listed by the types of the geoms, not by their ids. It changes nothing else.
    pub midphase: bool,
    /// Implicit joint damping in Euler's method.
    pub eulerdamp: bool,
    /// MuJoCo's own convex collision; models in which another could be seen are refused.
    pub nativeccd: bool,
    /// Several contacts of a convex pair; off by default. Models in which it could be seen are refused.
    pub multiccd: bool,
}

/// The visual settings (`<visual>`) as MuJoCo stores them, in single precision where it does.
#[doc(alias = "mjVisual")]
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Vertical field of view of the free camera, degrees.
    pub fovy: f64,
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

/// The statistics of a model (`<statistic>`), given or computed.
#[doc(alias = "mjStatistic")]
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Statistic {
    /// Mean diagonal of the joint-space inertia, kg m^2.
    pub meaninertia: f64,
    /// Mean body mass, kg.
    pub meanmass: f64,
    /// Mean body size, m.
    pub meansize: f64,
    /// Spatial extent, m.
    pub extent: f64,
    /// Centre of the model, m.
    pub center: Vec3,
}
