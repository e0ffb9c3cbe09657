//! The compiled model: everything about a scene that does not change while it runs.
//!
//! [`Arrays`] carry MuJoCo's names, ids and units (SI, radians), one entry per element in document order, so a number here
//! can be compared with the same number there. A [`Model`] owns complete arrays, lets them be read (`model.body_mass[b]`)
//! and never be changed; `compile` of mjcf-sim-physics makes one. It is shared in an [`std::sync::Arc`]; what changes at
//! run time lives in the `State` of mjcf-sim-physics.

mod actuator;
mod arrays;
mod code;
mod complete;
mod elements;
mod flex;
mod hfield;
mod look;
mod mesh;
mod options;
mod sensor;
mod skin;

pub use actuator::{BiasType, DynType, GainType, TrnType};
pub use arrays::Arrays;
pub use complete::Model;
pub use complete::{CameraPose, Constants, LightPose, WeldPose};
pub use elements::{EqualityKind, SameFrame, Wrap};
pub use elements::{GeomType, JointType, Keyframe};
pub use flex::{Flex, FlexSelfCollide};
pub use hfield::HField;
pub use look::{Builtin, CamLight, Light, Mark, Material, Texture, TextureType, Visual};
pub use mesh::{Mesh, MeshHull, MeshPolygons};
pub use options::{ConeType, Flags, JacobianFormat, SolverType, Statistic};
pub use options::{IntegratorType, Options};
pub use sensor::{DataType, ObjType, SensorType};
pub use skin::{Skin, SkinBone};

macro_rules! lookup {
    ($($fun:ident $field:ident $what:literal),* $(,)?) => {
        impl Arrays {$(
            #[doc = concat!("Returns the id of the ", $what, " called `name`.")]
            #[doc(alias = "mj_name2id")]
            pub fn $fun(&self, name: &str) -> Option<usize> {
                self.$field.iter().position(|n| n == name)
            }
        )*}
    };
}

lookup! {
    body body_name "body",
    joint jnt_name "joint",
    geom geom_name "geom",
    site site_name "site",
    camera cam_name "camera",
    actuator actuator_name "actuator",
    equality eq_name "equality constraint",
    tendon tendon_name "tendon",
    sensor sensor_name "sensor",
}

macro_rules! sizes {
    ($($fun:ident $field:ident $what:literal),* $(,)?) => {
        impl Arrays {$(
            #[doc = concat!("Returns the number of ", $what, ".")]
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
    nkey keys "keyframes",
    nmesh meshes "meshes",
    nhfield hfields "height fields",
    nskin skins "skins",
    nflex flexes "flexes",
}

impl Wrap {
    /// Returns the body of a site or a geom.
    pub fn body(&self, model: &Arrays) -> Option<usize> {
        match *self {
            Self::Site { site } => Some(model.site_bodyid[site]),
            Self::Sphere { geom, .. } | Self::Cylinder { geom, .. } => Some(model.geom_bodyid[geom]),
            Self::Joint { .. } | Self::Pulley { .. } => None,
        }
    }
}

impl Arrays {
    /// Returns whether a tendon is spatial.
    pub fn tendon_is_spatial(&self, tendon: usize) -> bool {
        !matches!(self.tendon_wrap[tendon].first(), Some(Wrap::Joint { .. }))
    }

    /// Returns whether a sensor reads accelerations or wrenches of bodies, which follow from the constraint forces.
    pub fn reads_accelerations(&self) -> bool {
        use SensorType::{Accelerometer, Force, FrameAngAcc, FrameLinAcc, Torque};
        let reads = |kind: &SensorType| matches!(kind, Accelerometer | Force | Torque | FrameLinAcc | FrameAngAcc);
        self.opt.flags.sensor && self.sensor_type.iter().any(reads)
    }

    /// Returns the number of elements on the paths of all tendons.
    pub fn nwrap(&self) -> usize {
        self.tendon_wrap.iter().map(Vec::len).sum()
    }

    /// Returns the joint of several coordinates that an actuator acts on, if it acts on one.
    pub fn actuator_turns(&self, actuator: usize) -> Option<usize> {
        let joint = self.actuator_joint(actuator);
        joint.filter(|&j| matches!(self.jnt_type[j], JointType::Free | JointType::Ball))
    }

    /// Returns the joint that an actuator acts on, if it acts on one.
    pub fn actuator_joint(&self, actuator: usize) -> Option<usize> {
        match self.actuator_trntype[actuator] {
            TrnType::Joint | TrnType::JointInParent => Some(self.actuator_trnid[actuator]),
            TrnType::SliderCrank | TrnType::Tendon | TrnType::Site | TrnType::Body => None,
        }
    }
}

impl Arrays {
    /// Returns the id of the keyframe called `name`.
    pub fn key(&self, name: &str) -> Option<usize> {
        self.keys.iter().position(|key| key.name == name)
    }

    /// Returns the length of `qpos`, as the field of that name.
    pub fn nq(&self) -> usize {
        self.nq
    }

    /// Returns the length of `qvel`, the number of degrees of freedom, as the field of that name.
    pub fn nv(&self) -> usize {
        self.nv
    }

    /// Returns the number of activations, as the field of that name.
    pub fn na(&self) -> usize {
        self.na
    }

    /// Returns the number of bodies that a program moves, as the field of that name.
    pub fn nmocap(&self) -> usize {
        self.nmocap
    }

    /// Returns whether a body may move in the world: by joints, or because a program moves it or a body that it is fixed to.
    pub fn moves(&self, body: usize) -> bool {
        self.body_weldid[body] != 0 || self.body_mocapid[self.body_rootid[body]].is_some()
    }

    /// Returns the length of `sensordata`.
    pub fn nsensordata(&self) -> usize {
        self.sensor_dim.iter().sum()
    }

    /// Returns whether `body` is `ancestor` or lies below it; false for a body that does not exist.
    pub fn in_subtree(&self, mut body: usize, ancestor: usize) -> bool {
        loop {
            if body == ancestor {
                return true;
            }
            match self.body_parentid.get(body) {
                Some(&parent) if body != 0 => body = parent,
                _ => return false,
            }
        }
    }
}
