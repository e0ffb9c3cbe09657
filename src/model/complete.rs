//! The model as the owner of complete arrays.

use std::ops::Deref;

use super::{Arrays, EqualityKind, Options, Statistic};
use crate::math::{Mat3, Quat, Vec3};

/// Owns the complete arrays of a compiled scene; they can be read, but not changed.
///
/// Every array of [`Arrays`] can be read through the model (`model.body_mass[b]`, `model.nbody()`). Only
/// `compile` of mjcf-sim-physics makes a model, so that constants which need dynamics (`body_invweight0`, `dof_invweight0`,
/// `tendon_invweight0`, `dof_m0`, statistics, poses of welds, damping from damping ratios, springs and dampers from time constants) are never missing:
///
/// ```
/// use mjcf_sim::{assets::MemoryAssets, mjcf_loader, physics};
///
/// let text = "<mujoco><worldbody><body><freejoint/><geom size='.1' mass='2'/></body></worldbody></mujoco>";
/// let model = physics::compile(mjcf_loader::load_str(text, "ball.xml", &MemoryAssets::new())?)?;
/// assert!((model.dof_invweight0[0] - 0.5).abs() < 1e-15);
/// # Ok::<(), mjcf_loader::LoadError>(())
/// ```
///
/// To change a scene, change its MJCF text and compile it again. A model itself stays as it is:
///
/// ```compile_fail,E0596
/// fn lighten(model: &mut mjcf_sim::Model) {
///     model.body_mass[1] = 0.0; // cannot borrow data in dereference of `Model` as mutable
/// }
/// ```
#[doc(alias = "mjModel")]
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    arrays: Arrays,
}

impl Deref for Model {
    type Target = Arrays;

    fn deref(&self) -> &Arrays {
        &self.arrays
    }
}

/// Everything in a model that needs dynamics at `qpos0`.
#[derive(Clone, Debug)]
pub struct Constants {
    /// See [`Arrays::body_invweight0`].
    pub body_invweight0: Vec<[f64; 2]>,
    /// See [`Arrays::dof_invweight0`].
    pub dof_invweight0: Vec<f64>,
    /// See [`Arrays::dof_m0`].
    pub dof_m0: Vec<f64>,
    /// See [`Arrays::jnt_stiffness`].
    pub jnt_stiffness: Vec<f64>,
    /// See [`Arrays::dof_damping`].
    pub dof_damping: Vec<f64>,
    /// See [`Arrays::tendon_length0`].
    pub tendon_length0: Vec<f64>,
    /// Length of each edge of all flexes, and its inverse weight; see [`super::Flex`].
    pub flexedges: Vec<[f64; 2]>,
    /// See [`Arrays::tendon_lengthspring`].
    pub tendon_lengthspring: Vec<[f64; 2]>,
    /// See [`Arrays::tendon_invweight0`].
    pub tendon_invweight0: Vec<f64>,
    /// See [`Arrays::actuator_biasprm`].
    pub actuator_biasprm: Vec<[f64; 10]>,
    /// See [`Arrays::actuator_acc0`].
    pub actuator_acc0: Vec<f64>,
    /// See [`Arrays::actuator_length0`].
    pub actuator_length0: Vec<f64>,
    /// The statistics, given or computed.
    pub stat: Statistic,
    /// The relative pose of each weld that keeps the pose at `qpos0`.
    pub weld_poses: Vec<WeldPose>,
    /// The point in body 2 of each connection, by equality.
    pub connect_anchors: Vec<(usize, Vec3)>,
    /// The part of its pose at `qpos0` that each camera keeps.
    pub camera_poses: Vec<CameraPose>,
    /// The part of its pose at `qpos0` that each light keeps.
    pub light_poses: Vec<LightPose>,
}

/// The relative pose of a weld at `qpos0`.
#[derive(Clone, Copy, Debug)]
pub struct WeldPose {
    /// Id of the equality.
    pub equality: usize,
    /// See [`EqualityKind::Weld`].
    pub relpos: Vec3,
    /// See [`EqualityKind::Weld`].
    pub relquat: Quat,
}

