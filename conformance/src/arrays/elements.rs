//! Bodies, joints, geoms, sites and cameras, and the arrays of all elements that no recording has.

use babybench::Model;
use babybench::model::{Keyframe, ObjType};

use super::relations::wrap;
use super::{Named, addresses, flags, flat, groups, ids, optional, shapes, users};

pub(super) fn of_bodies(m: &Model) -> Named {
    vec![
        ("body_parentid", ids(&m.body_parentid)),
        ("body_rootid", ids(&m.body_rootid)),
        ("body_weldid", ids(&m.body_weldid)),
        ("body_jntadr", addresses(&m.body_jntadr, &m.body_jntnum)),
        ("body_jntnum", ids(&m.body_jntnum)),
        ("body_dofadr", addresses(&m.body_dofadr, &m.body_dofnum)),
        ("body_dofnum", ids(&m.body_dofnum)),
        ("body_geomadr", addresses(&m.body_geomadr, &m.body_geomnum)),
        ("body_geomnum", ids(&m.body_geomnum)),
        ("body_pos", flat(&m.body_pos)),
        ("body_quat", flat(&m.body_quat)),
        ("body_ipos", flat(&m.body_ipos)),
        ("body_iquat", flat(&m.body_iquat)),
        ("body_mass", m.body_mass.clone()),
        ("body_subtreemass", m.body_subtreemass.clone()),
        ("body_inertia", flat(&m.body_inertia)),
    ]
}

