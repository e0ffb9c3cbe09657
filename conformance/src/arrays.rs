//! Arrays of our compiled model under MuJoCo's names and in its layout.

use babybench::Model;
use babybench::model::{
    BiasType, CamLight, DynType, EqualityKind, GainType, GeomType, JointType, ObjType, TextureType, TrnType, Wrap,
};

fn ids(values: &[usize]) -> Vec<f64> {
    values.iter().map(|&v| v as f64).collect()
}

fn flags(values: &[bool]) -> Vec<f64> {
    values.iter().map(|&v| f64::from(u8::from(v))).collect()
}

fn flat<const N: usize>(values: &[[f64; N]]) -> Vec<f64> {
    values.iter().flatten().copied().collect()
}

fn optional(values: &[Option<usize>]) -> Vec<f64> {
    values.iter().map(|v| v.map_or(-1.0, |v| v as f64)).collect()
}

fn shapes(values: &[GeomType]) -> Vec<f64> {
    let code = |shape: &GeomType| match shape {
        GeomType::Plane => 0,
        GeomType::HField => 1,
        GeomType::Sphere => 2,
        GeomType::Capsule => 3,
        GeomType::Ellipsoid => 4,
        GeomType::Cylinder => 5,
        GeomType::Box => 6,
        GeomType::Mesh => 7,
    };
    values.iter().map(|shape| f64::from(code(shape))).collect()
}

/// Returns user data, one row after another.
fn users(values: &[Vec<f64>]) -> Vec<f64> {
    values.iter().flatten().copied().collect()
}

/// Returns MuJoCo's number of a mode.
fn cam_light_code(mode: CamLight) -> f64 {
    match mode {
        CamLight::Fixed => 0.0,
        CamLight::Track => 1.0,
        CamLight::TrackCom => 2.0,
        CamLight::TargetBody => 3.0,
        CamLight::TargetBodyCom => 4.0,
    }
}

/// Returns the addresses of ranges as MuJoCo stores them: -1 for an empty range.
fn addresses(first: &[usize], number: &[usize]) -> Vec<f64> {
    first
        .iter()
        .zip(number)
        .map(|(&first, &number)| if number == 0 { -1.0 } else { first as f64 })
        .collect()
}

