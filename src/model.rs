//! The compiled model: everything about a scene that does not change while it runs.
//!
//! Arrays carry MuJoCo's names, ids and units (SI, radians), one entry per element in document order, so a number here
//! can be laid beside the same number there. A [`Model`] is immutable after compilation and is shared in an
//! [`std::sync::Arc`]; what changes at run time lives in [`crate::physics::State`].

use crate::math::{QUAT_ID, Quat, Vec3};

macro_rules! id {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);
    )*};
}

id! {
    /// Index of a body; 0 is the world.
    BodyId,
    /// Index of a joint.
    JointId,
    /// Index of a degree of freedom.
    DofId,
    /// Index of a geom.
    GeomId,
    /// Index of a site.
    SiteId,
    /// Index of a camera.
    CameraId,
    /// Index of an actuator.
    ActuatorId,
    /// Index of an equality constraint.
    EqualityId,
    /// Index of a tendon.
    TendonId,
    /// Index of a sensor.
    SensorId,
}

/// Joint types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointType {
    /// Six degrees of freedom; `qpos` is position (3) and quaternion (4), `qvel` linear velocity in the world frame (3)
    /// and angular velocity in the body frame (3).
    Free,
    /// Translation along the axis, m.
    Slide,
    /// Rotation about the axis, rad.
    Hinge,
}

impl JointType {
    /// Number of position coordinates.
    pub fn nq(self) -> usize {
        if self == JointType::Free { 7 } else { 1 }
    }
    /// Number of degrees of freedom.
    pub fn nv(self) -> usize {
        if self == JointType::Free { 6 } else { 1 }
    }
}

/// Geom and site shapes, with the meaning of `size`. The order is MuJoCo's, by which pairs are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GeomType {
    /// Infinite for collision; `size` is half width, half length, grid spacing.
    Plane,
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
}

/// Whether the frame of something in a body is one that is known already. MuJoCo copies such frames instead of composing
/// them, which shows in the last bits.
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

/// Camera modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CameraMode {
    /// Fixed in its body.
    Fixed,
    /// Fixed in its body, turned so that it looks at a target body.
    TargetBody(BodyId),
}

/// What an equality constraint holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EqualityKind {
    /// `y - y0 = polycoef(x - x0)` with `y` the first joint and `x` the second; without a second joint `y - y0 = polycoef[0]`.
    Joint {
        /// The constrained joint.
        joint1: JointId,
        /// The joint it follows.
        joint2: Option<JointId>,
        /// Coefficients of the quartic polynomial.
        polycoef: [f64; 5],
    },
    /// Body 1 keeps its pose relative to body 2.
    Weld {
        /// First body.
        body1: BodyId,
        /// Second body; the world by default.
        body2: BodyId,
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

/// Actuator bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BiasType {
    /// No bias (motor).
    None,
    /// `biasprm[0] + biasprm[1] length + biasprm[2] velocity` (position servo).
    Affine,
}

/// Sensors of the models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SensorType {
    /// Specific force at a site, m/s^2, site frame (3).
    Accelerometer,
    /// Angular velocity at a site, rad/s, site frame (3).
    Gyro,
    /// Torque that the parent exerts on the site's body, N m, site frame (3).
    Torque,
}

/// Texture layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureType {
    /// One image.
    Flat2d,
    /// Six images on a cube.
    Cube,
    /// Six images of the background.
    Skybox,
}

/// A procedural texture.
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

/// Marks drawn over a procedural texture.
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

/// How a texture is made. Pixels are decoded by the renderer; the model keeps the recipe.
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
    /// Paths of the cube faces: right, left, up, down, front, back.
    pub cube_files: [Option<String>; 6],
}

/// A surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Index into [`Model::textures`].
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

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name; may be empty.
    pub name: String,
    /// Body that carries it.
    pub bodyid: usize,
    /// Parallel light.
    pub directional: bool,
    /// Casts shadows.
    pub castshadow: bool,
    /// Position in the body, m.
    pub pos: Vec3,
    /// Unit direction in the body.
    pub dir: Vec3,
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

/// Solver and integrator options (`<option>`).
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Time step, s.
    pub timestep: f64,
    /// Gravity, m/s^2.
    pub gravity: Vec3,
    /// Most Newton iterations per step.
    pub iterations: usize,
    /// Newton stops when the scaled improvement or gradient is below this.
    pub tolerance: f64,
    /// Most line-search iterations per Newton iteration.
    pub ls_iterations: usize,
    /// Line-search tolerance.
    pub ls_tolerance: f64,
    /// Ratio of frictional to normal constraint impedance.
    pub impratio: f64,
    /// Most iterations of the convex collision routine.
    pub ccd_iterations: usize,
    /// Tolerance of the convex collision routine, m.
    pub ccd_tolerance: f64,
}

