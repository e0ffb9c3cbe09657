//! The compiled scene: MuJoCo's arrays and names.

use babybench::Model;
use babybench::model::Arrays;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::ToArray;

/// Lists arrays by name.
macro_rules! table {
    ($names:ident, $get:ident, $type:ty, $($field:ident)*) => {
        /// The names of the arrays.
        pub const $names: &[&str] = &[$(stringify!($field)),*];

        /// Returns a fresh copy of an array by name.
        pub fn $get<'py>(py: Python<'py>, of: &$type, name: &str) -> PyResult<Bound<'py, PyAny>> {
            match name {
                $(stringify!($field) => of.$field[..].to_array(py),)*
                _ => Err(pyo3::exceptions::PyKeyError::new_err(format!("there is no array {name:?}; there are {}", $names.join(", ")))),
            }
        }
    };
}
pub(crate) use table;

table! { ARRAYS, array, Arrays,
    body_parentid body_rootid body_weldid body_jntadr body_jntnum body_dofadr body_dofnum body_geomadr body_geomnum
    body_pos body_quat body_ipos body_iquat body_mass body_subtreemass body_inertia body_invweight0
    jnt_type jnt_bodyid jnt_qposadr jnt_dofadr jnt_pos jnt_axis jnt_limited jnt_range jnt_margin jnt_stiffness jnt_actfrcrange
    jnt_solref jnt_solimp jnt_group
    dof_bodyid dof_jntid dof_parentid dof_armature dof_damping dof_frictionloss dof_invweight0 dof_m0 dof_solref
    dof_solimp
    qpos0 qpos_spring
    geom_type geom_size geom_bodyid geom_pos geom_quat geom_contype geom_conaffinity geom_condim geom_priority
    geom_friction geom_solmix geom_solref geom_solimp geom_margin geom_gap geom_rbound geom_group geom_rgba geom_matid
    site_type site_bodyid site_size site_pos site_quat site_group site_rgba site_matid
    cam_bodyid cam_pos cam_quat cam_fovy cam_orthographic cam_user
    pair_geom pair_dim pair_solref pair_solreffriction pair_solimp pair_friction pair_margin pair_gap
    exclude
    eq_active0 eq_solref eq_solimp
    tendon_limited tendon_range tendon_margin tendon_solref_lim tendon_solimp_lim tendon_invweight0 tendon_stiffness tendon_damping
    tendon_frictionloss tendon_lengthspring tendon_solref_fri tendon_solimp_fri
    actuator_trnid actuator_refid actuator_gear actuator_ctrllimited actuator_ctrlrange actuator_forcelimited actuator_forcerange
    actuator_lengthrange actuator_dyntype actuator_dynprm actuator_actadr actuator_actlimited actuator_actrange actuator_actearly
    actuator_gaintype actuator_gainprm actuator_biastype actuator_biasprm actuator_user
    sensor_type sensor_objtype sensor_objid sensor_reftype sensor_refid sensor_adr sensor_cutoff sensor_noise
}

/// Returns the names of all elements, by kind.
pub fn names<'py>(py: Python<'py>, model: &Model) -> PyResult<Bound<'py, PyDict>> {
    let names = PyDict::new(py);
    for (kind, list) in [
        ("body", &model.body_name),
        ("joint", &model.jnt_name),
        ("geom", &model.geom_name),
        ("site", &model.site_name),
        ("camera", &model.cam_name),
        ("equality", &model.eq_name),
        ("tendon", &model.tendon_name),
        ("actuator", &model.actuator_name),
        ("sensor", &model.sensor_name),
    ] {
        names.set_item(kind, list)?;
    }
    Ok(names)
}

/// Returns sizes and options.
pub fn options<'py>(py: Python<'py>, model: &Model) -> PyResult<Bound<'py, PyDict>> {
    let options = PyDict::new(py);
    for (name, size) in [
        ("nq", model.nq),
        ("nv", model.nv),
        ("nu", model.nu()),
        ("na", model.na),
        ("nmocap", model.nmocap),
        ("nbody", model.nbody()),
        ("njnt", model.njnt()),
        ("ngeom", model.ngeom()),
        ("nsite", model.nsite()),
        ("ncam", model.ncam()),
        ("neq", model.neq()),
        ("ntendon", model.ntendon()),
        ("nsensor", model.nsensor()),
        ("nsensordata", model.nsensordata()),
        ("npair", model.npair()),
        ("iterations", model.opt.iterations),
        ("ls_iterations", model.opt.ls_iterations),
        ("ccd_iterations", model.opt.ccd_iterations),
    ] {
        options.set_item(name, size)?;
    }
    for (name, value) in [
        ("timestep", model.opt.timestep),
        ("tolerance", model.opt.tolerance),
        ("ls_tolerance", model.opt.ls_tolerance),
        ("impratio", model.opt.impratio),
        ("ccd_tolerance", model.opt.ccd_tolerance),
        ("density", model.opt.density),
        ("viscosity", model.opt.viscosity),
        ("extent", model.stat.extent),
        ("meaninertia", model.stat.meaninertia),
        ("meanmass", model.stat.meanmass),
        ("meansize", model.stat.meansize),
        ("znear", model.vis.znear),
        ("zfar", model.vis.zfar),
    ] {
        options.set_item(name, value)?;
    }
    options.set_item("center", model.stat.center[..].to_array(py)?)?;
    options.set_item("gravity", model.opt.gravity[..].to_array(py)?)?;
    options.set_item("wind", model.opt.wind[..].to_array(py)?)?;
    options.set_item("name", &model.name)?;
    Ok(options)
}