/// The part of its pose at `qpos0` that a camera keeps; see [`Arrays::cam_pos0`] and those after it.
#[derive(Clone, Copy, Debug)]
pub struct CameraPose {
    /// Position relative to its body, in the world's axes, m.
    pub pos0: Vec3,
    /// Position relative to the centre of mass of its body's subtree, in the world's axes, m.
    pub poscom0: Vec3,
    /// Orientation in the world.
    pub mat0: Mat3,
}

/// The part of its pose at `qpos0` that a light keeps; see [`super::Light`].
#[derive(Clone, Copy, Debug)]
pub struct LightPose {
    /// Position relative to its body, in the world's axes, m.
    pub pos0: Vec3,
    /// Position relative to the centre of mass of its body's subtree, in the world's axes, m.
    pub poscom0: Vec3,
    /// Direction in the world, a unit vector.
    pub dir0: Vec3,
}

impl Model {
    /// Returns whether the options switch off the group of an actuator.
    pub fn actuator_disabled(&self, actuator: usize) -> bool {
        let group = u32::try_from(self.actuator_group[actuator]).unwrap_or(u32::MAX);
        self.opt
            .disableactuator
            .checked_shr(group)
            .is_some_and(|bits| bits & 1 != 0)
    }

    /// Completes the arrays of a document with the constants that need dynamics.
    pub fn new(mut arrays: Arrays, constants: Constants) -> Self {
        arrays.body_invweight0 = constants.body_invweight0;
        arrays.dof_invweight0 = constants.dof_invweight0;
        arrays.dof_m0 = constants.dof_m0;
        arrays.jnt_stiffness = constants.jnt_stiffness;
        arrays.dof_damping = constants.dof_damping;
        arrays.tendon_length0 = constants.tendon_length0;
        arrays.tendon_lengthspring = constants.tendon_lengthspring;
        arrays.tendon_invweight0 = constants.tendon_invweight0;
        arrays.actuator_biasprm = constants.actuator_biasprm;
        arrays.actuator_acc0 = constants.actuator_acc0;
        arrays.actuator_length0 = constants.actuator_length0;
        arrays.stat = constants.stat;
        for flex in &mut arrays.flexes {
            let edges = &constants.flexedges[flex.edgeadr..flex.edgeadr + flex.edge.len()];
            flex.edge_length0 = edges.iter().map(|edge| edge[0]).collect();
            flex.edge_invweight0 = edges.iter().map(|edge| edge[1]).collect();
        }
        for pose in constants.weld_poses {
            if let EqualityKind::Weld { relpos, relquat, .. } = &mut arrays.eq_kind[pose.equality] {
                (*relpos, *relquat) = (pose.relpos, pose.relquat);
            }
        }
        for (equality, point) in constants.connect_anchors {
            if let EqualityKind::Connect { anchor2, .. } = &mut arrays.eq_kind[equality] {
                *anchor2 = point;
            }
        }
        for CameraPose { pos0, poscom0, mat0 } in constants.camera_poses {
            arrays.cam_pos0.push(pos0);
            arrays.cam_poscom0.push(poscom0);
            arrays.cam_mat0.push(mat0);
        }
        for (light, pose) in arrays.lights.iter_mut().zip(constants.light_poses) {
            (light.pos0, light.poscom0, light.dir0) = (pose.pos0, pose.poscom0, pose.dir0);
        }
        Self { arrays }
    }

    /// Returns the model with other options, for simulations during compilation.
    pub fn with_options(&self, edit: impl FnOnce(&mut Options)) -> Self {
        let mut arrays = self.arrays.clone();
        edit(&mut arrays.opt);
        Self { arrays }
    }

    /// Returns the model with the ranges of lengths of its actuators.
    pub fn with_lengthrange(mut self, ranges: Vec<[f64; 2]>) -> Self {
        self.arrays.actuator_lengthrange = ranges;
        self
    }

    /// Returns a model with other numbers, as if a program had written into MuJoCo's `mjModel` between two steps. Derived constants
    /// (`dof_invweight0`, statistics and the like) stay as they are, as in MuJoCo. `edit` must keep lengths, ids and names.
    #[must_use]
    pub fn edited(&self, edit: impl FnOnce(&mut Arrays)) -> Self {
        let mut arrays = self.arrays.clone();
        edit(&mut arrays);
        Self { arrays }
    }
}