/// Visual settings (`<visual>`), as the reference stores them (single precision where it does).
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
    /// Headlight on.
    pub headlight_active: bool,
    /// Headlight colours, 0..1.
    pub headlight_ambient: [f64; 3],
    /// Headlight colours, 0..1.
    pub headlight_diffuse: [f64; 3],
    /// Headlight colours, 0..1.
    pub headlight_specular: [f64; 3],
}

/// Statistics of the model (`<statistic>`).
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

macro_rules! model {
    ($($(#[$doc:meta])* $field:ident : $ty:ty),* $(,)?) => {
        /// A compiled scene. See the [module documentation](self).
        #[derive(Clone, Debug, PartialEq)]
        pub struct Model { $($(#[$doc])* pub $field: $ty,)* }
    };
}

model! {
    /// Name of the model.
    name: String,
    /// Options.
    opt: Options,
    /// Visual settings.
    vis: Visual,
    /// Statistics.
    stat: Statistic,

    /// Number of position coordinates.
    nq: usize,
    /// Number of degrees of freedom.
    nv: usize,

    /// Body names (nbody); may be empty.
    body_name: Vec<String>,
    /// Parent body; 0 for the world itself.
    body_parentid: Vec<usize>,
    /// Top body of the tree that holds the body (the ancestor that is a child of the world).
    body_rootid: Vec<usize>,
    /// Body it is rigidly welded to: itself when it has joints, else its parent's.
    body_weldid: Vec<usize>,
    /// First joint, `njnt` range start.
    body_jntadr: Vec<usize>,
    /// Number of joints.
    body_jntnum: Vec<usize>,
    /// First degree of freedom.
    body_dofadr: Vec<usize>,
    /// Number of degrees of freedom.
    body_dofnum: Vec<usize>,
    /// First geom.
    body_geomadr: Vec<usize>,
    /// Number of geoms.
    body_geomnum: Vec<usize>,
    /// Position in the parent, m.
    body_pos: Vec<Vec3>,
    /// Orientation in the parent.
    body_quat: Vec<Quat>,
    /// Centre of mass in the body, m.
    body_ipos: Vec<Vec3>,
    /// Orientation of the principal axes in the body.
    body_iquat: Vec<Quat>,
    /// Mass, kg.
    body_mass: Vec<f64>,
    /// Mass of the subtree, kg.
    body_subtreemass: Vec<f64>,
    /// Principal moments of inertia, kg m^2.
    body_inertia: Vec<Vec3>,
    /// Whether the inertial frame is the body's.
    body_sameframe: Vec<SameFrame>,
    /// Mean inverse weight at `qpos0`: translation 1/kg, rotation 1/(kg m^2).
    body_invweight0: Vec<[f64; 2]>,

    /// Joint names.
    jnt_name: Vec<String>,
    /// Joint type.
    jnt_type: Vec<JointType>,
    /// Body that carries the joint.
    jnt_bodyid: Vec<usize>,
    /// First coordinate in `qpos`.
    jnt_qposadr: Vec<usize>,
    /// First coordinate in `qvel`.
    jnt_dofadr: Vec<usize>,
    /// Anchor in the body, m.
    jnt_pos: Vec<Vec3>,
    /// Unit axis in the body.
    jnt_axis: Vec<Vec3>,
    /// Whether `jnt_range` applies.
    jnt_limited: Vec<bool>,
    /// Lower and upper limit, rad or m.
    jnt_range: Vec<[f64; 2]>,
    /// Distance at which a limit becomes active.
    jnt_margin: Vec<f64>,
    /// Spring stiffness, N m/rad or N/m.
    jnt_stiffness: Vec<f64>,
    /// `solref` of the limit.
    jnt_solref: Vec<[f64; 2]>,
    /// `solimp` of the limit.
    jnt_solimp: Vec<[f64; 5]>,
    /// Visual group.
    jnt_group: Vec<usize>,

    /// Body of a degree of freedom.
    dof_bodyid: Vec<usize>,
    /// Joint of a degree of freedom.
    dof_jntid: Vec<usize>,
    /// Next degree of freedom towards the root.
    dof_parentid: Vec<Option<usize>>,
    /// Inertia of the rotor, kg m^2.
    dof_armature: Vec<f64>,
    /// Damping, N m s/rad.
    dof_damping: Vec<f64>,
    /// Dry friction, N m.
    dof_frictionloss: Vec<f64>,
    /// Diagonal of the inverse inertia at `qpos0`.
    dof_invweight0: Vec<f64>,
    /// `solref` of dry friction.
    dof_solref: Vec<[f64; 2]>,
    /// `solimp` of dry friction.
    dof_solimp: Vec<[f64; 5]>,

    /// Reference configuration (nq).
    qpos0: Vec<f64>,
    /// Rest configuration of the springs (nq).
    qpos_spring: Vec<f64>,

    /// Geom names; may be empty.
    geom_name: Vec<String>,
    /// Shape.
    geom_type: Vec<GeomType>,
    /// Size, m; see [`GeomType`].
    geom_size: Vec<Vec3>,
    /// Body that carries the geom.
    geom_bodyid: Vec<usize>,
    /// Position in the body, m.
    geom_pos: Vec<Vec3>,
    /// Orientation in the body.
    geom_quat: Vec<Quat>,
    /// Whether its frame is one that the body has already.
    geom_sameframe: Vec<SameFrame>,
    /// Collision type bits.
    geom_contype: Vec<u32>,
    /// Collision affinity bits.
    geom_conaffinity: Vec<u32>,
    /// Dimension of its contacts: 1, 3, 4 or 6.
    geom_condim: Vec<usize>,
    /// Priority in contact parameter mixing.
    geom_priority: Vec<i32>,
    /// Sliding, torsional, rolling friction.
    geom_friction: Vec<[f64; 3]>,
    /// Weight in contact parameter mixing.
    geom_solmix: Vec<f64>,
    /// Contact `solref`.
    geom_solref: Vec<[f64; 2]>,
    /// Contact `solimp`.
    geom_solimp: Vec<[f64; 5]>,
    /// Contact margin, m.
    geom_margin: Vec<f64>,
    /// Contact gap, m.
    geom_gap: Vec<f64>,
    /// Radius of the bounding sphere, m; 0 for planes.
    geom_rbound: Vec<f64>,
    /// Visual group.
    geom_group: Vec<usize>,
    /// Own colour, 0..1.
    geom_rgba: Vec<[f64; 4]>,
    /// Index into [`Model::materials`].
    geom_matid: Vec<Option<usize>>,

    /// Site names.
    site_name: Vec<String>,
    /// Shape.
    site_type: Vec<GeomType>,
    /// Body that carries the site.
    site_bodyid: Vec<usize>,
    /// Size, m.
    site_size: Vec<Vec3>,
    /// Position in the body, m.
    site_pos: Vec<Vec3>,
    /// Orientation in the body.
    site_quat: Vec<Quat>,
    /// Whether its frame is one that the body has already.
    site_sameframe: Vec<SameFrame>,
    /// Visual group.
    site_group: Vec<usize>,
    /// Colour, 0..1.
    site_rgba: Vec<[f64; 4]>,
    /// Index into [`Model::materials`].
    site_matid: Vec<Option<usize>>,

    /// Camera names.
    cam_name: Vec<String>,
    /// Mode and target.
    cam_mode: Vec<CameraMode>,
    /// Body that carries the camera.
    cam_bodyid: Vec<usize>,
    /// Position in the body, m.
    cam_pos: Vec<Vec3>,
    /// Orientation in the body; the camera looks along its -z.
    cam_quat: Vec<Quat>,
    /// Vertical field of view, degrees.
    cam_fovy: Vec<f64>,

    /// Lights.
    lights: Vec<Light>,
    /// Textures.
    textures: Vec<Texture>,
    /// Materials.
    materials: Vec<Material>,

    /// Explicit pair: geoms, that of the lower body first.
    pair_geom: Vec<[usize; 2]>,
    /// Explicit pair: contact dimension.
    pair_dim: Vec<usize>,
    /// Explicit pair: `solref` of the normal.
    pair_solref: Vec<[f64; 2]>,
    /// Explicit pair: `solref` of friction; zeros mean that of the normal.
    pair_solreffriction: Vec<[f64; 2]>,
    /// Explicit pair: `solimp`.
    pair_solimp: Vec<[f64; 5]>,
    /// Explicit pair: the five friction coefficients.
    pair_friction: Vec<[f64; 5]>,
    /// Explicit pair: margin, m.
    pair_margin: Vec<f64>,
    /// Explicit pair: gap, m.
    pair_gap: Vec<f64>,
    /// Excluded body pairs, lower id first, sorted.
    exclude: Vec<[usize; 2]>,

    /// Equality names.
    eq_name: Vec<String>,
    /// What is held.
    eq_kind: Vec<EqualityKind>,
    /// Active after a reset.
    eq_active0: Vec<bool>,
    /// `solref`.
    eq_solref: Vec<[f64; 2]>,
    /// `solimp`.
    eq_solimp: Vec<[f64; 5]>,

    /// Tendon names.
    tendon_name: Vec<String>,
    /// Joints and coefficients of each fixed tendon, in document order.
    tendon_wrap: Vec<Vec<(usize, f64)>>,
    /// Whether `tendon_range` applies.
    tendon_limited: Vec<bool>,
    /// Limits, rad.
    tendon_range: Vec<[f64; 2]>,
    /// Distance at which a limit becomes active.
    tendon_margin: Vec<f64>,
    /// `solref` of the limit.
    tendon_solref_lim: Vec<[f64; 2]>,
    /// `solimp` of the limit.
    tendon_solimp_lim: Vec<[f64; 5]>,
    /// Inverse weight at `qpos0`.
    tendon_invweight0: Vec<f64>,

    /// Actuator names.
    actuator_name: Vec<String>,
    /// Driven joint.
    actuator_trnid: Vec<usize>,
    /// Gear, the first of MuJoCo's six.
    actuator_gear: Vec<f64>,
    /// Whether `actuator_ctrlrange` applies.
    actuator_ctrllimited: Vec<bool>,
    /// Limits of the control.
    actuator_ctrlrange: Vec<[f64; 2]>,
    /// Whether `actuator_forcerange` applies.
    actuator_forcelimited: Vec<bool>,
    /// Limits of the force before the gear, N m.
    actuator_forcerange: Vec<[f64; 2]>,
    /// Gain.
    actuator_gainprm: Vec<[f64; 3]>,
    /// Bias type.
    actuator_biastype: Vec<BiasType>,
    /// Bias parameters.
    actuator_biasprm: Vec<[f64; 3]>,
    /// User data, `nuser_actuator` values each.
    actuator_user: Vec<Vec<f64>>,

    /// Sensor names.
    sensor_name: Vec<String>,
    /// Sensor type.
    sensor_type: Vec<SensorType>,
    /// Site it is attached to.
    sensor_objid: Vec<usize>,
    /// First entry in `sensordata`.
    sensor_adr: Vec<usize>,
}

macro_rules! lookup {
    ($($fun:ident $field:ident $id:ident $what:literal),* $(,)?) => {
        impl Model {$(
            #[doc = concat!("Id of the ", $what, " called `name`.")]
            pub fn $fun(&self, name: &str) -> Option<$id> {
                self.$field.iter().position(|n| n == name).map($id)
            }
        )*}
    };
}

lookup! {
    body body_name BodyId "body",
    joint jnt_name JointId "joint",
    geom geom_name GeomId "geom",
    site site_name SiteId "site",
    camera cam_name CameraId "camera",
    actuator actuator_name ActuatorId "actuator",
    equality eq_name EqualityId "equality constraint",
    tendon tendon_name TendonId "tendon",
    sensor sensor_name SensorId "sensor",
}

macro_rules! sizes {
    ($($fun:ident $field:ident $what:literal),* $(,)?) => {
        impl Model {$(
            #[doc = concat!("Number of ", $what, ".")]
            pub fn $fun(&self) -> usize { self.$field.len() }
        )*}
    };
}

sizes! {
    nbody body_name "bodies, the world included",
    njnt jnt_name "joints",
    ngeom geom_name "geoms",
    nsite site_name "sites",
    ncam cam_name "cameras",
    neq eq_name "equality constraints",
    ntendon tendon_name "tendons",
    nu actuator_name "actuators",
    nsensor sensor_name "sensors",
    npair pair_geom "explicit contact pairs",
}

impl Model {
    /// Length of `sensordata`: three per sensor.
    pub fn nsensordata(&self) -> usize {
        3 * self.nsensor()
    }

    /// Whether `body` is `ancestor` or lies below it.
    pub fn in_subtree(&self, mut body: usize, ancestor: usize) -> bool {
        loop {
            if body == ancestor {
                return true;
            }
            if body == 0 {
                return false;
            }
            body = self.body_parentid[body];
        }
    }
}
