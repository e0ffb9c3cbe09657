//! The list of a model's arrays.

use super::*;
use crate::math::{Mat3, Quat, Vec3};

/// Copies a field. A separate function, because inlining it into the copy of all fields would repeat the allocation for each.
#[inline(never)]
fn copied<T: Clone>(field: &T) -> T {
    field.clone()
}

macro_rules! arrays {
    (
        $($(#[$setting_doc:meta])* $setting:ident : $setting_ty:ty),*;
        $($(#[$doc:meta])* $field:ident : $ty:ty),* $(,)?
    ) => {
        /// The numbers of a scene under MuJoCo's names, as a [`Model`] shows them; see the [module documentation](super).
        ///
        /// A field has the name that its array has in MuJoCo's `mjModel`, unless its documentation tells another one. In parentheses
        /// stands its shape: the number of elements, then of numbers for each. Ids count from 0 in document order, and the body 0 is the
        /// world. Units are SI; orientations are unit quaternions `w, x, y, z`, or rotation matrices row by row.
        ///
        /// # Solver parameters
        /// `solref` (2) says how fast a violated constraint returns: time constant, s, and damping ratio, no unit. If both are zero or
        /// less, they are the negative stiffness, 1/s^2, and the negative damping, 1/s. If only one is positive, (0.02, 1) counts.
        ///
        /// `solimp` (5) says how hard a constraint is: impedance without violation and at the width, 0..1; width, m or rad; midpoint,
        /// 0..1, and power, at least 1, of the curve between the two impedances, no unit.
        #[derive(Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Arrays {
            $($(#[$setting_doc])* pub $setting: $setting_ty,)*
            $($(#[$doc])* pub $field: $ty,)*
        }

        impl Clone for Arrays {
            fn clone(&self) -> Self {
                Self { $($setting: copied(&self.$setting),)* $($field: copied(&self.$field),)* }
            }
        }

        impl Arrays {
            /// Makes arrays that hold settings and no elements.
            pub fn without_elements($($setting: $setting_ty),*) -> Self {
                Self { $($setting,)* $($field: Default::default(),)* }
            }
        }
    };
}

arrays! {
    /// Name of the model, that of `<mujoco model>`.
    name: String,
    /// Options of physics: MuJoCo's `mjOption`.
    opt: Options,
    /// Settings of pictures: MuJoCo's `mjVisual`.
    vis: Visual,
    /// Statistics, given by the document or computed: MuJoCo's `mjStatistic`.
    stat: Statistic;

    /// Number of position coordinates, the length of `qpos`.
    nq: usize,
    /// Number of degrees of freedom, the length of `qvel`.
    nv: usize,
    /// Number of activations of actuators, the length of `act`.
    na: usize,
    /// Number of mocap bodies, which a program moves.
    nmocap: usize,
    /// Length of `userdata` of a simulation (`nuserdata`), numbers that only programs read and write.
    nuserdata: usize,

    /// Names of the bodies (nbody), "world" first; may be empty. MuJoCo's `name_bodyadr`.
    body_name: Vec<String>,
    /// Parent of each body (nbody), by id; 0 for the world itself.
    body_parentid: Vec<usize>,
    /// Root of each body's tree (nbody), by id: the ancestor that is a child of the world; 0 for the world.
    body_rootid: Vec<usize>,
    /// Body to which each body is rigidly attached (nbody), by id: itself if it has joints, otherwise that of its parent; 0 for bodies
    /// that never move by joints.
    body_weldid: Vec<usize>,
    /// First joint of each body (nbody), by id. Without joints, the id of the next joint, where MuJoCo has -1.
    body_jntadr: Vec<usize>,
    /// Number of joints of each body (nbody).
    body_jntnum: Vec<usize>,
    /// First degree of freedom of each body (nbody). Without any, the number of the next one, where MuJoCo has -1.
    body_dofadr: Vec<usize>,
    /// Number of degrees of freedom of each body (nbody).
    body_dofnum: Vec<usize>,
    /// First geom of each body (nbody), by id. Without geoms, the id of the next geom, where MuJoCo has -1.
    body_geomadr: Vec<usize>,
    /// Number of geoms of each body (nbody).
    body_geomnum: Vec<usize>,
    /// Position of each body's frame (nbody, 3), parent frame, m.
    body_pos: Vec<Vec3>,
    /// Orientation of each body's frame (nbody, 4), parent frame, unit quaternion `w, x, y, z`.
    body_quat: Vec<Quat>,
    /// Centre of mass of each body (nbody, 3), body frame, m.
    body_ipos: Vec<Vec3>,
    /// Orientation of each body's principal axes of inertia (nbody, 4), body frame, unit quaternion.
    body_iquat: Vec<Quat>,
    /// Mass of each body (nbody), kg.
    body_mass: Vec<f64>,
    /// Mass of each body with all bodies below it (nbody), kg.
    body_subtreemass: Vec<f64>,
    /// Principal moments of inertia of each body (nbody, 3) about its centre of mass, along the axes of `body_iquat`, kg m^2.
    body_inertia: Vec<Vec3>,
    /// Whether each body's inertial frame coincides with its body frame (nbody): MuJoCo's `mjtSameFrame`.
    body_sameframe: Vec<SameFrame>,
    /// Row of each body in `mocap_pos` and `mocap_quat` (nbody); `None` if it is not a mocap body, where MuJoCo has -1.
    body_mocapid: Vec<Option<usize>>,
    /// Gravity compensation of each body (nbody), as a share of its weight; 0 for none.
    body_gravcomp: Vec<f64>,
    /// Mean inverse weight of each body at `qpos0` (nbody, 2): translation, 1/kg, and rotation, 1/(kg m^2).
    body_invweight0: Vec<[f64; 2]>,
    /// Numbers for programs (nbody, `nuser_body`), no unit. Physics and pictures ignore them.
    body_user: Vec<Vec<f64>>,

    /// Names of the joints (njnt); may be empty. MuJoCo's `name_jntadr`.
    jnt_name: Vec<String>,
    /// Type of each joint (njnt): MuJoCo's `mjtJoint`.
    jnt_type: Vec<JointType>,
    /// Body that each joint moves (njnt), by id.
    jnt_bodyid: Vec<usize>,
    /// First coordinate of each joint in `qpos` (njnt).
    jnt_qposadr: Vec<usize>,
    /// First coordinate of each joint in `qvel` (njnt).
    jnt_dofadr: Vec<usize>,
    /// Anchor of each joint (njnt, 3), body frame, m.
    jnt_pos: Vec<Vec3>,
    /// Axis of each hinge or slide (njnt, 3), body frame, unit vector; (0, 0, 1) for other types.
    jnt_axis: Vec<Vec3>,
    /// Whether `jnt_range` limits each joint (njnt).
    jnt_limited: Vec<bool>,
    /// Lower and upper limit of each joint (njnt, 2): rad for hinges, m for slides; of a ball joint the second is its greatest angle,
    /// rad. A range without effect stays as in the document.
    jnt_range: Vec<[f64; 2]>,
    /// Distance to its limit below which each joint's limit becomes a constraint (njnt), rad or m.
    jnt_margin: Vec<f64>,
    /// Stiffness of each joint's spring (njnt): N m/rad for hinges and balls, N/m for slides. A free joint has both.
    jnt_stiffness: Vec<f64>,
    /// Whether gravity compensation acts on each joint as an actuator force, `qfrc_actuator`, and not as a passive one (njnt).
    jnt_actgravcomp: Vec<bool>,
    /// Whether `jnt_actfrcrange` limits the actuator force on each joint (njnt).
    jnt_actfrclimited: Vec<bool>,
    /// Least and greatest sum of the actuator forces on each joint (njnt, 2): N m for hinges, N for slides.
    jnt_actfrcrange: Vec<[f64; 2]>,
    /// Time constant, s, and damping ratio from which the compiler computes each joint's spring and damper (njnt, 2); zeros where the
    /// document gives these directly. Not in MuJoCo's `mjModel`.
    jnt_springdamper: Vec<[f64; 2]>,
    /// `solref` of each joint's limit (njnt, 2); see [Solver parameters](#solver-parameters).
    jnt_solref: Vec<[f64; 2]>,
    /// `solimp` of each joint's limit (njnt, 5); see [Solver parameters](#solver-parameters).
    jnt_solimp: Vec<[f64; 5]>,
    /// Group of each joint for visualization (njnt), no effect here.
    jnt_group: Vec<i32>,
    /// Numbers for programs (njnt, `nuser_jnt`), no unit. Physics and pictures ignore them.
    jnt_user: Vec<Vec<f64>>,

    /// Body of each degree of freedom (nv), by id.
    dof_bodyid: Vec<usize>,
    /// Joint of each degree of freedom (nv), by id.
    dof_jntid: Vec<usize>,
    /// Next degree of freedom towards the root of the tree (nv); `None` for the first of a tree, where MuJoCo has -1.
    dof_parentid: Vec<Option<usize>>,
    /// Inertia that each degree of freedom has besides that of bodies, such as a rotor's (nv): kg m^2 for rotations, kg for
    /// translations.
    dof_armature: Vec<f64>,
    /// Damping of each degree of freedom (nv): N m s/rad for rotations, N s/m for translations.
    dof_damping: Vec<f64>,
    /// Dry friction of each degree of freedom (nv): N m for rotations, N for translations.
    dof_frictionloss: Vec<f64>,
    /// Diagonal of the inverse inertia at `qpos0` (nv): 1/(kg m^2) for rotations, 1/kg for translations.
    dof_invweight0: Vec<f64>,
    /// Diagonal of the inertia at `qpos0` (nv): kg m^2 for rotations, kg for translations. MuJoCo's `dof_M0`.
    dof_m0: Vec<f64>,
    /// `solref` of dry friction (nv, 2); see [Solver parameters](#solver-parameters).
    dof_solref: Vec<[f64; 2]>,
    /// `solimp` of dry friction (nv, 5); see [Solver parameters](#solver-parameters).
    dof_solimp: Vec<[f64; 5]>,

    /// Reference positions (nq): m for slides and positions of free joints, rad for hinges, unit quaternions for balls and free joints.
    qpos0: Vec<f64>,
    /// Positions at which the springs of the joints are at rest (nq), in the units of `qpos0`.
    qpos_spring: Vec<f64>,

    /// Names of the geoms (ngeom); may be empty. MuJoCo's `name_geomadr`.
    geom_name: Vec<String>,
    /// Shape of each geom (ngeom): MuJoCo's `mjtGeom`.
    geom_type: Vec<GeomType>,
    /// Size of each geom (ngeom, 3), m; [`GeomType`] tells what the numbers mean.
    geom_size: Vec<Vec3>,
    /// Mesh of each geom that is one or is fitted to one, by its index in [`Arrays::meshes`]; height field, by its index in
    /// [`Arrays::hfields`] (ngeom); `None` for the other shapes.
    geom_dataid: Vec<Option<usize>>,
    /// Body that carries each geom (ngeom), by id.
    geom_bodyid: Vec<usize>,
    /// Centre of each geom (ngeom, 3), body frame, m.
    geom_pos: Vec<Vec3>,
    /// Orientation of each geom (ngeom, 4), body frame, unit quaternion `w, x, y, z`.
    geom_quat: Vec<Quat>,
    /// Which frame of its body each geom's frame coincides with, if any (ngeom): MuJoCo's `mjtSameFrame`.
    geom_sameframe: Vec<SameFrame>,
    /// Bits of each geom's contact type (ngeom). Two geoms may touch if one's type and the other's affinity share a bit.
    geom_contype: Vec<u32>,
    /// Bits of each geom's contact affinity (ngeom).
    geom_conaffinity: Vec<u32>,
    /// Dimension of each geom's contacts (ngeom): 1 frictionless, 3 sliding, 4 torsional, 6 rolling friction.
    geom_condim: Vec<usize>,
    /// Priority of each geom's contact parameters (ngeom). Those of the geom with the higher priority are used; at equal priority they are mixed.
    geom_priority: Vec<i32>,
    /// Friction coefficients of each geom (ngeom, 3): sliding, no unit; torsional, m; rolling, m.
    geom_friction: Vec<[f64; 3]>,
    /// Weight of each geom's `solref` and `solimp` when those of two geoms are mixed (ngeom), no unit.
    geom_solmix: Vec<f64>,
    /// `solref` of each geom's contacts (ngeom, 2); see [Solver parameters](#solver-parameters).
    geom_solref: Vec<[f64; 2]>,
    /// `solimp` of each geom's contacts (ngeom, 5); see [Solver parameters](#solver-parameters).
    geom_solimp: Vec<[f64; 5]>,
    /// Distance below which a contact of each geom is detected (ngeom), m.
    geom_margin: Vec<f64>,
    /// Distance by which a detected contact must be closer than the margin to exert a force (ngeom), m.
    geom_gap: Vec<f64>,
    /// Interaction of each geom with the medium as an ellipsoid (ngeom, 12): 1 if it has one; coefficients of blunt, slender and
    /// angular drag, Kutta lift and Magnus lift, no unit; virtual mass as volumes (3), m^3, and virtual inertia (3), m^5. Zeros if it
    /// has none.
    geom_fluid: Vec<[f64; 12]>,
    /// Bounding box of each geom (ngeom, 6), geom frame, m: centre, half lengths. That of a plane is the half space below it, to 1e10.
    geom_aabb: Vec<[f64; 6]>,
    /// Radius of each geom's bounding sphere (ngeom), m; 0 for planes.
    geom_rbound: Vec<f64>,
    /// Group of each geom for visualization (ngeom); those up to 2 are drawn.
    geom_group: Vec<i32>,
    /// Red, green, blue, opacity of each geom (ngeom, 4), 0..1, which apply without a material.
    geom_rgba: Vec<[f64; 4]>,
    /// Material of each geom (ngeom), by its index in [`Arrays::materials`]; `None` without one.
    geom_matid: Vec<Option<usize>>,
    /// Numbers for programs (ngeom, `nuser_geom`), no unit. Physics and pictures ignore them.
    geom_user: Vec<Vec<f64>>,

    /// Names of the sites (nsite); may be empty. MuJoCo's `name_siteadr`.
    site_name: Vec<String>,
    /// Shape of each site (nsite): MuJoCo's `mjtGeom`. Touch sensors and pictures use it.
    site_type: Vec<GeomType>,
    /// Body that carries each site (nsite), by id.
    site_bodyid: Vec<usize>,
    /// Size of each site (nsite, 3), m; [`GeomType`] tells what the numbers mean.
    site_size: Vec<Vec3>,
    /// Position of each site (nsite, 3), body frame, m.
    site_pos: Vec<Vec3>,
    /// Orientation of each site (nsite, 4), body frame, unit quaternion `w, x, y, z`.
    site_quat: Vec<Quat>,
    /// Which frame of its body each site's frame coincides with, if any (nsite): MuJoCo's `mjtSameFrame`.
    site_sameframe: Vec<SameFrame>,
    /// Group of each site for visualization (nsite); those up to 2 are drawn.
    site_group: Vec<i32>,
    /// Red, green, blue, opacity of each site (nsite, 4), 0..1, which apply without a material.
    site_rgba: Vec<[f64; 4]>,
    /// Material of each site (nsite), by its index in [`Arrays::materials`]; `None` without one.
    site_matid: Vec<Option<usize>>,
    /// Numbers for programs (nsite, `nuser_site`), no unit. Physics and pictures ignore them.
    site_user: Vec<Vec<f64>>,

    /// Names of the cameras (ncam); may be empty. MuJoCo's `name_camadr`.
    cam_name: Vec<String>,
    /// How each camera is placed and aimed (ncam): MuJoCo's `mjtCamLight`.
    cam_mode: Vec<CamLight>,
    /// Body that each camera looks at in modes that aim at one (ncam), by id; `None` in the others, where MuJoCo has -1.
    cam_targetbodyid: Vec<Option<usize>>,
    /// Body that carries each camera (ncam), by id.
    cam_bodyid: Vec<usize>,
    /// Position of each camera (ncam, 3), body frame, m.
    cam_pos: Vec<Vec3>,
    /// Orientation of each camera (ncam, 4), body frame, unit quaternion. A camera looks along its -z axis; +y is up in its picture.
    cam_quat: Vec<Quat>,
    /// Position of each camera at `qpos0` (ncam, 3) from its body's origin, world axes, m.
    cam_pos0: Vec<Vec3>,
    /// Position of each camera at `qpos0` (ncam, 3) from the centre of mass of the subtree of its target, or of its body without a
    /// target, world axes, m.
    cam_poscom0: Vec<Vec3>,
    /// Orientation of each camera at `qpos0` (ncam, 9), world frame, rotation matrix row by row.
    cam_mat0: Vec<Mat3>,
    /// Whether the rays of each camera are parallel (`cam_orthographic`, ncam). Its `cam_fovy` is then the height of the picture, m.
    cam_orthographic: Vec<bool>,
    /// Width and height of each camera's picture for sensors (ncam, 2), pixels.
    cam_resolution: Vec<[usize; 2]>,
    /// Vertical field of view of each camera (ncam), degrees.
    cam_fovy: Vec<f64>,
    /// Width and height of each camera's image sensor (ncam, 2), m; zeros where the document gives only the field of view.
    cam_sensorsize: Vec<[f64; 2]>,
    /// Focal lengths along x and y and principal point, x and y, of each camera (ncam, 4), m, camera frame; used where it has a sensor
    /// size.
    cam_intrinsic: Vec<[f64; 4]>,
    /// Numbers for programs (ncam, `nuser_cam`), no unit. Physics and pictures ignore them.
    cam_user: Vec<Vec<f64>>,

    /// Meshes (nmesh): MuJoCo's arrays `mesh_*`, one value for each mesh.
    meshes: Vec<Mesh>,
    /// Height fields (nhfield): MuJoCo's arrays `hfield_*`, one value for each field.
    hfields: Vec<HField>,
    /// Skins (nskin): MuJoCo's arrays `skin_*`, one value for each skin.
    skins: Vec<Skin>,
    /// Flexes (nflex): MuJoCo's arrays `flex_*` and `flexedge_*`, one value for each flex.
    flexes: Vec<Flex>,

    /// Lights (nlight): MuJoCo's arrays `light_*`, one value for each light.
    lights: Vec<Light>,
    /// Textures (ntex): one recipe for each texture, from which MuJoCo's arrays `tex_*` are made.
    textures: Vec<Texture>,
    /// Materials (nmat): MuJoCo's arrays `mat_*`, one value for each material.
    materials: Vec<Material>,

    /// Geoms of each explicit contact pair (npair, 2), by id, the geom of the lower body first. MuJoCo's `pair_geom1` and `pair_geom2`.
    pair_geom: Vec<[usize; 2]>,
    /// Dimension of each explicit pair's contacts (npair): 1, 3, 4 or 6, as `geom_condim`.
    pair_dim: Vec<usize>,
    /// `solref` of each explicit pair's normal (npair, 2); see [Solver parameters](#solver-parameters).
    pair_solref: Vec<[f64; 2]>,
    /// `solref` of each explicit pair's friction (npair, 2); zeros mean that of the normal.
    pair_solreffriction: Vec<[f64; 2]>,
    /// `solimp` of each explicit pair (npair, 5); see [Solver parameters](#solver-parameters).
    pair_solimp: Vec<[f64; 5]>,
    /// Friction coefficients of each explicit pair (npair, 5): sliding along both tangents, no unit; torsional, m; rolling about both
    /// tangents, m.
    pair_friction: Vec<[f64; 5]>,
    /// Distance below which each explicit pair's contact is detected (npair), m.
    pair_margin: Vec<f64>,
    /// Distance by which each explicit pair must be closer than its margin to exert a force (npair), m.
    pair_gap: Vec<f64>,
    /// Pairs of bodies whose geoms never touch (nexclude, 2), by id, the lower one first, sorted. MuJoCo's `exclude_signature`.
    exclude: Vec<[usize; 2]>,

    /// Names of the equality constraints (neq); may be empty. MuJoCo's `name_eqadr`.
    eq_name: Vec<String>,
    /// Kind of each equality constraint with its objects and numbers (neq): MuJoCo's `eq_type`, `eq_objtype`, `eq_obj1id`, `eq_obj2id`
    /// and `eq_data`. [`EqualityKind`] tells units and frames.
    eq_kind: Vec<EqualityKind>,
    /// Whether each equality constraint is active after a reset (neq).
    eq_active0: Vec<bool>,
    /// `solref` of each equality constraint (neq, 2); see [Solver parameters](#solver-parameters).
    eq_solref: Vec<[f64; 2]>,
    /// `solimp` of each equality constraint (neq, 5); see [Solver parameters](#solver-parameters).
    eq_solimp: Vec<[f64; 5]>,

    /// Names of the tendons (ntendon); may be empty. MuJoCo's `name_tendonadr`.
    tendon_name: Vec<String>,
    /// Path of each tendon (ntendon), in document order: MuJoCo's `tendon_adr`, `tendon_num`, `wrap_type`, `wrap_objid` and `wrap_prm`.
    tendon_wrap: Vec<Vec<Wrap>>,
    /// Whether `tendon_range` limits each tendon (ntendon).
    tendon_limited: Vec<bool>,
    /// Shortest and longest length of each tendon (ntendon, 2): m for spatial tendons; for fixed ones the unit of joint coordinates
    /// times coefficients.
    tendon_range: Vec<[f64; 2]>,
    /// Distance to its limit below which each tendon's limit becomes a constraint (ntendon), in the unit of its length.
    tendon_margin: Vec<f64>,
    /// `solref` of each tendon's limit (ntendon, 2); see [Solver parameters](#solver-parameters).
    tendon_solref_lim: Vec<[f64; 2]>,
    /// `solimp` of each tendon's limit (ntendon, 5); see [Solver parameters](#solver-parameters).
    tendon_solimp_lim: Vec<[f64; 5]>,
    /// Lengths between which each tendon's spring is slack (ntendon, 2), in the unit of its length; that at `qpos_spring` if the document gives none.
    tendon_lengthspring: Vec<[f64; 2]>,
    /// Dry friction of each tendon (ntendon): N for spatial tendons.
    tendon_frictionloss: Vec<f64>,
    /// `solref` of each tendon's dry friction (ntendon, 2); see [Solver parameters](#solver-parameters).
    tendon_solref_fri: Vec<[f64; 2]>,
    /// `solimp` of each tendon's dry friction (ntendon, 5); see [Solver parameters](#solver-parameters).
    tendon_solimp_fri: Vec<[f64; 5]>,
    /// Stiffness of each tendon's spring (ntendon): N/m for spatial tendons.
    tendon_stiffness: Vec<f64>,
    /// Damping of each tendon (ntendon): N s/m for spatial tendons.
    tendon_damping: Vec<f64>,
    /// Inverse weight of each tendon at `qpos0` (ntendon): 1/kg for spatial tendons.
    tendon_invweight0: Vec<f64>,
    /// Length of each tendon at `qpos0` (ntendon): m for spatial tendons.
    tendon_length0: Vec<f64>,
    /// Group of each tendon for visualization (ntendon); those up to 2 are drawn.
    tendon_group: Vec<i32>,
    /// Radius with which each tendon is drawn (ntendon), m.
    tendon_width: Vec<f64>,
    /// Red, green, blue, opacity of each tendon (ntendon, 4), 0..1, which apply without a material.
    tendon_rgba: Vec<[f64; 4]>,
    /// Material of each tendon (ntendon), by its index in [`Arrays::materials`]; `None` without one.
    tendon_matid: Vec<Option<usize>>,
    /// Numbers for programs (ntendon, `nuser_tendon`), no unit. Physics and pictures ignore them.
    tendon_user: Vec<Vec<f64>>,

    /// Names of the actuators (nu); may be empty. MuJoCo's `name_actuatoradr`.
    actuator_name: Vec<String>,
    /// Kind of object that each actuator acts on (nu): MuJoCo's `mjtTrn`.
    actuator_trntype: Vec<TrnType>,
    /// Joint, tendon, site or body that each actuator acts on (nu), by id; for a slider-crank, the site of its crank. The first of MuJoCo's two ids.
    actuator_trnid: Vec<usize>,
    /// Reference site of an actuator on a site, or the slider's site of a slider-crank (nu), by id; `None` without one. The second of MuJoCo's
    /// `actuator_trnid`.
    actuator_refid: Vec<Option<usize>>,
    /// Length of each slider-crank's rod (nu), m; 0 for other actuators.
    actuator_cranklength: Vec<f64>,
    /// Gear of each actuator (nu), by which its length and force are scaled, no unit on hinges and slides. The first of MuJoCo's six.
    actuator_gear: Vec<f64>,
    /// All six gears of each actuator (nu, 6), MuJoCo's `actuator_gear`: force (3) and torque (3) per unit of actuator force on sites,
    /// axes of ball and free joints; in the frame of the site, or its reference site.
    actuator_gear6: Vec<[f64; 6]>,
    /// Whether `actuator_ctrlrange` limits each control (nu).
    actuator_ctrllimited: Vec<bool>,
    /// Least and greatest control of each actuator (nu, 2), in the unit of its control.
    actuator_ctrlrange: Vec<[f64; 2]>,
    /// Whether `actuator_forcerange` limits each force (nu).
    actuator_forcelimited: Vec<bool>,
    /// Least and greatest force of each actuator before the gear (nu, 2), N or N m.
    actuator_forcerange: Vec<[f64; 2]>,
    /// Group of each actuator (nu). `disableactuator` of the options switches off groups 0 to 30 by bits.
    actuator_group: Vec<i32>,
    /// Shortest and longest length of each actuator (nu, 2), in the unit of its length; only MuJoCo's muscles use it. As given, or else found by
    /// simulation if `<lengthrange>` of `<compiler>` requests it.
    actuator_lengthrange: Vec<[f64; 2]>,
    /// How each actuator's activation follows its control (nu): MuJoCo's `mjtDyn`.
    actuator_dyntype: Vec<DynType>,
    /// Parameters of each actuator's activation (nu, 10); [`DynType`] tells meanings and units.
    actuator_dynprm: Vec<[f64; 10]>,
    /// Index of each actuator's activation in `act` (nu); `None` without one, where MuJoCo has -1.
    actuator_actadr: Vec<Option<usize>>,
    /// Whether `actuator_actrange` limits each activation (nu).
    actuator_actlimited: Vec<bool>,
    /// Least and greatest activation of each actuator (nu, 2), in the unit of its activation.
    actuator_actrange: Vec<[f64; 2]>,
    /// Whether each force follows from the activation at the end of the step instead of that at its start (nu).
    actuator_actearly: Vec<bool>,
    /// How each actuator's gain is computed (nu): MuJoCo's `mjtGain`.
    actuator_gaintype: Vec<GainType>,
    /// Parameters of each actuator's gain (nu, 10); [`GainType`] tells meanings and units.
    actuator_gainprm: Vec<[f64; 10]>,
    /// How each actuator's bias force is computed (nu): MuJoCo's `mjtBias`.
    actuator_biastype: Vec<BiasType>,
    /// Parameters of each actuator's bias (nu, 10); [`BiasType`] tells meanings and units. A damping ratio of a position servo is
    /// compiled to its damping at `qpos0`.
    actuator_biasprm: Vec<[f64; 10]>,
    /// Norm of the acceleration `qacc` at `qpos0` per unit of each actuator's force (nu), in the units of `qacc` over N or N m.
    actuator_acc0: Vec<f64>,
    /// Length of each actuator at `qpos0` (nu), in the unit of its length: rad or m times the gear.
    actuator_length0: Vec<f64>,
    /// Numbers for programs (nu, `nuser_actuator`), no unit. Physics and pictures ignore them.
    actuator_user: Vec<Vec<f64>>,

    /// Names of the sensors (nsensor); may be empty. MuJoCo's `name_sensoradr`.
    sensor_name: Vec<String>,
    /// Quantity that each sensor measures (nsensor), with its unit and frame: MuJoCo's `mjtSensor`.
    sensor_type: Vec<SensorType>,
    /// Kind of object that each sensor measures (nsensor): MuJoCo's `mjtObj`.
    sensor_objtype: Vec<ObjType>,
    /// Object that each sensor measures (nsensor), by id; `None` for sensors of the whole model, where MuJoCo has -1.
    sensor_objid: Vec<Option<usize>>,
    /// Kind of object in whose frame each sensor measures (nsensor): MuJoCo's `mjtObj`.
    sensor_reftype: Vec<ObjType>,
    /// Object in whose frame each sensor measures (nsensor), by id; `None` for the world frame, where MuJoCo has -1.
    sensor_refid: Vec<Option<usize>>,
    /// Bound on the absolute value of each sensor's numbers (nsensor), in their unit; 0 for none.
    sensor_cutoff: Vec<f64>,
    /// Standard deviation of each sensor's noise (nsensor), in the unit of its numbers. It is information for programs; sensors are exact.
    sensor_noise: Vec<f64>,
    /// Number of values of each sensor (nsensor).
    sensor_dim: Vec<usize>,
    /// Kind of each sensor's numbers, which decides how its cutoff applies (nsensor): MuJoCo's `mjtDataType`.
    sensor_datatype: Vec<DataType>,
    /// Stage of a step after which each sensor can be read (nsensor), MuJoCo's `mjtStage`: 1 positions, 2 velocities, 3 accelerations;
    /// 0 for a user sensor without one.
    sensor_needstage: Vec<usize>,
    /// First entry of each sensor in `sensordata` (nsensor).
    sensor_adr: Vec<usize>,
    /// Numbers for programs (nsensor, `nuser_sensor`), no unit. Physics and pictures ignore them.
    sensor_user: Vec<Vec<f64>>,

    /// Names of the `<numeric>` data (nnumeric). MuJoCo's `name_numericadr`.
    numeric_name: Vec<String>,
    /// Numbers of each `<numeric>` (nnumeric), of any length, no unit: MuJoCo's `numeric_data`, `numeric_adr` and `numeric_size`.
    numeric_data: Vec<Vec<f64>>,
    /// Names of the `<text>` data (ntext). MuJoCo's `name_textadr`.
    text_name: Vec<String>,
    /// Text of each `<text>` (ntext): MuJoCo's `text_data`, `text_adr` and `text_size`.
    text_data: Vec<String>,

    /// Keyframes (nkey): MuJoCo's arrays `key_*`, one value for each keyframe.
    keys: Vec<Keyframe>,
}