pub(super) fn of_joints(m: &Model) -> Named {
    vec![
        (
            "jnt_type",
            m.jnt_type.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("jnt_bodyid", ids(&m.jnt_bodyid)),
        ("jnt_qposadr", ids(&m.jnt_qposadr)),
        ("jnt_dofadr", ids(&m.jnt_dofadr)),
        ("jnt_pos", flat(&m.jnt_pos)),
        ("jnt_axis", flat(&m.jnt_axis)),
        ("jnt_limited", flags(&m.jnt_limited)),
        ("jnt_range", flat(&m.jnt_range)),
        ("jnt_margin", m.jnt_margin.clone()),
        ("jnt_stiffness", m.jnt_stiffness.clone()),
        ("jnt_solref", flat(&m.jnt_solref)),
        ("jnt_solimp", flat(&m.jnt_solimp)),
        ("jnt_group", groups(&m.jnt_group)),
        ("dof_bodyid", ids(&m.dof_bodyid)),
        ("dof_jntid", ids(&m.dof_jntid)),
        ("dof_parentid", optional(&m.dof_parentid)),
        ("dof_armature", m.dof_armature.clone()),
        ("dof_damping", m.dof_damping.clone()),
        ("dof_frictionloss", m.dof_frictionloss.clone()),
        ("dof_solref", flat(&m.dof_solref)),
        ("dof_solimp", flat(&m.dof_solimp)),
        ("qpos0", m.qpos0.clone()),
        ("qpos_spring", m.qpos_spring.clone()),
    ]
}

pub(super) fn of_geoms(m: &Model) -> Named {
    vec![
        ("geom_type", shapes(&m.geom_type)),
        ("geom_size", flat(&m.geom_size)),
        ("geom_bodyid", ids(&m.geom_bodyid)),
        ("geom_pos", flat(&m.geom_pos)),
        ("geom_quat", flat(&m.geom_quat)),
        (
            "geom_contype",
            m.geom_contype.iter().map(|&v| f64::from(v.cast_signed())).collect(),
        ),
        (
            "geom_conaffinity",
            m.geom_conaffinity.iter().map(|&v| f64::from(v.cast_signed())).collect(),
        ),
        ("geom_condim", ids(&m.geom_condim)),
        ("geom_priority", m.geom_priority.iter().map(|&v| f64::from(v)).collect()),
        ("geom_friction", flat(&m.geom_friction)),
        ("geom_solmix", m.geom_solmix.clone()),
        ("geom_solref", flat(&m.geom_solref)),
        ("geom_solimp", flat(&m.geom_solimp)),
        ("geom_margin", m.geom_margin.clone()),
        ("geom_gap", m.geom_gap.clone()),
        ("geom_rbound", m.geom_rbound.clone()),
    ]
}

pub(super) fn of_sites_and_cameras(m: &Model) -> Named {
    vec![
        ("site_type", shapes(&m.site_type)),
        ("site_bodyid", ids(&m.site_bodyid)),
        ("site_size", flat(&m.site_size)),
        ("site_pos", flat(&m.site_pos)),
        ("site_quat", flat(&m.site_quat)),
        (
            "cam_mode",
            m.cam_mode.iter().map(|mode| f64::from(mode.code())).collect(),
        ),
        ("cam_targetbodyid", optional(&m.cam_targetbodyid)),
        ("cam_bodyid", ids(&m.cam_bodyid)),
        ("cam_pos", flat(&m.cam_pos)),
        ("cam_quat", flat(&m.cam_quat)),
        ("cam_fovy", m.cam_fovy.clone()),
        ("cam_user", users(&m.cam_user)),
    ]
}

/// Returns the arrays that recordings lack, which are compared only with a running MuJoCo.
pub fn unrecorded(m: &Model) -> Named {
    let kinds = |all: &[ObjType]| all.iter().map(|kind| f64::from(kind.code())).collect();
    let keys = |of: fn(&Keyframe) -> &[f64]| m.keys.iter().flat_map(of).copied().collect();
    let wraps = m.tendon_wrap.iter().flatten();
    vec![
        ("tex_nchannel", m.textures.iter().map(|t| t.channels as f64).collect()),
        ("wrap_type", wraps.map(|along| wrap(along)[0]).collect()),
        ("actuator_cranklength", m.actuator_cranklength.clone()),
        ("body_user", users(&m.body_user)),
        ("jnt_user", users(&m.jnt_user)),
        ("cam_orthographic", flags(&m.cam_orthographic)),
        (
            "light_active",
            m.lights.iter().map(|light| f64::from(u8::from(light.active))).collect(),
        ),
        ("nuserdata", vec![m.nuserdata as f64]),
        ("jnt_actfrclimited", flags(&m.jnt_actfrclimited)),
        ("jnt_actgravcomp", flags(&m.jnt_actgravcomp)),
        ("jnt_actfrcrange", flat(&m.jnt_actfrcrange)),
        ("tendon_frictionloss", m.tendon_frictionloss.clone()),
        ("tendon_solref_fri", flat(&m.tendon_solref_fri)),
        ("tendon_solimp_fri", flat(&m.tendon_solimp_fri)),
        ("tendon_length0", m.tendon_length0.clone()),
        ("tendon_group", groups(&m.tendon_group)),
        ("tendon_width", m.tendon_width.clone()),
        ("tendon_rgba", flat(&m.tendon_rgba)),
        ("tendon_matid", optional(&m.tendon_matid)),
        (
            "actuator_trntype",
            m.actuator_trntype.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("geom_user", users(&m.geom_user)),
        ("geom_dataid", optional(&m.geom_dataid)),
        ("geom_aabb", flat(&m.geom_aabb)),
        ("site_user", users(&m.site_user)),
        ("cam_pos0", flat(&m.cam_pos0)),
        ("cam_poscom0", flat(&m.cam_poscom0)),
        ("cam_mat0", flat(&m.cam_mat0)),
        ("sensor_dim", ids(&m.sensor_dim)),
        (
            "sensor_datatype",
            m.sensor_datatype.iter().map(|kind| f64::from(*kind as u8)).collect(),
        ),
        ("sensor_needstage", ids(&m.sensor_needstage)),
        (
            "cam_resolution",
            m.cam_resolution.iter().flatten().map(|&v| v as f64).collect(),
        ),
        ("cam_sensorsize", flat(&m.cam_sensorsize)),
        ("cam_intrinsic", flat(&m.cam_intrinsic)),
        ("sensor_objtype", kinds(&m.sensor_objtype)),
        ("sensor_reftype", kinds(&m.sensor_reftype)),
        ("sensor_refid", optional(&m.sensor_refid)),
        ("sensor_cutoff", m.sensor_cutoff.clone()),
        ("sensor_noise", m.sensor_noise.clone()),
        ("sensor_user", users(&m.sensor_user)),
        ("numeric_data", users(&m.numeric_data)),
        ("key_time", m.keys.iter().map(|key| key.time).collect()),
        ("key_qpos", keys(|key| &key.qpos)),
        ("key_qvel", keys(|key| &key.qvel)),
        ("key_act", keys(|key| &key.act)),
        ("key_ctrl", keys(|key| &key.ctrl)),
        ("geom_fluid", flat(&m.geom_fluid)),
        ("key_mpos", keys(|key| key.mpos.as_flattened())),
        ("key_mquat", keys(|key| key.mquat.as_flattened())),
        ("nmocap", vec![m.nmocap as f64]),
        ("body_mocapid", optional(&m.body_mocapid)),
    ]
}
