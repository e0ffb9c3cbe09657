//! The list of a model's arrays.

use super::*;
use crate::math::{Mat3, Quat, Vec3};

/// Copies a field. It is apart from where all fields are copied, which would hold an allocation for each.
#[inline(never)]
fn copied<T: Clone>(field: &T) -> T {
    field.clone()
}

// A field with `["internals"]` before it is shown in the documentation with that feature only: it serves physics, pictures and MuJoCo's
// names, and changes in any release.
macro_rules! arrays {
    (
        $($(#[$setting_doc:meta])* $([$setting_of:tt])? $setting:ident : $setting_ty:ty),*;
        $($(#[$doc:meta])* $([$of:tt])? $field:ident : $ty:ty),* $(,)?
    ) => {
        /// The numbers of a scene under MuJoCo's names, as a [`Model`] shows them; see the [module documentation](super).
        #[derive(Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Arrays {
            $($(#[$setting_doc])* $(#[cfg_attr(not(feature = $setting_of), doc(hidden))])? pub $setting: $setting_ty,)*
            $($(#[$doc])* $(#[cfg_attr(not(feature = $of), doc(hidden))])? pub $field: $ty,)*
        }

        impl Clone for Arrays {
            fn clone(&self) -> Self {
                Self { $($setting: copied(&self.$setting),)* $($field: copied(&self.$field),)* }
            }
        }

        impl Arrays {
            /// Makes arrays that hold settings and no elements.
            pub(crate) fn without_elements($($setting: $setting_ty),*) -> Self {
                Self { $($setting,)* $($field: Default::default(),)* }
            }
        }
    };
}

arrays! {
    /// Name of the model.
    name: String,
    /// Options.
    opt: Options,
    /// Visual settings.
    ["internals"] vis: Visual,
    /// Statistics.
    ["internals"] stat: Statistic;

    /// Number of position coordinates.
    nq: usize,
    /// Number of degrees of freedom.
    nv: usize,
    /// Number of activations.
    na: usize,
    /// Number of bodies that a program moves.
    nmocap: usize,

    /// Body names (nbody); may be empty.
    body_name: Vec<String>,
    /// Parent body; 0 for the world itself.
    body_parentid: Vec<usize>,
    /// Top body of the tree that holds the body (the ancestor that is a child of the world).
    ["internals"] body_rootid: Vec<usize>,
    /// Body that it is rigidly welded to: itself when it has joints, else its parent's.
    ["internals"] body_weldid: Vec<usize>,
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
    ["internals"] body_sameframe: Vec<SameFrame>,
    /// Place in `mocap_pos` and `mocap_quat` of a body that a program moves.
    body_mocapid: Vec<Option<usize>>,
    /// Part of the weight that is compensated, 0 for none.
    ["internals"] body_gravcomp: Vec<f64>,
    /// Mean inverse weight at `qpos0`: translation 1/kg, rotation 1/(kg m^2).
    ["internals"] body_invweight0: Vec<[f64; 2]>,
    /// Numbers for programs, `nuser_body` for each body.
    body_user: Vec<Vec<f64>>,

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
    ["internals"] jnt_margin: Vec<f64>,
    /// Spring stiffness, N m/rad or N/m.
    jnt_stiffness: Vec<f64>,
    /// Whether the compensation of gravity is a force of its actuators, and not a passive one.
    ["internals"] jnt_actgravcomp: Vec<bool>,
    /// Whether `jnt_actfrcrange` applies.
    ["internals"] jnt_actfrclimited: Vec<bool>,
    /// Limits of the force of all actuators on the joint, N m or N.
    ["internals"] jnt_actfrcrange: Vec<[f64; 2]>,
    /// Time constant, s, and damping ratio from which its spring and damper follow; zeros where those are given.
    ["internals"] jnt_springdamper: Vec<[f64; 2]>,
    /// `solref` of the limit.
    ["internals"] jnt_solref: Vec<[f64; 2]>,
    /// `solimp` of the limit.
    ["internals"] jnt_solimp: Vec<[f64; 5]>,
    /// Visual group.
    ["internals"] jnt_group: Vec<usize>,
    /// Numbers for programs, `nuser_jnt` for each joint.
    jnt_user: Vec<Vec<f64>>,

    /// Body of a degree of freedom.
    dof_bodyid: Vec<usize>,
    /// Joint of a degree of freedom.
    dof_jntid: Vec<usize>,
    /// Next degree of freedom towards the root.
    ["internals"] dof_parentid: Vec<Option<usize>>,
    /// Inertia of the rotor, kg m^2.
    dof_armature: Vec<f64>,
    /// Damping, N m s/rad.
    dof_damping: Vec<f64>,
    /// Dry friction, N m.
    dof_frictionloss: Vec<f64>,
    /// Diagonal of the inverse inertia at `qpos0`, 1/kg or 1/(kg m^2).
    ["internals"] dof_invweight0: Vec<f64>,
    /// Diagonal of the inertia at `qpos0` (MuJoCo's `dof_M0`), kg or kg m^2.
    ["internals"] dof_m0: Vec<f64>,
    /// `solref` of dry friction.
    ["internals"] dof_solref: Vec<[f64; 2]>,
    /// `solimp` of dry friction.
    ["internals"] dof_solimp: Vec<[f64; 5]>,

    /// Reference configuration (nq).
    qpos0: Vec<f64>,
    /// Rest configuration of the springs (nq).
    ["internals"] qpos_spring: Vec<f64>,

    /// Geom names; may be empty.
    geom_name: Vec<String>,
    /// Shape.
    geom_type: Vec<GeomType>,
    /// Size, m; see [`GeomType`].
    geom_size: Vec<Vec3>,
    /// Mesh that the geom is, or that a primitive is fitted to; of a height field, its id among those.
    ["internals"] geom_dataid: Vec<Option<usize>>,
    /// Body that carries the geom.
    geom_bodyid: Vec<usize>,
    /// Position in the body, m.
    geom_pos: Vec<Vec3>,
    /// Orientation in the body.
    geom_quat: Vec<Quat>,
    /// Whether its frame is one that the body has already.
    ["internals"] geom_sameframe: Vec<SameFrame>,
    /// Collision type bits.
    geom_contype: Vec<u32>,
    /// Collision affinity bits.
    geom_conaffinity: Vec<u32>,
    /// Dimension of its contacts: 1, 3, 4 or 6.
    geom_condim: Vec<usize>,
    /// Priority in contact parameter mixing.
    ["internals"] geom_priority: Vec<i32>,
    /// Sliding, torsional, rolling friction.
    geom_friction: Vec<[f64; 3]>,
    /// Weight in contact parameter mixing.
    ["internals"] geom_solmix: Vec<f64>,
    /// Contact `solref`.
    ["internals"] geom_solref: Vec<[f64; 2]>,
    /// Contact `solimp`.
    ["internals"] geom_solimp: Vec<[f64; 5]>,
    /// Contact margin, m.
    ["internals"] geom_margin: Vec<f64>,
    /// Contact gap, m.
    ["internals"] geom_gap: Vec<f64>,
    /// How a medium acts on the geom as on an ellipsoid: 1 if it does, coefficients of blunt, slender and angular drag, of Kutta's lift
    /// and of Magnus's, volumes (3), m^3, and moments (3), m^5, of the medium that moves with it; zeros if it does not.
    ["internals"] geom_fluid: Vec<[f64; 12]>,
    /// Box around it in its frame: centre and half lengths, m. Planes fill half of it.
    ["internals"] geom_aabb: Vec<[f64; 6]>,
    /// Radius of the bounding sphere, m; 0 for planes.
    ["internals"] geom_rbound: Vec<f64>,
    /// Visual group.
    ["internals"] geom_group: Vec<usize>,
    /// Own colour, 0..1.
    geom_rgba: Vec<[f64; 4]>,
    /// Index into [`Arrays::materials`].
    ["internals"] geom_matid: Vec<Option<usize>>,
    /// Numbers for programs, `nuser_geom` for each geom.
    geom_user: Vec<Vec<f64>>,

    /// Site names.
    site_name: Vec<String>,
    /// Shape.
    ["internals"] site_type: Vec<GeomType>,
    /// Body that carries the site.
    site_bodyid: Vec<usize>,
    /// Size, m.
    ["internals"] site_size: Vec<Vec3>,
    /// Position in the body, m.
    site_pos: Vec<Vec3>,
    /// Orientation in the body.
    site_quat: Vec<Quat>,
    /// Whether its frame is one that the body has already.
    ["internals"] site_sameframe: Vec<SameFrame>,
    /// Visual group.
    ["internals"] site_group: Vec<usize>,
    /// Colour, 0..1.
    ["internals"] site_rgba: Vec<[f64; 4]>,
    /// Index into [`Arrays::materials`].
    ["internals"] site_matid: Vec<Option<usize>>,
    /// Numbers for programs, `nuser_site` for each site.
    site_user: Vec<Vec<f64>>,

    /// Camera names.
    cam_name: Vec<String>,
    /// How it is placed and aimed.
    ["internals"] cam_mode: Vec<CamLight>,
    /// Body that it looks at in modes that aim at one.
    ["internals"] cam_targetbodyid: Vec<Option<usize>>,
    /// Body that carries the camera.
    cam_bodyid: Vec<usize>,
    /// Position in the body, m.
    cam_pos: Vec<Vec3>,
    /// Orientation in the body; the camera looks along its -z.
    cam_quat: Vec<Quat>,
    /// Position at `qpos0` relative to the origin of its body, along the axes of the world, m.
    ["internals"] cam_pos0: Vec<Vec3>,
    /// Position at `qpos0` relative to the centre of mass of the target, or else its body, and those below, along the axes of
    /// the world, m.
    ["internals"] cam_poscom0: Vec<Vec3>,
    /// Orientation at `qpos0` in the world.
    ["internals"] cam_mat0: Vec<Mat3>,
    /// Width and height of its picture for sensors, pixels.
    ["internals"] cam_resolution: Vec<[usize; 2]>,
    /// Vertical field of view, degrees.
    cam_fovy: Vec<f64>,
    /// Width and height of its sensor, m; zeros where it has `fovy` alone.
    ["internals"] cam_sensorsize: Vec<[f64; 2]>,
    /// Focal lengths along both sides of its sensor, and where the axis of the lens meets that, from its centre, m; they mean something where it
    /// has a sensor.
    ["internals"] cam_intrinsic: Vec<[f64; 4]>,
    /// Numbers for programs, `nuser_cam` for each camera. They mean nothing to physics and pictures.
    cam_user: Vec<Vec<f64>>,

    /// Meshes.
    ["internals"] meshes: Vec<Mesh>,
    /// Height fields.
    ["internals"] hfields: Vec<HField>,
    /// Skins.
    ["internals"] skins: Vec<Skin>,

    /// Lights.
    ["internals"] lights: Vec<Light>,
    /// Textures.
    ["internals"] textures: Vec<Texture>,
    /// Materials.
    ["internals"] materials: Vec<Material>,

    /// Explicit pair: geoms, that of the lower body first.
    ["internals"] pair_geom: Vec<[usize; 2]>,
    /// Explicit pair: contact dimension.
    ["internals"] pair_dim: Vec<usize>,
    /// Explicit pair: `solref` of the normal.
    ["internals"] pair_solref: Vec<[f64; 2]>,
    /// Explicit pair: `solref` of friction; zeros mean that of the normal.
    ["internals"] pair_solreffriction: Vec<[f64; 2]>,
    /// Explicit pair: `solimp`.
    ["internals"] pair_solimp: Vec<[f64; 5]>,
    /// Explicit pair: the five friction coefficients.
    ["internals"] pair_friction: Vec<[f64; 5]>,
    /// Explicit pair: margin, m.
    ["internals"] pair_margin: Vec<f64>,
    /// Explicit pair: gap, m.
    ["internals"] pair_gap: Vec<f64>,
    /// Body pairs excluded from collision, lower id first, sorted.
    ["internals"] exclude: Vec<[usize; 2]>,

    /// Equality names.
    eq_name: Vec<String>,
    /// Kind of each constraint, with what it holds.
    ["internals"] eq_kind: Vec<EqualityKind>,
    /// Whether it is active after a reset.
    ["internals"] eq_active0: Vec<bool>,
    /// `solref`.
    ["internals"] eq_solref: Vec<[f64; 2]>,
    /// `solimp`.
    ["internals"] eq_solimp: Vec<[f64; 5]>,

    /// Tendon names.
    tendon_name: Vec<String>,
    /// Path of each tendon, in document order.
    ["internals"] tendon_wrap: Vec<Vec<Wrap>>,
    /// Whether `tendon_range` applies.
    tendon_limited: Vec<bool>,
    /// Shortest and longest length; m for spatial tendons.
    tendon_range: Vec<[f64; 2]>,
    /// Distance at which a limit becomes active.
    ["internals"] tendon_margin: Vec<f64>,
    /// `solref` of the limit.
    ["internals"] tendon_solref_lim: Vec<[f64; 2]>,
    /// `solimp` of the limit.
    ["internals"] tendon_solimp_lim: Vec<[f64; 5]>,
    /// Lengths between which the spring is slack; that of `qpos_spring` where none is given.
    ["internals"] tendon_lengthspring: Vec<[f64; 2]>,
    /// Dry friction.
    ["internals"] tendon_frictionloss: Vec<f64>,
    /// `solref` of dry friction.
    ["internals"] tendon_solref_fri: Vec<[f64; 2]>,
    /// `solimp` of dry friction.
    ["internals"] tendon_solimp_fri: Vec<[f64; 5]>,
    /// Stiffness of the spring.
    ["internals"] tendon_stiffness: Vec<f64>,
    /// Damping.
    ["internals"] tendon_damping: Vec<f64>,
    /// Inverse weight at `qpos0`.
    ["internals"] tendon_invweight0: Vec<f64>,
    /// Length at `qpos0`.
    ["internals"] tendon_length0: Vec<f64>,
    /// Visual group.
    ["internals"] tendon_group: Vec<usize>,
    /// Radius of what is drawn, m.
    ["internals"] tendon_width: Vec<f64>,
    /// Colour and opacity.
    ["internals"] tendon_rgba: Vec<[f64; 4]>,
    /// Material.
    ["internals"] tendon_matid: Vec<Option<usize>>,
    /// Numbers for programs, `nuser_tendon` for each tendon.
    tendon_user: Vec<Vec<f64>>,

    /// Actuator names.
    actuator_name: Vec<String>,
    /// Kind of what it acts on.
    ["internals"] actuator_trntype: Vec<TrnType>,
    /// Joint, tendon, site or body that it acts on; the site of the crank of a slider-crank.
    actuator_trnid: Vec<usize>,
    /// Reference site of a site, site of the slider of a slider-crank (MuJoCo's second `actuator_trnid`).
    ["internals"] actuator_refid: Vec<Option<usize>>,
    /// Length of the rod of a slider-crank, m.
    ["internals"] actuator_cranklength: Vec<f64>,
    /// Gear, the first of MuJoCo's six.
    actuator_gear: Vec<f64>,
    /// All six of MuJoCo's gears, of which sites use more than the first: force and torque per unit of the actuator's force.
    ["internals"] actuator_gear6: Vec<[f64; 6]>,
    /// Whether `actuator_ctrlrange` applies.
    actuator_ctrllimited: Vec<bool>,
    /// Limits of the control.
    actuator_ctrlrange: Vec<[f64; 2]>,
    /// Whether `actuator_forcerange` applies.
    actuator_forcelimited: Vec<bool>,
    /// Limits of the force before the gear, N m.
    actuator_forcerange: Vec<[f64; 2]>,
    /// Group, which `disableactuator` of the options may switch off.
    ["internals"] actuator_group: Vec<i32>,
    /// Shortest and longest length, which only MuJoCo's muscles use: as given, else found by simulation where `<lengthrange>` of
    /// `<compiler>` asks for it.
    ["internals"] actuator_lengthrange: Vec<[f64; 2]>,
    /// How the activation follows the control.
    ["internals"] actuator_dyntype: Vec<DynType>,
    /// Parameters of the activation; see [`DynType`].
    ["internals"] actuator_dynprm: Vec<[f64; 10]>,
    /// Address of the activation; `None` without one.
    ["internals"] actuator_actadr: Vec<Option<usize>>,
    /// Whether `actuator_actrange` applies.
    ["internals"] actuator_actlimited: Vec<bool>,
    /// Limits of the activation.
    ["internals"] actuator_actrange: Vec<[f64; 2]>,
    /// Whether the force follows from the activation at the end of the step.
    ["internals"] actuator_actearly: Vec<bool>,
    /// Gain type.
    ["internals"] actuator_gaintype: Vec<GainType>,
    /// Gain parameters; see [`GainType`].
    ["internals"] actuator_gainprm: Vec<[f64; 10]>,
    /// Bias type.
    ["internals"] actuator_biastype: Vec<BiasType>,
    /// Bias parameters; see [`BiasType`]. The damping of a servo that is given by its damping ratio is that at `qpos0`.
    ["internals"] actuator_biasprm: Vec<[f64; 10]>,
    /// Norm of the acceleration at `qpos0` per unit of its force.
    ["internals"] actuator_acc0: Vec<f64>,
    /// Length at `qpos0`.
    ["internals"] actuator_length0: Vec<f64>,
    /// User data, `nuser_actuator` values each.
    actuator_user: Vec<Vec<f64>>,

    /// Sensor names.
    sensor_name: Vec<String>,
    /// Sensor type.
    ["internals"] sensor_type: Vec<SensorType>,
    /// Kind of the object that it measures.
    ["internals"] sensor_objtype: Vec<ObjType>,
    /// Id of that object; none for the clock.
    ["internals"] sensor_objid: Vec<Option<usize>>,
    /// Kind of the object in whose frame it measures.
    ["internals"] sensor_reftype: Vec<ObjType>,
    /// Id of that object; none for the frame of the world.
    ["internals"] sensor_refid: Vec<Option<usize>>,
    /// Bound of its numbers; 0 for none.
    ["internals"] sensor_cutoff: Vec<f64>,
    /// Standard deviation of noise, for programs: sensors are exact.
    ["internals"] sensor_noise: Vec<f64>,
    /// How many numbers it gives.
    sensor_dim: Vec<usize>,
    /// Kind of its numbers.
    ["internals"] sensor_datatype: Vec<DataType>,
    /// Stage of a step after which it can be read: 1 positions, 2 velocities, 3 accelerations; 0 where a user's says none.
    ["internals"] sensor_needstage: Vec<usize>,
    /// First entry in `sensordata`.
    sensor_adr: Vec<usize>,
    /// Numbers for programs, `nuser_sensor` for each sensor.
    sensor_user: Vec<Vec<f64>>,

    /// Names of `<numeric>` data.
    numeric_name: Vec<String>,
    /// Numbers for programs, of any length each.
    numeric_data: Vec<Vec<f64>>,
    /// Names of `<text>` data.
    text_name: Vec<String>,
    /// Texts for programs.
    text_data: Vec<String>,

    /// Keyframes.
    keys: Vec<Keyframe>,
}