/// Named arrays.
type Named = Vec<(&'static str, Vec<f64>)>;

/// Returns the arrays that matter to physics and sensors, under MuJoCo's names.
pub fn physical(m: &Model) -> Named {
    let groups = [
        sizes_and_options(m),
        of_bodies(m),
        of_joints(m),
        of_geoms(m),
        of_sites_and_cameras(m),
        of_contacts(m),
        of_equalities(m),
        of_tendons(m),
        of_sensors(m),
    ];
    groups.concat()
}

fn sizes_and_options(m: &Model) -> Named {
    vec![
        ("nq", vec![m.nq as f64]),
        ("nv", vec![m.nv as f64]),
        ("opt_timestep", vec![m.opt.timestep]),
        ("opt_gravity", m.opt.gravity.to_vec()),
        ("opt_iterations", vec![m.opt.iterations as f64]),
        ("opt_tolerance", vec![m.opt.tolerance]),
        ("opt_ls_iterations", vec![m.opt.ls_iterations as f64]),
        ("opt_ls_tolerance", vec![m.opt.ls_tolerance]),
        ("opt_impratio", vec![m.opt.impratio]),
        ("opt_ccd_iterations", vec![m.opt.ccd_iterations as f64]),
        ("opt_ccd_tolerance", vec![m.opt.ccd_tolerance]),
    ]
}

fn of_bodies(m: &Model) -> Named {
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

fn of_joints(m: &Model) -> Named {
    let joint_code = |kind: &JointType| match kind {
        JointType::Free => 0.0,
        JointType::Ball => 1.0,
        JointType::Slide => 2.0,
        JointType::Hinge => 3.0,
    };
    vec![
        ("jnt_type", m.jnt_type.iter().map(joint_code).collect()),
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
        ("jnt_group", ids(&m.jnt_group)),
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

fn of_geoms(m: &Model) -> Named {
    vec![
        ("geom_type", shapes(&m.geom_type)),
        ("geom_size", flat(&m.geom_size)),
        ("geom_bodyid", ids(&m.geom_bodyid)),
        ("geom_pos", flat(&m.geom_pos)),
        ("geom_quat", flat(&m.geom_quat)),
        ("geom_contype", m.geom_contype.iter().map(|&v| f64::from(v)).collect()),
        (
            "geom_conaffinity",
            m.geom_conaffinity.iter().map(|&v| f64::from(v)).collect(),
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

fn of_sites_and_cameras(m: &Model) -> Named {
    vec![
        ("site_type", shapes(&m.site_type)),
        ("site_bodyid", ids(&m.site_bodyid)),
        ("site_size", flat(&m.site_size)),
        ("site_pos", flat(&m.site_pos)),
        ("site_quat", flat(&m.site_quat)),
        (
            "cam_mode",
            m.cam_mode.iter().map(|&mode| cam_light_code(mode)).collect(),
        ),
        ("cam_targetbodyid", optional(&m.cam_targetbodyid)),
        ("cam_bodyid", ids(&m.cam_bodyid)),
        ("cam_pos", flat(&m.cam_pos)),
        ("cam_quat", flat(&m.cam_quat)),
        ("cam_fovy", m.cam_fovy.clone()),
        ("cam_user", users(&m.cam_user)),
    ]
}

/// Returns the arrays that recordings do not have: those are compared with MuJoCo alone where it runs.
pub fn unrecorded(m: &Model) -> Named {
    let transmission = |kind: &TrnType| match kind {
        TrnType::Joint => 0.0,
        TrnType::JointInParent => 1.0,
        TrnType::SliderCrank => 2.0,
        TrnType::Tendon => 3.0,
        TrnType::Site => 4.0,
        TrnType::Body => 5.0,
    };
    let kinds = |all: &[ObjType]| all.iter().map(|kind| f64::from(kind.code())).collect();
    let keys = |of: fn(&babybench::model::Keyframe) -> &[f64]| m.keys.iter().flat_map(of).copied().collect();
    let wraps = m.tendon_wrap.iter().flatten();
    vec![
        ("wrap_type", wraps.map(|along| wrap(along)[0]).collect()),
        ("actuator_cranklength", m.actuator_cranklength.clone()),
        ("body_user", users(&m.body_user)),
        ("jnt_user", users(&m.jnt_user)),
        ("jnt_actfrclimited", flags(&m.jnt_actfrclimited)),
        ("jnt_actgravcomp", flags(&m.jnt_actgravcomp)),
        ("jnt_actfrcrange", flat(&m.jnt_actfrcrange)),
        ("tendon_frictionloss", m.tendon_frictionloss.clone()),
        ("tendon_solref_fri", flat(&m.tendon_solref_fri)),
        ("tendon_solimp_fri", flat(&m.tendon_solimp_fri)),
        ("tendon_length0", m.tendon_length0.clone()),
        (
            "actuator_trntype",
            m.actuator_trntype.iter().map(transmission).collect(),
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

/// Returns the arrays of meshes. Those without faces have the triangles of their hulls.
pub fn of_meshes(m: &Model) -> Named {
    let number = |of: fn(&babybench::model::Mesh) -> usize| -> Vec<f64> {
        m.meshes.iter().map(|mesh| of(mesh) as f64).collect()
    };
    let vert = m.meshes.iter().flat_map(|mesh| mesh.vert.as_flattened());
    vec![
        ("mesh_vertnum", number(|mesh| mesh.vert.len())),
        ("mesh_normalnum", number(|mesh| mesh.normal.len())),
        ("mesh_texcoordnum", number(|mesh| mesh.texcoord.len())),
        ("mesh_facenum", number(|mesh| mesh.face.len())),
        ("mesh_vert", vert.map(|&x| f64::from(x)).collect()),
        ("hfield_size", m.hfields.iter().flat_map(|field| field.size).collect()),
        ("hfield_nrow", m.hfields.iter().map(|field| field.nrow as f64).collect()),
        ("hfield_ncol", m.hfields.iter().map(|field| field.ncol as f64).collect()),
        (
            "hfield_data",
            m.hfields
                .iter()
                .flat_map(|field| &field.data)
                .map(|&x| f64::from(x))
                .collect(),
        ),
        ("mesh_scale", m.meshes.iter().flat_map(|mesh| mesh.scale).collect()),
        ("mesh_pos", m.meshes.iter().flat_map(|mesh| mesh.pos).collect()),
        ("mesh_quat", m.meshes.iter().flat_map(|mesh| mesh.quat).collect()),
    ]
}

fn of_contacts(m: &Model) -> Named {
    vec![
        ("pair_geom1", m.pair_geom.iter().map(|g| g[0] as f64).collect()),
        ("pair_geom2", m.pair_geom.iter().map(|g| g[1] as f64).collect()),
        ("pair_dim", ids(&m.pair_dim)),
        ("pair_solref", flat(&m.pair_solref)),
        ("pair_solreffriction", flat(&m.pair_solreffriction)),
        ("pair_solimp", flat(&m.pair_solimp)),
        ("pair_friction", flat(&m.pair_friction)),
        ("pair_margin", m.pair_margin.clone()),
        ("pair_gap", m.pair_gap.clone()),
        (
            "exclude_signature",
            m.exclude.iter().map(|[a, b]| ((a << 16) + b) as f64).collect(),
        ),
    ]
}

fn of_equalities(m: &Model) -> Named {
    let rows: Vec<_> = m.eq_kind.iter().map(EqualityKind::numbers).collect();
    let id = |k: usize| rows.iter().map(|(ids, _)| f64::from(ids[k])).collect();
    vec![
        ("eq_type", id(0)),
        ("eq_obj1id", id(2)),
        ("eq_obj2id", id(3)),
        ("eq_data", rows.iter().flat_map(|(_, data)| *data).collect()),
        ("eq_active0", flags(&m.eq_active0)),
        ("eq_solref", flat(&m.eq_solref)),
        ("eq_solimp", flat(&m.eq_solimp)),
    ]
}

fn of_tendons(m: &Model) -> Named {
    let wraps: Vec<[f64; 3]> = m.tendon_wrap.iter().flatten().map(wrap).collect();
    let starts = m.tendon_wrap.iter().scan(0, |next, wrap| {
        *next += wrap.len();
        Some((*next - wrap.len()) as f64)
    });
    vec![
        ("tendon_adr", starts.collect()),
        (
            "tendon_num",
            m.tendon_wrap.iter().map(|wrap| wrap.len() as f64).collect(),
        ),
        ("tendon_limited", flags(&m.tendon_limited)),
        ("tendon_range", flat(&m.tendon_range)),
        ("tendon_margin", m.tendon_margin.clone()),
        ("tendon_solref_lim", flat(&m.tendon_solref_lim)),
        ("tendon_solimp_lim", flat(&m.tendon_solimp_lim)),
        ("tendon_lengthspring", flat(&m.tendon_lengthspring)),
        ("tendon_stiffness", m.tendon_stiffness.clone()),
        ("tendon_damping", m.tendon_damping.clone()),
        ("wrap_objid", wraps.iter().map(|wrap| wrap[1]).collect()),
        ("wrap_prm", wraps.iter().map(|wrap| wrap[2]).collect()),
    ]
}

/// Returns MuJoCo's type, object and parameter of what a tendon runs along.
fn wrap(wrap: &Wrap) -> [f64; 3] {
    let side = |side: Option<usize>| side.map_or(-1.0, |site| site as f64);
    match *wrap {
        Wrap::Joint { joint, coef } => [1.0, joint as f64, coef],
        Wrap::Pulley { divisor } => [2.0, -1.0, divisor],
        Wrap::Site { site } => [3.0, site as f64, 0.0],
        Wrap::Sphere { geom, side: site } => [4.0, geom as f64, side(site)],
        Wrap::Cylinder { geom, side: site } => [5.0, geom as f64, side(site)],
    }
}

fn of_sensors(m: &Model) -> Named {
    vec![
        (
            "sensor_type",
            m.sensor_type.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("sensor_objid", optional(&m.sensor_objid)),
        ("sensor_adr", ids(&m.sensor_adr)),
    ]
}

/// Returns the actuator arrays, reduced to what the model keeps.
pub fn actuators(m: &Model) -> Named {
    let bias = |kind: &BiasType| match kind {
        BiasType::None => 0.0,
        BiasType::Affine => 1.0,
        BiasType::Muscle => 2.0,
    };
    let seconds = m.actuator_trnid.iter().zip(&m.actuator_refid);
    let trnid = seconds.flat_map(|(&id, second)| [id as f64, second.map_or(-1.0, |id| id as f64)]);
    let trnid = trnid.collect();
    vec![
        ("actuator_trnid", trnid),
        ("actuator_gear", flat(&m.actuator_gear6)),
        ("actuator_ctrllimited", flags(&m.actuator_ctrllimited)),
        ("actuator_ctrlrange", flat(&m.actuator_ctrlrange)),
        ("actuator_forcelimited", flags(&m.actuator_forcelimited)),
        ("actuator_forcerange", flat(&m.actuator_forcerange)),
        ("actuator_gainprm", flat(&m.actuator_gainprm)),
        ("actuator_biastype", m.actuator_biastype.iter().map(bias).collect()),
        ("actuator_biasprm", flat(&m.actuator_biasprm)),
        ("actuator_user", m.actuator_user.iter().flatten().copied().collect()),
    ]
}

/// Returns the arrays of activations and gains, which recordings of scenes without them leave out.
pub fn activations(m: &Model) -> Named {
    let dynamics = |kind: &DynType| match kind {
        DynType::None => 0.0,
        DynType::Integrator => 1.0,
        DynType::Filter => 2.0,
        DynType::FilterExact => 3.0,
        DynType::Muscle => 4.0,
    };
    let gain = |kind: &GainType| match kind {
        GainType::Fixed => 0.0,
        GainType::Affine => 1.0,
        GainType::Muscle => 2.0,
    };
    let numbers = m.actuator_actadr.iter().map(|adr| f64::from(u8::from(adr.is_some())));
    vec![
        ("na", vec![m.na as f64]),
        ("actuator_dyntype", m.actuator_dyntype.iter().map(dynamics).collect()),
        ("actuator_dynprm", flat(&m.actuator_dynprm)),
        ("actuator_actadr", optional(&m.actuator_actadr)),
        ("actuator_actnum", numbers.collect()),
        ("actuator_actlimited", flags(&m.actuator_actlimited)),
        ("actuator_actrange", flat(&m.actuator_actrange)),
        ("actuator_actearly", flags(&m.actuator_actearly)),
        ("actuator_gaintype", m.actuator_gaintype.iter().map(gain).collect()),
        ("actuator_lengthrange", flat(&m.actuator_lengthrange)),
    ]
}

/// Returns the arrays that only change what is drawn.
pub fn looks(m: &Model) -> Named {
    [of_colours(m), of_lights(m), of_materials(m), of_views(m)].concat()
}

fn of_colours(m: &Model) -> Named {
    vec![
        ("geom_group", ids(&m.geom_group)),
        ("geom_rgba", flat(&m.geom_rgba)),
        ("geom_matid", optional(&m.geom_matid)),
        ("site_group", ids(&m.site_group)),
        ("site_rgba", flat(&m.site_rgba)),
        ("site_matid", optional(&m.site_matid)),
    ]
}

fn of_lights(m: &Model) -> Named {
    vec![
        ("light_bodyid", m.lights.iter().map(|l| l.bodyid as f64).collect()),
        ("light_mode", m.lights.iter().map(|l| cam_light_code(l.mode)).collect()),
        (
            "light_targetbodyid",
            optional(&m.lights.iter().map(|l| l.targetbodyid).collect::<Vec<_>>()),
        ),
        ("light_pos0", m.lights.iter().flat_map(|l| l.pos0).collect()),
        ("light_poscom0", m.lights.iter().flat_map(|l| l.poscom0).collect()),
        ("light_dir0", m.lights.iter().flat_map(|l| l.dir0).collect()),
        (
            "light_directional",
            m.lights.iter().map(|l| f64::from(u8::from(l.directional))).collect(),
        ),
        (
            "light_castshadow",
            m.lights.iter().map(|l| f64::from(u8::from(l.castshadow))).collect(),
        ),
        ("light_pos", m.lights.iter().flat_map(|l| l.pos).collect()),
        ("light_dir", m.lights.iter().flat_map(|l| l.dir).collect()),
        ("light_ambient", m.lights.iter().flat_map(|l| l.ambient).collect()),
        ("light_diffuse", m.lights.iter().flat_map(|l| l.diffuse).collect()),
        ("light_specular", m.lights.iter().flat_map(|l| l.specular).collect()),
        (
            "light_attenuation",
            m.lights.iter().flat_map(|l| l.attenuation).collect(),
        ),
        ("light_cutoff", m.lights.iter().map(|l| l.cutoff).collect()),
        ("light_exponent", m.lights.iter().map(|l| l.exponent).collect()),
    ]
}

fn of_materials(m: &Model) -> Named {
    let texture_code = |kind: TextureType| match kind {
        TextureType::Flat2d => 0.0,
        TextureType::Cube => 1.0,
        TextureType::Skybox => 2.0,
    };
    vec![
        ("mat_rgba", m.materials.iter().flat_map(|x| x.rgba).collect()),
        ("mat_specular", m.materials.iter().map(|x| x.specular).collect()),
        ("mat_shininess", m.materials.iter().map(|x| x.shininess).collect()),
        ("mat_reflectance", m.materials.iter().map(|x| x.reflectance).collect()),
        ("mat_emission", m.materials.iter().map(|x| x.emission).collect()),
        ("mat_texrepeat", m.materials.iter().flat_map(|x| x.texrepeat).collect()),
        (
            "mat_texuniform",
            m.materials.iter().map(|x| f64::from(u8::from(x.texuniform))).collect(),
        ),
        (
            "mat_texid",
            m.materials
                .iter()
                .map(|x| x.texture.map_or(-1.0, |id| id as f64))
                .collect(),
        ),
        ("tex_type", m.textures.iter().map(|t| texture_code(t.kind)).collect()),
    ]
}

fn of_views(m: &Model) -> Named {
    vec![
        ("vis_global__fovy", vec![m.vis.fovy]),
        ("vis_global__offwidth", vec![m.vis.offwidth as f64]),
        ("vis_global__offheight", vec![m.vis.offheight as f64]),
        ("vis_map_znear", vec![m.vis.znear]),
        ("vis_map_zfar", vec![m.vis.zfar]),
        ("vis_map_fogstart", vec![m.vis.fogstart]),
        ("vis_map_fogend", vec![m.vis.fogend]),
        ("vis_map_haze", vec![m.vis.haze]),
        ("vis_map_shadowclip", vec![m.vis.shadowclip]),
        ("vis_map_force", vec![m.vis.force]),
        ("vis_quality_shadowsize", vec![m.vis.shadowsize as f64]),
        ("vis_quality_offsamples", vec![m.vis.offsamples as f64]),
        (
            "vis_headlight_active",
            vec![f64::from(u8::from(m.vis.headlight_active))],
        ),
        ("vis_headlight_ambient", m.vis.headlight_ambient.to_vec()),
        ("vis_headlight_diffuse", m.vis.headlight_diffuse.to_vec()),
        ("vis_headlight_specular", m.vis.headlight_specular.to_vec()),
    ]
}

/// Cuts the rows of MuJoCo's arrays to the width of ours, after checking that the rest is unused (0 or -1).
///
/// `mat_texid` holds one texture per role, of which the models use the second (colour).
pub fn narrowed(name: &str, recorded: &[f64]) -> Vec<f64> {
    let (wide, first, keep) = match name {
        "mat_texid" => (10, 1, 1),
        _ => return recorded.to_vec(),
    };
    let mut out = Vec::new();
    for row in recorded.chunks(wide) {
        for (column, &value) in row.iter().enumerate() {
            if (first..first + keep).contains(&column) {
                out.push(value);
            } else {
                assert!(value == 0.0 || value == -1.0, "{name}: {value} in column {column}");
            }
        }
    }
    out
}

/// Returns the arrays that follow from the dynamics at `qpos0`.
pub fn derived(m: &Model) -> Named {
    let s = &m.stat;
    vec![
        ("body_subtreemass", m.body_subtreemass.clone()),
        ("body_invweight0", flat(&m.body_invweight0)),
        ("dof_invweight0", m.dof_invweight0.clone()),
        ("dof_M0", m.dof_m0.clone()),
        ("tendon_invweight0", m.tendon_invweight0.clone()),
        ("meaninertia", vec![s.meaninertia]),
        ("meanmass", vec![s.meanmass]),
        ("meansize", vec![s.meansize]),
        ("extent", vec![s.extent]),
        ("center", s.center.to_vec()),
    ]
}

/// Returns those of actuators, which no recording has.
pub fn derived_unrecorded(m: &Model) -> Named {
    vec![
        ("actuator_acc0", m.actuator_acc0.clone()),
        ("actuator_length0", m.actuator_length0.clone()),
    ]
}

/// Returns the simulation options.
pub fn options(m: &Model) -> Named {
    let o = &m.opt;
    vec![
        ("timestep", vec![o.timestep]),
        ("gravity", o.gravity.to_vec()),
        ("iterations", vec![o.iterations as f64]),
        ("tolerance", vec![o.tolerance]),
        ("ls_iterations", vec![o.ls_iterations as f64]),
        ("ls_tolerance", vec![o.ls_tolerance]),
        ("impratio", vec![o.impratio]),
        ("noslip_iterations", vec![o.noslip_iterations as f64]),
        ("noslip_tolerance", vec![o.noslip_tolerance]),
        ("ccd_iterations", vec![o.ccd_iterations as f64]),
        ("ccd_tolerance", vec![o.ccd_tolerance]),
    ]
}

/// Returns the names of elements by kind.
pub fn names(m: &Model) -> Vec<(&'static str, Vec<String>)> {
    vec![
        ("body", m.body_name.clone()),
        ("jnt", m.jnt_name.clone()),
        ("geom", m.geom_name.clone()),
        ("site", m.site_name.clone()),
        ("cam", m.cam_name.clone()),
        ("eq", m.eq_name.clone()),
        ("tendon", m.tendon_name.clone()),
        ("actuator", m.actuator_name.clone()),
        ("sensor", m.sensor_name.clone()),
        ("tex", m.textures.iter().map(|t| t.name.clone()).collect()),
        ("mat", m.materials.iter().map(|t| t.name.clone()).collect()),
        ("light", m.lights.iter().map(|t| t.name.clone()).collect()),
    ]
}
